"""Errata of the suspended tub's equations, derived from the energies of tub and drum.

Coordinates x, y, z, alpha, beta, gamma, angles about the axes in that order; the drum spins about y. Mass,
gyroscopic and stiffness matrices are derivatives of the energies at rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from validation.cases.case import Case, compare

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
    """Matrices at rest as sympy expressions, rows and columns in the order of the coordinates.

    Parameters
    ----------
    mass : of the drum's unbalanced mass m_2 at (x_D, y_D, z_D) and its inertias J_a, J_b
    gyroscopic : of the same, spinning at omega
    stiffness : of one spring (c_x, c_y, c_z) at (x, y, z)
    """

    mass: Any
    gyroscopic: Any
    stiffness: Any


def tub_matrices() -> TubMatrices:
    """Matrices of tub and drum from their energies [theory: errata, eq. 3-5].

    T = m_2 |v_D|^2/2 + (J_a (w_x^2 + w_z^2) + J_b (w_y + omega)^2)/2 and the energy of a spring, both for the
    rotation Q = R_z(gamma) R_x(alpha) R_y(beta), on whose sequence nothing depends at rest.

    Returns
    -------
    Matrices, 6 x 6
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
    return [*_gyroscopic_cases(matrices), *_stiffness_cases(matrices), *_order_cases(matrices)]


def _gyroscopic_cases(matrices: TubMatrices) -> list[Case]:
    """The coupling of alpha and gamma by the drum's spin."""
    import sympy as sp

    unit = sp.symbols("J_b") * sp.symbols("omega")
    found = []
    for equation, rate, row, column, printed in (
        ("alpha", "gamma", 3, 5, -2.0),
        ("gamma", "alpha", 5, 3, 2.0),
    ):
        computed = float(sp.simplify(matrices.gyroscopic[row, column] / unit))
        found.append(
            compare(
                f"errata/dr-gyroscopic-{equation}",
                "DR18, equations below eq. 7",
                f"coefficient of {rate}' in the equation of {equation}, over J_b omega",
                printed,
                computed,
                tolerance=0.0,
                otherwise="erratum",
                note="from the kinetic energy of the spinning drum; the sign is right",
            )
        )
    return found


def _stiffness_cases(matrices: TubMatrices) -> list[Case]:
    """The stiffness coefficients in which the printed list and the springs' energy part."""
    import sympy as sp

    wrong = []
    for row, column in _PLACES:
        printed = sp.sympify(_PRINTED_STIFFNESS.get((row, column), "0"))
        computed = matrices.stiffness[row - 1, column - 1]
        if sp.expand(printed - computed) != 0:
            wrong.append((row, column, str(printed), str(computed)))
    return [
        Case(
            f"errata/dr-a{row}{column}",
            "DR18, list below eq. 8",
            f"a_{row}{column} of one spring (c_x, c_y, c_z) at (x, y, z)",
            printed,
            computed,
            "another expression",
            "erratum",
            f"from the springs' energy; {len(_PLACES) - len(wrong)} of {len(_PLACES)} coefficients agree",
        )
        for row, column, printed, computed in wrong
    ]


def _order_cases(matrices: TubMatrices) -> list[Case]:
    """How often gamma is differentiated in the equation of y."""
    import sympy as sp

    unit = sp.symbols("m_2") * sp.symbols("x_D")
    found = []
    for order, matrix, printed in (("gamma'", matrices.gyroscopic, 1.0), ("gamma''", matrices.mass, 0.0)):
        found.append(
            compare(
                f"errata/dr-y-equation-{'first' if printed else 'second'}-derivative",
                "DR18, equations below eq. 7",
                f"coefficient of {order} in the equation of y, over m_2 x_D",
                printed,
                float(sp.simplify(matrix[1, 5] / unit)),
                tolerance=0.0,
                otherwise="erratum",
                note="the equations of z, alpha, beta and gamma print first derivatives in the same way",
            )
        )
    return found
