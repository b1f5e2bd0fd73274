"""The calls of `import leblanc as lb` answer as the commands do, load late and name their keywords."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.answer import versions

ROOT = Path(__file__).parents[2]
RIG = ROOT / "examples" / "horizontal_rig.toml"
WHIRL = {
    "radius": 0.15,
    "volume": "671 ml",
    "height": "50 mm",
    "speed": 40.0,
    "whirl_speed": 32.0,
    "whirl_amplitude": "0.15 mm",
}
MODES = {
    **{name: WHIRL[name] for name in ("radius", "volume", "height", "speed")},
    **{"count": 4, "segments": 32, "layers": 3},
}
VOLUME = {"radius": 0.2, "height": 0.05, "eccentricity": "1 mm", "speed": 90.0, "volume": "40 ml"}
NOT_THE_SAME = {"wall_time"}  # measured

Capture = pytest.CaptureFixture[str]


def command(capsys: Capture, *words: str) -> dict[str, Any]:
    """What the command prints for scripts."""
    assert main([*words, "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def options(given: dict[str, Any]) -> list[str]:
    """Keywords as options of the command line."""
    return [word for name, value in given.items() for word in (f"--{name.replace('_', '-')}", str(value))]


def plain(value: Any) -> Any:
    """A value as JSON has it."""
    if isinstance(value, dict):
        return {name: plain(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, complex):
        return [value.real, value.imag]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    return None if isinstance(value, float) and not np.isfinite(value) else value


def same(result: Any, printed: dict[str, Any]) -> None:
    """The result says what the command printed."""
    found = plain(result.to_json())
    assert found.keys() == printed.keys()
    for name in found.keys() - NOT_THE_SAME:
        assert json.loads(json.dumps(found[name])) == printed[name], name


@pytest.mark.parametrize("name", lb.__all__)
def test_every_public_name_is_documented_and_found(name: str) -> None:
    found = getattr(lb, name)
    assert found.__doc__ and name in dir(lb)


def test_what_is_shown_is_for_readers() -> None:
    assert dir(lb) == sorted(lb.__all__)
    assert lb.__version__ == versions()["leblanc"]
    for name in lb.__all__:
        found = getattr(lb, name)
        if callable(found) and getattr(found, "__signature__", None) is not None:
            said = str(inspect.signature(found))
            assert not any(word in said for word in ("Annotated", "Validator", "Discriminator", "'float")), (
                name
            )
    shown = inspect.signature(lb.layer).parameters
    assert str(shown["speed"]) == "speed: float | str | None = None"
    assert str(shown["friction"]) == "friction: Friction | str | dict | None = None"
    assert "ramp : time over which the whirl grows" in str(inspect.getdoc(lb.layer))
    mass = inspect.signature(lb.JeffcottRotor).parameters["mass"]
    assert str(mass) == "mass: float"


def test_published_cases_are_computed() -> None:
    cases = lb.validate("turning")
    assert cases
    assert {case.verdict for case in cases} <= {"agrees", "erratum", "trend", "differs"}
    with pytest.raises(lb.InputError, match="case = 'turnin'"):
        lb.validate("turnin")


def test_a_name_that_is_not_there() -> None:
    with pytest.raises(AttributeError, match="no attribute 'runn'"):
        lb.runn  # noqa: B018 - the access is what is tested


def test_import_loads_no_library() -> None:
    """Not even numpy, so that the import costs less than numpy's."""
    code = "import sys, leblanc; print(*{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert not loaded & {"numpy", "scipy", "pydantic", "pint", "xarray", "matplotlib", "typer", "rich"}


@pytest.mark.parametrize(
    "scene", [lb.example("horizontal_rig"), str(RIG), RIG], ids=["scene", "text", "path"]
)
def test_run(scene: lb.Scene | str | Path, capsys: Capture, tmp_path: Path) -> None:
    same(lb.run(scene), command(capsys, "run", str(RIG), "--out", str(tmp_path)))


def test_run_of_an_exciter(capsys: Capture, tmp_path: Path) -> None:
    path = ROOT / "examples" / "vibratory_table.toml"
    same(lb.run(path), command(capsys, "run", str(path), "--out", str(tmp_path)))


def test_explain(capsys: Capture) -> None:
    same(lb.explain(RIG), command(capsys, "explain", str(RIG)))


@pytest.mark.parametrize("model", ["linear", "kdv"])
def test_layer(model: str, capsys: Capture) -> None:
    given = WHIRL | {"model": model, "friction": "linear:1.0"} if model == "kdv" else WHIRL | {"model": model}
    same(lb.layer(**given), command(capsys, "layer", *options(given), "--profile"))


def test_modes(capsys: Capture) -> None:
    same(lb.modes(**MODES), command(capsys, "modes", *options(MODES)))


def test_volume(capsys: Capture) -> None:
    same(lb.volume(**VOLUME), command(capsys, "volume", *options(VOLUME)))


def test_map(capsys: Capture, tmp_path: Path) -> None:
    given = {"volumes": 3, "speeds": 5, "max_volume": "20 ml", "friction": "linear:0.5"}
    printed = command(capsys, "map", str(RIG), *options(given), "--out", str(tmp_path))
    same(lb.map_whirl(RIG, **given), printed)
    same(lb.map_whirl(RIG, **given | {"friction": {"linear": 0.5}}), printed)


def test_optimise(capsys: Capture, tmp_path: Path) -> None:
    printed = command(
        capsys, "optimise", str(RIG), "--deflection", "0.5 mm", "--no-front", "--out", str(tmp_path)
    )
    same(lb.optimise(RIG, deflection="0.5 mm", front=False), printed)


def test_compare(capsys: Capture, tmp_path: Path) -> None:
    names = ["statics", "linear", "kdv"]
    printed = command(capsys, "compare", str(RIG), "--models", ",".join(names), "--out", str(tmp_path))
    found = plain(lb.compare(RIG, names).to_json())
    for entry in (*found["models"], *printed["models"]):
        del entry["cpu_time"]  # measured
    assert json.loads(json.dumps(found)) == printed


def test_sweep(capsys: Capture, tmp_path: Path) -> None:
    study = tmp_path / "rigs.toml"
    study.write_text(
        f'scene = "{RIG}"\nmethod = "random"\nsamples = 6\nseed = 3\n'
        '[vary]\n"rotor.mass" = { uniform = [3.0, 5.0] }\n',
        encoding="utf-8",
    )
    words = "--workers", "0", "--out", str(tmp_path / "out")
    printed = command(capsys, "sweep", str(study), *words)
    same(lb.sweep(study, tmp_path / "out", workers=0), printed)


def test_faults_name_the_keyword() -> None:
    with pytest.raises(lb.InputError, match=r"^whirl_speed"):
        lb.layer(**(WHIRL | {"whirl_speed": "32 mm"}))
    with pytest.raises(lb.InputError, match="duration is given"):
        lb.layer(**WHIRL, model="linear", duration=1.0)
    with pytest.raises(lb.InputError, match=r"^objective"):
        lb.optimise(RIG, "speed")
    with pytest.raises(lb.SceneError, match=r"rotor\.mass"):
        lb.example("horizontal_rig").replace({"rotor.mass": "-4 kg"})


def test_a_scene_of_fills_is_the_scene_of_its_table() -> None:
    """Objects of the solvers stand for the tables that describe them."""
    shipped = lb.example("horizontal_rig")
    built = lb.Scene(
        name=shipped.name,
        rotor={"kind": "jeffcott", **shipped.rotor.table()} | {"kind": "jeffcott"},
        chambers=list(shipped.fills),
        speeds=shipped.speeds.table(),
    )
    assert [chamber.fill() for chamber in built.chambers] == list(shipped.fills)
    np.testing.assert_array_equal(lb.run(built).amplitude, lb.run(shipped).amplitude)
