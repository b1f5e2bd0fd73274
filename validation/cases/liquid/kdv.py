"""KdV-Burgers where it is to hold: self-excited whirls, waves near resonance; the published fluid balancer.

Its limit cycles beside those of long waves and beside rotor and layer marched in time, its waves beside exact
ones; of the balancer by forced KdV-Burgers the statements of its abstract [LN14].
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import islice

import numpy as np

from fluid import kdv
from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import known_liquid
from leblanc.studies.held.whirls import own_whirl
from meshes.chamber import Chamber
from solvers.cycles.balance import circular
from solvers.cycles.branch import Follower
from solvers.cycles.cycles import HeldWhirl, LimitCycles, limit_cycles
from solvers.cycles.edges import small_whirl_edges
from solvers.cycles.family import FamilyWave, family_wave
from solvers.cycles.wave import Whirling
from solvers.held.integrate import hold, start
from solvers.held.state import HeldMachine, HeldState, HoldNumerics
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.potential.steady import forced
from solvers.pypde.models import LongWave, OneFamily
from solvers.synchronous.models import STATICS
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from validation.case import Case, Claims
from validation.cases.rotors.rigs import horizontal_rig, horizontal_rotor
from validation.cases.rotors.whirl import BANDED, NATURAL, layered_rotor
from validation.exact import detuning, whirl_speeds

CLAIMS = Claims("kdv")

# Over omega_n: speeds at which whirls are compared, of machines by depth over R and damping ratio.
MACHINES = {"a": (0.1, 0.02, (1.2, 1.3, 1.4, 1.55, 1.7, 2.0)), "c": (0.05, 0.02, (1.1, 1.2, 1.3))}
# Rotor and layer of the first in time, from a large whirl: speed and amplitude over the depth.
MARCHED = ((1.2, 0.4147), (1.3, 0.5664), (1.4, 0.6784), (1.55, 0.8126), (1.7, 0.9238), (2.0, 1.1065))
_TRIED, _BAND = (1.0, 0.5, 1.5), (1.15, 2.0)
# Waves near resonance, p over p_1 and w0 over h0: whirls of their size behind the drum.
_WAVES = ((0.1, 0.9, 0.005), (0.1, 0.95, 0.001), (0.1, 1.05, 0.001), (0.1, 1.1, 0.005), (0.05, 0.9, 0.002))
_RESTING = Friction(FrictionLaw.LINEAR, 1e-9)  # so little that nothing shows
_DRIVEN = (
    (2.0, 30.0, 0.05),
    (2.0, 30.58, 0.05),
    (0.5, 30.0, 0.05),
    (0.5, 30.58, 0.05),
    (0.5, 31.0, 0.02),
    (0.5, 31.5, 0.05),
)
# Unbalance in depths off the axis, and what rotor and long waves have in time at 1.3 omega_n, over the depth:
# the part that goes with the spin and the self-excited one.
_UNBALANCED = ((0.1, 0.189, 0.554), (0.3, 0.585, 0.631))
_LET_GO = 1.2, 1.3, 1.4  # speeds over omega_n, in the band
_SPEEDS = np.linspace(0.3, 3.0, 55)  # critical speeds
_DEPTHS = 0.01, 0.05, 0.1, 0.2


def cases() -> list[Case]:
    """Whirls, what they owe to lag and diffusion, waves beside exact ones, the published balancer."""
    return [*_whirls(), *_owed(), *_let_go(), *_waves(), *_driven(), *_balancer()]


@cache
def by_family(machine: str, front: float = kdv.FRONT) -> LimitCycles:
    """Limit cycles of a machine by KdV-Burgers."""
    return _cycles(machine, front)


@cache
def by_long_waves(machine: str) -> LimitCycles:
    """The same by nonlinear long waves."""
    return _cycles(machine, None)


def _cycles(machine: str, front: float | None) -> LimitCycles:
    depth, zeta, speeds = MACHINES[machine]
    rotor, fill = layered_rotor(0.1, depth, zeta)
    range_ = 0.95 * NATURAL, (speeds[-1] + 0.02) * NATURAL
    if front is None:
        return limit_cycles(rotor, [fill], range_, BANDED)
    return limit_cycles(rotor, [fill], range_, BANDED, wave=family_wave(front))


def stable_at(found: LimitCycles, ratio: float) -> HeldWhirl:
    """The largest stable whirl at a speed over omega_n."""
    whirls = [whirl for branch in found.branches for whirl in branch.at(ratio * NATURAL) if whirl.stable]
    return max(whirls, key=lambda whirl: whirl.amplitude)


def _whirls() -> Iterator[Case]:
    for name, (depth, zeta, speeds) in MACHINES.items():
        size = depth * layered_rotor(0.1, depth, zeta)[1].chamber.radius
        for ratio in speeds:
            own, other = (stable_at(found, ratio) for found in (by_family(name), by_long_waves(name)))
            words = {
                "machine": name, "ratio": ratio, "depth": depth, "zeta": zeta, "marched": "",
                "whirl_speed": own.whirl_speed / NATURAL, "other_speed": other.whirl_speed / NATURAL,
                "lag": own.lag / NATURAL, "other_lag": other.lag / NATURAL,
            }  # fmt: skip
            yield CLAIMS.case("whirl", own.amplitude / size, printed=other.amplitude / size, **words)
    size = 0.1 * layered_rotor(0.1, 0.1, 0.02)[1].chamber.radius
    for ratio, amplitude in MARCHED:
        found = stable_at(by_family("a"), ratio).amplitude / size
        yield CLAIMS.case("in-time", found, printed=amplitude, ratio=ratio)


class _Held(FamilyWave):
    """A layer whose mean flow the wall holds, however the whirl pulls."""

    def _rate(self, given: Whirling, lag: float) -> float:
        return 1e9


def without_lag(ratio: float) -> float:
    """Whirl over the depth at a speed over omega_n, from the upper edge, if no liquid lagged."""
    rotor, fill = layered_rotor(0.1, 0.1, 0.02)
    machine = circular(rotor.system(), [fill], BANDED)
    (edge,) = small_whirl_edges(machine, (1.3 * NATURAL, 1.6 * NATURAL))
    follower = Follower(machine, BANDED, 64, NATURAL, _Held)
    start = follower.start(edge.moved, edge.whirl_speed, edge.spin, 0.02, hold_size=True)
    assert start is not None
    for cycle in islice(follower.after(start), 80):
        if cycle.spin < ratio * NATURAL:
            return follower.size(cycle)
    return math.inf


def _owed() -> Iterator[Case]:
    """What the whirl owes to the lag and to the diffusion."""
    size = 0.1 * layered_rotor(0.1, 0.1, 0.02)[1].chamber.radius
    lagging = stable_at(by_family("a"), 1.4).amplitude / size
    times = without_lag(1.4) / lagging
    yield CLAIMS.case("no-lag", f"{times:.2g} times", 2.0 < times < math.inf, difference="in words")
    speeds = np.linspace(*_BAND, 18)
    widths = [share * kdv.FRONT for share in _TRIED]
    sizes = [[stable_at(by_family("a", width), ratio).amplitude for ratio in speeds] for width in widths]
    change = float(np.abs(np.array(sizes[1:]) - sizes[0]).max() / max(sizes[0]))
    yield CLAIMS.case("diffusion", f"{change:.2%}", change < 0.01, difference="in words")


def let_go(ratio: float, unbalance: float = 0.0) -> HeldState:
    """Rotor and layer held by KdV-Burgers, kicked: speed over omega_n, unbalance in depths off the axis."""
    rotor, fill = layered_rotor(0.1, 0.1, 0.02)
    spin, numerics = ratio * NATURAL, HoldNumerics(cells=64)
    heavy = replace(rotor, unbalance=rotor.mass * unbalance * fill.depth)
    machine = HeldMachine(heavy.system(), (fill,), BANDED, liquid="kdv")
    growth = float(asynchronous_growth(rotor, [fill], np.array([spin]), BANDED)[0][0])
    motion = response(heavy, [fill], [spin], 0.0).coordinates[0]
    return hold(machine, start(machine, spin, numerics, motion, 0.4), numerics, growth)


def _let_go() -> Iterator[Case]:
    """In time, without unbalance beside the cycle and long waves in time, and with it beside the latter."""
    rotor, fill = layered_rotor(0.1, 0.1, 0.02)
    depth, marched = fill.depth, dict(MARCHED)
    for ratio in _LET_GO:
        seen = let_go(ratio)
        words = {"speed": seen.whirl_speed / NATURAL, "lag": -float(seen.mean_rotation[0]) / NATURAL}
        yield CLAIMS.case("held", seen.amplitude / depth, printed=marched[ratio], ratio=ratio, **words)
        if ratio == 1.3:
            cycle = stable_at(by_family("a"), ratio).amplitude / depth
            yield CLAIMS.case("let-go", seen.amplitude / depth, printed=cycle, **words)
    for unbalance, synchronous, whirl in _UNBALANCED:
        seen = let_go(1.3, unbalance)
        forward = abs(seen.coordinates @ np.array([1.0, 1j])) / 2.0
        parts = (
            ("whirl", own_whirl(rotor.system(), seen, 0.0), whirl),
            ("synchronous", forward, synchronous),
        )
        for part, size, other in parts:
            yield CLAIMS.case("unbalanced", size / depth, printed=other, part=part, unbalance=unbalance)


def _waves() -> Iterator[Case]:
    """G of both families, one nonlinear, beside that of exact waves."""
    for depth, ratio, size in _WAVES:
        speed, _ = whirl_speeds(depth, ratio)
        exact = forced(depth, detuning(depth, ratio), size * depth)
        chamber = Chamber(0.15, 0.05)
        volume = (1.0 - (1.0 - depth) ** 2) * chamber.capacity
        wave = FamilyWave(Fill(chamber, known_liquid("water"), volume), _RESTING, 256, 0.0)
        given = Whirling(speed, size * depth, 1e-9)
        answer = wave.period(given)
        assert answer is not None
        posed = wave.posed(wave.state, given)
        assert posed is not None
        c = wave.near
        alone = (
            2.0
            * wave.mean
            * (1.0 + c.surface_radius / wave.mean * (posed.first - posed.other).real / (size * depth))
        )
        words = {"depth": depth, "ratio": ratio, "size": size, "alone": alone}
        yield CLAIMS.case(
            "exact",
            answer.force.real,
            printed=exact.force_ratio,
            height=1.0 - wave.thinnest(wave.state),
            **words,
        )


def driven(rate: float, speed: float, share: float) -> tuple[complex, float, complex, float]:
    """G and lag, rad/s, of a layer with friction under a whirl: by KdV-Burgers, and by settled long waves.

    A layer of 0.1 of 150 mm at 40 rad/s, linear friction, 1/s, whirl speed, rad/s, w0 over h0.
    """
    chamber = Chamber(0.15, 0.05)
    fill = Fill(chamber, known_liquid("water"), (1.0 - 0.9**2) * chamber.capacity)
    friction = Friction(FrictionLaw.LINEAR, rate)
    whirl = Whirl(40.0, speed, share * fill.depth, 0.0)
    models = OneFamily(friction), LongWave(friction, Numerics(128, dispersion=True))
    waves = [model.wave(fill, whirl) for model in models]
    unit = fill.full_mass * whirl.amplitude
    (own, lag), (other, other_lag) = (
        (complex(wave.answer.unbalance[0]) / unit, -wave.mean_rotation) for wave in waves
    )
    return own, lag, other, other_lag


def _driven() -> Iterator[Case]:
    """Layers with friction next to their natural wave at 30.58 rad/s."""
    for rate, speed, share in _DRIVEN:
        own, lag, other, other_lag = driven(rate, speed, share)
        words = {
            "rate": rate, "speed": speed, "share": share, "lag": lag, "other_lag": other_lag,
            "own": f"{own:.3f}", "other": f"{other:.3f}",
        }  # fmt: skip
        yield CLAIMS.case(
            "driven", abs(own - other) / abs(other), abs(own - other) < 0.05 * abs(other), **words
        )


def offset_share(depth: float, family: int) -> float:
    """Share that a family of small waves has of the liquid's offset in a synchronous whirl, by depth over R.

    Its linear wave, solved, over the exact offset of the paraboloid.
    """
    c = kdv.coefficients(1.0, 1.0 - depth, 1.0, family)
    wave = float(kdv.forcing(c, 1.0)) / float(kdv.wave_frequency(1, c, False))
    profile = wave * np.cos(2.0 * np.pi * np.arange(64) / 64)
    return float(kdv.offset(c, profile).real) * ((1.0 - depth) ** -2 - 1.0)


def _closed(depth: float) -> float:
    """The same by the closed form, of the family against the spin."""
    log = -math.log1p(-depth)
    root = math.sqrt(log * (log + 1.0))
    # lambda_0 and delta over the spin, from L alone.
    speed = log - root
    lag = log**3 / 3.0 * (1.0 - (2.0 * log + 1.0) / (2.0 * root))
    return 0.5 * (1.0 + math.sqrt(log / (1.0 + log))) * speed / (speed - lag)


def _balancer() -> Iterator[Case]:
    """A balancer by forced KdV-Burgers: where its liquid lies, and what one family makes of it."""
    rotor, fills = horizontal_rotor(0.05, 105.0), horizontal_rig()
    found = response(rotor, fills, _SPEEDS * rotor.natural_frequency, 0.0, STATICS)
    side = np.cos(found.liquid_angle - np.angle(found.deflection)) * found.liquid_offset
    least = float((side / np.abs(found.deflection)).min())
    deepest = max(fill.depth / fill.chamber.radius for fill in fills)
    yield CLAIMS.case("balancer-side", f"{least:.3g} or more", least > 0.0, depth=deepest)
    dry = found.deflection_dry[[int(np.argmin(np.abs(_SPEEDS - at))) for at in (0.8, 1.25)]]
    below, above = (float(value.real / abs(value)) for value in dry)
    yield CLAIMS.case("balancer-dry", agrees=below > 0.9 and above < -0.9, below=below, above=above)
    for depth in (*_DEPTHS, deepest):
        where = "the larger ring of the horizontal rig" if depth == deepest else "any radius, any speed"
        words = {"depth": depth, "where": where}
        yield CLAIMS.case("balancer-share", offset_share(depth, -1), printed=_closed(depth), **words)
    yield CLAIMS.case("balancer-both", offset_share(0.05, -1) + offset_share(0.05, 1))
