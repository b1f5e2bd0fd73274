"""Whirl modes of any rotor with layers of laminar friction: a nonlinear eigenproblem.

The drag of a laminar layer goes with the square root of the slip, and so differs from mode to mode. With the
layers eliminated the modes are zeros of a determinant, found together by Aberth's iteration.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fluid.whirl import Layer, plate_rate, plate_terms, steady_rate, stokes_rate
from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.system import RotorSystem
from solvers.whirl.count import Characteristic, Region, missed_modes, packed
from solvers.whirl.sheets import standing_roots
from solvers.whirl.system import (
    SystemModes,
    coupled_matrices,
    joined,
    linear_roots,
    sense_of,
)

Placed = tuple[float, Layer]
Groups = Sequence[tuple[list[int], int]]  # equal layers, and in how many ways they move with the rotor

_EPS = float(np.finfo(float).eps)
_NONE = complex(np.nan, np.nan)
_BLOCK = 128  # speeds whose arrays fit the processor's cache
_APART = 1.05  # of two speeds: from the modes at one those at the other are found
_STEEPEST = 3.0  # change of a mode over that of the spin, beyond which none is foretold
_FEW = 32
_NEXT = 1e-5  # relative distance up to which a second speed tells slopes
_LESS = 0.03  # of the spin: modes that grow by so much less are not followed where the most growing serve
_SWEEPS = 60
_OWN = 8  # steps to the waves with floor and lid at their own frequencies
_WAVE = 1e-9  # relative: a step after which such a wave is exact
_CUTS = (1.0, 3.0)  # over the spin: where the roots of the drags on circles along and against it end
_STEP = 1e-13  # relative, at which a root counts as found
_CLOSE = 1e-8  # the same next to a speed at which it is known, where a further step would be rounding
_REAL = 1e-12  # relative: imaginary part of a real root, by rounding
_ALIKE = 1e-6  # relative: the sense is told of modes that grow so nearly as much as the one that grows most
_GONE = -1e300  # lambda of what has no wave, 1/s
_LEAST = 1e-7  # relative, which noise of the determinant may hide
_BESIDE = (1e-7, 1e-5, 1e-3)  # of the spin: how far left of the mode that grows most the others are counted
_ASIDE = 1e-4  # of the spin: how far left of that what is no mode starts at least
_MOST = 40  # coordinates of a rotor with its layers, for which all modes are computed where some were missed
# Complex displacements along and against the spin from the two real ones, and back.
_CIRCLES = np.array([[1.0, 1.0j], [1.0, -1.0j]], dtype=complex)
_AXES = np.array([[0.5, 0.5], [-0.5j, 0.5j]], dtype=complex)


@dataclass(frozen=True, eq=False)
class _Problem:
    """The rotor with layers of laminar friction."""

    system: RotorSystem  #: the dry rotor
    layers: Sequence[Placed]  #: plane, m, and layer
    weights: Array  #: of each layer, how often the poles of its waves stand in the determinant
    degree: int  #: of the determinant without its poles, far away

    @cached_property
    def circles(self) -> _Circles:
        """Numbers of the layers for circles along the spin, then against it."""
        kinds = [
            (1.0 if side == 0 else -1.0, *(x.mass, x.layer_tanh, x.rate, x.stokes, x.lids), weight)
            for side in (0, 1)
            for (_, x), weight in zip(self.layers, self.weights, strict=True)
        ]
        places = [
            np.outer(at.T @ _AXES[:, side], _CIRCLES[side] @ at)
            for side in (0, 1)
            for at in (self.system.at(plane) for plane, _ in self.layers)
        ]
        system = self.system
        parts = [system.mass, system.damping, system.gyroscopic, system.stiffness, *places]
        sense, mass, tanh, rate, stokes, lids, weight = np.array(kinds).T[:, :, None]
        each = np.array(parts, dtype=complex).reshape(len(parts), -1)
        return _Circles(sense, mass, tanh, rate, stokes, lids, weight, each)


@dataclass(frozen=True)
class _Circles:
    """Layers in circles along the spin, then against it, shape (2 L, 1)."""

    sense: Array  #: 1 along the spin, -1 against it
    mass: Array  #: as of `fluid.whirl.Layer`
    tanh: Array
    rate: Array
    stokes: Array
    lids: Array
    weight: Array  #: as of `_Problem`
    #: M, C, G and K of the rotor, then what a force on each circle does, shape (4 + 2 L, N^2)
    parts: Complex


@dataclass
class Met:
    """Modes of a machine that a study has found on its way, all of a speed, from which others start."""

    speed: Array = field(default_factory=lambda: np.zeros(0))
    half: Complex = field(default_factory=lambda: np.zeros((0, 0), dtype=complex))  #: as of `_half`
    slope: Complex = field(default_factory=lambda: np.zeros((0, 0), dtype=complex))  #: over the spin

    def add(self, speed: Array, modes: SystemModes) -> None:
        """Keep modes where none is missing."""
        whole = np.flatnonzero(modes.complete & (modes.found | (modes.root == _GONE)).all(axis=1))
        half = _half(modes.root[whole], modes.found[whole], speed[whole])
        self.speed = np.concatenate([self.speed, speed[whole]])
        self.half, self.slope = _stacked(self.half, half), _stacked(self.slope, np.zeros_like(half))

    def lead(self, speed: Array, half: Complex, found: Flags) -> None:
        """Take slopes from the same modes at speeds next to some that were added last."""
        if self.speed.size == 0:
            return
        at = self._nearest(speed)
        gap = speed - self.speed[at]
        row = np.flatnonzero((gap > 0.0) & (gap <= _NEXT * speed))
        width = min(half.shape[1], self.half.shape[1])
        change = (half - self.half[at][:, :width])[row, :width] / gap[row, None]
        sure = found[row, :width] & (np.abs(change) <= _STEEPEST)
        self.slope[at[row], :width] = np.where(sure, change, 0.0)

    def near(self, speed: Array) -> tuple[Flags, Complex]:
        """At which speeds some are close by, and what is expected there from the nearest, shape (k, m)."""
        if self.speed.size == 0:
            return np.zeros(speed.shape, dtype=bool), np.zeros((0, 0), dtype=complex)
        at = self._nearest(speed)
        close = np.abs(np.log(self.speed[at] / speed)) <= np.log(_APART)
        at = at[close]
        return close, self.half[at] + self.slope[at] * (speed[close] - self.speed[at])[:, None]

    def _nearest(self, speed: Array) -> Index:
        """Where those at the nearest speed stand, for each of some."""
        order = np.argsort(self.speed, kind="stable")
        above = np.searchsorted(self.speed[order], speed)
        sides = order[np.clip(np.stack([above - 1, above]), 0, order.size - 1)]
        away = np.abs(np.log(self.speed[sides] / speed))
        return np.asarray(np.where(away[0] <= away[1], sides[0], sides[1]))


def _stacked(first: Complex, second: Complex) -> Complex:
    """Rows of one table below those of another, nan where one is wider."""
    width = max(first.shape[1], second.shape[1])
    found = np.full((len(first) + len(second), width), _NONE)
    found[: len(first), : first.shape[1]], found[len(first) :, : second.shape[1]] = first, second
    return found


def _half(root: Complex, found: Flags, speed: Array) -> Complex:
    """Roots above the real axis, which stand for their conjugates as well, and on it; nan for others."""
    real = np.abs(root.imag) <= _REAL * (np.abs(root) + speed[:, None])
    kept = found & (real | (root.imag > 0.0))
    return packed(np.where(kept, np.where(real, root.real, root), _NONE))


def laminar_modes(
    system: RotorSystem,
    layers: Sequence[Placed],
    speed: Array,
    near: SystemModes | None = None,
    every: bool = True,
    met: Met | None = None,
) -> SystemModes:
    """Modes with laminar friction, whose drag depends on the mode [theory: whirl, eq. 12-14].

    From the rotor with liquid at rest and the waves of each layer on a drum at rest; waves of equal layers
    against one another do not move the rotor. All at once where the argument principle says that a mode which
    grows more was missed. `near`: modes at speeds next to these, from which they are followed; others are not
    looked for then. Without `every` only those that grow most are found at some of the speeds, and the way
    round is told of them. `met`: what is known of the machine, from which the search starts and which grows.
    """
    groups = _groups(system, layers)
    weights = np.ones(len(layers))
    for members, rank in groups:
        weights[members] = rank / len(members)
    degree = 2 * len(system.coordinates) + 4 * sum(rank for _, rank in groups)
    problem = _Problem(system, layers, weights, degree)
    waves = [
        _layer_waves(problem.layers[members[0]][1], speed) for members, rank in groups if rank < len(members)
    ]
    if near is not None:
        own = near.root.shape[1] - sum(wave.shape[1] for wave in waves)
        start = _half(near.root[:, :own], near.found[:, :own], speed)
        modes = _aberth(problem, start, speed, half=True, least=_CLOSE)
        if met is not None:
            met.lead(speed, modes.root[:, : start.shape[1]], modes.found[:, : start.shape[1]])
        return _with_waves(modes, waves, speed)
    known = Met() if met is None else met
    lonely = np.flatnonzero(~known.near(speed)[0])
    first = lonely[_anchors(speed[lonely])]
    parts, places = [], []
    for cut in _blocks(first):
        parts.append(_all_counted(problem, _starts(problem, groups, speed[cut]), speed[cut]))
        known.add(speed[cut], parts[-1])
        places.append(cut)
    # Modes hardly differ from those at a speed close by: from there few sweeps lead to them.
    rest = np.setdiff1d(np.arange(speed.size), first)
    close, start = known.near(speed[rest])
    beside = rest[close]
    for cut in _blocks(rest[~close]):
        parts.append(_all_counted(problem, _starts(problem, groups, speed[cut]), speed[cut]))
        places.append(cut)
    for cut in _blocks(np.arange(beside.size)):
        parts.append(_followed(problem, start[cut], speed[beside[cut]], every))
        places.append(beside[cut])
        if every:
            known.add(speed[beside[cut]], parts[-1])
    width = max(part.root.shape[1] for part in parts)
    modes = joined([part.widened(width, _GONE) for part in parts]).at(np.argsort(np.concatenate(places)))
    if not every:
        modes = _with_sense(problem, modes, speed)
    return _with_waves(modes, waves, speed)


def _anchors(speed: Array) -> Index:
    """Speeds some way apart; all of few, whose sweeps cost the same whatever they start from."""
    if speed.size <= _FEW:
        return np.arange(speed.size)
    kept: list[int] = []
    for k in np.argsort(speed, kind="stable").tolist():
        if not kept or speed[k] > _APART * speed[kept[-1]]:
            kept.append(k)
    return np.array(kept, dtype=np.intp)


def _blocks(which: Index) -> list[Index]:
    """Some at a time."""
    return [which[first : first + _BLOCK] for first in range(0, which.size, _BLOCK)]


def _followed(problem: _Problem, start: Complex, speed: Array, every: bool) -> SystemModes:
    """Modes of a block of speeds from what is expected of all above the real axis and on it.

    Without `every` those are followed that grow most, up to where one is missed.
    """
    if every:
        return _all_counted(problem, start, speed, half=True)
    most = np.nanmax(start.real, axis=1) - _LESS * speed
    modes = _aberth(problem, start, speed, start.real >= most[:, None], half=True)
    modes = _counted(problem, modes, speed, start)
    missed = np.flatnonzero(~modes.complete)
    if missed.size:
        again = _all_counted(problem, start[missed], speed[missed], half=True)
        modes = modes.replaced(missed, again, _GONE)
    return modes


def _all_counted(problem: _Problem, start: Complex, speed: Array, half: bool = False) -> SystemModes:
    """Modes from starting values as of `_aberth`; where some were missed, from all of them at once."""
    modes = _counted(problem, _aberth(problem, start, speed, half=half), speed, start)
    missed = np.flatnonzero(~modes.complete)
    size = len(problem.system.coordinates) + 2 * len(problem.layers)
    if missed.size and size <= _MOST:
        again = all_modes(problem.system, problem.layers, speed[missed])
        others = _counted(problem, _aberth(problem, again, speed[missed]), speed[missed], start[missed])
        modes = modes.replaced(missed, others, _GONE)
    return modes


def _starts(problem: _Problem, groups: Groups, speed: Array) -> Complex:
    """Rotor with its liquid at rest and the waves of each layer on a drum at rest, shape (n, m).

    Moved, each by its own step, so that no two start alike or on a pole.
    """
    heavy = problem.system
    for plane, layer in problem.layers:
        at = problem.system.at(plane)
        heavy = replace(heavy, mass=heavy.mass + layer.mass * at.T @ at)
    dry = linear_roots(coupled_matrices(heavy, [], speed))
    turn = 1j * speed[:, None]
    started = [dry * (1.0 + 1e-3 * (1.0 + 0.37j) * (1.0 + np.arange(dry.shape[1]) / 3.0))]
    for members, rank in groups:
        wave = _layer_waves(problem.layers[members[0]][1], speed)
        for k in range(rank):
            pushed = turn + (wave - turn) * (1.0 + 1e-3 * (1.0 + 0.37j) * (1.0 + k))
            started += [pushed, pushed.conj()]
    return np.concatenate(started, axis=1)


def _counted(problem: _Problem, modes: SystemModes, speed: Array, start: Complex) -> SystemModes:
    """The modes, complete where no other grows more than the one of those found that grows most."""
    # Of what they started from, and where the drag of a layer, stokes lambda^1.5, equals lambda^2.
    drag = max(layer.stokes for _, layer in problem.layers) ** 2
    fastest = np.maximum(np.nanmax(np.abs(start), axis=1), drag)

    def determinant(own: Index) -> Characteristic:
        def at(points: Complex, owner: Index) -> Complex:
            here = _eliminate(problem, points, speed[own[owner]], slopes=False)
            unit, size = np.linalg.slogdet(here.matrix)
            return np.asarray(size + 1j * np.angle(unit) + here.waves)

        return at

    rate = np.where(modes.found, modes.root.real, -np.inf)
    best, complete = rate.max(axis=1, initial=-np.inf), np.zeros(speed.shape, dtype=bool)
    unsure = np.flatnonzero(np.isfinite(best))
    # Where rounding hides the phase so close to the modes found, farther from them; that claims more.
    for beside in _BESIDE:
        spin = speed[unsure]
        region = Region(best[unsure] - beside * spin, np.outer(spin, _CUTS), spin, fastest[unsure])
        # What is near a mode only makes smooth what is followed: left of the line it wins or loses none.
        root, found = modes.root[unsure], modes.found[unsure]
        left = (root.real < (region.line - _ASIDE * spin)[:, None]) & (root.imag >= 0.0) & (root != _GONE)
        known, rough = (np.where(own, root, complex(np.nan, np.nan)) for own in (found, left & ~found))
        count = missed_modes(determinant(unsure), problem.degree, known, region, rough)
        complete[unsure] = count == 0.0
        unsure = unsure[np.isnan(count)]
        if unsure.size == 0:
            break
    return replace(modes, complete=complete)


def _with_waves(modes: SystemModes, waves: Sequence[Complex], speed: Array) -> SystemModes:
    """Modes with the waves of equal layers against one another."""
    if not waves:
        return modes
    more = np.concatenate(waves, axis=1)
    gone = np.isnan(more)
    more = np.where(gone, _GONE, more)
    return SystemModes(
        np.concatenate([modes.root, more], axis=1),
        np.concatenate([modes.sense, np.ones(more.shape)], axis=1),
        np.concatenate([modes.rounding, 16.0 * _EPS * (np.abs(more) + speed[:, None])], axis=1),
        np.concatenate([modes.found, ~gone], axis=1),
        modes.complete,
    )


def _groups(system: RotorSystem, layers: Sequence[Placed]) -> list[tuple[list[int], int]]:
    """Equal layers, and in how many independent ways they move with the rotor."""
    found: dict[tuple[float, ...], list[int]] = {}
    for j, (_, layer) in enumerate(layers):
        found.setdefault((layer.layer_tanh, layer.rate, layer.stokes, layer.lids), []).append(j)
    ranks = []
    for members in found.values():
        along = np.array([_CIRCLES[0] @ system.at(layers[j][0]) for j in members])
        ranks.append(int(np.linalg.matrix_rank(along)) if len(members) > 1 else 1)
    return list(zip(found.values(), ranks, strict=True))


def _layer_waves(layer: Layer, speed: Array) -> Complex:
    """Natural sloshing waves lambda of a layer with laminar friction, nan for what has no wave, shape (n, 4).

    Zeros of E in p = sqrt(i s/Omega) with a positive real part [theory: whirl, eq. 13]; floor and lid drag as
    on the slower one.
    """
    t, rate = layer.layer_tanh, steady_rate(layer, speed) / speed
    companion = np.zeros((speed.size, 4, 4), dtype=complex)
    companion[:, 1:, :3] = np.eye(3)
    # p^4 + stokes p^3 + (k - 2 i T) p^2 + T = 0.
    companion[:, 0, 3] = -t
    companion[:, 2, 3] = 2j * t - rate
    companion[:, 3, 3] = -layer.stokes / np.sqrt(speed)
    p = np.linalg.eigvals(companion)
    row, column = np.nonzero(p.real > 0.0)
    spin, own = speed[row], p[row, column]
    linear, stokes, lids = layer.rate / spin, layer.stokes / np.sqrt(spin), layer.lids / np.sqrt(spin)
    step: Complex = np.zeros_like(own)
    for _ in range(_OWN):
        plates, rise = plate_terms(t, 1.0, -1j * np.square(own))
        steady = linear + lids * plates - 2j * t
        wave = np.square(own) * (np.square(own) + stokes * own + steady) + t
        slope = own * (4.0 * np.square(own) + 3.0 * stokes * own + 2.0 * steady)
        step = wave / (slope - 2j * lids * rise * own**3)
        own = own - step
        if np.all(np.abs(step) <= _WAVE * np.abs(own)):
            break
    settled = (np.abs(step) <= _WAVE * np.abs(own)) & (own.real > 0.0)
    waves = np.full(p.shape, complex(np.nan, np.nan))
    waves[row[settled], column[settled]] = ((np.square(own) + 1j) * spin)[settled]
    return waves


def _aberth(
    problem: _Problem,
    start: Complex,
    speed: Array,
    followed: Flags | None = None,
    half: bool = False,
    least: float = _STEP,
) -> SystemModes:
    """Zeros of the determinant from starting values; nan starts stay nan.

    Converged ones, by a step of `least`, are left out of further sweeps, but the others keep away from them.
    With `half` starts stand for their conjugates as well, which move as they do, and those on the real axis
    stay there. Where some are followed all take one step, and only they go on.
    """
    absent = np.isnan(start)
    root = np.where(absent, 0.0, start)
    twin = half & (root.imag != 0.0)
    step, last = np.full(root.shape, np.inf), np.zeros(root.shape)
    row, column = np.nonzero(~absent)
    for _ in range(_SWEEPS):
        if row.size == 0:
            break
        own = root[row, column]
        here = _eliminate(problem, own, speed[row])
        slope = np.trace(_solve(here.matrix, here.slope), axis1=-2, axis2=-1) + here.poles
        bottom = slope - _repulsion(own, root[row], ~absent[row])
        if half:
            bottom -= _repulsion(own, root[row].conj(), twin[row])
        moved = np.zeros_like(own)
        np.divide(1.0, bottom, out=moved, where=np.abs(bottom) > 0.0)
        if half:
            moved.imag[~twin[row, column]] = 0.0
        root[row, column] = own - moved
        last[row, column], step[row, column] = step[row, column], np.abs(moved)
        on = np.abs(moved) > least * (np.abs(root[row, column]) + speed[row])
        on &= True if followed is None else followed[row, column]
        row, column = row[on], column[on]
    scale = np.abs(root) + speed[:, None]
    found = (step <= _LEAST * scale) & ~absent
    last = np.where(np.isfinite(last), last, step)
    rounding = 16.0 * (_EPS * scale + np.where(found, np.maximum(step, last * _LEAST), 0.0))
    if half:
        root, absent = np.hstack([root, root.conj()]), np.hstack([absent, ~twin])
        rounding, found = np.hstack([rounding, rounding]), np.hstack([found, found & twin])
    # What has no wave decays faster than any that has.
    root = np.where(absent, _GONE, root)
    return SystemModes(root, np.ones(root.shape), rounding, found, np.zeros(speed.shape, dtype=bool))


def _repulsion(own: Complex, others: Complex, present: Flags) -> Complex:
    """Sum of 1/(own - other) over the other roots of its speed that are present, shape (k,)."""
    gap = own[:, None] - others
    other = np.zeros_like(gap)
    np.divide(1.0, gap, out=other, where=(gap != 0.0) & present)
    return np.asarray(other.sum(axis=1))


def _with_sense(problem: _Problem, modes: SystemModes, speed: Array) -> SystemModes:
    """Modes with the way round of those that grow most."""
    rate = np.where(modes.found, modes.root.real, -np.inf)
    scale = np.where(modes.found, np.abs(modes.root) + speed[:, None], 0.0)
    most = modes.found & (rate >= rate.max(axis=1, keepdims=True, initial=-np.inf) - _ALIKE * scale)
    sense = modes.sense.copy()
    sense[most] = _sense(problem, modes.root[most], speed[np.nonzero(most)[0]])
    return replace(modes, sense=sense)


def _sense(problem: _Problem, root: Complex, spin: Array) -> Array:
    """Which way round the modes at roots go, shape (k,)."""
    here = _eliminate(problem, root, spin)
    # One step of inverse iteration: next to its zero the matrix hardly leaves anything but the mode.
    vector = _solve(here.matrix, np.exp(1j * np.arange(here.matrix.shape[-1]))[:, None])[..., 0]
    vector = vector / np.abs(vector).max(axis=-1, keepdims=True)
    sizes, count = [], len(problem.layers)
    for side in (0, 1):
        total, shares = np.zeros(root.shape), here.shares[side * count : (side + 1) * count]
        for (plane, _), share in zip(problem.layers, shares, strict=True):
            circle = np.abs(vector @ (_CIRCLES[side] @ problem.system.at(plane)))
            total += (1.0 + np.square(np.abs(share))) * np.square(circle)
        sizes.append(total)
    return sense_of(sizes[0][:, None], sizes[1][:, None])[:, 0]


def _solve(matrix: Complex, right: Complex) -> Complex:
    """Solution; where the elimination stops, on a root to the last digit, that right next to it."""
    right = np.broadcast_to(right, (*matrix.shape[:-1], right.shape[-1]))
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        exact = np.linalg.slogdet(matrix)[0] == 0.0
        size = np.where(exact, _EPS * np.abs(matrix).max(axis=(-2, -1)), 0.0)
        return np.asarray(np.linalg.solve(matrix + size[..., None, None] * np.eye(matrix.shape[-1]), right))


@dataclass(frozen=True)
class _Eliminated:
    """T(lambda) q = 0 of the rotor with its layers eliminated, at k points."""

    matrix: Complex  #: T and dT/d lambda, shape (k, N, N)
    slope: Complex
    #: log of the product of the layers' waves, which are the poles of det T, and its derivative, shape (k,)
    waves: Complex
    poles: Complex
    #: offset of each layer over the deflection of its drum, along the spin, then against it, shape (2 L, k)
    shares: Complex


def _eliminate(problem: _Problem, root: Complex, spin: Array, slopes: bool = True) -> _Eliminated:
    """Rotor and layers at values of lambda [theory: whirl, eq. 14], with slopes or without."""
    c, size = problem.circles, len(problem.system.coordinates)
    turned = root - 1j * c.sense * spin
    friction = stokes_rate(c.stokes, -1j * turned)
    plate = c.tanh, c.sense * spin, -1j * turned
    plates, rise = plate_terms(*plate) if slopes else (plate_rate(*plate), None)
    rate = c.rate + c.lids * plates
    # W, in the slip, where films keep their digits, and its slope; W d = -(1 - T)/2 lambda^2 w.
    coriolis = 2j * c.sense * c.tanh * spin
    wave = turned * (turned - coriolis + rate + friction) + c.tanh * np.square(spin)
    wave = np.where(wave == 0.0, _EPS * np.square(spin), wave)
    share: Complex = np.asarray(0.5 * (1.0 - c.tanh) * np.square(root) / wave, dtype=complex)
    force = c.mass * np.square(root) * (1.0 - share)
    waves: Complex = np.asarray(c.weight[:, 0] @ np.log(wave), dtype=complex)
    # Of the rotor's matrices and of the layers' places, in one product.
    powers = np.concatenate([[np.square(root), root, root * spin, np.ones_like(root)], force])
    matrix = (powers.T @ c.parts).reshape(-1, size, size)
    if rise is None:
        return _Eliminated(matrix, matrix[:0], waves, root[:0], share)
    bend = 2.0 * turned - coriolis + rate + 1.5 * friction - 1j * c.lids * rise * turned
    change = c.mass * root * (2.0 - 4.0 * share + root * share * bend / wave)
    powers = np.concatenate([[2.0 * root, np.ones_like(root), spin, np.zeros_like(root)], change])
    slope = (powers.T @ c.parts).reshape(-1, size, size)
    return _Eliminated(matrix, slope, waves, c.weight[:, 0] @ (bend / wave), share)


def all_modes(system: RotorSystem, layers: Sequence[Placed], speed: Array) -> Complex:
    """All modes at once, lambda, 1/s, shape (n, 8 N): slower, and none is missed [theory: whirl, eq. 20].

    N coordinates of rotor and layers; nan in place of those on other sheets. Exact for layers without floor
    and lid, whose drag is that on the slower wave.
    """
    linear = coupled_matrices(system, layers, speed)
    size, count = len(linear.mass), len(system.coordinates)
    drags = np.zeros((2, size, size), dtype=complex)
    for j, (_, layer) in enumerate(layers):
        own = slice(count + 2 * j, count + 2 * j + 2)
        drag = layer.stokes * layer.mass / (0.5 * (1.0 - layer.layer_tanh))
        for side in (0, 1):
            drags[side, own, own] = drag * np.outer(_AXES[:, side], _CIRCLES[side])
    return standing_roots(linear, drags, speed)
