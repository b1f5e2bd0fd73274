"""Integrals over the liquid along the arc of one cylindrical wall, for one state.

Lengths in units of the wall's radius across the axis and of its height along it. A wall point at the angle
psi from the deflection, seen from the wall's centre, lies at s = r^2 = 1 + eps^2 + 2 eps cos(psi) from the
rotation axis; the circle through it is inside the wall for |angle| < phi. All integrands are positive, so
that nothing cancels [theory: statics, eq. 11-15]. eps is e/R, steep B = beta R^2/h, zeta the height of the
unclamped surface at the wall's farthest point over h; none is below 0.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from solvers.machine_code import BARE, machine_code

# Products and sums may be contracted; no arrays are made here, so that nothing needs reference counts.
COMPILED: dict[str, Any] = {
    "fastmath": {"contract", "nsz"},
    "error_model": "numpy",
    "_nrt": False,
}
_jit: Any = machine_code(**(COMPILED | BARE))

# The wall is divided at v = pi - psi = pi/4. Far part: the nearest singularity (v = 0 when the rotation axis
# touches the wall) is pi/4 beyond the end of a panel of half-length 3/8 pi: the error falls as 3**(-2 n).
# Near part, in u: the square root of dv/du ends 0.96 beyond a panel of half-length up to 6.3: 1.7**(-2 n).
# The full circles are polynomials of degree 3.
# Beside the length of short panels the same singularities are farther away: the error falls as 7.1**(-2 n) up
# to a half-length of 0.3 of the far part, as 5.2**(-2 n) up to 0.5 of the near one, where s = 0 at u = i pi/2
# is beyond as well. A panel of no length has one node.
_DIVIDE = 0.75 * np.pi
_DIVIDE_SINE = np.sin(np.pi / 8.0)
_DIVIDE_SQUARED = np.cos(np.pi / 8.0) ** 2  # sin^2(psi/2) there
_SHORT_FAR, _SHORT_NEAR = 0.3, 0.5  # half-lengths
_POINT, _DISC, _FEW_FAR, _FEW_NEAR, _FAR, _NEAR = 0, 1, 2, 3, 4, 5  # rules of quadrature
_COUNTS = np.array([1, 3, 10, 12, 18, 34])
_RULES = np.zeros((2, _COUNTS.size, _COUNTS.max()))  # nodes and weights
for _rule, _count in enumerate(_COUNTS):
    _RULES[:, _rule, :_count] = np.polynomial.legendre.leggauss(_count)

# Smallest width of the near zone that the nodes are crowded into; what lies inside a narrower one weighs
# less than its square.
_NARROWEST = 3e-6
_TINY = np.finfo(np.float64).tiny
_WALL_PANELS, _PANELS = 4, 6


class _Cuts(NamedTuple):
    """Where both waterlines and the change of variable cut the wall, and the full circles inside it."""

    eps: float
    steep: float
    zeta: float
    span: float  # 4 B eps, by which the surface falls along the whole wall
    nearest: float  # depth at the nearest point of the wall, unclamped
    middle: float  # where the variable changes
    lid_far: float  # psi at the lid's waterline, at most _DIVIDE
    floor_far: float
    lid_near: float  # sin(v/2) there, at most _DIVIDE_SINE
    floor_near: float
    inner: float  # s of the largest full circle
    deepest: float  # depth on it
    lid_fall: float  # drop of s from it to the lid's waterline
    floor_fall: float


class _Panel(NamedTuple):
    """A piece of the wall, or of the full circles; none if it has no nodes."""

    rule: int  # of quadrature
    nodes: int
    middle: float  # in its own variable
    half: float  # of its length
    width: float  # of the near zone
    ramp: bool  # the surface crosses it between floor and lid
    rise: float  # change of depth over it


class _Node(NamedTuple):
    """A node of a panel."""

    density: float  # ds over half the panel's length, with the quadrature's weight
    s: float  # r^2
    phi: float  # half the angle of the circle inside the chamber
    chord: float  # r sin(phi)
    abscissa: float  # r cos(phi)
    depth: float  # 0 to 1


@_jit
def _clip(x: float) -> float:
    return min(max(x, 0.0), 1.0)


@_jit
def _squared_sine(drop: float, span: float) -> float:
    """sin^2(psi/2) where the depth has dropped that much; 1 where it never drops so far."""
    if drop <= 0.0:
        return 0.0
    return drop / span if drop < span else 1.0


@_jit
def _fall(depth: float, steep: float, inner: float) -> float:
    """Drop of s over which the surface falls by a depth, between 0 and `inner`."""
    if depth <= 0.0:
        return 0.0
    return depth / steep if depth < steep * inner else inner


@_jit
def _cuts(eps: float, steep: float, zeta: float) -> _Cuts:
    span = 4.0 * steep * eps
    nearest = zeta - span
    lid, floor = _squared_sine(zeta - 1.0, span), _squared_sine(zeta, span)
    inner = (1.0 - eps) ** 2 if eps < 1.0 else 0.0
    deepest = max(nearest, 0.0)
    return _Cuts(
        eps,
        steep,
        zeta,
        span,
        nearest,
        zeta - _DIVIDE_SQUARED * span,
        min(2.0 * np.arcsin(np.sqrt(lid)), _DIVIDE),
        min(2.0 * np.arcsin(np.sqrt(floor)), _DIVIDE),
        np.sqrt(1.0 - max(lid, _DIVIDE_SQUARED)),
        np.sqrt(1.0 - max(floor, _DIVIDE_SQUARED)),
        inner,
        deepest,
        _fall(deepest - 1.0, steep, inner),
        _fall(deepest, steep, inner),
    )


@_jit
def _panel(number: int, cut: _Cuts) -> _Panel:
    """Far and near part of the wall, wet to the lid and crossed by the surface, then full circles alike."""
    ramp, rise, width = number % 2 == 1, 0.0, 0.0
    if number < 2:
        start, stop = (cut.lid_far, cut.floor_far) if ramp else (0.0, cut.lid_far)
        if ramp:
            rise = _clip(cut.zeta) - _clip(cut.middle)
    elif number < 4:
        start, stop = (cut.floor_near, cut.lid_near) if ramp else (cut.lid_near, _DIVIDE_SINE)
        if ramp:
            rise = _clip(cut.middle) - _clip(cut.nearest)
    else:
        start, stop = (cut.lid_fall, cut.floor_fall) if ramp else (0.0, cut.lid_fall)
        if ramp:
            rise = _clip(cut.deepest) - _clip(cut.deepest - cut.steep * cut.inner)
    # One of no length counts if the surface crosses it like a wall.
    if not (stop > start or rise != 0.0):
        return _Panel(_POINT, 0, 0.0, 0.0, 0.0, ramp, 0.0)
    if 2 <= number < 4:
        width = max(abs(1.0 - cut.eps) / (2.0 * np.sqrt(max(cut.eps, _TINY))), _NARROWEST)
        start, stop = np.arcsinh(start / width), np.arcsinh(stop / width)
    half = 0.5 * (stop - start)
    rule = _rule_of(number, half)
    return _Panel(rule, _COUNTS[rule], 0.5 * (stop + start), half, width, ramp, rise)


@_jit
def _rule_of(number: int, half: float) -> int:
    """Rule of quadrature for a panel of half a length."""
    if half == 0.0:
        return _POINT
    if number < 2:
        return _FEW_FAR if half <= _SHORT_FAR else _FAR
    if number < 4:
        return _FEW_NEAR if half <= _SHORT_NEAR else _NEAR
    return _DISC


@_jit
def _far_node(k: int, panel: _Panel, cut: _Cuts) -> _Node:
    """At the angle psi from the deflection."""
    e, psi = cut.eps, panel.middle + panel.half * _RULES[0, panel.rule, k]
    sine, cosine = np.sin(0.5 * psi), np.cos(0.5 * psi)
    squared, sin = sine * sine, 2.0 * sine * cosine
    abscissa = e + (1.0 - 2.0 * squared)
    return _Node(
        _RULES[1, panel.rule, k] * 2.0 * e * sin,
        (1.0 + e) ** 2 - 4.0 * e * squared,
        np.arctan2(sin, abscissa),
        sin,
        abscissa,
        _clip(cut.zeta - cut.span * squared),
    )


@_jit
def _near_node(k: int, panel: _Panel, cut: _Cuts) -> _Node:
    """At v = pi - psi, where sin(v/2) = width sinh(u)."""
    e, u = cut.eps, panel.middle + panel.half * _RULES[0, panel.rule, k]
    steepest = np.sinh(u)
    sine = min(panel.width * steepest, _DIVIDE_SINE)
    squared = sine * sine
    sin = 2.0 * sine * np.sqrt(1.0 - squared)
    abscissa = (e - 1.0) + 2.0 * squared
    return _Node(
        _RULES[1, panel.rule, k] * 8.0 * e * panel.width * sine * np.sqrt(1.0 + steepest * steepest),
        (1.0 - e) ** 2 + 4.0 * e * squared,
        np.arctan2(sin, abscissa),
        sin,
        abscissa,
        _clip(cut.nearest + cut.span * squared),
    )


@_jit
def _disc_node(k: int, panel: _Panel, cut: _Cuts) -> _Node:
    """Full circles, from the largest one inwards."""
    fall = panel.middle + panel.half * _RULES[0, panel.rule, k]
    depth = _clip(cut.deepest - cut.steep * fall)
    return _Node(_RULES[1, panel.rule, k], max(cut.inner - fall, 0.0), np.pi, 0.0, 0.0, depth)


@_jit
def _node(number: int, k: int, panel: _Panel, cut: _Cuts) -> _Node:
    found: _Node
    if number < 2:
        found = _far_node(k, panel, cut)
    elif number < 4:
        found = _near_node(k, panel, cut)
    else:
        found = _disc_node(k, panel, cut)
    return found


@_jit
def _second_moment(node: _Node) -> float:
    """Integral of x^2 over the circle of radius r inside the chamber, per ds."""
    return 0.5 * (node.s * node.phi + node.chord * node.abscissa)


@_jit
def _sine_excess(phi: float) -> float:
    """phi - sin(phi) cos(phi) without cancellation for thin slivers."""
    excess: float = phi - np.sin(phi) * np.cos(phi)
    if phi >= 0.2:
        return excess
    squared, term, total = (2.0 * phi) ** 2, 1.0, 1.0
    for n in range(2, 8):
        term *= -squared / ((2 * n) * (2 * n + 1))
        total += term
    return 4.0 / 6.0 * phi**3 * total


@_jit
def volume_and_plan(eps: float, steep: float, zeta: float) -> tuple[float, float]:
    """Volume of the liquid, and its derivative with respect to zeta: the plan area of its free surface."""
    cut = _cuts(eps, steep, zeta)
    volume = plan = area = 0.0
    for number in range(_PANELS):
        panel = _panel(number, cut)
        held = circles = measure = 0.0
        for k in range(panel.nodes):
            node = _node(number, k, panel, cut)
            weighted = node.density * node.phi
            held += weighted * node.depth
            circles += weighted
            measure += node.density
        volume += panel.half * held
        if panel.ramp and measure > 0.0:
            # A mean over the panel keeps its digits when the panel shrinks to a point.
            plan += panel.rise * circles / measure
            area += panel.half * circles
    # The plan shrinks as 1/B: its area then comes from the rise, which keeps its digits.
    return volume, plan / steep if steep > 1.0 else area


@_jit
def first_moment(eps: float, steep: float, zeta: float) -> float:
    """First moment of the liquid about the rotation axis over R^3 h."""
    cut = _cuts(eps, steep, zeta)
    x = 0.0
    for number in range(_WALL_PANELS):  # full circles have none
        panel = _panel(number, cut)
        pull = 0.0
        for k in range(panel.nodes):
            node = _node(number, k, panel, cut)
            pull += node.density * node.depth * node.chord
        x += panel.half * pull
    return x


@_jit
def unbalance(eps: float, steep: float, zeta: float) -> tuple[float, float, float, float]:
    """First moment about the rotation axis over R^3 h, and B times the moments of the surface's plan.

    Its area, first and second moment along the deflection, in chamber units, finite even for a cylinder.
    """
    cut = _cuts(eps, steep, zeta)
    x = plan = plan_x = plan_xx = 0.0
    for number in range(_PANELS):
        panel = _panel(number, cut)
        pull = measure = circles = chords = second = 0.0
        for k in range(panel.nodes):
            node = _node(number, k, panel, cut)
            pull += node.density * node.depth * node.chord
            if panel.ramp:
                measure += node.density
                circles += node.density * node.phi
                chords += node.density * node.chord
                second += node.density * _second_moment(node)
        x += panel.half * pull
        if measure > 0.0:
            plan += panel.rise * circles / measure
            plan_x += panel.rise * chords / measure
            plan_xx += panel.rise * second / measure
    return x, plan, plan_x, plan_xx


@_jit
def moments(eps: float, steep: float, zeta: float) -> tuple[float, ...]:
    """Volume, x, z, xx, yy, zz, xz of the liquid in a disc-shaped chamber, about rotation axis and floor.

    Lengths across the axis over R and along it over h [theory: statics, eq. 14-15].
    """
    cut = _cuts(eps, steep, zeta)
    v = x = z = xx = yy = zz = xz = 0.0
    for number in range(_PANELS):
        panel = _panel(number, cut)
        for k in range(panel.nodes):
            node = _node(number, k, panel, cut)
            depth = node.depth
            liquid = panel.half * node.density * depth
            v += liquid * node.phi
            x += liquid * node.chord
            xx += liquid * _second_moment(node)
            yy += 0.5 * liquid * node.s * _sine_excess(node.phi)
            z += 0.5 * liquid * depth * node.phi
            zz += liquid * depth**2 * node.phi / 3.0
            xz += 0.5 * liquid * depth * node.chord
    return v, x, z, xx, yy, zz, xz
