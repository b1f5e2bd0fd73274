"""Cases of bearings and of turning: wear of the bush, three modes with a free scale, modulation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.mutants import kills
from validation.cases.rotors import bearings, turning


@kills("validation.cases.rotors.bearings:rounded_off", "0.5 * bore + outward", "0.5 * bore - outward")
@kills("validation.cases.rotors.bearings:rounded_off", "(1.0 - 0.25 * math.pi)", "0.25 * math.pi")
def test_what_is_rounded_off() -> None:
    """Shell by shell: at the radius x into the wall the edge is lower by r - sqrt(r^2 - (r - x)^2)."""
    radius, bore = 1.5e-3, 0.017
    x = radius * 0.5 * (1.0 - np.cos(math.pi * (np.arange(4000) + 0.5) / 4000))
    width = radius * 0.5 * math.pi / 4000 * np.sin(math.pi * (np.arange(4000) + 0.5) / 4000)
    lower = radius - np.sqrt(radius**2 - (radius - x) ** 2)
    shells = float(np.sum(2.0 * math.pi * (0.5 * bore + x) * lower * width))
    assert bearings.rounded_off(radius, bore) == pytest.approx(shells, rel=1e-5)


@kills("validation.cases.rotors.bearings:load_times_speed", "3600.0 * HOURS", "HOURS")
def test_load_times_speed_wears_the_edge() -> None:
    """Archard's law back again: k P v t is what is missing."""
    for wear in bearings.WEAR.values():
        power = bearings.load_times_speed(1e-3, wear)
        assert wear * power * 300.0 * 3600.0 == pytest.approx(bearings.rounded_off(1e-3, 0.017), rel=1e-12)


@kills("validation.cases.rotors.turning:modal_response", "2j * damping * ratio", "1j * damping * ratio")
@kills("validation.cases.rotors.turning:modal_fit", "/ amplitude", "- amplitude")
def test_a_modal_fit_finds_what_was_put_in() -> None:
    """Amplitudes of three masses on springs, each driven by its own share of one unbalance, added up."""
    speed, resonances = np.array([135.0, 143.0, 152.0, 160.0, 166.0]), np.array([135.0, 152.0, 166.0])
    damping, scale = np.array([0.03, 0.02, 0.04]), 2e-3
    moved = np.zeros(5, dtype=complex)
    for hertz, ratio in zip(resonances, damping, strict=True):
        natural, spin = 2.0 * math.pi * hertz, 2.0 * math.pi * speed
        moved += scale * spin**2 / (natural**2 - spin**2 + 2j * ratio * natural * spin)
    found = turning.modal_fit(speed, np.abs(moved), resonances)
    assert found[0] == pytest.approx(scale, rel=1e-6)
    np.testing.assert_allclose(found[1], damping, rtol=1e-6)


def test_the_five_amplitudes_are_three_modes() -> None:
    """Within their rounding; two amplitudes taken for one another are not."""
    found = {case.name.partition("/")[2]: case for case in turning._modal()}
    assert len(found) == 5 and {case.verdict for case in found.values()} == {"agrees"}
    speed, sizes = np.array([135.0, 143.0, 152.0, 160.0, 166.0]), np.array([13.0, 17.0, 9.0, 12.0, 22.0])
    again = turning.modal_fit(speed, sizes, np.array([135.0, 152.0, 166.0]))[2]
    assert np.abs(again / sizes - 1.0).max() > 0.1


@kills("validation.cases.rotors.turning:power_of_modulation", "2.0 * math.pi * frequency", "frequency")
def test_power_of_a_modulation() -> None:
    """The largest of J Omega dOmega/dt in time, a tenth of a per cent of depth."""
    mean, depth, frequency = 7000.0, 7.0, 3.0
    time = np.linspace(0.0, 1.0 / frequency, 100_001)
    spin = (mean + depth * np.sin(2.0 * math.pi * frequency * time)) * math.pi / 30.0
    power = float(np.max(spin * np.gradient(spin, time)))
    assert turning.power_of_modulation(depth, frequency, mean) == pytest.approx(power, rel=2e-3)


def test_verdicts() -> None:
    found = {case.name.partition("/")[2]: case for case in bearings.cases()}
    assert {name for name, case in found.items() if case.verdict == "differs"} == {
        "load-and-slip",
        "bush-dry",
    }
    assert len(found) == 4
