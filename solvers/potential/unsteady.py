"""The exact wave in time: rates of change of its surface, the force that it exerts, what it conserves.

On even nodes all round the drum, by Fourier transforms [theory: potential, eq. 16-24]. Lengths over R, times
in 1/Omega, with the spin Omega that the liquid had when it was at rest in its drum. Forces are seen in the
frame that turns at that spin for ever, whatever the drum does later [theory: potential, eq. 24]; with f = 0
volume, energy and angular momentum stay. `solvers.potential.in_time` takes a wave through time.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy import fft

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.potential.steady import SteadyWave
from solvers.potential.strip import moved, nodes

# Waves that products of two may have without aliases, of all.
KEPT = 2.0 / 3.0
LARGE = 350.0  # k K beyond which tanh is 1 and 1/cosh nothing
FEWEST = 16

Push = Callable[[float], complex]


@dataclass(frozen=True)
class Surface:
    """A wave at a time.

    Parameters
    ----------
    height : y = ln(R/r) at even u from 0, shape (n,)
    potential : phi there, shape (n,)
    """

    height: Array
    potential: Array

    def __post_init__(self) -> None:
        n = self.height.size
        if n < FEWEST or n % 2 or self.potential.size != n:
            raise InputError("height", n, f"an even number of nodes from {FEWEST}, as many potentials")

    @property
    def state(self) -> Array:
        """Both in one, shape (2n,)."""
        return np.concatenate((self.height, self.potential))


@dataclass(frozen=True)
class Invariants:
    """What a wave without a force keeps, and its first moments, per unit length and density.

    Parameters
    ----------
    volume, energy, angular_momentum : V, E and L in units of R^2, Omega^2 R^4 and Omega R^4
    centre : V times the centre of mass, complex
    momentum : P, the sum of the velocity, complex
    kinetic : what of E is the motion's
    turning : what of L is the motion's
    rotation : mean over the liquid of its angular velocity, over Omega
    """

    volume: float
    energy: float
    angular_momentum: float
    centre: complex
    momentum: complex
    kinetic: float
    turning: float
    rotation: float


@dataclass(frozen=True)
class Waves:
    """Wave numbers of n even nodes; all but `angle` of shape (n/2 + 1,).

    Parameters
    ----------
    k : wave numbers
    odd : the same without the shortest, which has no sine on even nodes
    angle : u of the nodes, shape (n,)
    kept : how many of the waves rates keep
    short : eighth power of k over the last that is kept, of these
    """

    k: Array
    odd: Array
    angle: Array
    kept: int
    short: Array


@lru_cache(maxsize=16)
def wave_numbers(count: int) -> Waves:
    """Wave numbers of even nodes.

    Parameters
    ----------
    count : n, even
    """
    k = np.arange(count // 2 + 1.0)
    kept = math.floor(KEPT * k[-1]) + 1
    odd = np.concatenate((k[:-1], [0.0]))
    angle = 2.0 * np.pi * np.arange(count) / count
    return Waves(k, odd, angle, kept, (k[:kept] / (KEPT * k[-1])) ** 8)


@dataclass(frozen=True)
class _Flow:
    """Everything at the surface that rates, force and invariants need."""

    waves: Waves
    depth: float
    over: Array
    surface: Complex
    potential: Complex
    radius: Array
    shift: Array
    opened: Array
    steep: Array
    potential_slope: Array
    stream: Array
    stream_slope: Array

    @property
    def angle(self) -> Array:
        """x, the angle in the drum."""
        return np.asarray(self.waves.angle + self.shift)

    @property
    def metric(self) -> Array:
        """r^2 J, the square of |dz/du|."""
        return np.asarray((self.opened * self.opened + self.steep * self.steep) * self.radius * self.radius)


def still(layer: float, count: int) -> Surface:
    """The layer at rest in the drum.

    Parameters
    ----------
    layer : h_0/R
    count : n, even
    """
    if not 0.0 < layer < 1.0:
        raise InputError("layer", layer, "between 0 and 1")
    return Surface(np.full(count, -math.log1p(-layer)), np.zeros(count))


def started(wave: SteadyWave, slip: float, count: int) -> Surface:
    """A steady wave of one crest as it stands in the drum, its deflection along the first direction.

    Parameters
    ----------
    wave : steady, forced or free
    slip : s/Omega, with its sign: one of the wave's two, where the other has the same shape
    count : n, even
    """
    half = moved(wave.at, wave.surface, nodes(count // 2))
    height = np.concatenate((half[:-1], half[:0:-1]))
    # A negative whirl has its crest opposite to the deflection.
    height = np.roll(height, count // 2) if wave.whirl < 0.0 else height
    square = np.exp(-2.0 * height)
    k = np.arange(count // 2 + 1)
    spectrum = np.fft.rfft(0.5 * slip * (square.mean() - square))
    spectrum[1:] *= -1j / np.tanh(np.minimum(k[1:] * height.mean(), LARGE))
    spectrum[0] = spectrum[-1] = 0.0
    return Surface(height, np.fft.irfft(spectrum, count))


def finer(surface: Surface) -> Surface:
    """The same wave on twice as many nodes, every other one of which was there before.

    Parameters
    ----------
    surface : a wave
    """
    n = surface.height.size
    spectrum = fft.rfft(surface.state.reshape(2, n))
    # The shortest wave is a cosine, half of it at each end of the longer spectrum.
    spectrum[:, -1] *= 0.5
    height, potential = 2.0 * fft.irfft(spectrum, 2 * n)
    return Surface(height, potential)


def rates(state: Array, push: complex, damping: float = 0.0, friction: float = 0.0) -> Array:
    """Rates of change of a surface [theory: potential, eq. 16-18].

    Parameters
    ----------
    state : y and phi, shape (2n,)
    push : f, minus the acceleration of the axis, over Omega^2 R
    damping : of the shortest waves that are kept, over Omega; falls with the eighth power of the wave number
    friction : k of a body force -k grad phi on the liquid, over Omega [theory: potential, eq. 22]

    Returns
    -------
    Shape (2n,)
    """
    n = state.size // 2
    flow = _flow(state)
    waves = flow.waves
    metric = flow.metric
    climb = -flow.stream_slope / metric
    slide = fft.irfft(-1j * flow.over * fft.rfft(climb), n)
    # The mean that keeps x - u without one.
    slide -= (flow.opened @ slide - flow.steep @ climb) / n
    both = np.empty((2, n))
    both[0] = flow.steep * slide + flow.opened * climb
    inner = flow.potential_slope * flow.potential_slope - flow.stream_slope * flow.stream_slope
    both[1] = slide * flow.potential_slope - 0.5 * inner / metric + _pull(flow, push)
    change = fft.rfft(both)
    change[:, waves.kept :] = 0.0
    change[1, 0] = 0.0
    if damping > 0.0:
        change[0, : waves.kept] -= damping * waves.short * flow.surface[: waves.kept]
        change[1, : waves.kept] -= damping * waves.short * flow.potential[: waves.kept]
    if friction > 0.0:
        change[1, 1 : waves.kept] -= friction * flow.potential[1 : waves.kept]
    return np.asarray(fft.irfft(change, n).ravel())


def force(state: Array, push: complex, friction: float = 0.0) -> complex:
    """Force on the drum by the pressure on its wall, over density, Omega^2 R^3 [theory: potential, eq. 19].

    Parameters
    ----------
    state, push : as for `rates`
    friction : k as for `rates`; the drum holds the body force that it stands for [theory: potential, eq. 22]
    """
    n = state.size // 2
    flow = _flow(state)
    square = np.square(flow.potential_slope) + np.square(flow.stream_slope)
    above = fft.rfft(-0.5 * square / flow.metric + _pull(flow, push))
    inner = np.minimum(flow.waves.k * flow.depth, LARGE)
    change = fft.irfft(above / np.cosh(inner), n)
    potential, angle, opened = _wall(flow)
    sliding = fft.irfft(1j * flow.waves.odd * potential, n)
    along = push.real * np.cos(angle) + push.imag * np.sin(angle)
    pressure = -change - 0.5 * np.square(sliding / opened) + along
    by_pressure = complex(2.0 * np.pi * np.mean(pressure * np.exp(1j * angle) * opened))
    return by_pressure + friction * _momentum(flow, state[n:]) if friction else by_pressure


def invariants(state: Array) -> Invariants:
    """Volume, energy, angular momentum and first moments [theory: potential, eq. 20].

    Parameters
    ----------
    state : y and phi, shape (2n,)
    """
    n, flow, whole = state.size // 2, _flow(state), 2.0 * np.pi
    square, phi = np.square(flow.radius), state[n:]
    rest = whole * np.mean((1.0 - square * square) * flow.opened)
    swing = np.mean((1.0 - square * flow.radius) / 3.0 * flow.opened * np.exp(1j * flow.angle))
    volume = 0.5 * whole * np.mean((1.0 - square) * flow.opened)
    kinetic = -0.5 * whole * np.mean(phi * flow.stream_slope)
    turning = -whole * np.mean(phi * square * flow.steep)
    return Invariants(
        volume=float(volume),
        energy=float(kinetic - 0.125 * rest),
        angular_momentum=float(turning + 0.25 * rest),
        centre=complex(whole * swing),
        momentum=_momentum(flow, phi),
        kinetic=float(kinetic),
        turning=float(turning),
        rotation=float(-whole * np.mean(phi * flow.steep) / volume),
    )


def node_angles(surface: Surface) -> Array:
    """Angles of the nodes in the frame of the spin, rad, shape (n,).

    Parameters
    ----------
    surface : a wave
    """
    return _flow(surface.state).angle


def depth_at(surface: Surface, theta: Array) -> Array:
    """Depth over R at angles in the frame of the spin, of a surface that does not overhang.

    Parameters
    ----------
    surface : a wave
    theta : angles, rad, shape (m,)

    Returns
    -------
    Shape (m,)
    """
    n = surface.height.size
    flow = _flow(surface.state)
    k = flow.waves.k
    shift = -1j * flow.over * flow.surface
    # From between the nodes; Newton's method then finds the place itself.
    places = np.concatenate((flow.angle, flow.angle[:1] + 2.0 * np.pi))
    u = np.interp(theta, places, np.concatenate((flow.waves.angle, [2.0 * np.pi])), period=2.0 * np.pi)
    for _ in range(6):
        wave = np.exp(1j * np.outer(u, k))
        off = u + _summed(wave, shift, n) - theta
        u -= (np.mod(off + np.pi, 2.0 * np.pi) - np.pi) / (1.0 + _summed(wave, 1j * k * shift, n))
    return np.asarray(-np.expm1(-_summed(np.exp(1j * np.outer(u, k)), flow.surface, n)))


def _summed(wave: Complex, spectrum: Complex, count: int) -> Array:
    """A real function of this spectrum on so many nodes where e^{iku} is `wave`, shape (m, n/2 + 1)."""
    part = wave @ spectrum
    return np.asarray((2.0 * part.real - spectrum[0].real - (wave[:, -1] * spectrum[-1]).real) / count)


def _wall(flow: _Flow) -> tuple[Complex, Array, Array]:
    """At the wall: the potential's spectrum, the angle, x_u."""
    n, k = flow.radius.size, flow.waves.k
    inner = np.minimum(k * flow.depth, LARGE)
    over = np.concatenate(([0.0], 1.0 / np.sinh(inner[1:])))
    angle = flow.waves.angle + fft.irfft(-1j * np.where(flow.waves.odd > 0.0, over, 0.0) * flow.surface, n)
    opened = 1.0 + fft.irfft(k * over * flow.surface, n)
    return flow.potential / np.cosh(inner), angle, opened


def _momentum(flow: _Flow, phi: Array) -> complex:
    """P, from the potential at wall and surface [theory: potential, eq. 21]."""
    potential, angle, opened = _wall(flow)
    at_wall = fft.irfft(potential, phi.size) * np.exp(1j * angle) * opened
    at_surface = phi * flow.radius * np.exp(1j * flow.angle) * (flow.opened + 1j * flow.steep)
    return complex(2.0 * np.pi * np.mean(at_wall - at_surface))


def _flow(state: Array) -> _Flow:
    """From surface and potential all that goes with them [theory: potential, eq. 2-4]."""
    n = state.size // 2
    waves = wave_numbers(n)
    surface, potential = fft.rfft(state.reshape(2, n))
    depth = float(state[:n].mean())
    hollow = np.tanh(np.minimum(waves.k * depth, LARGE))
    over = np.zeros_like(hollow)
    np.divide(1.0, hollow[1:-1], out=over[1:-1])
    # All transforms at once.
    spectra = np.empty((6, waves.k.size), dtype=np.complex128)
    spectra[0] = -1j * over * surface
    spectra[1] = waves.k * over * surface
    spectra[2] = 1j * waves.odd * surface
    spectra[3] = 1j * waves.odd * potential
    spectra[4] = 1j * hollow * potential
    spectra[5] = -waves.k * hollow * potential
    spectra[4, -1] = 0.0
    spectra[1, -1] = waves.k[-1] / hollow[-1] * surface[-1]
    shift, opened, steep, potential_slope, stream, stream_slope = fft.irfft(spectra, n)
    opened += 1.0
    return _Flow(
        *(waves, depth, over, surface, potential, np.exp(-state[:n])),
        *(shift, opened, steep, potential_slope, stream, stream_slope),
    )


def _pull(flow: _Flow, push: complex) -> Array:
    """- 2 psi + r^2/2 + f.x at the surface."""
    found = flow.radius * (0.5 * flow.radius) - 2.0 * flow.stream
    if push:
        angle = flow.angle
        found += flow.radius * (push.real * np.cos(angle) + push.imag * np.sin(angle))
    return np.asarray(found)
