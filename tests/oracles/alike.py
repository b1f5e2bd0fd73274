"""Two answers that must be alike: what each number of an answer measures, and how near it must be."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np

from tests.oracles.commands import numbers
from tests.oracles.machines import LENGTH, MASS, RATIO, SPEED, TIME, factor

# Exponents of length, mass and time of what the commands answer, by key.
ANSWERED: dict[str, tuple[int, int, int]] = {
    # run
    "speed": SPEED, "amplitude": LENGTH, "amplitude_dry": LENGTH, "liquid_offset": LENGTH,
    "dry_patch": RATIO, "stable": RATIO, "in_range": RATIO, "converged": RATIO,
    "deflection": LENGTH, "branches": LENGTH, "branch_stable": RATIO, "liquid_mass": MASS,
    "critical_speed_dry": SPEED, "critical_speed_wet": SPEED, "capture_speed": SPEED, "error_estimate": RATIO,
    "carried_from": SPEED,
    "growth": SPEED, "whirl_speed": SPEED, "whirl_bands": SPEED, "position": LENGTH, "backward": LENGTH,
    "chamber_deflection": LENGTH, "natural_frequency": SPEED, "natural_damping_ratio": RATIO,
    "peak.speed": SPEED, "peak.amplitude": LENGTH, "peak_dry.speed": SPEED, "peak_dry.amplitude": LENGTH,
    "floor_force": (1, 1, -2), "floor_force_least": (1, 1, -2), "floor_force_rest": (1, 1, -2),
    "walking_margin": RATIO, "lift_off_margin": RATIO, "slip_margin": RATIO,
    "motor_torque": (2, 1, -2), "motor_power": (2, 1, -3),
    "clearance.end": LENGTH, "displacement.end": LENGTH,
    # map
    "volume": (3, 0, 0), "edges": SPEED, "scene_volume": (3, 0, 0), "scene_edges": SPEED,
    # volume
    "optimal_volume": (3, 0, 0), "optimal_volume_fem": (3, 0, 0), "fem_error": RATIO,
    "printed_eq18": (3, 0, 0), "corrected_eq18": (3, 0, 0), "surface_constant": LENGTH,
    "unbalance_volume": (4, 0, 0), "unbalance_volume_fem": (4, 0, 0), "case": RATIO,
    # layer
    "force_ratio": RATIO, "offset": LENGTH, "mass_error": RATIO, "mean_rotation": SPEED, "theta": RATIO,
    "depth": LENGTH,
    # modes
    "frequency": SPEED, "exact": SPEED, "damping": SPEED,
    # runup
    "time": TIME, "liquid_offset_mean": LENGTH, "depth_max": LENGTH, "depth_min": LENGTH,
    "captured": RATIO,
    # optimise
    "value": LENGTH, "baseline": LENGTH, "feasible": RATIO,
}  # fmt: skip

# Numbers near zero are judged beside these.
_BESIDE = {"backward": "deflection", "offset": "depth", "mean_rotation": "speed"}
# Growth and whirl speed are parts of one root.
_COMPLEX = {"growth": "whirl_speed"}
# Angles, each of a length: where that is nothing but rounding so is the angle.
_ANGLES = {"phase": "amplitude", "liquid_angle": "liquid_offset", "liquid_angle_mean": "liquid_offset_mean"}
# Rounding of a conserved sum: it is near zero, whatever the machine.
_ROUNDING = ("mass_error",)


def flat(answer: dict[str, Any]) -> dict[str, Any]:
    """An answer whose parts that have names of their own stand beside the others, as `part.name`."""
    found = dict(answer)
    for name, part in answer.items():
        if isinstance(part, dict):
            found |= {f"{name}.{key}": value for key, value in part.items()}
    return found


def assert_alike(
    found: dict[str, Any],
    answer: dict[str, Any],
    tolerance: float,
    scales: tuple[float, float, float] = (1.0, 1.0, 1.0),
    without: Collection[str] = (),
) -> None:
    """Every number of `answer`, scaled, stands in `found`, within `tolerance` of the largest of its kind."""
    found, answer = flat(found), flat(answer)
    compared = [key for key in ANSWERED if key not in without and not isinstance(answer.get(key, ""), str)]
    assert compared
    for key in compared:
        expected, number = numbers(answer[key]).astype(float), numbers(found[key]).astype(float)
        expected = expected * factor(ANSWERED[key], scales)
        assert number.shape == expected.shape, key
        beside = numbers(answer.get(_BESIDE.get(key, key), answer[key])).astype(float)
        sizes = np.abs(beside[np.isfinite(beside)])
        largest = factor(ANSWERED[key], scales) * max(sizes.flat, default=0.0)
        within = 1e-12 if key in _ROUNDING else tolerance * largest
        np.testing.assert_allclose(number, expected, rtol=0.0, atol=within, err_msg=key)
    for angle, length in _ANGLES.items():
        if angle in answer and angle not in without:
            expected = _complex(answer, angle, length) * factor(LENGTH, scales)
            within = tolerance * np.nanmax(np.abs(expected))
            number = _complex(found, angle, length)
            np.testing.assert_allclose(number, expected, rtol=0.0, atol=within, err_msg=angle)
    for key in ("model", "state"):
        assert found.get(key) == answer.get(key)


def _complex(answer: dict[str, Any], angle: str, length: str) -> np.ndarray:
    """A length and its angle as one complex number."""
    return numbers(answer[length]).astype(float) * np.exp(1j * numbers(answer[angle]).astype(float))


def differences(
    found: dict[str, Any],
    answer: dict[str, Any],
    scales: tuple[float, float, float] = (1.0, 1.0, 1.0),
    without: Collection[str] = (),
) -> dict[str, float]:
    """By key the largest difference of two answers, relative to the largest number of its kind.

    Infinite where they differ in more than numbers: in shape, in what was found at all, in a state.
    """
    far: dict[str, float] = {}
    found, answer = flat(found), flat(answer)
    near = _BESIDE | _COMPLEX
    for key in ANSWERED:
        if key in without or key not in answer or isinstance(answer[key], str):
            continue
        expected = numbers(answer[key]).astype(float) * factor(ANSWERED[key], scales)
        number = numbers(found[key]).astype(float) if key in found else np.array([np.inf])
        beside = numbers(answer.get(near.get(key, key), answer[key])).astype(float)
        sizes = np.abs(beside[np.isfinite(beside)])
        far[key] = _apart(number, expected, factor(ANSWERED[key], scales) * max(sizes.flat, default=0.0))
    for angle, length in _ANGLES.items():
        if angle in answer and angle not in without:
            wanted = _complex(answer, angle, length) * factor(LENGTH, scales)
            sizes = np.abs(wanted[np.isfinite(wanted)])
            far[angle] = _apart(_complex(found, angle, length), wanted, max(sizes.flat, default=0.0))
    for key in ("model", "state"):
        if found.get(key) != answer.get(key):
            far[key] = np.inf
    return far


def _apart(number: np.ndarray, expected: np.ndarray, size: float) -> float:
    """Largest difference over `size`; infinite where shapes differ or one of both is not a number."""
    if number.shape != expected.shape or not np.array_equal(np.isfinite(number), np.isfinite(expected)):
        return np.inf
    known = np.isfinite(expected)
    off = float(np.max(np.abs(number[known] - expected[known]), initial=0.0))
    return 0.0 if off == 0.0 else off / size if size > 0.0 else np.inf
