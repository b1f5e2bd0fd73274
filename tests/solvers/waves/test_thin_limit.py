"""One family of waves against the long waves it comes from, at resonance, as both get small and thin.

The whirl is scaled so that the one-family problem stays the same: dispersion over steepening and decay over
steepening are held [theory: kdv, eq. 29]. Then the height over the depth goes with the square of the depth,
and so does all that one family leaves out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from fluid import kdv
from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from fluid.long_wave import PADE
from meshes.chamber import Chamber
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import settle
from solvers.waves.modes import WaveProblem
from solvers.waves.steady import family_problem, solve
from tests.mutants import kills

RADIUS, HEIGHT, SPIN = 0.15, 0.01, 40.0
# delta and gamma over sqrt(alpha q): a wave of three and more modes, and only one of it.
DISPERSION, DECAY = 0.1, 1.0
POINTS = 65


@dataclass(frozen=True)
class Case:
    """A layer of one depth whose whirl is at the resonance of one family, with linear friction k."""

    c: kdv.KdvCoefficients
    acceleration: float
    speed: float
    decay: float
    dispersive: bool = True

    @property
    def friction(self) -> float:
        """Coefficient k of the law; the layer at rest feels k h0 R/A0 [theory: long_wave, eq. 9]."""
        depth = self.c.radius - self.c.surface_radius
        rate = self.decay / float(kdv.decay(self.c, 1.0))
        return rate * self.c.mean_area / (self.c.radius * depth)

    @property
    def amplitude(self) -> float:
        """w0, m."""
        return self.acceleration / (SPIN + self.speed) ** 2

    def force_ratio(self, offset: complex) -> complex:
        return complex(kdv.force_ratio(self.c, offset, self.amplitude))

    def problem(self, whitham: bool) -> WaveProblem:
        problem = family_problem(self.c, self.acceleration, whitham, self.decay)
        if self.dispersive:
            return problem
        return replace(problem, frequency=lambda n: n * self.c.linear_speed)


def balanced(depth: float, family: int) -> Case:
    """Depth over the radius; nonlinearity, dispersion, forcing and decay in fixed proportions."""
    c = kdv.coefficients(RADIUS, RADIUS * (1.0 - depth), SPIN, family)
    steepening = abs(c.dispersion) / DISPERSION
    acceleration = steepening**2 / abs(c.steepening * c.coupling)
    return Case(c, acceleration, c.linear_speed - c.dispersion, DECAY * steepening)


def hydraulic(depth: float, family: int, height: float) -> Case:
    """Without dispersion, sqrt(q/alpha)/A0 given; three times the damping, which holds off the bore."""
    c = kdv.coefficients(RADIUS, RADIUS * (1.0 - depth), SPIN, family)
    steepening = abs(c.steepening) * height * c.mean_area
    acceleration = steepening**2 / abs(c.steepening * c.coupling)
    return Case(c, acceleration, c.linear_speed, 3.0 * steepening, dispersive=False)


def one_family(case: Case, whitham: bool = False, points: int = POINTS) -> np.ndarray:
    """eta, m^2, at equal steps from the deflection."""
    wave = solve(case.problem(whitham), case.speed)
    assert wave.converged, wave.reason
    modes = np.concatenate((np.zeros(1), wave.modes, np.zeros(points)))[: points // 2 + 1]
    return np.fft.irfft(modes, points, norm="forward")


def long_waves(case: Case, guess: np.ndarray) -> np.ndarray:
    """eta of the steady answer of both long-wave equations with friction, by Newton's method on all points.

    In the whirl's frame the volume flux -s A + R u L is a constant C, which gives u; what is left is
    -s u' + [B' - y]/R + k h R u/A = 0 with Bernoulli's function B and y of [theory: long_wave, eq. 14].
    Lengths over R, times over 1/Omega.
    """
    c, size = case.c, guess.size
    xi, n = 2.0 * np.pi * np.arange(size) / size, np.arange(size // 2 + 1)
    constant, curved, less = PADE
    derive = np.fft.irfft(1j * n[:, None] * np.fft.rfft(np.eye(size), axis=0), size, axis=0)
    area, s = c.mean_area / RADIUS**2, case.speed / SPIN
    push, k = case.acceleration / (RADIUS * SPIN**2), case.friction / SPIN
    scale = float(np.max(np.abs(guess))) / RADIUS**2

    def slope(f: np.ndarray) -> np.ndarray:
        return np.asarray(1j * n * np.fft.rfft(f))

    def left(x: np.ndarray) -> np.ndarray:
        wet = area + scale * x[:-1]
        surface = np.sqrt(1.0 - 2.0 * wet)
        log = -np.log(surface)
        u = (scale * x[-1] + s * scale * x[:-1]) / log
        head = 0.5 * (u / surface) ** 2 + wet + 2.0 * log * u - surface * push * np.cos(xi)
        gradient = np.fft.irfft(slope(head), size)
        reach = wet * np.square(log) * case.dispersive
        bend = derive @ (derive @ (head - 0.5 * np.square(u / surface))) + 2.0 * np.square(derive @ u)
        implicit = constant * np.diag(wet) - curved * derive @ (reach[:, None] * derive)
        missing = np.linalg.solve(implicit, -less * derive @ (reach * bend))
        force = gradient - np.fft.irfft(s * slope(u), size) - missing + k * (1.0 - surface) / wet * u
        return np.append(force / (scale * k), np.mean(x[:-1]))

    x = np.append(guess / (scale * RADIUS**2), 0.0)
    for _ in range(12):
        rest = left(x)
        step = 1e-7 * np.eye(x.size)
        jacobian = np.array([(left(x + e) - left(x - e)) / 2e-7 for e in step]).T
        change = np.linalg.solve(jacobian, -rest)
        x = x + change
        if np.max(np.abs(change)) < 1e-7:
            return np.asarray(x[:-1] * scale * RADIUS**2)
    raise AssertionError(f"the long waves did not settle: {np.max(np.abs(change)):.1e}")


def offset(case: Case, eta: np.ndarray) -> complex:
    """Of the centre of mass, m: the first moment, without neglect."""
    angle = np.exp(2j * np.pi * np.arange(eta.size) / eta.size)
    surface = np.sqrt(RADIUS**2 - 2.0 * (case.c.mean_area + eta))
    return complex(np.sum((RADIUS**3 - surface**3) / 3.0 * angle) / np.sum(case.c.mean_area + eta))


def gaps(case: Case, whitham: bool = False) -> tuple[float, float, float]:
    """Relative differences of force ratio and profile, and the height over A0."""
    one = one_family(case, whitham)
    both = long_waves(case, one)
    exact = case.force_ratio(offset(case, both))
    found = case.force_ratio(complex(kdv.offset(case.c, one)))
    tall = float(np.max(np.abs(both)))
    return abs(found - exact) / abs(exact), float(np.max(np.abs(one - both))) / tall, tall / case.c.mean_area


def settled(case: Case, cells: int) -> tuple[complex, np.ndarray]:
    """Force ratio and first modes of the long waves in time, on finite volumes."""
    c, surface = case.c, case.c.surface_radius
    fill = Fill(
        Chamber(RADIUS, HEIGHT), Liquid("any", 1000.0, 1e-6), math.pi * (RADIUS**2 - surface**2) * HEIGHT
    )
    whirl = Whirl(SPIN, SPIN + case.speed, case.amplitude, ramp=2.0 / case.decay)
    history = settle(fill, whirl, Friction("linear", case.friction), Numerics(cells, case.dispersive))
    assert history.converged
    eta = 0.5 * (RADIUS**2 - np.square(RADIUS - history.depth)) - c.mean_area
    turns = np.exp(-1j * np.outer(np.arange(1, 9), history.theta))
    return complex(history.force_ratio[-1]), np.mean(turns * eta, axis=1)


@kills("fluid.kdv:coefficients", "3.0 * spin / surface_radius**2", "3.0 * spin / radius**2")
@kills("fluid.kdv:coefficients", "log * surface_radius / (2.0", "log * radius / (2.0")
@kills("fluid.kdv:decay", "k * abs(c.linear_speed) /", "0.5 * k + 0.0 * abs(c.linear_speed) /")
@kills("fluid.kdv:coefficients", "spin * log**3 / 3.0 * share", "spin * log**3 * (1.0 + log) / 3.0 * share")
@kills("fluid.kdv:offset", "c.surface_radius / c.mean_area * first", "c.radius / c.mean_area * first")
def test_gap_goes_with_the_height() -> None:
    """The height over the depth goes with the square of the depth, and the gap with the height."""
    for family in (1, -1):
        for whitham in (False, True):
            found = np.array([gaps(balanced(depth, family), whitham) for depth in (0.1, 0.05, 0.025)])
            exponents = np.log2(found[:-1] / found[1:])
            # The next order is a depth of a twentieth, in both.
            assert np.all(np.abs(exponents - 2.0) < 0.25), exponents
            assert np.all(np.abs(exponents[1] - 2.0) < 0.15), exponents
            # Half of what Whitham leaves out is that the dispersion goes with the depth of the place.
            assert found[-1, 0] < 5e-4 and found[-1, 1] < 2e-3


def test_thinness_alone_closes_no_gap() -> None:
    """Without dispersion, at one height over the depth: the gap is that height's, whatever the depth."""
    tall, thin, low = (gaps(hydraulic(*x)) for x in ((0.1, 1, 0.02), (0.025, 1, 0.02), (0.025, 1, 0.01)))
    assert tall[0] == pytest.approx(thin[0], rel=0.05)
    assert thin[0] / low[0] == pytest.approx(2.0, rel=0.02)
    assert thin[1] / low[1] == pytest.approx(2.0, rel=0.02)


def test_time_stepping_settles_there() -> None:
    """The same layer in time comes to the steady long waves as its cells shrink: their gap is the model's."""
    case = balanced(0.2, 1)
    one = one_family(case)
    both = long_waves(case, one)
    exact = case.force_ratio(offset(case, both))
    modes = np.fft.rfft(both, norm="forward")[1:9]
    found = [settled(case, cells) for cells in (64, 128)]
    force = [abs(ratio - exact) / abs(exact) for ratio, _ in found]
    shape = [float(np.linalg.norm(v - modes) / np.linalg.norm(modes)) for _, v in found]
    # Of second order; settling leaves 1e-4.
    assert force[0] / force[1] > 3.0 and shape[0] / shape[1] > 3.0
    family = case.force_ratio(complex(kdv.offset(case.c, one)))
    model = abs(family - exact) / abs(exact)
    # Extrapolated, the gap seen in time is the model's: a fifth of it is the grid's.
    limit = (4.0 * found[1][0] - found[0][0]) / 3.0
    assert abs(limit - exact) < abs(exact) * model / 4.0
    assert abs(family - limit) / abs(limit) == pytest.approx(model, rel=0.25)


@pytest.mark.slow
@pytest.mark.parametrize("family", [1, -1], ids=["prograde", "retrograde"])
def test_gap_in_time(family: int) -> None:
    """Time stepping alone, extrapolated from two grids: the exponent once more."""
    found = []
    for depth, cells in ((0.2, 128), (0.1, 256)):
        case = balanced(depth, family)
        one = case.force_ratio(complex(kdv.offset(case.c, one_family(case))))
        coarse, fine = (settled(case, n)[0] for n in (cells, 2 * cells))
        limit = (4.0 * fine - coarse) / 3.0
        found.append(abs(one - limit) / abs(limit))
    # What the grids leave is a twentieth of the gaps.
    assert math.log2(found[0] / found[1]) == pytest.approx(2.0, abs=0.3)


@pytest.mark.slow
def test_gap_of_bores() -> None:
    """Without dispersion and with little damping: a bore, whose force gap goes with the height as well."""
    found = []
    for depth in (0.2, 0.1, 0.05):
        case = hydraulic(depth, 1, 0.5 * depth)
        scale = case.decay / 3.0
        case = replace(case, decay=0.5 * scale)
        ratios = []
        for diffusion in (0.02, 0.01):
            wave = solve(replace(case.problem(False), diffusion=diffusion * scale), case.speed)
            assert wave.converged
            ratios.append(
                case.force_ratio(complex(kdv.offset(case.c, wave.profile(2 * wave.modes.size + 2))))
            )
        one = 2.0 * ratios[1] - ratios[0]
        coarse, fine = (settled(case, cells)[0] for cells in (128, 256))
        limit = 2.0 * fine - coarse
        found.append(abs(one - limit) / abs(limit))
    exponents = np.log2(np.array(found[:-1]) / np.array(found[1:]))
    assert exponents == pytest.approx(1.0, abs=0.15)
