"""The suspended tub of DG21 and the bearing of DR18: what is stated, and what follows from it.

The machine has six degrees of freedom: what the source gives, and all that it does not. The drum spins about
y, x lies across, z is up, and positions count from the tub's centre of mass.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from meshes.arrays import Array
from solvers.rotor.system import cage_speed
from solvers.rotor.tub import Mount, Tub, Vector
from solvers.rotor.vibration import orbit, unbalance_response
from validation.case import Case, Claims
from validation.page import Figure, page
from validation.study import launch, shown

CLAIMS = Claims("tub")

# Given in table 1.
TUB_MASS, DRUM_MASS = 48.2, 12.5  # kg
ECCENTRICITY = 14.8e-3  # m
SPRING, SPRING_ANGLE = 6000.0, math.radians(75.0)  # N/m each of two; taken from the horizontal
DAMPER, DAMPER_ANGLE = 175.0, math.radians(70.0)  # N s/m each of two
FARTHEST = 0.09  # m, of the drum's centre of mass along the axis


@dataclass(frozen=True)
class Assumed:
    """What DG21 does not give, in SI units."""

    #: of a shell of 230 mm radius and 300 mm length with a counterweight
    tub_inertia: Vector = (1.3, 1.5, 1.3)
    drum_polar_inertia: float = 0.32  #: of a shell of 185 mm radius and 190 mm length with laundry
    drum_transverse_inertia: float = 0.20
    spring_place: tuple[float, float] = (0.2, 0.2)  #: x across and z up, each mirrored in x, at y = 0
    damper_place: tuple[float, float] = (0.12, -0.22)
    #: stiffness of a spring across itself: its tension, 308 N, over its length, 250 mm
    lateral: float = 1200.0
    bush: float = 500.0  #: sideways stiffness of a damper's rubber bushes
    friction: float = 20.0  #: damping of the bushes in all directions


def suspended_tub(
    drum_y: float = 0.0, shift: float = 0.0, spring_turn: float = 0.0, damper_turn: float = 0.0
) -> Tub:
    """Machine of DG21 without liquid.

    `drum_y` is the place y_D of the drum's centre of mass and of the unbalance along the axis, `shift` l_c by
    which the springs sit farther along it, m. Turns phi out of the plane across the axis, rad: one of a pair
    towards +y, the other towards -y, so that they stay in balance under the weight.
    """
    known = Assumed()
    springs, dampers = [], []
    for side in (1.0, -1.0):
        place = (side * known.spring_place[0], shift, known.spring_place[1])
        springs.append(
            Mount(
                place,
                SPRING - known.lateral,
                direction(SPRING_ANGLE, spring_turn, side),
                along_axes=(known.lateral,) * 3,
            )
        )
        place = (side * known.damper_place[0], 0.0, known.damper_place[1])
        springs.append(Mount(place, along_axes=(known.bush, known.bush, 0.0)))
        way = direction(-DAMPER_ANGLE, damper_turn, side)
        dampers.append(Mount(place, DAMPER - known.friction, way, along_axes=(known.friction,) * 3))
    return Tub(
        tub_mass=TUB_MASS,
        drum_mass=DRUM_MASS,
        tub_inertia=known.tub_inertia,
        drum_polar_inertia=known.drum_polar_inertia,
        drum_transverse_inertia=known.drum_transverse_inertia,
        springs=tuple(springs),
        dampers=tuple(dampers),
        unbalance=DRUM_MASS * ECCENTRICITY,
        drum_position=(0.0, drum_y, 0.0),
    )


def direction(angle: float, turn: float, side: float) -> Vector:
    """Unit vector at an angle above the horizontal, turned by phi out of the plane across the axis, rad.

    On side -1 of the tub everything is turned by half a turn about the vertical.
    """
    flat = math.cos(turn)
    return side * math.cos(angle) * flat, side * math.sin(turn), math.sin(angle) * flat


def amplitude(machine: Tub, speed: Array, coordinate: str) -> Array:
    """Amplitude of a coordinate of the tub's centre of mass over speed, rad/s, shape (s,).

    "x", "y", "z", m, or "alpha", "beta", "gamma", rad.
    """
    system = machine.system()
    return np.asarray(np.abs(unbalance_response(system, speed)[:, system.coordinates.index(coordinate)]))


_RPM = math.pi / 30.0
_PLACES = np.linspace(0.0, FARTHEST, 7)
_SPEEDS = np.linspace(30.0, 400.0, 1481) * _RPM

# A ball bearing 203, the size that DR18 names: circle of the balls' centres and balls, mm.
_CIRCLE, _BALL = 28.5, 6.75


def cases() -> Iterator[Case]:
    """Every case of the tub and of the bearing's cage."""
    # Far above resonance the centre of mass of everything is at rest.
    system = suspended_tub().system()
    far, known = orbit(system, unbalance_response(system, [1e4]), 0.0), DRUM_MASS * ECCENTRICITY
    yield CLAIMS.case("supercritical", float(far.amplitude[0]), printed=known / (TUB_MASS + DRUM_MASS))
    yield _measured()
    # Largest angular and longitudinal motion over the whole range of speeds, as the laundry moves off.
    for key, coordinate, unit, meaning in (
        ("angular-motion", "alpha", "mrad", "turn about x"),
        ("longitudinal-motion", "y", "mm", "motion along the axis"),
    ):
        rises, told = _rising([suspended_tub(y) for y in _PLACES], coordinate)
        yield CLAIMS.case("with_distance", told, rises, key=key, meaning=meaning, unit=unit)
    # The relations below Fig. 7 for the stiffness of a spring out of the plane across the axis.
    turn = math.radians(30.0)
    flat, up, out = math.cos(SPRING_ANGLE), math.sin(SPRING_ANGLE), math.cos(turn)
    printed = (flat * out) ** 2 + (flat * math.sin(turn)) ** 2 + (up * out) ** 2
    squares = sum(cosine**2 for cosine in direction(SPRING_ANGLE, turn, 1.0))
    yield CLAIMS.case("dg-spring-direction", squares, printed=printed)
    yield CLAIMS.case("dg-spring-projection", flat**2, printed=flat)
    # Largest turn about x with the laundry in the middle, as the springs move along the axis.
    shifted = [suspended_tub(shift=shift) for shift in (0.0, 0.01, 0.02, 0.03)]
    rises, told = _rising(shifted, "alpha")
    yield CLAIMS.case("rigidity-centre", told, rises)
    yield CLAIMS.case("dr-eq-10", float(cage_speed(1.0, _CIRCLE, _BALL, 0.0)))


def _rising(machines: Sequence[Tub], coordinate: str) -> tuple[bool, str]:
    """Whether the largest amplitudes rise from machine to machine, and these, mm or mrad."""
    size = [1e3 * float(amplitude(machine, _SPEEDS, coordinate).max()) for machine in machines]
    return bool(np.all(np.diff(size) > 0.0)), ", ".join(f"{value:.3g}" for value in size)


def _measured() -> Case:
    """The one amplitude that was measured, with an unbalance that cannot be the one that is stated."""
    size = 1e3 * amplitude(suspended_tub(), _SPEEDS, "z")
    share = 1800e-6 / (DRUM_MASS * ECCENTRICITY)
    return CLAIMS.case(
        "measured-amplitude",
        f"{share * size[-1]:.2g} at {_SPEEDS[-1] / _RPM:.0f} rpm, {share * size.max():.2g} at most",
        share * size.max() >= 3.5,
        difference=f"with the table's m_2 e it is {size[-1]:.3g} and {size.max():.3g}",
    )


_LINES = ("-", (0, (5, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5, 1, 1.5)))
_MARKS = "osD^v"
_ABOUT = (
    "Linear vibration of the dry tub with the masses, springs, dampers and eccentricity of DG21, table 1; "
    "inertias, places and sideways stiffnesses are assumed."
)


@dataclass(frozen=True)
class Plot:
    """One figure."""

    name: str  #: stem of its file
    title: str  #: what it shows
    coordinate: str  #: of the tub's centre of mass
    label: str  #: of the axis
    lines: Sequence[tuple[str, Tub]]  #: label and machine of each line
    top: float = 300.0  #: largest speed, rpm


def plots() -> tuple[Plot, ...]:
    """The six figures of the source."""
    places = [(f"y_D = {1e3 * y:.0f} mm", suspended_tub(y)) for y in (0.0, 0.03, 0.06, FARTHEST)]
    shifts = (0.0, 0.025, 0.05, 0.075)
    turns = (0.0, 15.0, 30.0, 45.0)
    up, along = "Amplitude of z (mm)", "Amplitude of y (mm)"

    def shifted(y: float) -> list[tuple[str, Tub]]:
        return [(f"l_c = {1e3 * shift:.0f} mm", suspended_tub(y, shift)) for shift in shifts]

    springs = [
        (f"springs at {t:.0f}\N{DEGREE SIGN}", suspended_tub(FARTHEST, 0.0, math.radians(t))) for t in turns
    ]
    dampers = [
        (f"dampers at {t:.0f}\N{DEGREE SIGN}", suspended_tub(FARTHEST, 0.0, 0.0, math.radians(t)))
        for t in turns
    ]
    return (
        Plot("tub_fig4_vertical", "Vertical motion, after DG21, Fig. 4", "z", up, places),
        Plot("tub_fig5_longitudinal", "Motion along the axis, after DG21, Fig. 5", "y", along, places),
        Plot(
            "tub_fig6_rigidity_centre",
            "Vertical motion, after DG21, Fig. 6: rigidity centre l_c off the centre of gravity, y_D = 0",
            "z", up, shifted(0.0),
        ),
        Plot(
            "tub_fig7_rigidity_centre_far",
            "Vertical motion, after DG21, Fig. 7: rigidity centre l_c off, y_D = 90 mm",
            "z", up, shifted(FARTHEST),
        ),
        Plot(
            "tub_fig8_springs_turned",
            "Vertical motion, after DG21, Fig. 8: springs turned out of the plane, y_D = 90 mm",
            "z", up, springs,
        ),
        Plot(
            "tub_fig9_dampers_turned",
            "Vertical motion, after DG21, Fig. 9: dampers turned out of the plane, y_D = 90 mm",
            "z", up, dampers,
        ),
    )  # fmt: skip


def draw(plot: Plot) -> Figure:
    """Amplitude over speed, one line a machine."""
    speed = np.linspace(20.0, plot.top, 1121)
    with page([2.75], f"{plot.title}. {_ABOUT}", top=0.46) as (figure, [[axes]]):
        highest = 0.0
        for k, (label, machine) in enumerate(plot.lines):
            size = 1e3 * amplitude(machine, speed * _RPM, plot.coordinate)
            highest = max(highest, float(size.max()))
            axes.plot(
                *(speed, size),
                color=f"C{k}",
                linestyle=_LINES[k],
                marker=_MARKS[k],
                markerfacecolor="white",
                markevery=(40 + 35 * k, 140),
                linewidth=1.2,
                label=label,
            )
        axes.set(xlim=(speed[0], speed[-1]), ylim=(0.0, 1.08 * highest))
        axes.set(xlabel="Speed (rpm)", ylabel=plot.label)
        above = axes.secondary_xaxis("top", functions=(lambda x: x * _RPM, lambda x: x / _RPM))
        above.set_xlabel("Speed (rad/s)")
    return figure


if __name__ == "__main__":
    launch(shown(**{plot.name: partial(draw, plot) for plot in plots()}))
