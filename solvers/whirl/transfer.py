"""Whirl modes with any liquid model, from what it answers to small whirls of real frequency.

U over the deflection, as a function of the frequency seen from the drum, is taken for a rational function:
its poles and zeros come from the samples alone, by the barycentric form of Nakatsukasa, Sète and Trefethen
(AAA, 2018). With it the rotor's equations are a linear eigenproblem, all of whose modes are found
[theory: whirl, eq. 7].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fluid.fill import Fill, Fills
from fluid.whirl import is_full
from meshes.arrays import Array, Complex, Flags, Index
from solvers.checked_model import CheckedModel
from solvers.liquid_model import Whirls
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor
from solvers.whirl.planar import Modes
from solvers.whirl.system import SystemModes, sense_of

_EPS = float(np.finfo(float).eps)
_AT_ONCE = 256  # points
_EXACT = 2e-13  # of the largest value: left of the samples where the function is exact
_KNOWN = 1e-4  # beyond which no rational function stands for the samples
_TERMS = 22  # of a rational function at most
_WORSE = 10.0  # times what the best one leaves: fewer terms do
_SHIFT = 0.3719 + 0.2257j  # of the frequency over the spin, about which the eigenproblem is solved
_PLAIN = 10  # terms of a function that is rational
_CLOSE = 1e-7  # of the largest value, is left of the samples where more terms are not worth their time
_ALIKE = 1e-4  # relative, of frequencies seen from the drum that two fits give of one mode
_ENDLESS = 1e-11  # of the largest: the inverse of a root that is at infinity
_ENOUGH = 0.5  # of the samples, that the model must have found at a speed
_HALVES = slice(0, None, 2), slice(1, None, 2)  # of the samples


def _slips(reach: float) -> Array:
    """Frequencies seen from the drum over the spin at which a liquid is asked, close at the drum's own."""
    wide = np.sinh(np.linspace(-np.arcsinh(reach), np.arcsinh(reach), 90)) * 0.97
    near = np.geomspace(1e-5, 0.5, 24)
    found = np.concatenate([-near[::-1], near, wide])
    # Nobody whirls at the speed 0 in space.
    return np.unique(found[np.abs(found + 1.0) > 1e-3])


@dataclass(frozen=True)
class _Rational:
    """mass(s) = y/z, z = sum v, y = scale sum (1 - c h) v, (s - x_j) v_j = w_j t; shapes (p, k), (p,)."""

    node: Array  #: x, slips over the spin
    weight: Complex  #: w
    value: Complex  #: h, of 1/(mass/scale + c), which has no pole on the real axis
    scale: Array
    shift: Complex  #: c
    left: Array  #: of the samples, relative


def _bounded(mass: Complex, known: Flags) -> tuple[Complex, Array, Complex]:
    """1/(mass/scale + c), of the c from which the samples keep farthest away; h, scale, c."""
    scale = np.nanmedian(np.where(known & np.isfinite(mass), np.abs(mass), np.nan), axis=1)
    scale = np.where(scale > 0.0, scale, 1.0)
    with np.errstate(invalid="ignore"):
        value = np.where(known & np.isfinite(mass), mass / scale[:, None], np.inf)
    turns = np.exp(2j * np.pi * (np.arange(16) + 0.5) / 16)
    away = np.array([np.min(np.where(np.isfinite(value), np.abs(value + c), np.inf), axis=1) for c in turns])
    shift = turns[np.argmax(away, axis=0)]
    h = np.divide(1.0, value + shift[:, None], out=np.zeros(value.shape, complex), where=np.isfinite(value))
    return h, scale, shift


def _fitted(slip: Array, mass: Complex, known: Flags) -> list[tuple[Index, _Rational]]:
    """Rational functions of p rows of samples, shape (p, n), by how many terms they have."""
    h, scale, shift = _bounded(mass, known)
    open_ = known & np.isfinite(mass)
    size = np.abs(h).max(axis=1)
    parts, rows = [], np.arange(len(h))
    taken = np.zeros((rows.size, 0), dtype=np.intp)
    now = np.repeat(
        (np.sum(h * open_, axis=1) / np.maximum(open_.sum(axis=1), 1))[:, None], slip.size, axis=1
    )
    lefts: list[Array] = []
    weights: list[Complex] = []
    for terms in range(1, _TERMS + 1):
        off = np.where(open_[rows], np.abs(h[rows] - now), -1.0)
        taken = np.concatenate([taken, np.argmax(off, axis=1)[:, None]], axis=1)
        apart = slip[None, :, None] - slip[taken][:, None, :]
        cauchy = np.divide(1.0, apart, out=np.zeros(apart.shape), where=apart != 0.0)
        free = open_[rows]
        free[np.arange(rows.size)[:, None], taken] = False
        own = np.take_along_axis(h[rows], taken, axis=1)
        loewner = (h[rows][:, :, None] - own[:, None, :]) * cauchy * free[:, :, None]
        weight = np.linalg.svd(loewner, full_matrices=False)[2][:, -1].conj()
        above, below = (cauchy @ part[:, :, None] for part in (weight * own, weight))
        now = np.divide(above[:, :, 0], below[:, :, 0], out=h[rows], where=free & (below[:, :, 0] != 0.0))
        left = np.where(free, np.abs(h[rows] - now), 0.0).max(axis=1) / size[rows]
        lefts, weights = [*lefts, left], [*weights, weight]
        done = left <= (_EXACT if terms <= _PLAIN else _CLOSE)
        if terms == _TERMS:
            done[:] = True
        if not done.any():
            continue
        # As few terms as leave not much more than the best: others only follow the rounding.
        every = np.array([each[done] for each in lefts])
        first = np.argmax(every <= np.maximum(_WORSE * every.min(axis=0), _EXACT), axis=0)
        for k in np.unique(first).tolist():
            which = np.flatnonzero(done)[first == k]
            at, nodes = rows[which], taken[which, : k + 1]
            fit = _Rational(
                slip[nodes], weights[k][which], own[which, : k + 1], scale[at], shift[at], lefts[k][which]
            )
            parts.append((at, fit))
        if done.all():
            break
        rows, taken, now = rows[~done], taken[~done], now[~done]
        lefts, weights = [each[~done] for each in lefts], [each[~done] for each in weights]
    return parts


_Fits = Sequence[tuple[Index, Sequence[_Rational]]]  # of points with as many terms each, by chamber


@dataclass(frozen=True)
class _Way:
    """How one circle of a chamber's axis moves the rotor: force = share b mass(s) b^H q of its square."""

    along: Complex  #: b, shape (n,)
    share: float
    sense: int  #: 1 with e^{i omega t}, -1 against it, where the samples count conjugated
    chamber: int


def _solved(
    matrices: Sequence[Array],
    ways: Sequence[_Way],
    fits: Sequence[_Rational],
    masses: Array,
    spin: Array,
) -> tuple[Complex, Array, Array]:
    """Whirl speeds over the spin, their rounding, and squares of the circles of axis and liquid, at p points.

    Circles with e^{i omega t} and against it, shape (2, p, m).

    `matrices`: M, C, G, K. Unknown are q, P = nu (M q + liquid) and v of each way.
    """
    mass, damping, gyro, stiffness = matrices
    n, count = len(mass), spin.size
    sizes = [fits[way.chamber].node.shape[1] for way in ways]
    ends = np.cumsum([2 * n, *sizes])
    a, b = np.zeros((2, count, ends[-1], ends[-1]), dtype=complex)
    unit, q, p = np.eye(n), slice(0, n), slice(n, 2 * n)
    one = np.abs(np.diag(mass)).max()
    a[:, q, p], b[:, q, q] = unit, mass / one
    a[:, p, q] = stiffness / (one * np.square(spin)[:, None, None])
    b[:, p, q] = -1j * (damping / spin[:, None, None] + gyro) / one
    b[:, p, p] = unit
    for k, way in enumerate(ways):
        fit, own = fits[way.chamber], slice(ends[k], ends[k + 1])
        weight, value, shift = (
            part if way.sense > 0 else np.conj(part) for part in (fit.weight, fit.value, fit.shift)
        )
        pulled = (fit.scale[:, None] / one) * (1.0 - shift[:, None] * value)
        b[:, q, own] += way.share * way.along[:, None] * pulled[:, None, :]
        a[:, ends[k], own], a[:, ends[k], q] = value, -np.conj(way.along)
        rows, place = np.arange(ends[k] + 1, ends[k + 1]), fit.node + 1.0  # nu sense = s + 1
        a[:, rows, rows] = -weight[:, :1] * place[:, 1:]
        a[:, rows, ends[k]] = weight[:, 1:] * place[:, :1]
        b[:, rows, rows] = -way.sense * weight[:, :1]
        b[:, rows, ends[k]] = way.sense * weight[:, 1:]
    turned = np.linalg.solve(a - _SHIFT * b, b)
    inverse, right = np.linalg.eig(turned)
    left = np.linalg.pinv(right)
    size = np.linalg.norm(turned, axis=(1, 2))[:, None]
    endless = np.abs(inverse) <= _ENDLESS * size
    inverse = np.where(endless, 1.0, inverse)
    root = np.where(endless, np.nan, _SHIFT + 1.0 / inverse)
    condition = np.linalg.norm(left, axis=2) * np.linalg.norm(right, axis=1)
    noise = _EPS * np.sqrt(float(ends[-1])) * np.minimum(condition, 1.0 / _EPS) * size / np.abs(inverse) ** 2
    sizes_of = np.zeros((2, *root.shape))
    for k, way in enumerate(ways):
        axis = np.einsum("i,pim->pm", np.conj(way.along), right[:, q])
        fit, own = fits[way.chamber], slice(ends[k], ends[k + 1])
        value, shift = (part if way.sense > 0 else np.conj(part) for part in (fit.value, fit.shift))
        pulled = fit.scale[:, None] * (1.0 - shift[:, None] * value) / masses[way.chamber]
        offset = np.einsum("pk,pkm->pm", pulled, right[:, own]) - axis
        sizes_of[(1 - way.sense) // 2] += np.square(np.abs(axis)) + np.square(np.abs(offset))
    return root, np.where(endless, np.nan, noise), sizes_of


def _sampled(fills: Sequence[Fill], spin: Array, slip: Array, model: CheckedModel) -> tuple[Complex, Flags]:
    """What each fill answers at p spins and n slips over the spin, kg, and where it is known, (c, p, n)."""
    own, whole = np.repeat(spin, slip.size), np.tile(slip, spin.size)
    still = np.zeros(own.size)
    whirls = Whirls(own, own * (1.0 + whole), still, still, still)
    one = np.zeros(own.size, dtype=np.intp)
    found = [model.transfer(Fills.of([fill]).at(one), whirls) for fill in fills]
    shape = len(fills), spin.size, slip.size
    return (
        np.array([mass for mass, _ in found]).reshape(shape),
        np.array([known for _, known in found]).reshape(shape),
    )


def _groups(
    found: Sequence[Sequence[tuple[Index, _Rational]]], count: int
) -> list[tuple[Index, list[_Rational]]]:
    """Points whose chambers have the same numbers of terms, and their functions."""
    kind = np.zeros((len(found), count), dtype=np.intp)
    for own, parts in zip(kind, found, strict=True):
        for k, (at, _) in enumerate(parts):
            own[at] = k
    groups = []
    for own in np.unique(kind, axis=1).T:
        at = np.flatnonzero((kind == own[:, None]).all(axis=0))
        fits = []
        for k, parts in zip(own.tolist(), found, strict=True):
            rows, fit = parts[k]
            which = np.searchsorted(rows, at)
            fits.append(_Rational(*(getattr(fit, name)[which] for name in fit.__dataclass_fields__)))
        groups.append((at, fits))
    return groups


@dataclass(frozen=True)
class _Found:
    """Modes at p points, nan where there is none, shape (p, m)."""

    whirl: Complex  #: speed in space over the spin
    noise: Array
    sense: Array
    left: Array  #: of the samples, and how many terms stand for them, shape (p,)
    terms: Index


def _modes(
    matrices: Sequence[Array], ways: Sequence[_Way], masses: Array, fits: _Fits, spin: Array
) -> _Found:
    """Modes of a rotor whose liquid is known by rational functions; `masses` of the liquid, kg."""
    parts = []
    for at, own in fits:
        root, noise, circles = _solved(matrices, ways, own, masses, spin[at])
        left = np.max([fit.left for fit in own], axis=0)
        along, against = circles
        parts.append((at, root, noise + left[:, None], sense_of(along, against), left, own))
    width = max((part[1].shape[1] for part in parts), default=0)
    whirl = np.full((spin.size, width), complex(np.nan, np.nan))
    noise, sense = np.full((spin.size, width), np.nan), np.ones((spin.size, width))
    left, terms = np.zeros(spin.size), np.zeros(spin.size, dtype=np.intp)
    for at, root, rounding, turns, off, own in parts:
        many = root.shape[1]
        whirl[at, :many], noise[at, :many], sense[at, :many], left[at] = root, rounding, turns, off
        terms[at] = max(fit.node.shape[1] for fit in own)
    return _Found(whirl, noise, sense, left, terms)


def _spread(found: _Found, at: Index, count: int) -> _Found:
    """Modes at some of so many points; none, and all of the samples left, at the others."""
    width = max(found.whirl.shape[1], 1)
    whirl = np.full((count, width), complex(np.nan, np.nan))
    noise, sense = np.full((count, width), np.nan), np.ones((count, width))
    left, terms = np.full(count, np.inf), np.zeros(count, dtype=np.intp)
    if at.size:
        whirl[at], noise[at], sense[at] = found.whirl, found.noise, found.sense
    left[at], terms[at] = found.left, found.terms
    return _Found(whirl, noise, sense, left, terms)


def transfer_modes(
    rotor: Rotor, fills: Sequence[Fill], speed: Array, model: CheckedModel
) -> SystemModes | Modes:
    """All whirl modes of a rotor with liquid of any model that has a surface: planar of a Jeffcott rotor.

    Growth is not known where no rational function stands for the model's answers, or where it does not find
    half of them. Of a function that has no rational form, as with laminar layers, only modes count that half
    of the samples give as well.
    """
    wet = [fill for fill in fills if fill.volume > 0.0 and not is_full(fill)]
    full = [fill for fill in fills if is_full(fill)]
    system, planar = rotor.system(), isinstance(rotor, Jeffcott)
    heavy = system.mass.copy()
    for fill in full:
        at = system.at(fill.chamber.plane)
        heavy += fill.mass * at.T @ at
    matrices = [heavy, system.damping, system.gyroscopic, system.stiffness]
    along = [system.at(fill.chamber.plane).T @ np.array([1.0, -1j]) for fill in wet]
    ways = [_Way(b, 0.5, 1, j) for j, b in enumerate(along)]
    ways += [_Way(np.conj(b), 0.5, -1, j) for j, b in enumerate(along)]
    if isinstance(rotor, Jeffcott):
        mass = rotor.mass + sum(fill.mass for fill in full)
        matrices = [np.array([[value]]) for value in (mass, rotor.damping, 0.0, rotor.stiffness)]
        ways = [_Way(np.ones(1, dtype=complex), 1.0, 1, j) for j in range(len(wet))]
    masses = np.array([fill.mass for fill in wet])
    highest = np.sqrt(np.max(np.abs(np.linalg.eigvals(np.linalg.solve(matrices[0], matrices[3])))))
    parts = []
    for first in range(0, speed.size, _AT_ONCE):
        spin = speed[first : first + _AT_ONCE]
        slip = _slips(float(np.clip(1.5 * highest / spin.min(), 3.0, 100.0)))
        asked, known = _sampled(wet, spin, slip, model)

        def found(at: Index, part: slice) -> _Found:
            pairs = zip(asked[:, at, part], known[:, at, part], strict=True)  # noqa: B023
            fits = _groups([_fitted(slip[part], *pair) for pair in pairs], at.size)  # noqa: B023
            return _modes(matrices, ways, masses, fits, spin[at])  # noqa: B023

        shares = [known[:, :, part].mean(axis=2) for part in _HALVES]
        sure = np.flatnonzero((np.array(shares) >= _ENOUGH).all(axis=(0, 1)))
        modes = _spread(found(sure, slice(None)), sure, spin.size)
        unsure = np.flatnonzero(modes.terms > _PLAIN)
        if unsure.size:
            own = modes.whirl[unsure]
            for part in _HALVES:
                off = np.abs(own[:, :, None] - found(unsure, part).whirl[:, None, :])
                off = np.where(np.isnan(off), np.inf, off).min(axis=2)
                own[~(off <= _ALIKE * np.abs(own - 1.0))] = np.nan
            modes.whirl[unsure] = own
        parts.append(modes)
    width = max(part.whirl.shape[1] for part in parts)

    def joined(name: str, missing: complex) -> Any:
        tables = [getattr(part, name) for part in parts]
        pads = (((0, 0), (0, width - table.shape[1])) for table in tables)
        return np.concatenate(
            [np.pad(table, pad, constant_values=missing) for table, pad in zip(tables, pads, strict=True)]
        )

    whirl = joined("whirl", complex(np.nan, np.nan)) * speed[:, None]
    noise, complete = (
        joined("noise", np.nan) * speed[:, None],
        np.concatenate([p.left for p in parts]) <= _KNOWN,
    )
    if planar:
        return Modes((whirl - speed[:, None]).T, noise.T, complete)
    sense = joined("sense", 1.0)
    return SystemModes(1j * whirl, sense, noise, ~np.isnan(whirl), complete)
