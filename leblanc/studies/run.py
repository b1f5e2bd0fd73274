"""The main job: a scene in, the response of the machine out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from leblanc.results.record import ChamberRecord, ModeRecord, Motion, SelfExcited, StudyRecord
from leblanc.scene.machine import dry_rotor
from leblanc.scene.machine import jeffcott as jeffcott
from leblanc.scene.rows import input_rows
from leblanc.scene.scene import Rotor, Scene, TubRotor
from leblanc.studies.choose import Choice, axial_gravity, choose
from leblanc.studies.whirl_map import small_whirl_friction
from leblanc.text.models import fidelity_notes
from leblanc.units import ML, MM, RPM
from meshes.arrays import Complex
from meshes.chamber_section import liquid_of
from solvers.rotor.campbell import campbell
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import (
    critical_speeds,
    modes,
    orbit,
    unbalance_response,
    whirl_direction,
)
from solvers.statics.hydrostatics import optimal_volume
from solvers.synchronous.coupled import CoupledResponse, coupled_response, wet_critical_speeds
from solvers.synchronous.mixed import mixed_coupled, mixed_response
from solvers.synchronous.planar import Response, critical_speed
from solvers.whirl.edges import unstable_bands
from solvers.whirl.growth import asynchronous_growth


def self_excited(scene: Scene) -> SelfExcited:
    """Growth of small whirls of the scene's machine at its speeds [theory: whirl, eq. 7].

    Parameters
    ----------
    scene : the machine; its friction acts in the liquid
    """
    system, speed = dry_rotor(scene).system(), scene.speed_array()
    friction = scene.model.friction
    growth, whirl_speed = asynchronous_growth(system, scene.chambers, speed, friction)
    bands: tuple[tuple[float, float], ...] = ()
    if speed[-1] > speed[0]:
        bands = unstable_bands(system, [scene.chambers], speed, friction, growth[None])[0]
    return SelfExcited(growth, whirl_speed, bands, small_whirl_friction(scene.model.friction))


def stable_with(found: SelfExcited, stable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Stability against slow disturbances and against whirls that grow by themselves.

    Parameters
    ----------
    found : the whirl
    stable : against slow disturbances, shape (n,)
    """
    return np.asarray(stable & ~(found.growth > 0.0))


def describe_whirl(found: SelfExcited) -> str:
    """What was found, in words."""
    theory = (
        "by linear theory of an even layer; dry walls and liquid gathered on one side are left out; "
        f"liquid friction: {found.friction}"
    )
    if np.isnan(found.growth).any():
        return f"Whether a whirl grows by itself was not found at every speed ({theory})."
    if not found.bands:
        return f"No whirl grows by itself at these speeds ({theory})."
    listed = ", ".join(f"{low * RPM:.5g} to {high * RPM:.5g} rpm" for low, high in found.bands)
    most = int(np.argmax(found.growth))
    fastest = ""
    if found.growth[most] > 0.0:
        ratio = found.whirl_speed[most]
        fastest = f", fastest at {found.growth[most]:.3g} 1/s, whirling at {ratio * RPM:.4g} rpm"
    return f"A whirl grows by itself from {listed}{fastest}: unstable there ({theory})."


_DIAGRAM = 121  # speeds of a Campbell diagram

# What each coordinate of the rotors means, in words.
_WORDS = {
    "x": "shift along x",
    "y": "shift along y",
    "z": "shift along z",
    "alpha": "turn about x",
    "beta": "turn about y",
    "gamma": "turn about z",
}


def motion_response(scene: Scene, choice: Choice) -> tuple[CoupledResponse, Motion, tuple[float, float]]:
    """Response of a scene's rotor with all its chambers, and what its vibration is without them.

    Parameters
    ----------
    scene : the machine
    choice : liquid model of the forward part at each speed

    Returns
    -------
    The response; the motion; the critical speeds without and with liquid at which the unbalance moves the
    axis most, rad/s

    Raises
    ------
    InputError : an exciter, or an unknown model
    """
    system, gravity = dry_rotor(scene).system(), axial_gravity(scene)
    found = mixed_coupled(system, scene.chambers, scene.speed_array(), gravity, choice.models)
    dry, dry_shape = critical_speeds(system)
    wet, wet_shape = wet_critical_speeds(system, scene.chambers, gravity, choice.model)
    motion = Motion(
        position=found.position,
        backward=found.backward,
        backward_dry=found.backward_dry,
        branch_backward=found.branch_backward,
        chamber_forward=_at_chambers(system, scene.chambers, found),
        modes=rest_modes(system),
        campbell=campbell(system, np.linspace(0.0, scene.speeds.stop, _DIAGRAM)),
        critical_speeds_dry=_directed(system, dry, dry_shape),
        critical_speeds_wet=_directed(system, wet, wet_shape),
        zero="unbalance" if isinstance(scene.rotor, TubRotor) else "angle 0 of the unbalances",
    )
    return found, motion, main_critical_speeds(system, scene.chambers, found.position, dry, wet)


def _at_chambers(system: RotorSystem, fills: tuple[Fill, ...], found: CoupledResponse) -> Complex:
    """Forward part at every chamber, those without liquid as well, shape (s, c)."""
    places = [orbit(system, found.coordinates, fill.chamber.plane).forward for fill in fills]
    return np.stack(places, axis=1) if places else np.zeros((found.residual.size, 0), dtype=complex)


def rest_modes(system: RotorSystem) -> tuple[ModeRecord, ...]:
    """Modes at rest by rising frequency, each with the coordinate that has most of its energy."""
    found = modes(system)
    energy = np.abs(found.shape[0]) ** 2 * np.diag(system.mass)[:, None]
    most = energy.argmax(axis=0)
    return tuple(
        ModeRecord(float(frequency), float(ratio), _WORDS[system.coordinates[k]])
        for frequency, ratio, k in zip(found.frequency[0], found.damping_ratio[0], most, strict=True)
    )


def _directed(
    system: RotorSystem, speed: NDArray[np.float64], shape: Complex
) -> tuple[tuple[float, float], ...]:
    sense = whirl_direction(system, shape)
    return tuple((float(one), float(way)) for one, way in zip(speed, sense, strict=True))


def main_critical_speeds(
    system: RotorSystem,
    fills: tuple[Fill, ...],
    position: float,
    dry: NDArray[np.float64],
    wet: NDArray[np.float64],
) -> tuple[float, float]:
    """Of the critical speeds without and with liquid those at which the unbalance moves the axis most.

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers
    position : where the axis is looked at, m
    dry, wet : critical speeds, rad/s, at least one each

    Returns
    -------
    rad/s, without and with liquid
    """
    chosen = []
    for speeds, liquid in ((dry, ()), (wet, fills)):
        if speeds.size == 0:
            chosen.append(float("nan"))
            continue
        if liquid:
            found = coupled_response(system, liquid, speeds, 0.0, "linear", position)
            size = np.abs(found.response.deflection) + np.abs(found.backward)
        else:
            size = orbit(system, unbalance_response(system, speeds), position).amplitude
        chosen.append(float(speeds[int(np.argmax(size))]))
    return chosen[0], chosen[1]


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
    >>> from leblanc.scene.scene import load_scene
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
