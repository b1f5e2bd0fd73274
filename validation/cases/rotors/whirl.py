"""Self-excited whirl of a planar rotor with one layer: known bands and growth rates, limits.

The values beside bands and growth rates come from a scan of our own of the characteristic equation, in steps
of 5e-4 of the natural frequency: an edge is known to one step, a growth rate to its last digit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.liquid import known_liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.cycles.cycles import limit_cycles
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor
from solvers.rotor.two_plane import Support, TwoPlane
from solvers.runup.runup import RunupNumerics
from solvers.whirl.edges import unstable_bands
from solvers.whirl.growth import asynchronous_growth
from validation.case import Case, Claims
from validation.page import Figure, page
from validation.whirl_in_time import Passage, large_whirl_in_time, passage, whirl_in_time

CLAIMS = Claims("whirl")

NATURAL = 100.0  # rad/s
_STEP, _DIGIT = 5e-4, 5e-4
_BANDS = ((0.1, 0.1, 1.1225, 1.475), (0.5, 0.2, 0.969, 1.699))
_PEAKS = ((0.0, 0.066), (0.05, 0.046))
RANGE = np.linspace(0.3, 4.0, 1481)


def cases() -> list[Case]:
    """Edges, peaks, the weak growth that support damping alone leaves, and the limits without a band."""
    found: list[Case] = []
    for mu, depth, low, high in _BANDS:
        rotor, fill = layered_rotor(mu, depth, 0.0)
        ((band,),) = unstable_bands(rotor, [[fill]], RANGE * NATURAL)
        for end, printed, edge in (("lower", low, band[0]), ("upper", high, band[1])):
            at = {"mu": mu, "depth": depth, "end": end, "tolerance": 1.2 * _STEP}
            found.append(CLAIMS.case("edge", edge / NATURAL, printed=printed, **at))
    return [*found, *_limits(), *_in_time(), *_limit_cycles(), *_run_ups()]


def _in_time() -> Iterator[Case]:
    """The linear growth against the coupled nonlinear model, let go from 1e-7 of the depth.

    Inside the band without any damping, on both sides of it with damping of the support and of the liquid.
    """
    free, damped_points = (1.15, 1.3, 1.45), (1.0, 1.7)
    points = [(at, 0.0, 0.0) for at in free] + [(at, 0.02, 30.0) for at in damped_points]
    for ratio, zeta, rate in points:
        rotor, fill = layered_rotor(0.1, 0.1, zeta)
        law = Friction(FrictionLaw.LINEAR, rate) if rate else NO_FRICTION
        speed = ratio * NATURAL
        growth, _ = asynchronous_growth(rotor, [fill], [speed], law)
        numerics = RunupNumerics(cells=256, dispersion=True)
        # The mode that dies slowest stands alone late.
        duration = (400.0 if rate else 150.0) / NATURAL
        seen = whirl_in_time(rotor.system(), [fill], speed, law, duration, numerics)
        damped = f", damping ratio {zeta:g}, friction {rate:g} 1/s" if rate else ", no damping"
        yield CLAIMS.case("in-time", seen.growth, ratio=ratio, damped=damped, printed=float(growth[0]))


def _limit_cycles() -> Iterator[Case]:
    """Whirls of finite size against rotor and layers let go from a kick, in one plane and in two."""
    planar, fill = layered_rotor(0.1, 0.1, 0.02)
    full = fill.full_mass
    supports = (
        Support(-0.1, 0.45 * full / 0.1 * NATURAL**2, 2.2 * full / 0.1),
        Support(0.12, 0.6 * full / 0.1 * NATURAL**2, 1.8 * full / 0.1),
    )
    two = TwoPlane(full / 0.1, full / 0.1 * 0.08**2, full / 0.1 * 0.06**2, supports)
    halves = [_thinner(fill, -0.05, 0.6, 0.19), _thinner(fill, 0.07, 0.4, 0.15)]
    law = Friction(FrictionLaw.LINEAR, 0.03 * NATURAL)
    machines: list[tuple[str, Rotor, list[Fill], float]] = [
        ("planar-1.3", planar, [fill], 1.3),
        ("two-planes-1.25", two, halves, 1.25),
    ]
    for name, rotor, fills, ratio in machines:
        spin = ratio * NATURAL
        cycles = limit_cycles(rotor, fills, (0.95 * NATURAL, 1.45 * NATURAL), law)
        size = cycles.largest_stable(spin)
        seen = large_whirl_in_time(rotor, fills, spin, law, 0.7 * size)
        words = {"machine": name, "ratio": ratio, "whirl_speed": seen.whirl_speed}
        yield CLAIMS.case("limit-cycle", seen.amplitude, printed=size, **words)


BANDED = Friction(FrictionLaw.LINEAR, 0.03 * NATURAL)  # of the machine whose band is passed
_RATES = (8.0, 4.0)  # rad/s^2, the second half of the first
_MEASURED = ((1.6, False), (1.3, True))  # speed over the natural frequency, on the way down
_GROWN = 1e-3, 1e-2  # of the depth, between which a small whirl grows in a run-up


def banded_rotor() -> tuple[Jeffcott, Fill]:
    """The machine that is run through its band of self-excited whirl: 1.1236 to 1.4866 of 100 rad/s."""
    return layered_rotor(0.1, 0.1, 0.02)


def slow_passage(rate: float) -> Passage:
    """That machine up through its band and back at a rate, rad/s^2, without dispersion as the branch."""
    speeds = NATURAL, 1.7 * NATURAL
    return passage(*banded_rotor(), BANDED, speeds, rate, RunupNumerics(cells=64))


def _run_ups() -> Iterator[Case]:
    """Run-ups through a band: the branch that they follow, how far behind, and how the whirl begins."""
    rotor, fill = banded_rotor()
    branch = limit_cycles(rotor, [fill], (0.95 * NATURAL, 1.65 * NATURAL), BANDED)
    fast, slow = (slow_passage(rate) for rate in _RATES)
    for ratio, back in _MEASURED:
        speed, way = ratio * NATURAL, "down" if back else "up"
        size = branch.largest_stable(speed)
        ends = fast.at(speed, back), slow.at(speed, back)
        yield CLAIMS.case("run", 2.0 * ends[1] - ends[0], way=way, ratio=ratio, printed=size)
        apart = [abs(end / size - 1.0) for end in ends]
        yield CLAIMS.case(
            "run-lag",
            math.log2(apart[0] / apart[1]),
            way=way,
            ratio=ratio,
            note=f"{apart[0]:.2%} at {_RATES[0]:g} rad/s^2, {apart[1]:.2%} at {_RATES[1]:g}",
        )
    yield _beginning()


def _beginning() -> Case:
    """A small whirl in a run-up against linear theory at the speed at which the liquid turns."""
    rotor, fill = banded_rotor()
    speeds, numerics = (1.1 * NATURAL, 1.35 * NATURAL), RunupNumerics(cells=128, dispersion=True)
    seen = passage(rotor, fill, BANDED, speeds, _RATES[1], numerics, seed=1e-6)
    first, last = (int(np.argmax(seen.amplitude > size * fill.depth)) for size in _GROWN)
    part = slice(first, last + 1)
    growth, _ = asynchronous_growth(rotor, [fill], (seen.speed - seen.lag)[part], BANDED)
    by_drum, _ = asynchronous_growth(rotor, [fill], seen.speed[part], BANDED)
    time = seen.time[part]
    return CLAIMS.case(
        "run-up-growth",
        math.log(seen.amplitude[last] / seen.amplitude[first]),
        printed=float(np.trapezoid(growth, time)),
        **{"lag": seen.lag[first], "by_drum": float(np.trapezoid(by_drum, time))},
    )


def _thinner(fill: Fill, plane: float, share: float, filled: float) -> Fill:
    """A chamber of a share of the height in a plane, filled to a part."""
    chamber = Chamber(fill.chamber.radius, share * fill.chamber.height, plane=plane)
    return Fill(chamber, fill.liquid, filled * chamber.capacity)


def layered_rotor(mu: float, depth: float, zeta: float) -> tuple[Jeffcott, Fill]:
    """Rotor of 100 rad/s with one chamber of water: m_f/M, h0/R, damping ratio of the support."""
    chamber, water = Chamber(0.1, 0.02), known_liquid("water")
    fill = Fill(chamber, water, (1.0 - (1.0 - depth) ** 2) * chamber.capacity)
    mass = fill.full_mass / mu
    return Jeffcott(mass, mass * NATURAL**2, 2.0 * zeta * mass * NATURAL, 0.0), fill


def growth_over_speed(zeta: float, friction: Friction = NO_FRICTION) -> Array:
    """Growth rate over the natural frequency at the speeds of `RANGE`, m_f/M = 0.1, h0/R = 0.1."""
    rotor, fill = layered_rotor(0.1, 0.1, zeta)
    return asynchronous_growth(rotor, [fill], RANGE * NATURAL, friction)[0] / NATURAL


def _limits() -> Iterator[Case]:
    """Peaks, the weak growth that support damping alone leaves, and the limits in which no whirl grows."""
    for zeta, printed in _PEAKS:
        words = {"zeta": zeta, "printed": printed, "tolerance": _DIGIT / printed}
        yield CLAIMS.case("peak-zeta", float(growth_over_speed(zeta).max()), **words)
    # Damping of the support alone leaves every speed unstable; with laminar friction a band remains.
    alone, both = growth_over_speed(0.05), growth_over_speed(0.05, Friction(FrictionLaw.STOKES))
    unstable, share = RANGE[both > 0.0], float(np.mean(alone > 0.0))
    band = {"unstable": unstable, "last": unstable[-1]}
    yield CLAIMS.case("damping-alone", share, np.all(alone > 0.0), least=alone.min(), **band)
    # None without liquid, in a full chamber, and on supports of a thousand times the frequency.
    rotor, fill = layered_rotor(0.1, 0.1, 0.0)
    chamber, water, speed = fill.chamber, fill.liquid, RANGE * NATURAL
    rigid = Jeffcott(rotor.mass, rotor.stiffness * 1e6, 0.0, 0.0)
    for name, machine, volume in (
        ("empty", rotor, 0.0),
        ("full", rotor, chamber.capacity),
        ("rigid", rigid, fill.volume),
    ):
        growth, _ = asynchronous_growth(machine, [Fill(chamber, water, volume)], speed)
        largest = float(growth.max())
        difference = "none" if math.isclose(largest, 0.0) else f"{largest:.3g} 1/s"
        yield CLAIMS.case("limits", largest, largest == 0.0, key=name, difference=difference)


def growth_figure(in_time: list[Case]) -> Figure:
    """Growth rate over speed with four sets of damping, and the coupled model in time."""
    curves: tuple[tuple[str, float, Friction, str, Any], ...] = (
        ("no damping", 0.0, NO_FRICTION, "#0072B2", "-"),
        ("support 0.05", 0.05, NO_FRICTION, "#D55E00", (0, (5, 1.5))),
        (
            "support 0.05, laminar friction",
            0.05,
            Friction(FrictionLaw.STOKES),
            "#009E73",
            (0, (6, 1.5, 1, 1.5)),
        ),
        ("support 0.02, friction 30 1/s", 0.02, Friction(FrictionLaw.LINEAR, 30.0), "#CC79A7", (0, (1, 1.2))),
    )
    text = (
        "Growth rate of the small whirl that grows most; above zero it grows by itself. Planar rotor "
        "with one layer, m_f/M = 0.1, h0/R = 0.1; support: damping ratio. Exact linear theory of the "
        "plane layer; marks: coupled nonlinear long waves with dispersion, 256 cells, on the first and "
        "on the last of the lines."
    )
    with page([2.75], text) as (figure, [[axes]]):
        axes.axhline(0.0, color="0.15", linewidth=0.8)
        for label, zeta, friction, color, dashes in curves:
            look = {"color": color, "linestyle": dashes, "linewidth": 1.4, "label": label}
            axes.plot(RANGE, growth_over_speed(zeta, friction), **look)
        marks = {"marker": "s", "linestyle": "none", "color": "black", "markerfacecolor": "white"}
        for case in in_time:
            ratio = float(case.name.rpartition("-")[2])
            assert isinstance(case.computed, float)
            axes.plot(ratio, case.computed / NATURAL, **marks, zorder=4, label="coupled long waves in time")
        axes.set(xlim=(0.6, 2.4), ylim=(-0.03, 0.08))
        axes.set_xlabel("Spin speed over the natural frequency without liquid (\N{EN DASH})")
        axes.set_ylabel("Growth over the natural frequency (\N{EN DASH})")
    return figure


def in_time(cases: list[Case]) -> list[Case]:
    """Cases that were run in time."""
    return [case for case in cases if case.name.startswith("whirl/in-time-")]
