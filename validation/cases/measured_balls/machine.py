"""The measured rig [RCFW11]: a rigid rotor on two unlike supports, with two balls in one race.

What was measured stands in `validation/data/measured_balls.json`, read from the source's figures.
"""

from __future__ import annotations

import cmath
import math
from functools import cache
from typing import Any

import numpy as np

from meshes.arrays import Array, Complex
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import orbit, unbalance_response
from validation.study import data

RPM = math.pi / 30.0
WASHERS = range(5)
STIFFER = 2.0  # of the supports over what is printed
# Speeds above all resonances at which the levels are compared, of those that were read.
FAST = (4100, 4500, 4900)
# Two balls that come to one place with the same speed move as one for ever: no number tells them apart. Real
# balls touch before. Of their masses, so much; a tenth or ten times of it changes nothing.
UNLIKE = 1e-3


@cache
def known() -> dict[str, Any]:
    """What the source says and what was read from its figures."""
    return data("measured_balls.json")


def measured(curve: str, washers: int) -> Array:
    """Amplitudes over `speeds_read`, m; curve: plain, up or down."""
    return np.array(known()["amplitude_um"][curve][washers]) * 1e-6


def speeds_read() -> Array:
    """Speeds of the measured amplitudes, rpm."""
    return np.array(known()["speed_rpm"], dtype=float)


def level(curve: str, washers: int) -> float:
    """Measured amplitude above all resonances, m."""
    return float(measured(curve, washers)[np.isin(speeds_read(), FAST)].mean())


def couples() -> Complex:
    """First moments of the unbalance along the axis with 1 to 4 washers, kg m^2, the washers at angle 0.

    The misalignment times the difference of the inertias. Its sense is not known from the figures; this one
    puts the washers on the side of the race, where they can be balanced as measured, the other on the far
    side of the centre of mass.
    """
    rotor, printed = known()["rotor"], known()["washers"]
    longer = rotor["transverse_inertia"] - rotor["polar_inertia"]
    turned = np.radians(printed["eccentricity_leads_deg"][1:])
    return np.asarray(-longer * np.array(printed["misalignment_1e-5_rad"][1:]) * 1e-5 * np.exp(-1j * turned))


def washer_plane() -> tuple[float, complex]:
    """Place of the washers along the axis, m, and couple without them, kg m^2, that fit `couples` best."""
    moment = np.array(known()["washers"]["unbalance_g_mm"][1:]) * 1e-6
    slope, left = np.polyfit(moment, couples().real, 1)
    return float(slope), complex(left, couples().imag.mean())


def rotor(washers: int, stiffer: float = STIFFER) -> TwoPlane:
    """The rotor with its washers, in supports of so many times the printed stiffness."""
    said = known()
    place, couple = washer_plane()
    springs = [stiffer * value for value in said["stiffness_printed"]]
    dampers = [said["damping_over_stiffness"] * value for value in springs]
    supports = tuple(
        Support(at, (springs[0], springs[1]), (dampers[0], dampers[1])) for at in said["bearings_position"]
    )
    arm, angle = 0.1, cmath.phase(couple)
    unbalances = [
        PlaneUnbalance(arm, 0.5 * abs(couple) / arm, angle),
        PlaneUnbalance(-arm, 0.5 * abs(couple) / arm, angle + math.pi),
    ]
    if washers:
        unbalances.append(PlaneUnbalance(place, said["washers"]["unbalance_g_mm"][washers] * 1e-6))
    inertia = said["rotor"]
    return TwoPlane(
        inertia["mass"],
        inertia["transverse_inertia"],
        inertia["polar_inertia"],
        supports,
        tuple(unbalances),
    )


def race(resistance: float = 0.0, drag: float = 0.01) -> BallRace:
    """The race with its two balls; resistance to rolling and drag, N s/m, are not known."""
    said = known()["race"]
    masses = (said["ball_mass"] * (1.0 + 0.5 * UNLIKE), said["ball_mass"] * (1.0 - 0.5 * UNLIKE))
    return BallRace(said["position"], said["radius"], masses, drag, resistance=resistance)


def at_bearings(system: RotorSystem, coordinates: Complex) -> Array:
    """Amplitude as it was measured: mean over the bearings of the largest distance in a turn, m."""
    ways = [orbit(system, coordinates, place).amplitude for place in known()["bearings_position"]]
    return np.asarray(np.mean(ways, axis=0))


def plain(washers: int, rpm: Array) -> Array:
    """Amplitude without balls, m."""
    system = rotor(washers).system()
    return at_bearings(system, unbalance_response(system, np.asarray(rpm) * RPM))
