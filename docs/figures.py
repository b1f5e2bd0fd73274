"""Draw every picture of docs/images again, and compare what is drawn with what is committed.

    python docs/figures.py                          # all, into docs/images: some eight minutes
    python docs/figures.py --check --out out/figures    # what takes seconds, compared with docs/images

A picture without a recipe here, and a recipe without its picture, fail a test.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"
# Another release of the drawing library may set a letter elsewhere: this share of the points may differ, by
# more than this share of black.
_SHARE, _DEPTH = 0.02, 0.1


@dataclass(frozen=True)
class Recipe:
    """One run of a program and the pictures it draws.

    Parameters
    ----------
    program : module or file with its arguments, without the folder that it draws into
    pictures : stems in docs/images
    drawn : what the program calls them, where that is something else
    minutes : it takes minutes, so that only `make figures` draws it
    needs : package of an extra without which it cannot run
    """

    program: tuple[str, ...]
    pictures: tuple[str, ...]
    drawn: dict[str, str] = field(default_factory=dict)
    minutes: bool = False
    needs: str = ""

    def command(self, out: Path) -> list[str]:
        """The command line, told to draw PNG; `view` draws nothing else.

        Parameters
        ----------
        out : folder that it draws into
        """
        first, *rest = self.program
        if first == "leblanc":
            rest += [] if rest[0] == "view" else ["--png"]
            start = ["-c", "from leblanc.cli import main; import sys; sys.exit(main(sys.argv[1:]))"]
        else:
            start = [first] if first.endswith(".py") else ["-m", first]
        return [sys.executable, *start, *rest, "--out", str(out)]

    def shown(self) -> str:
        """The command as a reader types it."""
        first, *rest = self.program
        start = first if first == "leblanc" else f"python {first if first.endswith('.py') else f'-m {first}'}"
        return " ".join([start, *(f'"{word}"' if " " in word else word for word in rest), "--out", "DIR"])


def _example(command: str, scene: str, *rest: str, **drawn: str) -> Recipe:
    """A command on a shipped scene; `picture=what the command calls it`."""
    return Recipe(("leblanc", command, f"examples/{scene}.toml", *rest), tuple(drawn), drawn)


RECIPES = (
    _example(
        "run",
        "horizontal_rig",
        horizontal_rig_amplitude="amplitude",
        horizontal_rig_chamber="chamber",
    ),
    _example("run", "washing_machine", washing_machine_amplitude="amplitude"),
    _example("run", "tub", machine_loads="machine"),
    _example("run", "centrifuge", volumes_centrifuge="volumes"),
    _example("run", "spindle", spindle_compliance="compliance", spindle_shapes="shapes"),
    _example("map", "horizontal_rig", whirl_map="map"),
    _example(
        "map",
        "centrifuge",
        *("--over", "rotor.damping_ratio", "--speeds", "101"),
        whirl_over_damping="map",
    ),
    Recipe(
        ("leblanc", "map", "docs/examples/self_excited.toml", "--cycles", "--volumes", "21"),
        ("whirl_cycles",),
        {"whirl_cycles": "cycles"},
    ),
    _example("runup", "runup", runup_example_speed="runup_speed"),
    _example(
        "runup",
        "horizontal_rig",
        runup_horizontal_rig_speed="runup_speed",
        runup_horizontal_rig_time="runup_time",
    ),
    _example("run", "balls", balls_states="balls"),
    _example("map", "balls", balls_map="map"),
    _example(
        "map",
        "long_rotor",
        *("--over", "rotor.supports.0.damping", "--over", "rotor.supports.1.damping"),
        *("--from", "0.25", "--to", "16000"),
        long_rotor_map="map",
    ),
    _example("runup", "balls", balls_runup="runup_time"),
    _example("optimise", "balls_design", balls_design="design"),
    _example("run", "balls_and_liquid", balls_and_liquid="balls"),
    _example("runup", "programme", programme_speed="runup_speed", programme_time="runup_time"),
    _example("optimise", "runup", optimise_objective="objective"),
    _example("optimise", "washing_machine", "--objective", "peak", "--steady", optimise_front="front"),
    Recipe(
        ("leblanc", "optimise", "docs/examples/warm.toml", "--no-front"),
        ("optimise_conditions",),
        {"optimise_conditions": "conditions"},
    ),
    Recipe(
        ("validation.cases.rotors.tub",),
        (
            "tub_fig4_vertical",
            "tub_fig5_longitudinal",
            "tub_fig6_rigidity_centre",
            "tub_fig7_rigidity_centre_far",
            "tub_fig8_springs_turned",
            "tub_fig9_dampers_turned",
        ),
    ),
    Recipe(("docs/house.py", "--picture", "rooms.png"), ("rooms",)),
    Recipe(("validation.cases.two_plane.conditions",), ("two_plane_balls",)),
    Recipe(("validation.cases.measured_balls.figure",), ("measured_balls",)),
    _example("run", "measured_balls", balls_that_stick="balls"),
    Recipe(("validation.cases.liquid.lying_drum",), ("lying_drum",)),
    Recipe(
        ("validation.cases.two_plane.charts",),
        ("balls_damping", "balls_reference", "balls_unlike", "balls_charts"),
        minutes=True,
    ),
    Recipe(("validation.cases.exciter.traces",), ("exciter_traces", "exciter_trends")),
    Recipe(("validation.cases.exciter.beyond",), ("exciter_beyond",)),
    Recipe(("validation.cases.rotors.weak_motor",), ("runup_weak_motor",)),
    Recipe(("validation.cases.rotors.rig_lag",), ("runup_lag",)),
    Recipe(("validation.trade.figure",), ("trade_runup", "trade_horizontal_rig")),
    Recipe(
        ("validation.benchmarks.report",),
        (
            "benchmark_steady_strongly_damped",
            "benchmark_steady_weakly_damped",
            "benchmark_travelling",
            "benchmark_layer_profile",
            "benchmark_layer_force",
            "benchmark_cells",
            "benchmark_speeds",
        ),
    ),
    *(
        _example("view", scene, **{f"view_{scene}": "view"})
        for scene in (
            *("centrifuge", "horizontal_rig", "runup", "tub", "two_plane_rig", "vertical_rig"),
            *("vibratory_table", "washing_machine"),
        )
    ),
    *(
        _example("view", scene, **{f"view_{scene}": "view"})
        for scene in ("balls", "balls_and_liquid", "long_rotor", "blood_pump")
    ),
    _example("view", "balls", "--speed", "600 rpm", view_balls_slow="view"),
    _example("view", "spindle", "--speed", "335Hz", view_spindle="view"),
    _example("view", "runup", "--speed", "24 rad/s", view_runup_resonance="view"),
    _example("view", "vertical_rig", "--speed", "8 rad/s", view_vertical_rig_slow="view"),
    _example("view", "centrifuge", "--mode", "3", view_mode="view"),
    Recipe(
        ("leblanc", "view", "docs/examples/closed_baffles.toml"),
        ("view_closed_baffles",),
        {"view_closed_baffles": "view"},
    ),
    Recipe(("docs/examples/lobes.py",), ("view_lobes",), {"view_lobes": "view"}),
    Recipe(("docs/mesh_pictures.py",), ("meshes_sections", "meshes_bodies")),
    Recipe(
        (
            *("leblanc", "modes", "--radius", "150 mm", "--volume", "671.5 ml", "--height", "50 mm"),
            *("--speed", "40 rad/s", "--baffles", "3", "--baffle-tip-radius", "142 mm"),
        ),
        ("modes_baffles",),
        {"modes_baffles": "modes"},
    ),
    Recipe(
        (
            *("leblanc", "layer", "--radius", "100 mm", "--volume", "119.4 ml", "--height", "20 mm"),
            *("--speed", "40 rad/s", "--free", "1.6", "--model", "potential"),
        ),
        ("layer_limiting_wave",),
        {"layer_limiting_wave": "wave"},
    ),
    Recipe(("validation.cases.rotors.whirl_passage",), ("whirl_passage",), minutes=True),
    Recipe(("tests.models.figure",), ("models",)),
    Recipe(("validation.breaking.figure",), ("breaking", "breaking_crest")),
    Recipe(("validation.exact.figure",), ("wave_errors", "wave_ends")),
    Recipe(("tests.exact_whirl.figure",), ("exact_whirl",)),
    Recipe(("validation.cases.baffles.whirl",), ("whirl_baffles",)),
    Recipe(("validation.cases.baffles.flow",), ("baffles_decay",)),
    Recipe(("validation.cases.claims.chambers",), ("claims_rings",)),
    Recipe(
        ("leblanc", "optimise", "examples/tub.toml", "--objective", "layout"),
        ("tub_layout",),
        {"tub_layout": "layout"},
    ),
    Recipe(("validation.cases.fill_sweep.judged",), ("fill_sweep",)),
    Recipe(("validation.cases.rotors.runup",), ("runup_trends",), minutes=True),
    Recipe(
        ("validation.cases.exciter.speeds",),
        ("exciter_table", "exciter_start", "exciter_regression"),
        minutes=True,
    ),
    Recipe(("validation.cases.rotors.blood_pump",), ("blood_pump", "blood_pump_coils")),
    Recipe(("docs/app_pictures.py",), ("app_wide", "app_telephone"), minutes=True, needs="trame_vuetify"),
    Recipe(("examples/ross_flexible_rotor.py",), ("ross_flexible_rotor",), minutes=True, needs="ross"),
)


def draw(recipe: Recipe, out: Path) -> float:
    """Draw the pictures of a recipe.

    Parameters
    ----------
    recipe : what to run
    out : folder of the pictures

    Returns
    -------
    Seconds that it took
    """
    begin = time.perf_counter()
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    with tempfile.TemporaryDirectory() as scratch:
        command = recipe.command(Path(scratch))
        done = subprocess.run(
            command, cwd=ROOT, capture_output=True, text=True, env=os.environ | one_thread, check=False
        )
        if done.returncode != 0:
            raise SystemExit(f"{recipe.shown()} ended with code {done.returncode}\n{done.stderr}")
        out.mkdir(parents=True, exist_ok=True)
        for name in recipe.pictures:
            shutil.copyfile(Path(scratch) / f"{recipe.drawn.get(name, name)}.png", out / f"{name}.png")
    return time.perf_counter() - begin


def difference(path: Path, other: Path) -> float:
    """Share of the points in which two pictures differ to the eye; 1 if they differ in size.

    Parameters
    ----------
    one, other : PNG files
    """
    import numpy as np
    from matplotlib.image import imread

    first, second = imread(path), imread(other)
    if first.shape != second.shape:
        return 1.0
    return float((np.abs(first - second).max(axis=-1) > _DEPTH).mean())


def changed(recipe: Recipe, out: Path) -> list[str]:
    """Pictures of a recipe that are no longer what is committed, in words.

    Parameters
    ----------
    recipe : drawn into `out`
    out : folder of what was drawn
    """
    found = []
    for name in recipe.pictures:
        share = difference(out / f"{name}.png", IMAGES / f"{name}.png")
        if share > _SHARE:
            found.append(
                f"docs/images/{name}.png differs in {share:.0%} of its points from what is drawn now"
            )
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Draw, and with `--check` compare; exit code 1 if a committed picture has changed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--out", type=Path, default=IMAGES, help="folder of the pictures [docs/images]")
    parser.add_argument(
        "--check", action="store_true", help="only what takes seconds; compare with docs/images"
    )
    chosen = parser.parse_args(arguments)
    return draw_all(RECIPES, chosen.out, chosen.check)


def draw_all(recipes: Iterable[Recipe], out: Path, check: bool) -> int:
    """Draw the pictures of recipes.

    Parameters
    ----------
    recipes : in their order
    out : folder of the pictures
    check : leave out what takes minutes, compare the others with what is committed

    Returns
    -------
    Exit code, 1 if a committed picture has changed
    """
    wanted = [recipe for recipe in recipes if not (check and recipe.minutes)]
    able = [recipe for recipe in wanted if not recipe.needs or importlib.util.find_spec(recipe.needs)]
    for recipe in wanted:
        if recipe not in able:
            print(f"{recipe.shown()}: left out, {recipe.needs} is not installed", flush=True)
    wrong: list[str] = []
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for recipe, seconds in zip(able, pool.map(lambda recipe: draw(recipe, out), able), strict=True):
            print(f"{recipe.shown()}: {seconds:.1f} s", flush=True)
            wrong += changed(recipe, out) if check else []
    if wrong:
        print(*wrong, "If that is right: make figures, and look at them.", sep="\n", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
