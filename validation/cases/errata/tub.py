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


def cases() -> list[Case]:
    """Every erratum of the suspended tub's equations [DR18, eq. 1-8]."""
    matrices = tub_matrices()
    return [
        *_gyroscopic_cases(matrices),
        *_stiffness_cases(matrices),
        *_order_cases(matrices),
        *_row_cases(matrices),
        *_energy_cases(matrices),
        _energy_of_unbalance(),
        _energy_of_spin(matrices),
        _groups(matrices),
    ]


def _gyroscopic_cases(matrices: TubMatrices) -> Iterator[Case]:
    """The coupling of alpha and gamma by the drum's spin."""
    import sympy as sp

    unit = sp.symbols("J_b") * sp.symbols("omega")
    for equation, rate, row, column, printed in (
        ("alpha", "gamma", 3, 5, -2.0),
        ("gamma", "alpha", 5, 3, 2.0),
    ):
        computed = float(sp.simplify(matrices.gyroscopic[row, column] / unit))
        yield CLAIMS.case("dr-gyroscopic", computed, equation=equation, rate=rate, printed=printed)


def _stiffness_cases(matrices: TubMatrices) -> list[Case]:
    """The stiffness coefficients in which the printed list and the springs' energy part."""
    import sympy as sp

    wrong = []
    for row, column in _PLACES:
        printed = sp.sympify(_PRINTED_STIFFNESS.get((row, column), "0"))
        computed = matrices.stiffness[row - 1, column - 1]
        if sp.expand(printed - computed) != 0:
            wrong.append((row, column, _written(printed), _written(computed)))
    return [
        CLAIMS.case(
            "dr-a",
            computed,
            row=row,
            column=column,
            printed=printed,
            same=len(_PLACES) - len(wrong),
            all=len(_PLACES),
        )
        for row, column, printed, computed in wrong
    ]


def _order_cases(matrices: TubMatrices) -> Iterator[Case]:
    """How often gamma is differentiated in the equation of y."""
    import sympy as sp

    unit = sp.symbols("m_2") * sp.symbols("x_D")
    for which, order, matrix, printed in (
        ("first", "gamma'", matrices.gyroscopic, 1.0),
        ("second", "gamma''", matrices.mass, 0.0),
    ):
        words = {"which": which, "order": order, "printed": printed}
        yield CLAIMS.case("dr-y-equation-derivative", float(sp.simplify(matrix[1, 5] / unit)), **words)


@dataclass(frozen=True)
class _Term:
    """A term of the equations below eq. 7 with another letter than the spring's energy has."""

    row: int  #: of the coordinate whose equation it is, and of the one that it multiplies, from 0
    column: int
    printed: str  #: coefficient as printed, of one spring or damper
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


def _row_cases(matrices: TubMatrices) -> Iterator[Case]:
    """Springs and dampers in the equations of alpha, beta and gamma, term by term."""
    import sympy as sp

    for term in _TERMS:
        computed = matrices.stiffness[term.row, term.column]
        if not term.rate and sp.expand(sp.sympify(term.printed) - computed) == 0:
            continue
        of = _NAMES[term.column] + ("'" if term.damping else "")
        shown, derived = (_as_damping(_written(text), term.damping) for text in (term.printed, computed))
        kind = "rate" if term.rate else "damping" if term.damping else "stiffness"
        words = {"of": of, "row": _NAMES[term.row], "kind": kind}
        words["part"] = "damper (h_x, h_y, h_z)" if term.damping else "spring (c_x, c_y, c_z)"
        words["printed"] = f"0, and {shown} of {of}'" if term.rate else shown
        rate, symmetric = "a stiffness multiplies the angle, not its rate", "symmetric, as J^T c J is"
        yield CLAIMS.case("dr-equation", derived, note=rate if term.rate else symmetric, **words)


def _written(expression: object) -> str:
    """An expression as on paper: `2 x y^2`."""
    return str(expression).replace("**", "^").replace("*", " ")


def _as_damping(text: str, damping: bool) -> str:
    return text.replace("c_", "h_") if damping else text


# Products of rates in eq. 4 and what they are printed and meant to go with.
_PRODUCTS = (
    (1, 4, "m_2*z_D", -1.0, "the bracket with beta' z_D goes with -gamma' y_D, not with -y'"),
    (4, 5, "m_2*y_D*z_D", 0.0, "the bracket with beta' z_D goes with -gamma' y_D, not with -y'"),
    (3, 5, "m_2*x_D*z_D", 0.0, "printed is alpha' x_D z_D alone, which has not the dimension of the rest"),
)


def _energy_cases(matrices: TubMatrices) -> list[Case]:
    """Eq. 4: products of rates in the kinetic energy, which are the places of the mass matrix."""
    import sympy as sp

    return [
        CLAIMS.case(
            "dr-eq-4",
            float(sp.simplify(matrices.mass[first, second] / sp.sympify(unit))),
            first=_NAMES[first],
            second=_NAMES[second],
            unit=_written(unit),
            printed=printed,
            why=why,
        )
        for first, second, unit, printed, why in _PRODUCTS
    ]


def _energy_of_unbalance() -> Case:
    """Eq. 4: the energy that the unbalanced mass has by its own circle alone."""
    import sympy as sp

    mass, radius, spin, time = sp.symbols("m_2 e omega t", positive=True)
    place = sp.Matrix([-radius * sp.cos(spin * time), radius * sp.sin(spin * time)])
    energy = sp.simplify(mass * place.diff(time).dot(place.diff(time)) / 2)
    unit = mass * spin**2 * radius**2
    return CLAIMS.case("dr-eq-4-unbalance", float(sp.simplify(energy / unit)))


def _energy_of_spin(matrices: TubMatrices) -> Case:
    """Eq. 4: what its last bracket makes of the coupling of alpha and gamma."""
    import sympy as sp

    unit = sp.symbols("J_b") * sp.symbols("omega")
    return CLAIMS.case("dr-eq-4-gyroscopic", float(sp.simplify(matrices.gyroscopic[5, 3] / unit)))


def _groups(matrices: TubMatrices) -> Case:
    """Which coefficients of the stiffness matrix are static moments, linear in a place."""
    import sympy as sp

    place, scale = sp.symbols("x y z"), sp.Symbol("s")
    static = []
    for row, column in _PLACES:
        entry = matrices.stiffness[row - 1, column - 1]
        scaled = entry.subs({length: scale * length for length in place}, simultaneous=True)
        if entry != 0 and sp.expand(scaled - scale * entry) == 0:
            static.append((row, column))
    inside = sum(row <= 3 and column <= 3 for row, column in static)
    return CLAIMS.case(
        "dr-third-group",
        f"i <= 3 < j: {len(static) - inside} of them, and {inside} with i, j <= 3",
        inside >= len(static),
    )
