"""Errata of the sources: every wrong formula evaluated as printed and as derived [theory: errata].

Those of the suspended tub follow from the energies of tub and drum. Coordinates x, y, z, alpha, beta, gamma,
angles about the axes in that order; the drum spins about y. Mass, gyroscopic and stiffness matrices are
derivatives of the energies at rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fluid.printed import (
    dry_volume_as_printed,
    dry_volume_frozen_angle,
    liquid_angle_as_printed,
    liquid_volume_by_lens,
    optimal_volume_as_printed,
    optimal_volume_by_lens,
    optimal_volume_disc_corrected,
)
from fluid.upright import free_surface_term
from meshes.chamber import Chamber
from solvers.rotor.vector_model import balance_angles, balance_residual
from validation.cases.case import Case, compare

GRAVITY = 9.81

# Where the formulas of the liquid are compared. The sources evaluate none of them, so any chamber would do.
_CHAMBER = Chamber(radius=0.2, height=0.05)
_SPEED = 90.0
_ECCENTRICITY = 0.001
_WHERE = "R = 0.2 m, h = 0.05 m, 90 rad/s, e = 1 mm"

# Figures are taken as right to half a per cent; the errata are off by far more.
_TOLERANCE = 0.005


def cases() -> list[Case]:
    """Every erratum found, each with its printed and its derived value.

    Returns
    -------
    Cases in the order of the sources
    """
    return [
        *tub_cases(),
        *_optimal_volume(),
        _dry_volume(),
        _upright_angle(),
        _oblate(),
        _liquid_angle("errata/dr-eq-25", "DR18, eq. 25"),
        _liquid_angle("errata/dg-eq-4", "DG21, eq. 4"),
        *_artificial_unbalance(),
        _kinetic_energy(),
    ]


def _optimal_volume() -> list[Case]:
    at = (_CHAMBER, _ECCENTRICITY, _SPEED, GRAVITY)
    corrected = optimal_volume_disc_corrected(*at)
    volume = compare(
        "errata/dr-eq-18",
        "DR18, eq. 18",
        f"optimal volume, m^3 ({_WHERE})",
        optimal_volume_as_printed(*at),
        optimal_volume_by_lens(*at),
        tolerance=_TOLERANCE,
        otherwise="erratum",
        note=f"moment about the rotation axis: {corrected * 1e6:.1f} ml; a disc still stands for a lens",
    )
    near = _CHAMBER.radius - _ECCENTRICITY
    far = math.sqrt(2.0 * GRAVITY * _CHAMBER.height / _SPEED**2 + near**2)
    s = near + far
    moment = compare(
        "errata/dr-eq-18-moment",
        "DR18, eq. 18",
        f"polar moment of the air's section at the lid over pi s^4 ({_WHERE})",
        3.0 / 32.0,
        _polar_moment_about_axis(0.5 * s, 0.5 * (far - near)) / (math.pi * s**4),
        tolerance=_TOLERANCE,
        otherwise="erratum",
        note=f"about a point of the rim it is {_polar_moment_about_axis(0.5, 0.5) / math.pi:.5f}",
    )
    return [volume, moment]


def _polar_moment_about_axis(radius: float, distance: float) -> float:
    """Polar moment of a disc about an axis at that distance from its centre, by quadrature."""
    node, weight = np.polynomial.legendre.leggauss(4)
    r = 0.5 * radius * (1.0 + node)
    angle = 2.0 * np.pi * np.arange(8) / 8
    # Trapezoid and Gauss points are exact for these polynomials.
    squared = (distance + r[:, None] * np.cos(angle)) ** 2 + (r[:, None] * np.sin(angle)) ** 2
    return float(np.sum(0.5 * radius * weight * r * squared.mean(axis=1)) * 2.0 * np.pi)


def _dry_volume() -> Case:
    # The waterline on the floor crosses the wall half way between its near and its far point.
    constant = _SPEED**2 / (2.0 * GRAVITY) * _CHAMBER.radius**2
    at = (_CHAMBER, constant, _ECCENTRICITY, _SPEED, GRAVITY)
    return compare(
        "errata/dr-eq-20",
        "DR18, eq. 20",
        f"volume with its waterline on the floor at r = R, m^3 ({_WHERE})",
        dry_volume_as_printed(*at),
        liquid_volume_by_lens(*at),
        tolerance=_TOLERANCE,
        otherwise="erratum",
        note=f"repaired, the angle frozen at the floor: {dry_volume_frozen_angle(*at) * 1e6:.2f} ml",
    )


def _upright_angle() -> Case:
    """DR18, eq. 22 for the upright axis, its integral over the angle taken of 1 as it stands."""
    density, constant = 998.2, -0.8 * _SPEED**2 / (2.0 * GRAVITY) * _CHAMBER.radius**2
    node, weight = np.polynomial.legendre.leggauss(8)
    low, high = np.sqrt(
        np.minimum(
            2.0 * GRAVITY / _SPEED**2 * np.array([-constant, _CHAMBER.height - constant]), _CHAMBER.radius**2
        )
    )
    r = 0.5 * (low + high) + 0.5 * (high - low) * node
    bracket = _SPEED**2 / GRAVITY**2 * (0.5 * _SPEED**2 * r**2 + GRAVITY * constant) + 1.0
    printed = (
        density * GRAVITY * 2.0 * math.pi * float(np.sum(0.5 * (high - low) * weight * bracket**2 * r**3))
    )
    return compare(
        "errata/dr-eq-22",
        "DR18, eq. 22",
        "a, N m (R = 0.2 m, h = 0.05 m, 90 rad/s, upright, fixed point at the floor, C = -0.8 beta R^2)",
        printed,
        float(free_surface_term(_CHAMBER, 0.0, constant, _SPEED, GRAVITY, density)),
        tolerance=_TOLERANCE,
        otherwise="erratum",
        note="the integrand lacks cos^2(phi); over the plan of the free surface",
    )


def _oblate() -> Case:
    """Largest height over radius of a solid cylinder whose axis has the larger moment of inertia."""
    import sympy as sp

    height, r, phi, z = sp.symbols("height r phi z", positive=True)
    difference = sp.integrate(
        ((r * sp.cos(phi)) ** 2 - z**2) * r, (r, 0, 1), (phi, 0, 2 * sp.pi), (z, -height / 2, height / 2)
    )
    (limit,) = (root for root in sp.solve(difference, height) if root.is_positive)
    return Case(
        "errata/dr-oblate",
        "DR18, remark below eq. 22",
        "height over radius of a cylinder with C_0 > A_0",
        "much greater than 1",
        float(limit),
        "the opposite",
        "erratum",
        "upper limit for a full chamber about its centre; a fixed point elsewhere lowers it",
    )


def _liquid_angle(name: str, source: str) -> Case:
    lag, ratio = math.radians(30.0), 0.8
    printed = liquid_angle_as_printed(lag, ratio)
    _, computed = balance_angles(lag, ratio)
    left, right = (abs(float(balance_residual(angle, lag, ratio))) for angle in (printed, computed))
    return compare(
        name,
        source,
        "alpha_0, rad (delta = 30 deg, k = 0.8)",
        printed,
        float(computed),
        tolerance=_TOLERANCE,
        otherwise="erratum",
        note=f"second root; left of the balance of forces: {left:.2g} as printed, {right:.0e} as derived",
    )


def _artificial_unbalance() -> list[Case]:
    """DG21, section 4: amplitude of a body on springs far above resonance, and the largest at any speed."""
    tub, drum, eccentricity = 48.2, 12.5, 14.8e-3
    springs, dampers = (
        2 * 6.0e3 * math.sin(math.radians(75.0)) ** 2,
        2 * 175.0 * math.sin(math.radians(70.0)) ** 2,
    )
    mass, unbalance, printed = tub + drum, 1800e-6, 3.7e-3
    speed = np.geomspace(0.1, 1e4, 4001)
    response = speed**2 / np.abs(springs - mass * speed**2 + 1j * dampers * speed)
    far = float(response[-1])
    note = (
        f"m_2 e = {drum * eccentricity * 1e6:.0f} g mm of the same paper gives "
        f"{drum * eccentricity * far * 1e3:.2f} mm far above resonance"
    )
    found = []
    for name, meaning, factor in (
        ("far", "far above resonance", far),
        ("peak", "at the worst speed", float(response.max())),
    ):
        found.append(
            compare(
                f"errata/dg-section-4-{name}",
                "DG21, section 4 and table 1",
                f"vertical amplitude for 1800 g mm, m, {meaning}",
                printed,
                unbalance * factor,
                tolerance=0.1,
                otherwise="erratum",
                note=note,
            )
        )
    return found


def _kinetic_energy() -> Case:
    """FF20, eq. 10: coefficient of y eta_G in the energy of translation over M omega^2/2."""
    import sympy as sp

    x, y, xi, eta = sp.symbols("x y xi eta")
    energy = sp.Poly((x + xi) ** 2 + (y + eta) ** 2, x, y, xi, eta)
    printed = sp.Poly(x**2 + y**2 + 2 * (x * xi + 2 * y * eta) + xi**2 + eta**2, x, y, xi, eta)
    return compare(
        "errata/ff-eq-10",
        "FF20, eq. 10",
        "coefficient of y eta_G in T_tr over M omega^2/2",
        float(printed.coeff_monomial(y * eta)),
        float(energy.coeff_monomial(y * eta)),
        tolerance=0.0,
        otherwise="erratum",
        note="eq. 13 of the same paper has it right",
    )


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


def tub_cases() -> list[Case]:
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
