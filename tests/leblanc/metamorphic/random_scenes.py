"""Machines drawn at random, asked twice: as they are and changed by what must not change the answer.

`python -m tests.leblanc.metamorphic.random_scenes --count 1000` lists every violation with the seed that
draws the machine again; `--seed 17 --change split` shows one of them.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing import get_context
from typing import Any

import numpy as np

from leblanc.scene.schema.load import SceneError
from meshes.errors import InputError
from tests.oracles.alike import differences
from tests.oracles.commands import numbers, run, whirl_map
from tests.oracles.machines import Table, in_other_units, scaled, split, turned
from tests.oracles.random_machines import Scales, machine, mirrored, nudged, permuted, random_scales

MEMORY = 6 << 30  # bytes of addresses that a worker may have
SAME: Scales = (1.0, 1.0, 1.0)
UNASKED = "a similar machine beyond what a scene may hold"
ANGLE = 0.7  # rad, by which unbalances are turned
# A change may move an answer by ten times the part of the largest term at which Newton's method stops, and by
# as much as numbers do that are off by 2^-40 each: whatever is sensitive to its inputs is so to rounding.
ROUNDING = 1e-10
NUDGES, SPREAD = 4, 10.0  # so many draws of those, of which the largest may be exceeded so many times
# Roots and eigenvalues are found to a part of the largest of their problem, not of themselves.
ROOTS = 1e-6
SILENT = 1e-5  # growth over whirl speed that a machine with doubled roots may call 0
NOISE = 1e-3  # growth over whirl speed below which the edges of a band are rounding's as well
SEARCHED = (
    "growth", "whirl_speed", "whirl_bands", "edges", "scene_edges", "natural_frequency",
    "natural_damping_ratio", "critical_speed_dry", "critical_speed_wet", "peak.speed", "peak_dry.speed",
)  # fmt: skip
# Worst of a turn.
LOADS = (
    "floor_force", "floor_force_least", "walking_margin", "lift_off_margin", "slip_margin", "clearance.end",
    "displacement.end",
)  # fmt: skip
# Deflections and the like, which turn with the unbalance, and where tilting rotors have them.
TURNING = ("phase", "liquid_angle", "deflection", "branches", "backward", "chamber_deflection")


@dataclass(frozen=True)
class Violation:
    """An answer that should not have changed.

    Parameters
    ----------
    seed, command, change : of the machine, what was asked, what was changed
    key : of the answer; or `error`
    off : relative to the largest of its kind, infinite where shapes or states differ
    allowed : as much as numbers that are a little off move it
    text : of an error, or empty
    """

    seed: int
    command: str
    change: str
    key: str
    off: float
    allowed: float
    text: str = ""

    def __str__(self) -> str:
        size = f"{self.off:.1e}, allowed {self.allowed:.0e}"
        return f"seed {self.seed:4d} {self.command:4} {self.change:9} {self.key}: {self.text or size}"


COMMANDS: dict[str, Callable[[Table], dict[str, Any]]] = {
    "run": run,
    "map": partial(whirl_map, volumes=2, speeds=3),
}


def changes(table: Table, seed: int) -> Iterator[tuple[str, Table, Scales]]:
    """What a machine may be changed to, and the factors of length, mass and time between the answers."""
    scales = random_scales(seed)
    yield "units", in_other_units(table), SAME
    yield "scaled", scaled(table, scales), scales
    yield "permuted", permuted(table), SAME
    # A partition is a floor and a lid more; upright, halves one above the other would stand side by side.
    if table["model"]["friction"] != "stokes" and table["rotor"]["axis"] == "horizontal":
        yield "split", split(table), SAME
    if "unbalances" in table["rotor"]:
        yield "turned", turned(table, ANGLE), SAME
    if table["rotor"]["kind"] != "jeffcott":
        yield "mirrored", mirrored(table), SAME


def expected(answer: dict[str, Any], change: str) -> dict[str, Any]:
    """The answer as the change should leave it, where it is more than scaled."""
    found = dict(answer)
    if change == "permuted" and "chamber_deflection" in answer:
        found["chamber_deflection"] = [[row[0], *row[:0:-1]] for row in answer["chamber_deflection"]]
    if change == "split" and "chamber_deflection" in answer:
        found["chamber_deflection"] = [[row[0], *row] for row in answer["chamber_deflection"]]
    if change == "permuted" and "floor_force" in answer:
        found["floor_force_rest"] = answer["floor_force_rest"][::-1]
        for key in ("floor_force", "floor_force_least"):
            found[key] = [row[::-1] for row in answer[key]]
    if change == "mirrored" and "position" in answer:
        found["position"] = -answer["position"]
    if change == "turned":
        for key, sense in (("deflection", 1), ("branches", 1), ("chamber_deflection", 1), ("backward", -1)):
            if key in answer:
                found[key] = _turned(answer[key], sense * ANGLE)
        for key in ("phase", "liquid_angle"):
            if key in answer:
                found[key] = [None if value is None else value + ANGLE for value in answer[key]]
    return found


def _turned(values: Any, angle: float) -> Any:
    """Nested lists of [re, im], turned."""
    if isinstance(values, list) and len(values) == 2 and not any(isinstance(one, list) for one in values):
        if values[0] is None or values[1] is None:
            return values
        turned = complex(*values) * np.exp(1j * angle)
        return [turned.real, turned.imag]
    return [_turned(one, angle) for one in values] if isinstance(values, list) else values


def asked(command: str, table: Table) -> dict[str, Any] | str:
    """The answer, or in words why there is none."""
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            return COMMANDS[command](table)
    except SceneError:
        return UNASKED
    except InputError as refused:
        return f"refused: {refused.field}"
    except Exception:  # whatever it is, it is what this looks for
        return "fails: " + traceback.format_exc(limit=-2)


def violations(
    seed: int, command: str, only: Sequence[str] = (), table: Table | None = None
) -> list[Violation]:
    """What a machine's answer should not have changed by.

    Parameters
    ----------
    seed : of the machine and of its changes
    command : of `COMMANDS`
    only : these changes; all if empty
    table : the machine, in place of the seed's own
    """
    table = machine(seed) if table is None else table
    answer = asked(command, table)
    if isinstance(answer, str):
        if answer.startswith("fails"):
            return [Violation(seed, command, "none", "error", np.inf, 0.0, answer)]
        kept = [(name, asked(command, other)) for name, other, _ in changes(table, seed)]
        return [
            Violation(seed, command, name, "error", np.inf, 0.0, f"{answer}; changed {str(found)[:60]}")
            for name, found in kept
            if found not in (answer, UNASKED)
        ]
    found, floors = [], _floors(answer)
    for name, other, scales in changes(table, seed):
        if only and name not in only:
            continue
        again = asked(command, other)
        if again == UNASKED:
            continue
        if isinstance(again, str):
            found.append(Violation(seed, command, name, "error", np.inf, 0.0, again))
            continue
        wanted, without = expected(answer, name), _noise(answer)
        if name == "split":
            # Where growth falls to nothing without a change of sign rounding says where a band ends, and the
            # waves of the halves against one another, neutral without friction, round in their own way. What
            # is called stable follows from growth and from the stability of the branches.
            without = (*without, "growth", "whirl_speed", "whirl_bands", "edges", "scene_edges")
            without = (*without, "stable", "stability")
            found += _halves(seed, command, answer, again)
        upright = table["rotor"]["axis"] == "vertical"
        if name == "turned" or (name == "mirrored" and upright):
            # They are looked at at 180 angles of a turn, of which others are the largest now; upright, the
            # machine in the mirror hangs from its floor.
            without = (*without, *LOADS)
        off = differences(again, wanted, scales, without)
        found += [
            Violation(seed, command, name, key, far, floors[key])
            for key, far in off.items()
            if not far <= floors[key]
        ]
    if not any(violation.key in floors for violation in found):
        return found
    # Only now is it worth asking how sensitive the machine is.
    allowed = _allowed(seed, command, table, answer)
    judged = [replace(one, allowed=max(one.allowed, allowed.get(one.key, 0.0))) for one in found]
    return [one for one in judged if not one.off <= one.allowed]


def _floors(answer: dict[str, Any]) -> dict[str, float]:
    """By key what rounding alone may leave."""
    found = dict.fromkeys(differences(answer, answer), ROUNDING) | dict.fromkeys(("model", "state"), 0.0)
    return found | {key: ROOTS for key in SEARCHED if key in found}


def _noise(answer: dict[str, Any]) -> tuple[str, ...]:
    """What is not compared: bands of growth that rounding makes, the direction of a whirl that it makes."""
    growth, whirl, spin = (
        np.append(numbers(answer.get(key, [])).astype(float), 0.0)
        for key in ("growth", "whirl_speed", "speed")
    )
    grows = np.nanmax(growth) > NOISE * np.nanmax(np.abs(whirl))
    found = () if grows else ("whirl_bands", "edges", "scene_edges")
    turns = np.nanmax(np.abs(whirl)) > ROOTS * np.nanmax(spin)
    return found if turns else (*found, "whirl_speed")


def _allowed(seed: int, command: str, table: Table, answer: dict[str, Any]) -> dict[str, float]:
    """By key how far numbers a little off move the answer."""
    found = _floors(answer)
    for k in range(NUDGES):
        near = asked(command, nudged(table, NUDGES * seed + k))
        if isinstance(near, str):
            return dict.fromkeys(found, np.inf)
        for key, far in differences(near, answer).items():
            found[key] = max(found[key], SPREAD * far)
    return found


def _halves(seed: int, command: str, whole: dict[str, Any], halves: dict[str, Any]) -> list[Violation]:
    """Two halves slosh against one another: that may be the slowest to die, never what grows."""
    if "growth" not in whole:
        return []
    before, after = (numbers(found["growth"]).astype(float) for found in (whole, halves))
    if before.shape != after.shape:
        return [Violation(seed, command, "split", "growth", np.inf, 0.0)]
    # Of roots, which are found to a part of themselves. Halves double each root, by whose rounding growth is
    # called 0: some times more of it than where the chamber is whole.
    size = float(np.nanmax(np.abs(np.append(numbers(whole["whirl_speed"]).astype(float), 0.0))))
    grows = np.maximum(before, after) > ROOTS * size
    off = np.where(grows, np.abs(after - before), np.maximum(before - after, 0.0))
    silent = (np.minimum(before, after) == 0.0) & (off <= SILENT * size)
    off = np.where(silent, 0.0, off)
    unknown = bool(np.any(np.isnan(before) != np.isnan(after)))
    far = np.inf if unknown else float(np.nanmax(np.append(off, 0.0))) / (size or 1.0)
    return [] if far <= ROOTS else [Violation(seed, command, "split", "growth", far, ROOTS)]


def every(seed: int, commands: Sequence[str]) -> list[Violation]:
    """The violations of one machine."""
    return [one for command in commands for one in violations(seed, command)]


def search(first: int, count: int, commands: Sequence[str], jobs: int = 1) -> Iterator[list[Violation]]:
    """The violations of one machine after the other, in the order of their seeds."""
    seeds = range(first, first + count)
    task = partial(every, commands=commands)
    if jobs == 1:
        yield from map(task, seeds)
        return
    # A worker that dies ends the search; one that asks for all memory fails on its machine.
    with ProcessPoolExecutor(jobs, get_context("spawn"), _bound_memory) as pool:
        yield from pool.map(task, seeds)


def _bound_memory() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def main() -> int:
    """Draw machines, list violations."""
    parser = argparse.ArgumentParser(prog="python -m tests.leblanc.metamorphic.random_scenes")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="seed of the first machine")
    parser.add_argument("--seed", type=int, help="this machine alone, shown as a scene")
    parser.add_argument("--command", choices=COMMANDS, action="append")
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args()
    commands = given.command or list(COMMANDS)
    if given.seed is not None:
        print(json.dumps(machine(given.seed), indent=1))
        given.first, given.count = given.seed, 1
    total = 0
    for done, found in enumerate(search(given.first, given.count, commands, given.jobs), start=1):
        total += len(found)
        for one in found:
            print(one, flush=True)
        if done % 50 == 0:
            print(f"{done} machines, {total} violations", file=sys.stderr, flush=True)
    print(f"{given.count} machines, {total} violations")
    return 1 if total else 0


if __name__ == "__main__":
    sys.exit(main())
