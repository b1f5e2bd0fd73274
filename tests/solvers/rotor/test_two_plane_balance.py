"""Conditions of two-plane balancing: against the potential, resonances of the whole rotor, special cases."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshes.errors import InputError
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.stability import balanced_stability
from solvers.rotor.balls.two_plane_balance import (
    RigidRotor,
    dynamic_balancing,
    of_two_planes,
    plane_compliance,
    potential_hessian,
    single_plane_balancing,
)
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from tests.mutants import kills

ROTOR = RigidRotor(10.0, (0.5, 0.6, 0.1), (1e4, 1.3e4), (0.2, -0.25))


@kills(
    "solvers.rotor.balls.two_plane_balance:RigidRotor.support", "sum(k * z for k, z", "sum(-k * z for k, z"
)
@kills(
    "solvers.rotor.balls.two_plane_balance:RigidRotor.support", "sum(k * z * z for k, z", "sum(k * z for k, z"
)
def test_support() -> None:
    """[FF20, eq. 17]."""
    k1, k2, l1, l2 = 1e4, 1.3e4, 0.2, 0.25
    assert ROTOR.support == pytest.approx((k1 + k2, k1 * l1 - k2 * l2, k1 * l1**2 + k2 * l2**2), rel=1e-15)


def elastic_less_kinetic(rotor: RigidRotor, speed: float, q: np.ndarray) -> float:
    """Potential of a turning rigid rotor by its definition, to second order in q = (alpha, beta, x, y).

    Supports stretch by (x + z beta, y - z alpha); the inertia about the axis of rotation of a body tilted by
    alpha about its first and beta about its second axis is n^T J n with the rotation axis n in the body.
    """
    alpha, beta, x, y = q
    elastic = sum(
        0.5 * k * ((x + z * beta) ** 2 + (y - z * alpha) ** 2)
        for k, z in zip(rotor.stiffness, rotor.position, strict=True)
    )
    axis = np.array([-math.cos(alpha) * math.sin(beta), math.sin(alpha), math.cos(alpha) * math.cos(beta)])
    inertia = axis @ np.diag(rotor.inertia) @ axis + rotor.mass * (x * x + y * y)
    return elastic - 0.5 * speed**2 * float(inertia)


@kills(
    "solvers.rotor.balls.two_plane_balance:potential_hessian",
    "tilt_x, tilt_y = (b - c)",
    "tilt_x, tilt_y = (a - c)",
)
@kills(
    "solvers.rotor.balls.two_plane_balance:potential_hessian",
    "[0.0, tilt_y, -k14, 0.0]",
    "[0.0, tilt_y, k14, 0.0]",
)
@kills(
    "solvers.rotor.balls.two_plane_balance:potential_hessian",
    "[k14, 0.0, 0.0, shift]",
    "[-k14, 0.0, 0.0, shift]",
)
@kills(
    "solvers.rotor.balls.two_plane_balance:potential_hessian",
    "shift = rotor.mass * speed**2 - k11",
    "shift = rotor.mass * speed**2 + k11",
)
def test_hessian() -> None:
    """Minus the second differences of elastic less kinetic energy.

    The sign turns where the unbalances are eliminated instead of the coordinates.
    Second differences of an order-1e4 energy over 1e-3: fourth order terms 1e-6, rounding 1e-12/1e-6 of 1e4.
    """
    speed, step = 130.0, 1e-3
    matrix = np.zeros((4, 4))
    for i in range(4):
        for j in range(4):
            value = 0.0
            for a in (-1, 1):
                for b in (-1, 1):
                    q = np.zeros(4)
                    q[i] += a * step
                    q[j] += b * step
                    value += a * b * elastic_less_kinetic(ROTOR, speed, q)
            matrix[i, j] = -value / (4 * step**2)
    found = potential_hessian(ROTOR, speed)
    assert found == pytest.approx(matrix, rel=1e-4, abs=1e-5 * np.abs(matrix).max())


@kills(
    "solvers.rotor.balls.two_plane_balance:dynamic_balancing",
    "v11, v22, v33 = (b - c)",
    "v11, v22, v33 = (b + c)",
)
@kills(
    "solvers.rotor.balls.two_plane_balance:dynamic_balancing",
    "(a - c) * square - k33",
    "(a - c) * square + k33",
)
@kills("solvers.rotor.balls.two_plane_balance:dynamic_balancing", "rotor.mass * square - k11", "square - k11")
@kills(
    "solvers.rotor.balls.two_plane_balance:dynamic_balancing",
    "v11 * v33 - k14 * k14",
    "v11 * v33 + k14 * k14",
)
@kills(
    "solvers.rotor.balls.two_plane_balance:dynamic_balancing",
    "v22 * v33 - k14 * k14",
    "v11 * v33 - k14 * k14",
)
def test_conditions() -> None:
    """Yes exactly where the Hessian is positive definite, over speed; the limit is where it becomes so."""
    answer = dynamic_balancing(ROTOR, np.linspace(0.0, 200.0, 401))
    for speed, possible in zip(answer.speed, answer.possible, strict=True):
        hessian = potential_hessian(ROTOR, float(speed))
        assert possible == bool(np.linalg.eigvalsh(hessian).min() > 0.0)
    minors = [hessian[k, k] for k in range(3)]
    minors += [np.linalg.det(hessian[np.ix_(pair, pair)]) for pair in ((0, 3), (1, 2))]
    assert [one.value[-1] for one in answer.conditions[2:]] == pytest.approx(minors, rel=1e-12)
    limit = np.linalg.eigvalsh(potential_hessian(ROTOR, answer.above))
    assert abs(limit[0]) < 1e-10 * limit[-1]
    assert answer.above == max(answer.resonances) and len(answer.resonances) == 4 and answer.long
    for one in answer.conditions:
        if 0.0 < one.above < 200.0:
            assert np.all(one.satisfied[answer.speed > one.above])
            below = np.interp(one.above * (1.0 - 1e-3), answer.speed, one.value)
            assert below < np.interp(one.above * 1.1, answer.speed, one.value)


@kills(
    "solvers.rotor.balls.two_plane_balance:_tilt_limits",
    "excess * k11 + rotor.mass * k33",
    "excess * k11 + 2.0 * rotor.mass * k33",
)
@kills(
    "solvers.rotor.balls.two_plane_balance:_tilt_limits",
    "k11 * k33 - k14 * k14\n    # Never",
    "k11 * k33 + k14 * k14\n    # Never",
)
@kills(
    "solvers.rotor.balls.two_plane_balance:of_two_planes", "mass=rotor.mass + added_mass", "mass=rotor.mass"
)
def test_resonances() -> None:
    """They are the speeds at which the whole undamped rotor has no stiffness against its unbalance."""
    rotor = TwoPlane(10.0, 0.5, 0.1, (Support(0.2, 1e4, 0.0), Support(-0.25, 1.3e4, 0.0)))
    system = rotor.system()
    scale = np.linalg.eigvalsh(system.stiffness)
    for speed in dynamic_balancing(of_two_planes(rotor), 1.0).resonances:
        matrix = system.stiffness - speed**2 * system.mass + 1j * speed**2 * system.gyroscopic
        # Scaled by masses: a singular value at rounding.
        singular = np.linalg.svd(matrix)[1]
        assert singular[-1] < 1e-9 * scale[-1]
    assert of_two_planes(rotor, 0.5).mass == 10.5


@kills("solvers.rotor.balls.two_plane_balance:_root", "math.sqrt(stiffness / inertia)", "stiffness / inertia")
def test_uncoupled() -> None:
    """k14 = 0 [FF20, eq. 34]: the largest of three square roots."""
    rotor = RigidRotor(8.0, (0.5, 0.7, 0.2), (1e4, 1e4), (0.3, -0.3))
    answer = dynamic_balancing(rotor, [10.0, 300.0])
    roots = [math.sqrt(2e4 / 8.0), math.sqrt(1800.0 / 0.3), math.sqrt(1800.0 / 0.5)]
    assert answer.above == pytest.approx(max(roots), rel=1e-14)
    assert sorted(answer.resonances) == pytest.approx(sorted(roots), rel=1e-14)
    assert [one.above for one in answer.conditions[2:5]] == pytest.approx(
        [roots[2], roots[1], roots[0]], rel=1e-14
    )
    assert answer.possible.tolist() == [False, True]


def test_a_short_rotor_is_never_balanced() -> None:
    short = RigidRotor(10.0, (0.1, 0.1, 0.15), (1e4, 1.3e4), (0.2, -0.25))
    answer = dynamic_balancing(short, np.linspace(0.0, 1e4, 201))
    assert not answer.possible.any() and math.isinf(answer.above) and not answer.long
    assert len(answer.resonances) == 1
    assert "A > C fails at every speed" in answer.why(100)


def test_a_rotor_long_one_way_is_not_long() -> None:
    answer = dynamic_balancing(RigidRotor(10.0, (0.2, 0.1, 0.15), (1e4, 1e4), (0.2, -0.2)), [1e4])
    assert not answer.possible[0] and "B > C" in answer.why()


def test_the_answer_says_why() -> None:
    answer = dynamic_balancing(ROTOR, [10.0, 500.0])
    assert answer.why(0).startswith("no: ") and f"{answer.above:.6g}" in answer.why(1)
    assert answer.why(1).startswith("yes")


long_ones = st.tuples(st.floats(0.2, 2.0), st.floats(0.2, 2.0), st.floats(0.01, 0.19)).filter(
    lambda j: abs(j[0] - j[1]) <= j[2]
)


@given(
    long_ones,
    st.floats(1.0, 100.0),
    st.tuples(st.floats(1e3, 1e6), st.floats(1e3, 1e6)),
    st.floats(0.05, 0.5),
)
def test_the_limit_separates_no_from_yes(
    inertia: tuple[float, float, float], mass: float, stiffness: tuple[float, float], far: float
) -> None:
    rotor = RigidRotor(mass, inertia, stiffness, (0.2, -far))
    above = dynamic_balancing(rotor, 1.0).above
    answer = dynamic_balancing(rotor, [above * (1.0 - 1e-9), above * (1.0 + 1e-9), 10.0 * above])
    assert answer.possible.tolist() == [False, True, True]
    eigenvalues = [np.linalg.eigvalsh(potential_hessian(rotor, float(w)))[0] for w in answer.speed]
    assert eigenvalues[0] < 0.0 < eigenvalues[2]


@pytest.mark.parametrize(
    "values",
    [
        (0.0, (0.5, 0.5, 0.1), (1e4, 1e4), (0.2, -0.2)),
        (10.0, (0.5, 0.0, 0.1), (1e4, 1e4), (0.2, -0.2)),
        (10.0, (0.5, 0.5, 1.1), (1e4, 1e4), (0.2, -0.2)),
        (10.0, (0.5, 0.5, 0.1), (1e4, -1e4), (0.2, -0.2)),
        (10.0, (0.5, 0.5, 0.1), (1e4,), (0.2,)),
        (10.0, (0.5, 0.5, 0.1), (1e4, 1e4), (0.2, 0.2)),
        (10.0, (0.5, 0.5, 0.1), (1e4, 1e4), (0.2,)),
        (10.0, (0.5, 0.5, 0.1), (1e4, 1e4), (0.2, math.nan)),
    ],
)
def test_bad_rotors_are_refused(values: tuple[float, ...]) -> None:
    with pytest.raises(InputError):
        RigidRotor(*values)


def test_bad_speeds_are_refused() -> None:
    for speed in (-1.0, math.nan, [[1.0]]):
        with pytest.raises(InputError):
            dynamic_balancing(ROTOR, speed)


def circulatory(damping: Sequence[float], position: Sequence[float]) -> np.ndarray:
    """B_1: what damping supports do to a deflection at rest in the rotor, over the speed [FF20, eq. 25].

    Damping of each support, N s/m, at its position from the centre of mass, m; a skew matrix for (alpha,
    beta, x, y) [theory: balls, eq. 41].
    """
    pairs = list(zip(damping, position, strict=True))
    b11, b14, b33 = (sum(b * z**k for b, z in pairs) for k in range(3))
    return np.array(
        [
            [0.0, -b33, -b14, 0.0],
            [b33, 0.0, 0.0, -b14],
            [b14, 0.0, 0.0, -b11],
            [0.0, b14, b11, 0.0],
        ]
    )


def turning_state(rotor: RigidRotor, damping: list[float], speed: float, unbalance: np.ndarray) -> np.ndarray:
    """Steady deflection (alpha, beta, x, y) in the turning frame, by the source's matrices [FF20, eq. 27-29].

    For the unbalance (-I_eta_zeta, I_xi_zeta, M xi_G, M eta_G). The source has its V with the other sign
    here, see theory: balls, eq. 42.
    """
    matrix = speed * circulatory(damping, rotor.position) - potential_hessian(rotor, speed)
    return np.linalg.solve(matrix, speed**2 * unbalance)


def test_dissipative_function_of_the_source() -> None:
    """[FF20, eq. 22-26] by sympy: three parts as printed, the matrix, and a half too much in eq. 26."""
    sympy = pytest.importorskip("sympy")
    a, b, x, y, da, db, dx, dy, w, l1, l2, b1, b2 = sympy.symbols("a b x y da db dx dy w l1 l2 b1 b2")
    whole = 0
    for drag, z in ((b1, l1), (b2, -l2)):
        whole += drag / 2 * ((dx + z * db - w * (y - z * a)) ** 2 + (dy - z * da + w * (x + z * b)) ** 2)
    b11, b14, b33 = b1 + b2, b1 * l1 - b2 * l2, b1 * l1**2 + b2 * l2**2
    square = b11 * (dx**2 + dy**2) + 2 * b14 * (db * dx - da * dy) + b33 * (da**2 + db**2)
    linear = b11 * (x * dy - y * dx) + b14 * (a * dx - x * da + b * dy - db * y) + b33 * (db * a - b * da)
    rest = b11 * (x**2 + y**2) + 2 * b14 * (b * x - a * y) + b33 * (a**2 + b**2)
    half = sympy.Rational(1, 2)
    assert sympy.expand(whole - half * square - w * linear - half * w**2 * rest) == 0
    q, rate = sympy.Matrix([a, b, x, y]), sympy.Matrix([da, db, dx, dy])
    matrix = sympy.Matrix([[0, -b33, -b14, 0], [b33, 0, 0, -b14], [b14, 0, 0, -b11], [0, b14, b11, 0]])
    # Eq. 26 prints half of this; eq. 27 goes on with the whole.
    assert sympy.expand(w * linear - w * (rate.T * matrix * q)[0]) == 0
    values = {b1: 3.0, b2: 5.0, l1: 0.2, l2: 0.3}
    expected = np.array(matrix.subs(values).tolist(), dtype=float)
    assert circulatory([3.0, 5.0], [0.2, -0.3]) == pytest.approx(expected, rel=1e-14)


@kills("solvers.rotor.balls.two_plane_balance:plane_compliance", "- 2.0 * position", "+ 2.0 * position")
@pytest.mark.parametrize("speed", [20.0, 47.0, 130.0])
def test_steady_state_by_the_sources_matrices(speed: float) -> None:
    """[FF20, eq. 27-29], with V's sign as derived, against the response of the whole rotor."""
    supports = (Support(0.2, 1e4, 40.0), Support(-0.25, 1.3e4, 15.0))
    plane = PlaneUnbalance(0.15, 1e-3, 0.7)
    rotor = TwoPlane(10.0, 0.5, 0.1, supports, (plane,))
    system = rotor.system()
    matrix = (
        system.stiffness - speed**2 * system.mass + 1j * speed * (system.damping + speed * system.gyroscopic)
    )
    whirl = np.linalg.solve(matrix, speed**2 * system.unbalance)
    at = plane.size * np.array([math.cos(plane.angle), math.sin(plane.angle)])
    unbalance = np.array([-plane.position * at[1], plane.position * at[0], *at])
    rigid = of_two_planes(rotor)
    found = turning_state(rigid, [40.0, 15.0], speed, unbalance)
    # q is the whirl at time 0: its real part; two solves of matrices of condition 1e3.
    expected = whirl.real[[2, 3, 0, 1]]
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-12 * np.abs(expected).max())
    compliance = plane_compliance(rigid, plane.position, speed, [40.0, 15.0])
    seen = (system.at(plane.position)[0] @ whirl) / (speed**2 * plane.size * np.exp(0.7j))
    assert complex(compliance) == pytest.approx(complex(seen), rel=1e-9)


@kills("solvers.rotor.balls.two_plane_balance:single_plane_balancing", ".real < 0.0", ".real > 0.0")
@pytest.mark.parametrize("inertia", [(0.5, 0.1), (0.1, 0.18)], ids=["long", "short"])
@pytest.mark.parametrize("damping", [0.5, 40.0, 400.0])
def test_one_plane_balances_where_the_roots_say_so(inertia: tuple[float, float], damping: float) -> None:
    """Balls of 1e-6 of the rotor with heavy drag, long and short rotors, planes on both sides: same answer.

    Where |Re g| is small beside |g| the balls' share in the mass, 1e-6, could decide; none of the speeds is
    that close.
    """
    supports = (Support(0.2, 1e4, damping), Support(-0.22, 1.1e4, damping))
    seen = []
    for position in (0.05, 0.25):
        mass = 5e-6
        race = BallRace(position, 0.08, (mass, mass), 0.5)
        unbalance = PlaneUnbalance(position, 1.2 * mass * 0.08, 0.3)
        rotor = TwoPlane(10.0, *inertia, supports, (unbalance,))
        for speed in (25.0, 47.0, 60.0, 90.0, 160.0):
            rigid = of_two_planes(rotor)
            g = complex(plane_compliance(rigid, position, speed, [damping] * 2))
            assert abs(g.real) > 1e-4 * abs(g)
            said = bool(single_plane_balancing(rigid, position, speed, [damping] * 2))
            assert said == balanced_stability(rotor.system(), (race,), speed).stable, (position, speed)
            seen.append(said)
    assert any(seen) and not all(seen)


def test_the_roots_stand_beside_the_conditions() -> None:
    """Weak supports: the conditions say yes at 60 rad/s, the balls whirl; with 40 N s/m both say yes."""
    races = tuple(BallRace(z, 0.08, (0.015, 0.015), 0.3) for z in (0.15, -0.15))
    for damping, holds in ((0.5, False), (40.0, True)):
        supports = (Support(0.2, 1e4, damping), Support(-0.22, 1.1e4, damping))
        rotor = TwoPlane(10.0, 0.5, 0.1, supports, (PlaneUnbalance(0.15, 1e-3),))
        answer = dynamic_balancing(of_two_planes(rotor, 0.06), [60.0], (rotor.system(), races))
        assert answer.possible[0] and bool(answer.holds[0]) == holds and answer.growth is not None
        assert ("grows" in answer.why()) == (not holds)
    alone = dynamic_balancing(of_two_planes(rotor, 0.06), [60.0])
    assert alone.growth is None and alone.holds.tolist() == alone.possible.tolist()


@kills("solvers.rotor.balls.two_plane_balance:of_two_planes", "if not support.isotropic:", "if False:")
def test_supports_that_differ_in_two_directions_are_refused() -> None:
    """The conditions come from a potential that turns with the rotor: there is none where supports differ."""
    refused = []
    for unlike in (Support(0.3, (2e4, 1e4), 1.0), Support(0.3, 2e4, (1.0, 2.0))):
        try:
            of_two_planes(TwoPlane(10.0, 0.5, 0.1, (Support(-0.3, 2e4, 1.0), unlike)))
        except InputError as error:
            refused.append(error.field)
    assert refused == ["supports"] * 2
