"""Gravity on a ring of liquid in a fast horizontal drum [KC06, IKC04, KP22]: swing, drift, modulated speed.

Speed of the drum Omega (1 + epsilon cos(Omega t)) turns gravity in its frame unevenly: its mean there is
epsilon g/2. Liquid that the drum carries along, as in a cell with walls across, has its surface moved by
epsilon g/(2 Omega^2). A smooth wall without friction carries nothing along: the surface stands in space,
xi = (kappa - 1) g/(2 kappa Omega^2) below the axis, and has the mean epsilon xi/2 in the frame of the drum.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fluid.fill import Fill
from fluid.liquid import known_liquid
from fluid.waves import displacement_ratio, gravity_displacement, wall_swing
from leblanc.studies.layer.study import answer_layer
from meshes.chamber import Chamber
from meshes.rings.quadrilaterals import ring
from solvers.sloshing.forced import FORWARD, displacement_field
from solvers.sloshing.system import condense, wall_points
from solvers.synchronous.models import LINEAR
from validation.case import Case, Claims

CLAIMS = Claims("published")

_GRAVITY = 9.81
RADIUS, SHARE = 0.05, 0.3  # m, of the drum, and its share filled: not printed in what was read
SPEEDS = (20.0, 40.0, 80.0)  # rad/s
_CELLS = (48, 4)  # around and across


def filled() -> Fill:
    """Water in the drum."""
    chamber = Chamber(RADIUS, RADIUS)
    return Fill(chamber, known_liquid("water"), SHARE * chamber.capacity)


def swing_by_elements(speed: float) -> float:
    """Velocity of the liquid along the wall by finite elements, largest, m/s."""
    system = condense(ring(RADIUS, RADIUS * math.sqrt(1.0 - SHARE), *_CELLS))
    field = displacement_field(system, speed, -speed, (_GRAVITY * FORWARD).astype(complex))
    psi = -1j * speed * system.on_nodes(field[None])[0]
    return float(np.abs(wall_points(system.section).slope @ psi).max())


def lag(speed: float) -> float:
    """Lag of the liquid at the edge of the wall's layer over the spin, as `leblanc layer` has it."""
    return -answer_layer(filled(), speed, speed, 0.0, LINEAR, gravity=_GRAVITY).wall_drift / speed


def shifts(depth: float, speed: float) -> tuple[float, float]:
    """Mean place of the surface's centre in the frame of a drum whose speed is modulated by `depth`, m.

    Of liquid that goes with the drum, under a force that stands in it, and of a ring that nothing carries.
    """
    kappa = 1.0 / (1.0 - SHARE)
    # A synchronous whirl of w is the force Omega^2 w; the surface moves along it, the layer there is thinner.
    force = 0.5 * depth * _GRAVITY
    carried = abs(float(displacement_ratio(kappa, 1.0))) * force / speed**2
    return carried, 0.5 * depth * float(gravity_displacement(kappa, speed, _GRAVITY))


def cases() -> Iterator[Case]:
    """Swing along the wall, drift by it over speed, place of the surface under a modulated speed."""
    kappa, speed = 1.0 / (1.0 - SHARE), SPEEDS[1]
    swing = float(wall_swing(kappa, speed, _GRAVITY))
    yield CLAIMS.case("swing", swing_by_elements(speed), printed=swing, speed=speed, share=SHARE)
    lags = [lag(each) for each in SPEEDS]
    power = math.log(lags[-1] / lags[0]) / math.log(SPEEDS[-1] / SPEEDS[0])
    same = all(value > 0.0 for value in lags) and math.isclose(power, -4.0, rel_tol=1e-9)
    words = ", ".join(f"{value:.2g}" for value in lags)
    told = {"speeds": ", ".join(f"{each:g}" for each in SPEEDS), "share": SHARE}
    yield CLAIMS.case("drift", words, same, **told)
    (first, other), twice, faster = shifts(0.1, speed), shifts(0.2, speed), shifts(0.1, 2.0 * speed)
    pairs = zip((first, other), twice, faster, strict=True)
    same = all(math.isclose(b, 2.0 * a) and math.isclose(c, 0.25 * a) for a, b, c in pairs)
    yield CLAIMS.case("modulated", agrees=same, carried=1e3 * first, slipping=1e3 * other, speed=speed)
