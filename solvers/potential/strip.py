"""The strip onto which the layer is mapped: nodes, and harmonic functions from their values at the surface.

A wave of n equal crests has one of them at u = 0 and a trough at u = pi/n; between the two its surface is
even about both. Nodes crowd at the crest as tan(n u/2) = L tan(xi/2) has it, xi being evenly spaced; L = 1
leaves them even. The operator of harmonic waves in a strip, k coth(kK), is split into k, which this map of a
disc onto itself leaves as it is, and the rest, which falls off as k exp(-2kK) and is summed up over few waves
[theory: potential, eq. 11-13].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_positive

# The rest of coth beyond its 1 is nothing to rounding for k K above this: 2 exp(-40).
_DEEP = 20.0
FEWEST = 8


@dataclass(frozen=True)
class Nodes:
    """Half a wave of a strip, from crest to trough."""

    u: Array  #: along the strip, which is the angle where there is no wave, shape (m,)
    mean: Array  #: weights of a mean over the wave, shape (m,)
    harmonics: Array  #: half of the waves' coefficients from the values in xi, shape (m, m)
    hilbert: Array  #: |d/du| of an even function, shape (m, m)
    slope: Array  #: d/du of an even function, an odd one, shape (m, m)
    conjugate: Array  #: the odd function that goes with an even one in a deep strip, shape (m, m)
    cosine: Array  #: of the first waves in u, shape (m, k)
    sine: Array
    taken: Array  #: their coefficients from the values, shape (k, m)
    crests: int  #: n
    cluster: float  #: L

    def spectrum(self, values: Array) -> Array:
        """Coefficients of an even function in cosines of xi, shape (m,)."""
        return np.asarray(self.harmonics @ values)


@dataclass(frozen=True)
class Strip:
    """Operators of a strip of depth K on values at its surface."""

    flux: Array  #: k coth(kK) of an even function, none of its mean, shape (m, m)
    flux_slope: Array  #: its derivative by K
    shift: Array  #: coth(kK) of an even function as an odd one, shape (m, m)
    shift_slope: Array  #: its derivative by K


@lru_cache(maxsize=8)
def nodes(count: int, crests: int = 1, cluster: float = 1.0) -> Nodes:
    """The `count` + 1 nodes from crest to trough of n crests round the drum; `cluster` is L, at most 1."""
    if count < FEWEST:
        raise InputError("count", count, f"at least {FEWEST}")
    if crests < 1:
        raise InputError("crests", crests, "1 or more")
    require_positive("cluster", cluster)
    if cluster > 1.0:
        raise InputError("cluster", cluster, "at most 1")
    xi, ends, u, stretch = _placed(count, crests, cluster)
    k = np.arange(count + 1)
    cosine, sine = np.cos(np.outer(xi, k)), np.sin(np.outer(xi, k))
    # Discrete cosine transform of the first kind.
    harmonics = 2.0 / count * ends[:, None] * cosine.T * ends
    first = crests * np.arange(1, count - 1)
    taken = _waves_in_u(count, cluster) @ harmonics
    return Nodes(
        u=u,
        mean=ends * stretch * crests / count,
        harmonics=harmonics,
        hilbert=(cosine * k) @ harmonics / stretch[:, None],
        slope=(-sine * k) @ harmonics / stretch[:, None],
        conjugate=sine @ harmonics,
        cosine=np.cos(np.outer(u, first)),
        sine=np.sin(np.outer(u, first)),
        taken=taken,
        crests=crests,
        cluster=cluster,
    )


def _placed(count: int, crests: int, cluster: float) -> tuple[Array, Array, Array, Array]:
    """Nodes in xi with the trapezium's weights, in u, and du/dxi [theory: potential, eq. 11]."""
    xi = np.pi * np.arange(count + 1) / count
    ends = np.full(count + 1, 1.0)
    ends[[0, -1]] = 0.5
    cosine, sine = np.cos(0.5 * xi), np.sin(0.5 * xi)
    stretch = cluster / (np.square(cosine) + np.square(cluster * sine)) / crests
    return xi, ends, 2.0 * np.arctan2(cluster * sine, cosine) / crests, stretch


def _waves_in_u(count: int, cluster: float) -> Array:
    """Waves in u of one crest from those in xi, without the mean [theory: potential, eq. 13].

    Shape (count - 2, count + 1): the nodes themselves are too far apart for them at the trough.
    """
    j, away = np.arange(count + 1), (1.0 - cluster) / (1.0 + cluster)
    # exp(iu) = (w + away)/(1 + away w) as a power series in w = exp(i xi), and what multiplies one by it.
    series = np.where(j == 0, away, (1.0 - away * away) * (-away) ** np.maximum(j - 1, 0))
    behind = j[:, None] - j
    times = np.where(behind >= 0, series[np.abs(behind)], 0.0)
    found, power = np.empty((count - 2, count + 1)), np.where(j == 0, 1.0, 0.0)
    for k in range(1, count - 1):
        power = times @ power
        found[k - 1] = j * power / k
    return found


def strip(at: Nodes, depth: float) -> Strip:
    """Operators for a strip of this depth K."""
    require_positive("depth", depth)
    most = min(math.ceil(_DEEP / (at.crests * depth)), at.taken.shape[0])
    k = at.crests * np.arange(1, most + 1)
    cosine, sine, taken = at.cosine[:, :most], at.sine[:, :most], at.taken[:most]
    # coth(kK) - 1 and its derivative by K.
    rest = 2.0 / np.expm1(np.minimum(2.0 * k * depth, 700.0))
    fall = -k * rest * (2.0 + rest)
    return Strip(
        flux=at.hilbert + (cosine * (k * rest)) @ taken,
        flux_slope=(cosine * (k * fall)) @ taken,
        shift=at.conjugate + (sine * rest) @ taken,
        shift_slope=(sine * fall) @ taken,
    )


def moved(at: Nodes, values: Array, to: Nodes) -> Array:
    """Values of an even function at other nodes of the same number of crests, by its series in xi."""
    xi = 2.0 * np.arctan2(np.sin(0.5 * at.crests * to.u), at.cluster * np.cos(0.5 * at.crests * to.u))
    return np.asarray(np.cos(np.outer(xi, np.arange(at.u.size))) @ at.spectrum(values))
