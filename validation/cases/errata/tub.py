"""Errata of the suspended tub's equations, from the energies of tub and drum [theory: errata].

Coordinates x, y, z, alpha, beta, gamma, angles about the axes in that order; the drum spins about y. Mass,
gyroscopic and stiffness matrices are derivatives of the energies at rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from validation.case import Case, Claims

CLAIMS = Claims("errata")

# Coefficients of the stiffness matrix as DR18 prints them below eq. 8, one spring, places counted from 1;
# the other places of the upper triangle it gives as 0 or leaves out.
_PRINTED_STIFFNESS = {
    (1, 1): "c_x",
    (1, 5): "c_x*z",
    (1, 6): "-c_x*y",
    (2, 2): "c_y",
    (2, 5): "-c_y*z",
    (2, 6): "c_y*x",
    (3, 3): "c_z",
    (3, 4): "c_z*y",
    (3, 5): "-c_z*x",
    (4, 4): "c_z*y**2 + c_y*z**2",
    (4, 5): "-c_z*x*y",
    (4, 6): "-c_y*x*z",
    (5, 5): "c_x*z**2 + c_z*x**2",
    (5, 6): "-c_x*y*z",
    (6, 6): "c_y*x**2 + c_x*y**2",
}
_PLACES = [(row, column) for row in range(1, 7) for column in range(row, 7)]


@dataclass(frozen=True)
class TubMatrices:
    """Matrices at rest as sympy expressions, rows and columns in the order of the coordinates."""

    mass: Any  #: of the drum's unbalanced mass m_2 at (x_D, y_D, z_D) and its inertias J_a, J_b
    gyroscopic: Any  #: of the same, spinning at omega
    stiffness: Any  #: of one spring (c_x, c_y, c_z) at (x, y, z)


def tub_matrices() -> TubMatrices:
    """Matrices of tub and drum, 6 x 6, from their energies [theory: errata, eq. 3-5].

    T = m_2 |v_D|^2/2 + (J_a (w_x^2 + w_z^2) + J_b (w_y + omega)^2)/2 and the energy of a spring, both for the
    rotation Q = R_z(gamma) R_x(alpha) R_y(beta), on whose sequence nothing depends at rest.
    """
    import sympy as sp

    q = sp.Matrix(sp.symbols("X Y Z alpha beta gamma"))
    v = sp.Matrix(sp.symbols("X' Y' Z' alpha' beta' gamma'"))
    turn = sp.rot_ccw_axis3(q[5]) * sp.rot_ccw_axis1(q[3]) * sp.rot_ccw_axis2(q[4])
    turn_rate = sum((turn.diff(q[k]) * v[k] for k in (3, 4, 5)), sp.zeros(3, 3))
    spin = turn.T * turn_rate

    m2, j_a, j_b, omega = sp.symbols("m_2 J_a J_b omega")
    velocity = sp.Matrix(v[:3]) + turn_rate * sp.Matrix(sp.symbols("x_D y_D z_D"))
    kinetic = [(m2, component) for component in velocity]
    kinetic += [(j_a, spin[2, 1]), (j_b, spin[0, 2] + omega), (j_a, spin[1, 0])]

    place = sp.Matrix(sp.symbols("x y z"))
    stretch = sp.Matrix(q[:3]) + turn * place - place
    elastic = list(zip(sp.symbols("c_x c_y c_z"), stretch, strict=True))

    rest = dict.fromkeys([*q, *v], 0)

    def at_rest(energy: list[tuple[Any, Any]], first: Any, second: Any) -> Any:
        """Second derivatives of the sum of weight s^2/2: weight (s_i s_j + s s_ij)."""
        total = sp.zeros(6, 6)
        for weight, s in energy:
            rows, columns = (sp.Matrix([s.diff(u).subs(rest) for u in side]) for side in (first, second))
            total += weight * rows * columns.T
            if s.subs(rest) != 0:
                bend = sp.Matrix(6, 6, lambda i, j, s=s: s.diff(first[i], second[j]).subs(rest))
                total += weight * s.subs(rest) * bend
        return total.applyfunc(sp.expand)

    mixed = at_rest(kinetic, v, q)
    return TubMatrices(
        mass=at_rest(kinetic, v, v), gyroscopic=mixed - mixed.T, stiffness=at_rest(elastic, q, q)
    )


@dataclass(frozen=True)
class _Term:
    """A term of the equations below eq. 7 with another letter than the spring's energy has."""

    row: int  #: of the coordinate whose equation it is, and of the one that it multiplies, from 0
    column: int
    printed: str  #: coefficient as published, of one spring or damper
    damping: bool = False  #: it multiplies the rate, with the dampers' h in the place of the springs' c
    rate: bool = False  #: printed with a rate where the coordinate itself belongs


_NAMES = ("x", "y", "z", "alpha", "beta", "gamma")
_TERMS = (
    _Term(3, 5, "-c_y*x*y"),
    _Term(3, 5, "-c_y*x*y", damping=True),
    _Term(4, 2, "-c_z*y", damping=True),
    _Term(5, 4, "-c_x*x*z", damping=True),
    _Term(5, 5, "c_y*x**2 + c_x*y**2", rate=True),
)


# Products of rates in eq. 4 and what they are printed and meant to go with.
_PRODUCTS = (
    (1, 4, "m_2*z_D", -1.0, "the bracket with beta' z_D goes with -gamma' y_D, not with -y'"),
    (4, 5, "m_2*y_D*z_D", 0.0, "the bracket with beta' z_D goes with -gamma' y_D, not with -y'"),
    (3, 5, "m_2*x_D*z_D", 0.0, "printed is alpha' x_D z_D alone, which has not the dimension of the rest"),
)


def _written(expression: object) -> str:
    """An expression as on paper: `2 x y^2`."""
    return str(expression).replace("**", "^").replace("*", " ")


def cases() -> Iterator[Case]:
    """Every erratum of the suspended tub's equations [DR18, eq. 1-8]."""
    import sympy as sp

    matrices = tub_matrices()

    def share(entry: Any, *units: str) -> float:
        return float(sp.simplify(entry / sp.prod(sp.symbols(units))))

    # The coupling of alpha and gamma by the drum's spin.
    for equation, rate, row, column, printed in (
        ("alpha", "gamma", 3, 5, -2.0),
        ("gamma", "alpha", 5, 3, 2.0),
    ):
        computed = share(matrices.gyroscopic[row, column], "J_b", "omega")
        yield CLAIMS.case("dr-gyroscopic", computed, equation=equation, rate=rate, printed=printed)
    # Stiffness coefficients in which the printed list and the springs' energy part.
    given = {place: sp.sympify(_PRINTED_STIFFNESS.get(place, "0")) for place in _PLACES}
    stiffness = {(row, column): matrices.stiffness[row - 1, column - 1] for row, column in _PLACES}
    wrong = [place for place in _PLACES if sp.expand(given[place] - stiffness[place]) != 0]
    counts = {"same": len(_PLACES) - len(wrong), "all": len(_PLACES)}
    for place in wrong:
        at = {"row": place[0], "column": place[1], "printed": _written(given[place])}
        yield CLAIMS.case("dr-a", _written(stiffness[place]), **at, **counts)
    # How often gamma is differentiated in the equation of y.
    for which, order, matrix, printed in (
        ("first", "gamma'", matrices.gyroscopic, 1.0),
        ("second", "gamma''", matrices.mass, 0.0),
    ):
        words = {"which": which, "order": order, "printed": printed}
        yield CLAIMS.case("dr-y-equation-derivative", share(matrix[1, 5], "m_2", "x_D"), **words)
    # Springs and dampers in the equations of alpha, beta and gamma, term by term.
    for term in _TERMS:
        found = matrices.stiffness[term.row, term.column]
        if not term.rate and sp.expand(sp.sympify(term.printed) - found) == 0:
            continue
        letter = "h_" if term.damping else "c_"
        shown, derived = (_written(text).replace("c_", letter) for text in (term.printed, found))
        of = _NAMES[term.column] + ("'" if term.damping else "")
        kind = "rate" if term.rate else "damping" if term.damping else "stiffness"
        words = {"of": of, "row": _NAMES[term.row], "kind": kind}
        words["part"] = "damper (h_x, h_y, h_z)" if term.damping else "spring (c_x, c_y, c_z)"
        words["printed"] = f"0, and {shown} of {of}'" if term.rate else shown
        why, symmetric = "a stiffness multiplies the angle, not its rate", "symmetric, as J^T c J is"
        yield CLAIMS.case("dr-equation", derived, note=why if term.rate else symmetric, **words)
    # Eq. 4: products of rates in the kinetic energy, which are the places of the mass matrix.
    for first, second, unit, printed, why in _PRODUCTS:
        computed = share(matrices.mass[first, second], *unit.split("*"))
        of, other = _NAMES[first], _NAMES[second]
        words = {"first": of, "second": other, "unit": _written(unit), "printed": printed, "why": why}
        yield CLAIMS.case("dr-eq-4", computed, **words)
    # The energy of the unbalanced mass by its own circle alone, and what the last bracket makes of spin.
    mass, radius, spin, time = sp.symbols("m_2 e omega t", positive=True)
    circle = sp.Matrix([-radius * sp.cos(spin * time), radius * sp.sin(spin * time)])
    energy = sp.simplify(mass * circle.diff(time).dot(circle.diff(time)) / 2)
    yield CLAIMS.case("dr-eq-4-unbalance", float(sp.simplify(energy / (mass * spin**2 * radius**2))))
    yield CLAIMS.case("dr-eq-4-gyroscopic", share(matrices.gyroscopic[5, 3], "J_b", "omega"))
    # Which coefficients of the stiffness matrix are static moments, linear in a place.
    scale, static = sp.Symbol("s"), []
    lengths = {length: scale * length for length in sp.symbols("x y z")}
    for place, entry in stiffness.items():
        if entry != 0 and sp.expand(entry.subs(lengths, simultaneous=True) - scale * entry) == 0:
            static.append(place)
    inside = sum(row <= 3 and column <= 3 for row, column in static)
    told = f"i <= 3 < j: {len(static) - inside} of them, and {inside} with i, j <= 3"
    yield CLAIMS.case("dr-third-group", told, inside >= len(static))
