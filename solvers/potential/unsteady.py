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
_ROUNDS, _SETTLED = 200, 1e-14  # of the angles of a surface of a given shape

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


def invariants(state: Array, spin: float = 1.0) -> Invariants:
    """Volume, energy, angular momentum and centre of mass [theory: potential, eq. 20].

    Parameters
    ----------
    state : y and phi, shape (2n,)
    spin : of the frame in which the flow has no vorticity, over the unit of the spin; 0 leaves phi alone
    """
    n, flow, whole = state.size // 2, _flow(state), 2.0 * np.pi
    square, phi = np.square(flow.radius), state[n:]
    rest = np.mean((1.0 - square * square) * flow.opened)
    swing = np.mean((1.0 - square * flow.radius) / 3.0 * flow.opened * np.exp(1j * flow.angle))
    return Invariants(
        volume=float(0.5 * whole * np.mean((1.0 - square) * flow.opened)),
        energy=float(-0.5 * whole * np.mean(phi * flow.stream_slope) - 0.125 * whole * spin**2 * rest),
        angular_momentum=float(-whole * np.mean(phi * square * flow.steep) + 0.25 * whole * spin * rest),
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
    # All at once: most of the time of small transforms is the call.
    parts = np.empty((6, k.size), dtype=complex)
    parts[0], parts[1], parts[2] = -1j * over_sine * surface, k * over * surface, 1j * turned * surface
    parts[3], parts[5] = 1j * turned * potential, -k * hollow * potential
    parts[4] = 1j * np.where(turned > 0.0, hollow, 0.0) * potential
    shift, opened, steep, potential_slope, stream, stream_slope = np.fft.irfft(parts, n)
    return _Flow(
        k=k,
        depth=depth,
        radius=np.exp(-state[:n]),
        angle=_even(n) + shift,
        opened=1.0 + opened,
        steep=steep,
        potential=potential,
        potential_slope=potential_slope,
        stream=stream,
        stream_slope=stream_slope,
    )


def _pull(flow: _Flow, push: complex) -> Array:
    """- 2 psi + r^2/2 + f.x at the surface."""
    along = push.real * np.cos(flow.angle) + push.imag * np.sin(flow.angle)
    return np.asarray(-2.0 * flow.stream + 0.5 * np.square(flow.radius) + flow.radius * along)


@dataclass(frozen=True)
class Answer:
    """What a layer does under any force: its rates and its own force are straight lines of f.

    Parameters
    ----------
    still : rates without f, shape (2n,)
    lever : rates of phi for f = 1 and f = i, shape (2, n)
    force : on the drum by the pressure without f, complex
    response : symmetric matrix that f adds to it with, shape (2, 2)
    momentum : P, the liquid's in its frame, complex
    moment : V times the centre of mass, complex
    """

    still: Array
    lever: Array
    force: complex
    response: Array
    momentum: complex
    moment: complex

    def rates(self, push: complex) -> Array:
        """Rates under a force f, shape (2n,).

        Parameters
        ----------
        push : f, as for `rates`
        """
        found = self.still.copy()
        found[self.lever.shape[1] :] += push.real * self.lever[0] + push.imag * self.lever[1]
        return found


def answer(state: Array, spin: float = 1.0, friction: float = 0.0, damping: float = 0.0) -> Answer:
    """Rates and force of a layer under any force at once [theory: potential, eq. 21-23].

    Parameters
    ----------
    state, damping : as for `rates`
    spin : of the frame in which the flow has no vorticity, over the unit of the spin
    friction : k of a force -k grad phi on all the liquid, which turns the drum's pressure by nothing
    """
    n, flow, whole = state.size // 2, _flow(state), 2.0 * np.pi
    metric, inner = flow.metric, np.minimum(flow.k * flow.depth, _LARGE)
    climb = -flow.stream_slope / metric
    square = np.square(flow.radius)
    arms = flow.radius * np.stack((np.cos(flow.angle), np.sin(flow.angle)))
    spectrum = np.fft.rfft(climb)
    spectrum[1:] *= -1j * _coth(flow)
    spectrum[0] = spectrum[-1] = 0.0
    slide = np.fft.irfft(spectrum, n)
    slide -= (flow.opened @ slide - flow.steep @ climb) / n
    fast, deep = np.square(flow.potential_slope), np.square(flow.stream_slope)
    rest = -2.0 * spin * flow.stream + 0.5 * spin**2 * square
    change = slide * flow.potential_slope - 0.5 * (fast - deep) / metric + rest - friction * state[n:]
    above = -0.5 * (fast + deep) / metric + rest
    spectra = np.fft.rfft(np.stack((flow.steep * slide + flow.opened * climb, change, above, *arms)))
    # Twice the share of a pair of waves; the mean and the shortest have one each.
    pairs = np.full(flow.k.size, 2.0 * whole / n**2)
    pairs[[0, -1]] *= 0.5
    weight = pairs * flow.k * np.tanh(inner)
    moved = np.real(spectra[3:, None] * spectra[None, 3:].conj()) @ weight
    volume = 0.5 * whole / n * ((1.0 - square) @ flow.opened)
    ray = arms[0] + 1j * arms[1]
    kept = np.concatenate((spectra[:2], spectra[3:]))
    kept[:, flow.k > _KEPT * flow.k[-1]] = 0.0
    kept[1:, 0] = 0.0
    if damping > 0.0:
        kept[:2] -= damping * (flow.k / (_KEPT * flow.k[-1])) ** 8 * np.fft.rfft(state.reshape(2, n))
    found = np.fft.irfft(kept, n)
    return Answer(
        still=found[:2].ravel(),
        lever=found[2:],
        force=_wall_force(flow, spectra[2], np.fft.rfft(state[:n])),
        response=volume * np.eye(2) - moved,
        momentum=complex(-whole / n * (ray @ flow.stream_slope)),
        moment=complex(whole / n * (ray @ ((1.0 / flow.radius - square) * flow.opened)) / 3.0),
    )


def _wall_force(flow: _Flow, above: Complex, surface: Complex) -> complex:
    """Sum of the pressure on the wall without f; `above` and `surface`: coefficients of D and y."""
    n, inner = flow.angle.size, np.minimum(flow.k * flow.depth, _LARGE)
    over = np.concatenate(([0.0], 1.0 / np.sinh(inner[1:])))
    over[-1] = 0.0
    near = 1.0 / np.cosh(inner)
    parts = np.stack((above * near, 1j * flow.k * flow.potential * near, -1j * over * surface,
                      flow.k * over * surface))  # fmt: skip
    change, sliding, shift, opened = np.fft.irfft(parts, n)
    opened += 1.0
    pressure = -change - 0.5 * np.square(sliding / opened)
    return complex(2.0 * np.pi / n * ((pressure * opened) @ np.exp(1j * (_even(n) + shift))))


def laid(radius: Callable[[Array], Array], count: int) -> Surface:
    """Liquid at rest in the drum under a surface of a given shape [theory: potential, eq. 2].

    Parameters
    ----------
    radius : of the surface over R at some angles, shape as theirs, above 0, below 1; its waves are lower than
        the layer is deep
    count : n, even

    Raises
    ------
    ArithmeticError : the angles did not settle: the surface is too steep for these nodes
    """
    angle = _even(count)
    for _ in range(_ROUNDS):
        height = -np.log(radius(angle))
        before, angle = angle, _angle_of(height)
        if np.abs(angle - before).max() < _SETTLED:
            return Surface(height, np.zeros(count))
    raise ArithmeticError(f"no strip with {count} nodes for this surface")


def seen(state: Array, at: Array) -> tuple[Array, Array]:
    """Radius of the surface, and velocity along the wall, at given angles.

    Parameters
    ----------
    state : y and phi, shape (2n,)
    at : angles, rad, shape (m,)

    Returns
    -------
    r/R and the velocity over R times the unit of the spin, shape (m,) each
    """
    n, flow = state.size // 2, _flow(state)
    k, inner = flow.k[:-1], np.minimum(flow.k[:-1] * flow.depth, _LARGE)
    heights = np.fft.rfft(state[:n])[:-1] / n
    heights[1:] *= 2.0
    slides = 2.0 / n * flow.potential[:-1] / np.cosh(inner)
    top, low = np.zeros(k.size), np.zeros(k.size)
    top[1:], low[1:] = 1.0 / np.tanh(inner[1:]), 1.0 / np.sinh(inner[1:])
    found = []
    for factor in (top, low):
        u = at.copy()
        for _ in range(_ROUNDS):
            waves = np.exp(1j * np.outer(u, k))
            gap = u + np.real(waves @ (-1j * factor * heights)) - at
            u = u - gap / (1.0 + np.real(waves @ (factor * k * heights)))
            if np.abs(gap).max() < _SETTLED:
                break
        found.append(np.exp(1j * np.outer(u, k)))
    opened = 1.0 + np.real(found[1] @ (low * k * heights))
    return np.exp(-np.real(found[0] @ heights)), np.real(found[1] @ (1j * k * slides)) / opened


def angles(state: Array) -> Array:
    """Of the surface's nodes, x, rad, shape (n,).

    Parameters
    ----------
    state : y and phi, shape (2n,)
    """
    return _angle_of(state[: state.size // 2])


def _angle_of(height: Array) -> Array:
    """x of a surface y, shape (n,)."""
    n = height.size
    k, spectrum = np.arange(n // 2 + 1), np.fft.rfft(height)
    spectrum[1:] *= -1j / np.tanh(np.minimum(k[1:] * height.mean(), _LARGE))
    spectrum[0] = spectrum[-1] = 0.0
    return np.asarray(_even(n) + np.fft.irfft(spectrum, n))


def levelled(state: Array, volume: float) -> Array:
    """The same surface, moved out or in until it holds a volume, shape (2n,).

    Parameters
    ----------
    state : y and phi, shape (2n,)
    volume : V, over R^2

    Raises
    ------
    ArithmeticError : no such surface near by
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
    """Size of the shortest waves that are kept, over that of the largest.

    Parameters
    ----------
    state : y and phi, shape (2n,)
    layer : h_0/R; waves below a thousandth of it count as that high
    """
    n = state.size // 2
    k = np.arange(n // 2 + 1)
    sizes = k * np.abs(np.fft.rfft(state.reshape(2, n))) * 2.0 / n
    kept = int(_KEPT * k[-1])
    last = sizes[:, int(0.9 * kept) : kept + 1].max(axis=1)
    return float((last / np.maximum(sizes.max(axis=1), 1e-3 * layer)).max())


def resampled(state: Array, count: int) -> Array:
    """The same waves on another number of nodes, the shortest left out where they are fewer.

    Parameters
    ----------
    state : y and phi, shape (2n,)
    count : n, even
    """
    n = state.size // 2
    spectra = np.fft.rfft(state.reshape(2, n)) * (count / n)
    whole = np.zeros((2, count // 2 + 1), dtype=complex)
    kept = min(n, count) // 2
    whole[:, :kept] = spectra[:, :kept]
    return np.asarray(np.fft.irfft(whole, count).ravel())
