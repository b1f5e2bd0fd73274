"""Results as objects: one question asked once, the same numbers by every way out."""

from __future__ import annotations

import json
import pickle
import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc import run_up
from leblanc.cli import main
from leblanc.core.answer import Answer
from leblanc.core.terminal import print_json
from leblanc.liquid.choose import choose_all, prepare
from leblanc.plotting.page import Figure
from leblanc.scene.scene import Scene, load_scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.optimise import optimise
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.study import run_scene
from leblanc.studies.volume import volume
from leblanc.studies.volume.answer import Coverage
from leblanc.studies.volume.figure import surface_figure
from leblanc.wings.exciter.study import explain_exciter, run_exciter
from leblanc.wings.magnetic.study import explain_magnetic, run_magnetic
from tests.oracles.data_files import assert_read_back

CHAMBER = {"radius": 0.065, "height": 0.02}
LAYER: dict[str, Any] = {"radius": 0.15, "volume": "671 ml", "height": 0.05, "speed": 40.0}
ROOT = Path(__file__).parents[3]


def scene(name: str) -> Scene:
    return load_scene(ROOT / f"examples/{name}.toml")


FEW = {"speeds.count": 12}
RUNUP = scene("runup").replace({"runup.duration": "1 s", "runup.cells": 16})


WARM = Optimisation(objective="robust", temperature=(280.0, 330.0), volumes=((0.0, 1e-5),))


@cache
def run() -> RunAnswer:
    return run_scene(scene("tub").replace(FEW))


SELF_EXCITED = {"speeds.start": 120.0, "speeds.stop": 155.0, "speeds.count": 4}

RESULTS = {
    "runup": lambda: run_up(RUNUP, samples=50, check=False),
    "optimise": lambda: optimise(scene("horizontal_rig").replace(FEW)),
    "optimise robust": lambda: optimise(scene("runup").altered(optimise=WARM), front=False),
    "run": run,
    "run with cycles": lambda: run_scene(
        load_scene(ROOT / "docs/examples/self_excited.toml").replace(SELF_EXCITED), cycles=True
    ),
    "map": lambda: lb.map_whirl(scene("horizontal_rig"), volumes=5, speeds=21),
    "compare": lambda: lb.compare(scene("horizontal_rig").replace(FEW), ["kdv", "linear", "statics"]),
    "explain": lambda: explain_scene(scene("runup")),
    "explain an exciter": lambda: explain_exciter(scene("vibratory_table")),
    "layer": lambda: lb.layer(**LAYER, whirl_speed=32.0, whirl_amplitude="0.15 mm"),
    "layer from rest": lambda: lb.layer(
        **LAYER, whirl_speed=32.0, whirl_amplitude="0.15 mm", model="long_wave", cells=32, duration=2.0
    ),
    "modes": lambda: lb.modes(**LAYER, count=3, segments=32),
    "volume": lambda: volume(**CHAMBER, eccentricity=1e-3, speed=20.0, volume=3e-5),
    "exciter": lambda: run_exciter(scene("vibratory_table").replace(FEW)),
    "magnetic": lambda: run_magnetic(
        scene("blood_pump").replace({"speeds.count": 3, "rotor.trial.duration": 0.02})
    ),
    "explain a rotor in magnetic bearings": lambda: explain_magnetic(scene("blood_pump")),
}


class Cells(HTMLParser):
    """Texts of a block of a notebook, and its pictures."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.pictures: list[dict[str, str | None]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.pictures.append(dict(attrs))

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


@pytest.mark.usefixtures("_exciter_once")
@pytest.mark.parametrize("name", RESULTS)
def test_every_result_has_every_way_out(
    name: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    result: Answer = RESULTS[name]()
    print_json(result.to_json())
    assert json.loads(capsys.readouterr().out)
    for key, value in result.to_json().items():
        carried = getattr(result, key)
        assert not callable(carried), key
        if isinstance(value, np.ndarray) and value.dtype.kind in "fc":
            np.testing.assert_array_equal(carried, value)
    data = result.to_dataset()
    assert all(variable.attrs["units"] and variable.attrs["long_name"] for variable in data.values())
    assert data.attrs["version_numpy"] == np.__version__
    assert_read_back(result.named_arrays(), tmp_path)
    figure = result.plot()
    assert isinstance(figure, Figure) and figure.axes
    assert figure.caption.shown and len(figure.alt) > 20
    cells = Cells(result._repr_html_())
    assert len(cells.texts) >= 6 and "nan" not in " ".join(cells.texts).split()
    (picture,) = cells.pictures
    assert picture["alt"] == figure.alt and str(picture["src"]).startswith("data:image/svg+xml;base64,")


def test_attributes_are_the_arrays_of_the_json() -> None:
    result = run()
    found = result.to_json()
    for key in ("speed", "amplitude", "amplitude_dry", "phase", "liquid_offset", "liquid_angle", "growth"):
        np.testing.assert_array_equal(np.array(found[key], dtype=float), getattr(result, key))
    for key in ("dry_patch", "stable", "model", "in_range", "converged"):
        assert found[key] == getattr(result, key).tolist()
    turn = np.array(found["deflection"]) @ np.array([1.0, 1.0j])
    np.testing.assert_array_equal(turn, result.deflection)


def test_notes_say_what_their_numbers_are() -> None:
    """A note is found by its code; its sentence has its numbers, in engineers' units."""
    notes = run().notes
    assert len({note.code for note in notes}) == len(notes)
    for note in notes:
        assert pickle.loads(pickle.dumps(note)) == note
        if "share" in note.data:
            assert f"{note.data['share']:.2g}" in note.text
        if "below" in note.data:
            assert note.data["below"] == run().capture_speed


def calls(action: object, *counted: CodeType) -> dict[CodeType, list[dict[str, Any]]]:
    """What some functions are given each time that they are called while something is done."""
    found: dict[CodeType, list[dict[str, Any]]] = {code: [] for code in counted}

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and frame.f_code in found:
            found[frame.f_code].append(dict(frame.f_locals))

    assert callable(action)
    sys.setprofile(note)
    try:
        action()
    finally:
        sys.setprofile(None)
    return found


@pytest.mark.parametrize("command", ["run", "explain"])
def test_models_are_chosen_once_a_command(command: str, tmp_path: Path) -> None:
    """Once at each speed: text, figures and report take them, the machine and its speeds from the result.

    `run` chooses again only at the speeds between those of the scene, which it finds as it goes: no speed is
    chosen for twice.
    """
    counted = (choose_all.__code__, prepare.__code__, Scene.speed_array.__code__)
    options = ["--out", str(tmp_path)] if command == "run" else []
    path = tmp_path / "scene.toml"
    path.write_text(scene("centrifuge").replace(FEW).to_toml(), encoding="utf-8")
    found = calls(lambda: main([command, str(path), *options]), *counted)
    chosen, *once = (found[code] for code in counted)
    assert [len(given) for given in once] == [1, 1]
    given, *between = ([machine.speed for machine in each["machines"]] for each in chosen)
    np.testing.assert_array_equal(np.concatenate(given), load_scene(path).speed_array())
    assert bool(between) == (command == "run")
    every = np.concatenate([*given, *(speed for speeds in between for speed in speeds)])
    assert np.unique(every).size == every.size


def test_the_optimal_surface_touches_the_near_wall_at_the_floor() -> None:
    """What is drawn of the optimal volume begins at the floor where the wall is nearest to the axis."""
    best = volume(**CHAMBER, eccentricity=2e-3, speed=60.0)
    (liquid,) = surface_figure(best).axes[0].collections
    x, z = np.concatenate([path.vertices for path in liquid.get_paths()]).T
    left, right = (2.0 - 65.0), (2.0 + 65.0)
    # 400 points over 130 mm; the surface is as steep as 2 beta r = 23 there.
    near = z[x < left + 0.5].max(initial=0.0)
    assert near < 0.5 * 23.2 and z[x > right - 0.5].max() == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("factor", "case"), [(1.2, Coverage.MORE), (1.0, Coverage.AS_MUCH), (0.8, Coverage.LESS)]
)
def test_the_case_says_how_much_there_is(factor: float, case: Coverage) -> None:
    best = volume(**CHAMBER, eccentricity=1e-3, speed=60.0).optimal_volume
    surface = volume(**CHAMBER, eccentricity=1e-3, speed=60.0, volume=factor * best).surface
    assert surface is not None and surface.case is case
    assert ("dry" in case.message) == (case is Coverage.LESS)
