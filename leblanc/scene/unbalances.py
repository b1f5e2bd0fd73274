"""The unbalances of a scene's rotor of any kind, and what spins with them: one order for all of them."""

from __future__ import annotations

from collections.abc import Sequence

from leblanc.scene.loads import Sheds
from leblanc.scene.rotors import AnyRotor, JeffcottRotor, Machine, TubRotor, TwoPlaneRotor
from leblanc.scene.spindle import Spindle


def polar_inertia_of(rotor: AnyRotor) -> float | None:
    """Moment of inertia about the axis of what spins, without liquid, kg m^2; None where it is not given."""
    if isinstance(rotor, TubRotor):
        return rotor.drum_polar_inertia
    return rotor.polar_inertia if isinstance(rotor, TwoPlaneRotor) else None


def unbalances_of(rotor: AnyRotor) -> tuple[float, ...]:
    """Size of each unbalance of a rotor, kg m."""
    if isinstance(rotor, TwoPlaneRotor):
        return tuple(part.size for part in rotor.unbalances)
    if isinstance(rotor, Spindle | Machine):
        return tuple(value for value in [getattr(rotor, "unbalance", None)] if value is not None)
    own = (rotor.unbalance,)
    if isinstance(rotor, TubRotor):
        return own * rotor.has_own_unbalance + tuple(load.size for load in rotor.loads)
    return own


def unbalance_places_of(rotor: AnyRotor) -> tuple[float, ...]:
    """Place of the plane of each unbalance along the axis, in the order of `unbalances_of`, m."""
    if isinstance(rotor, TwoPlaneRotor):
        return tuple(part.position for part in rotor.unbalances)
    if isinstance(rotor, TubRotor):
        own = rotor.drum_position[1] if rotor.unbalance_position is None else rotor.unbalance_position
        return (own,) * rotor.has_own_unbalance + tuple(load.position for load in rotor.loads)
    return (0.0,) * len(unbalances_of(rotor))


def sheds_of(rotor: AnyRotor) -> tuple[Sheds | None, ...]:
    """What leaves of each unbalance of a rotor, in the order of `unbalances_of`."""
    if isinstance(rotor, TwoPlaneRotor):
        return tuple(part.sheds for part in rotor.unbalances)
    if isinstance(rotor, TubRotor):
        return (rotor.sheds,) * rotor.has_own_unbalance + tuple(load.sheds for load in rotor.loads)
    if not unbalances_of(rotor):
        return ()
    return (rotor.sheds if isinstance(rotor, JeffcottRotor) else None,)


def with_unbalances(rotor: AnyRotor, sizes: Sequence[float]) -> AnyRotor:
    """The same rotor with unbalances of other sizes, kg m, at the same places and angles."""
    if isinstance(rotor, TwoPlaneRotor):
        parts = zip(rotor.unbalances, sizes, strict=True)
        return rotor.altered(unbalances=tuple(part.altered(size=size) for part, size in parts))
    if isinstance(rotor, TubRotor) and rotor.loads:
        first = int(rotor.has_own_unbalance)
        pairs = zip(rotor.loads, sizes[first:], strict=True)
        loads = tuple(load.altered(size=size) for load, size in pairs)
        return rotor.altered(loads=loads, **({"unbalance": sizes[0]} if first else {}))
    if not unbalances_of(rotor):
        return rotor
    (size,) = sizes
    return rotor.altered(unbalance=size)


def left_in_the_end(rotor: AnyRotor) -> float:
    """Share of the sizes of all unbalances that remains when all has left that does."""
    sizes, sheds = unbalances_of(rotor), sheds_of(rotor)
    gone = sum(size * part.share for size, part in zip(sizes, sheds, strict=True) if part is not None)
    return 1.0 - gone / sum(sizes) if sum(sizes) > 0.0 else 1.0
