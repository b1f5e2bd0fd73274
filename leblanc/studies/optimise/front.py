"""The front of an optimum: a sweep from no liquid to the fullest, and what the search met by the way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from leblanc.results.optimum import ParetoFront
from leblanc.scene.scene import Scene
from leblanc.studies.optimise.constraints import growth
from leblanc.studies.optimise.problem import Problem
from meshes.arrays import Array, Flags
from solvers.search import Found


def not_dominated(values: Array) -> Flags:
    """Points that no other beats: none is as good in every value and better in one.

    Parameters
    ----------
    values : to be small, shape (m, k)

    Returns
    -------
    shape (m,); of points that are equal in everything the first alone
    """
    kept: Flags = np.asarray(np.isfinite(values).all(axis=1))
    order = np.lexsort(values.T[::-1])
    # In this order no point is beaten by a later one.
    for place, k in enumerate(order.tolist()):
        if kept[k]:
            later = order[place + 1 :]
            kept[later] &= ~np.all(values[later] >= values[k], axis=1)
    return kept


def front_of(volume: Array, vibration: Array, mass: Array, margin: Array) -> ParetoFront:
    """The points that are not dominated, by rising mass.

    Parameters
    ----------
    volume, vibration, mass, margin : as in `ParetoFront`
    """
    kept = np.flatnonzero(not_dominated(np.stack((vibration, mass, -margin), axis=1)))
    kept = kept[np.lexsort((vibration[kept], mass[kept]))]
    return ParetoFront(volume[kept], vibration[kept], mass[kept], margin[kept])


_SWEEP, _SPARING = 40, 12  # volumes of the dedicated sweep; where an answer costs much
_MOST_IN_FRONT = 60  # of the points evaluated by the way


def front_around(
    scene: Scene, problem: Problem, found: Found, vibration: float, speeds: Array
) -> tuple[ParetoFront, ParetoFront]:
    """What must be given up for what.

    Parameters
    ----------
    scene, problem : the machine and what its volumes are evaluated by
    found : by the search
    vibration : of the best volumes, m
    speeds : at which small whirls are looked at, rad/s

    Returns
    -------
    the front, and all of the sweep from no liquid to the fullest chamber, shares as in the best volumes
    """
    evaluate, known = problem.evaluate, found.judged.details
    count = _SPARING if problem.costly else _SWEEP
    high = np.array([fill.chamber.capacity for fill in scene.fills])
    share = np.concatenate(([0.0], np.geomspace(1e-3, 1.0, count)))
    along = found.point if found.point.max() > 0.0 else high
    room = float(np.min(high[along > 0.0] / along[along > 0.0]))
    rows = [np.minimum(share[:, None] * room * along, high), found.point[None]]
    swept = np.unique(np.concatenate(rows), axis=0)
    exact = np.flatnonzero((known["sure"] == 1.0) & np.isfinite(known["vibration"]))
    by_the_way = exact[_thin(known["vibration"][exact], known["mass"][exact])]
    volume = np.concatenate((swept, found.points[by_the_way]))
    size = np.concatenate((evaluate.vibration.exact(swept), known["vibration"][by_the_way]))
    size[np.all(volume == found.point, axis=1)] = vibration
    margin, mass = -growth(scene, volume, speeds), volume @ evaluate.density
    part = slice(0, swept.shape[0])
    whole = ParetoFront(volume[part], size[part], mass[part], margin[part])
    return front_of(volume, size, mass, margin), whole


def _thin(vibration: Array, mass: Array) -> NDArray[np.intp]:
    """Of the points that are not beaten in vibration and mass a few, evenly chosen."""
    kept = np.flatnonzero(not_dominated(np.stack((vibration, mass), axis=1)))
    kept = kept[np.argsort(mass[kept], kind="stable")]
    return (
        kept[np.unique(np.linspace(0, max(kept.size - 1, 0), _MOST_IN_FRONT).astype(int))]
        if kept.size
        else kept
    )
