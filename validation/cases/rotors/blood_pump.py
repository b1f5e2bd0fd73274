"""The blood pump in magnetic bearings against its source [BG18]."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from leblanc.scene.examples import example
from leblanc.wings.magnetic.figure import magnetic_figure
from leblanc.wings.magnetic.study import run_magnetic
from meshes.arrays import Array
from solvers.rotor.magnetic.control import Controller, Pid, Synergetic, source_times
from solvers.rotor.magnetic.linear import Loop, closed_loop, margins, orbit_size
from solvers.rotor.magnetic.machine import MagneticRotor, Magnets, dimensionless, motor_length, screw_drag
from solvers.rotor.magnetic.motion import SpeedLaw, integrate, settling_time
from validation.case import Case, Claims
from validation.page import Figure, Table, logarithmic, page
from validation.study import launch, shown

CLAIMS = Claims("blood_pump")

LENGTH, RADIUS, GAP = 22e-3, 7.8e-3, 2e-4  # l, d/2 and delta of table 1
SHAPE, COEFFICIENT, VISCOSITY = 0.202, 0.91, 0.056  # k_m, c_w and eta
# Force constant and bias current are not given. Assumed so that the bearings hold three times c_m delta.
MAGNETS = Magnets(gap=GAP, force_constant=2e-5, bias_current=0.03)
MACHINE = MagneticRotor(
    mass=12.42e-3,
    transverse_inertia=6.9e-7,
    polar_inertia=3.78e-7,
    eccentricity=4.27e-7,
    inertia_tilt=2.15e-5,
    first=-9e-3,
    second=9e-3,
    magnets=MAGNETS,
    motor_stiffness=6000.0,
    motor_length=motor_length(SHAPE, -9e-3, 9e-3),
    drag=screw_drag(COEFFICIENT, VISCOSITY, RADIUS, LENGTH),
)
SPEED = 9000.0 * math.pi / 30.0
PULSATION = SpeedLaw(SPEED, 700.0 * math.pi / 30.0, 2.0 * math.pi)
TIME, WEIGHT, RATE, TILT_RATE = 35.0, 4000.0, 0.2, 1.2  # T, h, mu_1 and mu_3
LOAD = MACHINE.motor_stiffness * GAP  # c_m delta, an assumed load
REQUIRED = 4e-6  # accuracy asked for, m


def control(machine: MagneticRotor = MACHINE, weight: float = WEIGHT) -> Synergetic:
    """Controller of the source; weight h."""
    return source_times(machine, TIME, weight, RATE, TILT_RATE)


def cases() -> list[Case]:
    """Table, equations, stability, transients, accuracy, robustness."""
    loop = closed_loop(MACHINE, control(), SPEED)
    # Poles and unbalance response of the changed rotors with the unchanged controller.
    loops = {name: closed_loop(machine, control(), SPEED) for name, machine in variants().items()}
    slowest = {name: float(each.poles.real.max()) for name, each in loops.items()}
    shaken = {name: float(orbit_size(each.unbalance()[0]).max()) for name, each in loops.items()}
    worst, most = max(slowest, key=slowest.__getitem__), max(shaken, key=shaken.__getitem__)
    told = (
        f"slowest pole {slowest[worst]:.1f} 1/s ({worst}), deflection by the unbalances at most "
        f"{1e9 * shaken[most]:.1f} nm ({most})"
    )
    robust = CLAIMS.case("robustness", told, slowest[worst] < 0.0 and shaken[most] < REQUIRED)
    return [*_table(), *_equations(), *_stability(loop), *_transients(loop), robust]


def _table() -> list[Case]:
    """Dimensionless numbers and inertias of table 1."""
    numbers = dimensionless(MACHINE, LENGTH)
    whole = COEFFICIENT * VISCOSITY * math.pi * LENGTH**3 * numbers.time / MACHINE.transverse_inertia
    cylinder = MACHINE.mass * (3.0 * RADIUS**2 + LENGTH**2) / 12.0
    # Least share of the force from half the gap on that its slope in the centre, by differences, lacks.
    away, near = np.linspace(0.5, 0.9, 41) * GAP, 1e-5 * GAP
    slope = float(MAGNETS.force(near, 0.0)) / near
    beyond = float(np.min(1.0 - slope * away / np.asarray(MAGNETS.force(away, 0.0))))
    digits = "the inertias are printed with two and three digits"
    return [
        CLAIMS.case("pi-1", numbers.gyroscopic),
        CLAIMS.case(
            "pi-2",
            numbers.slenderness,
            note=f"{digits}; with those of a uniform cylinder {MACHINE.mass * LENGTH**2 / cylinder:.4f}",
        ),
        CLAIMS.case("inertia-across", cylinder),
        CLAIMS.case("inertia-about", 0.5 * MACHINE.mass * RADIUS**2),
        CLAIMS.case("pi-h", numbers.drag),
        CLAIMS.case("pi-h-table", whole),
        CLAIMS.case("force-44", beyond, tolerance=0.005 / 0.44),
    ]


def printed_accelerations(
    machine: MagneticRotor, time: float, place: Array, rate: Array, current: Array
) -> Array:
    """Accelerations of the source's eq. 39, computed in its units, in SI, shape (4,) [BG18, eq. 39-41].

    Currents, A, along first x, first y, second x, second y; there are no loads.
    """
    magnets, unit = machine.magnets, dimensionless(machine, LENGTH)
    tilt = GAP / LENGTH  # the unit of angles
    x, y, alpha, beta = place / [GAP, GAP, tilt, tilt]
    alpha_2, beta_2 = rate[2:] / tilt * unit.time
    a1, a2, speed = -machine.first / LENGTH, machine.second / LENGTH, SPEED * unit.time
    angle, e, gamma = SPEED * time, machine.eccentricity / GAP, machine.inertia_tilt / tilt
    i = current / magnets.bias_current

    def force(at: float, share: float) -> float:
        return unit.magnets * (((1.0 + share) / (1.0 - at)) ** 2 - ((1.0 - share) / (1.0 + at)) ** 2)

    ax, ay = force(x - a1 * beta, i[0]), force(y + a1 * alpha, i[1])
    bx, by = force(x + a2 * beta, i[2]), force(y - a2 * alpha, i[3])
    k = (machine.motor_length / (machine.second - machine.first)) ** 2 / 3.0
    pi1, pi2, pih = unit.gyroscopic, unit.slenderness, unit.drag
    own = 0.25 * pi2 * ((a1**2 + a2**2) * (1.0 + k) - 2.0 * a1 * a2 * (1.0 - k))
    turning = speed**2 * np.array([np.cos(angle), np.sin(angle)])
    first = x + 0.5 * (a2 - a1) * beta + ax + bx + e * turning[0]
    second = y + 0.5 * (a1 - a2) * alpha + ay + by + e * turning[1]
    third = -pih * alpha_2 - pi1 * speed * beta_2 + 0.5 * pi2 * (a1 - a2) * y - pih * speed * beta
    third += a1 * pi2 * ay - a2 * pi2 * by + own * alpha + gamma * (1.0 - pi1) * turning[0]
    fourth = -pih * beta_2 + pi1 * speed * alpha_2 + 0.5 * pi2 * (a2 - a1) * x + pih * speed * alpha
    fourth += -a1 * pi2 * ax + a2 * pi2 * bx + own * beta + gamma * (1.0 - pi1) * turning[1]
    scale = np.array([GAP, GAP, tilt, tilt]) / unit.time**2
    return np.asarray(scale * [first, second, third, fourth])


def accelerations(machine: MagneticRotor, time: float, place: Array, rate: Array, current: Array) -> Array:
    """Accelerations from the package's equations [theory: magnetic, eq. 1]."""
    motion = machine.bearing_motion
    load = motion.T @ machine.magnets.force(motion @ place, current)
    load = load + machine.unbalance_load(SPEED * time, SPEED)
    load = load + (machine.motor_pull - SPEED * machine.circulation) @ place
    load = load - (machine.damping + SPEED * machine.gyroscopic) @ rate
    return np.asarray(load / machine.inertia)


def _equations() -> list[Case]:
    uneven = replace(MACHINE, first=-8e-3, second=11e-3, inertia_tilt=2e-3, drag=1e-5)
    state = (
        *(0.013, np.array([3e-5, -2e-5, 2e-3, -1e-3]), np.array([0.1, -0.2, 9.0, 4.0])),
        np.array([5e-3, -2e-3, -7e-3, 9e-3]),
    )
    printed, found = printed_accelerations(uneven, *state), accelerations(uneven, *state)
    off = float(np.abs(printed / found - 1.0).max())
    share = float((PULSATION.rate(0.0) / PULSATION.mean**2).max())
    return [
        CLAIMS.case("equations", agrees=off < 1e-9, off=off, difference=off),
        CLAIMS.case("eq-39-order"),
        CLAIMS.case("numbering"),
        CLAIMS.case("acceleration", share, share < 1e-3),
    ]


def _stability(loop: Loop) -> list[Case]:
    """Poles that the method promises and those of the closed loop; the conditions of eq. 52."""
    unit = dimensionless(MACHINE, LENGTH).time
    promised = 1.0 / (TIME * unit)
    slow, fast = complex(loop.poles[1]), float(loop.poles.real.min())
    weak = closed_loop(MACHINE, control(weight=1.0), SPEED)
    growth = float(weak.poles.real.max())
    return [
        CLAIMS.case(
            "poles",
            f"{slow.real:.2f} +- {abs(slow.imag):.2f} i",
            abs(slow / promised + 1.0) <= 0.05,
            **{"follow": -promised, "damping": -slow.real / abs(slow), "fast": fast},
        ),
        CLAIMS.case("stability", agrees=growth <= 0.0, growth=growth),
    ]


def _transients(loop: Loop) -> list[Case]:
    """A step of c_m delta on the rotor at rest, and a start near a magnet."""
    time = np.linspace(0.0, 0.6, 1201)
    place = loop.step([LOAD, 0.0, 0.0, 0.0], time)[0][:, 0]
    peak, left = float(place.max()), float(np.abs(place[time >= 0.4]).max())
    past, most = float(-place.min()), LOAD * REQUIRED / peak
    stays, beyond = (f"{100.0 * size / peak:.2f}" for size in (left, past))
    start = integrate(MACHINE, control(), PULSATION, 0.6, place=(0.7 * GAP, 0.0, 0.0, 0.0), samples=1201)
    home, over = settling_time(start, REQUIRED), float(-start.displacement[:, 0].min()) / (0.7 * GAP)
    return [
        CLAIMS.case("transient", left / peak, left < 0.02 * peak, difference=f"{stays} % left"),
        CLAIMS.case("overshoot", past / peak, past < 0.01 * peak, difference=f"{beyond} % beyond"),
        CLAIMS.case("accuracy", peak, peak < REQUIRED, load=most, weights=most / MACHINE.mass / 9.81),
        CLAIMS.case(
            "startup",
            f"within 4 um after {home:.3f} s, {100.0 * over:.0f} % beyond the centre on the way",
            math.isfinite(home),
        ),
    ]


def variants() -> dict[str, MagneticRotor]:
    """The rotor with each of the source's parameters doubled and halved."""
    found: dict[str, MagneticRotor] = {}
    for word, factor in (("doubled", 2.0), ("halved", 0.5)):
        across, about = MACHINE.transverse_inertia / factor, MACHINE.polar_inertia / factor
        found |= {
            f"Pi_1 {word}": replace(MACHINE, polar_inertia=factor * MACHINE.polar_inertia),
            f"Pi_2 {word}": replace(MACHINE, transverse_inertia=across, polar_inertia=about),
            f"Pi_H {word}": replace(MACHINE, drag=factor * MACHINE.drag),
            f"a_1 {word}": replace(MACHINE, first=factor * MACHINE.first),
            f"a_2 {word}": replace(MACHINE, second=factor * MACHINE.second),
            f"e {word}": replace(MACHINE, eccentricity=factor * MACHINE.eccentricity),
            f"gamma {word}": replace(MACHINE, inertia_tilt=factor * MACHINE.inertia_tilt),
        }
    return found


HERTZ = 2.0 * math.pi
BANDWIDTHS = np.geomspace(300.0, 5e6, 43)  # of the coils, Hz
TOLD = (500.0, 1e3, 2e3, 5e3, 1e4, 1e5, 1e6)  # in the table, Hz
_LOOKS: dict[str, dict[str, Any]] = {
    "synergetic": {"color": "C0", "linestyle": "-", "label": "synergetic control"},
    "pid": {"color": "C1", "linestyle": "--", "label": "PID control"},
}


@dataclass(frozen=True)
class Coils:
    """A loop with coils that take time; n bandwidths."""

    bandwidth: Array  #: Hz, shape (n,)
    sensitivity: Array  #: largest, nan where the loop is not stable, shape (n,)
    damping: Array  #: least damping ratio of all poles, below 0 where the loop is not stable, shape (n,)
    delay: Array  #: delay margin, s, nan where the loop is not stable, shape (n,)


def controllers() -> tuple[Controller, ...]:
    """That of the source and the PID control of the example."""
    pid = Pid(MACHINE, proportional=150e3, integral=7.5e6, derivative=41.0, cutoff=5e4)
    return control(), pid


def slow_coils(controller: Controller, bandwidth: Array) -> Coils:
    """Pump at 9000 rpm with coils of some bandwidths, Hz, the controller unchanged."""
    found = []
    for hertz in bandwidth.tolist():
        machine = replace(MACHINE, magnets=replace(MACHINE.magnets, bandwidth=HERTZ * hertz))
        loop = closed_loop(machine, controller, SPEED)
        edge, poles = margins(loop), loop.poles
        found.append((edge.sensitivity, float((-poles.real / np.abs(poles)).min()), edge.delay))
    return Coils(bandwidth, *np.array(found).T)


def table() -> Table:
    """Margins over the bandwidth of the coils."""
    both, rows = [slow_coils(controller, np.array(TOLD)) for controller in controllers()], []
    for k, hertz in enumerate(TOLD):
        cells = [f"{hertz:g} Hz"]
        for coils in both:
            lost = math.isnan(coils.sensitivity[k])
            cells += ["not stable" if lost else f"{coils.sensitivity[k]:.2f}", f"{coils.damping[k]:.3f}"]
        rows.append(tuple(cells))
    head = ("synergetic: sensitivity", "least damping", "PID: sensitivity", "least damping")
    return Table(("bandwidth", *head), tuple(rows))


def coils_figure() -> Figure:
    """Sensitivity and damping over the bandwidth of the coils."""
    text = (
        "Blood pump at 9000 rpm: largest sensitivity and least damping ratio over the bandwidth "
        "of coils and amplifiers, controllers unchanged. The source's controller is made for coils that "
        "follow at once. Magnets, bias current and PID control are assumed."
    )
    with page([1.7, 1.4], text, top=0.12) as (figure, [[above], [below]]):
        for controller in controllers():
            coils = slow_coils(controller, BANDWIDTHS)
            above.plot(1e-3 * BANDWIDTHS, coils.sensitivity, **_LOOKS[controller.name])
            below.plot(1e-3 * BANDWIDTHS, coils.damping, **_LOOKS[controller.name])
        above.axhline(3.0, color="0.25", linewidth=0.8, linestyle=":", label="3, a new machine (ISO 14839-3)")
        below.axhline(0.0, color="0.45", linewidth=0.8)
        logarithmic(above, x=[1.0, 10.0, 100.0, 1000.0], y=[1.0, 10.0, 100.0])
        logarithmic(below, x=[1.0, 10.0, 100.0, 1000.0])
        for axes in (above, below):
            axes.set_xlim(1e-3 * float(BANDWIDTHS[0]), 1e-3 * float(BANDWIDTHS[-1]))
        above.set_ylim(0.9, 100.0)
        above.tick_params(labelbottom=False)
        above.set_ylabel("Largest sensitivity (\N{EN DASH})")
        below.set(ylabel="Least damping ratio (\N{EN DASH})", xlabel="Bandwidth of the coils (kHz)")
    return figure


def trial_figure() -> Figure:
    """Trial of the scene in time and its unbalance response."""
    return magnetic_figure(run_magnetic(example("blood_pump")))


if __name__ == "__main__":
    launch(shown(table, blood_pump=trial_figure, blood_pump_coils=coils_figure))
