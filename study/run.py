"""The main job: a scene in, the response of the machine out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fluid.fill import Fill
from solvers.hydrostatics import optimal_volume
from solvers.response import Response, critical_speed, synchronous_response
from solvers.rotor.jeffcott import Jeffcott
from study.fidelity import Choice, axial_gravity, choose
from study.record import MM, RPM, ChamberRecord, StudyRecord
from study.scene import Scene

ML = 1e6  # millilitres in one cubic metre


def jeffcott(scene: Scene) -> Jeffcott:
    """The scene's rotor without liquid."""
    rotor = scene.rotor
    return Jeffcott(rotor.mass, rotor.stiffness, rotor.damping, rotor.unbalance)


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
    InputError : the scene asks for a liquid model that does not answer this

    Examples
    --------
    >>> from study.scene import load_scene
    >>> record = run_scene(load_scene("examples/horizontal_rig.toml"))
    >>> record.response.speed.size
    201
    """
    choice = choose(scene)
    gravity = axial_gravity(scene)
    rotor = jeffcott(scene)
    answer = synchronous_response(rotor, scene.chambers, scene.speed_array(), gravity, choice.model)
    answer = replace(answer, in_range=answer.in_range & choice.in_range)
    return StudyRecord(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        inputs=_inputs(scene),
        digest=scene.digest,
        response=answer,
        liquid_mass=sum(fill.mass for fill in scene.chambers),
        notes=_notes(scene, choice, answer),
        axis=scene.rotor.axis,
        chambers=tuple(_chamber(fill) for fill in scene.chambers),
        capture_speed=choice.captured_from,
        critical_speed_dry=rotor.natural_frequency,
        critical_speed_wet=critical_speed(rotor, scene.chambers, gravity, choice.model),
    )


def _chamber(fill: Fill) -> ChamberRecord:
    chamber = fill.chamber
    return ChamberRecord(
        chamber.radius,
        chamber.inner_radius,
        chamber.height,
        fill.volume,
        fill.liquid.name,
        fill.surface_radius,
    )


def _inputs(scene: Scene) -> tuple[tuple[str, str, str], ...]:
    """Label, value with its unit and field path of what the scene says."""
    rotor = scene.rotor
    frequency = jeffcott(scene).natural_frequency
    rows = [
        ("Rotor mass", f"{rotor.mass:.4g} kg", "rotor.mass"),
        ("Support stiffness", f"{rotor.stiffness:.4g} N/m", "rotor.stiffness"),
        (
            "Critical speed without liquid",
            f"{frequency * RPM:.4g} rpm ({frequency:.4g} rad/s)",
            "rotor.critical_speed",
        ),
        ("Support damping", f"{rotor.damping:.4g} N s/m", "rotor.damping"),
        ("Damping ratio", f"{jeffcott(scene).damping_ratio:.4g}", "rotor.damping_ratio"),
        ("Unbalance", f"{rotor.unbalance * 1e6:.4g} g mm", "rotor.unbalance"),
        ("Axis", rotor.axis, "rotor.axis"),
    ]
    for k, fill in enumerate(scene.chambers):
        label, chamber = f"Chamber {k + 1}", fill.chamber
        inner = f", inner radius {chamber.inner_radius * MM:.4g} mm" if chamber.inner_radius > 0.0 else ""
        rows += [
            (f"{label}: radius", f"{chamber.radius * MM:.4g} mm{inner}", f"chambers.{k}.radius"),
            (f"{label}: height", f"{chamber.height * MM:.4g} mm", f"chambers.{k}.height"),
            (f"{label}: liquid", f"{fill.volume * ML:.4g} ml of {fill.liquid.name}", f"chambers.{k}.volume"),
        ]
    speeds = scene.speeds
    span = f"{speeds.start * RPM:.4g} to {speeds.stop * RPM:.4g} rpm, {speeds.count} speeds"
    return (*rows, ("Speeds", span, "speeds"))


def _notes(scene: Scene, choice: Choice, answer: Response) -> tuple[str, ...]:
    """Limits of validity and findings, in words."""
    notes: list[str] = []
    if choice.captured_from is not None:
        notes.append(
            f"Below {choice.captured_from * RPM:.3g} rpm gravity across the axis is stronger than the "
            "centrifugal acceleration at a free surface: the liquid does not ride with the drum there, and "
            "the results are marked out of range. Above it gravity's pull on the liquid turns backwards in "
            "the drum and adds nothing to the synchronous response in linear theory."
        )
    notes.append(
        "Stability is that of slow disturbances, the liquid being in equilibrium at every moment, without "
        "liquid friction; self-excited whirl of the liquid is not part of it."
    )
    several = np.count_nonzero(np.isfinite(answer.branch_deflection), axis=1) > 1
    if several.any():
        first, last = answer.speed[several][[0, -1]] * RPM
        notes.append(
            f"Several deflections satisfy the balance between {first:.4g} and {last:.4g} rpm; the largest "
            "stable one is reported, where a slow run-up arrives."
        )
    return (*notes, *_volume_notes(scene, answer))


def _volume_notes(scene: Scene, answer: Response) -> list[str]:
    """The volume beyond which more liquid does nothing, for the deflection at the last speed."""
    notes: list[str] = []
    deflection, speed = abs(answer.deflection[-1]), answer.speed[-1]
    if not np.isfinite(deflection):
        return notes
    for k, fill in enumerate(scene.chambers):
        best = float(optimal_volume(fill.chamber, deflection, speed, axial_gravity(scene)))
        has = "wet all round" if fill.volume > best else "dry in part"
        notes.append(
            f"Chamber {k + 1} at {speed * RPM:.4g} rpm: its wall is {has} with {fill.volume * ML:.4g} ml; "
            f"{best * ML:.4g} ml just cover it at this deflection of {deflection * MM:.3g} mm."
        )
    return notes
