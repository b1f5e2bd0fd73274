"""The main job: a scene in, the response of the machine out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fluid.fill import Fill
from meshes.chamber_section import liquid_of
from solvers.hydrostatics import optimal_volume
from solvers.mixed_response import mixed_response
from solvers.response import Response, critical_speed
from study.fidelity import Choice, axial_gravity, choose
from study.fidelity_words import fidelity_notes
from study.inputs import ML, input_rows
from study.machine import jeffcott as jeffcott
from study.record import MM, RPM, ChamberRecord, Motion, SelfExcited, StudyRecord
from study.run_motion import motion_response
from study.scene import Rotor, Scene
from study.self_excited import describe_whirl, self_excited, stable_with


def run_scene(scene: Scene) -> StudyRecord:
    """Response to the unbalance and the liquid's centre of mass at each speed of a scene.

    Parameters
    ----------
    scene : the machine

    Returns
    -------
    StudyRecord with the response, what was assumed and where the models hold

    Raises
    ------
    InputError : the scene asks for a liquid model that does not answer this, or its rotor is an exciter

    Examples
    --------
    >>> from study.scene import load_scene
    >>> record = run_scene(load_scene("examples/horizontal_rig.toml"))
    >>> record.response.speed.size
    201
    """
    choice = choose(scene)
    motion: Motion | None = None
    if isinstance(scene.rotor, Rotor):
        gravity, rotor = axial_gravity(scene), jeffcott(scene)
        answer = mixed_response(rotor, scene.chambers, scene.speed_array(), gravity, choice.models)
        dry, wet = rotor.natural_frequency, critical_speed(rotor, scene.chambers, gravity, choice.model)
    else:
        coupled, motion, (dry, wet) = motion_response(scene, choice)
        answer = coupled.response
    whirl = self_excited(scene)
    answer = replace(
        answer, in_range=answer.in_range & choice.in_range, stable=stable_with(whirl, answer.stable)
    )
    return StudyRecord(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        inputs=input_rows(scene),
        digest=scene.digest,
        response=answer,
        liquid_mass=sum(fill.mass for fill in scene.chambers),
        notes=_notes(scene, choice, answer, motion, whirl),
        axis=scene.rotor.axis,
        chambers=tuple(_chamber(fill, motion) for fill in scene.chambers),
        capture_speed=choice.captured_from,
        critical_speed_dry=dry,
        critical_speed_wet=wet,
        motion=motion,
        whirl=whirl,
        error_estimate=choice.error,
    )


def _chamber(fill: Fill, motion: Motion | None) -> ChamberRecord:
    chamber = fill.chamber
    return ChamberRecord(
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


def _notes(
    scene: Scene, choice: Choice, answer: Response, motion: Motion | None, whirl: SelfExcited
) -> tuple[str, ...]:
    """Limits of validity and findings, in words."""
    notes: list[str] = list(fidelity_notes(choice, answer.speed))
    if choice.captured_from is not None:
        notes.append(
            f"Below {choice.captured_from * RPM:.3g} rpm gravity across the axis is stronger than the "
            "centrifugal acceleration at a free surface: the liquid does not ride with the drum there, and "
            "the results are marked out of range. Above it gravity's pull on the liquid turns backwards in "
            "the drum and adds nothing to the synchronous response in linear theory."
        )
    if motion is not None:
        notes += _motion_notes(scene, motion, answer)
    else:
        notes.append(
            "Branches are judged against slow disturbances, the liquid being in equilibrium at every moment."
        )
    notes.append(describe_whirl(whirl))
    several = np.count_nonzero(np.isfinite(answer.branch_deflection), axis=1) > 1
    if several.any():
        first, last = answer.speed[several][[0, -1]] * RPM
        notes.append(
            f"Several deflections satisfy the balance between {first:.4g} and {last:.4g} rpm; the largest "
            f"{'stable ' if motion is None else ''}one is reported, where a slow run-up arrives."
        )
    return (*notes, *_volume_notes(scene, answer, motion), *_mesh_notes(scene))


def _mesh_notes(scene: Scene) -> list[str]:
    """What is poor in the meshes of chambers with a section of their own."""
    notes = []
    for k, fill in enumerate(scene.chambers):
        if fill.chamber.section is None or not fill.uneven:
            continue
        from meshes.findings import mesh_findings, wave_findings

        liquid = liquid_of(fill.chamber.section, fill.surface_radius)
        found = (*mesh_findings(fill.chamber.section.mesh), *wave_findings(liquid, 1))
        notes += [f"Mesh of chamber {k + 1}: {one}." for one in found]
    return notes


def _motion_notes(scene: Scene, motion: Motion, answer: Response) -> list[str]:
    """How a rotor that is not planar is reported, and how far its orbit is from a circle."""
    place = "the first chamber" if scene.chambers else "the origin of positions"
    notes = [
        f"Amplitudes are the largest radius of the axis' orbit in the plane of {place}, at "
        f"{motion.position * MM:.4g} mm; angles are those of its part that turns with the spin, from "
        f"{'the unbalance' if motion.zero == 'unbalance' else motion.zero}.",
    ]
    size, against = np.abs(answer.deflection), np.abs(motion.backward)
    known = np.isfinite(size) & (size + against > 0.0)
    if known.any():
        share = against[known] / (size + against)[known]
        worst = int(np.argmax(share))
        if share[worst] > 1e-6 and scene.chambers:
            notes.append(
                f"Against the spin goes up to {share[worst]:.2g} of the orbit, at "
                f"{answer.speed[known][worst] * RPM:.4g} rpm; the liquid answers that part by linear theory."
            )
    return notes


def _volume_notes(scene: Scene, answer: Response, motion: Motion | None) -> list[str]:
    """The volume beyond which more liquid does nothing, for the deflection at the last speed."""
    notes: list[str] = []
    speed = answer.speed[-1]
    for k, fill in enumerate(scene.chambers):
        deflection = abs(answer.deflection[-1] if motion is None else motion.chamber_forward[-1, k])
        if not np.isfinite(deflection) or fill.compartments > 1 or fill.chamber.section is not None:
            continue
        best = float(optimal_volume(fill.chamber, deflection, speed, axial_gravity(scene)))
        has = "wet all round" if fill.volume > best else "dry in part"
        notes.append(
            f"Chamber {k + 1} at {speed * RPM:.4g} rpm: its wall is {has} with {fill.volume * ML:.4g} ml; "
            f"{best * ML:.4g} ml just cover it at this deflection of {deflection * MM:.3g} mm."
        )
    return notes
