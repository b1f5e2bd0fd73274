"""Estimated errors of the steady answer of any rotor, before anything is solved for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from meshes.arrays import Array, Index
from solvers.rotor.jeffcott import Jeffcott, PlanarMachine
from solvers.rotor.system import Rotor
from solvers.synchronous.coupled_bounds import coupled_error
from solvers.synchronous.enclosure import planar_enclosure, planar_gravity_error
from solvers.synchronous.errors import LinearError
from solvers.synchronous.models import LINEAR
from solvers.synchronous.pairs import pair_machines


def error_estimate(
    rotor: Rotor,
    fills: Sequence[Fill],
    speed: ArrayLike,
    gravity: float,
    across: float = 0.0,
    position: float | None = None,
) -> tuple[LinearError, Array]:
    """Errors in the motion of a rotor: of the linear law, and by gravity across the axis.

    Parameters
    ----------
    rotor, fills, position : see `solvers.synchronous.response.response`
    speed : spin speeds Omega, rad/s, shape (n,), > 0
    gravity, across : along and across the axis, m/s^2

    Returns
    -------
    Of the linear law; by gravity, relative, infinite where it has no bound and nan where the liquid does not
    ride with the drum or nothing is known, shape (n,)
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    if isinstance(rotor, Jeffcott):
        owner = np.zeros(spin.size, dtype=np.intp)
        return machine_errors([(rotor, fills)], owner, spin, np.array([gravity]), np.array([across]))
    place = position if position is not None else (fills[0].chamber.plane if fills else 0.0)
    return coupled_error(rotor.system(), fills, spin, gravity, place, across)


def machine_errors(
    machines: Sequence[PlanarMachine], owner: Index, speed: Array, gravity: Array, across: Array
) -> tuple[LinearError, Array]:
    """`error_estimate` of many planar machines at once: of n pairs of a machine and a speed.

    Parameters
    ----------
    machines : rotors, each with its chambers and their liquid
    owner : which machine each pair has, shape (n,)
    speed : spin speeds Omega, rad/s, shape (n,), > 0
    gravity, across : along and across the axis of each machine, m/s^2, shape (machines,)
    """
    pairs = pair_machines(machines, owner, speed, gravity, LINEAR)
    bounds = planar_enclosure(pairs)
    return bounds.error(), planar_gravity_error(pairs, across[owner], bounds.most)
