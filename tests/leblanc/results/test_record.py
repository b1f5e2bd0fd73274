"""What a result holds: signs of angles, parts of complex numbers, peaks."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from leblanc.studies.run.answer import peak, phase
from tests.mutants import kills
from tests.oracles.records import DAMPING, MASS, RPM, STIFFNESS, dry_deflection, folded


@kills(
    "leblanc.studies.run.answer:phase",
    "angle = np.angle(deflection)",
    "angle = np.angle(np.conj(deflection))",
)
def test_lag_of_a_damped_rotor() -> None:
    """tan(lag) = C Omega/(K - M Omega^2), between 0 and half a turn [theory: rotor]."""
    speed = np.linspace(100.0, 2000.0, 96) * RPM
    lag = np.arctan2(DAMPING * speed, STIFFNESS - MASS * speed**2)
    # Rounding of two arctangents and of the division before them.
    np.testing.assert_allclose(phase(dry_deflection(speed, MASS)), -lag, rtol=0, atol=1e-14)


@kills("leblanc.studies.run.answer:phase", "angle <= -math.pi, math.pi", "angle <= -math.pi, -math.pi")
def test_phase_lies_in_one_turn() -> None:
    """The interval is open below and closed above; without a deflection the angle is 0."""
    w = np.array([complex(-1.0, -0.0), complex(-1.0, 0.0), complex(-0.0, -0.0), 1j, -1j])
    assert phase(w).tolist() == [math.pi, math.pi, 0.0, 0.5 * math.pi, -0.5 * math.pi]


@kills("leblanc.studies.run.answer:peak", "np.where(known, size, -1.0)", "np.where(known, -size, -1.0)")
def test_peak_is_the_largest() -> None:
    assert peak(np.array([0.1, 0.3j, np.nan, -0.2])) == 1
    assert peak(np.array([np.nan + 0j])) is None


@kills("leblanc.core.netcdf:finite", "[values.real, values.imag]", "[values.imag, values.real]")
@kills("leblanc.core.quantities:to_json", "value[there]", "value[there][::-1]")
def test_json_is_the_record() -> None:
    """Complex numbers go as [re, im]; what was not found as null."""
    record = folded(31)
    r = record.response
    w = np.array(r.deflection)
    w[3] = np.nan
    found = replace(record, response=replace(r, deflection=w)).to_json()
    assert found["deflection"][3] == [None, None]
    assert found["amplitude"][3] is None
    assert found["deflection"][5] == [w[5].real, w[5].imag]
    assert found["liquid_angle"] == r.liquid_angle.tolist()
    for row, deflections, stable in zip(found["branches"], r.branch_deflection, r.branch_stable, strict=True):
        number = np.count_nonzero(~np.isnan(deflections))
        assert row == [[w.real, w.imag] for w in deflections[:number].tolist()]
        assert found["branch_stable"][found["branches"].index(row)] == stable[:number].tolist()


@kills("leblanc.studies.run.answer:RunAnswer.phase_dry", "deflection_dry", "deflection")
@kills("leblanc.core.quantities:_variables", "getattr(values, end)", "values.real")
@kills(
    "leblanc.core.netcdf:flags",
    "np.arange(2 - len(meanings.split()), 2",
    "np.arange(3 - len(meanings.split()), 3",
)
def test_dataset_is_the_record() -> None:
    r = folded(31).response
    data = folded(31).to_dataset()
    # The phase is an angle again after a turn through the exponential, to rounding.
    turn = data["amplitude_dry"].values * np.exp(1j * data["phase_dry"].values)
    np.testing.assert_allclose(turn, r.deflection_dry, rtol=1e-14)
    np.testing.assert_array_equal(data["deflection_real"].values, r.deflection.real)
    np.testing.assert_array_equal(data["deflection_imag"].values, r.deflection.imag)
    states = np.where(np.isnan(r.branch_deflection), -1, r.branch_stable.astype(int))
    np.testing.assert_array_equal(data["branch_stable"].values, states)
    names = data["branch_stable"].attrs["flag_meanings"].split()
    assert dict(zip(names, data["branch_stable"].attrs["flag_values"].tolist(), strict=True)) == {
        "absent": -1,
        "unstable": 0,
        "stable": 1,
    }
    assert data["dry_patch"].attrs["flag_values"].tolist() == [0, 1]
