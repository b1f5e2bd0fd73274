"""The measured rig [RCFW11] beside what the package computes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from meshes.arrays import Array
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.balls.steady import steady_states
from solvers.rotor.campbell import campbell
from solvers.rotor.vibration import orbit, unbalance_response
from validation.case import Case, Claims, Effect
from validation.cases.measured_balls.machine import (
    FAST,
    RPM,
    STIFFER,
    WASHERS,
    at_bearings,
    couples,
    known,
    level,
    measured,
    plain,
    race,
    rotor,
    speeds_read,
    washer_plane,
)
from validation.cases.measured_balls.runs import BEST, GRAVITY, RESISTANCES, WEIGHTLESS, Curve, kept

CLAIMS = Claims("measured_balls")
_FAST = np.arange(4000.0, 5001.0, 50.0)  # rpm
# Between the two members of each pair of criticals, rpm.
_BETWEEN = (1550.0, 2100.0)
# Below it run-out hides what the model has, and the motor's torsion is near; a bearing vibrates at 3300.
_LOWEST, _BEARING = 1250.0, 3300.0
# Of the steps over which one resistance is the best: whose misfit is no more than so many times the least.
_AS_GOOD = 2.0
_ROUNDS, _STEP = 3000, 1e-4  # of balls that creep; m, over which the pull changes in a radian


def criticals(stiffer: float) -> Array:
    """Speeds at which a natural frequency meets the spin, rpm."""
    found = campbell(rotor(0, stiffer).system(), np.linspace(500.0, 3000.0, 251) * RPM)
    return np.asarray(found.crossing / RPM)


def levels(resistance: float, gravity: float = GRAVITY) -> Array:
    """Kept amplitudes above all resonances, um, shape (washers, runs)."""
    rows = [
        each.amplitude for each in kept().levels if each.resistance == resistance and each.gravity == gravity
    ]
    return np.array(rows)


def misfit(resistance: float, gravity: float = GRAVITY) -> float:
    """Root mean square of log(measured/median) with 0 to 3 washers, which two balls can balance."""
    medians = np.median(levels(resistance, gravity), axis=1)
    logs = [np.log(1e6 * level("up", washers) / medians[washers]) for washers in range(4)]
    return float(np.sqrt(np.mean(np.square(logs))))


def as_good() -> tuple[float, float]:
    """Least and largest of the resistances whose levels are about as near as those of the best one."""
    good = [f for f in RESISTANCES if misfit(f) <= _AS_GOOD * misfit(BEST)]
    return min(good), max(good)


def unresisted(washers: int) -> float:
    """Mean amplitude from 4000 to 5000 rpm with balls that roll without resistance, at rest, m."""
    system = rotor(washers).system()
    states = steady_states(system, [race()], _FAST * RPM)
    sizes = np.where(states.stable, at_bearings(system, states.coordinates), np.nan)
    return float(np.nanmax(sizes, axis=1).mean())


def eccentric(washers: int) -> float:
    """Largest mean amplitude, m, that balls without resistance leave in a race as eccentric as the source's.

    They balance about the race's centre, which turns about the axis; of twelve directions of it the worst.
    """
    system, away = rotor(washers).system(), known()["race"]["eccentricity_um"] * 1e-6
    machine, turned = RotorWithBalls(system, (race(),)), np.linspace(0.0, 2.0 * np.pi, 13)[:-1]
    centre, sizes = away * np.exp(1j * turned)[:, None], []
    for rpm in FAST:
        each = np.repeat(machine.compliance(np.array([rpm * RPM])), turned.size, axis=0)
        # Balls that creep.
        places = np.tile(balanced_start(washers), (turned.size, 1))
        for _ in range(_ROUNDS):
            seen = machine.forward(machine.coordinates(each, places)) + centre
            places = places + np.imag(seen * np.exp(-1j * places)) / _STEP
        sizes.append(at_bearings(system, machine.coordinates(each, places)))
    return float(np.mean(sizes, axis=0).max())


def balanced_start(washers: int) -> Array:
    """Angles at which the balls take the washers' unbalance away, or most of it, rad."""
    moment, own = known()["washers"]["unbalance_g_mm"][washers] * 1e-6 * (washers > 0), race()
    share = min(1.0, moment / (sum(own.masses) * own.radius))
    return np.array([np.pi - np.arccos(share), np.pi + np.arccos(share)])


def curves_of(resistance: float, washers: int) -> list[Curve]:
    """Kept ways up and down, one for each drag."""
    return [each for each in kept().curves if (each.resistance, each.washers) == (resistance, washers)]


def cases() -> list[Case]:
    """All of the rig."""
    return [*_rotor(), *_plain(), *_balls(), *_stuck(), *_ways()]


def _rotor() -> Iterator[Case]:
    """Criticals, the stiffness that they need, the whirl between them, the place of the washers."""
    said, printed, found = known(), criticals(1.0), criticals(STIFFER)
    seen = np.array(said["critical_rpm"], dtype=float)
    for k in range(seen.size):
        yield CLAIMS.case("critical", float(found[k]), number=k + 1, printed=float(seen[k]), alone=printed[k])
    needed = float(np.exp(np.mean(2.0 * np.log(seen / printed))))
    values = said["stiffness_printed"]
    yield CLAIMS.case("stiffness", needed * values[0], printed=values[0], times=needed, second=values[1])
    for low, high, speed in zip(found[::2], found[1::2], _BETWEEN, strict=True):
        back = [way for washers in WASHERS for way in _backward(washers, speed)]
        told = {"speed": speed, "low": low, "high": high, "back": sum(back), "count": len(back)}
        yield CLAIMS.case("whirl", agrees=2 * sum(back) > len(back), **told)
    place, couple = washer_plane()
    inertia = said["rotor"]["transverse_inertia"] - said["rotor"]["polar_inertia"]
    moment = np.array(said["washers"]["unbalance_g_mm"][1:]) * 1e-6
    worst = float(np.abs(np.abs(couple + place * moment) / np.abs(couples()) - 1.0).max())
    alone, tilt = said["washers"]["misalignment_1e-5_rad"][0] * 1e-5, abs(couple) / inertia
    yield CLAIMS.case("washers", tilt, printed=alone, place=1e3 * place, worst=worst)


def _backward(washers: int, rpm: float) -> list[bool]:
    """Whether the axis whirls against the spin at each bearing."""
    system = rotor(washers).system()
    answer = unbalance_response(system, [rpm * RPM])
    ways = [orbit(system, answer, place) for place in known()["bearings_position"]]
    return [bool(np.abs(way.backward[0]) > np.abs(way.forward[0])) for way in ways]


def _ratios(washers: int) -> Array:
    """Measured over computed without balls, where neither run-out nor a bearing hides it."""
    rpm = speeds_read()
    wanted = (rpm >= _LOWEST) & (rpm != _BEARING)
    return np.asarray(measured("plain", washers)[wanted] / plain(washers, rpm[wanted]))


def _plain() -> Iterator[Case]:
    """Without balls: levels above all resonances, and the whole curves."""
    for washers in WASHERS:
        found = float(plain(washers, _FAST).mean())
        yield CLAIMS.case("plain-level", 1e6 * found, washers=washers, printed=1e6 * level("plain", washers))
    every = np.concatenate([_ratios(washers) for washers in range(1, 5)])
    low, middle, high = (float(part) for part in np.percentile(every, [25.0, 50.0, 75.0]))
    effect = Effect("median of measured over computed amplitude", middle, 1.0)
    told = {"low": low, "middle": middle, "high": high, "count": every.size}
    yield CLAIMS.case("plain-curve", f"{middle:.2f} times", effect.alike, effect=effect, **told)


def _balls() -> Iterator[Case]:
    """Levels of balls that roll without resistance."""
    for washers in WASHERS:
        seen, found = 1e6 * level("up", washers), 1e6 * unresisted(washers)
        name = "just-enough" if washers == 3 else "too-few" if washers == 4 else "rolling"
        yield CLAIMS.case(name, found, washers=washers, printed=seen, excess=seen / found)


def _stuck() -> Iterator[Case]:
    """Levels of balls that resist to rolling."""
    found = levels(BEST)
    least, most = as_good()
    for washers in (1, 2):
        yield CLAIMS.case(
            "eccentric", 1e6 * eccentric(washers), washers=washers, printed=1e6 * level("up", washers)
        )
    for washers in WASHERS:
        low, middle, high = np.percentile(found[washers], [10.0, 50.0, 90.0]).tolist()
        told = {"low": low, "high": high, "count": found.shape[1], "resistance": BEST}
        seen = 1e6 * level("up", washers)
        yield CLAIMS.case("sticking", middle, washers=washers, printed=seen, **told)
    small = [f for f in RESISTANCES if 0.0 < f <= 1e-3]
    free = np.median(levels(0.0), axis=1)
    still = max(float(np.abs(np.median(levels(f), axis=1) / free - 1.0).max()) for f in small)
    light = min(WEIGHTLESS, key=lambda f: misfit(f, 0.0))
    told = {"least": least, "most": most, "misfit": misfit(BEST), "none": misfit(0.0)}
    told |= {"still": still, "small": max(small), "light": light, "weightless": misfit(light, 0.0)}
    best = min(RESISTANCES, key=misfit)
    yield CLAIMS.case("resistance", f"{best:g}, from {least:g} to {most:g}", best == BEST, **told)


def below_critical() -> tuple[Array, Array]:
    """Amplitude with balls, speed rising, over that without, measured and computed, shape (washers, speeds).

    At 1250 and 1400 rpm, below the first critical, where run-out is not most of it.
    """
    at = np.isin(speeds_read(), (1250.0, 1400.0))
    seen = [measured("up", w)[at] / measured("plain", w)[at] for w in WASHERS]
    found = [
        np.median([np.array(each.up)[at] for each in curves_of(BEST, w)], axis=0)
        * 1e-6
        / plain(w, speeds_read()[at])
        for w in WASHERS
    ]
    return np.array(seen), np.array(found)


def hysteresis() -> tuple[Array, Array]:
    """Largest amplitude on the way up over that on the way down, 1250 to 1850 rpm, shape (washers,) each.

    Measured, and the median over drags.
    """
    at = (speeds_read() >= 1250.0) & (speeds_read() <= 1850.0)
    seen = [measured("up", w)[at].max() / measured("down", w)[at].max() for w in WASHERS]
    found = [
        np.median([max(np.array(c.up)[at]) / max(np.array(c.down)[at]) for c in curves_of(BEST, w)])
        for w in WASHERS
    ]
    return np.array(seen), np.array(found)


def _ways() -> Iterator[Case]:
    """Worse below the first critical, and larger on the way up than on the way down."""
    seen, found = below_critical()
    sizes = float(np.median(seen)), float(np.median(found))
    effect = Effect("amplitude with balls over that without, median", *sizes)
    told = {"worse": int(np.sum(found > 1.0)), "seen": int(np.sum(seen > 1.0)), "count": seen.size}
    yield CLAIMS.case("below-critical", agrees=bool((found > 1.0).all()), effect=effect, **told)
    seen, found = hysteresis()
    sizes = float(np.median(seen)), float(np.median(found))
    effect = Effect("largest amplitude up over down, median", *sizes)
    told = {"up": int(np.sum(found > 1.0)), "seen": int(np.sum(seen > 1.0)), "count": seen.size}
    yield CLAIMS.case("hysteresis", agrees=bool(np.sum(found > 1.0) >= 4), effect=effect, **told)
