"""The exact wave in time: rates of change of its surface, the force that it exerts, what it conserves.

On even nodes all round the drum, by Fourier transforms [theory: potential, eq. 16-20]. Lengths over R, times
in 1/Omega. Forces are seen in the frame of the drum; with f = 0 volume, energy and angular momentum stay.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.potential.steady import SteadyWave
from solvers.potential.strip import moved, nodes

# Waves that products of two may have without aliases, of all.
_KEPT = 2.0 / 3.0
_LARGE = 350.0  # k K beyond which tanh is 1 and 1/cosh nothing
_RELATIVE, _ABSOLUTE = 1e-9, 1e-12
# Share of the volume that no sound wave loses; nothing but (17) keeps it.
_LOST = 1e-6
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
    """What a wave without a force keeps, per unit length and density.

    Parameters
    ----------
    volume, energy, angular_momentum : V, E and L in units of R^2, Omega^2 R^4 and Omega R^4
    centre : V times the centre of mass, complex in the frame of the drum
    """

    volume: float
    energy: float
    angular_momentum: float
    centre: complex


@dataclass(frozen=True)
class _Flow:
    """Everything at the surface that rates, force and invariants need."""

    k: Array
    depth: float
    radius: Array
    angle: Array
    opened: Array
    steep: Array
    potential: Complex
    potential_slope: Array
    stream: Array
    stream_slope: Array

    @property
    def metric(self) -> Array:
        """r^2 J, the square of |dz/du|."""
        return np.asarray(np.square(self.radius) * (np.square(self.opened) + np.square(self.steep)))


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
    spectrum[1:] *= -1j / np.tanh(np.minimum(k[1:] * height.mean(), _LARGE))
    spectrum[0] = spectrum[-1] = 0.0
    return Surface(height, np.fft.irfft(spectrum, count))


def rates(state: Array, push: complex, damping: float = 0.0) -> Array:
    """Rates of change of a surface [theory: potential, eq. 16-18].

    Parameters
    ----------
    state : y and phi, shape (2n,)
    push : f, minus the acceleration of the axis, in the frame of the drum, over Omega^2 R
    damping : of the shortest waves that are kept, over Omega; falls with the eighth power of the wave number

    Returns
    -------
    Shape (2n,)
    """
    n = state.size // 2
    flow = _flow(state)
    metric = flow.metric
    climb = -flow.stream_slope / metric
    spectrum = np.fft.rfft(climb)
    spectrum[1:] *= -1j * _coth(flow)
    spectrum[0] = spectrum[-1] = 0.0
    slide = np.fft.irfft(spectrum, n)
    # The mean that keeps x - u without one.
    slide -= np.mean(flow.opened * slide - flow.steep * climb)
    height = flow.steep * slide + flow.opened * climb
    inner = np.square(flow.potential_slope) - np.square(flow.stream_slope)
    potential = slide * flow.potential_slope - 0.5 * inner / metric + _pull(flow, push)
    both = np.fft.rfft(np.stack((height, potential - potential.mean())))
    both[:, flow.k > _KEPT * flow.k[-1]] = 0.0
    if damping > 0.0:
        short = damping * (flow.k / (_KEPT * flow.k[-1])) ** 8
        both -= short * np.fft.rfft(state.reshape(2, n))
    return np.asarray(np.fft.irfft(both, n).ravel())


def force(state: Array, push: complex) -> complex:
    """Force on the drum by the pressure on its wall, over density, Omega^2 R^3 [theory: potential, eq. 19].

    Parameters
    ----------
    state, push : as for `rates`
    """
    n = state.size // 2
    flow = _flow(state)
    square = np.square(flow.potential_slope) + np.square(flow.stream_slope)
    inner = np.minimum(flow.k * flow.depth, _LARGE)
    above = np.fft.rfft(-0.5 * square / flow.metric + _pull(flow, push))
    change = np.fft.irfft(above / np.cosh(inner), n)
    sliding = np.fft.irfft(1j * flow.k * flow.potential / np.cosh(inner), n)
    surface = np.fft.rfft(state[:n])
    over = np.concatenate(([0.0], 1.0 / np.sinh(inner[1:])))
    over[-1] = 0.0
    angle = _even(n) + np.fft.irfft(-1j * over * surface, n)
    opened = 1.0 + np.fft.irfft(flow.k * over * surface, n)
    along = push.real * np.cos(angle) + push.imag * np.sin(angle)
    pressure = -change - 0.5 * np.square(sliding / opened) + along
    return complex(2.0 * np.pi * np.mean(pressure * np.exp(1j * angle) * opened))


def invariants(state: Array) -> Invariants:
    """Volume, energy, angular momentum and centre of mass [theory: potential, eq. 20].

    Parameters
    ----------
    state : y and phi, shape (2n,)
    """
    n, flow, whole = state.size // 2, _flow(state), 2.0 * np.pi
    square, phi = np.square(flow.radius), state[n:]
    rest = np.mean((1.0 - square * square) * flow.opened)
    swing = np.mean((1.0 - square * flow.radius) / 3.0 * flow.opened * np.exp(1j * flow.angle))
    return Invariants(
        volume=float(0.5 * whole * np.mean((1.0 - square) * flow.opened)),
        energy=float(-0.5 * whole * np.mean(phi * flow.stream_slope) - 0.125 * whole * rest),
        angular_momentum=float(-whole * np.mean(phi * square * flow.steep) + 0.25 * whole * rest),
        centre=complex(whole * swing),
    )


def advance(begin: Surface, time: float, push: Push | None = None, damping: float = 0.0) -> Surface:
    """A surface after a time, by steps that the fastest of its waves allows.

    Parameters
    ----------
    begin : surface
    time : in 1/Omega
    push : f over time, as for `rates`; none if None
    damping : as for `rates`

    Raises
    ------
    ArithmeticError : no such step, or liquid lost: a wave that breaks, or that these nodes do not carry
    """
    from scipy.integrate import solve_ivp

    n = begin.height.size
    # A method that tries longer ones fills the spectrum with what its tolerance lets through.
    longest = 2.0 / (1.0 + math.sqrt(1.0 + n / 3.0))

    def change(now: float, state: Array) -> Array:
        return rates(state, 0j if push is None else push(now), damping)

    found = solve_ivp(
        *(change, (0.0, time), begin.state, "DOP853"),
        rtol=_RELATIVE,
        atol=_ABSOLUTE,
        max_step=longest,
    )
    if not found.success or not np.isfinite(found.y[:, -1]).all():
        raise ArithmeticError(f"the wave went no further than {found.t[-1]:g}/Omega: {found.message}")
    first, last = (invariants(state).volume for state in (begin.state, found.y[:, -1]))
    if not abs(last / first - 1.0) < _LOST:
        raise ArithmeticError(
            f"the wave breaks, or wants more than {n} nodes: its volume became {last / first:g}"
        )
    return Surface(found.y[:n, -1].copy(), found.y[n:, -1].copy())


def _even(count: int) -> Array:
    return 2.0 * np.pi * np.arange(count) / count


def _coth(flow: _Flow) -> Array:
    """coth(kK) from k = 1 on."""
    return np.asarray(1.0 / np.tanh(np.minimum(flow.k[1:] * flow.depth, _LARGE)))


def _flow(state: Array) -> _Flow:
    """From surface and potential all that goes with them [theory: potential, eq. 2-4]."""
    n = state.size // 2
    k = np.arange(n // 2 + 1.0)
    surface, potential = np.fft.rfft(state.reshape(2, n))
    depth = float(state[:n].mean())
    hollow = np.tanh(np.minimum(k * depth, _LARGE))
    over = np.concatenate(([0.0], 1.0 / hollow[1:]))
    # The shortest wave has no sine on even nodes.
    turned = np.concatenate((k[:-1], [0.0]))
    over_sine = np.concatenate((over[:-1], [0.0]))
    return _Flow(
        k=k,
        depth=depth,
        radius=np.exp(-state[:n]),
        angle=_even(n) + np.fft.irfft(-1j * over_sine * surface, n),
        opened=1.0 + np.fft.irfft(k * over * surface, n),
        steep=np.fft.irfft(1j * turned * surface, n),
        potential=potential,
        potential_slope=np.fft.irfft(1j * turned * potential, n),
        stream=np.fft.irfft(1j * np.where(turned > 0.0, hollow, 0.0) * potential, n),
        stream_slope=-np.fft.irfft(k * hollow * potential, n),
    )


def _pull(flow: _Flow, push: complex) -> Array:
    """- 2 psi + r^2/2 + f.x at the surface."""
    along = push.real * np.cos(flow.angle) + push.imag * np.sin(flow.angle)
    return np.asarray(-2.0 * flow.stream + 0.5 * np.square(flow.radius) + flow.radius * along)
