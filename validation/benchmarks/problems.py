"""The problems of the benchmarks, their exact or converged answers, and the errors against them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fluid import kdv
from fluid.exact import TravellingWave, cnoidal_wave
from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw, damping_rate
from fluid.kdv import KdvCoefficients
from fluid.liquid import Liquid
from meshes.arrays import Array, Complex
from meshes.chamber import Chamber
from solvers.liquid_model import Whirl
from solvers.waves.modes import WaveProblem, WaveTerms, wave_split
from solvers.waves.steady import family_problem, solve
from solvers.waves.stepper import Advance, Control, Split, advance_adaptive

# One drum for all: a tenth of its radius is filled, water, a low chamber.
RADIUS, SURFACE, SPIN, HEIGHT = 0.15, 0.135, 40.0, 0.01
WATER = Liquid("water", 1000.0, 1e-6)
# Steady waves: the axis' whirl amplitude, m, and the diffusion, rad^2/s; in a tall chamber less of all.
AMPLITUDE, DIFFUSION = 1.5e-4, 0.05
_TALL_HEIGHT, _TALL_AMPLITUDE, _TALL_DIFFUSION = 0.1, 5e-5, 0.01
# How near to the steady wave the steppers must come, and what of it the transient may take.
WANTED, TRANSIENT = 1e-4, 5e-5
_FINE = 512
# Of the exponential stepper.
METHOD = "krogstad"


def retrograde() -> KdvCoefficients:
    """The family of waves against the spin, whose resonance lies below the spin speed."""
    return kdv.coefficients(RADIUS, SURFACE, SPIN, -1)


def fill() -> Fill:
    """The chamber with its water."""
    return Fill(Chamber(RADIUS, HEIGHT), WATER, math.pi * (RADIUS**2 - SURFACE**2) * HEIGHT)


def spectrum(values: Array, first: float = 0.0) -> Complex:
    """Coefficients of e^{i n xi}, n = 1 ... (points - 1) // 2, of a field on equal steps.

    The mean is left out; `first` is the angle of the first point, rad.
    """
    modes = np.fft.rfft(values, norm="forward")[1 : (values.size + 1) // 2]
    return np.asarray(modes * np.exp(-1j * first * np.arange(1, modes.size + 1)))


def distance(modes: ArrayLike, reference: Complex) -> float:
    """L2 distance of two waves over the size of the second; modes that one of them lacks count as 0."""
    found = np.asarray(modes, dtype=np.complex128)
    size = max(found.size, reference.size)
    gap = np.pad(found, (0, size - found.size)) - np.pad(reference, (0, size - reference.size))
    return float(np.linalg.norm(gap) / np.linalg.norm(reference))


@dataclass(frozen=True)
class SteadyProblem:
    """A steady wave in the frame of the whirl, eta(xi), xi = theta - s t, reached from rest.

    eta_t + (lambda0 - s) eta_xi + alpha eta eta_xi + delta eta_xixixi
        = nu_b eta_xixi - gamma eta - q sin(xi)                            [theory: kdv, eq. 1]
    """

    c: KdvCoefficients  #: the family
    speed: float  #: s, rad/s
    waves: WaveProblem  #: forcing, decay, diffusion

    @property
    def drift(self) -> float:
        """lambda0 - s, rad/s."""
        return self.c.linear_speed - self.speed

    @property
    def constants(self) -> dict[str, float]:
        """Numbers of the equation, as it is told to codes that take it as text."""
        consts = {"c": self.drift, "a": self.c.steepening, "d": self.c.dispersion}
        return consts | {"nu": self.waves.diffusion, "g": self.waves.decay, "q": self.waves.forcing}

    @cached_property
    def exact(self) -> Complex:
        """Modes of the converged wave, on 512 points."""
        wave = solve(self.waves, self.speed, points=_FINE)
        if not wave.converged:
            raise RuntimeError(f"the reference did not converge: {wave.reason}")
        return wave.modes

    @cached_property
    def time(self) -> float:
        """When a wave that starts from rest is within half the wanted error of the steady one, s."""
        return settling_time(self)


def steady_problem(tall: bool = False) -> SteadyProblem:
    """Resonance of the retrograde family, with the laminar friction of water.

    Tall: a chamber ten times as high, whose floor and lid hardly damp, so that the wave settles later.
    """
    c = retrograde()
    speed = c.linear_speed
    if tall:
        return SteadyProblem(c, speed, _forced(c, speed, _TALL_HEIGHT, _TALL_AMPLITUDE, _TALL_DIFFUSION))
    return SteadyProblem(c, speed, _forced(c, speed, HEIGHT, AMPLITUDE, DIFFUSION))


def response_speeds() -> Array:
    """201 whirl speeds across the resonance, rad/s."""
    return np.asarray(retrograde().linear_speed + np.linspace(-3.0, 3.0, 201))


def _forced(
    c: KdvCoefficients, speed: float, height: float, amplitude: float, diffusion: float
) -> WaveProblem:
    """Forcing by q = coupling omega_w^2 w0; decay by the layer's laminar friction on wall, floor and lid."""
    layer, whirl = fill(), Whirl(SPIN, SPIN + speed, amplitude)
    law, coefficient = Friction(FrictionLaw.STOKES).at(layer.liquid.viscosity, whirl.slip, RADIUS)
    area = c.mean_area / RADIUS**2
    rate = damping_rate(law, coefficient, 2.0 * RADIUS / height, layer.depth / RADIUS, area, 0.0)
    gamma = float(kdv.decay(c, rate))
    return family_problem(c, whirl.speed**2 * amplitude, decay=gamma, diffusion=diffusion)


def whirl_split(problem: SteadyProblem, points: int) -> Split:
    """The steady problem as exponential steppers take it, in the drum frame."""
    waves = problem.waves
    terms = WaveTerms(problem.c, False, waves.diffusion, waves.decay, waves.forcing, problem.speed)
    return wave_split(terms, points)


def seen_from_whirl(done: Advance, speed: float, points: int) -> Complex:
    """Modes seen from the whirl; of a run that broke off, nan."""
    if done.status != "finished":
        return np.full(1, complex(math.nan, math.nan))
    n = np.arange(1, (points + 1) // 2)
    return np.asarray(done.spectrum[1 : n.size + 1] / points * np.exp(1j * n * speed * done.time))


def settling_time(
    problem: SteadyProblem, points: int = 96, stretch: float = 0.25, most: float = 1000.0
) -> float:
    """Time after which a wave that starts from rest stays close to the steady one, s.

    It is compared every `stretch` seconds; RuntimeError after `most` seconds.
    """
    split = whirl_split(problem, points)
    state, time = np.zeros(points // 2 + 1, dtype=complex), 0.0
    while time < most:
        done = advance_adaptive(split, state, (time, time + stretch), Control(1e-8), METHOD)
        state, time = done.spectrum, done.time
        if distance(seen_from_whirl(done, problem.speed, points), problem.exact) < TRANSIENT:
            return time
    raise RuntimeError(f"no steady wave after {most:g} s")


@dataclass(frozen=True)
class TravellingProblem:
    """A natural sloshing wave of permanent form that runs for some turns in the frame of long waves."""

    c: KdvCoefficients  #: the family
    wave: TravellingWave  #: exact
    time: float  #: s

    def start(self, theta: Array) -> Array:
        """Field at time 0 at the given angles, m^2."""
        return self.wave.profile(theta)

    @cached_property
    def exact(self) -> Complex:
        """Modes at the end, theta seen in the frame that turns at lambda0."""
        theta = 2.0 * np.pi * np.arange(_FINE) / _FINE
        return spectrum(self.wave.profile(theta + self.c.linear_speed * self.time, self.time))


def travelling_problem(turns: float = 1.0) -> TravellingProblem:
    """A cnoidal wave of three tenths of the layer, for so many turns round the drum."""
    c = retrograde()
    wave = cnoidal_wave(c, 0.3 * c.mean_area)
    return TravellingProblem(c, wave, turns * 2.0 * math.pi / abs(wave.speed))
