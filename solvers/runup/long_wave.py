"""A rotor with its chambers, ready for the coupled time steps: which liquid is a layer, which a mass."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.baffles import SUPERCRITICAL
from fluid.friction.laws import Friction
from meshes.arrays import Array, Complex, Flags
from solvers.layer.baffles import tables_of
from solvers.layer.inside import SLOT_SPEED, full_area
from solvers.layer.records import Outcome, Record, records
from solvers.layer.state import ring, turned_ring
from solvers.layer.two_layers import FLOWS, ROWS, STREAM, TAKEN, resting, stream_of
from solvers.rotor.system import RotorSystem
from solvers.runup.balls import NO_BALLS, Balls, ball_records, balls_energy, balls_inertia, race_planes
from solvers.runup.machine import Handover, Reading, Transfer
from solvers.runup.state import (
    CREST,
    GAINS,
    LAYER,
    MEASURES,
    PACE,
    RELEASE,
    SUMS,
    WORKS,
    CoupledRotor,
    Machine,
    Room,
    State,
    at_rest,
    layer_properties,
    mean_area,
    planes_of,
    wall_tables,
)
from solvers.slices import compiled, slices

# A layer that gravity has thrown down is caught again at a speed higher by this factor.
_AGAIN = 1.2
# Own rotation over sqrt(g/a) below which a ring is left to the two layers, and above which it is taken from
# them; Froude number of the flow past its baffles above which it is left, and below which it is taken; slip
# between stream and pool over their rotation up to which they are one layer [theory: pool].
_LEFT, _TAKEN = 1.2, 1.4
_SHOOTS, _RESTS = SUPERCRITICAL, 0.8
_ONE = 0.1
# Least and largest depth of a ring over its mean.
_THIN, _THICK = 0.3, 2.0
# Area over R^2 of a film from which on a wall counts as wet: 24 um in a drum of 0.24 m.
_FILM = 1e-4
# Grip of the walls on a pool over the expected one in the run that shows how far that is known.
_FIRM = 2.0


# Plane, relative momentum, number of the chamber and record FLOWS of liquids in two layers.
Swinging = list[tuple[Array, Array, int, np.record]]


@dataclass
class Coupled(CoupledRotor):
    """A rotor with long-wave layers at one moment, a `solvers.runup.machine.RunupMachine`."""

    layers: Record  #: properties of each chamber's layer, records LAYER, shape (l,)
    tables: Array  #: of the law of the wall, shape (l, m, 2)
    area: Array  #: of all layers, shape (l, c)
    momentum: Array
    #: A e of the fluctuations behind bores of all layers, shape (l, c), or (l, 0) without them
    rolling: Array
    active: Flags  #: which of them are layers now, shape (l,)
    streams: Record  #: records STREAM of each chamber, shape (l,)
    two_layers: Array  #: of all liquids as stream and pool, as in `State`, shape (l, 4, k)
    rings: Flags
    balls: Record  #: records BALL, shape (N,)
    machine: Machine  #: of those
    state: State
    room: Room
    #: steps written down since `followed` was asked last, rows of the state's trace
    kept: list[Array] = field(default_factory=list)

    @property
    def pooled(self) -> Flags:
        """Which liquids are pools that swing now, shape (l,)."""
        return self.swings & ~self.active

    @property
    def theta(self) -> Array:
        """Angle of the cells' middles from the drum's zero mark, rad, shape (c,)."""
        return np.asarray(np.arctan2(self.machine.angles[1], self.machine.angles[0]))

    def advance(self, stop: float, rate: float, courant: float, most: int) -> Outcome:
        """Advance to a time while the spin changes at a rate, in at most so many steps."""
        return self.pass_by(np.array([stop]), rate, courant, most)[0]

    def pass_by(self, stops: Array, rate: float, courant: float, most: int) -> tuple[Outcome, Array]:
        """`advance` to one time after another: areas of the layers at those reached, over R^2, (k, l, c)."""
        kept = (
            np.zeros((stops.size, 6 + self.state.place.size)),
            np.zeros((stops.size, 2 * self.state.area.size)),
        )
        legs = stops, np.full(stops.size, rate)
        outcome, reached = self._along(legs, kept, courant, most, lambda _: None)
        self.area[self.active], self.momentum[self.active] = self.state.area, self.state.momentum
        self.rolling[self.active] = self.state.rolling
        self.two_layers[self.pooled], self.rings[self.pooled] = self.state.two_layers, self.state.rings
        rows = kept[1][:reached].reshape(reached, 2, *self.state.area.shape)
        return outcome, rows[:, 0]

    def _along(
        self,
        legs: tuple[Array, Array],
        kept: tuple[Array, Array],
        courant: float,
        most: int,
        progress: Callable[[float], object],
    ) -> tuple[Outcome, int]:
        """Go through times at rates of the spin, shape (k,), with rows for each; how many were reached."""
        from solvers.runup.steps.spin import spin_of

        outcome, leg, resumed = Outcome.RAN_OUT, 0, False
        rows = self.state.trace.shape[0]
        try:
            for steps in slices(most, max(1, self.state.area.size), rows):
                found, leg = compiled(
                    *(
                        *self.steps,
                        *spin_of(self.machine.curve.size > 0),
                        *self.machine,
                        *self.state,
                        *self.room,
                    ),
                    *(*legs, leg, *kept, courant, steps, resumed),
                )
                outcome, resumed = Outcome(found), True
                self._collect()
                progress(leg / legs[0].size)
                if outcome is not Outcome.RAN_OUT:
                    break
        except KeyboardInterrupt:
            outcome = Outcome.INTERRUPTED
        return outcome, leg

    @property
    def settled(self) -> bool:
        """Whether each liquid stays the layer or the mass that it is, whatever the speed, beside no ball."""
        if self.balls.size:
            return False
        if self.handover is not Handover.RIDING:
            return not (self.swings | self.rests).any()
        return bool(np.isin(self.capture, (0.0, np.inf)).all())

    def through(
        self,
        stops: Array,
        rates: Array,
        courant: float,
        most: int,
        progress: Callable[[float], object],
    ) -> tuple[Outcome, dict[str, Array], Array] | None:
        """See `solvers.runup.machine.RunupMachine.through`."""
        if not self.settled:
            return None
        n, (count, cells), k = self.state.place.size, self.state.area.shape, stops.size
        moments, rings = np.zeros((k, 6 + n)), np.zeros((k, 2 * count * cells))
        outcome, reached = self._along((stops, rates), (moments, rings), courant, most, progress)
        self.area[self.active], self.momentum[self.active] = self.state.area, self.state.momentum
        self.rolling[self.active] = self.state.rolling
        area = np.zeros((reached, len(self.fills), cells))
        area[:, ~self.active] = self.area[~self.active]
        momentum = area.copy()
        both = rings[:reached].reshape(reached, 2, count, cells)
        area[:, self.active], momentum[:, self.active] = both[:, 0], both[:, 1]
        return outcome, self._readings(moments[:reached], area, momentum), self._depths(area)

    @cached_property
    def steps(self) -> tuple[Any, ...]:
        """The compiled steps and the parts of them that this machine has, handed over."""
        from solvers.layer.drag import friction_of
        from solvers.layer.finite_volume import RATES, no_rates, rates_of
        from solvers.machine_code import entry, handed
        from solvers.runup.steps.balls import balls_of
        from solvers.runup.steps.coupled import ADVANCE, advance
        from solvers.runup.steps.layer import LAYER_STEP, layer_step
        from solvers.runup.steps.pools import pools_of

        wet, cells = [fill for fill in self.fills if fill.volume > 0.0], self.area.shape[1]
        dispersion = bool(wet) and bool(self.layers.dispersion.any())
        enstrophy = bool(wet) and self.rolling.shape[1] > 0
        return (
            entry(advance, *ADVANCE),
            handed(rates_of(tables_of(wet, cells), dispersion, enstrophy) if wet else no_rates, RATES),
            friction_of(self.friction.law.number),
            handed(layer_step, LAYER_STEP),
            *pools_of(bool(self.swings.any())),
            *balls_of(self.balls.size),
        )

    def follow(self, rows: int) -> None:
        """Write every step down from here on; 0 writes none."""
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

    @property
    def velocity(self) -> Array:
        """Rates of change of the rotor's coordinates, shape (n,)."""
        return np.asarray(self.state.rate)

    def energy(self) -> float:
        """Kinetic and elastic energy of rotor and liquid, J [theory: coupling, eq. 9]."""
        x, v = self.state.place, self.state.rate
        total = 0.5 * (v @ self.machine.matrices[0] @ v + x @ self.machine.matrices[3] @ x)
        for layer, plane, measures, momentum in self.measured():
            rate = plane @ v
            total += 0.5 * layer.mass * rate @ rate + momentum @ rate
            total += layer.weight * layer.radius**4 * measures.energy
        total += self._pressed()
        for plane, momentum, j, flows in self._swinging():
            rate = plane @ v
            total += 0.5 * self.masses[j] * rate @ rate + momentum @ rate
            total += self.streams[j].inertia * flows.energy
        return float(
            total
            + balls_energy(
                self.balls, self.machine.races, v, self.state.roll, self.state.roll_rate, self.spin
            )
        )

    def works(self) -> Array:
        """Works and heats so far, J, in the order of `WORKS`; of bores with what the scheme gives back."""
        return np.array([self.sums["lost" if name == "bores" else name] for name in WORKS], dtype=float)

    def _pressed(self) -> float:
        """Energy of what full gaps hold beyond their room, J [theory: long_wave, eq. 19]."""
        more = np.maximum(self.state.area - self.machine.gaps[:, None], 0.0)
        each = math.pi * (SLOT_SPEED * self.spin) ** 2 * np.square(more).mean(axis=1)
        return float((self.machine.layers.weight * self.machine.layers.radius**4) @ each)

    def _swinging(self) -> Swinging:
        """Plane, relative momentum, number of the chamber and record FLOWS of each pool."""
        if not self.pooled.any():
            return []
        planes = planes_of(self.system, self.fills)
        found = []
        for j in np.flatnonzero(self.pooled).tolist():
            flows = self._flows(j)
            momentum = self.streams[j].weight * np.array([flows.flow_x, flows.flow_y])
            found.append((planes[j], momentum, j, flows))
        return found

    def _flows(self, j: int) -> np.record:
        """Record FLOWS of a liquid in two layers."""
        from solvers.layer.two_layer_step import measure

        flows: np.record = records(FLOWS)[0]
        work = np.zeros((ROWS, self.two_layers.shape[2]))
        full, slot = self.streams[j].full, self.streams[j].slot
        measure(self.two_layers[j], self.machine.angles, full, slot, self.spin, work, flows)
        return flows

    def _turning(self, swinging: Swinging | None = None) -> tuple[Array, Array]:
        """Angular momentum of each liquid, kg m^2/s, and its own rotation, rad/s, shape (l,) each."""
        momentum, inertia = np.zeros((2, len(self.fills)))
        if self.active.any():
            for (layer, _, measures, _), j in zip(self.measured(), np.flatnonzero(self.active), strict=True):
                momentum[j] = layer.weight * layer.radius**4 * measures.spinning
                inertia[j] = self.spread_inertia[j]
        for _, _, k, flows in self._swinging() if swinging is None else swinging:
            momentum[k] = self.streams[k].inertia * flows.spinning
            inertia[k] = self.streams[k].inertia * flows.inertia
        own = np.divide(momentum, inertia, out=np.zeros_like(momentum), where=inertia > 0.0)
        return momentum, own

    def measured(self) -> list[tuple[np.record, Array, np.record, Array]]:
        """Properties, plane, measures and relative momentum of each layer."""
        from solvers.runup.steps.layer import measure, relative_momentum

        shaft = self.shaft
        cosine, sine = math.cos(shaft.angle), math.sin(shaft.angle)
        found = []
        for j in range(self.machine.layers.size):
            layer, measures, momentum = self.machine.layers[j], records(MEASURES)[0], np.zeros(2)
            spare, angles = self.room.spare[j], self.machine.angles
            state, plates = self.state, self.machine.plates[j]
            measure(state.area[j], state.momentum[j], shaft.spin, angles, plates, spare, measures)
            relative_momentum(measures, layer, shaft.spin, cosine, sine, momentum)
            found.append((layer, self.machine.planes[j], measures, momentum))
        return found

    def mass_error(self) -> float:
        """Largest relative change of a layer's volume since the beginning."""
        errors = [0.0]
        for j, fill in enumerate(self.fills):
            held = self.area[j] if self.active[j] else self.two_layers[j, :2].sum(axis=0)
            if self.active[j] or self.pooled[j]:
                errors.append(abs(float(held.mean()) / mean_area(fill) - 1.0))
        return max(errors)

    def switch(self) -> float:
        """Catch the liquid that can be a layer by now, let go what cannot; energy brought in, J.

        Keeps the momentum of rotor and liquid and, of liquid that the drum does not take along, its angular
        momentum about the chamber's axis [theory: pool, eq. 18].
        """
        if self.handover is Handover.RIDING:
            return self._rearrange(self.ridden(self.active))
        if not (self.swings | self.rests).any():
            return 0.0
        return self._rearrange(self._wanted())

    def _wanted(self) -> Flags:
        """Which liquids are layers from now on, shape (l,) [theory: pool]."""
        own, wanted = self._turning()[1], self.active.copy()
        formed = self.spin > np.where(self.active, RELEASE * self.capture, self.centrifuging)
        wanted[self.rests] = formed[self.rests]
        for j in np.flatnonzero(self.swings).tolist():
            fill, fast = self.fills[j], own[j] / float(self.capture[j])
            past = abs(own[j] - self.spin) * math.sqrt(fill.chamber.radius / max(fill.depth, 1e-300))
            past /= max(abs(own[j]), 1e-300)
            shoots = past if fill.uneven and fill.compartments == 1 else 0.0
            if self.active[j]:
                wanted[j] = fast > _LEFT and shoots < _SHOOTS
            else:
                wanted[j] = fast > _TAKEN and shoots < _RESTS and self._is_one(j)
        return wanted

    def _is_one(self, j: int) -> bool:
        """Whether liquid stands round the whole wall, and stream and pool turn alike nearly everywhere."""
        area, spun = self.two_layers[j, :2], self.two_layers[j, 2:]
        whole = area.sum(axis=0)
        if not _THIN * whole.mean() < whole.min() <= whole.max() < _THICK * whole.mean():
            return False
        turn = np.divide(spun, area * (1.0 - whole), out=np.zeros_like(spun), where=area > 1e-6)
        shared = area.prod(axis=0) / whole
        slip = math.sqrt(float(shared @ np.square(turn[0] - turn[1])) / float(whole.sum()))
        return slip < _ONE * abs(float((area * turn).sum() / whole.sum()))

    def fall(self, outcome: Outcome) -> float | None:
        """Let the deepest layer fall to the bottom where gravity has won; energy brought in, J.

        It is caught again at a speed higher by a fifth. None where the steps failed for another reason.
        """
        thrown = outcome in (Outcome.AT_AXIS, Outcome.NOT_COUPLED)
        if not (thrown and self.machine.gravity.any() and self.active.any()):
            return None
        deepest = int(np.argmax(np.where(self.active, self.area.max(axis=1), -1.0)))
        wanted = self.active.copy()
        wanted[deepest] = False
        own = self.spin if self.handover is Handover.RIDING else max(float(self._turning()[1][deepest]), 0.0)
        self.capture[deepest] = _AGAIN * max(own, float(self.lowest[deepest]))
        return self._rearrange(wanted, broken=True)

    def _rearrange(self, wanted: Flags, broken: bool = False) -> float:
        """Make the wanted layers the active ones; energy brought in, J.

        `broken`: what leaves has no state to go on from, and keeps its mean depth and rotation.
        """
        if np.array_equal(wanted, self.active):
            return 0.0
        before, lost = self.energy(), np.zeros(self.state.rate.size)
        anew, (spread, own) = wanted != self.active, self._turning()
        offset = self._offsets()
        for (_, plane, _, momentum), gone in zip(self.measured(), anew[self.active], strict=True):
            lost += plane.T @ momentum * gone
        for plane, momentum, j, _ in self._swinging():
            lost += plane.T @ momentum * anew[j]
        for j in np.flatnonzero(anew).tolist():
            if not self.swings[j]:
                self.area[j], self.rolling[j] = self.area[j].mean(), 0.0
                self.momentum[j] = -self.spin * np.square(self.area[j])
            elif wanted[j]:
                self._join(j)
            else:
                self._part(j, own[j] if broken else None)
        self.active = wanted
        self._assemble()
        for (_, plane, _, momentum), come in zip(self.measured(), anew[self.active], strict=True):
            lost -= plane.T @ momentum * come
        for plane, momentum, j, _ in self._swinging():
            lost -= plane.T @ momentum * anew[j]
        whole = self.machine.matrices[0].copy()
        weights = np.concatenate((self.masses[self.active], self.masses[self.pooled]))
        for mass, plane in zip(weights, self.machine.planes, strict=True):
            whole += mass * plane.T @ plane
        inertia, along = balls_inertia(self.balls, self.machine.races, self.state.roll)
        jump = np.linalg.solve(whole + inertia, lost)
        self.state.rate[:] += jump
        self.state.roll_rate[:] -= along @ jump
        after, now, low = self.energy(), self._turning()[0], abs(float(self.gravity[0]))
        rise = (self._offsets() - offset).real * low * self.masses
        for j in np.flatnonzero(anew).tolist():
            turning = float(spread[j]), float(now[j])
            there = bool(wanted[j])
            self.transfers.append(
                Transfer(j, there, self.time, self.spin, turning, (before, after), float(rise[j]))
            )
        return after - before

    def _join(self, j: int) -> None:
        """Make stream and pool one layer in the drum's frame, cell by cell."""
        whole = self.two_layers[j].reshape(2, 2, -1).sum(axis=1)
        area, spun = turned_ring(whole, -float(self.shaft.angle))
        # The layer's momentum is the absolute one less Omega R^2 A.
        self.area[j], self.momentum[j], self.rolling[j] = area, spun - self.spin * area, 0.0

    def _part(self, j: int, rotation: float | None) -> None:
        """Take a layer over as a ring of one layer in the frame that stands still, cell by cell."""
        count, area = self.two_layers.shape[2], self.area[j]
        if rotation is None:
            both = np.stack([area, self.momentum[j] + self.spin * area])
            area, spun = turned_ring(both, float(self.shaft.angle))
        else:
            area = np.full(count, area.mean())
            spun = rotation * area * (1.0 - area)
        self.two_layers[j] = 0.0
        self.two_layers[j, 1], self.two_layers[j, 3], self.rings[j] = area, spun, True

    def _assemble(self) -> None:
        """Make machine, state and scratch anew for the present layers and pools; other liquid is a mass."""
        old, active, pooled = self.state, self.active, self.pooled
        planes, mass = planes_of(self.system, self.fills), self.system.mass.copy()
        if self.lost_mass is not None:
            mass -= self.lost_mass
        for weight, plane, moving in zip(self.layers.mass, planes, active | pooled, strict=True):
            if not moving:
                mass += weight * plane.T @ plane
        matrices = [mass, self.system.damping, self.system.gyroscopic, self.system.stiffness]
        riding = [fill for fill, on in zip(self.fills, active, strict=True) if on]
        self.machine = self.machine._replace(
            matrices=np.stack(matrices).astype(float),
            planes=np.concatenate((planes[active], planes[pooled])),
            masses=np.concatenate((self.layers.mass[active], self.streams.mass[pooled])),
            layers=self.layers[active],
            pools=self.streams[pooled],
            pool_tables=self.tables[pooled],
            tables=self.tables[active],
            plates=tables_of(riding, self.area.shape[1]),
            gaps=np.array([full_area(fill) for fill in riding]),
        )
        count, cells = int(active.sum()), self.area.shape[1]
        self.state = old._replace(
            area=self.area[active],
            momentum=self.momentum[active],
            rolling=self.rolling[active],
            two_layers=self.two_layers[pooled],
            rings=self.rings[pooled],
            push=np.zeros((count + int(pooled.sum()), 3, 2)),
            pace=_fresh_pace(),
        )
        self.follow(old.trace.shape[0])
        sizes = count, int(pooled.sum()), self.balls.size
        self.room = _room(old.place.size, sizes, cells, self.rolling.shape[1])

    def _offsets(self, swinging: Swinging | None = None) -> Complex:
        """Centre of mass of each liquid from its chamber's axis, standing frame, complex, m, shape (l,)."""
        found = self._ring_offsets(self.area, np.array(float(self.shaft.angle)))
        for _, _, j, flows in self._swinging() if swinging is None else swinging:
            found[j] = self.streams[j].weight * complex(flows.moment_x, flows.moment_y) / self.masses[j]
        return found

    def _ring_offsets(self, area: Array, angle: Array) -> Complex:
        """The same of layers of these areas, shape (..., l, c), at these angles, shape (...)."""
        angles = self.machine.angles
        surface = np.sqrt(np.maximum(1.0 - 2.0 * area, 0.0))
        lever = (1.0 - surface) * (1.0 + surface + np.square(surface)) / 3.0
        whole = np.maximum(area.sum(axis=-1), 1e-300)
        turn = (np.cos(angle) + 1j * np.sin(angle))[..., None]
        moved = self.layers.radius * (lever @ angles[0] + 1j * (lever @ angles[1])) / whole * turn
        return np.asarray(np.where(self.active, moved, self.pool_offset))

    def read(self) -> Reading:
        """The moment as the history keeps it."""
        shaft, crest = self.shaft, self.crest
        moment = (*(shaft.time, shaft.spin, shaft.angle, crest.amplitude, crest.speed, crest.time),)
        found = self._readings(np.array([[*moment, *self.state.place]]), self.area[None], self.momentum[None])
        read: dict[str, Any] = {name: values[0] for name, values in found.items()}
        swinging = self._swinging()
        if swinging:
            slow = self.pooled * (self._turning(swinging)[1] - self.spin)
            read["mean_rotation"] = np.where(self.active, read["mean_rotation"], slow)
            read["offset"] = self._offsets(swinging)
            for j in np.flatnonzero(self.pooled).tolist():
                area, up = self.two_layers[j, :2].sum(axis=0), self.machine.angles[0]
                read["wet_share"][j] = np.mean(area > _FILM)
                read["lifted_share"][j] = area[up > 0.0].sum() / max(float(area.sum()), 1e-300)
        return Reading(
            **read,
            captured=self.active.copy(),
            ball_angle=self.state.roll - float(shaft.angle),
            ball_speed=self.state.roll_rate.copy(),
        )

    def _readings(self, moments: Array, area: Array, momentum: Array) -> dict[str, Any]:
        """Fields of readings, of k moments as the steps wrote them and of areas and momenta, (k, l, c)."""
        time, spin, angle, largest, largest_speed, largest_time = moments[:, :6].T
        coordinates, angles, on = moments[:, 6:], self.machine.angles, self.active
        parts = np.einsum("lin,kn->kli", self.seen, coordinates)
        deflection = parts[:, :, 0] + 1j * parts[:, :, 1]
        # As the steps take it: numpy's modulus of many numbers at once may differ in the last digit.
        amplitude = np.hypot(deflection[:, 0].real, deflection[:, 0].imag)
        later = amplitude >= largest
        surface = np.sqrt(np.maximum(1.0 - 2.0 * area, 0.0))
        whole, radius = np.maximum(area.sum(axis=2), 1e-300), self.layers.radius
        velocity = np.divide(momentum, area, out=np.zeros_like(surface), where=area > 0.0)
        velocity += spin[:, None, None] * area
        flow = (velocity * -np.log(np.maximum(surface, 1e-300))).sum(axis=2) / whole
        up = np.cos(angle)[:, None] * angles[0] - np.sin(angle)[:, None] * angles[1] > 0.0
        lifted = np.einsum("klc,kc->kl", area, up) / whole
        return {
            "time": time,
            "speed": spin,
            "angle": angle,
            "coordinates": coordinates,
            "deflection": deflection,
            "largest": np.where(later, amplitude, largest),
            "largest_speed": np.where(later, spin, largest_speed),
            "largest_time": np.where(later, time, largest_time),
            "offset": self._ring_offsets(area, angle),
            "depth_min": np.where(on, radius * (1.0 - surface.max(axis=2, initial=0.0)), np.nan),
            "depth_max": np.where(on, radius * (1.0 - surface.min(axis=2, initial=1.0)), np.nan),
            "mean_rotation": np.where(on, flow, 0.0),
            "wet_share": np.where(on, (area > _FILM).mean(axis=2), self.resting_wet),
            "lifted_share": np.where(on, lifted, 0.0),
        }

    def depth(self) -> Array:
        """Depth of the layers cell by cell, m, nan where the liquid is none, shape (l, c)."""
        return self._depths(self.area)

    def _depths(self, area: Array) -> Array:
        """The same of layers of these areas, shape (..., l, c)."""
        surface = np.sqrt(np.maximum(1.0 - 2.0 * area, 0.0))
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
    handover: Handover = Handover.RIDING,
    balls: Balls = NO_BALLS,
    position: float = 0.0,
) -> Coupled:
    """Rotor without deflection, liquid at rest in the drum, balls where they start, by long waves.

    `enstrophy`: bores carry fluctuations behind them [theory: long_wave, eq. 15-17]; `position` of the plane
    whose amplitude counts where there is no chamber, m.
    """
    tables_of(fills, cells)  # refuses compartments that the cells do not resolve
    rest, sums, crest = at_rest(system, fills, spin, gravity, position), records(SUMS), records(CREST)
    n, count = len(system.coordinates), len(fills)
    layers = records(LAYER, count)
    for j, fill in enumerate(fills):
        layers[j] = layer_properties(fill, friction, dispersion)
    tables = wall_tables(fills, friction)
    streams = records(STREAM, count)
    grip = _FIRM if handover is Handover.DRUM else 1.0
    for j, fill in enumerate(fills):
        streams[j] = stream_of(fill, friction, gravity, float(layers[j].top), grip)
    area = np.repeat(np.array([mean_area(fill) for fill in fills]).reshape(-1, 1), cells, axis=1)
    found = Coupled(
        system=system,
        fills=tuple(fills),
        layers=layers,
        friction=friction,
        handover=handover,
        tables=tables,
        capture=rest.capture,
        pools=rest.pools,
        shaft=rest.shaft[0],
        sums=sums[0],
        crest=crest[0],
        area=area,
        momentum=-spin * np.square(area),
        rolling=np.zeros((count, cells if enstrophy else 0)),
        active=np.zeros(count, dtype=bool),
        streams=streams,
        two_layers=np.zeros((count, 4, cells)),
        rings=np.zeros(count, dtype=bool),
        balls=ball_records(balls),
        machine=Machine(
            matrices=np.zeros((4, n, n)),
            unbalance=system.unbalance.astype(complex),
            planes=np.zeros((0, 2, n)),
            masses=np.zeros(0),
            layers=layers[:0],
            pools=streams[:0],
            pool_tables=tables[:0],
            tables=tables[:0],
            gravity=rest.gravity,
            angles=ring(cells),
            curve=np.zeros((2, 0)),
            watched=rest.watched,
            plates=tables_of([], cells),
            gaps=np.zeros(0),
            balls=ball_records(balls),
            races=race_planes(system, balls),
        ),
        state=State(
            place=np.zeros(n),
            rate=np.zeros(n),
            shaft=rest.shaft,
            area=area[:0],
            momentum=area[:0],
            rolling=area[:0, :0],
            two_layers=np.zeros((0, 4, cells)),
            rings=np.zeros(0, dtype=bool),
            push=np.zeros((0, 3, 2)),
            pace=_fresh_pace(),
            sums=sums,
            crest=crest,
            trace=np.zeros((0, 2 + n)),
            roll=np.array(balls.places, dtype=float),
            roll_rate=spin * np.array(balls.shares, dtype=float),
        ),
        room=_room(n, (0, 0, len(balls.places)), cells, 0),
    )
    found.position = position
    found.active = found.begins_as_layer(spin)
    for j in np.flatnonzero(found.pooled).tolist():
        found.two_layers[j] = _at_bottom(streams[j], mean_area(fills[j]), gravity, cells)
    found._assemble()
    return found


def _at_bottom(stream: np.record, mean: float, gravity: float, cells: int) -> Array:
    """Liquid at rest at the bottom in two layers, shape (4, c)."""
    pull = -gravity / stream.radius * ring(cells)[0]
    whole = resting(mean, pull, stream.full, stream.slot, stream.rim)
    below = np.minimum(whole, stream.tip)
    return np.stack([below, whole - below, np.zeros(cells), np.zeros(cells)])


def _fresh_pace() -> Record:
    """Pace of a machine that has made no step yet."""
    pace = records(PACE)
    pace[0].share = 1.0
    return pace


def _room(coordinates: int, sizes: tuple[int, int, int], cells: int, rolling: int) -> Room:
    """Scratch for a machine of `sizes` layers, pools and balls; `rolling`: cells with fluctuations."""
    from solvers.runup.steps.layer import layer_scratch

    n, (count, pools, balls) = coordinates, sizes
    both = count + pools
    return Room(
        area=np.zeros((count, cells)),
        momentum=np.zeros((count, cells)),
        rolling=np.zeros((count, rolling)),
        two_layers=np.zeros((pools, 4, cells)),
        taken=records(TAKEN, pools),
        first=records(FLOWS, pools),
        last=records(FLOWS, pools),
        work=np.zeros((pools, ROWS, cells)),
        begin=records(MEASURES, count),
        end=records(MEASURES, count),
        gains=records(GAINS, count),
        inertia=np.zeros((both, 3)),
        before=np.zeros((both, 2)),
        after=np.zeros((both, 2)),
        guess=np.zeros((both, 2)),
        found=np.zeros((both, 2)),
        miss=np.zeros((both, 2)),
        change=np.zeros(n),
        swing=np.zeros(n),
        left=np.zeros((n + balls, n + balls)),
        right=np.zeros(n + balls),
        roll=np.zeros(balls),
        held=np.zeros(balls),
        spins=np.zeros(2),
        turn=np.zeros(4),
        force=np.zeros(4),
        spare=layer_scratch(count, cells),
    )
