"""Noise of a measurement, stated or estimated, and whether it explains what a fit leaves."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from leblanc.core import units
from leblanc.core.notes import Note
from leblanc.studies.fit.answer import Noise
from leblanc.studies.fit.measured import ANGLES, SIZES
from leblanc.studies.fit.notes import POOR, few_note, poor_note
from leblanc.studies.fit.problem import Problem, is_turn, model_error
from leblanc.studies.fit.search import descend
from meshes.arrays import Array
from meshes.errors import InputError

ESTIMATE = "estimate"
_ALLOWED = 'estimate, a share of each reading such as "3 %", or an error such as "0.1 mm" or "2 deg"'
# Of the largest reading: relative noise does not go on to nothing where a reading does.
_LEAST_READING = 1e-3
_LEAST = 1e-6  # of the size: noise below it is not looked for
_EXACT = 1e-4  # of the largest value: less left needs no explanation
_CHANCE = 2e-3  # of noise that looks worse: below it what is left is no noise
_FEW = 3  # degrees of freedom up to which no pattern is seen, nor noise told from a bad fit
_PASSES = 4  # of weights by the fitted values


def parse_noise(text: str) -> tuple[str, float]:
    """Kind of the noise and its size: "estimate", 0; "relative", a share; "length" or "angle", SI."""
    if text.strip() == ESTIMATE:
        return ESTIMATE, 0.0
    kind, size = "", 0.0
    if found := re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*(?:%|per\s?cent|percent)\s*", text):
        kind, size = "relative", float(found[1]) / 100.0
    else:
        for name, dimension in (("length", units.LENGTH), ("angle", units.ANGLE)):
            try:
                kind, size = name, units.parse(text, dimension, "noise")
                break
            except InputError:
                continue
    if not kind or not 0.0 < size < 1e4 or (kind == "relative" and size >= 1.0):
        raise InputError("noise", text, _ALLOWED)
    return kind, size


@dataclass(frozen=True)
class Judged:
    """Values by one kind of noise."""

    x: Array  #: logarithms or steps, shape (p,)
    noise: Noise
    sigma: tuple[Array, ...]  #: standard deviation of each value of each quantity, shape (n,)
    unlikely: float  #: minus twice the logarithm of the likelihood, nan without a search
    ended: bool  #: the last search came to its end


def _shapes(problem: Problem, found: Sequence[Array] | None, kind: str) -> list[Array]:
    """Standard deviations of the readings but for one factor of each quantity."""
    shapes = []
    for k, (name, value) in enumerate(problem.measurement.columns):
        own = np.abs(value if found is None else found[k])
        if kind == "relative" and not is_turn(name) and own.max(initial=0.0) > 0.0:
            shapes.append(np.maximum(own, _LEAST_READING * float(own.max())))
        else:
            shapes.append(np.ones(value.shape))
    return shapes


def _noise(
    problem: Problem,
    x: Array,
    stated: tuple[str, float],
    kind: str,
    before: Sequence[Array] | None = None,
) -> tuple[Noise, list[Array]]:
    """Size of the noise of each quantity and the deviations by it [theory: fit, eq. 7].

    A free scale is that by deviations found before, at first by the sizes of the quantities.
    """
    found = problem.scaled(x, problem.plain() if before is None else before)
    shapes = _shapes(problem, found, kind)
    left = problem.left(found) if found is not None else [np.ones(shape.shape) for shape in shapes]
    share = max(problem.freedom, 1) / problem.count
    sizes, sigma = [], []
    together = _together(problem, left, shapes)
    for k, ((name, _value), rest, shape) in enumerate(
        zip(problem.measurement.columns, left, shapes, strict=True)
    ):
        typical = 1.0 if name in ANGLES else problem.sizes[k]
        unit = typical if kind == "absolute" or is_turn(name) else 1.0
        mean = together[k] if together else float(np.mean(np.square(rest / shape)))
        size = max(np.sqrt(mean / share), _LEAST * unit)
        fixed = stated[0] == "relative" and not is_turn(name)
        fixed |= (stated[0] == "angle") == is_turn(name) and stated[0] in ("length", "angle")
        size = stated[1] if fixed else size
        sizes.append(float(size))
        sigma.append(size * shape)
    noise = Noise(kind, stated[0] != ESTIMATE, tuple(problem.names), tuple(sizes))
    return noise, sigma


def _together(problem: Problem, left: Sequence[Array], shapes: Sequence[Array]) -> list[float]:
    """Mean squares in proportion to the quantities' sizes, where few values tell no more; else nothing."""
    columns = problem.measurement.columns
    if len(columns) == 1 or problem.freedom >= 4 * len(columns):
        return []
    units_of = [
        (1.0 if name in ANGLES else size) if np.all(shape == 1.0) else 1.0
        for (name, _), size, shape in zip(columns, problem.sizes, shapes, strict=True)
    ]
    each = zip(left, shapes, units_of, strict=True)
    common = float(np.mean([np.mean(np.square(rest / shape / unit)) for rest, shape, unit in each]))
    return [common * unit**2 for unit in units_of]


def kinds_of(problem: Problem, stated: tuple[str, float]) -> tuple[str, ...]:
    """Kinds of noise that a fit may have."""
    if stated[0] == "relative":
        return ("relative",)
    sized = any(name in SIZES for name in problem.names)
    return ("absolute", "relative") if stated[0] in (ESTIMATE, "angle") and sized else ("absolute",)


def unlikely(problem: Problem, x: Array, sigma: Sequence[Array]) -> float:
    """Minus twice the logarithm of the likelihood of some noise, whatever the values [theory: fit, eq. 13].

    The likelihood at the best values alone prefers noise by which a few readings, met by the values, count.
    """
    residual = problem.weighted(sigma)
    jacobian = problem.jacobian(residual, x)
    squares = float(np.sum(np.square(residual(x))))
    _, told = np.linalg.slogdet(np.eye(x.size) + jacobian.T @ jacobian)
    return squares + 2.0 * sum(float(np.sum(np.log(each))) for each in sigma) + float(told)


def refine(problem: Problem, x: Array, stated: tuple[str, float], kind: str) -> Judged:
    """Best values by one kind of noise, its weights by the fitted values [theory: fit, eq. 7]."""
    noise, sigma = _noise(problem, x, stated, kind)
    ended = True
    for _ in range(_PASSES):
        valley = descend(problem, problem.weighted(sigma), x)
        moved = float(np.abs(valley.x - x).max())
        x, ended = valley.x, valley.ended
        noise, sigma = _noise(problem, x, stated, kind, sigma)
        if moved < 1e-5 or (kind == "absolute" and len(problem.names) == 1):
            break
    return Judged(x, noise, tuple(sigma), unlikely(problem, x, sigma), ended)


def here(problem: Problem, x: Array, stated: tuple[str, float], kind: str) -> Judged:
    """Noise of one kind by what some values leave, without a search."""
    noise, sigma = _noise(problem, x, stated, kind)
    return Judged(x, noise, tuple(sigma), np.nan, True)


def unexplained(problem: Problem, judged: Judged) -> Note | None:
    """Why the residuals are not noise; None where it may be [theory: fit, eq. 8, 9]."""
    found = problem.scaled(judged.x, judged.sigma)
    if found is None:
        return poor_note(1.0, "the scene has no answer with these values")
    left = problem.left(found)
    if is_exact(problem, left) or _by_model(problem, judged.x, found, left):
        return None
    rms = relative_rms(problem, left)
    white = [rest / each for rest, each in zip(left, judged.sigma, strict=True)]
    if judged.noise.stated:
        from scipy.special import chdtrc

        squares = float(sum(np.sum(np.square(each)) for each in white))
        if chdtrc(max(problem.freedom, 1), squares) < _CHANCE:
            size = np.sqrt(squares / max(problem.freedom, 1))
            return poor_note(rms, f"it is {units.number(float(size))} times the noise that was stated")
        return None
    if rms > POOR and _replicates(problem) <= _FEW:
        # Few values let a resonance in the wrong place pass for noise of a half.
        return poor_note(rms, "so much is noise only if it is stated (--noise) or rows that repeat show it")
    if problem.freedom <= _FEW:
        return few_note(rms, problem.freedom)
    for reason in (
        _repeated(problem, white),
        _neighbours(problem, judged, white),
        _outlier(problem, judged, white),
    ):
        if reason:
            return poor_note(rms, reason)
    return None


def relative_rms(problem: Problem, left: Sequence[Array]) -> float:
    """Root of the mean square of the residuals over the sizes of the quantities."""
    parts = [rest / each for rest, each in zip(left, problem.plain(), strict=True)]
    return float(np.sqrt(np.mean(np.square(np.concatenate(parts)))))


def is_exact(problem: Problem, left: Sequence[Array]) -> bool:
    """The residuals are smaller than what needs an explanation."""
    return all(
        float(np.abs(rest).max()) <= _EXACT * (1.0 if is_turn(name) else float(np.abs(value).max()))
        for rest, (name, value) in zip(left, problem.measurement.columns, strict=True)
    )


def _by_model(problem: Problem, x: Array, found: Sequence[Array], left: Sequence[Array]) -> bool:
    """The residuals are within the error that the scene's own answer has."""
    if problem.measurement.over != "speed" or any(name not in SIZES for name in problem.names):
        return False
    speed, where = np.unique(problem.measurement.at, return_inverse=True)
    error = model_error(problem.with_values(x), speed)[where]
    return all(
        bool((np.abs(rest) <= error * np.abs(own)).all()) for own, rest in zip(found, left, strict=True)
    )


def _basis(problem: Problem, judged: Judged) -> Array:
    """Orthonormal directions that a fit takes out of the noise, shape (n columns, p)."""
    residual = problem.weighted(judged.sigma)
    jacobian = problem.jacobian(residual, judged.x)
    size = np.linalg.norm(jacobian, axis=0)
    jacobian = jacobian[:, size > 1e-9 * max(float(size.max(initial=0.0)), 1e-300)]
    if not jacobian.shape[1]:
        return np.zeros((problem.count, 0))
    turn, singular, _ = np.linalg.svd(jacobian / np.linalg.norm(jacobian, axis=0), full_matrices=False)
    return np.asarray(turn[:, singular > 1e-7 * singular[0]])


def _replicates(problem: Problem) -> int:
    """Degrees of freedom of rows that repeat about their means."""
    at = problem.measurement.at
    return len(problem.names) * (at.size - np.unique(at).size)


def _repeated(problem: Problem, white: Sequence[Array]) -> str:
    """Rows of one speed scatter less than the residuals: their noise is known without the scene."""
    from scipy.special import fdtrc

    _, where, counts = np.unique(problem.measurement.at, return_inverse=True, return_counts=True)
    own, squares = 0.0, 0.0
    for each in white:
        means = np.bincount(where, each) / counts
        own += float(np.sum(np.square(each - means[where])))
        squares += float(np.sum(np.square(each)))
    inside = _replicates(problem)
    outside = problem.freedom - inside
    if inside < 1 or outside < 1:
        return ""
    ratio = (squares - own) / outside / max(own / inside, 1e-300)
    if fdtrc(outside, inside, ratio) >= _CHANCE:
        return ""
    return f"rows that repeat scatter {units.number(float(np.sqrt(ratio)))} times less than they lie off"


def _beside(vectors: Array, size: int) -> Array:
    """Half the sum of both neighbours within each quantity of some size, shape as given."""
    found = np.zeros_like(vectors)
    for start in range(0, vectors.shape[0], size):
        part, to = vectors[start : start + size], found[start : start + size]
        to[1:] += 0.5 * part[:-1]
        to[:-1] += 0.5 * part[1:]
    return found


def alike_by_chance(basis: Array, size: int) -> tuple[float, float]:
    """Mean and variance of e'Ae/e'e of normal noise [theory: fit, eq. 8].

    Orthonormal directions that a fit takes out of the noise, shape (n columns, p).
    """
    moved = _beside(basis, size)
    inner = basis.T @ moved
    trace = -float(np.trace(inner))
    pairs = 0.5 * (basis.shape[0] // size) * (size - 1)
    both = pairs - 2.0 * float(np.sum(np.square(moved))) + float(np.sum(np.square(inner)))
    freedom = basis.shape[0] - basis.shape[1]
    return trace / freedom, 2.0 * (freedom * both - trace**2) / (freedom**2 * (freedom + 2.0))


def _neighbours(problem: Problem, judged: Judged, white: Sequence[Array]) -> str:
    """Residuals of neighbours are alike, or opposite: their correlation beside that of noise."""
    from scipy.special import betainc

    basis = _basis(problem, judged)
    rest = np.concatenate(white)
    squares = float(rest @ rest)
    if rest.size - basis.shape[1] <= _FEW or squares == 0.0:
        return ""
    ratio = float(rest @ _beside(rest, white[0].size)) / squares
    mean, variance = alike_by_chance(basis, white[0].size)
    if variance <= 1e-12:
        return ""
    # Of the beta distribution between -1 and 1 with that mean and variance.
    middle, spread = 0.5 * (mean + 1.0), 0.25 * variance
    total = middle * (1.0 - middle) / spread - 1.0
    chance = float(betainc(middle * total, (1.0 - middle) * total, np.clip(0.5 * (ratio + 1.0), 0.0, 1.0)))
    if 2.0 * min(chance, 1.0 - chance) >= _CHANCE:
        return ""
    return f"neighbours are {'alike' if ratio > mean else 'opposite'} in it, which noise is not"


def _outlier(problem: Problem, judged: Judged, white: Sequence[Array]) -> str:
    """One value lies off by far more than all others."""
    from scipy.special import stdtr

    basis, rest = _basis(problem, judged), np.concatenate(white)
    freedom = rest.size - basis.shape[1]
    squares = np.square(rest) / np.maximum(1.0 - np.sum(np.square(basis), axis=1), 1e-6)
    k = int(np.argmax(squares))
    total = float(rest @ rest)
    without = (total - float(squares[k])) / (freedom - 1)
    if without <= 1e-12 * total:
        chance, off = 0.0, np.inf
    else:
        off = float(np.sqrt(squares[k] / without))
        chance = 2.0 * rest.size * float(stdtr(freedom - 1, -off))
    if chance >= _CHANCE:
        return ""
    measured = problem.measurement
    column, row = divmod(k, measured.at.size)
    at = float(measured.at[row])
    dimension = {"speed": units.ANGULAR_SPEED, "time": units.TIME, "added": units.VOLUME}[measured.over]
    return (
        f"the {problem.names[column].replace('_', ' ')} at {units.with_unit(at, dimension)} lies off by "
        f"{units.number(off)} standard deviations of the others"
    )
