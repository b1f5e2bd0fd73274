"""A rotor with its chambers, ready for the coupled time steps: which liquid is a layer, which a mass."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.friction import Friction
from meshes.arrays import Array
from meshes.errors import require_not_negative
from solvers.layer.loads import ring
from solvers.rotor.system import RotorSystem
from solvers.runup.chamber import layer_capture, layer_properties, pool_offset
from solvers.runup.state import ENERGY, GAINS, MASS, MEASURES, RADIUS, TALLIES, WEIGHT, Machine, Room, State

# A layer is let go at this share of the spin speed that captures it, lest it be caught and let go in turns.
_RELEASE = 0.98


@dataclass
class Coupled:
    """A rotor with chambers at one moment.

    Parameters
    ----------
    system, fills : what it is made from
    layers : properties of each chamber's layer, shape (l, 7)
    capture : speed above which each rides with the drum as a layer, rad/s, inf for a solid mass, shape (l,)
    pool : offset of the centre of mass of liquid that is no layer, along the first direction, m, shape (l,)
    area, momentum : of all layers, shape (l, c)
    active : which of them are layers now, shape (l,)
    machine, state, room : of those
    """

    system: RotorSystem
    fills: tuple[Fill, ...]
    layers: Array
    capture: Array
    pool: Array
    area: Array
    momentum: Array
    active: NDArray[np.bool_]
    machine: Machine
    state: State
    room: Room

    @property
    def time(self) -> float:
        """Time, s."""
        return float(self.state.rotor[-1])

    @property
    def spin(self) -> float:
        """Spin speed, rad/s."""
        return float(self.state.rotor[-3])

    @property
    def held_by_spin(self) -> bool:
        """Gravity acts across the axis, and some liquid rides with the drum against it."""
        return bool(self.machine.gravity.any() and self.active.any())

    @property
    def masses(self) -> Array:
        """Mass of the liquid in each chamber, kg, shape (l,)."""
        return self.layers[:, MASS].copy()

    @property
    def sums(self) -> Array:
        """Tallies of `solvers.runup.state`."""
        return self.state.sums

    def drive(self, curve: Array, inertia: float) -> None:
        """Set a motor's torque curve and moment of inertia; an empty curve leaves the spin to its ramp."""
        self.machine = self.machine._replace(curve=curve)
        self.machine.drive[1] = inertia

    def advance(self, stop: float, rate: float, courant: float, most: int) -> int:
        """Advance to a time; status of `solvers.runup.kernel.advance`."""
        from solvers.runup.kernel import advance

        self.machine.drive[0] = rate
        status = int(advance(self.machine, self.state, self.room, stop, courant, most))
        self.area[self.active], self.momentum[self.active] = self.state.area, self.state.momentum
        return status

    def energy(self) -> float:
        """Kinetic and elastic energy of rotor and liquid, J [theory: coupling, eq. 9]."""
        n = len(self.system.coordinates)
        x, v = self.state.rotor[:n], self.state.rotor[n : 2 * n]
        total = 0.5 * (v @ self.machine.matrices[0] @ v + x @ self.machine.matrices[3] @ x)
        for layer, plane, measures, momentum in self.measured():
            rate = plane @ v
            total += 0.5 * layer[MASS] * rate @ rate + momentum @ rate
            total += layer[WEIGHT] * layer[RADIUS] ** 4 * measures[ENERGY]
        return float(total)

    def measured(self) -> list[tuple[Array, Array, Array, Array]]:
        """Properties, plane, measures and relative momentum of each layer."""
        from solvers.runup.kernel import measure, relative_momentum

        cosine, sine = math.cos(self.state.rotor[-2]), math.sin(self.state.rotor[-2])
        found = []
        for j, layer in enumerate(self.machine.layers):
            measures, momentum = np.zeros(MEASURES), np.zeros(2)
            spare, angles = self.room.spare[j], self.machine.angles
            measure(self.state.area[j], self.state.momentum[j], self.spin, angles, spare, measures)
            relative_momentum(measures, layer, self.spin, cosine, sine, momentum)
            found.append((layer, self.machine.planes[j], measures, momentum))
        return found

    def mass_error(self) -> float:
        """Largest relative change of a layer's volume since the beginning."""
        errors = [0.0]
        for j, fill in enumerate(self.fills):
            if self.active[j]:
                mean = fill.volume / (2.0 * math.pi * fill.chamber.height * fill.chamber.radius**2)
                errors.append(abs(float(self.area[j].mean()) / mean - 1.0))
        return max(errors)


def couple(
    system: RotorSystem,
    fills: Sequence[Fill],
    spin: float,
    friction: Friction,
    gravity: float,
    cells: int,
    dispersion: bool,
) -> Coupled:
    """Rotor without deflection, liquid at rest in the drum.

    Parameters
    ----------
    system, fills, friction, gravity : as for `solvers.runup.runup.run_up`
    spin : at the beginning, rad/s
    cells, dispersion : of the layers

    Raises
    ------
    InputError : a negative gravity
    """
    require_not_negative("gravity", gravity)
    layers = np.array([layer_properties(fill, friction, dispersion) for fill in fills]).reshape(len(fills), 7)
    capture = np.array([layer_capture(fill, gravity) for fill in fills])
    mean = [fill.volume / (2.0 * math.pi * fill.chamber.height * fill.chamber.radius**2) for fill in fills]
    area = np.repeat(np.array(mean).reshape(-1, 1), cells, axis=1)
    n = len(system.coordinates)
    rotor = np.zeros(2 * n + 3)
    rotor[2 * n] = spin
    whole: dict[str, Any] = {
        "system": system,
        "fills": tuple(fills),
        "layers": layers,
        "capture": capture,
        "pool": np.array([pool_offset(fill) if gravity > 0.0 else 0.0 for fill in fills]),
        "area": area,
        "momentum": -spin * np.square(area),
        "active": capture < spin,
    }
    drive = (np.array([-gravity, 0.0]), ring(cells), np.zeros(2), np.zeros((2, 0)))
    machine, state, scratch = _parts(**whole, rotor=rotor, sums=np.zeros(TALLIES), drive=drive)
    return Coupled(**whole, machine=machine, state=state, room=scratch)


def _parts(
    *,
    system: RotorSystem,
    fills: tuple[Fill, ...],
    layers: Array,
    area: Array,
    momentum: Array,
    active: NDArray[np.bool_],
    rotor: Array,
    sums: Array,
    drive: tuple[Array, Array, Array, Array],
    **_: object,
) -> tuple[Machine, State, Room]:
    """Machine of the active layers, the other liquid being masses."""
    planes = np.array([system.at(fill.chamber.plane) for fill in fills])
    n, count = len(system.coordinates), int(active.sum())
    planes = planes.reshape(len(fills), 2, n)
    mass = system.mass.copy()
    for layer, plane, moving in zip(layers, planes, active, strict=True):
        if not moving:
            mass += layer[MASS] * plane.T @ plane
    matrices = np.stack([mass, system.damping, system.gyroscopic, system.stiffness]).astype(float)
    machine = Machine(matrices, system.unbalance.astype(complex), planes[active], layers[active], *drive)
    memory = np.zeros((count + 1, 4))
    memory[count, 3] = 1.0
    cells = area.shape[1]
    return machine, State(rotor, area[active], momentum[active], memory, sums), _room(n, count, cells)


def _room(coordinates: int, layers: int, cells: int) -> Room:
    """Scratch for a machine of that size."""
    from solvers.runup.kernel import layer_scratch

    n, count = coordinates, layers
    pairs, few = (count, 2), (4,)
    return Room(
        area=np.zeros((count, cells)),
        momentum=np.zeros((count, cells)),
        begin=np.zeros((count, MEASURES)),
        end=np.zeros((count, MEASURES)),
        gains=np.zeros((count, GAINS)),
        inertia=np.zeros((count, 3)),
        before=np.zeros(pairs),
        after=np.zeros(pairs),
        guess=np.zeros(pairs),
        found=np.zeros(pairs),
        change=np.zeros(n),
        swing=np.zeros(n),
        left=np.zeros((n, n)),
        spins=np.zeros(2),
        turn=np.zeros(few),
        push=np.zeros(few),
        rub=np.zeros(few),
        spare=layer_scratch(count, cells),
    )


def switch(machine: Coupled) -> float:
    """Catch the liquid that can ride with the drum by now, let go what cannot; energy brought in, J.

    Caught liquid is a uniform layer at rest in the drum; liquid let go lies at the bottom. The momentum of
    rotor and liquid stays.
    """
    limit = np.where(machine.active, _RELEASE * machine.capture, machine.capture)
    return _rearrange(machine, machine.spin > limit)


def fall(machine: Coupled) -> float:
    """Let the deepest layer fall to the bottom before its time; energy brought in, J.

    It is caught again at a speed higher by a fifth.
    """
    deepest = int(np.argmax(np.where(machine.active, machine.area.max(axis=1), -1.0)))
    wanted = machine.active.copy()
    wanted[deepest] = False
    machine.capture[deepest] = 1.2 * machine.spin
    return _rearrange(machine, wanted)


def _rearrange(machine: Coupled, wanted: NDArray[np.bool_]) -> float:
    """Make the wanted layers the active ones; energy brought in, J."""
    if np.array_equal(wanted, machine.active):
        return 0.0
    before = machine.energy()
    n = len(machine.system.coordinates)
    lost = np.zeros(n)
    for (_, plane, _, momentum), kept in zip(machine.measured(), wanted[machine.active], strict=True):
        lost += plane.T @ momentum * (not kept)
    mean = machine.area.mean(axis=1, keepdims=True)
    anew = wanted != machine.active
    machine.area[anew] = mean[anew]
    machine.momentum[anew] = -machine.spin * np.square(machine.area[anew])
    machine.active = wanted
    old = machine.machine
    machine.machine, machine.state, machine.room = _parts(
        system=machine.system,
        fills=machine.fills,
        layers=machine.layers,
        area=machine.area,
        momentum=machine.momentum,
        active=wanted,
        rotor=machine.state.rotor,
        sums=machine.state.sums,
        drive=(old.gravity, old.angles, old.drive, old.curve),
    )
    whole = machine.machine.matrices[0].copy()
    for layer, plane in zip(machine.machine.layers, machine.machine.planes, strict=True):
        whole += layer[MASS] * plane.T @ plane
    machine.state.rotor[n : 2 * n] += np.linalg.solve(whole, lost)
    return machine.energy() - before


def reading(machine: Coupled) -> dict[str, Any]:
    """What `solvers.runup.runup.RunupHistory` records of a moment, by its names."""
    n, count = len(machine.system.coordinates), len(machine.fills)
    x, angle = machine.state.rotor[:n].copy(), float(machine.state.rotor[-2])
    turn = complex(math.cos(angle), math.sin(angle))
    planes = [machine.system.at(fill.chamber.plane) for fill in machine.fills] or [machine.system.centre]
    surface = np.sqrt(np.maximum(1.0 - 2.0 * machine.area, 0.0))
    lever = (1.0 - surface) * (1.0 + surface + np.square(surface)) / 3.0
    whole = np.maximum(machine.area.sum(axis=1), 1e-300)
    angles, radius = machine.machine.angles, machine.layers[:, RADIUS]
    moved = radius * (lever @ angles[0] + 1j * (lever @ angles[1])) / whole * turn
    velocity = np.divide(machine.momentum, machine.area, out=np.zeros_like(surface), where=machine.area > 0.0)
    velocity += machine.spin * machine.area
    flow = velocity * -np.log(np.maximum(surface, 1e-300))
    nothing = np.full(count, np.nan)
    return {
        "time": machine.time,
        "speed": machine.spin,
        "angle": angle,
        "coordinates": x,
        "deflection": np.array([complex(*(plane @ x)) for plane in planes]),
        "offset": np.where(machine.active, moved, machine.pool),
        "captured": machine.active.copy(),
        "depth_min": np.where(machine.active, radius * (1.0 - surface.max(axis=1, initial=0.0)), nothing),
        "depth_max": np.where(machine.active, radius * (1.0 - surface.min(axis=1, initial=1.0)), nothing),
        "mean_rotation": np.where(machine.active, flow.sum(axis=1) / whole, 0.0),
    }
