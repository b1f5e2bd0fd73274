"""The main job: a scene in, the response of the machine out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.whirl import plane_layer, slower_slip
from leblanc.core.answer import Later, later
from leblanc.core.notes import Note
from leblanc.core.progress import update
from leblanc.liquid.choice import HELD_MODELS, Choice, model_spans
from leblanc.liquid.choose import (
    Prepared,
    by_elements,
    carried_from,
    choose_all,
    costed,
    held_at,
    held_cost,
    liquid_models,
    may_hold,
    prepare,
)
from leblanc.liquid.filled import FilledChamber
from leblanc.liquid.models import element_model, synchronous_model
from leblanc.liquid.notes import compartment_notes, slowed_by, smeared_baffles
from leblanc.liquid.validity import doubts
from leblanc.scene.inputs import input_rows
from leblanc.scene.scene import Scene, TubRotor
from leblanc.scene.unbalances import left_in_the_end, sheds_of
from leblanc.studies.closed_forms.study import closed_forms
from leblanc.studies.cycles.study import large_whirl
from leblanc.studies.held.answer import Held
from leblanc.studies.held.holding import HERE, Began, Holding
from leblanc.studies.loads.answer import MachineLoads
from leblanc.studies.loads.study import loaded_machine, loads_over_speed, with_bearing_life
from leblanc.studies.peaks import responses_between
from leblanc.studies.run import notes as notes
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.motion import Motion, RestMode, SelfExcited
from leblanc.studies.volume.answer import WallVolumes
from leblanc.studies.volume.study import volumes_over_speed
from meshes.arrays import Array, Complex
from meshes.chamber_section import liquid_of
from meshes.errors import InputError
from solvers.held.state import COUPLED, HeldState
from solvers.liquid_model import THIN_LAYERS
from solvers.rotor.balance_quality import balance_quality, tolerance_planes
from solvers.rotor.campbell import campbell
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.loads.machine import LoadedMachine
from solvers.rotor.system import RotorSystem
from solvers.rotor.tub import Tub
from solvers.rotor.two_plane import TwoPlane
from solvers.rotor.vibration import (
    critical_speeds,
    modes,
    orbit,
    whirl_direction,
)
from solvers.statics.hydrostatics import wall_volumes
from solvers.synchronous.response import (
    Response,
    answered_by,
    by_speed,
    critical_speed,
    distance,
    main_critical_speeds,
    response,
    wet_critical_speeds,
)
from solvers.whirl.edges import bands_not_known, unstable_bands
from solvers.whirl.growth import asynchronous_growth
from solvers.whirl.laminar import Met

_DIAGRAM = 121  # speeds of a Campbell diagram

# What each coordinate of the rotors means, in words.
# What a rotor does in each coordinate; a tub, whose drum turns about y, by its axis: z is upwards where the
# axis lies, y where it stands.
_MOTIONS = {"x": "sway along x", "y": "sway along y", "alpha": "rocking about x", "beta": "rocking about y"}
_OF_TUB = {
    "horizontal": {
        "x": "sway across",
        "y": "surge along the drum",
        "z": "bounce",
        "beta": "rolling about the drum",
        "gamma": "yawing about the vertical",
    },
    "vertical": {
        "y": "bounce",
        "z": "sway along z",
        "beta": "turning about the drum",
        "gamma": "rocking about z",
    },
}
_NAMED = 0.2  # of a mode's kinetic energy, from which a coordinate names it


def self_excited(machine: Prepared) -> SelfExcited:
    """Growth of small whirls of a machine at its speeds [theory: whirl, eq. 7]."""
    scene, speed = machine.scene, machine.speed
    met = Met()
    growth, whirl_speed = asynchronous_growth(machine.rotor, scene.fills, speed, machine.waves, met)
    bands: tuple[tuple[float, float], ...] = ()
    if speed[-1] > speed[0]:
        filled, known = [scene.fills], growth[None]
        bands = unstable_bands(machine.rotor, filled, speed, machine.waves, known, [met])[0]
    elif growth[0] > 0.0:
        bands = ((float(speed[0]), float(speed[0])),)
    return SelfExcited(growth, whirl_speed, bands, machine.drag, bands_not_known(speed, growth))


def motion_response(machine: Prepared, choice: Choice) -> tuple[Response, Motion, tuple[float, float]]:
    """Response of a rotor that is not planar, its motion, and the excited critical speeds, rad/s.

    The last two are those without and with liquid.
    """
    scene, system, gravity = machine.scene, machine.system, machine.axial_gravity
    found = response(machine.rotor, scene.fills, machine.speed, gravity, liquid_models(choice))
    dry, dry_shape = critical_speeds(system)
    wet, wet_shape = wet_critical_speeds(system, scene.fills, gravity, synchronous_model(choice.model))
    main = main_critical_speeds(system, scene.fills, (dry, dry_shape), (wet, wet_shape))
    motion = Motion(
        position=found.position,
        backward=found.backward,
        backward_dry=found.backward_dry,
        branch_backward=found.branch_backward,
        chamber_forward=_at_chambers(system, scene.fills, found),
        modes=rest_modes(system, scene.rotor.axis),
        campbell=later(campbell, system, np.linspace(0.0, scene.speeds.stop, _DIAGRAM)),
        critical_speeds_dry=_directed(system, dry, dry_shape),
        critical_speeds_wet=_directed(system, wet, wet_shape),
        zero="unbalance" if isinstance(scene.rotor, TubRotor) else "angle 0 of the unbalances",
    )
    return found, motion, main


def element_answers(
    machine: Prepared, choice: Choice, answer: Response, refined: Response
) -> tuple[Choice, Response, Response]:
    """The same answers with the free surface integrated over finite elements.

    Their error is the distance from the exact equilibrium that they began with.
    """
    found = [
        answered_by(machine.rotor, machine.scene.fills, known, element_model(), machine.axial_gravity)
        for known in (answer, refined)
    ]
    error = choice.gravity.amplitude + distance(found[0], answer)
    return replace(choice, models=found[0].model, error=error), found[0], found[1]


def _at_chambers(system: RotorSystem, fills: tuple[Fill, ...], found: Response) -> Complex:
    """Forward part at every chamber, those without liquid as well, shape (s, c)."""
    places = [orbit(system, found.coordinates, fill.chamber.plane).forward for fill in fills]
    return np.stack(places, axis=1) if places else np.zeros((found.residual.size, 0), dtype=complex)


def rest_modes(system: RotorSystem, axis: str) -> tuple[RestMode, ...]:
    """Modes at rest by rising frequency, named by the coordinates that share their kinetic energy."""
    found = modes(system)
    shape = found.shape[0]
    energy = (shape.conj() * (system.mass @ shape)).real
    share = energy / energy.sum(axis=0)
    motions = _MOTIONS | (_OF_TUB[axis] if "z" in system.coordinates else {})
    names = [motions.get(name, name) for name in system.coordinates]
    return tuple(
        RestMode(float(frequency), float(ratio), _named(names, part))
        for frequency, ratio, part in zip(found.frequency[0], found.damping_ratio[0], share.T, strict=True)
    )


def _named(names: Sequence[str], share: Array) -> str:
    """Motions that have most of a mode's energy with their shares; one alone without."""
    order = np.argsort(-share, kind="stable")
    told = [k for k in order.tolist() if k == order[0] or share[k] >= _NAMED]
    if share[order[0]] >= 1.0 - _NAMED:
        return names[int(order[0])]
    return ", ".join(f"{names[k]} {100.0 * share[k]:.0f} %" for k in told)


def _directed(
    system: RotorSystem, speed: NDArray[np.float64], shape: Complex
) -> tuple[tuple[float, float], ...]:
    sense = whirl_direction(system, shape)
    return tuple((float(critical), float(way)) for critical, way in zip(speed, sense, strict=True))


def run_scene(scene: Scene, holding: Holding = HERE, cycles: bool = False) -> RunAnswer:
    """Response to the unbalance and the liquid's centre of mass at each speed of a scene."""
    scene = scene.as_read()
    if holding.solver != COUPLED and not may_hold(scene):
        raise InputError(
            "solver", holding.solver, "left out: the scene has no motion integrated in time ([model] held)"
        )
    machine = prepare(scene)
    update(what="choosing the liquid model")
    (choice,) = choose_all([machine])
    update(what="response to the unbalance")
    motion: Motion | None = None
    if isinstance(machine.rotor, Jeffcott):
        gravity, rotor = machine.axial_gravity, machine.rotor
        answer = response(rotor, scene.fills, machine.speed, gravity, liquid_models(choice))
        dry = rotor.natural_frequency
        wet = later(critical_speed, rotor, scene.fills, gravity, synchronous_model(choice.model))
    else:
        answer, motion, (dry, wet) = motion_response(machine, choice)
    update(what="peaks between the speeds")
    in_range_too = replace(answer, in_range=answer.in_range & choice.in_range)
    (refined,) = responses_between([machine], [in_range_too], drawn=True)
    if by_elements(scene):
        update(what=f"response{slowed_by(scene.fills)}")
        choice, answer, refined = element_answers(machine, choice, answer, refined)
    update(what=f"self-excited whirl{slowed_by(scene.fills)}")
    whirl = self_excited(machine)
    grown: tuple[Note, ...] = ()
    if cycles:
        update(what="limit cycles")
        large, grown = large_whirl(machine, whirl.growth)
        whirl = replace(whirl, large=large)
    choice = costed(machine, choice, whirl.growth)
    at, held, stable = held_at(scene, choice, whirl.growth), None, whirl.leaves_stable(answer.stable)
    states: dict[float, HeldState] = {}
    if at.any():
        from leblanc.studies.held.held import hold_answer

        began = Began(answer, refined, whirl.growth, at)
        choice, answer, refined, held, states = hold_answer(machine, choice, began, holding)
        stable = np.where(at, answer.stable, stable)
        if motion is not None:
            forward = _at_chambers(machine.system, scene.fills, answer)
            motion = replace(
                motion, backward=answer.backward, branch_backward=answer.branch_backward,
                chamber_forward=forward,
            )  # fmt: skip
    answer = replace(answer, in_range=answer.in_range & choice.in_range, stable=stable)
    # Next to a speed at which it is not known whether a whirl grows, it is not known either.
    calm = np.interp(refined.speed, machine.speed, np.isnan(whirl.growth)) == 0.0
    steady = refined.stable & calm & ~whirl.inside(refined.speed)
    refined = replace(
        refined, stable=np.where(np.isin(refined.model, list(HELD_MODELS)), refined.stable, steady)
    )
    if motion is not None:
        motion = replace(motion, refined_forward=_at_chambers(machine.system, scene.fills, refined))
    moved = _moved(machine, answer, motion)
    # What nothing else of the answer depends on is worked out when it is read.
    loads = later(loads_of, loaded_machine(scene), scene, answer, refined, states)
    volumes = later(volumes_over_speed, scene.fills, answer.speed, moved, machine.axial_gravity)
    said = machine, choice, answer, refined, motion, whirl, held
    return RunAnswer(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        inputs=later(input_rows, scene),
        digest=scene.digest,
        response=answer,
        liquid_mass=sum(fill.mass for fill in scene.fills),
        notes=later(_every_note, said, grown, loads, moved, volumes),
        axis=scene.rotor.axis,
        chambers=tuple(_chamber(fill, motion) for fill in scene.fills),
        capture_speed=choice.captured_from,
        carried_from=later(carried_from, scene),
        closed_forms=later(closed_forms, machine, answer),
        critical_speed_dry=dry,
        critical_speed_wet=wet,
        motion=None if motion is None else later(_with_diagram, motion),
        whirl=whirl,
        error_estimate=choice.error,
        models=model_spans(choice, machine.speed) if scene.fills else (),
        tolerance=choice.tolerance,
        refined=refined,
        axial_gravity=machine.axial_gravity,
        held=held,
        loads=loads,
        wall_volumes=volumes,
        balance_quality=later(_balance, machine, answer.speed, answer.coordinates),
        balance_quality_dry=later(_balance, machine, answer.speed),
    )


def _with_diagram(motion: Any) -> Motion:
    """A motion with its Campbell diagram, which few read."""
    found: Motion = replace(motion, campbell=motion.campbell())
    return found


_Said = tuple[Prepared, Choice, Response, Response, Motion | None, SelfExcited, Held | None]


def _every_note(
    said: _Said, grown: tuple[Note, ...], loads: Later, moved: Array, volumes: Later
) -> tuple[Note, ...]:
    """Limits of validity and findings, those of large whirls and of loads among them."""
    machine, answer = said[0], said[2]
    walls = _walls(machine, answer, moved, volumes())
    found = (*_notes(said, walls), *grown)
    if loads() is None:
        return found
    obstructed = any(fill.uneven and fill.volume > 0.0 for fill in machine.scene.fills)
    return (*found, notes.loads(obstructed), *_skidding(loads(), answer))


def loads_of(
    machine: LoadedMachine | None,
    scene: Scene,
    answer: Response,
    refined: Response,
    held: Mapping[float, HeldState] = MappingProxyType({}),
) -> MachineLoads | None:
    """Forces and clearances at the speeds of the scene and between them; None where it asks for none."""
    if machine is None:
        return None
    every = by_speed([answer, refined])
    order = np.argsort(np.concatenate((answer.speed, refined.speed)), kind="stable")
    asked = np.argsort(order, kind="stable")[: answer.speed.size]
    friction = scene.model.friction
    found = loads_over_speed(
        machine, friction, every.speed, every.coordinates, asked, held, counts=every.holds
    )
    return with_bearing_life(scene, machine, found)


def _skidding(loads: MachineLoads, answer: Response) -> list[Note]:
    """Bearings with too little load to roll at the last speed."""
    life, speed = loads.bearing_life, float(answer.speed[-1])
    if life is None:
        return []
    found = (notes.skids(name, speed, life, k) for k, name in enumerate(loads.bearings))
    return [note for note in found if note is not None]


def _balance(machine: Prepared, *motion: Any) -> Array | None:
    """Balance quality of a motion, or without liquid; None where no mass spins or its planes are unknown."""
    if not isinstance(machine.rotor, Jeffcott | TwoPlane | Tub) or not tolerance_planes(machine.rotor):
        return None
    return balance_quality(machine.rotor, *motion)


def _chamber(fill: Fill, motion: Motion | None) -> FilledChamber:
    """A chamber as figures show it; its place along the axis counts where the rotor tilts."""
    chamber = fill.chamber
    return FilledChamber(
        chamber.radius,
        chamber.inner_radius,
        chamber.height,
        fill.volume,
        fill.liquid.name,
        fill.surface_radius,
        0.0 if motion is None else chamber.plane,
        chamber.baffles,
        chamber.section,
    )


def _notes(said: _Said, walls: list[Note]) -> tuple[Note, ...]:
    """Limits of validity and findings."""
    machine, choice, answer, refined, motion, whirl, held = said
    cost = held_cost(machine, choice, whirl.growth)
    found = [notes.tolerance_missed(choice, machine.speed, cost)]
    if machine.scene.fills:
        found.insert(0, notes.liquid_models(choice))
    if any(sheds is not None for sheds in sheds_of(machine.scene.rotor)):
        found.append(notes.unbalance_leaves(left_in_the_end(machine.scene.rotor)))
    if choice.captured_from is not None:
        found.append(notes.not_carried(choice.captured_from, carried_from(machine.scene)))
    found.append(notes.left_out(by_speed([answer, refined]), choice.captured_from))
    found.append(notes.one_family(answer))
    if held is not None:
        found += [*notes.held_motions(held, answer.speed), *smeared_baffles(machine.scene.fills, held.cells)]
    chambers = bool(machine.scene.fills)
    if motion is None:
        found.append(notes.slow_disturbances(held) if chambers else None)
    else:
        found.append(notes.plane(motion.position, motion.zero, chambers, held is not None))
        found.append(_against_spin(answer, motion, held) if chambers else None)
    found += [notes.self_excited(whirl), _thick_layers(machine)]
    found.append(None if whirl.large is None else notes.large_whirl(whirl.large, answer.speed))
    several = np.count_nonzero(np.isfinite(answer.branch_deflection), axis=1) > 1
    if several.any():
        first, last = answer.speed[several][[0, -1]].tolist()
        found.append(notes.several_answers(first, last, stable=motion is None))
    found.append(_endless(by_speed([answer, refined])))
    found += [*compartment_notes(machine.scene.fills), *walls]
    found += [*_meshes(machine.scene), *doubts(machine.scene)]
    return tuple(note for note in found if note is not None)


def _endless(answer: Response) -> Note | None:
    """Where the amplitude has no bound, with and without liquid; None where it has one everywhere."""
    # A motion held in time that ran away says nothing of the resonance.
    lost = np.isin(answer.model, list(HELD_MODELS)) & ~answer.converged
    endless = [np.isinf(answer.amplitude) & ~lost, np.isinf(answer.amplitude_dry)]
    wet, dry = (float(answer.speed[at][0]) if at.any() else None for at in endless)
    return None if wet is None and dry is None else notes.unbounded(wet, dry)


def _against_spin(answer: Response, motion: Motion, held: Held | None) -> Note | None:
    """How far the orbit is from a circle; None where it is one."""
    size, against = np.abs(answer.deflection), np.abs(motion.backward)
    known = np.isfinite(size) & (size + against > 0.0)
    if not known.any():
        return None
    share = against[known] / (size + against)[known]
    worst = int(np.argmax(share))
    if share[worst] <= 1e-6:
        return None
    return notes.against_spin(float(share[worst]), float(answer.speed[known][worst]), held)


def _thick_layers(machine: Prepared) -> Note | None:
    """Where laminar layers of the slower waves are not as thin as friction of small whirls takes them."""
    if machine.waves is not machine.friction:
        return None
    layers = [(fill, plane_layer(fill, machine.friction)) for fill in machine.scene.fills]
    # delta = sqrt(2 nu/|s|) at the slower wave, whose frequency goes with the spin: thick below one speed.
    limit, least = THIN_LAYERS[1], 0.0
    for fill, layer in layers:
        if layer is not None and layer.stokes > 0.0:
            slip = 2.0 * fill.liquid.viscosity / (limit * fill.depth) ** 2
            least = max(least, slip / slower_slip(layer.layer_tanh))
    if least <= machine.speed[0]:
        return None
    return notes.thick_wall_layer(least, limit, whole=least > float(machine.speed[-1]))


def _moved(machine: Prepared, answer: Response, motion: Motion | None) -> Array:
    """Deflection at each chamber, m, shape (c, s)."""
    if motion is not None:
        return np.abs(motion.chamber_forward.T)
    return np.tile(np.abs(answer.deflection), (len(machine.scene.fills), 1))


def _walls(machine: Prepared, answer: Response, moved: Array, volumes: WallVolumes) -> list[Note]:
    """How wet each wall is at the last speed, and what more liquid does there."""
    speed = float(answer.speed[-1])
    return [
        notes.wall(
            *(k, speed, fill.volume, float(e)),
            wall_volumes(fill.chamber, e, speed, machine.axial_gravity),
        )
        for k, (fill, e) in enumerate(zip(machine.scene.fills, moved[:, -1], strict=True))
        if np.isfinite(volumes.wetting_volume[k, -1])
    ]


def _meshes(scene: Scene) -> list[Note]:
    """Faults of the meshes of chambers with a section of their own."""
    found: list[Note] = []
    for k, fill in enumerate(scene.fills):
        if fill.chamber.section is None or not fill.uneven:
            continue
        from meshes.findings import mesh_findings, wave_findings

        liquid = liquid_of(fill.chamber.section, fill.surface_radius)
        findings = (*mesh_findings(fill.chamber.section.mesh), *wave_findings(liquid, 1))
        found += [notes.mesh(k, str(finding)) for finding in findings]
    return found
