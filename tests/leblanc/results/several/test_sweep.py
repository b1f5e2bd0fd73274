"""The result of a sweep, on a sample whose quantiles are known."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from leblanc.cli import main
from leblanc.core.terminal import print_json
from leblanc.studies.run.study import run_scene
from leblanc.studies.sweep.answer import QUANTILES, SweepAnswer
from leblanc.studies.sweep.figure import sweep_figure
from leblanc.studies.sweep.store import STORE
from leblanc.studies.sweep.study import answer_sweep
from tests.oracles.data_files import assert_read_back
from tests.oracles.records import RPM
from tests.oracles.sweeps import SCENE, study_in, write_study

# 101 unbalances, evenly from 0.1 to 1.1 kg mm, of a linear machine whose own unbalance is 0.6 kg mm.
STUDY = """
scene = "scene.toml"
method = "grid"

[vary]
"rotor.unbalance" = { linspace = ["0.1 kg*mm", "1.1 kg*mm", 101] }
"""
LINEAR = SCENE.replace('liquid = "statics"', 'liquid = "linear"')
ONE = LINEAR.replace('start = "1200 rpm"', 'start = "1500 rpm"').replace("count = 2", "count = 1")
# The share q of the samples lies below the unbalance 0.1 + q: with 101 of them 5 % is a sample itself.
SHARES = (0.1 + np.array(QUANTILES)) / 0.6


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> SweepAnswer:
    folder = tmp_path_factory.mktemp("sweep")
    return answer_sweep(study_in(folder, STUDY, LINEAR), folder / "out", workers=0)


def test_quantiles_of_a_linear_machine(found: SweepAnswer, tmp_path: Path) -> None:
    own = run_scene(study_in(tmp_path, STUDY, LINEAR).scene)
    quantiles = found.over_speed["amplitude"].quantiles
    # The amplitude is proportional to the unbalance, up to rounding.
    np.testing.assert_allclose(quantiles, own.amplitude[:, None] * SHARES, rtol=1e-10)
    np.testing.assert_allclose(found.outputs["last_amplitude"].mean, own.amplitude[-1], rtol=1e-10)
    assert (found.samples, found.done, found.fields) == (101, 101, ("rotor.unbalance",))


def test_json_is_that_of_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = write_study(tmp_path, STUDY, LINEAR), tmp_path / "out"
    assert main(["sweep", str(path), "--workers", "0", "--netcdf", "--out", str(out), "--json"]) == 0
    printed = capsys.readouterr().out
    result = answer_sweep(study_in(tmp_path, STUDY, LINEAR), out)
    assert all(hasattr(result, key) for key in result.to_json())
    print_json(result.to_json())
    assert capsys.readouterr().out == printed
    assert [*json.loads(printed)] == [
        *(
            "store",
            "name",
            "method",
            "seed",
            "fields",
            "samples",
            "done",
            "failed",
            "not_converged",
            "reasons",
        ),
        *("outputs", "over_speed", "sensitivity", "digest"),
    ]
    copy = xr.open_dataset(out / "sweep.nc", engine="h5netcdf").load()
    for name, values in result.to_dataset().variables.items():
        np.testing.assert_array_equal(copy[name].values, values.values)


def test_the_dataset_is_the_store_and_goes_with_the_result(found: SweepAnswer, tmp_path: Path) -> None:
    assert_read_back(found.named_arrays(), tmp_path)
    again = pickle.loads(pickle.dumps(found)).to_dataset()
    store = xr.open_zarr(found.store, consolidated=False).load()
    assert found.store.name == STORE and dict(again.sizes) == {"sample": 101, "speed": 2}
    np.testing.assert_array_equal(again.amplitude, store.amplitude)
    assert all(one.attrs["units"] and one.attrs["long_name"] for one in again.data_vars.values())
    low, high = np.quantile(store.amplitude, [0.05, 0.95], axis=0)
    np.testing.assert_allclose(found.over_speed["amplitude"].quantiles[:, [0, 4]].T, [low, high], rtol=1e-14)


def test_bands_of_the_figure_are_the_quantiles(found: SweepAnswer) -> None:
    found = replace(found, over_value=None)  # as of more fields than one
    figure = found.plot()
    (axes,) = figure.axes
    quantiles = found.over_speed["amplitude"].quantiles * 1e3
    for band, (low, high) in zip(axes.collections, ((0, 4), (1, 3)), strict=True):
        (path,) = band.get_paths()
        x, y = path.vertices.T
        for speed, between in zip((1200.0, 1500.0), quantiles[:, [low, high]], strict=True):
            at = y[np.abs(x - speed) < 1e-6]
            np.testing.assert_allclose([at.min(), at.max()], between, rtol=1e-12)
    wet, dry = axes.lines
    assert found.speed is not None
    np.testing.assert_allclose(wet.get_xdata(), found.speed / RPM, rtol=1e-12)
    np.testing.assert_array_equal(wet.get_ydata(), quantiles[:, 2])
    np.testing.assert_array_equal(dry.get_ydata(), found.over_speed["amplitude_dry"].quantiles[:, 2] * 1e3)
    assert "101 of 101" in str(figure.caption) and "mm" in figure.alt
    assert figure.alt in found._repr_html_()


def test_boxes_of_one_speed_are_the_quantiles(tmp_path: Path) -> None:
    result = answer_sweep(study_in(tmp_path, STUDY, ONE), tmp_path / "out", workers=0)
    result = replace(result, over_value=None)
    above, below = result.plot().axes
    assert (above.get_xlabel(), below.get_xlabel()) == ("Amplitude (mm 0-p)", "Growth (1/s)")
    assert len(above.patches) == 2  # with and without liquid
    for box, name in zip(above.patches, ("last_amplitude", "last_amplitude_dry"), strict=True):
        low, high = result.outputs[name].quantiles[[1, 3]] * 1e3
        assert (box.get_x(), box.get_x() + box.get_width()) == pytest.approx((low, high), rel=1e-12)
    line = above.lines[0].get_xdata()
    np.testing.assert_allclose(line, result.outputs["last_amplitude"].quantiles[[0, 4]] * 1e3, rtol=1e-12)


def test_speeds_that_differ_give_boxes(tmp_path: Path) -> None:
    study = STUDY.replace(", 101]", ", 5]") + '"speeds.stop" = { linspace = ["1400 rpm", "1600 rpm", 2] }\n'
    result = answer_sweep(study_in(tmp_path, study, LINEAR), tmp_path / "out", workers=0)
    assert result.speed is None and result.samples == 10
    assert [len(axes.patches) for axes in result.plot().axes] == [4, 1]


def test_narrow_resonances_of_a_sweep_are_drawn_wider_below(found: SweepAnswer) -> None:
    """Quantiles in proportion to one another, about a peak of a hundredth of the speeds."""
    rpm = np.linspace(100.0, 6000.0, 3000)
    peak = 1e-3 / np.abs(1.0 - (rpm / 1000.0) ** 2 + 0.02j)
    shares = np.array([0.8, 0.9, 1.0, 1.1, 1.2])
    one = found.over_speed["amplitude"]
    over = {name: replace(one, quantiles=peak[:, None] * shares) for name in ("amplitude", "amplitude_dry")}
    narrow = replace(found, over_value=None, speed=rpm * RPM, over_speed={**found.over_speed, **over})
    whole, wide = sweep_figure(narrow).axes
    low, high = wide.get_xlim()
    assert low < 980.0 and 1020.0 < high < low + 600.0
    for axes in (whole, wide):
        assert axes.get_ylim()[1] > 1.2e3 * peak.max()
        assert np.max(axes.lines[0].get_ydata()) == pytest.approx(1e3 * peak.max(), rel=1e-12)
