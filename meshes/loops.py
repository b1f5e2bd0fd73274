"""Closed outlines among the curves of a drawing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from meshes.border import InputError
from meshes.drawing import Curve

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Ends of curves nearer than this part of the drawing meet.
_MEET = 1e-6


def meet(points: Array) -> tuple[Indices, Array]:
    """Number the places where ends of curves meet.

    Parameters
    ----------
    points : ends of curves, shape (N, 2)

    Returns
    -------
    Number of the place of each end, shape (N,), and the places, shape (P, 2).
    """
    reach = _MEET * float(np.ptp(points, axis=0).max())
    first = np.array([min(near) for near in cKDTree(points).query_ball_point(points, reach)])
    places, number = np.unique(first, return_inverse=True)
    return number.astype(np.int64), points[places]


def closed_loops(path: str | Path, ends: Indices, places: Array) -> list[list[int]]:
    """Put curves that meet end to end in order.

    Parameters
    ----------
    path : of the drawing, for words
    ends : places of the two ends of each curve, shape (K, 2)
    places : where they are, shape (P, 2)

    Returns
    -------
    Numbers of the curves of each outline, in order.

    Raises
    ------
    InputError : an outline that is open or branches, and where
    """
    degree = np.bincount(ends.ravel(), minlength=len(places))
    if np.any(degree != 2):
        worst = int(np.argmax(degree != 2))
        x, y = places[worst]
        state = "open" if degree[worst] == 1 else "branching"
        raise InputError("path", str(path), f"a drawing of closed outlines; one is {state} at ({x:g}, {y:g})")
    at: list[list[int]] = [[] for _ in places]
    for k, (one, other) in enumerate(ends):
        at[one].append(k)
        at[other].append(k)
    left, loops = set(range(len(ends))), []
    while left:
        loop = [min(left)]
        left.remove(loop[0])
        place = ends[loop[0], 1]
        while following := [k for k in at[place] if k in left]:
            loop.append(following[0])
            left.remove(loop[-1])
            one, other = ends[loop[-1]]
            place = other if place == one else one
        loops.append(loop)
    return loops


def extent(curves: list[Curve]) -> float:
    """Diagonal of the rectangle that some curves span."""
    return float(np.hypot(*np.ptp(np.concatenate([curve.points for curve in curves]), axis=0)))
