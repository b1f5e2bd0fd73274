"""What a scene of kind "spindle" answers: compliances, natural frequencies, checks of both."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from leblanc.core.progress import update
from leblanc.scene.spindle import Spindle
from leblanc.studies.closed_forms.study import cages_of
from leblanc.wings.spindle.answer import NaturalMode, SpindleAnswer, Turning
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.shaft.natural import modes
from solvers.rotor.shaft.structure import Coordinate, Structure, compliances
from solvers.rotor.shaft.substructures import substructures

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene

_CHECKED = 50  # frequencies at which the way by reactions is gone as well


def run_spindle(scene: Scene) -> SpindleAnswer:
    """Answer of a spindle unit to a unit harmonic force over its frequency [theory: spindle, eq. 10-14].

    The scene's speeds are the frequencies of the force; one beyond the range of the beam theory is refused.
    """
    update(what="compliances")
    rotor = scene.rotor
    if not isinstance(rotor, Spindle):
        raise InputError("rotor.kind", rotor.kind, "spindle for this")
    machine, frequency = rotor.machine(), scene.speed_array()
    points = [rotor.coordinate(name) for name in (rotor.driven, rotor.measured, rotor.wanted)]
    try:
        answers = compliances(machine, frequency, points, points)
        shapes = modes(machine, float(frequency[0]), float(frequency[-1]))
    except InputError as error:
        raise InputError("speeds.stop", float(frequency[-1]), error.allowed) from error
    driven, measured, wanted = np.moveaxis(answers[:, :, 0], -1, 0)
    at_modes = compliances(machine, np.array([shape.frequency for shape in shapes]), points, points[:1])
    names = tuple(f"{beam.name}.{k}" for beam in rotor.beams for k in range(len(beam.sections) + 1))
    found = tuple(
        NaturalMode(
            shape.frequency,
            shape.along,
            dict(zip(names, np.concatenate(shape.stations).tolist(), strict=True)),
            complex(answer[1, 0]),
            complex(answer[2, 0]),
        )
        for shape, answer in zip(shapes, at_modes, strict=True)
    )
    exchanged = np.abs(answers - np.swapaxes(answers, -1, -2)).max(axis=(-1, -2))
    return SpindleAnswer(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        theory=rotor.theory,
        driven_at=rotor.driven,
        measured_at=rotor.measured,
        wanted_at=rotor.wanted,
        beams=tuple(beam.name for beam in rotor.beams),
        stations=names,
        places=places_of(machine),
        frequency=frequency,
        driven=driven,
        measured=measured,
        wanted=wanted,
        modes=found,
        reciprocity=float((exchanged / np.abs(answers).max(axis=(-1, -2))).max()),
        ways_apart=_ways_apart(machine, frequency, points, answers),
        least_dissipation=float((-driven.imag / np.abs(driven)).min()),
        turning=None if rotor.rotation is None else _turning(rotor, rotor.rotation),
    )


def _turning(rotor: Spindle, rotation: float) -> Turning:
    """Speeds of the cages of all joints whose balls are given."""
    cages = cages_of(rotor.caged(), np.array([rotation]))
    return Turning(rotation, {cage.name: float(cage.speed[0]) for cage in cages})


def _ways_apart(machine: Structure, frequency: Array, points: list[Coordinate], answers: Complex) -> float:
    """How far the way by reactions is from the assembly, at frequencies spread over the band."""
    if all(joint.second is None for joint in machine.joints):
        return float("nan")
    some = np.unique(np.linspace(0, frequency.size - 1, _CHECKED).round().astype(int))
    other = substructures(machine, frequency[some], points[0])
    there = [other.motions[point.station[0]][:, point.station[1], 0] for point in points]
    apart = np.abs(np.stack(there, axis=-1) - answers[some, :, 0])
    return float((apart / np.abs(answers[some, :, 0]).max(axis=-1, keepdims=True)).max())


def places_of(machine: Structure) -> tuple[float, ...]:
    """First station of each beam along the machine, m: the ends of a joint stand at one place.

    A beam that no joint leads to begins at 0.
    """
    within = [np.cumsum([0.0, *(section.length for section in beam)]) for beam in machine.beams]
    known = {0: 0.0}
    for _ in machine.beams:
        for joint in machine.joints:
            if joint.second is None:
                continue
            for (beam, here), (other, there) in (
                (joint.first, joint.second),
                (joint.second, joint.first),
            ):
                if beam in known and other not in known:
                    known[other] = known[beam] + float(within[beam][here] - within[other][there])
    return tuple(known.get(beam, 0.0) for beam in range(len(machine.beams)))
