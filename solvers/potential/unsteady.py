"""The nonlinear wave in time: rates of change of its surface, the force that it exerts, what it conserves.

A state is y and phi on n even nodes all round the drum, n even, shape (2n,); by Fourier transforms
[theory: potential, eq. 16-27]. Lengths over R, times in 1/Omega, with the spin Omega that the liquid had when
it was at rest in its drum. Forces are seen in the frame that turns at that spin for ever, whatever the drum
does later [theory: potential, eq. 24]; with f = 0 volume, energy and angular momentum stay.
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
# What counts as the largest wave at least, over the depth.
_LEAST = 1e-3
_ROUNDS, _SETTLED = 200, 1e-14  # of the angles of a surface of a given shape

Push = Callable[[float], complex]


@dataclass(frozen=True)
class Surface:
    """A wave at a time."""

    height: Array  #: y = ln(R/r) at even u from 0, shape (n,)
    potential: Array  #: phi there, shape (n,)

    def __post_init__(self) -> None:
        n = self.height.size
        if n < FEWEST or n % 2 or self.potential.size != n:
            raise InputError("height", n, f"an even number of nodes from {FEWEST}, as many potentials")

    @property
    def state(self) -> Array:
        """Height and potential in one, shape (2n,)."""
        return np.concatenate((self.height, self.potential))


@dataclass(frozen=True)
class Invariants:
    """What a wave without a force keeps, and its first moments, per unit length and density."""

    volume: float  #: V, E and L in units of R^2, Omega^2 R^4 and Omega R^4
    energy: float
    angular_momentum: float
    centre: complex  #: V times the centre of mass, complex
    momentum: complex  #: P, the sum of the velocity, complex
    kinetic: float  #: what of E is the motion's
    turning: float  #: what of L is the motion's
    rotation: float  #: mean over the liquid of its angular velocity, over Omega


@dataclass(frozen=True)
class Waves:
    """Wave numbers of n even nodes; arrays but `angle` of shape (n/2 + 1,)."""

    k: Array  #: wave numbers
    odd: Array  #: the same without the shortest, which has no sine on even nodes
    angle: Array  #: u of the nodes, shape (n,)
    kept: int  #: how many of the waves rates keep
    short: Array  #: eighth power of k over the last that is kept


@lru_cache(maxsize=16)
def wave_numbers(count: int) -> Waves:
    """Wave numbers of even nodes."""
    k = np.arange(count // 2 + 1.0)
    kept = math.floor(KEPT * k[-1]) + 1
    odd = np.concatenate((k[:-1], [0.0]))
    angle = 2.0 * np.pi * np.arange(count) / count
    return Waves(k, odd, angle, kept, (k / (KEPT * k[-1])) ** 8)


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
    """The layer at rest in the drum."""
    if not 0.0 < layer < 1.0:
        raise InputError("layer", layer, "between 0 and 1")
    return Surface(np.full(count, -math.log1p(-layer)), np.zeros(count))


def started(wave: SteadyWave, slip: float, count: int) -> Surface:
    """A steady wave of one crest as it stands in the drum, its deflection along the first direction.

    The slip s/Omega is one of the wave's two, with its sign.
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


def rates(state: Array, push: complex, damping: float = 0.0, friction: float = 0.0) -> Array:
    """Rates of change of a surface, shape (2n,) [theory: potential, eq. 16-18].

    `push` is f, minus the acceleration of the axis, over Omega^2 R; `damping` that of the shortest waves that
    are kept, over Omega, falling with the eighth power of the wave number; `friction` k of a body force -k
    grad phi on the liquid, over Omega [theory: potential, eq. 22].
    """
    flow = _flow(state)
    change = _moved(flow, 1.0)
    if push:
        change[1] += flow.radius * (push.real * np.cos(flow.angle) + push.imag * np.sin(flow.angle))
    spectra = _limited(fft.rfft(change), flow, damping, friction)
    return np.asarray(fft.irfft(spectra, state.size // 2).ravel())


def _moved(flow: _Flow, spin: float) -> Array:
    """Rates of y and phi without f or friction, shape (2, n) [theory: potential, eq. 16-18]."""
    n, metric = flow.radius.size, flow.metric
    climb = -flow.stream_slope / metric
    slide = fft.irfft(-1j * flow.over * fft.rfft(climb), n)
    # The mean that keeps x - u without one.
    slide -= (flow.opened @ slide - flow.steep @ climb) / n
    found = np.empty((2, n))
    found[0] = flow.steep * slide + flow.opened * climb
    inner = flow.potential_slope * flow.potential_slope - flow.stream_slope * flow.stream_slope
    found[1] = slide * flow.potential_slope - 0.5 * inner / metric + _field(flow, spin)
    return found


def _fixed(flow: _Flow, spin: float) -> Array:
    """Rate of phi at a fixed place of the surface without f, shape (n,)."""
    square = flow.potential_slope * flow.potential_slope + flow.stream_slope * flow.stream_slope
    return np.asarray(-0.5 * square / flow.metric + _field(flow, spin))


def _field(flow: _Flow, spin: float) -> Array:
    """- 2 psi + r^2/2 at the surface."""
    return np.asarray(0.5 * spin**2 * flow.radius * flow.radius - 2.0 * spin * flow.stream)


def _limited(spectra: Complex, flow: _Flow, damping: float, friction: float) -> Complex:
    """Rates of y, phi and any more of phi as waves, in place: those that are kept, damped."""
    kept = flow.waves.kept
    spectra[:, kept:] = 0.0
    spectra[1:, 0] = 0.0
    if damping > 0.0:
        # Those beyond that a surface may have begun with as well: they would stay for ever.
        spectra[0] -= damping * flow.waves.short * flow.surface
        spectra[1] -= damping * flow.waves.short * flow.potential
    if friction > 0.0:
        spectra[1, 1:kept] -= friction * flow.potential[1:kept]
    return spectra


def force(state: Array, push: complex, friction: float = 0.0) -> complex:
    """Force on the drum by the pressure on its wall, over density, Omega^2 R^3 [theory: potential, eq. 19].

    The drum holds the body force that friction stands for [theory: potential, eq. 22].
    """
    flow = _flow(state)
    along = flow.radius * (push.real * np.cos(flow.angle) + push.imag * np.sin(flow.angle))
    by_pressure = _wall_force(flow, fft.rfft(_fixed(flow, 1.0) + along), push)
    return by_pressure + friction * _momentum(flow) if friction else by_pressure


def _wall_force(flow: _Flow, above: Complex, push: complex) -> complex:
    """Sum of the pressure on the wall; `above`: coefficients of the rate of phi at the surface."""
    n, k = flow.radius.size, flow.waves.k
    inner = np.minimum(k * flow.depth, LARGE)
    near, over = 1.0 / np.cosh(inner), np.concatenate(([0.0], 1.0 / np.sinh(inner[1:-1]), [0.0]))
    parts = np.stack(
        (above * near, 1j * flow.waves.odd * flow.potential * near, -1j * over * flow.surface,
         k * over * flow.surface)
    )  # fmt: skip
    change, sliding, shift, opened = fft.irfft(parts, n)
    opened += 1.0
    angle = flow.waves.angle + shift
    along = push.real * np.cos(angle) + push.imag * np.sin(angle)
    pressure = -change - 0.5 * np.square(sliding / opened) + along
    return complex(2.0 * np.pi / n * ((pressure * opened) @ np.exp(1j * angle)))


def _momentum(flow: _Flow) -> complex:
    """P, the rate of change of V times the centre of mass [theory: potential, eq. 21]."""
    ray = flow.radius * np.exp(1j * flow.angle)
    return complex(-2.0 * np.pi * np.mean(ray * flow.stream_slope))


@dataclass(frozen=True)
class Answer:
    """What a layer does under any force: its rates and its own force are linear in f."""

    still: Array  #: rates without f, shape (2n,)
    lever: Array  #: rates of phi for f = 1 and f = i, shape (2, n)
    force: complex  #: on the drum by the pressure without f, complex
    response: Array  #: symmetric matrix that f adds to it with, shape (2, 2)
    momentum: complex  #: P, the liquid's in its frame, complex
    moment: complex  #: V times the centre of mass, complex

    def rates(self, push: complex) -> Array:
        """Rates under a force f, shape (2n,)."""
        found = self.still.copy()
        found[self.lever.shape[1] :] += push.real * self.lever[0] + push.imag * self.lever[1]
        return found


def answer(state: Array, spin: float = 1.0, friction: float = 0.0, damping: float = 0.0) -> Answer:
    """Rates and force of a layer under any force at once [theory: potential, eq. 25-27].

    Friction turns the drum's pressure by nothing; `spin` is that of the frame in which the flow has no
    vorticity, over the unit of the spin.
    """
    n, flow, whole = state.size // 2, _flow(state), 2.0 * np.pi
    arms = flow.radius * np.stack((np.cos(flow.angle), np.sin(flow.angle)))
    spectra = fft.rfft(np.concatenate((_moved(flow, spin), arms, _fixed(flow, spin)[None])))
    # Twice the share of a pair of waves; the mean and the shortest have one each.
    pairs = np.full(flow.waves.k.size, 2.0 * whole / n**2)
    pairs[[0, -1]] *= 0.5
    weight = pairs * flow.waves.k * np.tanh(np.minimum(flow.waves.k * flow.depth, LARGE))
    moved = np.real(spectra[2:4, None] * spectra[None, 2:4].conj()) @ weight
    square = flow.radius * flow.radius
    volume = 0.5 * whole / n * ((1.0 - square) @ flow.opened)
    outward = _wall_force(flow, spectra[4], 0j)
    found = fft.irfft(_limited(spectra[:4], flow, damping, friction), n)
    return Answer(
        still=found[:2].ravel(),
        lever=found[2:],
        force=outward,
        response=volume * np.eye(2) - moved,
        momentum=_momentum(flow),
        moment=_moment(flow),
    )


def _moment(flow: _Flow) -> complex:
    """V times the centre of mass [theory: potential, eq. 20]."""
    third = (1.0 - flow.radius * flow.radius * flow.radius) / 3.0
    return complex(2.0 * np.pi * np.mean(third * flow.opened * np.exp(1j * flow.angle)))


def invariants(state: Array, spin: float = 1.0) -> Invariants:
    """Volume, energy, angular momentum and first moments [theory: potential, eq. 20].

    `spin` is that of the frame in which the flow has no vorticity, over the unit of the spin; 0 leaves phi
    alone.
    """
    n, flow, whole = state.size // 2, _flow(state), 2.0 * np.pi
    square, phi = np.square(flow.radius), state[n:]
    rest = whole * np.mean((1.0 - square * square) * flow.opened)
    volume = 0.5 * whole * np.mean((1.0 - square) * flow.opened)
    kinetic = -0.5 * whole * np.mean(phi * flow.stream_slope)
    turning = -whole * np.mean(phi * square * flow.steep)
    return Invariants(
        volume=float(volume),
        energy=float(kinetic - 0.125 * spin**2 * rest),
        angular_momentum=float(turning + 0.25 * spin * rest),
        centre=_moment(flow),
        momentum=_momentum(flow),
        kinetic=float(kinetic),
        turning=float(turning),
        rotation=float(-whole * np.mean(phi * flow.steep) / volume),
    )


def laid(radius: Callable[[Array], Array], count: int) -> Surface:
    """Liquid at rest in the drum under a surface of a given shape [theory: potential, eq. 2].

    `radius` of the surface over R, between 0 and 1, at angles; its waves are lower than the layer is deep. An
    `ArithmeticError` where it is too steep for these nodes.
    """
    angle = wave_numbers(count).angle
    for _ in range(_ROUNDS):
        height = -np.log(radius(angle))
        before, angle = angle, node_angles(np.concatenate((height, np.zeros(count))))
        if np.abs(angle - before).max() < _SETTLED:
            return Surface(height, np.zeros(count))
    raise ArithmeticError(f"no strip with {count} nodes for this surface")


def levelled(state: Array, volume: float) -> Array:
    """The same surface, moved out or in until it holds a volume over R^2, shape (2n,).

    An `ArithmeticError` where there is no such surface near by.
    """
    found, n = state.copy(), state.size // 2
    for _ in range(_ROUNDS):
        flow = _flow(found)
        gap = volume - np.pi * np.mean((1.0 - np.square(flow.radius)) * flow.opened)
        found[:n] += gap / (2.0 * np.pi * np.mean(np.square(flow.radius)))
        if abs(gap) < _SETTLED:
            return found
    raise ArithmeticError(f"no surface like this one holds {volume:g}")


def tail(state: Array, layer: float) -> float:
    """Size of the shortest waves that are kept, over that of the largest: k |Y_k| and k |phi_k|.

    Waves below a thousandth of the layer h_0/R count as that high: a layer at rest has none.
    """
    n = state.size // 2
    kept = wave_numbers(n).kept
    sizes = np.arange(kept) * np.abs(fft.rfft(state.reshape(2, n))[:, :kept]) * 2.0 / n
    last = sizes[:, -(kept // 10 + 1) :].max(axis=1)
    return float((last / np.maximum(sizes.max(axis=1), _LEAST * layer)).max())


def resampled(state: Array, count: int) -> Array:
    """The same waves on another number of nodes, the shortest left out where they are fewer."""
    n = state.size // 2
    spectra = fft.rfft(state.reshape(2, n)) * (count / n)
    whole = np.zeros((2, count // 2 + 1), dtype=complex)
    kept = min(n, count) // 2
    whole[:, :kept] = spectra[:, :kept]
    # The shortest wave is a cosine, half of it at each end of a longer spectrum.
    whole[:, kept] = spectra[:, kept].real * (0.5 if count > n else 1.0 if count == n else 0.0)
    return np.asarray(fft.irfft(whole, count).ravel())


def node_angles(state: Array) -> Array:
    """Angles of the nodes in the frame of the spin, rad, shape (n,)."""
    return _flow(state).angle


def seen(state: Array, at: Array) -> tuple[Array, Array]:
    """Radius of the surface, and velocity along the wall, at given angles in the frame of the spin, rad.

    Over R, and over R times the unit of the spin, shape (m,); of a surface that does not overhang.
    """
    flow = _flow(state)
    k, inner = flow.waves.k[1:-1], np.minimum(flow.waves.k[1:-1] * flow.depth, LARGE)
    n = flow.radius.size
    heights, slides = 2.0 / n * flow.surface[1:-1], 2.0 / n * flow.potential[1:-1] / np.cosh(inner)
    found = []
    for factor, places in ((1.0 / np.tanh(inner), flow.angle), (1.0 / np.sinh(inner), flow.waves.angle)):
        ends = np.concatenate((places, places[:1] + 2.0 * np.pi))
        # From between the nodes; Newton's method then finds the place itself.
        u = np.interp(at, ends, np.concatenate((flow.waves.angle, [2.0 * np.pi])), period=2.0 * np.pi)
        for _ in range(_ROUNDS):
            waves = np.exp(1j * np.outer(u, k))
            gap = u + np.real(waves @ (-1j * factor * heights)) - at
            gap = np.mod(gap + np.pi, 2.0 * np.pi) - np.pi
            if np.abs(gap).max() < _SETTLED:
                break
            u = u - gap / (1.0 + np.real(waves @ (factor * k * heights)))
        found.append(waves)
    opened = 1.0 + np.real(found[1] @ (k / np.sinh(inner) * heights))
    height = flow.depth + np.real(found[0] @ heights)
    return np.exp(-height), np.real(found[1] @ (1j * k * slides)) / opened


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
