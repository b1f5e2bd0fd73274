"""A rotor with its chambers, ready for the coupled time steps: which liquid is a layer, which a mass."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.arrays import Array, Flags
from solvers.layer.baffles import tables_of
from solvers.layer.records import Outcome, Record, records
from solvers.layer.state import ring
from solvers.rotor.system import RotorSystem
from solvers.runup.machine import Reading
from solvers.runup.state import (
    CREST,
    GAINS,
    LAYER,
    MEASURES,
    PACE,
    RELEASE,
    SUMS,
    CoupledRotor,
    Machine,
    Room,
    State,
    at_rest,
    layer_properties,
    mean_area,
    planes_of,
)
from solvers.slices import compiled, slices

# A layer that gravity has thrown down is caught again at a speed higher by this factor.
_AGAIN = 1.2


@dataclass
class Coupled(CoupledRotor):
    """A rotor with long-wave layers at one moment, a `solvers.runup.machine.RunupMachine`.

    Parameters
    ----------
    layers : properties of each chamber's layer, records LAYER, shape (l,)
    area, momentum : of all layers, shape (l, c)
    rolling : A e of the fluctuations behind bores of all layers, shape (l, c), or (l, 0) without them
    active : which of them are layers now, shape (l,)
    machine, state, room : of those
    kept : steps written down since `followed` was asked last, rows of the state's trace
    """

    layers: Record
    area: Array
    momentum: Array
    rolling: Array
    active: Flags
    machine: Machine
    state: State
    room: Room
    kept: list[Array] = field(default_factory=list)

    @property
    def shaft(self) -> np.record:
        """See `CoupledRotor`."""
        found: np.record = self.state.shaft[0]
        return found

    @property
    def sums(self) -> np.record:
        """See `CoupledRotor`."""
        found: np.record = self.state.sums[0]
        return found

    @property
    def crest(self) -> np.record:
        """See `CoupledRotor`."""
        found: np.record = self.state.crest[0]
        return found

    @property
    def theta(self) -> Array:
        """Angle of the cells' middles from the drum's zero mark, rad, shape (c,)."""
        return np.asarray(np.arctan2(self.machine.angles[1], self.machine.angles[0]))

    def drive(self, curve: Array, inertia: float) -> None:
        """Set a motor's torque curve and moment of inertia; an empty curve leaves the spin to its ramp."""
        self.machine = self.machine._replace(curve=curve)
        self.shaft.inertia = inertia

    def advance(self, stop: float, rate: float, courant: float, most: int) -> Outcome:
        """Advance to a time while the spin changes at a rate, in at most so many steps."""
        from solvers.runup.kernel import advance

        self.shaft.rate = rate
        outcome, resumed = Outcome.RAN_OUT, False
        rows = self.state.trace.shape[0]
        for steps in slices(most, max(1, self.state.area.size), rows):
            found, _ = compiled(advance, self.machine, self.state, self.room, stop, courant, steps, resumed)
            outcome, resumed = Outcome(found), True
            self._collect()
            if outcome is not Outcome.RAN_OUT:
                break
        self.area[self.active], self.momentum[self.active] = self.state.area, self.state.momentum
        self.rolling[self.active] = self.state.rolling
        return outcome

    def follow(self, rows: int) -> None:
        """Write every step down from here on; 0 writes none.

        Parameters
        ----------
        rows : steps between two looks of Python
        """
        width = 2 + self.state.place.size + 2 * self.state.area.shape[0]
        self.state = self.state._replace(trace=np.zeros((rows, width)))
        self.state.pace[0].kept = 0.0
        self.kept = []

    def followed(self) -> Array:
        """The steps since this was asked last, rows of the state's trace, shape (k, 2 + n + 2 l)."""
        found = np.concatenate([self.state.trace[:0], *self.kept])
        self.kept = []
        return found

    def _collect(self) -> None:
        """Take the steps out of the trace."""
        pace, trace = self.state.pace[0], self.state.trace
        if trace.shape[0] and pace.kept:
            self.kept.append(trace[: int(pace.kept)].copy())
            pace.kept = 0.0

    def energy(self) -> float:
        """Kinetic and elastic energy of rotor and liquid, J [theory: coupling, eq. 9]."""
        x, v = self.state.place, self.state.rate
        total = 0.5 * (v @ self.machine.matrices[0] @ v + x @ self.machine.matrices[3] @ x)
        for layer, plane, measures, momentum in self.measured():
            rate = plane @ v
            total += 0.5 * layer.mass * rate @ rate + momentum @ rate
            total += layer.weight * layer.radius**4 * measures.energy
        return float(total)

    def measured(self) -> list[tuple[np.record, Array, np.record, Array]]:
        """Properties, plane, measures and relative momentum of each layer."""
        from solvers.runup.kernel import measure, relative_momentum

        shaft = self.shaft
        cosine, sine = math.cos(shaft.angle), math.sin(shaft.angle)
        found = []
        for j in range(self.machine.layers.size):
            layer, measures, momentum = self.machine.layers[j], records(MEASURES)[0], np.zeros(2)
            spare, angles = self.room.spare[j], self.machine.angles
            measure(self.state.area[j], self.state.momentum[j], shaft.spin, angles, spare, measures)
            relative_momentum(measures, layer, shaft.spin, cosine, sine, momentum)
            found.append((layer, self.machine.planes[j], measures, momentum))
        return found

    def mass_error(self) -> float:
        """Largest relative change of a layer's volume since the beginning."""
        errors = [0.0]
        for j, fill in enumerate(self.fills):
            if self.active[j]:
                errors.append(abs(float(self.area[j].mean()) / mean_area(fill) - 1.0))
        return max(errors)

    def switch(self) -> float:
        """Catch the liquid that can ride with the drum by now, let go what cannot; energy brought in, J.

        Caught liquid is a uniform layer at rest in the drum; liquid let go lies at the bottom. The momentum
        of rotor and liquid stays.
        """
        limit = np.where(self.active, RELEASE * self.capture, self.capture)
        return self._rearrange(self.spin > limit)

    def fall(self, outcome: Outcome) -> float | None:
        """Let the deepest layer fall to the bottom where gravity has won; energy brought in, J.

        It is caught again at a speed higher by a fifth. None where the outcome has another reason.
        """
        thrown = outcome in (Outcome.AT_AXIS, Outcome.NOT_COUPLED)
        if not (thrown and self.machine.gravity.any() and self.active.any()):
            return None
        deepest = int(np.argmax(np.where(self.active, self.area.max(axis=1), -1.0)))
        wanted = self.active.copy()
        wanted[deepest] = False
        self.capture[deepest] = _AGAIN * self.spin
        return self._rearrange(wanted)

    def _rearrange(self, wanted: Flags) -> float:
        """Make the wanted layers the active ones; energy brought in, J."""
        if np.array_equal(wanted, self.active):
            return 0.0
        before, lost = self.energy(), np.zeros(self.state.rate.size)
        for (_, plane, _, momentum), kept in zip(self.measured(), wanted[self.active], strict=True):
            lost += plane.T @ momentum * (not kept)
        mean = self.area.mean(axis=1, keepdims=True)
        anew = wanted != self.active
        self.area[anew] = mean[anew]
        self.momentum[anew] = -self.spin * np.square(self.area[anew])
        self.rolling[anew] = 0.0
        self.active = wanted
        self._assemble()
        whole = self.machine.matrices[0].copy()
        for mass, plane in zip(self.machine.layers.mass, self.machine.planes, strict=True):
            whole += mass * plane.T @ plane
        self.state.rate[:] += np.linalg.solve(whole, lost)
        return self.energy() - before

    def _assemble(self) -> None:
        """Make machine, state and room anew for the active layers, the other liquid being masses."""
        old, active = self.state, self.active
        planes, mass = planes_of(self.system, self.fills), self.system.mass.copy()
        for weight, plane, moving in zip(self.layers.mass, planes, active, strict=True):
            if not moving:
                mass += weight * plane.T @ plane
        matrices = [mass, self.system.damping, self.system.gyroscopic, self.system.stiffness]
        self.machine = self.machine._replace(
            matrices=np.stack(matrices).astype(float),
            planes=planes[active],
            layers=self.layers[active],
            plates=tables_of(
                [fill for fill, on in zip(self.fills, active, strict=True) if on], self.area.shape[1]
            ),
        )
        count, cells = int(active.sum()), self.area.shape[1]
        self.state = old._replace(
            area=self.area[active],
            momentum=self.momentum[active],
            rolling=self.rolling[active],
            push=np.zeros((count, 2, 2)),
            pace=_fresh_pace(),
        )
        self.follow(old.trace.shape[0])
        self.room = _room(old.place.size, count, cells, self.rolling.shape[1])

    def read(self) -> Reading:
        """The moment as the history keeps it."""
        x, angle = self.state.place.copy(), float(self.shaft.angle)
        turn = complex(math.cos(angle), math.sin(angle))
        deflection = np.array([complex(*(plane @ x)) for plane in self.seen])
        surface = np.sqrt(np.maximum(1.0 - 2.0 * self.area, 0.0))
        lever = (1.0 - surface) * (1.0 + surface + np.square(surface)) / 3.0
        whole = np.maximum(self.area.sum(axis=1), 1e-300)
        angles, radius = self.machine.angles, self.layers.radius
        moved = radius * (lever @ angles[0] + 1j * (lever @ angles[1])) / whole * turn
        velocity = np.divide(self.momentum, self.area, out=np.zeros_like(surface), where=self.area > 0.0)
        velocity += self.spin * self.area
        flow = velocity * -np.log(np.maximum(surface, 1e-300))
        nothing = np.full(len(self.fills), np.nan)
        return Reading(
            time=self.time,
            speed=self.spin,
            angle=angle,
            coordinates=x,
            deflection=deflection,
            **self.largest(abs(deflection[0])),
            offset=np.where(self.active, moved, self.pool),
            captured=self.active.copy(),
            depth_min=np.where(self.active, radius * (1.0 - surface.max(axis=1, initial=0.0)), nothing),
            depth_max=np.where(self.active, radius * (1.0 - surface.min(axis=1, initial=1.0)), nothing),
            mean_rotation=np.where(self.active, flow.sum(axis=1) / whole, 0.0),
        )

    def depth(self) -> Array:
        """Depth of the layers cell by cell, m, nan where the liquid is none, shape (l, c)."""
        surface = np.sqrt(np.maximum(1.0 - 2.0 * self.area, 0.0))
        return np.where(self.active[:, None], self.layers.radius[:, None] * (1.0 - surface), np.nan)


def couple(
    system: RotorSystem,
    fills: Sequence[Fill],
    spin: float,
    friction: Friction,
    gravity: float,
    cells: int,
    dispersion: bool,
    enstrophy: bool = False,
) -> Coupled:
    """Rotor without deflection, liquid at rest in the drum.

    Parameters
    ----------
    system, fills, friction, gravity : as for `solvers.runup.runup.run_up`
    spin : at the beginning, rad/s
    cells, dispersion : of the layers
    enstrophy : their bores carry fluctuations behind them [theory: long_wave, eq. 15-17]

    Raises
    ------
    InputError : a negative gravity
    """
    rest = at_rest(system, fills, spin, gravity)
    n, count = len(system.coordinates), len(fills)
    layers = records(LAYER, count)
    for j, fill in enumerate(fills):
        layers[j] = layer_properties(fill, friction, dispersion)
    area = np.repeat(np.array([mean_area(fill) for fill in fills]).reshape(-1, 1), cells, axis=1)
    found = Coupled(
        system=system,
        fills=tuple(fills),
        layers=layers,
        capture=rest.capture,
        pool=rest.pool,
        area=area,
        momentum=-spin * np.square(area),
        rolling=np.zeros((count, cells if enstrophy else 0)),
        active=rest.capture < spin,
        machine=Machine(
            matrices=np.zeros((4, n, n)),
            unbalance=system.unbalance.astype(complex),
            planes=np.zeros((0, 2, n)),
            layers=layers[:0],
            gravity=rest.gravity,
            angles=ring(cells),
            curve=np.zeros((2, 0)),
            watched=rest.watched,
            plates=tables_of([], cells),
        ),
        state=State(
            place=np.zeros(n),
            rate=np.zeros(n),
            shaft=rest.shaft,
            area=area[:0],
            momentum=area[:0],
            rolling=area[:0, :0],
            push=np.zeros((0, 2, 2)),
            pace=_fresh_pace(),
            sums=records(SUMS),
            crest=records(CREST),
            trace=np.zeros((0, 2 + n)),
        ),
        room=_room(n, 0, cells, 0),
    )
    found._assemble()
    return found


def _fresh_pace() -> Record:
    """Pace of a machine that has made no step yet."""
    pace = records(PACE)
    pace[0].share = 1.0
    return pace


def _room(coordinates: int, layers: int, cells: int, rolling: int) -> Room:
    """Scratch for a machine of that size; `rolling`: cells with fluctuations."""
    from solvers.runup.kernel import layer_scratch

    n, count = coordinates, layers
    return Room(
        area=np.zeros((count, cells)),
        momentum=np.zeros((count, cells)),
        rolling=np.zeros((count, rolling)),
        begin=records(MEASURES, count),
        end=records(MEASURES, count),
        gains=records(GAINS, count),
        inertia=np.zeros((count, 3)),
        before=np.zeros((count, 2)),
        after=np.zeros((count, 2)),
        guess=np.zeros((count, 2)),
        found=np.zeros((count, 2)),
        change=np.zeros(n),
        swing=np.zeros(n),
        left=np.zeros((n, n)),
        spins=np.zeros(2),
        turn=np.zeros(4),
        force=np.zeros(4),
        spare=layer_scratch(count, cells),
    )
