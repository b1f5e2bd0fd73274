"""The groups `spindle` and `turning`: verdicts that follow from the numbers."""

from __future__ import annotations

from itertools import islice

import pytest

from tests.mutants import kills
from validation.cases.rotors import spindle, turning


def test_table_of_the_bearing() -> None:
    found = {case.name: case for case in spindle.cases()}
    verdicts = {name.partition("/")[2]: case.verdict for name, case in found.items()}
    assert (
        verdicts["bpfo"] == "erratum" and verdicts["bpfi"] == verdicts["bsf"] == verdicts["balls"] == "agrees"
    )
    assert verdicts["bsf-15-degrees"] == verdicts["bsf-25-degrees"] == "differs"
    assert verdicts["eq-14"] == "erratum" and verdicts["matrix"] == "agrees" and verdicts["flat"] == "trend"
    computed = {name: found[f"spindle/{name}"].computed for name in ("bpfo", "bsf", "bsf-15-degrees")}
    # By hand: 33/(9 33/85.77) = 9.530; d/D = 0.2305.
    assert list(computed.values()) == pytest.approx([9.530, 16.07, 16.63], abs=5e-3)


@kills("leblanc.core.units:_scaled", "else number * factor", "else 1.05 * number * factor")
@kills("solvers.rotor.shaft.natural:natural_frequencies", "return _found", "return 1.05 * _found")
def test_multiples_of_the_speed() -> None:
    """The example's first natural frequency is the 33 Hz of the table, and 660 rpm are a third of it."""
    found = {case.name.partition("/")[2]: case.verdict for case in islice(spindle.cases(), 4)}
    assert found == dict.fromkeys(("harmonic-1", "harmonic-2", "harmonic-3", "speed"), "agrees")


def test_speeds_of_turning() -> None:
    assert turning.speed(300.0 / 60.0, 0.020) * 60.0 == pytest.approx(4775.0, abs=0.5)
    found = {case.name.partition("/")[2]: case for case in turning.cases()}
    assert found["300-m-min"].verdict == "agrees" and found["modulation"].verdict == "erratum"
    assert {found[f"resonance-{hertz}"].verdict for hertz in (135, 152, 166)} == {"agrees"}


def test_damping_by_two_amplitudes() -> None:
    """A mode with the damping found answers off resonance with the share of its answer at resonance."""
    for off in (120.0, 143.0):
        damping, ratio = turning.single_mode_damping(135.0, off, 0.6), off / 135.0
        answer = ratio**2 / abs(1.0 - ratio**2 + 2j * damping * ratio)
        assert answer * 2.0 * damping == pytest.approx(0.6, rel=1e-12)
