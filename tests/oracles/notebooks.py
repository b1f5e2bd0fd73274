"""Wrong formulas, and the notebooks that lean on them: each must fail at one of its claims.

`python -m tests.oracles.notebooks` breaks all of them, one after the other, and prints a table.
"""

from __future__ import annotations

import argparse
import ast
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.mutants import Mutant, seeded
from validation.run_notebooks import FOLDER

ROOT = Path(__file__).parents[2]
_DRAWING = {"picture", "drawn"}  # what draws claims nothing
_COMPILED = ("fluid.long_wave:", "solvers.rotor.balls.motion:")

# Five per cent each, but where a sign or a power is what can be mistaken.
BROKEN: tuple[tuple[str, Mutant], ...] = (
    ("1_paraboloid", Mutant("fluid.paraboloid:steepness", "2.0 * g * h", "2.1 * g * h")),
    ("2_wave", Mutant("fluid.kdv:coefficients", "log**3 / 3.0", "log**3 / 3.15")),
    ("2_wave", Mutant("fluid.long_wave:wall_pressure", "2.0 * spin * log", "2.1 * spin * log")),
    ("2_wave", Mutant("fluid.long_wave:static_head", "spin * spin * area", "1.05 * spin * spin * area")),
    ("2_wave", Mutant("fluid.long_wave:pressure_force", "0.5 * spin * spin", "0.525 * spin * spin")),
    (
        "3_rigs",
        Mutant(
            "solvers.synchronous.pairs:Pairs.dynamic_stiffness", "1j * self.damping", "1.05j * self.damping"
        ),
    ),
    ("3_rigs", Mutant("fluid.pool:pool_of", "hole.moment) / area", "hole.moment) / (1.05 * area)")),
    ("3_rigs", Mutant("fluid.pool:sloshing_number", "return 1.0 /", "return 1.05 /")),
    (
        "4_self_excited_whirl",
        Mutant(
            "solvers.rotor.jeffcott:Jeffcott.system", "damping=self.damping", "damping=1.05 * self.damping"
        ),
    ),
    (
        "5_washing_machine",
        Mutant(
            "solvers.rotor.tub:Tub._system", "self.unbalance * (centre", "1.05 * self.unbalance * (centre"
        ),
    ),
    ("5_washing_machine", Mutant("solvers.rotor.system:cage_speed", "0.5 * shaft", "0.525 * shaft")),
    (
        "6_balls",
        Mutant(
            "solvers.rotor.exciter.machine:shaft_speed", "np.square(2.0 * h * q)", "np.square(2.1 * h * q)"
        ),
    ),
    (
        "7_fill_volume",
        Mutant(
            "solvers.rotor.jeffcott:Jeffcott.system", "damping=self.damping", "damping=1.05 * self.damping"
        ),
    ),
    (
        "8_accuracy_and_cost",
        Mutant("fluid.fill:Fill.full_mass", "* math.pi * self", "* 1.05 * math.pi * self"),
    ),
    ("9_the_exact_wave", Mutant("solvers.potential.steady:SteadyWave.centre", "/ 3.0", "/ 3.15")),
    (
        "10_blood_pump",
        Mutant(
            "solvers.rotor.magnetic.machine:MagneticRotor.gyroscopic",
            "self.polar_inertia, -self.polar_inertia",
            "1.05 * self.polar_inertia, -1.05 * self.polar_inertia",
        ),
    ),
    (
        "11_balls_two_planes_damping",
        Mutant(
            "solvers.rotor.balls.stability:_turning_motions",
            "damping + 2.0 * speed",
            "damping + 2.1 * speed",
        ),
    ),
    (
        "11_balls_two_planes_damping",
        Mutant(
            "solvers.rotor.balls.stability:_turning_motions", "diag(balls[:, 2]", "diag(1.05 * balls[:, 2]"
        ),
    ),
    (
        "11_balls_two_planes_damping",
        Mutant("solvers.rotor.balls.balancers:race_arrays", "race.drag,", "1.05 * race.drag,"),
    ),
    (
        "11_balls_two_planes_damping",
        Mutant("solvers.rotor.balls.motion:rates", "-drag * radius", "-1.05 * drag * radius"),
    ),
    *(
        ("12_the_wave_by_py_pde", mutant)
        for mutant in (
            Mutant("fluid.kdv:coefficients", "log**3 / 3.0", "log**3 / 3.15"),
            Mutant("fluid.kdv:coefficients", "dispersion=spin", "dispersion=-spin"),
            Mutant("fluid.kdv:coefficients", "3.0 * spin / surface_radius", "3.15 * spin / surface_radius"),
            Mutant("fluid.kdv:coefficients", "surface_radius / (2.0", "surface_radius / (2.1"),
            Mutant("fluid.kdv:coefficients", "coupling=family", "coupling=-family"),
            Mutant("fluid.kdv:decay", "k * abs", "1.05 * k * abs"),
            Mutant("fluid.kdv:offset", "c.surface_radius /", "1.05 * c.surface_radius /"),
            Mutant("fluid.kdv:force_ratio", "2.0 * c.mean_area", "2.1 * c.mean_area"),
            Mutant("solvers.waves.modes:wave_split", "terms.viscosity * np", "1.05 * terms.viscosity * np"),
            Mutant("solvers.pypde.models:OneFamily._terms", "whirl.slip + lag", "whirl.slip - lag"),
            Mutant("solvers.pypde.models:OneFamily._lag", "inertia * math", "1.1 * inertia * math"),
            Mutant("solvers.cycles.family:FamilyWave._rate", "* self.near", "* 1.15 * self.near"),
            Mutant("solvers.cycles.family:FamilyWave._fed", "2.0 * self.mean", "2.4 * self.mean"),
            Mutant("fluid.long_wave:mass_flux", "velocity * log", "1.05 * velocity * log"),
        )
    ),
)


def claims(path: Path) -> str:
    """Code of a notebook without the lines that only draw, each claim right behind what it stands on.

    Parameters
    ----------
    path : Python whose comments are the text
    """
    body = statements(path)
    return ast.unparse(ast.Module([body[k] for k in earliest(body)], []))


def statements(path: Path) -> list[ast.stmt]:
    """What a notebook does besides drawing."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    return [node for node in body if not _draws(node)]


def earliest(body: list[ast.stmt]) -> list[int]:
    """Order of statements with each claim as early as it can be.

    Those on tables of cases, which take longest, come last.
    """
    needed = [_needed(body, k) for k, node in enumerate(body) if isinstance(node, ast.Assert)]
    slow = [any("cases(" in ast.unparse(body[k]) for k in one) for one in needed]
    order: list[int] = []
    for _, one in sorted(zip(slow, needed, strict=True), key=lambda pair: pair[0]):
        order += [k for k in one if k not in order]
    return [*order, *(k for k in range(len(body)) if k not in order)]


def _needed(body: list[ast.stmt], last: int) -> list[int]:
    """Numbers of the statements that one stands on, in their order, it among them."""
    found, names = [last], used(body[last])
    for k in range(last - 1, -1, -1):
        if names & made(body[k], body):
            found.append(k)
            names |= used(body[k])
    return found[::-1]


def used(node: ast.stmt) -> set[str]:
    """Names whose value a statement takes."""
    return _names(node, ast.Load) - _own(node)


def made(node: ast.stmt, body: list[ast.stmt]) -> set[str]:
    """Names whose value a statement gives or may change; what is imported is changed by nothing."""
    if isinstance(node, ast.Assert):
        return set()
    modules = {name for other in body for name in _imported(other)}
    return _imported(node) or _stored(node) | (_changed(node) - modules)


def _names(node: ast.AST, use: type[ast.expr_context]) -> set[str]:
    return {one.id for one in ast.walk(node) if isinstance(one, ast.Name) and isinstance(one.ctx, use)}


def _imported(node: ast.stmt) -> set[str]:
    if isinstance(node, ast.Import | ast.ImportFrom):
        return {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
    return set()


def _stored(node: ast.stmt) -> set[str]:
    """Names that a statement gives a meaning to."""
    return {node.name} if isinstance(node, ast.FunctionDef) else _names(node, ast.Store) - _own(node)


def _own(node: ast.stmt) -> set[str]:
    """Names of comprehensions, which mean nothing outside."""
    inside = [one.target for one in ast.walk(node) if isinstance(one, ast.comprehension)]
    return {name for target in inside for name in _names(target, ast.Store)}


def _changed(node: ast.stmt) -> set[str]:
    """Names whose value a statement may change: by a method, or at a place of it."""
    held = [
        one.func if isinstance(one, ast.Call) else one
        for one in ast.walk(node)
        if isinstance(one, ast.Call | ast.Subscript)
    ]
    places = [one.value for one in held if isinstance(one, ast.Attribute | ast.Subscript)]
    return {place.id for place in places if isinstance(place, ast.Name)}


def _draws(node: ast.stmt) -> bool:
    """A line that is nothing but the call of what shows a figure."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Call)
        and isinstance(node.value.func, ast.Name)
        and node.value.func.id in _DRAWING
    )


def failed(number: int) -> str:
    """Claim at which a notebook fails with a wrong formula, empty if it passes.

    In a process of its own, where nothing has been computed before, and if the formula is one of compiled
    code, with machine code of its own.

    Parameters
    ----------
    number : in `BROKEN`
    """
    compiled = BROKEN[number][1].function.startswith(_COMPILED)
    with TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, "-m", "tests.oracles.notebooks", "--one", str(number)],
            capture_output=True,
            text=True,
            cwd=ROOT,
            check=False,
            env=os.environ | ({"NUMBA_CACHE_DIR": folder} if compiled else {}),
        )
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr)
    return done.stdout.strip().splitlines()[-1] if done.returncode else ""


def main(arguments: Sequence[str] | None = None) -> int:
    """Table of all, or one of them in this process: exit code 1 at a claim that does not hold.

    Parameters
    ----------
    arguments : instead of those of the process
    """
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--one", type=int, help="number of one formula, to be broken in this process")
    number = parser.parse_args(arguments).one
    if number is not None:
        return _one(*BROKEN[number])
    found = [failed(number) for number in range(len(BROKEN))]
    for (name, mutant), claim in zip(BROKEN, found, strict=True):
        print(f"| {mutant} | {name} | {claim or 'PASSED'} |", flush=True)
    return 0 if all(found) else 1


def _one(name: str, mutant: Mutant) -> int:
    text = claims(FOLDER / f"{name}.py")
    with seeded(mutant):
        try:
            exec(compile(text, name, "exec"), {"__name__": "__main__"})
        except AssertionError as error:
            trace = error.__traceback__
            lines = []
            while trace is not None:
                if trace.tb_frame.f_code.co_filename == name:
                    lines.append(text.splitlines()[trace.tb_lineno - 1].strip())
                trace = trace.tb_next
            print(lines[-1])
            return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
