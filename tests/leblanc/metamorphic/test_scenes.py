"""Machines that must answer alike: other units, similar machines, chambers split or in another order.

Nothing here knows what the answer is; only what must not change it. The scales are powers of two, so that a
similar machine differs in the exponents of its numbers alone. What is left is rounding: 1e-12 of the largest
number of its kind leaves some hundred roundings, amplified ten times at a resonance of five per cent.
"""

from __future__ import annotations

import copy
import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from tests.oracles.alike import assert_alike
from tests.oracles.commands import numbers, optimum, run, runup, whirl_map
from tests.oracles.machines import (
    JEFFCOTT,
    MACHINES,
    TWO_PLANE,
    in_other_units,
    reordered,
    scaled,
    split,
    turned,
)

ROUNDING = 1e-12
# Length, mass, time: a large slow machine of a thin liquid, a small fast one of a thick liquid.
SCALES = [(8.0, 0.25, 64.0), (0.5, 8.0, 0.0625)]
COMMANDS = {"run": run, "map": whirl_map}
# Kept apart from the rest for the splits: a partition adds a floor and a lid, on which the liquid would rub.
NO_WALLS = {"linear": 0.5}


def with_model(table: dict[str, Any], **model: Any) -> dict[str, Any]:
    """The machine with another liquid model or friction."""
    found = copy.deepcopy(table)
    found["model"] |= model
    return found


def upright(table: dict[str, Any]) -> dict[str, Any]:
    """The machine with its axis along gravity: the run-up of a layer across it is that of a pool at first."""
    found = copy.deepcopy(table)
    found["rotor"]["axis"] = "vertical"
    return found


@cache
def as_given(command: str, machine: str) -> Any:
    """What a command answers to a machine as it stands."""
    return COMMANDS[command](MACHINES[machine])


ONE_CHAMBER = JEFFCOTT | {"chambers": JEFFCOTT["chambers"][:1]}


@cache
def one_chamber() -> Any:
    """Its best volume."""
    return optimum(ONE_CHAMBER)


def rubbing(liquid: str) -> dict[str, Any]:
    """A standing machine without walls to rub on."""
    return upright(with_model(JEFFCOTT, liquid=liquid, friction=NO_WALLS))


@cache
def run_up_of(liquid: str) -> Any:
    """Its run-up."""
    return runup(rubbing(liquid))


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("command", COMMANDS)
def test_units(command: str, machine: str) -> None:
    """What is written in millimetres and rpm is read to a few roundings."""
    answer = as_given(command, machine)
    assert_alike(COMMANDS[command](in_other_units(MACHINES[machine])), answer, ROUNDING)


@pytest.mark.parametrize("scales", SCALES, ids=["large", "small"])
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("command", COMMANDS)
def test_similar_machines(command: str, machine: str, scales: tuple[float, float, float]) -> None:
    """Buckingham: equal numbers without dimension, equal answers without dimension."""
    answer = as_given(command, machine)
    assert_alike(COMMANDS[command](scaled(MACHINES[machine], scales)), answer, ROUNDING, scales)


@pytest.mark.parametrize("scales", SCALES, ids=["large", "small"])
def test_similar_machines_by_statics(scales: tuple[float, float, float]) -> None:
    """The exact static surface, dry patches included: a fifth of the liquid, ten times the unbalance."""
    table = with_model(JEFFCOTT, liquid="statics")
    table["rotor"]["unbalance"] *= 10.0
    for chamber in table["chambers"]:
        chamber["volume"] *= 0.2
    answer = run(table)
    assert any(answer["dry_patch"])
    assert_alike(run(scaled(table, scales)), answer, ROUNDING, scales)


@pytest.mark.parametrize("machine", ["jeffcott", "two_plane"])
@pytest.mark.parametrize("command", COMMANDS)
def test_a_chamber_split_in_two(command: str, machine: str) -> None:
    """Two halves of a chamber in its plane are that chamber, but for the friction on the wall between them.

    Their liquid has waves of its own, of one half against the other. They push nothing, so they only decay:
    they may be the slowest to die, never what grows.
    """
    table = with_model(MACHINES[machine], friction=NO_WALLS)
    whole, halves = COMMANDS[command](table), COMMANDS[command](split(table))
    assert_alike(halves, whole, ROUNDING, without=["chamber_deflection", "growth", "whirl_speed"])
    growth, within = numbers(whole["growth"]), ROUNDING * np.nanmax(np.abs(numbers(whole["growth"])))
    grows = growth > 0.0
    assert grows.any()
    assert np.all(numbers(halves["growth"]) >= growth - within)
    for key in ("growth", "whirl_speed"):
        np.testing.assert_allclose(
            numbers(halves[key])[grows], numbers(whole[key])[grows], rtol=ROUNDING, atol=within, err_msg=key
        )
    if "chamber_deflection" in whole:
        first, second, last = np.moveaxis(numbers(halves["chamber_deflection"]), 1, 0)
        np.testing.assert_array_equal(first, second)
        within = ROUNDING * np.abs(last).max()
        np.testing.assert_allclose(
            np.stack([first, last], axis=1), numbers(whole["chamber_deflection"]), rtol=0.0, atol=within
        )


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("command", COMMANDS)
def test_order_of_the_parts(command: str, machine: str) -> None:
    """Chambers, supports and unbalances may come in any order."""
    table = MACHINES[machine]
    answer, found = as_given(command, machine), COMMANDS[command](reordered(table))
    # A rotor that tilts is given at its first chamber, now at the other end; `chamber_deflection` has both.
    moved = ["amplitude", "amplitude_dry", "phase", "deflection", "branches", "backward", "position",
             "error_estimate", "peak.speed", "peak.amplitude", "peak_dry.speed",
             "peak_dry.amplitude"] if machine == "two_plane" else []  # fmt: skip
    assert_alike(found, answer, ROUNDING, without=[*moved, "chamber_deflection"])
    if "chamber_deflection" in answer:
        ends = numbers(answer["chamber_deflection"])[:, ::-1]
        within = ROUNDING * np.abs(ends).max()
        np.testing.assert_allclose(numbers(found["chamber_deflection"]), ends, rtol=0.0, atol=within)


def test_order_of_supports_and_unbalances() -> None:
    """With its chambers in their places a rotor that tilts is given at the same one, and so are its peaks."""
    table = reordered(TWO_PLANE)
    table["chambers"].reverse()
    assert_alike(run(table), as_given("run", "two_plane"), ROUNDING)


def complex_numbers(values: Any) -> np.ndarray:
    """Pairs of real and imaginary parts as complex numbers."""
    pairs = numbers(values)
    return pairs[..., 0] + 1j * pairs[..., 1]


def test_the_unbalance_turned() -> None:
    """Everything turns with the unbalance: deflections by its angle, sizes and speeds by nothing."""
    angle = 0.7
    answer, found = as_given("run", "two_plane"), run(turned(TWO_PLANE, angle))
    turning = ["phase", "liquid_angle", "deflection", "branches", "backward", "chamber_deflection"]
    assert_alike(found, answer, ROUNDING, without=turning)
    for key in ("deflection", "branches", "chamber_deflection"):
        expected = complex_numbers(answer[key]) * np.exp(1j * angle)
        within = ROUNDING * np.nanmax(np.abs(expected))
        np.testing.assert_allclose(complex_numbers(found[key]), expected, rtol=0.0, atol=within)
    for key in ("phase", "liquid_angle"):
        left = (numbers(found[key]) - numbers(answer[key]) - angle + math.pi) % (2.0 * math.pi) - math.pi
        assert np.nanmax(np.abs(left)) < ROUNDING
    # Supports alike in both directions: no whirl against the spin, whatever the angle.
    largest = np.abs(complex_numbers(answer["deflection"])).max()
    for one in (answer, found):
        assert np.abs(complex_numbers(one["backward"])).max() < ROUNDING * largest


@pytest.mark.parametrize("scales", SCALES, ids=["large", "small"])
def test_similar_machines_have_similar_optima(scales: tuple[float, float, float]) -> None:
    """The search asks the same questions of both, so it takes the same way."""
    answer, found = one_chamber(), optimum(scaled(ONE_CHAMBER, scales))
    assert found["evaluations"] == answer["evaluations"]
    assert_alike(found, answer, ROUNDING, scales)


@pytest.mark.parametrize("liquid", ["linear", "long_wave"])
def test_similar_run_ups(liquid: str) -> None:
    """In time as well: the steps are those of the scaled time, their number the same."""
    table, scales = with_model(JEFFCOTT, liquid=liquid), SCALES[0]
    answer, found = runup(table), runup(scaled(table, scales))
    assert found["steps"] == answer["steps"]
    assert_alike(found, answer, ROUNDING, scales)


@pytest.mark.parametrize("change", [split, reordered, in_other_units])
@pytest.mark.parametrize("liquid", ["linear", "long_wave"])
def test_run_up_of_the_same_machine(liquid: str, change: Any) -> None:
    """Some 1e4 steps of rounding, one after the other, in a machine that forgets: 1e-10."""
    answer, found = run_up_of(liquid), runup(change(rubbing(liquid)))
    each = ["captured", "depth_max", "depth_min", "mean_rotation"]  # of each layer
    assert_alike(found, answer, 1e-10, without=each)
