"""Fully nonlinear waves that stand in the frame of their whirl, by Newton's method with an analytic Jacobian.

Lengths over R, times in 1/Omega; `layer` is h_0/R, `crest` the depth there over h_0, `most` the steps from
crest to trough that nodes may have. Unknown are the surface y at the nodes, Bernoulli's constant, the
detuning p^2 = (1 - Omega/omega_w)^2 and the whirl w_0; two conditions choose among p^2, w_0, the depth of the
crest and the height of the wave [theory: potential, eq. 7-8]. The wave depends on p^2 and not on the sign of
p: whirl speeds come in twins [theory: potential, eq. 9].
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.potential.strip import Nodes, moved, nodes, strip

# Newton's method: done when the residual is this over the depth, and rounds that it may take.
_DONE, _ROUNDS = 1e-13, 12
# Rounds after which a residual is given up that grows and is no rounding, over the depth.
_PATIENT, _STALLED = 3, 1e-6
# Of the first round's change, what the later ones may add before the wave found counts as another branch's.
_NEAR = 0.5
# A stand-still of the residual at this much counts as done as well: rounding of many nodes.
_ROUNDING = 1e-10
# Steps from crest to trough to begin with.
_FIRST = 64
# Depths of the strip that a step may not leave, of the one that it began with.
_LEAST, _GREATEST = 0.1, 4.0
# A surface this far from the wall, in ln(R/r), is at the axis.
_FURTHEST = 15.0
# Rise between crest and trough, of the height, that a short wave has and rounding has not.
_RIPPLE = 1e-6
_NOISE = 1e-12  # of a surface in ln(R/r), which is no ripple and no wave
# Tail of a spectrum that counts as its end, and steps from crest to trough that nodes may have for it.
RESOLVED, MOST = 1e-8, 432
# Tail beyond which nodes do not carry a wave at all.
_LOST = 1e-2
# Crowding of nodes over n h_0/R and the square of the crest's speed, best for layers of 0.05 to 0.5; least.
_CROWDED, _SHARPEST = 10.0, 0.004
# Nodes of the wave beside which its own error is taken, over its own.
_FINER = 1.5
CONDITIONS = ("detuning", "whirl", "crest", "height")


class Branch(StrEnum):
    """Kinds of waves of permanent form, which hold one whirl or have one crest and differ otherwise."""

    ONE_CREST = "one_crest"
    MANY_CRESTS = "many_crests"
    LEE_WAVES = "lee_waves"


@dataclass(frozen=True)
class SteadyWave:
    """A wave of permanent form."""

    at: Nodes  #: nodes
    surface: Array  #: y = ln(R/r) at the nodes, shape (m,)
    detuning: float  #: p^2
    whirl: float  #: w_0/R, the drum's axis from the axis of spin, towards the crest where it is positive
    layer: float  #: h_0/R of the layer at rest
    residual: float  #: of the equations, over the depth; nan where the method found nothing
    converged: bool  #: whether it is rounding

    @property
    def crest(self) -> float:
        """Depth at the crest over that of the layer at rest."""
        return float(-np.expm1(-self.surface[0])) / self.layer

    @property
    def trough(self) -> float:
        """Depth at the trough, half way between two crests, over that of the layer at rest."""
        return float(-np.expm1(-self.surface[-1])) / self.layer

    @property
    def angle(self) -> Array:
        """Angle of each node from the crest, rad, shape (m,)."""
        at = self.at
        return np.asarray(at.u + strip(at, float(at.mean @ self.surface)).shift @ self.surface)

    @property
    def depth(self) -> Array:
        """Depth at each node, over R, shape (m,)."""
        return np.asarray(-np.expm1(-self.surface))

    @property
    def tail(self) -> float:
        """Largest coefficient in the last tenth of the spectrum, k |Y_k| over the largest; 0 for rounding."""
        size = np.arange(self.surface.size) * np.abs(self.at.spectrum(self.surface))
        last = float(size[-(size.size // 10 + 1) :].max())
        return last / float(size.max()) if last > _NOISE else 0.0

    @property
    def single(self) -> bool:
        """Whether the surface falls all the way from the crest to the trough.

        Where it does not, shorter waves ride on the one that was asked for: another branch.
        """
        fall = np.diff(self.surface)
        return bool(fall.max() <= max(_RIPPLE * abs(self.surface[0] - self.surface[-1]), _NOISE))

    @property
    def branch(self) -> Branch:
        """One crest in a turn, many equal ones, or shorter waves on either."""
        if not self.single:
            return Branch.LEE_WAVES
        return Branch.ONE_CREST if self.at.crests == 1 else Branch.MANY_CRESTS

    @property
    def centre(self) -> float:
        """Centre of mass from the drum's axis towards the crest over R; of waves of one crest."""
        if self.at.crests > 1:
            return 0.0
        square, volume = np.exp(-2.0 * self.surface), self.layer * (2.0 - self.layer)
        opened = 1.0 + strip(self.at, float(self.at.mean @ self.surface)).flux @ self.surface
        third = (1.0 - square * np.exp(-self.surface)) / 3.0
        return float(2.0 * self.at.mean @ (np.cos(self.angle) * third * opened)) / volume

    @property
    def force_ratio(self) -> float:
        """Force G on the drum over that of a full chamber [theory: potential, eq. 14]."""
        if self.whirl == 0.0:
            raise InputError("whirl", self.whirl, "other than 0")
        volume = self.layer * (2.0 - self.layer)
        return volume * (1.0 + self.centre / self.whirl)

    @property
    def crest_speed(self) -> float:
        """Speed of the liquid at the crest seen from the wave, over |s|/R: 0 for the highest wave."""
        return float(self.speeds[0])

    @property
    def speeds(self) -> Array:
        """Speed of the liquid along the surface seen from the wave, over |s|/R, against it, shape (m,)."""
        at, y = self.at, self.surface
        operators, square = strip(at, float(at.mean @ y)), np.exp(-2.0 * y)
        opened, steep = 1.0 + operators.flux @ y, at.slope @ y
        speed = 0.5 * operators.flux @ square + square * opened
        return np.asarray(speed / np.sqrt(square * (np.square(opened) + np.square(steep))))

    @property
    def rotation(self) -> float:
        """Mean over the liquid of its angular velocity in the drum, over s [theory: potential, eq. 5]."""
        at, square = self.at, np.exp(-2.0 * self.surface)
        operators = strip(at, float(at.mean @ self.surface))
        # phi, over -s/2, along the surface.
        potential, steep = operators.shift @ square, at.slope @ self.surface
        return float(at.mean @ (potential * steep)) / self.volume

    @property
    def volume(self) -> float:
        """Area of the liquid over pi R^2, by the nodes; h_0/R (2 - h_0/R) is what there should be."""
        opened = 1.0 + strip(self.at, float(self.at.mean @ self.surface)).flux @ self.surface
        return float(self.at.mean @ (-np.expm1(-2.0 * self.surface) * opened))

    def slip_speeds(self) -> tuple[float, float]:
        """Speeds s along the wall over Omega, forward and backward [theory: potential, eq. 10]."""
        p = math.sqrt(self.detuning)
        return p / (1.0 - p), -p / (1.0 + p)


def linear_detuning(layer: float, crests: int = 1) -> float:
    """p^2 of small natural sloshing waves [theory: potential, eq. 15]."""
    ring = (1.0 - layer) ** (2 * crests)
    share = (1.0 - ring) / (1.0 + ring)
    return share / (crests + share)


def at_rest(layer: float, at: Nodes) -> SteadyWave:
    """The layer without a wave, from which the others begin."""
    if not 0.0 < layer < 1.0:
        raise InputError("layer", layer, "between 0 and 1")
    flat = np.full(at.u.size, -math.log1p(-layer))
    return SteadyWave(at, flat, linear_detuning(layer, at.crests), 0.0, layer, 0.0, True)


def solve(begin: SteadyWave, wanted: Mapping[str, float], same: bool = False) -> SteadyWave:
    """The wave that meets two conditions, from one that is near and whose nodes are kept.

    Conditions are two of "detuning" p^2, "whirl" w_0/R, "crest" and, crest less trough, "height", both over
    h_0. With `same` it stays on the branch of `begin`: where rounds after the first, along its tangent,
    change the surface by more than half as much again, they have come to another. Where none is near it is
    `begin`, not converged.
    """
    if len(wanted) != 2 or not set(wanted) <= set(CONDITIONS):
        raise InputError("wanted", ", ".join(wanted), "two of " + ", ".join(CONDITIONS))
    if not all(math.isfinite(value) for value in wanted.values()):
        raise InputError("wanted", str(dict(wanted)), "finite numbers")
    m = begin.surface.size
    # What is given is given at once: from a natural sloshing wave's own detuning no step leads away.
    given = wanted.get("detuning", begin.detuning), wanted.get("whirl", begin.whirl)
    state = np.concatenate((begin.surface, [0.0, *given]))
    first = float(begin.at.mean @ begin.surface)
    # Bernoulli's constant of the surface that is given.
    state[m] = float(np.mean(_equations(begin.at, begin.layer, state, wanted)[0][:m]))
    error, along = math.inf, state[:m]
    for turn in range(_ROUNDS):
        depth = float(begin.at.mean @ state[:m])
        off = np.abs(state[:m]).max() > _FURTHEST
        if off or not _LEAST * first < depth < _GREATEST * first or not state[m + 1] >= 0.0:
            return _broken(begin)
        residual, jacobian = _equations(begin.at, begin.layer, state, wanted)
        before, error = error, float(np.abs(residual).max() / begin.layer)
        if error < _DONE or (error < _ROUNDING and error > 0.5 * before):
            break
        if turn > _PATIENT and error > max(before, _STALLED):
            return _broken(begin)
        try:
            state = state - np.linalg.solve(jacobian, residual)
        except np.linalg.LinAlgError:
            return _broken(begin)
        if not np.isfinite(state).all():
            return _broken(begin)
        along = state[:m] if turn == 0 else along
    strayed = np.abs(state[:m] - along).max() > _NEAR * np.abs(along - begin.surface).max()
    if not error < _ROUNDING or (same and strayed):
        return _broken(begin)
    return replace(
        begin,
        surface=state[:m].copy(),
        detuning=float(state[m + 1]),
        whirl=float(state[m + 2]),
        residual=error,
        converged=True,
    )


def _broken(begin: SteadyWave) -> SteadyWave:
    """Where the method found nothing: what it began with, as not converged."""
    return replace(begin, residual=math.nan, converged=False)


def follow(
    begin: SteadyWave, wanted: Mapping[str, float], steps: int = 4, most: int = MOST, least: float = 2e-3
) -> SteadyWave:
    """The wave that meets two conditions, in steps from another: each that fails is halved.

    For a natural wave a step that puts shorter waves on it fails too: it has come to another branch. A whirl
    brings such waves along in its lee; there a step fails that leaves the tangent. Nodes follow the spectrum,
    up to `most` (0: those of `begin` stay). Where it is not reached, the last wave found, not converged.
    """
    parameters = np.concatenate((begin.surface, [0.0, begin.detuning, begin.whirl]))
    start = {key: _value(parameters, begin.layer, key) for key in wanted}
    wave, reached, step = begin, 0.0, 1.0 / steps
    while reached < 1.0:
        step = min(step, 1.0 - reached)
        goal = {key: start[key] + (reached + step) * (value - start[key]) for key, value in wanted.items()}
        found = solve(wave, goal, same=wanted.get("whirl") != 0.0)
        if _kept(found, wanted):
            found = refined(found, goal, most)
        if _kept(found, wanted) and (most == 0 or found.tail < _LOST):
            wave, reached, step = found, reached + step, 1.4 * step
        elif step < least:
            return replace(wave, converged=False)
        else:
            step *= 0.5
    return wave


def refined(wave: SteadyWave, wanted: Mapping[str, float], most: int = MOST) -> SteadyWave:
    """The same wave on nodes that its spectrum needs, up to `most`, as crowded as its crest is sharp."""
    while wave.tail > RESOLVED and wave.surface.size - 1 < most:
        # A crest is as wide as the layer is deep, and shrinks with the square of its speed as it nears 0.
        sharp = _CROWDED * wave.at.crests * wave.layer * wave.crest_speed**2
        count = min(most, 3 * (wave.surface.size - 1) // 2)
        # Even nodes where it is the trough that is sharp.
        for cluster in dict.fromkeys((min(max(sharp, _SHARPEST), 1.0), 1.0)):
            found = solve(on_nodes(wave, nodes(count, wave.at.crests, cluster)), wanted)
            if _kept(found, wanted) and found.tail <= wave.tail:
                break
        else:
            break
        wave = found
    return wave


def on_more_nodes(wave: SteadyWave, wanted: Mapping[str, float]) -> SteadyWave:
    """The same wave on half as many nodes again, whose own error is far less."""
    count = math.ceil(_FINER * (wave.surface.size - 1))
    return solve(on_nodes(wave, nodes(count, wave.at.crests, wave.at.cluster)), wanted)


def _kept(found: SteadyWave, wanted: Mapping[str, float]) -> bool:
    """Whether this is a wave, and a free one without shorter ones on it."""
    return found.converged and (found.single or wanted.get("whirl") != 0.0)


def forced(layer: float, detuning: float, whirl: float, most: int = MOST) -> SteadyWave:
    """The wave that a whirl holds, followed from the layer at rest."""
    require_not_negative("detuning", detuning)
    require_positive("whirl", whirl)
    begin = solve(at_rest(layer, nodes(min(_FIRST, most))), {"detuning": detuning, "whirl": 0.0})
    # The crest is at u = 0, along the deflection or opposite to it.
    way = 1.0 if detuning < linear_detuning(layer) else -1.0
    return follow(begin, {"detuning": detuning, "whirl": way * whirl}, most=most)


def free(layer: float, crest: float, crests: int = 1, most: int = MOST) -> SteadyWave:
    """The natural sloshing wave with a crest of this depth, followed from small ones."""
    if not crest > 1.0:
        raise InputError("crest", crest, "above 1")
    rest = at_rest(layer, nodes(min(_FIRST, most), crests))
    # Thin layers hardly disperse: only a wave well below the cube of the depth is a cosine.
    small = min(0.2 * layer * layer, 0.5 * (crest - 1.0))
    lifted = rest.surface + small * layer / (1.0 - layer) * np.cos(crests * rest.at.u)
    guess = SteadyWave(rest.at, lifted, rest.detuning, 0.0, layer, math.nan, False)
    begin = solve(guess, {"whirl": 0.0, "crest": 1.0 + small})
    return follow(begin, {"whirl": 0.0, "crest": crest}, 8, most) if begin.converged else begin


def on_nodes(wave: SteadyWave, to: Nodes) -> SteadyWave:
    """The same wave on other nodes, its residual there not yet known."""
    surface = moved(wave.at, wave.surface, to)
    return replace(wave, at=to, surface=surface, residual=math.nan, converged=False)


def _equations(at: Nodes, layer: float, state: Array, wanted: Mapping[str, float]) -> tuple[Array, Array]:
    """Residual and Jacobian: Bernoulli, the volume, two conditions [theory: potential, eq. 7-8]."""
    m = at.u.size
    y, constant, detuning, whirl = state[:m], state[m], state[m + 1], state[m + 2]
    by_strip = strip(at, float(at.mean @ y))
    square, radius = np.exp(-2.0 * y), np.exp(-y)
    opened, d_opened = _linear(by_strip.flux, by_strip.flux_slope, y, at.mean)
    opened = 1.0 + opened
    shifted, d_angle = _linear(by_strip.shift, by_strip.shift_slope, y, at.mean)
    angle = at.u + shifted
    steep = at.slope @ y
    stretch = opened * opened + steep * steep
    d_stretch = 2.0 * (opened[:, None] * d_opened + steep[:, None] * at.slope)
    d_square = np.diag(-2.0 * square)
    speed = 0.5 * by_strip.flux @ square + square * opened
    d_speed = (
        0.5 * (by_strip.flux * (-2.0 * square) + np.outer(by_strip.flux_slope @ square, at.mean))
        + opened[:, None] * d_square
        + square[:, None] * d_opened
    )
    below = 2.0 * square * stretch
    kinetic = speed * speed / below
    d_kinetic = (
        2.0 * (speed / below)[:, None] * d_speed
        - (kinetic / stretch)[:, None] * d_stretch
        + np.diag(2.0 * kinetic)
    )
    cosine, sine = np.cos(angle), np.sin(angle)
    residual, jacobian = np.zeros(m + 3), np.zeros((m + 3, m + 3))
    residual[:m] = detuning * kinetic - 0.5 * square - whirl * radius * cosine - constant
    jacobian[:m, :m] = (
        detuning * d_kinetic
        + np.diag(square + whirl * radius * cosine)
        + (whirl * radius * sine)[:, None] * d_angle
    )
    jacobian[:m, m], jacobian[:m, m + 1], jacobian[:m, m + 2] = -1.0, kinetic, -radius * cosine
    residual[m] = at.mean @ ((1.0 - square) * opened) - layer * (2.0 - layer)
    jacobian[m, :m] = at.mean * 2.0 * square * opened + (at.mean * (1.0 - square)) @ d_opened
    for row, (key, value) in enumerate(wanted.items(), m + 1):
        residual[row] = _value(state, layer, key) - value
        jacobian[row] = _gradient(state, layer, key)
    return residual, jacobian


def _value(state: Array, layer: float, key: str) -> float:
    """Value of the quantity that a condition names."""
    if key in ("detuning", "whirl"):
        return float(state[-2] if key == "detuning" else state[-1])
    crest, trough = -np.expm1(-state[0]) / layer, -np.expm1(-state[-4]) / layer
    return float(crest - trough if key == "height" else crest)


def _gradient(state: Array, layer: float, key: str) -> Array:
    """Derivative of that quantity by the state."""
    found = np.zeros(state.size)
    if key in ("detuning", "whirl"):
        found[-2 if key == "detuning" else -1] = 1.0
    else:
        found[0] = math.exp(-state[0]) / layer
        found[-4] = -math.exp(-state[-4]) / layer if key == "height" else 0.0
    return found


def _linear(operator: Array, slope: Array, y: Array, mean: Array) -> tuple[Array, Array]:
    """An operator of the strip on its own surface, whose mean is the strip's depth, and the derivative."""
    return operator @ y, operator + np.outer(slope @ y, mean)
