"""A branch of limit cycles, followed by its arc length through turning points [theory: whirl, eq. 24-26].

Newton's method on every cell of every layer, the whirl's shape and frequency, and the spin at once: stable
and unstable parts of a branch are alike to it.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.arrays import Array, Complex
from solvers.continuation import slopes
from solvers.cycles.balance import Circular
from solvers.cycles.wave import Answer, Derivatives, LayerWave, StandingWave, Whirling

MakeWave = Callable[[Fill, Friction, int], LayerWave]  # of a layer on so many cells

_ROUNDS = 24
# What is left of the layers' maps over their mean areas, and of the rotor's balance times the weight.
_LEFT, _WEIGHT = 1e-7, 10.0
# Next to a kink of the scheme's limiter Newton's steps go to and fro: this will do once the whirl stays.
_KINKED, _STILL = 1e-5, 3e-6
_SMOOTHING = 8  # cells' times that a layer is left alone where no Newton step helps
_SHORTEST = 1.0 / 16.0  # share of a Newton step
_SLOW = 0.4  # of what was left before: above that the derivatives are found anew
_GONE = 0.5  # of the mean area: a layer this far from a standing wave does not come to one
_FIRST, _LEAST, _MOST = 0.1, 2e-3, 0.4  # of the arc's steps
_FINEST = 0.35  # largest relative change of a whirl's size in a step
_FEW, _MANY = 5, 9  # rounds after which the next step is longer or shorter
_TURN = 0.8  # cosine between two whirls' directions: beyond, the determinant tells which way is onward
_SPREAD, _RANGE = 0.05, 0.1  # changes of whirl speed and of spin that count as a depth of the layer does
_RISE, _STAY = 0.05, 60  # of the whirl in a period, over the depth; most periods after it
_ROUGH = 0.01  # of the mean area: change in a period at which a layer has settled for a first whirl


@dataclass(frozen=True)
class Cycle:
    """A limit cycle; p coordinates, l places of layers, 2 n components of a layer's state."""

    spin: float  #: Omega and omega_w, rad/s
    whirl_speed: float
    moved: Complex  #: the rotor's coordinates in the frame of the whirl, complex, shape (p,)
    given: tuple[Whirling, ...]  #: what drives each layer
    force: Complex  #: G of each layer, complex, shape (l,)
    turning: Array  #: mean rotation of each layer relative to its drum, rad/s, shape (l,)
    state: Array  #: of each layer, the deflection of its axis pointing to the first cell, shape (l, 2 n)
    derivatives: tuple[Derivatives, ...]  #: of each layer's map there
    tangent: Array  #: direction of the branch, all unknowns of `Follower`, those of the rotor of length 1
    sense: float  #: sign of the determinant of the equations' derivatives, bordered by the tangent
    arc: float  #: length of the branch up to it


@dataclass(frozen=True)
class _Point:
    """Unknowns on the way: those of the layers one after the other, and those of the rotor."""

    state: Array
    vector: Array

    def moved(self, change: Array) -> _Point:
        """The point further on by a change of all unknowns."""
        count = self.state.size
        return _Point(self.state + change[:count].reshape(self.state.shape), self.vector + change[count:])


@dataclass(frozen=True)
class _Left:
    """What is left of the equations: G of the layers, the residuals of all unknowns, and their size."""

    forces: list[complex]
    residual: Array
    size: float


class Follower:
    """Follows limit cycles, of `cells` to a layer; `speed`, rad/s, scales spin and frequency.

    Unknowns of the rotor are real and imaginary parts of the coordinates over `unit`, whirl speed over 0.05
    `speed` and spin over 0.1 `speed`.
    """

    def __init__(
        self,
        machine: Circular,
        friction: Friction,
        cells: int,
        speed: float,
        wave: MakeWave = StandingWave,
    ) -> None:
        self.machine, self.speed = machine, speed
        self.waves = [wave(place.fill, friction, cells) for place in machine.places]
        rows = np.array([place.row for place in machine.places])
        heavy = int(np.argmax([place.mass for place in machine.places]))
        self.depth = machine.places[heavy].fill.depth
        self.unit = self.depth / float(np.abs(rows[heavy]).max())
        self._coordinates = rows.shape[1]
        self._rows, self._watched = rows, heavy
        self._radius = np.array([place.fill.chamber.radius for place in machine.places])
        self._rounds = 0

    def unknowns(self, moved: Complex, whirl_speed: float, spin: float) -> Array:
        """Unknowns of the rotor, shape (2 p + 2,)."""
        part = moved / self.unit
        speeds = (whirl_speed / (_SPREAD * self.speed), spin / (_RANGE * self.speed))
        return np.concatenate([part.real, part.imag, speeds])

    @property
    def scales(self) -> tuple[float, float, float]:
        """Changes of spin, whirl speed and amplitude that count alike along a branch."""
        return _RANGE * self.speed, _SPREAD * self.speed, self.unit

    def parts(self, vector: Array) -> tuple[Complex, float, float]:
        """Coordinates, whirl speed and spin of unknowns of the rotor."""
        p = self._coordinates
        moved = np.asarray(self.unit * (vector[:p] + 1j * vector[p : 2 * p]), dtype=complex)
        return moved, float(vector[-2]) * _SPREAD * self.speed, float(vector[-1]) * _RANGE * self.speed

    def given(self, vector: Array) -> list[Whirling]:
        """Whirl that drives each layer."""
        moved, whirl_speed, spin = self.parts(vector)
        sizes = np.abs(self._rows @ moved) / self._radius
        return [
            Whirling(whirl_speed / spin, float(size), wave.drag(spin, whirl_speed))
            for wave, size in zip(self.waves, sizes, strict=True)
        ]

    def size(self, cycle: Cycle) -> float:
        """Largest deflection of a layer's axis over the depth of the largest layer."""
        return float(np.abs(self._rows @ cycle.moved).max()) / self.depth

    def _widening(self, cycle: Cycle) -> float:
        """Change of the size over the arc's length along the branch, without sign."""
        p = self._coordinates
        tangent = cycle.tangent[-2 * p - 2 :]
        way = self._rows @ (self.unit * (tangent[:p] + 1j * tangent[p : 2 * p]))
        at = self._rows @ cycle.moved
        rate = (at.conj() * way).real / np.maximum(np.abs(at), 1e-300)
        return float(np.abs(rate).max()) / self.depth

    def thinnest(self, cycle: Cycle) -> float:
        """Least depth of a layer over its mean depth."""
        pairs = zip(self.waves, cycle.state, strict=True)
        return min(wave.thinnest(state) for wave, state in pairs)

    def start(
        self,
        moved: Complex,
        whirl_speed: float,
        spin: float,
        size: float,
        lag: float = 0.0,
        hold_size: bool = False,
    ) -> Cycle | None:
        """Limit cycle at a spin near a whirl of a shape and size over the layer's depth; None if not found.

        `lag` of the liquid behind the drum at first, rad/s; with `hold_size` one of that size, at whatever
        spin.
        """
        watched = complex(self._rows[self._watched] @ moved)
        shape = moved * (cmath.exp(-1j * cmath.phase(watched)) / float(np.abs(self._rows @ moved).max()))
        vector = self.unknowns(size * self.depth * shape, whirl_speed, spin)
        for wave in self.waves:
            wave.lag(lag / spin)
        if not self._grown(vector, size):
            return None
        towards = np.zeros(vector.size)
        if hold_size:
            towards[:-2] = vector[:-2] / np.linalg.norm(vector[:-2])
        else:
            towards[-1] = 1.0
        point = _Point(np.array([wave.state for wave in self.waves]), vector)
        found = self._corrected(point, vector, towards)
        return None if found is None else self._cycle(found, towards, 0.0)

    def _grown(self, vector: Array, size: float) -> bool:
        """March the layers while the whirl grows: a sudden one would throw them to the axis."""
        rise = max(1, math.ceil(size / _RISE))
        for wave, given in zip(self.waves, self.given(vector), strict=True):
            for k in range(rise + _STAY):
                share = min(1.0, (k + 1) / rise)
                last = wave.state
                if wave.period(given._replace(size=share * given.size)) is None:
                    return False
                if k > rise + 2 and float(np.abs(wave.state - last).max()) < _ROUGH * wave.mean:
                    break
        return True

    def after(self, cycle: Cycle) -> Iterator[Cycle]:
        """Limit cycles on along the branch, until one is not found."""
        length = _FIRST
        while length >= _LEAST:
            found = self.step(cycle, length)
            if found is None:
                length *= 0.5
                continue
            cycle = found
            yield cycle
            length *= 1.6 if self._rounds <= _FEW else 1.0 if self._rounds <= _MANY else 0.7
            length = min(length, _MOST)
            # Towards an edge the size goes with the root of the speed's distance.
            length = min(length, _FINEST * self.size(cycle) / max(self._widening(cycle), 1e-3))

    def step(self, cycle: Cycle, length: float) -> Cycle | None:
        """The limit cycle further on along the branch by a length of arc; None where it is not found."""
        origin = self.unknowns(cycle.moved, cycle.whirl_speed, cycle.spin)
        point = self._kept(_Point(cycle.state, origin).moved(length * cycle.tangent))
        towards = cycle.tangent[-origin.size :]
        found = self._corrected(point, point.vector, towards)
        return None if found is None else self._cycle(found, towards, cycle.arc + length, cycle.sense)

    def at(self, cycle: Cycle, spin: float) -> Cycle | None:
        """The limit cycle at a spin, rad/s, next to one that is known; None where it is not found."""
        origin = self.unknowns(cycle.moved, cycle.whirl_speed, cycle.spin)
        towards = np.zeros(origin.size)
        towards[-1] = 1.0
        rise = (spin - cycle.spin) / (_RANGE * self.speed)
        length = rise / cycle.tangent[-1] if cycle.tangent[-1] else 0.0
        point = self._kept(_Point(cycle.state, origin).moved(length * cycle.tangent))
        found = self._corrected(point, point.vector, towards)
        way = cycle.tangent[-origin.size :]
        return None if found is None else self._cycle(found, way, cycle.arc + length, cycle.sense)

    def _kept(self, point: _Point) -> _Point:
        states = [wave.kept(state) for wave, state in zip(self.waves, point.state, strict=True)]
        return _Point(np.array(states), point.vector)

    def _answers(self, point: _Point) -> list[Answer] | None:
        """The layers after the time of a cell; None where one breaks down."""
        triples = zip(self.waves, point.state, self.given(point.vector), strict=True)
        found = [wave.cell(state, given) for wave, state, given in triples]
        answers = [answer for answer in found if answer is not None]
        return answers if len(answers) == len(found) else None

    def _derivatives(self, point: _Point) -> list[Derivatives] | None:
        found = []
        for wave, state, given in zip(self.waves, point.state, self.given(point.vector), strict=True):
            wave.state = state
            derivatives = wave.linearise(given)
            if derivatives is None:
                return None
            found.append(derivatives)
        return found

    def _corrected(self, point: _Point, origin: Array, towards: Array) -> _Point | None:
        """Newton's method on the plane across `towards` through `origin`."""
        factors, seen = None, self._left(point, origin, towards)
        for self._rounds in range(1, _ROUNDS + 1):
            if seen is None or not seen.size < _GONE:
                return None
            if seen.size < _LEFT:
                return point
            fresh = factors is None
            if factors is None:
                derivatives = self._derivatives(point)
                seen = self._left(point, origin, towards)
                if derivatives is None or seen is None:
                    return None
                slopes = self._slopes(point, seen.forces, derivatives)
                factors = lu_factor(np.vstack([slopes, self._across(towards)]))
            change = -lu_solve(factors, seen.residual)
            if not np.isfinite(change).all():
                return None
            share, best = 1.0, None
            while share >= _SHORTEST:
                tried = self._kept(point.moved(share * change))
                found = self._left(tried, origin, towards)
                if found is not None and found.size < (1.0 - 0.5 * share) * seen.size:
                    best = tried, found
                    break
                if not fresh:
                    break
                share *= 0.5
            moving = share * float(np.abs(change[-origin.size :]).max())
            if best is None:
                if not fresh:
                    factors = None
                    continue
                if seen.size < _KINKED:
                    return point
                smoothed = self._smoothed(point)
                if smoothed is None:
                    return None
                point, seen, factors = smoothed, self._left(smoothed, origin, towards), None
                continue
            last, (point, seen) = seen.size, best
            if moving < _STILL and seen.size < _KINKED:
                return point
            if seen.size > _SLOW * last:
                factors = None
        return point if seen is not None and seen.size < _KINKED else None

    def _smoothed(self, point: _Point) -> _Point | None:
        """The layers some cells' times later: what a kink has left of Newton's steps dies out first."""
        for _ in range(_SMOOTHING):
            answers = self._answers(point)
            if answers is None:
                return None
            point = _Point(np.array([answer.state for answer in answers]), point.vector)
        return point

    def _left(self, point: _Point, origin: Array, towards: Array) -> _Left | None:
        """What is left of all equations at a point; None where a layer breaks down."""
        if not point.vector[-1] > 0.0:
            return None
        answers = self._answers(point)
        if answers is None:
            return None
        forces = [answer.force for answer in answers]
        gaps = np.array([answer.state for answer in answers]) - point.state
        rotor = np.append(self._balance(point.vector, forces), towards @ (point.vector - origin))
        layers = np.abs(gaps).max(axis=1) / [wave.mean for wave in self.waves]
        size = float(max(layers.max(), _WEIGHT * np.abs(rotor).max()))
        return _Left(forces, np.concatenate([gaps.ravel(), rotor]), size)

    def _across(self, towards: Array) -> Array:
        """Row of the condition that the rotor's unknowns lie on a plane."""
        count = sum(wave.state.size for wave in self.waves)
        return np.concatenate([np.zeros(count), towards])

    def _balance(self, vector: Array, forces: list[complex]) -> Array:
        """What is left of the rotor's balance and of the phase, given G of the layers, shape (2 p + 1,)."""
        moved, whirl_speed, spin = self.parts(vector)
        left = self.machine.gap(whirl_speed, spin, moved, forces) / (self.unit * self.speed**2)
        phase = (self._rows[self._watched] @ moved).imag / self.depth
        return np.concatenate([left.real, left.imag, [phase]])

    def _slopes(self, point: _Point, forces: list[complex], derivatives: list[Derivatives]) -> Array:
        """Derivatives of the layers' maps, less the states, and of `_balance`, by all unknowns."""
        vector, layers = point.vector, len(self.waves)
        size, unknown = point.state.shape[1], vector.size
        matrix = np.zeros((layers * size + unknown - 1, layers * size + unknown))
        rotor = slice(layers * size, None)
        matrix[rotor, rotor] = slopes(lambda v: self._balance(v, forces), vector)
        drives = slopes(lambda v: np.ravel(self.given(v)), vector).reshape(layers, 3, unknown)
        moved, whirl_speed, _ = self.parts(vector)
        scale = -(whirl_speed**2) / (self.unit * self.speed**2)
        for k, (place, found) in enumerate(zip(self.machine.places, derivatives, strict=True)):
            own = slice(k * size, (k + 1) * size)
            matrix[own, own] = self.waves[k].closed(found.state)
            matrix[own, rotor] = found.given @ drives[k]
            push = scale * place.full_mass * (place.row @ moved) * place.row.conj()
            by_state, by_rotor = np.outer(push, found.force), np.outer(push, found.force_given @ drives[k])
            none = np.zeros((1, size))
            matrix[rotor, own] = np.vstack([by_state.real, by_state.imag, none])
            matrix[rotor, rotor] += np.vstack([by_rotor.real, by_rotor.imag, none[:, :unknown]])
        return matrix

    def _cycle(self, point: _Point, towards: Array, arc: float, sense: float = 0.0) -> Cycle | None:
        """The limit cycle of a solution, with derivatives found there and the branch's direction.

        Along a branch the sign of the determinant stays, even at a kink, where a short step may turn the
        direction by any angle; next to one derivatives of both sides may be mixed: there small turns count.
        """
        answers, derivatives = self._answers(point), self._derivatives(point)
        if answers is None or derivatives is None:
            return None
        forces = [answer.force for answer in answers]
        matrix = np.vstack([self._slopes(point, forces, derivatives), self._across(towards)])
        ahead = np.zeros(len(matrix))
        ahead[-1] = 1.0
        tangent = np.linalg.solve(matrix, ahead)
        size = float(np.linalg.norm(tangent[-point.vector.size :]))
        found = float(np.linalg.slogdet(matrix)[0])
        # `towards` is a unit vector across which the direction's component is 1.
        if sense and size * _TURN > 1.0 and found != sense:
            size, found = -size, sense
        moved, whirl_speed, spin = self.parts(point.vector)
        return Cycle(
            spin=spin,
            whirl_speed=whirl_speed,
            moved=moved,
            given=tuple(self.given(point.vector)),
            force=np.array(forces),
            turning=spin * np.array([answer.turning for answer in answers]),
            state=point.state,
            derivatives=tuple(derivatives),
            tangent=np.asarray(tangent / size, dtype=np.float64),
            sense=sense or found,
            arc=arc,
        )
