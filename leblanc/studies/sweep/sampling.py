"""Samples of a sweep: sample k is the same whether it is drawn alone or among others."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from leblanc.studies.sweep.plan import Choice, Levels, Sweep, VariedField
from meshes.arrays import Array

Rows = Callable[[int, int], Array]

_SOBOL_CELL = 2.0**-30  # points of the sequence are multiples of it


def sample_rows(sweep: Sweep) -> Rows:
    """What makes samples from one number up to another: SI values, or the number of a choice."""
    if sweep.method == "grid":
        return lambda start, stop: grid_rows(sweep, start, stop)
    unit = _DESIGNS[sweep.method](sweep)

    def rows(start: int, stop: int) -> Array:
        shares = unit(start, stop)
        columns = [_drawn(field, shares[:, j]) for j, field in enumerate(sweep.fields)]
        return np.stack(columns, axis=1)

    return rows


def _drawn(field: VariedField, shares: Array) -> Array:
    assert not isinstance(field.distribution, Levels)  # no design but a grid has them
    return field.distribution.at(shares)


def grid_rows(sweep: Sweep, start: int, stop: int) -> Array:
    """Rows of the full product of all levels, the last field running fastest [theory: sampling, eq. 5]."""
    levels = []
    for field in sweep.fields:
        assert isinstance(field.distribution, Choice | Levels)
        levels.append(field.distribution.levels())
    places = np.unravel_index(np.arange(start, stop), tuple(level.size for level in levels))
    values = [level[place] for level, place in zip(levels, places, strict=True)]
    return np.stack(values, axis=1)


def _random(sweep: Sweep) -> Rows:
    """Independent shares; each takes one number of the generator, which can jump."""
    width = len(sweep.fields)

    def unit(start: int, stop: int) -> Array:
        generator = np.random.PCG64(sweep.seed)
        generator.advance(start * width)
        return np.random.Generator(generator).random((stop - start, width))

    return unit


def _latin_hypercube(sweep: Sweep) -> Rows:
    """As many even strata as samples in each field, one sample in each; made as a whole."""
    from scipy.stats import qmc

    whole = qmc.LatinHypercube(len(sweep.fields), rng=np.random.default_rng(sweep.seed)).random(sweep.points)
    return lambda start, stop: whole[start:stop]


def _sobol(sweep: Sweep) -> Rows:
    return lambda start, stop: sobol_points(len(sweep.fields), sweep.seed, start, stop)


def sobol_points(width: int, seed: int, start: int, stop: int) -> Array:
    """Points of the scrambled Sobol sequence, each in the middle of its cell of the unit cube.

    Shares strictly between 0 and 1, shape (stop - start, width).
    """
    from scipy.stats import qmc

    engine = qmc.Sobol(width, scramble=True, rng=np.random.default_rng(seed))
    # Drawn after a first point, any number of them comes without a word about powers of two.
    first = engine.random(1) if start == 0 else engine.fast_forward(start).random(1)
    points = np.concatenate([first, engine.random(stop - start - 1)]) if stop - start > 1 else first
    return np.asarray(points + 0.5 * _SOBOL_CELL)


def _saltelli(sweep: Sweep) -> Rows:
    """Points A and B, and A with one field after the other taken from B [theory: sampling, eq. 6].

    Each point has a row of A, one row for each field exchanged, and a row of B.
    """
    width = len(sweep.fields)
    members = width + 2

    def unit(start: int, stop: int) -> Array:
        first, last = start // members, (stop - 1) // members + 1
        both = sobol_points(2 * width, sweep.seed, first, last)
        a, b = both[:, None, :width], both[:, None, width:]
        taken = np.zeros((members, width), dtype=bool)
        taken[1:-1] = np.eye(width, dtype=bool)
        taken[-1] = True
        whole = np.where(taken, b, a).reshape(-1, width)
        return np.asarray(whole[start - first * members : stop - first * members])

    return unit


_DESIGNS: dict[str, Callable[[Sweep], Rows]] = {
    "random": _random,
    "latin_hypercube": _latin_hypercube,
    "sobol": _sobol,
    "saltelli": _saltelli,
}


def sampling_note(sweep: Sweep) -> str | None:
    """What the number of samples gives away, in words; None if nothing."""
    n = sweep.points
    if sweep.method not in ("sobol", "saltelli") or n & (n - 1) == 0:
        return None
    below = 2 ** (n.bit_length() - 1)
    return (
        f"{n} points of a Sobol sequence are no power of two: they fill the space less evenly than "
        f"{below} or {2 * below} would"
    )
