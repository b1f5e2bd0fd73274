"""`leblanc optimise`: its table in the scene, its JSON, its files, its words, its figures."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from leblanc.cli import main
from leblanc.core import units
from leblanc.core.blocks import Picture, flat
from leblanc.core.question import called
from leblanc.plotting.page import save_png
from leblanc.scene.scene import load_scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.scene.tasks import Optimisation
from leblanc.studies.optimise.answer import OptimumAnswer
from leblanc.studies.optimise.objectives import AtSpeed
from leblanc.studies.optimise.study import optimise_scene
from tests.oracles.blocks import failed, on_terminal

EXAMPLES = Path(__file__).parents[3] / "examples"


def table(**optimise: object) -> dict[str, object]:
    found = tomllib.loads((EXAMPLES / "washing_machine.toml").read_text(encoding="utf-8"))
    found["speeds"]["count"] = 21
    del found["runup"]
    found["assumed"].remove("runup")
    return found | ({"optimise": optimise} if optimise else {})


def test_the_table_comes_in_si() -> None:
    scene = scene_from_table(
        table(
            objective="robust",
            working_speed="900 rpm",
            temperature=["5 degC", "68 degF"],
            unbalance=["100 kg*mm", 0.2],
            duty=[{"speed": "60 rpm", "weight": 2}],
            volumes=[["10 ml", "0.5 l"]],
            operating=["10 Hz", "12 Hz"],
            clearance="3 mm",
        )
    )
    task = scene.optimise
    assert task is not None
    assert task.temperature == pytest.approx((278.15, 293.15))
    assert task.unbalance == pytest.approx((0.1, 0.2))
    assert (task.duty[0].speed, task.duty[0].weight) == pytest.approx((2.0 * np.pi, 2.0))
    assert task.volumes[0] == pytest.approx((1e-5, 5e-4))
    assert task.operating == pytest.approx((20.0 * np.pi, 24.0 * np.pi))
    assert task.working_speed == pytest.approx(30.0 * np.pi)


def test_a_scene_without_the_table_keeps_its_digest() -> None:
    plain, with_task = scene_from_table(table()), scene_from_table(table(objective="peak"))
    assert with_task.altered(optimise=None).digest == plain.digest
    assert with_task.digest != plain.digest


@pytest.mark.parametrize(
    ("given", "field", "said"),
    [
        ({"objectiv": "peak"}, "optimise.objectiv", "left out or spelled as one of: objective"),
        ({"objective": "best"}, "optimise.objective", "least_mass"),
        ({"duty": [{"speed": "1 m", "weight": 1}]}, "optimise.duty.0.speed", "an angular speed"),
        ({"duty": [{"speed": 1}]}, "optimise.duty.0.weight", "must be given"),
        ({"duty": []}, "optimise.duty", "1 to 1000"),
        ({"temperature": ["60 degC", "5 degC"]}, "optimise.temperature", "the second at least the first"),
        ({"temperature": ["5 C", "6 C"]}, "optimise.temperature", "a temperature such as"),
        ({"temperature": ["-200 degC", "6 degC"]}, "optimise.temperature", "from -123.15 to 726.85 degC"),
        ({"unbalance": ["1 kg*mm"]}, "optimise.unbalance", "a list of two"),
        ({"volumes": [["1 l", "2 m"]]}, "optimise.volumes.0", "a volume"),
        ({"quantile": 1.5}, "optimise.quantile", "from 0 to 1"),
        ({"samples": -1}, "optimise.samples", "a whole number"),
        ({"dry_patch": "no"}, "optimise.dry_patch", "true or false"),
        ({"stability_margin": "1 Hz"}, "optimise.stability_margin", "a rate"),
        ({"clearance": 0}, "optimise.clearance", "from 0.000 000 000 001 to"),
        ({"limit_at": "never"}, "optimise.limit_at", "operating"),
    ],
)
def test_faults_are_named(given: dict[str, object], field: str, said: str) -> None:
    with pytest.raises(SceneError) as caught:
        scene_from_table(table(**given))
    (fault,) = caught.value.faults
    assert fault.field == field
    assert said in str(fault)


def test_temperatures() -> None:
    """The three scales meet where they are defined to."""
    for text, kelvin in (("0 degC", 273.15), ("-40 degF", 233.15), ("-40 °C", 233.15), ("77 K", 77.0)):
        assert units.parse(text, units.TEMPERATURE) == pytest.approx(kelvin, rel=1e-12)
    assert units.parse(300, units.TEMPERATURE) == 300.0


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("scene") / "scene.toml"
    text = (
        (EXAMPLES / "washing_machine.toml").read_text(encoding="utf-8").replace("count = 189", "count = 31")
    )
    file.write_text(text + '\n[optimise]\nstability_margin = "0.01 1/s"\n', encoding="utf-8")
    return file


KEYS = {
    "objective",
    "volume",
    "value",
    "baseline",
    "feasible",
    "constraints",
    "evaluations",
    "pareto",
    "closed_form",
}


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, object]:
    assert main(["optimise", *arguments, "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.out.count("\n") == 1
    found: dict[str, object] = json.loads(captured.out)
    return found


@pytest.mark.usefixtures("undrawn")
def test_json_and_files(scene_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = run(capsys, str(scene_file), "--out", str(tmp_path))
    assert found.keys() >= KEYS
    assert found["objective"] == "working_speed" and found["feasible"] is True
    assert found["value"] < found["baseline"]  # type: ignore[operator]
    constraints = found["constraints"]
    assert isinstance(constraints, dict) and set(constraints) == {"capacity", "stability", "wetting", "spill"}
    for one in constraints.values():
        assert one["satisfied"] == (one["value"] <= one["limit"] * (1.0 + 1e-12))
    assert {one.name for one in tmp_path.iterdir()} == {
        *(
            "contents.json",
            "optimum.nc",
            "objective.svg",
            "front.svg",
            "optimise.html",
        )
    }
    with h5py.File(tmp_path / "optimum.nc") as file:
        judged = file["objective"][...]
        good = (file["excess"][...] <= 0.0) & (file["sure"][...] == 1)
        # The answer is the least of what was judged, but for a margin given up for less liquid.
        assert judged[good].min() >= found["value"] * (1.0 - 3e-6)  # type: ignore[operator]
        assert file["best_volume"][0] == pytest.approx(found["volume"][0])  # type: ignore[index]
        assert file["front_mass"].size == len(found["pareto"])


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("objective", ["peak", "mean", "least_mass", "robust"])
def test_every_objective_answers(
    objective: str, scene_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without anything else in the scene: what is assumed is said."""
    extra = ["--steady"] if objective == "peak" else []
    found = run(
        capsys, str(scene_file), "--objective", objective, "--no-front", "--out", str(tmp_path), *extra
    )
    assert found.keys() >= KEYS
    assert found["objective"] == objective and found["feasible"] is True
    assert bool(found["notes"]) == (objective != "peak")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--objective", "best"], "--objective"),
        (["--deflection", "3 kg"], "--deflection"),
        (["--limit", "0"], "--limit"),
        (["--seed", "-1"], "--seed"),
    ],
)
def test_wrong_options(
    arguments: list[str], said: str, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["optimise", str(scene_file), *arguments]) == 2
    captured = capsys.readouterr()
    assert said in captured.err and "Traceback" not in captured.err


def test_words_tell_what_is_not_feasible(scene_file: Path) -> None:
    scene = load_scene(scene_file)
    best = optimise_scene(scene, task=Optimisation(objective="least_mass", vibration_limit=1e-5), front=False)
    text = on_terminal(best)
    assert "no volumes meet every constraint" in text and "EXCEEDED" in text
    assert "wetting" in text and failed(best)["Constraints exceeded"] == "vibration"


def _optimum(name: str, **task: object) -> OptimumAnswer:
    scene = load_scene(EXAMPLES / f"{name}.toml")
    return optimise_scene(scene.altered(speeds=scene.speeds.altered(count=9)), task=Optimisation(**task))


def _drawn(best: OptimumAnswer, folder: Path) -> list[bytes]:
    folder.mkdir(exist_ok=True)
    pictures = (block for block in flat(best.blocks(), "page") if isinstance(block, Picture))
    return [save_png(called(one.draw)(best), folder, one.name, one.title).read_bytes() for one in pictures]


@pytest.mark.parametrize("name", ["runup", "horizontal_rig"])
def test_figures_hold_what_they_say(name: str, tmp_path: Path) -> None:
    """Curve and map; the same record gives the same bytes."""
    best = _optimum(name)
    first, again = (_drawn(best, tmp_path / folder) for folder in "ab")
    assert len(first) == 2
    assert first == again


def test_figures_without_liquid_or_front(tmp_path: Path) -> None:
    """No liquid is best below the resonance; figures are drawn all the same."""
    best = _optimum("runup", working_speed=15.0)
    assert best.volume[0] == 0.0
    assert best.value == best.baseline
    assert len(_drawn(best, tmp_path)) >= 1
    assert len(_drawn(replace(best, front=None, sweep=None), tmp_path)) == 1


@pytest.mark.usefixtures("undrawn")
def test_what_is_not_allowed_and_what_is_interrupted_have_their_codes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both write and print what comes nearest or what was best so far."""
    rig = str(EXAMPLES / "horizontal_rig.toml")
    limit = ["--objective", "least_mass", "--limit", "1 um", "--no-front", "--out", str(tmp_path / "a")]
    assert main(["optimise", rig, *limit]) == 3
    captured = capsys.readouterr()
    assert "no volumes meet every constraint" in captured.err and "vibration" in captured.err
    assert "these exceed them least" in captured.out and (tmp_path / "a" / "optimum.nc").exists()
    asked, whole = 0, AtSpeed.exact

    def exact(vibration: AtSpeed, volumes: np.ndarray) -> np.ndarray:
        nonlocal asked
        asked += 1
        if asked == 5:
            raise KeyboardInterrupt
        return whole(vibration, volumes)

    monkeypatch.setattr(AtSpeed, "exact", exact)
    assert main(["optimise", rig, "--json", "--out", str(tmp_path / "b")]) == 130
    captured = capsys.readouterr()
    assert json.loads(captured.out)["interrupted"] is True and "interrupted" in captured.err
    assert (tmp_path / "b" / "optimise.html").exists()
