"""Self-excited whirl: growth rate and whirl speed of the mode that grows most, for any rotor and fills."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from fluid.whirl import Layer, is_full, plane_layer
from meshes.arrays import Array, Complex, Index
from meshes.errors import InputError
from solvers.checked_model import CheckedModel
from solvers.rotor.jeffcott import Jeffcott, PlanarMachine
from solvers.rotor.system import Rotor
from solvers.sloshing.reduced import section_layer, section_layers
from solvers.whirl.laminar import Met, laminar_modes
from solvers.whirl.planar import Modes, PlanarProblem, planar_modes
from solvers.whirl.sections import drum_modes, standing_modes
from solvers.whirl.system import SystemModes, circles_of, coupled_matrices, linear_modes
from solvers.whirl.transfer import transfer_modes

MOST_LAYERS = 50
_ALIKE = 1e-9  # relative; layers that differ by less are one
_EQUAL = 1e-9  # of a mode's own speed: difference in growth of two modes that counts as none

# What small waves do: those of a ring under friction, or whatever a model of one's own answers.
Waves = Friction | CheckedModel


def asynchronous_growth(
    rotor: Rotor,
    fills: Sequence[Fill],
    speed: ArrayLike,
    friction: Waves = NO_FRICTION,
    met: Met | None = None,
) -> tuple[Array, Array]:
    """Growth rate and whirl speed of the fastest-growing whirl [theory: whirl, eq. 7], shape (n,).

    1/s, unstable above 0, 0 where rounding cannot tell it from 0, nan where modes were not found; rad/s in
    the standing frame, positive with the spin. The laminar law takes each liquid's viscosity, the quadratic
    one does not act on an infinitesimal whirl. An `InputError` also for too many different layers. `met`:
    what is known of the machine and what becomes known, for further questions about it.
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    row = np.zeros(spin.size, dtype=np.intp)
    return growth_at(rotor, [fills], row, spin, friction, None if met is None else [met])


def growth_map(
    rotor: Rotor, rows: Sequence[Sequence[Fill]], speed: ArrayLike, friction: Waves = NO_FRICTION
) -> tuple[Array, Array]:
    """Growth rate and whirl speed over speed for each of several sets of fills, shape (rows, n)."""
    spin = np.array(speed, dtype=float).reshape(-1)
    row = np.repeat(np.arange(len(rows)), spin.size)
    growth, whirl_speed = growth_at(rotor, rows, row, np.tile(spin, len(rows)), friction)
    shape = (len(rows), spin.size)
    return growth.reshape(shape), whirl_speed.reshape(shape)


def growth_at(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    row: Index,
    speed: Array,
    friction: Waves = NO_FRICTION,
    met: Sequence[Met] | None = None,
) -> tuple[Array, Array]:
    """Growth rate and whirl speed at points (row, speed), as `growth_map`; `met`: of each row."""
    if not np.all(np.isfinite(speed) & (speed > 0.0)):
        raise InputError("speed", speed.tolist(), "finite numbers above 0")
    if isinstance(rotor, Jeffcott):
        return machines_growth([(rotor, fills) for fills in rows], [friction] * len(rows), row, speed)
    growth, whirl_speed = np.full((2, speed.size), np.nan)
    for k in np.unique(row).tolist():
        here = np.flatnonzero(row == k)
        own = None if met is None else met[k]
        modes = system_modes(rotor, rows[k], speed[here], friction, every=False, met=own)
        growth[here], whirl_speed[here] = _fastest(modes, speed[here])
    return growth, whirl_speed


def system_modes(
    rotor: Rotor,
    fills: Sequence[Fill],
    speed: Array,
    friction: Waves = NO_FRICTION,
    near: SystemModes | None = None,
    every: bool = True,
    met: Met | None = None,
) -> SystemModes:
    """All whirl modes of any rotor with its fills, or those that grow most [theory: whirl, eq. 7].

    `near`: those at speeds next to these, from which an iteration follows them; it looks for no others then.
    `met`: what is known of the machine, where a search needs a start. Of laminar layers the way round is told
    without `every` alone.
    """
    heavy, law = rotor.system(), _waves_of(fills, friction)
    if isinstance(law, CheckedModel):
        found = transfer_modes(heavy, fills, speed, law)
        assert isinstance(found, SystemModes)
        return found
    for fill in fills:
        if is_full(fill):
            at = heavy.at(fill.chamber.plane)
            heavy = replace(heavy, mass=heavy.mass + fill.mass * at.T @ at)
    if any(fill.uneven for fill in fills):
        cut = [(fill.chamber.plane, section_layer(fill, law)) for fill in fills]
        parted = [(plane, layer) for plane, layer in cut if layer is not None]
        return standing_modes(heavy, parted, speed, near)
    rings = [(fill.chamber.plane, plane_layer(fill, law)) for fill in fills]
    layers = [(plane, layer) for plane, layer in rings if layer is not None]
    _require_few(len(layers))
    if any(layer.stokes > 0.0 for _, layer in layers):
        return laminar_modes(heavy, layers, speed, near, every, met)
    return linear_modes(coupled_matrices(heavy, layers, speed), circles_of(heavy, layers))


def _fastest(modes: SystemModes, spin: Array) -> tuple[Array, Array]:
    """Growth rate and whirl speed from eigenvalues; nan where a mode that grows more may be missing."""
    root, known, lost = modes.root, modes.found, ~modes.complete
    omega = modes.sense * root.imag - 1j * root.real
    omega = np.where(known, omega, complex(np.nan, np.nan))
    growth, whirl_speed = dominant(omega.T, modes.rounding.T, spin)
    return np.where(lost, np.nan, growth), np.where(lost, np.nan, whirl_speed)


def dominant(omega: Complex, rounding: Array, spin: Array) -> tuple[Array, Array]:
    """Growth rate and whirl speed of the mode that grows most, shape (n,).

    Growth is 0 where rounding cannot tell it from 0; of modes that grow alike, to 1e-9 of their own speeds,
    the one nearest to the spin, as growing waves are. Modes of shape (m, n), rad/s in the standing frame, nan
    where there is none.
    """
    missing = np.isnan(omega)
    rate = np.where(missing, -np.inf, -omega.imag)
    rate = np.where(np.abs(rate) <= rounding, 0.0, rate)
    most = rate.max(axis=0)
    alike = ~missing & (rate >= most - _EQUAL * np.abs(omega))
    away = np.where(alike, np.abs(spin - omega.real), np.inf)
    which = np.argmin(away, axis=0)
    return most, np.take_along_axis(omega.real, which[None], axis=0)[0]


def machines_growth(
    machines: Sequence[PlanarMachine], frictions: Sequence[Waves], owner: Index, speed: Array
) -> tuple[Array, Array]:
    """Growth rate and whirl speed of many planar machines at once [theory: whirl, eq. 8]."""
    growth, whirl_speed = np.full((2, speed.size), np.nan)
    for here, found in _planar_parts(machines, frictions, owner, speed):
        if isinstance(found, SystemModes):
            growth[here], slip = _fastest(found, np.zeros(here.shape))
            whirl_speed[here] = slip + speed[here]
            continue
        values = dominant(found.slip + speed[here], found.rounding, speed[here])
        for table, own in zip((growth, whirl_speed), values, strict=True):
            table[here] = np.where(found.converged, own, np.nan)
    return growth, whirl_speed


def _planar_parts(
    machines: Sequence[PlanarMachine],
    frictions: Sequence[Waves],
    owner: Index,
    speed: Array,
    near: Sequence[SystemModes | Modes] = (),
) -> Iterator[tuple[Index, SystemModes | Modes]]:
    """Points of planar machines with as many modes each, and those modes; arguments of `machines_growth`.

    In the frame of the drum where baffles stand in the liquid [theory: sections, eq. 3]. `near`: what came at
    speeds next to these, as of `system_modes`.
    """
    known = iter(near)
    laws = [_waves_of(fills, law) for (_, fills), law in zip(machines, frictions, strict=True)]
    apart = np.zeros(len(machines), dtype=bool)
    tables: list[tuple[float, list[Layer]]] = []
    for i, ((rotor, fills), law) in enumerate(zip(machines, laws, strict=True)):
        apart[i] = isinstance(law, CheckedModel) or any(fill.uneven for fill in fills)
        here = np.flatnonzero(owner == i) if apart[i] else np.zeros(0, dtype=np.intp)
        if isinstance(law, CheckedModel):
            tables.append((rotor.mass, []))
            if here.size:
                next(known, None)
                yield here, transfer_modes(rotor, fills, speed[here], law)
            continue
        tables.append(planar_layers(rotor.mass, fills, law))
        if here.size:
            solid, parted = section_layers(fills, law)
            close = next(known, None)
            assert not isinstance(close, Modes)
            yield here, drum_modes(replace(rotor, mass=rotor.mass + solid), parted, speed[here], close)
    support = np.array([(rotor.stiffness, rotor.damping) for rotor, _ in machines]).reshape(-1, 2)
    # The number of modes depends on that of the layers and on whether their drag depends on the mode.
    kinds = [(len(layers), any(layer.stokes > 0.0 for layer in layers)) for _, layers in tables]
    for kind in sorted(set(kinds)):
        _require_few(kind[0])
        own = np.array([i for i, other in enumerate(kinds) if other == kind and not apart[i]], dtype=np.intp)
        index = np.full(len(machines), -1, dtype=np.intp)
        index[own] = np.arange(own.size)
        here = np.flatnonzero(index[owner] >= 0)
        if here.size == 0:
            continue
        place = index[owner[here]]
        mass = np.array([tables[i][0] for i in own])[place]
        layers = np.array(
            [[(x.mass, x.layer_tanh, x.rate, x.stokes, x.lids) for x in tables[i][1]] for i in own]
        ).reshape(own.size, kind[0], 5)[place]
        stiffness, damping = support[own[place]].T
        columns = (layers[:, :, k].T for k in range(5))
        yield here, planar_modes(PlanarProblem(mass, stiffness, damping, speed[here], *columns))


Parts = list[tuple[Index, SystemModes | Modes]]


def modes_at(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    row: Index,
    speed: Array,
    friction: Waves,
    beside: float,
    met: Sequence[Met] | None = None,
) -> tuple[tuple[Complex, Array], tuple[Complex, Array], Array]:
    """Modes of small whirls and their rounding at points (row, speed) and next to them; largest growth rates.

    growth + i frequency, 1/s, each mode once, in a frame in which coupled modes meet where they are alike; 0
    for a growth that is rounding, nan where a point has fewer modes, shape (n, m). Next to them: at speeds
    larger by the share `beside`, without a proof that no mode is missing. `met`: of each row.
    """

    def parts(row: Index, spin: Array, near: Parts) -> Parts:
        close = [found for _, found in near]
        if isinstance(rotor, Jeffcott):
            machines = [(rotor, fills) for fills in rows]
            return list(_planar_parts(machines, [friction] * len(rows), row, spin, close))
        own = [(np.flatnonzero(row == k), k) for k in np.unique(row).tolist()]
        known = [modes if isinstance(modes, SystemModes) else None for modes in close] or [None] * len(own)
        return [
            (here, system_modes(rotor, rows[k], spin[here], friction, modes, met=met[k] if met else None))
            for (here, k), modes in zip(own, known, strict=True)
        ]

    size, next_to = speed.size, speed * (1.0 + beside)
    if isinstance(rotor, Jeffcott) and not any(fill.uneven for fills in rows for fill in fills):
        # None are followed from one speed to the other: both together cost hardly more than one.
        spin = np.append(speed, next_to)
        every = parts(np.tile(row, 2), spin, [])
        root, rounding = _table(every, 2 * size)
        growth = _growths(every, spin)[:size]
        return (root[:size], rounding[:size]), (root[size:], rounding[size:]), growth
    first = parts(row, speed, [])
    second = parts(row, next_to, first)
    return _table(first, size), _table(second, size), _growths(first, speed)


def _growths(parts: Parts, speed: Array) -> Array:
    """Largest growth rates from the parts of `modes_at`."""
    growth = np.full(speed.size, np.nan)
    for here, found in parts:
        if isinstance(found, SystemModes):
            growth[here] = _fastest(found, speed[here])[0]
        else:
            most = dominant(found.slip + speed[here], found.rounding, speed[here])[0]
            growth[here] = np.where(found.converged, most, np.nan)
    return growth


def _table(parts: Parts, size: int) -> tuple[Complex, Array]:
    """Modes of `modes_at` and their rounding from those of its parts."""
    seen = []
    for here, found in parts:
        if isinstance(found, SystemModes):
            known = found.found & (found.root.imag >= 0.0)
            root, rounding = np.where(known, found.root, complex(np.nan, np.nan)), found.rounding
        else:
            root, rounding = (1j * found.slip).T, found.rounding.T
        kept = ~np.isnan(root).all(axis=0)
        root, rounding = root[:, kept], rounding[:, kept]
        seen.append((here, np.where(np.abs(root.real) <= rounding, 1j * root.imag, root), rounding))
    width = max((part.shape[1] for _, part, _ in seen), default=0)
    roots = np.full((size, width), complex(np.nan, np.nan))
    noise = np.full((size, width), np.nan)
    for here, part, unsure in seen:
        roots[here, : part.shape[1]], noise[here, : part.shape[1]] = part, unsure
    return roots, noise


def _waves_of(fills: Sequence[Fill], waves: Waves) -> Waves:
    """What small waves do; without any free surface there are none."""
    return waves if any(fill.volume > 0.0 and not is_full(fill) for fill in fills) else NO_FRICTION


def planar_layers(mass: float, fills: Sequence[Fill], friction: Friction) -> tuple[float, list[Layer]]:
    """Mass of a rotor with all liquid that has no free surface, and its layers, equal ones as one.

    In one plane the liquid of equal chambers acts together; a layer without mass stands for their sloshing
    against one another, which does not move the rotor.
    """
    layers: list[Layer] = []
    apart: list[Layer] = []
    for fill in fills:
        layer = plane_layer(fill, friction)
        if is_full(fill):
            mass += fill.mass
        if layer is None:
            continue
        same = [k for k, other in enumerate(layers) if _alike(layer, other)]
        if not same:
            layers.append(layer)
            continue
        k = same[0]
        if not any(_alike(layer, other) for other in apart):
            apart.append(replace(layer, mass=0.0))
        layers[k] = replace(layers[k], mass=layers[k].mass + layer.mass)
    return mass, layers + apart


def _alike(first: Layer, second: Layer) -> bool:
    return all(
        abs(getattr(first, name) - getattr(second, name)) <= _ALIKE * abs(getattr(first, name))
        for name in ("layer_tanh", "rate", "stokes", "lids")
    )


def _require_few(count: int) -> None:
    if count > MOST_LAYERS:
        raise InputError("chambers", count, f"at most {MOST_LAYERS} whose layers differ")
