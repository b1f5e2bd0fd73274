"""Linear layers and a planar machine as x' = A x + B u, y = C x + D u in the drum frame, for control design.

Drag of a laminar layer, sqrt(i s), has no finite state space. A sum of decaying terms stands for it, each of
them a drag itself, so that the waves of a chamber decay whatever the fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from fluid.whirl import Layer, layer_rate, wave_function
from meshes.arrays import Array, Complex
from solvers.rotor.jeffcott import Jeffcott

BAND = (0.01, 10.0)  # sizes of the slip over the spin between which roots are fitted
ERROR = 1e-3  # of a root in the band, relative
_MOST_TERMS = 24
_AT = 400  # frequencies of a fit; of the search for its largest error twenty times as many
_PARTS = ("x", "y")

# A layer of a chamber; without a free surface, or for liquid that is none, its mass that is solid, kg.
Liquid = Layer | float


@dataclass(frozen=True, eq=False)
class RootFit:
    """sqrt(p) as the sum of c p/(p + a), c and a above 0: a drag [theory: whirl, eq. 36]."""

    weight: Array  #: c, s^(-1/2), shape (k,)
    decay: Array  #: a, 1/s, shape (k,)

    def at(self, spin: float) -> RootFit:
        """The fit of a unit spin at another."""
        return RootFit(np.sqrt(spin) * self.weight, spin * self.decay)

    def __call__(self, p: Complex) -> Complex:
        """The sum at complex rates, shape of p."""
        terms = self.weight * p[..., None] / (p[..., None] + self.decay)
        return np.asarray(terms.sum(axis=-1), dtype=complex)


@cache
def fit_root() -> RootFit:
    """Fewest terms that give sqrt(i s) in the band of a unit spin within a relative error of `ERROR`.

    Decays evenly on a logarithmic scale over a width that is sought, weights by non-negative least squares:
    as few terms as the AAA algorithm takes, with all of them a drag.
    """
    from scipy.optimize import minimize_scalar, nnls

    low, high = BAND
    s = np.geomspace(low, high, _AT)
    root: Complex = np.asarray(np.sqrt(1j * s), dtype=complex)
    aim = np.concatenate([np.ones(_AT), np.zeros(_AT)])

    def fitted(wide: float, count: int) -> tuple[float, RootFit]:
        decay = np.geomspace(low / wide, high * wide, count)
        terms = 1j * s[:, None] / (1j * s[:, None] + decay) / root[:, None]
        found = RootFit(nnls(np.concatenate([terms.real, terms.imag]), aim)[0], decay)
        return float(np.abs(found(np.asarray(1j * s)) / root - 1.0).max()), found

    for count in range(2, _MOST_TERMS + 1):
        search = minimize_scalar(
            lambda wide, count=count: fitted(np.exp(wide), count)[0], bounds=(-1.0, 5.0), method="bounded"
        )
        best, found = fitted(float(np.exp(search.x)), count)
        if best <= ERROR:
            break
    used = found.weight > 0.0
    return RootFit(found.weight[used], found.decay[used])


@dataclass(frozen=True, eq=False)
class StateSpace:
    """x' = A x + B u, y = C x + D u, real, SI units; n states, m inputs, p outputs. Frame of the drum."""

    A: Array  #: shape (n, n)
    B: Array  #: shape (n, m)
    C: Array  #: shape (p, n)
    D: Array  #: shape (p, m)
    inputs: tuple[str, ...]  #: names
    outputs: tuple[str, ...]
    states: tuple[str, ...]
    speed: float  #: spin, rad/s

    def __call__(self, slip: Array) -> Complex:
        """Outputs over inputs that turn as e^{i s t} in the drum, along its first direction, shape (k, p/2).

        Two parts (x, y) each are one complex number x + i y.
        """
        a, b, c, d = (_complex(matrix) for matrix in (self.A, self.B, self.C, self.D))
        whole = 1j * slip[:, None, None] * np.eye(len(a)) - a
        return np.asarray((c @ np.linalg.solve(whole, np.broadcast_to(b, (slip.size, *b.shape))) + d)[..., 0])


def _complex(matrix: Array) -> Complex:
    """Matrix of complex numbers x + i y from that of their parts."""
    return np.asarray(matrix[::2, ::2] + 1j * matrix[1::2, ::2])


def _real(matrix: Complex) -> Array:
    """Matrix of the parts x, y from that of complex numbers x + i y."""
    found = np.zeros((2 * matrix.shape[0], 2 * matrix.shape[1]))
    found[::2, ::2] = found[1::2, 1::2] = matrix.real
    found[1::2, ::2], found[::2, 1::2] = matrix.imag, -matrix.imag
    return found


def _named(names: Sequence[str]) -> tuple[str, ...]:
    return tuple(f"{name}_{part}" for name in names for part in _PARTS)


@dataclass(frozen=True, eq=False)
class _Parts:
    """A layer driven by the acceleration b of its axis: z' = a z + g b, force on the drum h z - m b."""

    a: Complex  #: shape (k, k)
    g: Complex  #: shape (k,)
    h: Complex  #: shape (k,)
    mass: float  #: m, kg
    states: tuple[str, ...]  #: of z, shape (k,)


def _parts(liquid: Liquid, spin: float) -> _Parts:
    """The layer as states: offset d, rate v, those of the roots' terms [theory: whirl, eq. 35-36]."""
    if not isinstance(liquid, Layer):
        empty = np.zeros(0, dtype=complex)
        return _Parts(empty.reshape(0, 0), empty, empty, float(liquid), ())
    t = liquid.layer_tanh
    # Of the drags with sqrt(p + i shift): size and shift.
    roots = [(liquid.stokes, 0.0)]
    roots.append((0.5 * (1.0 - t) * liquid.lids, 2.0 * spin))
    roots.append((0.5 * (1.0 + t) * liquid.lids, -2.0 * spin))
    roots = [each for each in roots if each[0] > 0.0]
    root = fit_root().at(spin) if roots else RootFit(np.zeros(0), np.zeros(0))
    terms = root.weight.size
    k = 2 + terms * len(roots)
    a, g, drag = np.zeros((k, k), dtype=complex), np.zeros(k, dtype=complex), np.zeros(k, dtype=complex)
    drag[1] = liquid.rate
    for j, (size, shift) in enumerate(roots):
        own = slice(2 + j * terms, 2 + (j + 1) * terms)
        # c p/(p + a) of v is c (v - y) with y' = a (v - y), p counted from its shift.
        a[own, own] = -np.diag(root.decay + 1j * shift)
        a[own, 1] = root.decay
        drag[1] += size * root.weight.sum()
        drag[own] = -size * root.weight
    a[0, 1] = 1.0
    a[1] = -drag
    a[1, 0] -= t * spin**2
    a[1, 1] += 2j * t * spin
    g[1] = -0.5 * (1.0 - t)
    # Newton's law of the liquid: -m (b + v' + 2 i Omega v - Omega^2 d).
    h = -liquid.mass * a[1]
    h[0] += liquid.mass * spin**2
    h[1] -= 2j * liquid.mass * spin
    names = ["liquid", "liquid_rate"]
    names += [f"drag_{j + 1}_{i + 1}" for j in range(len(roots)) for i in range(terms)]
    return _Parts(a, g, h, 0.5 * (1.0 + t) * liquid.mass, tuple(names))


def chamber_space(liquid: Liquid, spin: float) -> StateSpace:
    """One chamber: from the acceleration of its axis to the force of its liquid and the liquid's offset.

    The acceleration in space, m/s^2, force, N, and offset from the chamber's axis, m, along the drum's
    directions. A displacement w e^{i s t} in the drum has the acceleration -(Omega + s)^2 w.
    """
    p = _parts(liquid, spin)
    c, d = [p.h], [-p.mass]
    outputs = ["force"]
    if p.states:
        c, d = [*c, np.eye(len(p.states), dtype=complex)[0]], [*d, 0.0]
        outputs.append("liquid")
    return StateSpace(
        _real(p.a),
        _real(p.g[:, None]),
        _real(np.array(c).reshape(len(outputs), len(p.states))),
        _real(np.array(d, dtype=complex)[:, None]),
        _named(["acceleration"]),
        _named(outputs),
        _named(p.states),
        spin,
    )


def machine_space(rotor: Jeffcott, liquids: Sequence[Liquid], spin: float) -> StateSpace:
    """The planar machine: from a force on its axis to deflection and liquid's force [theory: whirl, eq. 37].

    N and m along the drum's directions; its unbalance is the constant force U Omega^2 along x.
    """
    parts = [_parts(liquid, spin) for liquid in liquids]
    size = 2 + sum(len(p.states) for p in parts)
    # b = z'' + 2 i Omega z' - Omega^2 z as a row of states, and what the force adds to it.
    mass = rotor.mass + sum(p.mass for p in parts)
    row = np.zeros(size, dtype=complex)
    row[0] = -rotor.stiffness - 1j * rotor.damping * spin
    row[1] = -rotor.damping
    a, b = np.zeros((size, size), dtype=complex), np.zeros(size, dtype=complex)
    force, names, first = np.zeros(size, dtype=complex), ["deflection", "deflection_rate"], 2
    places = []
    for k, p in enumerate(parts):
        own = slice(first, first + len(p.states))
        row[own] = force[own] = p.h
        a[own, own] = p.a
        places.append(own)
        first = own.stop
        names += [f"chamber_{k + 1}_{name}" for name in p.states]
    row /= mass
    a[0, 1] = 1.0
    a[1] = row
    a[1, 0] += spin**2
    a[1, 1] -= 2j * spin
    b[1] = 1.0 / mass
    wet = sum(p.mass for p in parts)
    for p, own in zip(parts, places, strict=True):
        a[own] += np.outer(p.g, row)
        b[own] = p.g / mass
    c = np.stack([np.eye(size, dtype=complex)[0], force - wet * row])
    d = np.array([0.0, -wet / mass], dtype=complex)
    return StateSpace(
        _real(a),
        _real(b[:, None]),
        _real(c),
        _real(d[:, None]),
        _named(["force"]),
        _named(["deflection", "liquid_force"]),
        _named(names),
        spin,
    )


def layer_force(liquid: Liquid, spin: float, slip: Array) -> Complex:
    """Force of the liquid over its axis' acceleration at slips, kg, shape (k,) [theory: whirl, eq. 4]."""
    if not isinstance(liquid, Layer):
        return np.full(slip.shape, -float(liquid), dtype=complex)
    wave = wave_function(liquid.layer_tanh, spin, slip, layer_rate(liquid, spin, slip))
    share = -0.5 * (1.0 - liquid.layer_tanh) * np.square(slip + spin) / wave
    return np.asarray(-liquid.mass * (1.0 + share))


def largest_error(liquid: Liquid, spin: float, space: StateSpace) -> float:
    """Largest error of a chamber's force over the band, over the larger of the force and a full drum's."""
    if not isinstance(liquid, Layer):
        return 0.0
    s = spin * np.geomspace(*BAND, 20 * _AT)
    slip = np.concatenate([-s[::-1], s])
    exact, t = layer_force(liquid, spin, slip), liquid.layer_tanh
    whole = liquid.mass * (1.0 + t) / (2.0 * t)
    off = np.abs(space(slip)[:, 0] - exact)
    return float((off / np.maximum(np.abs(exact), whole)).max())
