"""Estimated size of a self-excited whirl: the layer's lag by rule, no wave solved."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.friction.wall import lag_drag
from meshes.arrays import Array, Complex
from solvers.cycles.balance import Circular, NotCircularError, circular
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor
from solvers.whirl.edges import Bands, unstable_bands
from solvers.whirl.growth import growth_at

# The whirl drags the liquid back until it turns at about this share of the speed where whirls begin to grow.
_DRAGGED = 0.955
# Share of the undamped growth from which on it does, and the power with which the whirl shrinks below it:
# fitted to limit cycles of 74 random machines.
_WHOLE, _WEAKENING = 0.75, 1.4
_GRID = 241  # speeds among which bands are looked for
_BELOW, _ABOVE = 0.6, 1.5  # of the first and of the last speed, where edges of bands are looked for


@dataclass(frozen=True)
class Estimate:
    """A whirl by rule [theory: whirl, eq. 29]."""

    spin: float  #: Omega and omega_w, rad/s
    whirl_speed: float
    moved: Complex  #: the rotor's coordinates, complex, shape (p,)
    amplitude: float  #: largest deflection of a chamber with a layer, m
    lag: float  #: by which the liquid turns more slowly than the drum, rad/s


def estimated_whirl(
    machine: Circular, friction: Friction, lower: float, near: float, spin: float
) -> Estimate:
    """Frequency, shape and size of a large whirl [theory: whirl, eq. 29].

    It whirls as if the chambers were full of solid, drags the liquid back to about the lower edge of the
    undamped band, and is as large as the lagging liquid's torque on the wall can feed against damping: 0
    without friction, infinite without damping. `near`: frequency at that edge, rad/s.
    """
    whirl_speed, shape = _full(machine, near, spin)
    rows = np.array([place.row for place in machine.places])
    shape = shape / float(np.abs(rows @ shape).max())
    lag = max(spin - _DRAGGED * lower, 0.0)
    torque = sum(
        place.mass
        * place.fill.chamber.radius**2
        * lag_drag(place.fill, friction, lag, spin, abs(whirl_speed - spin))
        for place in machine.places
    )
    resisted = whirl_speed * float((shape.conj() @ machine.damping @ shape).real)
    size = math.sqrt(torque / resisted) if resisted > 0.0 else math.inf
    return Estimate(spin, whirl_speed, shape, size, lag)


def _full(machine: Circular, near: float, spin: float) -> tuple[float, Complex]:
    """Frequency and shape of the undamped whirl with full chambers, the one nearest to a frequency."""
    mass = machine.mass.copy()
    for place in machine.places:
        mass = mass + place.full_mass * np.outer(place.row.conj(), place.row)
    p = len(mass)
    inverse = np.linalg.inv(mass)
    # omega^2 M - i omega Omega G - K = 0.
    state = np.zeros((2 * p, 2 * p), dtype=complex)
    state[:p, p:] = np.eye(p)
    state[p:, :p], state[p:, p:] = inverse @ machine.stiffness, 1j * spin * inverse @ machine.gyroscopic
    values, vectors = np.linalg.eig(state)
    best = int(np.argmin(np.abs(values - near)))
    return float(values[best].real), np.asarray(vectors[:p, best])


def _settling(rotor: Rotor, fills: Sequence[Fill], friction: Friction) -> Circular | None:
    """A rotor's circles, if its whirls are circles and something bounds them."""
    try:
        machine = circular(rotor.system(), fills, friction)
    except NotCircularError:
        return None
    return None if unsettled(machine, friction) else machine


def _by_rule(
    rotor: Rotor,
    fills: Sequence[Fill],
    machine: Circular,
    bands: Sequence[tuple[float, float, float]],
    speeds: Array,
    friction: Friction,
) -> tuple[Estimate | None, ...]:
    """Size of the whirl at each speed inside a band, without solving for it [theory: whirl, eq. 29, 31].

    None outside the bands, which are those without friction and damping, see `undamped_bands`.
    """
    whirls: dict[int, Estimate] = {}
    for k, speed in enumerate(speeds.tolist()):
        here = [(lower, near) for lower, upper, near in bands if lower < speed < upper]
        if here:
            whirls[k] = estimated_whirl(machine, friction, *here[0], speed)
    shares = _shares(rotor, fills, speeds[list(whirls)], friction)
    found: list[Estimate | None] = [None] * len(speeds)
    # The torque goes with the square of the amplitude, and with the lag or, by the quadratic law, its square.
    # The wall's is nearly quadratic.
    power = 1.0 if friction.law in (FrictionLaw.QUADRATIC, FrictionLaw.WALL) else 2.0
    for (k, whirl), share in zip(whirls.items(), shares.tolist(), strict=True):
        if share > 0.0:
            size, lag = share * whirl.amplitude, share**power * whirl.lag
            found[k] = replace(whirl, amplitude=size, lag=lag)
    return tuple(found)


def _shares(rotor: Rotor, fills: Sequence[Fill], speeds: Array, friction: Friction) -> Array:
    """Share of the whole whirl that weak growth leaves at speeds inside undamped bands, shape (n,).

    Where friction and damping take most of the growth, the whirl's own wave is steep before it drags the
    liquid back to the edge of the band.
    """
    at = np.zeros(len(speeds), dtype=int)
    own = growth_at(rotor, [fills], at, speeds, friction)[0]
    free = growth_at(_undamped(rotor), [fills], at, speeds, NO_FRICTION)[0]
    left = np.divide(own, free, out=np.zeros(len(speeds)), where=free > 0.0)
    return np.asarray(np.clip(left / _WHOLE, 0.0, 1.0) ** _WEAKENING)


def largest_estimate(
    rotor: Rotor,
    fills: Sequence[Fill],
    range_: tuple[float, float],
    friction: Friction,
    bands: Callable[[], Bands] | None = None,
) -> Estimate | None:
    """The largest of the whirls in the middles of the bands, by rule; None where nothing grows by itself.

    The middle of what a band shares with an undamped one, next to whose upper edge [theory: whirl, eq. 31]
    leaps, as growth vanishes there. `bands` gives those in which some whirl grows, rad/s;
    they are solved for if None.
    """
    machine = _settling(rotor, fills, friction)
    if machine is None:
        return None
    own = unstable_bands(rotor, [fills], np.array(range_), friction)[0] if bands is None else bands()
    free = list(undamped_bands(rotor, fills, (_BELOW * range_[0], _ABOVE * range_[1]))) if own else []
    shared = [(max(low, lower), min(high, upper)) for low, high in own for lower, upper, _ in free]
    middles = np.array(sorted(0.5 * (low + high) for low, high in shared if low < high))
    found = _by_rule(rotor, fills, machine, free, middles, friction)
    return max((whirl for whirl in found if whirl), key=lambda whirl: whirl.amplitude, default=None)


def unsettled(machine: Circular, friction: Friction) -> str:
    """Why no whirl of a certain size can last; empty where one can."""
    if friction.law is FrictionLaw.NONE or (not friction.law.laminar and friction.coefficient == 0.0):
        return "without friction of the liquid nothing keeps it turning: a whirl drags it back and dies down"
    if not np.abs(machine.damping).max() > 0.0:
        return "without damping of the supports nothing bounds the whirl"
    return ""


def undamped_bands(
    rotor: Rotor, fills: Sequence[Fill], range_: tuple[float, float]
) -> Iterator[tuple[float, float, float]]:
    """Bands without friction and damping: their edges, and the whirl speed at the lower one."""
    free = _undamped(rotor)
    (bands,) = unstable_bands(free, [fills], np.linspace(*range_, _GRID), NO_FRICTION)
    for lower, upper in bands:
        inside = np.array([lower + 1e-3 * (upper - lower)])
        near = growth_at(free, [fills], np.array([0]), inside, NO_FRICTION)[1]
        yield lower, upper, float(near[0])


def _undamped(rotor: Rotor) -> Rotor:
    if isinstance(rotor, Jeffcott):
        return replace(rotor, damping=0.0)
    system = rotor.system()
    return replace(system, damping=0.0 * system.damping)
