"""Many values of one number: the same sweep as of a study file, each row that of the machine itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.blocks import Headline, Table
from leblanc.core.units import ML, Unit
from leblanc.studies.sweep.answer import OverValue, SweepAnswer
from leblanc.studies.sweep.plan import load_sweep, study_of, varied, vary_of
from leblanc.studies.sweep.store import STORE
from meshes.errors import InputError
from tests.mutants import kills
from tests.oracles.sweeps import SCENE, tree, write_study

FILLS = "chambers.0.volume=200 ml..2 ml:15"
GRID = """
scene = "scene.toml"
method = "grid"

[vary]
"chambers.0.volume" = { linspace = ["200 ml", "2 ml", 15] }
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> SweepAnswer:
    folder = tmp_path_factory.mktemp("vary")
    write_study(folder, GRID)
    fills = {"chambers.0.volume": "200 ml..2 ml:15"}
    return lb.sweep(folder / "scene.toml", folder / "out", vary=fills, workers=0)


def test_a_machine_that_varies_is_the_sweep_of_a_study_file(tmp_path: Path, found: SweepAnswer) -> None:
    path = write_study(tmp_path, GRID)
    machine = varied(load_sweep(tmp_path / "scene.toml"), vary_of([FILLS]))
    study = load_sweep(path)
    assert (machine.digest, machine.points, machine.fields) == (study.digest, study.points, study.fields)
    own = lb.sweep(path, tmp_path / "out", workers=0)
    assert tree(own.store) == tree(found.store)
    # The store of the one goes on with the other: nothing is left to answer.
    assert main(["sweep", str(tmp_path / "scene.toml"), "--vary", FILLS, "--out", str(tmp_path / "out")]) == 0
    assert tree(own.store) == tree(found.store)


@kills("leblanc.studies.sweep.study:_over_value", "stable[:, -1]", "stable[:, 0]")
@kills("leblanc.studies.sweep.study:_over_value", "value=value[order]", "value=value")
def test_each_row_is_that_of_the_machine_itself(found: SweepAnswer) -> None:
    """The values rise although the grid falls; at some the last speed alone is stable, at some the first."""
    folder, fills = found.store.parents[1], {"chambers.0.volume": "200 ml..2 ml:15"}
    over = lb.sweep(folder / "scene.toml", folder / "out", vary=fills, workers=0).over_value
    assert over is not None and over.stable is not None and over.stable_speeds is not None
    np.testing.assert_allclose(over.value, np.linspace(2e-6, 200e-6, 15), rtol=1e-12)
    for k, volume in enumerate(over.value.tolist()):
        own = lb.run(lb.load_scene(folder / "scene.toml").replace({"chambers.0.volume": volume}))
        assert over.outputs["last_amplitude"][k] == pytest.approx(own.amplitude[-1], rel=1e-9)
        assert over.outputs["last_amplitude_dry"][k] == pytest.approx(own.amplitude_dry[-1], rel=1e-9)
        assert over.outputs["peak_amplitude"][k] == pytest.approx(own.peak["amplitude"], rel=1e-9)
        assert over.stable[k] == own.stable[-1] and over.stable_speeds[k] == np.count_nonzero(own.stable)


def test_a_table_over_the_value_stands_for_quantiles_and_shares(found: SweepAnswer) -> None:
    over, blocks = found.over_value, found.blocks()
    assert over is not None and isinstance(blocks[0], Headline)
    (table,) = [block for block in blocks if isinstance(block, Table) and block.shown == "both"]
    assert len(table.rows) == 12 and [table.rows[k][0] for k in (0, -1)] == ["2", "200"]
    assert tuple(table.head[:3]) == ("volume of chamber 1 (ml)", "at 1500 rpm (mm)", "without liquid")
    values = (over.value * ML).tolist()
    for row in table.rows:
        k = int(np.argmin([abs(float(str(row[0])) - one) for one in values]))
        assert float(str(row[1])) == pytest.approx(1e3 * over.outputs["last_amplitude"][k], rel=1e-3)


def test_the_curve_is_over_the_value(found: SweepAnswer) -> None:
    over = found.over_value
    assert over is not None
    (axes,) = found.plot().axes
    names = ("last_amplitude", "last_amplitude_dry", "peak_amplitude", "peak_amplitude_dry")
    assert axes.get_xlabel() == "volume of chamber 1 (ml)" and axes.get_ylim()[0] == 0.0
    for line, name in zip(axes.lines, names, strict=False):
        np.testing.assert_allclose(line.get_xdata(), over.value * ML, rtol=1e-12)
        np.testing.assert_allclose(line.get_ydata(), over.outputs[name] * 1e3, rtol=1e-12)
        assert (line.get_linestyle() == "-") == (not name.endswith("_dry"))
    unstable = replace(over, stable=np.arange(15) != 3)
    (axes,) = replace(found, over_value=unstable).plot().axes
    assert axes.lines[-1].get_xdata() == pytest.approx([over.value[3] * ML])
    assert len(axes.get_legend_handles_labels()[1]) == 5


def over_of(last: list[float], stable: list[bool] | None = None, options: tuple[str, ...] = ()) -> OverValue:
    count = len(last)
    value = np.arange(count) * (1.0 if options else 1e-5)
    held = None if stable is None else np.array(stable)
    return OverValue(
        *("volume", value, options, Unit("ml", ML), {"last_amplitude": np.array(last)}),
        *(held, None if held is None else held.astype(np.intp)),
    )


NAN, OIL = float("nan"), {"choice": [{"density": 900, "viscosity": 0}, "water"]}


@pytest.mark.parametrize(
    ("last", "stable", "said"),
    [
        (
            [3e-3, 2e-3, 2.5e-3],
            None,
            "Of 3 values of volume the least amplitude at the end, 2 mm, is at 10 ml.",
        ),
        ([3e-3, 2e-3, 2e-3], None, "2 mm, is at 10 ml; more changes nothing (under 0.1 %)."),
        ([3e-3, 2e-3, 2.0019e-3], None, "is at 10 ml; more changes nothing (under 0.1 %)."),
        ([3e-3, 2e-3, 2.0021e-3], None, "is at 10 ml."),
        ([3e-3, 2.001e-3, 2e-3], None, "2.001 mm, is at 10 ml; more changes nothing (under 0.1 %)."),
        ([3e-3, 2e-3, 2e-3, 4e-3], None, "is at 10 ml; up to 20 ml more changes nothing (under 0.1 %)."),
        ([3e-3, 2e-3, 2e-3, NAN], None, "is at 10 ml; up to 20 ml more changes nothing (under 0.1 %)."),
        (
            [3e-3, 2e-3, 2e-3, 2e-3],
            [True, True, True, False],
            "up to 20 ml more changes nothing (under 0.1 %), beyond that it is unstable.",
        ),
        ([3e-3, 2e-3, 1e-3], None, "1 mm, is at 20 ml, the largest of them."),
        ([1e-3, 2e-3, 3e-3], None, "1 mm, is at 0 ml, the smallest of them."),
        (
            [2e-3, 2e-3, 2e-3],
            None,
            "None of 3 values of volume changes the amplitude at the end, 2 mm, by 0.1 %.",
        ),
        ([3e-3, 2e-3, 1e-3, 4e-3], [True, True, False, True], "2 mm, is at 10 ml; what is less is unstable."),
        ([3e-3, 2e-3, 4e-3], [False] * 3, "2 mm, unstable, is at 10 ml."),
        ([NAN, NAN], None, "None of 2 values of volume has an amplitude at the end."),
    ],
)
def test_the_sentence_says_what_is_so(last: list[float], stable: list[bool] | None, said: str) -> None:
    assert over_of(last, stable).sentence("at the end").endswith(said)


def test_words_have_no_order() -> None:
    over = over_of([2e-3, 1e-3, 1e-3], options=("water", "brine", "glycerol"))
    assert over.sentence("at the end").endswith("1 mm, is at brine.")


@pytest.mark.parametrize(
    ("typed", "given"),
    [
        ("rotor.mass=3 kg..5 kg:3", {"linspace": ["3 kg", "5 kg", 3]}),
        ("rotor.mass = 3..5:3", {"linspace": [3, 5, 3]}),
        ("rotor.mass=3 kg, 4 kg", {"choice": ["3 kg", "4 kg"]}),
        ("rotor.mass=3.5,4", {"choice": [3.5, 4]}),
        ('chambers.0.liquid={density=900, viscosity=0},"water"', OIL),
        ("chambers.0.liquid=water,brine", {"choice": ["water", "brine"]}),
    ],
)  # fmt: skip
def test_what_is_typed_is_what_a_study_file_says(typed: str, given: dict[str, Any]) -> None:
    ((own, _),) = vary_of([typed]).values()
    assert own == given
    path, _, values = typed.partition("=")
    assert vary_of({path.strip(): given.get("choice", values)})[path.strip()][0] == given


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("rotor.mass", "PATH=LOW..HIGH:COUNT or PATH=A,B,C"),
        ("", "PATH=LOW..HIGH:COUNT"),
        ("=1..2:3", "PATH=LOW..HIGH:COUNT"),
        ("rotor.mass=3 kg", "--set takes a single value"),
        ("rotor.mass=3 kg..4 kg", "such as rotor.mass='3 kg..4 kg:20'"),
        ("rotor.mass=3 kg..4 kg:2.5", "PATH=LOW..HIGH:COUNT"),
        ("rotor.mass=3 kg..:2", "PATH=LOW..HIGH:COUNT"),
        ("rotor.mass=3 kg..4 kg:1", "a whole number from 2"),
        ("rotor.mass=3..4 kg:3", "all have a unit, or none"),
        ("chambers.0.volume=0,1 l", "all have a unit, or none"),
        ("rotor.mass=3 m..4 m:2", "m measures something else"),
        ("rotor.mass=-1 kg..4 kg:2", "from 0.000 000 001"),
        ("rotor.mas=3 kg..4 kg:2", "did you mean mass?"),
        ("rotor.kind=tub,jeffcott", "other than rotor.kind"),
        ("chambers.0.liquid=waater,water", "did you mean water?"),
        ("rotor.mass=3 kg..4 kg:999999999", "a whole number from 2 to 1000000"),
    ],
)
def test_a_bad_form_is_refused_in_one_line(
    typed: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_study(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", "scene.toml", "--vary", typed]) == 2
    printed = capsys.readouterr()
    (line,) = printed.err.splitlines()
    assert "--vary" in line and "must be" in line and said in line
    assert not (tmp_path / "out").exists()


def test_a_machine_in_which_nothing_varies_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_study(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", "scene.toml"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "--vary" in line and "leblanc new --example studies/fill_grid" in line
    with pytest.raises(InputError, match="vary"):
        lb.sweep(lb.load_scene("scene.toml"))


def test_a_grid_takes_more_and_other_values_and_a_sample_none(tmp_path: Path) -> None:
    study = load_sweep(write_study(tmp_path, GRID))
    more = varied(
        study, vary_of({"rotor.mass": [3.0, 4.0, 5.0], "chambers.0.volume": np.array([1e-6, 2e-6])})
    )
    assert [field.path for field in more.fields] == ["chambers.0.volume", "rotor.mass"]
    assert more.points == 6
    with pytest.raises(InputError, match="left out of a study whose method is sobol"):
        varied(load_sweep(write_study(tmp_path)), vary_of(["rotor.mass=3 kg..4 kg:2"]))
    with pytest.raises(InputError, match="at most 10000000 scenes"):
        varied(study, vary_of(["rotor.mass=3 kg..4 kg:1000000"]))
    with pytest.raises(InputError, match="given once"):
        vary_of(["rotor.mass=3 kg..4 kg:2", "rotor.mass=5 kg,6 kg"])
    with pytest.raises(InputError, match=r"left out where chambers\.1\.liquid varies"):
        varied(study, vary_of(["chambers.1.liquid=water,brine", "chambers.1.liquid.density=900,950"]))
    for wrong in (3, "rotor.mass=1,2", [1, 2], {"rotor.mass": 3.0}, {"rotor.mass": [3.0]}, {3: [1, 2]}):
        with pytest.raises(InputError, match="vary"):
            vary_of(wrong)  # type: ignore[arg-type]


def test_set_changes_the_machine_and_not_that_of_a_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], quick: None
) -> None:
    write_study(tmp_path, GRID, SCENE.replace('"4 kg"', '"5 kg"'))
    monkeypatch.chdir(tmp_path)
    more = ["--set", "rotor.mass=4 kg", "--vary", "chambers.0.volume=200 ml..2 ml:15", "--workers", "0"]
    assert main(["sweep", "scene.toml", *more]) == 0
    write_study(tmp_path, GRID)
    assert main(["sweep", "study.toml", "--workers", "0"]) == 0
    assert tree(Path("out", "Rig", STORE)) == tree(Path("out", "study", STORE))
    capsys.readouterr()
    assert main(["sweep", "study.toml", *more]) == 2
    assert "left out with a study file" in capsys.readouterr().err


def test_a_table_of_a_machine_and_a_machine_are_one(tmp_path: Path) -> None:
    write_study(tmp_path)
    scene = lb.load_scene(tmp_path / "scene.toml")
    fills = vary_of([FILLS])
    assert varied(study_of(scene), fills).digest == varied(study_of(scene.table()), fills).digest
