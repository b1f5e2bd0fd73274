"""Shallow water and KdV-Burgers by py-pde: natural waves, steepening, decay, and layers under a whirl.

A layer of water on the wall of a drum of 150 mm at 40 rad/s, mostly a tenth of the radius deep, which carries
waves against the spin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from fluid import kdv
from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.liquid import known_liquid
from fluid.waves import free_wave_frequencies
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.layer.state import Numerics
from solvers.liquid_model import LiquidWave, Whirl
from solvers.pypde.grid import circle
from solvers.pypde.long_wave import AnnularLongWavePDE
from solvers.pypde.models import LongWave, OneFamily
from solvers.pypde.one_family import KdvBurgersPDE
from validation.page import Figure, page

SPIN, RADIUS, DEPTH = 40.0, 0.15, 0.1  # rad/s, m, over the radius
CRESTS = (1, 2, 3, 4)
FREE_DEPTH = 0.2  # at which dispersion shows in the first waves
FRICTION = 2.0  # 1/s, of driven layers
#: whirl speed, rad/s, and w0/h0: next to the natural wave at 30.58 rad/s, in a bore there, and far from it
WHIRLS = {"next to it, small": (30.58, 0.01), "next to it, a bore": (30.0, 0.05), "far from it": (34.0, 0.05)}
_SMALL, _TALL = 1e-5, 0.02  # of the mean area: a wave that is linear, one that steepens
_CELLS = 256
_SHALLOW = {"color": "#D55E00", "linewidth": 1.4, "label": "shallow water"}
_FAMILY = {"color": "#0072B2", "linewidth": 1.4, "linestyle": (0, (5, 1.5)), "label": "KdV-Burgers"}


def layer(depth: float = DEPTH) -> Fill:
    """Water on the wall."""
    chamber = Chamber(RADIUS, 0.05)
    return Fill(chamber, known_liquid("water"), (1.0 - (1.0 - depth) ** 2) * chamber.capacity)


def coefficients(depth: float = DEPTH) -> kdv.KdvCoefficients:
    """Of the family against the spin."""
    return kdv.coefficients(RADIUS, RADIUS * (1.0 - depth), SPIN, -1)


def by_family(start: Array, time: float, depth: float, decay: float = 0.0, diffusion: float = 0.0) -> Array:
    """Change of the area, m^2, after a time of KdV-Burgers from a first one, by py-pde's solve."""
    equation = KdvBurgersPDE(coefficients(depth), damping=decay, viscosity=diffusion)
    end = equation.solve(equation.start(circle(start.size), start), time, tracker=None, solver="exponential")
    return np.asarray(end.data)


def by_shallow_water(
    start: Array, time: float, depth: float, dispersion: bool, friction: Friction = NO_FRICTION
) -> Array:
    """The same by nonlinear long waves, their flow at first that of the family against the spin."""
    fill, c = layer(depth), coefficients(depth)
    equation = AnnularLongWavePDE(fill, Whirl(SPIN, SPIN, 0.0, 0.0), friction=friction, dispersion=dispersion)
    grid = circle(start.size)
    area = c.mean_area + start
    surface = np.sqrt(RADIUS**2 - 2.0 * area)
    state = equation.start(grid, RADIUS - surface, simple_wave(c, start))
    end = equation.solve(state, time, tracker=None, solver="finite_volume")
    return np.asarray(end.data[0]) - c.mean_area


def simple_wave(c: kdv.KdvCoefficients, change: Array) -> Array:
    """Velocity along the wall, m/s, of a wave of one family by its change of area [theory: kdv, eq. 6-7]."""
    top = float(np.abs(change).max())

    def slope(rise: float, velocity: float) -> float:
        surface = math.sqrt(c.surface_radius**2 - 2.0 * rise)
        log, turning = math.log(c.radius / surface), velocity * c.radius / surface**2
        root = math.sqrt((c.spin * log) ** 2 + log * (c.spin + turning) ** 2)
        return (c.spin * log + c.family * root) / (c.radius * log)

    both = []
    for way in (-top, top):
        step, rows = way / 50.0, [0.0]
        for k in range(50):  # the midpoint rule
            half = rows[-1] + 0.5 * step * slope(k * step, rows[-1])
            rows.append(rows[-1] + step * slope((k + 0.5) * step, half))
        both.append(rows)
    at = np.linspace(-top, top, 101)
    return np.asarray(np.interp(change, at, np.array([*both[0][:0:-1], *both[1]])))


def mode(change: Array, crests: int) -> complex:
    """Fourier coefficient of so many crests."""
    angle = 2.0 * math.pi * (np.arange(change.size) + 0.5) / change.size
    return complex(np.mean(change * np.exp(-1j * crests * angle)))


def cosine(crests: int, share: float, depth: float, points: int = _CELLS) -> Array:
    """A wave of so many crests, its height as a share of the mean area, at the middles of cells."""
    angle = 2.0 * math.pi * (np.arange(points) + 0.5) / points
    return coefficients(depth).mean_area * share * np.cos(crests * angle)


@cache
def frequencies(crests: int, depth: float = FREE_DEPTH) -> dict[str, float]:
    """Frequency of a small natural wave, rad/s: exact, KdV, shallow water with and without dispersion."""
    start = cosine(crests, _SMALL, depth)
    time = 1.0 / (crests * SPIN * 0.3)
    found = {"exact": float(free_wave_frequencies(crests, coefficients(depth).layer_log, SPIN)[1])}
    ends = {
        "KdV": by_family(start, time, depth),
        "dispersion": by_shallow_water(start, time, depth, True),
        "shallow water": by_shallow_water(start, time, depth, False),
    }
    for name, end in ends.items():
        turned = np.angle(mode(end, crests) / mode(start, crests))
        found[name] = -float(turned) / time
    return found


def lag(crests: int, name: str) -> float:
    """By how much a wave lags behind long waves, over what the exact one does; without dispersion 0."""
    found, fast = frequencies(crests), crests * coefficients(FREE_DEPTH).linear_speed
    return (fast - found[name]) / (fast - found["exact"])


@cache
def steepening() -> tuple[float, float, float]:
    """Rate at which a wave of one crest makes its second harmonic, m^2/s: by hand, KdV, shallow water."""
    start, time = cosine(1, _TALL, DEPTH), 0.05
    c, first = coefficients(), abs(mode(cosine(1, _TALL, DEPTH), 1))
    # v_2' = -i alpha v_1^2, as long as it is small; of both in one frame.
    ends = by_family(start, time, DEPTH), by_shallow_water(start, time, DEPTH, True)
    one, other = (abs(mode(end, 2)) / time for end in ends)
    return abs(c.steepening) * first**2, one, other


@cache
def decays() -> dict[str, tuple[float, float]]:
    """Rates of decay of a small wave of two crests, 1/s: by hand and as solved."""
    start, time, c = cosine(2, _SMALL, DEPTH), 0.3, coefficients()
    rate = FRICTION * DEPTH / (c.mean_area / RADIUS**2)  # tau R/(rho u A) of the layer
    gamma = float(kdv.decay(c, rate))
    share = math.log(RADIUS / c.surface_radius)
    by_hand = rate * 0.5 * (1.0 - math.sqrt(share / (1.0 + share)))  # k |lambda_0|/(2 S)

    def seen(end: Array) -> float:
        return -math.log(abs(mode(end, 2)) / abs(mode(start, 2))) / time

    rubbed = Friction(FrictionLaw.LINEAR, FRICTION)
    return {
        "KdV-Burgers, friction": (by_hand, seen(by_family(start, time, DEPTH, decay=gamma))),
        "KdV-Burgers, diffusion": (4.0 * 0.5, seen(by_family(start, time, DEPTH, diffusion=0.5))),
        "shallow water, friction": (by_hand, seen(by_shallow_water(start, time, DEPTH, True, rubbed))),
    }


@dataclass(frozen=True)
class Driven:
    """A layer under a whirl by both."""

    family: LiquidWave
    shallow: LiquidWave
    forces: tuple[complex, complex]  #: G of them
    linear: complex  #: G of a small whirl by exact theory, without friction

    @property
    def apart(self) -> float:
        """Distance of the forces over that of shallow water, or of a full drum where it is smaller."""
        one, other = self.forces
        return abs(one - other) / max(1.0, abs(other))


@cache
def driven(speed: float, share: float) -> Driven:
    """Settled answers with friction; whirl speed, rad/s, w0 over h0."""
    fill, friction = layer(), Friction(FrictionLaw.LINEAR, FRICTION)
    whirl = Whirl(SPIN, speed, share * fill.depth, 0.0)
    models: tuple[Any, Any] = OneFamily(friction), LongWave(friction, Numerics(128, dispersion=True))
    one, other = (model.wave(fill, whirl) for model in models)
    unit = fill.full_mass * whirl.amplitude
    kappa, slip = (1.0 - DEPTH) ** -2, speed - SPIN
    linear = 1.0 - 2.0 * slip**2 / ((1.0 - kappa) * speed**2 + 2.0 * kappa * slip**2)
    forces = complex(one.answer.unbalance[0]) / unit, complex(other.answer.unbalance[0]) / unit
    return Driven(one, other, forces, complex(linear))


def family_share() -> float:
    """Share that one family has of the liquid's offset in a synchronous whirl, by py-pde's steady wave."""
    fill = layer()
    wave = OneFamily().wave(fill, Whirl(SPIN, SPIN, 1e-3 * fill.depth, 0.0))
    exact = 1e-3 * fill.depth / ((1.0 - DEPTH) ** -2 - 1.0)
    return float(wave.answer.offset[0].real) / exact


def resonance() -> tuple[Array, Array, Array]:
    """Whirl speeds through the resonance, rad/s, and G of both at w0 = h0/50."""
    speeds = np.array([28.0, 29.0, 29.75, 30.25, 30.75, 31.25, 32.0, 33.5])
    found = [driven(speed, 0.02).forces for speed in speeds.tolist()]
    one, other = np.array(found).T
    return speeds, one, other


def waves_figure() -> Figure:
    """The layer's depth round the drum under three whirls."""
    text = (
        "Depth over the angle from the deflection, positive with the spin: layer of a tenth of the radius "
        "of 150 mm, 40 rad/s, linear friction of 2 1/s. Shallow water with dispersion, settled; KdV-Burgers "
        "with the lag of the liquid. The natural wave against the spin has 30.58 rad/s in space."
    )
    with page([1.45] * len(WHIRLS), text) as (figure, rows):
        for [axes], (name, whirl) in zip(rows, WHIRLS.items(), strict=True):
            found = driven(*whirl)
            for wave, look in ((found.shallow, _SHALLOW), (found.family, _FAMILY)):
                axes.plot(np.degrees(wave.theta), 1e3 * wave.depth, **look)
            axes.axhline(1e3 * layer().depth, color="0.6", linewidth=0.6)
            axes.set(xlim=(-180.0, 180.0), ylabel="Depth (mm)")
            axes.set_xticks(np.arange(-180.0, 181.0, 60.0))
            words = f"{name}: {whirl[0]:g} rad/s, whirl of {whirl[1]:g} of the depth"
            apart = f"forces {100.0 * found.apart:.2g} % apart"
            axes.text(0.012, 0.95, f"{words}\n{apart}", transform=axes.transAxes, va="top", fontsize="small")
            axes.margins(y=0.2)
            axes.tick_params(labelbottom=axes is rows[-1][0])
        rows[-1][0].set_xlabel("Angle from the deflection (\N{DEGREE SIGN})")
    return figure


def resonance_figure() -> Figure:
    """Force along and ahead of the deflection through the resonance."""
    text = (
        "Force over that of a full drum, along the deflection and 90 degrees ahead, for a whirl of a "
        "fiftieth of the depth; else as before. Grey: exact linear theory without friction, which has no "
        "bound at the natural wave."
    )
    speeds, one, other = resonance()
    with page([1.6, 1.6], text) as (figure, rows):
        fine = np.linspace(speeds[0], speeds[-1], 400)
        kappa = (1.0 - DEPTH) ** -2
        line = 1.0 - 2.0 * (fine - SPIN) ** 2 / ((1.0 - kappa) * fine**2 + 2.0 * kappa * (fine - SPIN) ** 2)
        rows[0][0].plot(fine, np.where(np.abs(line) < 6.0, line, np.nan), color="0.6", linewidth=0.8)
        labels = ("Along (\N{EN DASH})", "90\N{DEGREE SIGN} ahead (\N{EN DASH})")
        for [axes], name, part in zip(rows, labels, (np.real, np.imag), strict=True):
            axes.plot(speeds, part(other), marker="o", markersize=3.5, **_SHALLOW)
            axes.plot(speeds, part(one), marker="x", markersize=4.5, **_FAMILY)
            axes.set(xlim=(speeds[0], speeds[-1]), ylabel=name)
            axes.tick_params(labelbottom=axes is rows[-1][0])
        rows[-1][0].set_xlabel("Whirl speed in space (rad/s)")
    return figure
