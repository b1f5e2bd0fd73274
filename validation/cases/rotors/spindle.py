"""Spindle units against their source [DP18]: the bearing table, the equations of the test rig."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator

import numpy as np

from leblanc.core.notes import percent
from leblanc.core.units import ANGULAR_SPEED, parse
from leblanc.scene.examples import example
from leblanc.scene.spindle import Spindle
from solvers.rotor.rolling_bearing import Bearing, fit_bearing
from solvers.rotor.shaft.natural import natural_frequencies
from solvers.rotor.shaft.structure import Coordinate, Structure, compliances
from solvers.rotor.shaft.substructures import connections, free_compliances, substructures
from validation.case import Case, Claims

CLAIMS = Claims("spindle")

FRAME = 33.0  # Hz, first natural frequency of the frame [DP18, figure 5c]
# Speeds of the spindle at which each frequency of the bearing meets that of the frame, Hz [DP18, table 1].
PRINTED = {"ftf": 85.77, "bpfo": 9.55, "bpfi": 5.96, "bsf": 16.1}


def cases() -> Iterator[Case]:
    """Table 1, then the compliance matrix and the equation with a wrong index."""
    # Of the spindle's frequency, at the example's first natural one, and of the speed run at.
    turn = 2.0 * math.pi
    frame = float(natural_frequencies(_machine(), 10.0 * turn, 100.0 * turn)[0]) / turn
    for k, printed in ((1, 33.0), (2, 16.5), (3, 11.0)):
        yield CLAIMS.case("harmonic", frame / k, k=k, printed=printed)
    yield CLAIMS.case("speed", parse("660 rpm", ANGULAR_SPEED) / turn)
    known, cage = bearing(), FRAME / PRINTED["ftf"]
    speeds = {name: FRAME / order for name, order in known.orders().items()}
    fit = fit_bearing({name: FRAME / speed for name, speed in PRINTED.items()})
    words = {"fit": fit, "residual": 100.0 * fit.residual_rms, "next": 100.0 * fit.next_rms}
    balls = FRAME / PRINTED["bpfi"] / (1.0 - cage)
    yield CLAIMS.case("balls", balls, printed=float(known.balls), **words)
    ratio = {"bpfi": {"diameter_ratio": known.diameter_ratio}}
    for name in ("bpfi", "bpfo", "bsf"):
        yield CLAIMS.case(name, speeds[name], printed=PRINTED[name], **ratio.get(name, {}))
    for degrees in (15.0, 25.0):
        angle = math.radians(degrees)
        tilted = Bearing(known.balls, known.diameter_ratio / math.cos(angle), angle).orders()["bsf"]
        yield CLAIMS.case("bsf-degrees", FRAME / tilted, degrees=degrees, printed=PRINTED["bsf"])
    yield from _equations()


def _machine() -> Structure:
    rotor = example("spindle").rotor
    assert isinstance(rotor, Spindle)
    return rotor.machine()


def bearing() -> Bearing:
    """From three of the four printed numbers: the cage gives d cos(theta)/D, the inner ring the balls."""
    ratio = 1.0 - 2.0 * FRAME / PRINTED["ftf"]
    return Bearing(round(FRAME / PRINTED["bpfi"] / (1.0 - FRAME / PRINTED["ftf"])), ratio, 0.0)


def printed_housing(machine: Structure, frequency: float) -> complex:
    """q2 of the housing as published, alpha_25 in the place of alpha_21 at X5 [DP18, eq. 14 and 16]."""
    omega = np.array([frequency])
    reactions = substructures(machine, omega, Coordinate((1, 1))).reactions[0]
    own = free_compliances(machine, 2, omega)[0]
    signs = {2: -reactions[2], 3: -reactions[3], 4: -reactions[4], 5: -reactions[5] + reactions[6]}
    signs[6] = reactions[7]
    return complex(sum(own[4, 2 * station] * force for station, force in signs.items()))


def _equations() -> list[Case]:
    machine, rate = _machine(), 2.0 * math.pi * FRAME
    omega = np.array([rate])
    found = substructures(machine, omega, Coordinate((1, 1)))
    points = [Coordinate((0, 0)), Coordinate((2, 2))]
    direct = compliances(machine, omega, points, [Coordinate((1, 1))])[0, :, 0]
    by_reactions = found.motions[0][0, 0, 0] / found.motions[2][0, 2, 0]
    exact = complex(direct[0] / direct[1])
    printed = complex(found.motions[0][0, 0, 0]) / printed_housing(machine, rate)
    order = found.matrix.shape[-1]
    apart = percent(abs(by_reactions / exact - 1.0))
    return [
        CLAIMS.case(
            "matrix",
            f"{order} by {order}, {len(connections(machine, omega))} reactions, apart by {apart}",
            order == 8 and apart == "rounding",
            apart=apart,
        ),
        CLAIMS.case(
            "eq-14",
            f"{abs(exact):.3f} at {math.degrees(cmath.phase(exact)):.0f} deg",
            abs(printed / exact - 1.0) < 1e-6,
            printed=f"{abs(printed):.3f} at {math.degrees(cmath.phase(printed)):.0f} deg",
            difference=f"{abs(printed / exact - 1.0):.2f}",
        ),
        _flat(machine),
        CLAIMS.case("discussion"),
    ]


def _flat(machine: Structure) -> Case:
    """The source's "practically linear" W below 70 Hz."""
    omega = 2.0 * math.pi * np.linspace(5.0, 70.0, 66)
    points = [Coordinate((0, 0)), Coordinate((2, 2))]
    answer = compliances(machine, omega, points, [Coordinate((1, 1))])[..., 0]
    ratio = answer[:, 0] / answer[:, 1]
    size, turn = np.abs(ratio), np.abs(np.degrees(np.angle(ratio))).max()
    same = size.max() / size.min() < 1.2 and turn < 5.0
    return CLAIMS.case("flat", f"{size.min():.2f} to {size.max():.2f}, phase within {turn:.2f} deg", same)
