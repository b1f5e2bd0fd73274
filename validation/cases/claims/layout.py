"""Rules for the layout of a washing machine, each with the couplings that it takes away.

They stand in words in DR18, sections 2 and 8. The machine is the suspended tub of DG21 with mounts along its
axes in the plane of its centre, so that one rule at a time can be kept or broken. All but masses and
eccentricity is assumed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from meshes.arrays import Array
from solvers.rotor.layout import PAIRS, couplings
from solvers.rotor.tub import Mount, Tub, Vector
from solvers.rotor.two_plane import PlaneUnbalance
from solvers.rotor.vibration import unbalance_response
from validation.case import Case, Claims
from validation.cases.rotors.tub import DAMPER, SPRING, suspended_tub

CLAIMS = Claims("claims")

NAMES = ("x", "y", "z", "alpha", "beta", "gamma")
_SPREAD = (0.2, 0.15)  # m, of the mounts across and along the axis
_SHIFT = 0.03  # m, by which a rule is broken
_NONE = 1e-12  # a coupling that is rounding alone
_SPEEDS = np.linspace(2.0, 60.0, 581)  # rad/s, over all resonances


def centred_tub(drum: Vector = (0.0, 0.0, 0.0), springs: float = 0.0, dampers: float = 0.0) -> Tub:
    """Tub whose mounts couple nothing.

    `drum` is the drum's centre, m; mounts sit `springs`, `dampers` above the centre and in front of it, m.
    """

    def mounts(size: Vector, shift: float) -> tuple[Mount, ...]:
        across, along = _SPREAD
        return tuple(
            Mount((x * across, y * along + shift, shift), along_axes=size) for x in (1, -1) for y in (1, -1)
        )

    return replace(
        suspended_tub(),
        springs=mounts((0.3 * SPRING, 0.2 * SPRING, 0.5 * SPRING), springs),
        dampers=mounts((0.5 * DAMPER, 0.5 * DAMPER, 0.5 * DAMPER), dampers),
        drum_position=drum,
    )


def cases() -> Iterator[Case]:
    """Each rule kept and broken, the drum's spin, and the two wordings of one rule."""
    plain, along = centred_tub(), centred_tub(drum=(0.0, _SHIFT, 0.0))
    system, turns = plain.system(), _turns(plain)
    rules = (
        (
            *("1-axis", "tub's centre of mass on the drum's axis", "mass"),
            *(centred_tub(drum=(_SHIFT, 0.0, _SHIFT)), "the drum's centre off the tub's across the axis"),
        ),
        (
            *("3-centres", "drum's centre of mass in the tub's", "mass", along),
            f"along the axis; largest turn under the unbalance {turns:.2g} rad kept, {_turns(along):.2g} rad "
            "broken",
        ),
        (
            *("4-rigidity", "centre and axes of rigidity in those of mass", "stiffness"),
            *(centred_tub(springs=_SHIFT), "the springs above the centre and in front of it"),
        ),
        (
            *("5-damping", "axes of viscous friction in those of mass", "damping"),
            *(centred_tub(dampers=_SHIFT), "the dampers above the centre and in front of it"),
        ),
    )
    for rule, what, of, broken_tub, broken_by in rules:
        # A rule must take every coupling away, and without it there are some.
        kept, broken = (_couplings(getattr(each, of)) for each in (system, broken_tub.system()))
        left = ", ".join(f"{pair} {size:.3f}" for pair, size in broken.items())
        computed = ", ".join(kept) or f"none; broken: {left}"
        words = {"rule": rule, "meaning": f"{what}: couplings of the {of}", "broken_by": broken_by}
        yield CLAIMS.case("layout", computed, not kept and bool(broken), **words)
        if rule == "1-axis":
            # The drum's axis is one of its inertia: without the couple of an unbalance along its length.
            size = 0.1 * plain.unbalance
            loads = (PlaneUnbalance(0.06, size), PlaneUnbalance(-0.06, size, np.pi))
            tilted = _turns(replace(plain, loads=loads))
            holds = turns < _NONE < tilted
            yield CLAIMS.case("layout-2-inertia", agrees=holds, kept=turns, broken=tilted)
    # With all rules the free motions at rest are separate; the spin couples two turns.
    rest = {**_couplings(system.mass), **_couplings(system.stiffness), **_couplings(system.damping)}
    turning = [f"{NAMES[i]}-{NAMES[j]}" for i, j in PAIRS if abs(system.gyroscopic[i, j]) > 0.0]
    told = f"none at rest; {', '.join(turning)} by J_b omega while it turns"
    yield CLAIMS.case("layout-separate", told, not rest and turning == ["alpha-gamma"])


def _couplings(matrix: Array) -> dict[str, float]:
    """Those that are not rounding, by pair."""
    sizes = couplings(matrix)
    return {
        f"{NAMES[i]}-{NAMES[j]}": float(size)
        for (i, j), size in zip(PAIRS, sizes.tolist(), strict=True)
        if abs(size) > _NONE
    }


def _turns(machine: Tub) -> float:
    """Largest turn about x or z under the unbalance at any speed, rad."""
    return float(np.abs(unbalance_response(machine.system(), _SPEEDS)[:, [3, 5]]).max())
