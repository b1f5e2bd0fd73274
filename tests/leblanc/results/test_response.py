"""Dataset and JSON of a study: they hold the record, whole and unchanged."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import leblanc as lb
from leblanc.core.blocks import Words
from leblanc.core.files import writing
from leblanc.core.netcdf import write_netcdf
from leblanc.core.units import amplitude_sentence
from leblanc.studies.run.answer import RunAnswer
from meshes.errors import InputError
from tests.oracles.records import folded, record_of, response_of, rig

CONTRACT = [
    "speed",
    "amplitude",
    "amplitude_dry",
    "phase",
    "liquid_offset",
    "liquid_angle",
    "dry_patch",
    "stable",
    "model",
]


@pytest.fixture(scope="module", params=[rig, folded, lambda: rig(1)], ids=["rig", "folded", "one speed"])
def record(request) -> RunAnswer:
    return request.param()


def test_file_holds_what_was_written(record: RunAnswer, tmp_path: Path):
    path = tmp_path / "run.nc"
    write_netcdf(record.named_arrays(), path)
    r = record.response
    with xr.open_dataset(path) as data:
        assert set(data.dims) - {"resonance", "resonance_dry"} == {"speed", "branch"}
        np.testing.assert_array_equal(data["speed"], r.speed)
        np.testing.assert_array_equal(data["deflection_real"] + 1j * data["deflection_imag"], r.deflection)
        np.testing.assert_array_equal(data["branch_real"] + 1j * data["branch_imag"], r.branch_deflection)
        np.testing.assert_array_equal(data["amplitude"], np.abs(r.deflection))
        np.testing.assert_array_equal(data["liquid_offset"], r.liquid_offset)
        np.testing.assert_array_equal(data["liquid_angle"], r.liquid_angle)
        assert data["model"].values.tolist() == r.model.tolist()
        for name in ("dry_patch", "stable", "in_range", "converged"):
            assert data[name].dtype == np.int8
            assert data[name].attrs["flag_meanings"] == "no yes"
            np.testing.assert_array_equal(data[name], getattr(r, name))
        assert data["liquid_mass"].item() == record.liquid_mass
        if record.capture_speed is None:
            assert np.isnan(data["capture_speed"].item())
        else:
            assert data["capture_speed"].item() == record.capture_speed


def test_every_variable_says_what_it_is():
    data = folded().to_dataset()
    for name, variable in data.variables.items():
        assert {"units", "long_name", "description"} <= set(variable.attrs), name
        assert all(variable.attrs[key] for key in ("units", "long_name", "description")), name
    units = {str(name): variable.attrs["units"] for name, variable in data.variables.items()}
    assert units["speed"] == units["critical_speed_dry"] == "rad s-1"
    assert units["amplitude"] == units["branch_real"] == units["liquid_offset"] == "m"
    assert units["phase"] == units["liquid_angle"] == "rad"
    assert units["liquid_mass"] == "kg"


def test_attributes_name_scene_and_versions():
    record = rig()
    attrs = record.to_dataset().attrs
    assert attrs["title"] == record.name
    assert attrs["source"] == record.source
    assert attrs["digest"] == record.digest
    assert attrs["assumed"].split("; ") == list(record.assumed)
    assert "Mass without liquid: 4 kg [rotor.mass]" in attrs["inputs"].splitlines()
    assert attrs["model"] == "statics"
    assert attrs["version_numpy"] == np.__version__
    assert {"version_leblanc", "version_scipy", "Conventions", "history"} <= set(attrs)


def test_same_record_same_bytes(tmp_path: Path):
    files = [tmp_path / "a.nc", tmp_path / "b" / "c.nc"]
    for file in files:
        write_netcdf(folded().named_arrays(), file)
    assert files[0].read_bytes() == files[1].read_bytes()


def test_texts_that_a_file_cannot_carry(tmp_path: Path):
    record = replace(rig(3), name="Schleuder \x00 \N{SNOWMAN}\n2", source="", assumed=(), notes=())
    write_netcdf(record.named_arrays(), tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as data:
        assert data.attrs["title"] == "Schleuder \N{SNOWMAN} 2"
        assert data.attrs["assumed"] == "nothing"


def test_interrupted_writing_leaves_the_old_file(tmp_path: Path):
    path = tmp_path / "summary.html"
    path.write_text("old", encoding="utf-8")
    with pytest.raises(KeyboardInterrupt), writing(path) as temporary:
        temporary.write_text("half", encoding="utf-8")
        raise KeyboardInterrupt
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_json_keeps_its_promise(record: RunAnswer):
    found = json.loads(json.dumps(record.to_json(), allow_nan=False))
    count = record.response.speed.size
    for key in CONTRACT:
        assert len(found[key]) == count, key
    for key in ("in_range", "converged", "branches", "branch_stable", "deflection"):
        assert len(found[key]) == count, key
    assert found["speed"] == record.response.speed.tolist()
    assert all(value is True or value is False for value in found["dry_patch"])
    assert all(-np.pi < angle <= np.pi for angle in found["phase"])
    np.testing.assert_allclose(
        np.array(found["amplitude"]) * np.exp(1j * np.array(found["phase"])),
        record.response.deflection,
        rtol=1e-14,
    )
    assert found["notes"] == [note.text for note in record.notes]
    assert found["capture_speed"] == record.capture_speed


def test_records_that_contradict_themselves_are_refused():
    response = response_of(np.linspace(10.0, 20.0, 5))
    with pytest.raises(InputError, match=r"rotor\.axis"):
        record_of(response, axis="tilted")
    with pytest.raises(InputError, match="at least one speed"):
        record_of(response_of(np.zeros(0)))
    with pytest.raises(InputError, match=r"response\.stable"):
        record_of(replace(response, stable=response.stable[:3]))
    with pytest.raises(InputError, match=r"response\.branch_stable"):
        record_of(replace(response, branch_stable=np.ones((5, 2), dtype=np.bool_)))


def test_amplitudes_are_zero_to_peak() -> None:
    """Each amplitude of a data file, the axis of its figure and the rows of a summary say so."""
    result = lb.run(lb.example("horizontal_rig").replace({"speeds.count": 5}))
    data = result.to_dataset()
    named = [name for name in data.variables if "amplitude" in str(name) and data[name].attrs["units"] == "m"]
    assert {"amplitude", "amplitude_dry", "peak_amplitude", "curve_amplitude"} <= set(named)
    for name in named:
        assert "zero to peak" in data[name].attrs["description"]
    assert result.plot().axes[0].get_ylabel() == "Amplitude (mm 0-p)"
    assert "Amplitudes are zero to peak." in [
        block.text for block in result.blocks() if isinstance(block, Words)
    ]
    assert amplitude_sentence("in a plane") == "Amplitudes are zero to peak, in a plane."
