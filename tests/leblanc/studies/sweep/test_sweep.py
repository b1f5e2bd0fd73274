"""A sweep and its store: every sample answered once, whatever happens to others or to the process."""

from __future__ import annotations

import json
import math
import signal
import sys
from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import leblanc as lb
from leblanc.cli import main
from leblanc.core.quantities import quantities
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import read_toml
from leblanc.scene.schema.paths import keys_of, with_values
from leblanc.studies.run.study import run_scene
from leblanc.studies.sweep.answer import QUANTILES
from leblanc.studies.sweep.block import (
    DONE,
    FAILED,
    NOT_CONVERGED,
    PENDING,
    STATUS,
    Block,
    answer_block,
    make_scenes,
    scene_maker,
)
from leblanc.studies.sweep.outputs import Answers, Kept, RunupAnswers, kept_of
from leblanc.studies.sweep.sampling import sample_rows
from leblanc.studies.sweep.store import STORE, block_size, locked, open_store, read_store
from leblanc.studies.sweep.study import run_sweep, statistics, summarise
from meshes.errors import InputError
from tests.mutants import kills
from tests.oracles.sweeps import ROOT, STUDY, added_mass_answers, study_in, tree, write_study

Capture = pytest.CaptureFixture[str]
SMALL = STUDY.replace("samples = 256", "samples = 8")
ONE_FIELD = STUDY[: STUDY.index('"rotor.mass"')]


def run_all(folder: Path, study: str = STUDY) -> Path:
    run_sweep(study_in(folder, study), folder / "out", workers=0)
    return folder / "out" / STORE


# -- scenes --------------------------------------------------------------------------------------------------


@kills("leblanc.studies.sweep.block:scene_maker", "parts[k] = type(parts[k])", "parts[0] = type(parts[0])")
@kills("leblanc.studies.sweep.block:scene_maker", 'if ("rotor",) in touched:', "if not touched:")
def test_sampled_scenes_are_those_of_the_whole_table() -> None:
    """A scene made by parts is the one that the whole table gives."""
    for name, values in (
        ("horizontal_rig", {"rotor.mass": 5.0, "chambers.1.volume": 2e-5, "chambers.1.liquid": "brine"}),
        ("horizontal_rig", {"gravity": 1.6, "speeds.start": 20.0, "model.friction": "none"}),
        ("washing_machine", {"rotor.damping": 200.0, "chambers.0.inner_radius": 0.16}),
        ("tub", {"rotor.drum_mass": 13.0, "rotor.tub_inertia.1": 2.0}),
        ("two_plane_rig", {"rotor.supports.1.stiffness": 5e4, "chambers.0.plane": -0.3}),
    ):
        table = read_toml(ROOT / "examples" / f"{name}.toml")
        changes = [(keys_of(path), value) for path, value in values.items()]
        whole = scene_from_table(with_values(table, changes))
        made = scene_maker(table, [keys for keys, _ in changes])([value for _, value in changes])
        assert made == whole.altered(source=made.source, assumed=made.assumed, runup=made.runup)


@given(mass=st.floats(-1.0, 10.0), volume=st.floats(-1e-5, 6e-4))
def test_a_sample_fails_where_its_scene_does_and_in_the_same_words(mass: float, volume: float) -> None:
    table = read_toml(ROOT / "examples" / "horizontal_rig.toml")
    paths = [keys_of("rotor.mass"), keys_of("chambers.0.volume")]
    (made,), (reason,) = make_scenes(scene_maker(table, paths), [(mass, volume)])
    capacity = math.pi * 0.065**2 * 0.02
    good = mass >= 1e-9 and 0.0 <= volume <= capacity * (1.0 + 1e-9)
    assert (made is not None) == good
    assert (reason == "") == good
    assert ("rotor.mass = " in reason) == (mass < 1e-9)
    assert ("at most what the chamber holds" in reason) == (volume > capacity * (1.0 + 1e-9))


# -- answers -------------------------------------------------------------------------------------------------


@kills("leblanc.studies.sweep.block:answer_block", "getattr(found, name)", "getattr(found, name)[::-1]")
@kills("leblanc.studies.sweep.outputs:Answers.peak_growth", "np.fmax.reduce", "np.fmin.reduce")
@kills("leblanc.studies.sweep.outputs:Answers.last_amplitude", "[:, -1]", "[:, 0]")
@kills(
    "leblanc.studies.sweep.study:write_answer",
    "field_values(field, drawn[:, j])",
    "field_values(field, drawn[::-1, j])",
)
def test_answers_stand_at_their_samples(tmp_path: Path) -> None:
    """Each row of the store is what `run` says of the scene with the values of that row."""
    found = xr.open_zarr(run_all(tmp_path, SMALL), consolidated=False).load()
    assert (found.status == DONE).all()
    table = read_toml(tmp_path / "scene.toml")
    for k in range(8):
        row = found.isel(sample=k)
        liquid = str(row["chambers.1.liquid"].values)
        values = {
            "rotor.mass": float(row["rotor.mass"]),
            "chambers.0.volume": float(row["chambers.0.volume"]),
            "chambers.1.liquid": json.loads(liquid) if liquid.startswith("{") else liquid,
        }
        record = run_scene(
            scene_from_table(with_values(table, [(keys_of(path), one) for path, one in values.items()]))
        )
        # The same formulas on arrays of another shape: the order of sums may differ, and roots are found to
        # a relative 1e-10 or so.
        np.testing.assert_allclose(row.speed, record.response.speed, rtol=1e-15)
        for name, expected in (
            ("amplitude", record.amplitude),
            ("amplitude_dry", record.amplitude_dry),
            ("liquid_offset", record.response.liquid_offset),
            ("liquid_angle", record.response.liquid_angle),
        ):
            np.testing.assert_allclose(row[name], expected, rtol=1e-8)
        for name in ("dry_patch", "stable", "in_range"):
            np.testing.assert_array_equal(row[name] == 1, getattr(record.response, name))
        assert row.model.values.tolist() == ["statics", "statics"]
        # Between the two speeds as well; where a curve is highest it is flat, and its size as exact as above.
        assert float(row.peak_amplitude) == pytest.approx(record.peak["amplitude"], rel=1e-8)
        assert float(row.peak_amplitude_dry) == pytest.approx(record.peak_dry["amplitude"], rel=1e-8)
        assert row.last_amplitude == row.amplitude[-1]
        assert row.last_amplitude_dry == row.amplitude_dry[-1]
        assert row.peak_growth == row.growth.max()


@pytest.mark.usefixtures("quick")
def test_the_store_says_what_it_holds(tmp_path: Path) -> None:
    path = run_all(tmp_path)
    found = xr.open_zarr(path, consolidated=False)
    assert dict(found.sizes) == {"sample": 256, "speed": 2}
    for name, variable in found.variables.items():
        assert variable.attrs["units"], name
        assert variable.attrs["long_name"], name
    assert found["rotor.mass"].attrs["units"] == "kg"
    assert found.status.attrs["flag_meanings"].split() == list(STATUS)
    assert found.attrs["digest"] == study_in(tmp_path).digest
    assert found.attrs["seed"] == "11"
    assert {"version_leblanc", "version_numpy", "version_scipy", "version_zarr"} <= set(found.attrs)
    rows = sample_rows(study_in(tmp_path))(0, 256)
    np.testing.assert_array_equal(found["rotor.mass"], rows[:, 0])
    words = ["water", "brine", '{"density": 900, "viscosity": 0}']
    assert found["chambers.1.liquid"].values.tolist() == [words[int(k)] for k in rows[:, 2]]
    assert read_store(path).samples == 256


@pytest.mark.usefixtures("quick")
def test_speeds_may_differ_from_sample_to_sample(tmp_path: Path) -> None:
    study = SMALL.replace(
        '"rotor.mass"', '"speeds.stop" = { uniform = ["1300 rpm", "1600 rpm"] }\n"rotor.mass"'
    )
    found = xr.open_zarr(run_all(tmp_path, study), consolidated=False)
    np.testing.assert_array_equal(found.speed[:, -1], found["speeds.stop"])
    summary = summarise(read_store(tmp_path / "out" / STORE), study_in(tmp_path, study))
    assert summary.speed is None


@given(samples=st.integers(1, 10_000_000), speeds=st.integers(1, 100_000))
def test_blocks_are_neither_large_nor_many(samples: int, speeds: int) -> None:
    block = block_size(samples, speeds)
    assert 1 <= block <= 4096
    assert block == 1 or block * speeds <= 16_384
    assert block >= min(64, samples) or block * speeds > 16_384 - speeds


# -- what goes wrong -----------------------------------------------------------------------------------------


@pytest.mark.usefixtures("quick")
def test_a_sample_that_breaks_a_rule_is_recorded_and_the_rest_is_done(
    tmp_path: Path, capsys: Capture
) -> None:
    study = STUDY.replace('"250 ml"', '"300 ml"')  # the chamber holds 265.5 ml
    path = write_study(tmp_path, study)
    assert main(["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "out"), "--json"]) == 0
    found = xr.open_zarr(tmp_path / "out" / STORE, consolidated=False).load()
    too_much = found["chambers.0.volume"].values > math.pi * 0.065**2 * 0.02
    assert 0 < too_much.sum() < 256
    np.testing.assert_array_equal(found.status.values, np.where(too_much, FAILED, DONE))
    np.testing.assert_array_equal(np.isnan(found.amplitude).all("speed"), too_much)
    assert (found.stable.values[too_much] == -1).all()
    for reason in found.reason.values[too_much]:
        assert reason.startswith("chambers.0.volume = 0.000")
        assert "must be at most what the chamber holds" in reason
    assert (found.reason.values[~too_much] == "").all()
    said = json.loads(capsys.readouterr().out)
    assert said["failed"] == too_much.sum()
    (one,) = said["reasons"]
    assert one["samples"] == too_much.sum()
    assert main(["sweep", str(path), "--out", str(tmp_path / "out")]) == 0
    assert f"note: {too_much.sum()} of 256 samples: chambers.0.volume" in capsys.readouterr().out


def failing(scenes: Sequence[Scene]) -> Answers:
    """One mass breaks the solver, alone or among others."""
    if any(scene.rotor.mass == 7.0 for scene in scenes):  # type: ignore[union-attr]
        raise ZeroDivisionError(f"in {object()}")
    return added_mass_answers(scenes)


def unsettled(scenes: Sequence[Scene]) -> Answers:
    """At the last speed of one mass nothing is found."""
    found = added_mass_answers(scenes)
    lost = np.array([[False, scene.rotor.mass == 7.0] for scene in scenes])  # type: ignore[union-attr]
    amplitude = np.where(lost, np.nan, found.amplitude)
    return replace(found, converged=~lost, amplitude=amplitude, peak_amplitude=np.nanmax(amplitude, axis=1))


CHOICE = ONE_FIELD.replace("samples = 256", "samples = 64") + '"rotor.mass" = { choice = [5, 7, 9, 11] }\n'


def test_an_unexpected_error_fells_its_own_sample_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("leblanc.studies.sweep.batch.answer_scenes", failing)
    found = xr.open_zarr(run_all(tmp_path, CHOICE), consolidated=False).load()
    struck = found["rotor.mass"].values == 7.0
    assert struck.sum() == 16  # a quarter of a power of two of Sobol points
    np.testing.assert_array_equal(found.status.values == FAILED, struck)
    assert set(found.reason.values[struck]) == {"ZeroDivisionError: in <object object at 0x...>"}
    np.testing.assert_array_equal(np.isfinite(found.amplitude).all("speed"), ~struck)
    assert (found.status.values[~struck] == DONE).all()


def test_what_converged_of_a_sample_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("leblanc.studies.sweep.batch.answer_scenes", unsettled)
    found = xr.open_zarr(run_all(tmp_path, CHOICE), consolidated=False).load()
    struck = found["rotor.mass"].values == 7.0
    np.testing.assert_array_equal(found.status.values == NOT_CONVERGED, struck)
    assert set(found.reason.values[struck]) == {"no bounded deflection found at 1 of 2 speeds"}
    assert np.isfinite(found.amplitude.values[struck, 0]).all()
    np.testing.assert_array_equal(found.peak_amplitude.values[struck], found.amplitude.values[struck, 0])
    assert np.isnan(found.last_amplitude.values[struck]).all()


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        ('"chambers.0.volume" = { uniform = ["300 ml", "400 ml"] }', 2, "some sample is a scene"),
        ('"rotor.mass" = { choice = [7] }', 3, "no sample converged"),
    ],
)
def test_without_any_sample_done_the_sweep_failed(
    line: str, code: int, said: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("leblanc.studies.sweep.batch.answer_scenes", unsettled)
    path = write_study(tmp_path, ONE_FIELD + line)
    assert main(["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "out")]) == code
    assert said in capsys.readouterr().err


def test_what_no_sample_can_answer_is_one_fault(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "scene.toml").write_text("")
    path = write_study(tmp_path)
    scene = tmp_path / "scene.toml"
    cut = "[[chambers]]\nbaffles = { count = 4 }"
    scene.write_text(scene.read_text().replace("[[chambers]]", cut), encoding="utf-8")
    assert main(["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "out")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('scene.toml: model.liquid = "statics": must be auto, linear or fem')


def test_number_height_and_angle_of_baffles_vary(tmp_path: Path) -> None:
    """Each sample is the run of its own scene, its compartments by elements, two of them refused."""
    base = (Path(__file__).parents[4] / "docs" / "examples" / "closed_baffles.toml").read_text(
        encoding="utf-8"
    )
    base = base.replace("count = 41", "count = 1").replace('"200 rpm"', '"1200 rpm"')
    (tmp_path / "scene.toml").write_text(base, encoding="utf-8")
    study = """scene = "scene.toml"
method = "grid"
[vary]
"chambers.0.baffles.count" = { choice = [2, 3] }
"chambers.0.baffles.tip_radius" = { linspace = ["141 mm", "179 mm", 2] }
"chambers.0.baffles.first_angle" = { linspace = ["0 deg", "10 deg", 2] }
"""
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")
    lb.sweep(tmp_path / "study.toml", tmp_path / "out", workers=0)
    found = xr.open_zarr(tmp_path / "out" / STORE, consolidated=False).load()
    assert found.sizes["sample"] == 8
    scene = lb.load_scene(tmp_path / "scene.toml")
    paths = [f"chambers.0.baffles.{name}" for name in ("count", "tip_radius", "first_angle")]
    for k in range(8):
        values = {path: found[path].values[k].item() for path in paths}
        cut = values[paths[1]] < 0.15
        if values[paths[0]] == 2 and cut:
            assert found["status"].values[k] != 0 and "two directions" in str(found["reason"].values[k])
            continue
        record = run_scene(scene.replace({**values, paths[0]: int(values[paths[0]])}))
        np.testing.assert_allclose(found["amplitude"].values[k], record.amplitude, rtol=1e-9)
        # No error is known of compartments.
        assert record.error_estimate is not None and np.isnan(record.error_estimate).any() == cut


# -- going on ------------------------------------------------------------------------------------------------


class Killed(BaseException):
    """The process ends here."""


@pytest.mark.usefixtures("quick")
def test_a_stopped_sweep_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A sweep stopped anywhere ends the same, and no finished block is answered again."""
    import leblanc.studies.sweep.study as sweeps
    from leblanc.studies.sweep.store import write_block

    (tmp_path / "whole").mkdir()
    whole = tree(run_all(tmp_path / "whole"))
    sweep = study_in(tmp_path)
    answered: list[float] = []

    def counting(scenes: Sequence[Scene]) -> Answers:
        answered.extend(scene.rotor.mass for scene in scenes)  # type: ignore[union-attr]
        return added_mass_answers(scenes)

    def two_blocks(store, number, variables, status) -> None:  # type: ignore[no-untyped-def]
        if number == 2:
            del variables["amplitude"]  # half of it is written
            monkeypatch.setattr("leblanc.studies.sweep.store._to_disk", stop)
        write_block(store, number, variables, status)

    def stop(_: Path) -> None:
        raise Killed

    monkeypatch.setattr("leblanc.studies.sweep.batch.answer_scenes", counting)
    with monkeypatch.context() as patch:
        patch.setattr(sweeps, "write_block", two_blocks)
        patch.setattr("leblanc.studies.sweep.store._to_disk", lambda _: None)
        with pytest.raises(Killed):
            run_sweep(sweep, tmp_path / "out", workers=0)
    monkeypatch.setattr("leblanc.studies.sweep.store._to_disk", lambda _: None)
    path = tmp_path / "out" / STORE
    (path / "amplitude" / "c" / "2.0123.partial").write_bytes(b"left over")
    assert np.count_nonzero(read_store(path).read("status") != PENDING) == 128
    assert tree(path) != whole
    before = len(answered)
    run_sweep(sweep, tmp_path / "out", workers=0)
    assert tree(path) == whole
    # the two blocks that were not finished, and the scene itself that is tried before
    assert len(answered) - before == 128 + 1
    run_sweep(sweep, tmp_path / "out", workers=0)
    assert len(answered) - before == 128 + 1


class Unlucky:
    """A Ctrl-C comes while it is destroyed."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


@pytest.fixture
def heard() -> Iterator[None]:
    """Interrupts are heard even where the tests run in the background of a shell, which ignores them."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("quick", "heard")
def test_an_interrupt_that_python_drops_ends_the_sweep(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    dropped = []
    monkeypatch.setattr(sys, "unraisablehook", lambda one: dropped.append(one.exc_type))
    sweep, before = study_in(tmp_path), signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        lb.sweep(sweep, tmp_path / "out", workers=0, progress=lambda done, _: done == 128 and Unlucky())
    assert not dropped  # nor does anything else tell of it
    assert signal.getsignal(signal.SIGINT) is before
    assert np.count_nonzero(read_store(tmp_path / "out" / STORE).read("status") == DONE) == 128


@pytest.mark.usefixtures("quick")
def test_another_study_does_not_go_on_with_the_store(tmp_path: Path, capsys: Capture) -> None:
    run_all(tmp_path)
    before = tree(tmp_path / "out" / STORE)
    path = write_study(tmp_path, STUDY.replace("seed = 11", "seed = 12"))
    command = ["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "out")]
    assert main(command) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "which have changed since; --fresh starts anew" in line
    assert tree(tmp_path / "out" / STORE) == before
    assert main([*command, "--fresh", "--scheduler", "nowhere"]) == 2
    assert "--scheduler" in capsys.readouterr().err
    assert tree(tmp_path / "out" / STORE) == before  # not thrown away for a cluster that is not there
    assert main([*command, "--fresh"]) == 0
    assert read_store(tmp_path / "out" / STORE).attributes()["seed"] == "12"


@pytest.mark.usefixtures("quick")
def test_other_versions_do_not_go_on_with_the_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run_all(tmp_path)
    monkeypatch.setattr(
        "leblanc.studies.sweep.store.versions", lambda names: dict.fromkeys(names, "0") | {"leblanc": "99.0"}
    )
    with pytest.raises(InputError, match=r"written with leblanc 99\.0, not"):
        open_store(tmp_path / "out", study_in(tmp_path))


@pytest.mark.usefixtures("quick")
def test_a_store_half_made_or_half_removed_is_made_anew(tmp_path: Path) -> None:
    (tmp_path / "out" / f".{STORE}.part" / "speed").mkdir(parents=True)
    path = run_all(tmp_path)
    assert not (tmp_path / "out" / f".{STORE}.part").exists()
    assert (read_store(path).read("status") == DONE).all()


def test_two_sweeps_do_not_write_one_store(tmp_path: Path) -> None:
    with locked(tmp_path), pytest.raises(InputError, match="no other sweep runs"), locked(tmp_path):
        pass
    with locked(tmp_path):
        pass


def test_what_is_no_store_is_not_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the store of a sweep"):
        read_store(tmp_path / STORE)


# -- what comes out ------------------------------------------------------------------------------------------


@kills("leblanc.studies.sweep.study:statistics", "known.std(ddof=1)", "known.std()")
@kills("leblanc.studies.sweep.study:statistics", "values[np.isfinite(values)]", "values[~np.isnan(values)]")
def test_statistics_of_known_numbers() -> None:
    """Of the numbers 1 to 101: mean 51, variance 101 * 102/12, quantiles evenly spaced."""
    values = np.random.default_rng(1).permutation(np.append(np.arange(1.0, 102.0), [np.nan, np.inf]))
    found, none = statistics(values), statistics(np.full(103, np.nan))
    assert (found.count, none.count) == (101, 0)
    assert found.mean == pytest.approx(51.0, rel=1e-14)
    assert found.deviation == pytest.approx(math.sqrt(101.0 * 102.0 / 12.0), rel=1e-14)
    np.testing.assert_allclose(found.quantiles, 1.0 + 100.0 * np.array(QUANTILES), rtol=1e-14)
    assert np.isnan([none.mean, *none.quantiles]).all()


@pytest.mark.usefixtures("quick")
def test_uncertainty_of_a_linear_output(tmp_path: Path) -> None:
    """The amplitude is proportional to the unbalance: so are its mean, deviation and quantiles."""
    study = ONE_FIELD.replace("sobol", "latin_hypercube").replace("256", "1000")
    study += '"rotor.unbalance" = { normal = ["0.6 kg*mm", "0.06 kg*mm"] }\n'
    sweep = study_in(tmp_path, study)
    summary = summarise(run_sweep(sweep, tmp_path / "out", workers=0), sweep)
    own = added_mass_answers([sweep.scene]).amplitude[0]
    found = summary.over_speed["amplitude"]
    # One sample in each of 1000 strata: the error of the mean is below 1e-4 of the deviation, that of the
    # deviation below one in a thousand, where the outermost strata decide.
    np.testing.assert_allclose(found.mean, own, rtol=1e-4)
    np.testing.assert_allclose(found.deviation, 0.1 * own, rtol=5e-3)
    np.testing.assert_allclose(found.quantiles[:, 2], own, rtol=1e-3)
    np.testing.assert_allclose(found.quantiles[:, 4], own * (1.0 + 0.16448536), rtol=1e-3)
    assert summary.outputs["last_amplitude"].mean == found.mean[-1]
    assert summary.speed is not None
    shares = summary.sensitivity["last_amplitude"]
    assert shares is not None
    # Sorted up and down, a normal output has its tails at the turning points: ten harmonics hold 98 % of it.
    assert shares.first[0] > 0.97


@pytest.mark.usefixtures("quick")
def test_json_is_one_object_and_the_same_each_time(tmp_path: Path, capsys: Capture) -> None:
    path = write_study(tmp_path)
    command = ["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "out"), "--json"]
    assert main(command) == 0
    first = capsys.readouterr()
    assert main(command) == 0
    second = capsys.readouterr()
    assert first.out == second.out
    said = json.loads(first.out)
    assert said["samples"] == said["done"] == 256
    assert said["fields"] == ["rotor.mass", "chambers.0.volume", "chambers.1.liquid"]
    assert len(said["over_speed"]["amplitude"]["mean"]) == len(said["over_speed"]["speed"]) == 2
    assert said["outputs"]["last_amplitude"]["mean"] > 0.0
    assert len(said["sensitivity"]["peak_amplitude"]["first"]) == 3
    assert "\r" not in first.err


@pytest.mark.usefixtures("quick")
def test_the_copy_holds_what_the_store_holds(tmp_path: Path) -> None:
    path = write_study(tmp_path)
    command = ["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "out"), "--netcdf"]
    assert main(command) == 0
    with xr.open_dataset(tmp_path / "out" / "sweep.nc", engine="h5netcdf") as copy:
        store = xr.open_zarr(tmp_path / "out" / STORE, consolidated=False)
        assert copy.attrs["digest"] == store.attrs["digest"]
        machine = {
            str(name) for name in copy.variables if str(name).startswith("machine_")
        }  # of the copy alone
        assert set(copy.variables) - machine == set(store.variables)
        for name in store.variables:
            one, other = copy[name].values, store[name].values
            assert one.tolist() == other.tolist() or np.array_equal(one, other, equal_nan=True), name
            assert copy[name].attrs["units"] == store[name].attrs["units"]


@kills(
    "leblanc.studies.sweep.block:answer_block",
    "getattr(found, name)",
    'getattr(found, name) if name != "peak_amplitude" else found.amplitude.max(axis=1)',
)
def test_peaks_are_those_between_the_speeds() -> None:
    """Two speeds, one on either side of the resonance."""
    scene = example("horizontal_rig").replace({"speeds.count": 2})
    record = run_scene(scene)
    kept = answer_block(Block(0, scene.table(), (), ((),), kept_of(scene))).values
    for name, found in (("amplitude", record.peak), ("amplitude_dry", record.peak_dry)):
        (peak,) = kept[f"peak_{name}"]
        # The same roots from arrays of another shape, found to a relative 1e-10 or so.
        assert peak == pytest.approx(found["amplitude"], rel=1e-8)
        assert peak > 2.0 * kept[name].max()


def test_every_output_of_a_batch_is_kept() -> None:
    for kind in (Answers, RunupAnswers):
        every = frozenset(q.when for q in quantities(kind).values() if q.when)
        kept = set(Kept(kind, every, 1).outputs)
        assert {field.name for field in fields(kind)} - {"reasons"} <= kept
