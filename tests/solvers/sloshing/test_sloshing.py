"""Sloshing by finite elements: exact waves and force of the ring, series for sectors, balances, limits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fluid.waves import force_ratio, free_wave_frequencies
from meshes.baffles import Baffles
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection, liquid_section
from meshes.rings.quadrilaterals import ring
from meshes.rings.triangles import ring as triangles
from solvers.sloshing.forced import displacement_field, forced_response, newton_force, pressure_force
from solvers.sloshing.modes import HARMONICS, sloshing_modes, spectrum
from solvers.sloshing.system import LiquidSystem, condense, gradients, stiffness, surface_forms, wall_points
from tests.mutants import kills
from tests.oracles.sloshing import sector_frequencies, sectors_force

R, A, SPIN = 0.15, 0.135, 40.0
LOG = math.log(R / A)
WHIRLS = np.array([0.0, 0.1, -0.5, 0.5, 0.7, 0.9, 1.0, 1.2, 1.4, 1.5, 2.0, 5.0, 1e3, 1e8])


def quads(around: int, across: int, order: int = 2, baffles: Baffles | None = None) -> LiquidSystem:
    return condense(ring(R, A, around, across, order=order, baffles=baffles))


def wave_errors(system: LiquidSystem, log: float = LOG, modes: tuple[int, ...] = (1, 2, 3)) -> np.ndarray:
    """Relative errors of the free waves of a ring, prograde and retrograde, against the closed form."""
    found = spectrum(system).frequency
    exact = [np.abs(one) for n in modes for one in free_wave_frequencies(n, log, 1.0)]
    return np.array([np.min(np.abs(found / one - 1.0)) for one in exact])


@kills("solvers.sloshing.system:surface_forms", "broadcast_to(-first", "broadcast_to(first")
@kills(
    "solvers.sloshing.system:_Parts.schur",
    "whole[:, part] -= self.coupling.T",
    "whole[:, part] += self.coupling.T",
)
@kills("solvers.sloshing.modes:spectrum", "= -1j * (turned - turned.T)", "= -0.5j * (turned - turned.T)")
@kills(
    "solvers.sloshing.modes:sloshing_modes",
    "np.where(travel < 0.0, -1.0, 1.0)",
    "np.where(travel < 0.0, 1.0, -1.0)",
)
def test_waves_of_the_ring() -> None:
    """Exact waves of the ring, and their signs, to the error of the elements on 48 by 3 cells."""
    system = quads(48, 3)
    # n^4 (2 pi/48)^4/720 bounds the error of quadratic elements on n waves; twice for the depth's part.
    assert np.all(wave_errors(system) < np.repeat([1e-6, 1e-5, 5e-5], 2))
    modes = sloshing_modes(system, SPIN, 8)
    for sigma, n in zip(modes.frequency, modes.crests, strict=True):
        pair = free_wave_frequencies(n, LOG, SPIN)
        assert min(abs(sigma / one - 1.0) for one in pair) < 1e-3
    assert modes.converged and np.all(modes.multiplicity == 1) and modes.circulations == 1


@kills(
    "solvers.sloshing.system:_enclosed_area",
    "area_within(section.points, section.surface) - across",
    "across",
)
@kills("solvers.sloshing.forced:forced_response", "force = second + 2.0 * 1j", "force = second - 2.0 * 1j")
@kills("solvers.sloshing.forced:_moments_of", "found[2] - np.tensordot", "found[2] + np.tensordot")
@kills("solvers.sloshing.forced:_moments_of", "np.concatenate([p, p.conj()])", "np.concatenate([p, p])")
@kills(
    "solvers.sloshing.forced:forced_response",
    "0.5 * (circle @ FORWARD.conj())",
    "0.5 * (circle @ BACKWARD.conj())",
)
def test_force_on_the_ring() -> None:
    """Force ratio on both sides of both resonances, at rest, under gravity and for whirls of any speed."""
    system = quads(128, 8)
    answer = forced_response(system, SPIN, WHIRLS * SPIN)
    exact = force_ratio((R / A) ** 2, WHIRLS)
    assert np.all(np.abs(answer.force_ratio - exact) < 1e-6 * np.maximum(1.0, np.abs(exact)))
    # No second circle in a section of full symmetry; rounding of a sum over modes.
    assert np.all(np.abs(answer.counter_ratio) < 1e-9)


def test_closed_sectors() -> None:
    """Frequencies and force of one to eight closed sectors against series of sines.

    The series' error falls as terms^-3 (its coefficients as m^-3, for the corner's z^2 log z): one step of
    extrapolation leaves 1e-9. The elements' error is (h m)^4, h the width of a cell over the sector.
    """
    for count, around, bound in ((1, 64, 2e-7), (2, 64, 3e-6), (3, 64, 1.5e-5), (8, 96, 2e-4)):
        system = quads(around, 4, 2, Baffles(count))
        angle = 2.0 * math.pi / count
        coarse, fine = (sector_frequencies(angle, LOG, terms, 2) for terms in (60, 120))
        exact = fine + (fine - coarse) / 7.0
        found = spectrum(system).frequency
        for k, sigma in enumerate(exact):
            same = found[k * count : (k + 1) * count]
            assert np.allclose(same, sigma, rtol=bound, atol=0.0), (count, k, same / sigma - 1.0)
        for slip in (-1.0, 0.11):
            rough, better = (sectors_force(count, R / A, slip, terms) for terms in (60, 120))
            expected = better + (better - rough) / 7.0
            tensor = forced_response(system, SPIN, SPIN * (1.0 + slip)).tensor
            # Gravity, slip -1, meets waves among the fast modes, whose error is larger.
            assert np.allclose(tensor, expected, rtol=0.0, atol=3e-4 if slip == -1.0 else 2e-5), (count, slip)


def test_compartments_keep_their_volume() -> None:
    """Synchronous whirl: the mean displacement of a closed compartment vanishes."""
    for count in (1, 2, 3, 6):
        answer = forced_response(quads(72, 2, 2, Baffles(count, first_angle=0.4)), SPIN, SPIN)
        exact = 1.0 - (A / R * count / math.pi * math.sin(math.pi / count)) ** 2
        # Elements of degree 2 on the circle: (2 pi/72)^4.
        assert abs(answer.force_ratio - exact) < 6e-5
    for baffles in (
        Baffles(1, 0.14),
        Baffles(2, 0.0, 0.004),
        Baffles(3, 0.139, 0.004),
        Baffles(5, 0.0, 0.001),
    ):
        answer = forced_response(quads(72, 2, 2, baffles), SPIN, SPIN)
        assert np.abs(answer.tensor - np.eye(2)).max() < 6e-5


def test_symmetry_of_the_answer() -> None:
    """Three or more equal sectors answer a circle by a circle; one or two do not."""
    for count in (1, 2, 3, 5):
        for baffles in (Baffles(count, first_angle=0.3), Baffles(count, 0.142), Baffles(count, 0.0, 0.006)):
            answer = forced_response(quads(30, 2, 2, baffles), SPIN, 1.15 * SPIN)
            if count > 2:
                assert np.abs(answer.counter_ratio) < 1e-8 * np.abs(answer.force_ratio)
            else:
                assert np.abs(answer.counter_ratio) > 1e-4
            # A frictionless liquid takes no power on the mean: force over deflection is Hermitian.
            change = 0.15j * np.eye(2) + np.array([[0.0, -1.0], [1.0, 0.0]])
            stiff = answer.tensor @ change @ change
            assert np.abs(stiff - stiff.conj().T).max() < 1e-8 * np.abs(stiff).max()


@kills("solvers.sloshing.system:moment_of", "(gyration.T @ section.points)", "(gyration @ section.points)")
@kills(
    "solvers.sloshing.forced:displacement_field",
    "slip**2 * system.inertia + 2j",
    "slip**2 * system.inertia - 2j",
)
@kills(
    "solvers.sloshing.forced:pressure_force", "walls.along @ force - slip**2", "walls.along @ force + slip**2"
)
@kills("solvers.sloshing.forced:pressure_force", "= -(spin**2) * section", "= spin**2 * section")
def test_pressure_and_newton() -> None:
    """Wall pressure and the motion of the centre of mass give the same force, baffles and all."""
    force = np.array([1.0, 0.3j])
    cases = (
        (None, 1e-5),
        # Gradients at walls, taken point by point: third order on a smooth wall, lower at edges and corners.
        (Baffles(2, 0.139, 0.004, 0.4), 1e-4),
        (Baffles(2, 0.142, first_angle=0.2), 2e-2),
        (Baffles(1, 0.0, first_angle=0.3), 1e-2),
        (Baffles(3, 0.0, 0.004), 3e-2),
    )
    for baffles, bound in cases:
        system = quads(64, 4, 2, baffles)
        for slip in (0.0, 30.0, -SPIN):
            field = displacement_field(system, SPIN, slip, force)
            newton, pressure = (
                one(system, SPIN, slip, force, field) for one in (newton_force, pressure_force)
            )
            scale = np.abs(newton).max()
            assert np.abs(newton - pressure).max() < bound * scale, (baffles, slip, newton, pressure)
            summed = forced_response(system, SPIN, SPIN + slip).tensor @ force * system.enclosed_area
            # Rounding: the finest cells at edges are 1e-5 of the others.
            assert np.abs(newton - summed).max() < 1e-6 * scale


def test_pieces_that_stand_free() -> None:
    """Natural condition: circulation along a piece changes as the difference of Pi between its ends."""
    force, slip = np.array([1.0, 0.5j]), 22.0
    for baffles in (Baffles(2, 0.139, 0.004, 0.4), Baffles(2, 0.0, 0.005, 0.2)):
        section = ring(R, A, 32, 3, baffles=baffles, times=2)
        system = condense(section)
        eta = system.on_nodes(displacement_field(system, SPIN, slip, force)[None])[0]
        walls = wall_points(section)
        jumps, flows = [], []
        pi = -(SPIN**2) * _slope_on_surface(section, eta) - section.points @ force
        for piece in np.flatnonzero(~section.fixed_piece):
            own = section.wall[section.wall_piece == piece]
            weight = np.isin(walls.points @ [1.0, 1j], _points_on(section, own))
            flows.append(-(slip**2) * np.sum(walls.weights[weight] * (walls.slope @ eta)[weight]))
            last, first = (
                np.intersect1d(own[:, 1], section.surface[:, 0]),
                np.intersect1d(own[:, 0], section.surface[:, 1]),
            )
            jumps.append(pi[last].sum() - pi[first].sum())
        scale = np.abs(force).max() * A
        assert np.abs(np.array(flows) - jumps).max() < 3e-3 * scale, (flows, jumps)
        if baffles.tip_radius == 0.0:
            assert np.abs(jumps).max() > 0.05 * scale  # and it is no small number


def _slope_on_surface(section: LiquidSection, eta: np.ndarray) -> np.ndarray:
    """eta_theta at the ends of sides, from the three nodes of a side, 0 elsewhere."""
    sides = section.surface
    start, end = section.points[sides[:, 0]], section.points[sides[:, 1]]
    turn = np.arctan2(start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0], np.sum(start * end, axis=1))
    e0, e1, em = eta[sides].T
    slope = np.zeros(len(section.points), dtype=complex)
    slope[sides[:, 0]] = (-3.0 * e0 - e1 + 4.0 * em) / turn
    slope[sides[:, 1]] = (e0 + 3.0 * e1 - 4.0 * em) / turn
    return slope


def _points_on(section: LiquidSection, sides: np.ndarray) -> np.ndarray:
    """Quadrature points of some sides as complex numbers, from the same rule."""
    picked = wall_points(
        LiquidSection(
            section.points, section.cells, section.surface, sides, np.zeros(len(sides), dtype=np.int64),
            np.array([True]), section.surface_radius,
        )
    )  # fmt: skip
    return np.asarray(picked.points @ [1.0, 1j])


@kills("solvers.sloshing.system:_gradients", "u.grad[0] * v.grad[0] +", "u.grad[0] * v.grad[0] -")
@kills(
    "solvers.sloshing.system:wall_points", "grads[:, 0] * unit[:, :, 1] -", "grads[:, 0] * unit[:, :, 1] +"
)
@kills(
    "solvers.sloshing.system:_along",
    "end - start + bend * (1.0 - 2.0 * t)",
    "end - start + bend * (1.0 - t)",
)
@kills(
    "solvers.sloshing.system:surface_forms",
    "[1.0, 7.0, -8.0], [-8.0, -8.0, 16.0]]) / 3.0",
    "[1.0, 7.0, -8.0], [-8.0, -8.0, 16.0]]) / 6.0",
)
def test_matrices() -> None:
    """K, C, B and P on functions known by hand, straight and curved cells of both kinds."""
    for section in (quads(96, 4).section, triangles(R, A, 96, layers=4), ring(R, A, 96, 4, order=1)):
        x, y = section.points.T
        bound = 3e-4 if section.order == 1 else 1e-6  # (2 pi/96)^(2 order)/12
        bound *= 4.0
        k, (c, b) = stiffness(section), surface_forms(section)
        area = math.pi * (R**2 - A**2)
        for one in (x, y, x + y):
            exact = area * (2.0 if one is not x and one is not y else 1.0)
            assert abs(one @ k @ one / exact - 1.0) < (1e-2 if section.order == 1 else 1e-5)
        # oint y_theta x = -oint x_theta y = pi a^2, oint x_theta^2 = pi a^2.
        assert abs(x @ (c @ y) / (math.pi * A**2) - 1.0) < bound
        assert abs(y @ (c @ x) / (-math.pi * A**2) - 1.0) < bound
        assert abs(x @ (b @ x) / (math.pi * A**2) - 1.0) < bound
        along_x, along_y = gradients(section)
        assert np.abs(along_x @ (3.0 * x - y) - 3.0).max() < 1e-9
        assert np.abs(along_y @ (3.0 * x - y) + 1.0).max() < 1e-9
        walls = wall_points(section)
        # n = (t_y, -t_x): out of the liquid, so outward on the wall.
        assert np.abs(walls.slope @ (x + 2.0 * y) - walls.along @ [-2.0, 1.0]).max() < 1e-9
        assert abs(walls.weights.sum() / (2.0 * math.pi * R) - 1.0) < bound
        (px, py), (tx, ty) = walls.points.T, walls.along.T
        assert np.all(px * ty > py * tx)
        # Along the circle, but for the angle of a chord or a parabola with it.
        assert np.abs(px * tx + py * ty).max() < (2.0 * math.pi / 96) ** (2 * section.order - 1) * R


@kills("solvers.sloshing.system:area_within", "(4.0 / 3.0) * _cross", "(2.0 / 3.0) * _cross")
def test_areas_of_a_bumpy_wall() -> None:
    """A wall that is no circle: G = 1 at rest in the drum against the area that the wall encloses."""
    plain = ring(R, A, 96, 4)
    radius, angle = np.hypot(*plain.points.T), np.arctan2(plain.points[:, 1], plain.points[:, 0])
    depth = (radius - A) / (R - A)
    moved = A + (radius - A) * (1.0 + 0.2 * depth * np.cos(3.0 * angle) + 0.1 * depth * np.sin(angle))
    section = liquid_section(np.stack([moved * np.cos(angle), moved * np.sin(angle)], axis=1), plain.cells, A)
    system = condense(section)
    t = np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False)
    outline = R + (R - A) * (0.2 * np.cos(3.0 * t) + 0.1 * np.sin(t))
    assert abs(system.enclosed_area / (np.pi * np.mean(outline**2)) - 1.0) < 1e-6
    assert np.abs(forced_response(system, SPIN, SPIN).tensor - np.eye(2)).max() < 1e-6
    # Away from rest the sides with less depth lag: both circles answer.
    answer = forced_response(system, SPIN, 1.3 * SPIN)
    assert abs(answer.counter_ratio) > 1e-5


@kills("solvers.sloshing.modes:sloshing_modes", "psi=-1j * frequency", "psi=1j * frequency")
@kills(
    "solvers.sloshing.modes:surface_displacement",
    "/ section.surface_radius\n    fitted",
    "* section.surface_radius\n    fitted",
)
@kills("solvers.sloshing.modes:harmonics", "np.exp(-1j * n * angle", "np.exp(1j * n * angle")
@kills("solvers.sloshing.modes:running", "product = -values.conj()", "product = values.conj()")
def test_shapes() -> None:
    """Modes of the ring are single harmonics of unit size; psi, displacement and frequency fit together."""
    modes = sloshing_modes(quads(96, 4), SPIN, 6)
    size = np.abs(modes.harmonics)
    for k, n in enumerate(modes.crests):
        # The fitted slope overshoots by (n h)^2/12 at the ends of sides, h = 2 pi/96.
        assert abs(size[k, HARMONICS + n] - 1.0) < 1.1 * (n * 2.0 * math.pi / 96) ** 2 / 12.0
        others = np.delete(size[k], HARMONICS + n)
        assert others.max() < 1e-8
    assert np.allclose(np.abs(modes.displacement).max(axis=1), 1.0, rtol=1e-12)
    # xi_t = psi_theta/a: for e^{i n theta}, sigma a xi = -n psi on the surface.
    on_surface = modes.psi[:, modes.surface_nodes]
    expected = -(modes.frequency / modes.crests)[:, None] * A * modes.displacement
    assert np.allclose(on_surface, expected, atol=6e-3 * np.abs(on_surface).max())
    # Gauss' rule on a modulus that waves by (n h)^4 within a side.
    assert np.allclose(modes.travelling, 1.0, rtol=1e-6)


@kills("solvers.sloshing.system:condense", "qr(schur @ constants)", "qr(constants)")
def test_limits_of_baffles() -> None:
    """Shallow baffles leave the ring's waves, closing gaps the sectors'."""
    plain = spectrum(quads(48, 4)).frequency[:3]
    shift = []
    for depth in (4e-3, 2e-3, 1e-3):
        found = spectrum(quads(48, 4, 2, Baffles(2, R - depth))).frequency[:3]
        shift.append(np.abs(found / plain - 1.0).max())
    # A flow along the wall loses the square of the depth of what stands across it.
    ratios = np.array(shift[:-1]) / shift[1:]
    assert np.all(np.abs(ratios - 4.0) < 0.5), ratios
    closed = spectrum(quads(48, 4, 2, Baffles(2))).frequency[0]
    gaps = (1e-5, 1e-6, 1e-7)
    found = np.array([spectrum(quads(48, 4, 2, Baffles(2, 0.0, gap))).frequency[:2] for gap in gaps])
    # Between the edge and the wall passes as much as one over the logarithm of the gap. Liquid that swings
    # from one compartment to the other through it gets as slow as the root of that, the next mode is theirs.
    steps = np.diff(np.square(1.0 / found[:, 0]))
    assert np.all(steps > 0.0) and np.ptp(steps) < 0.03 * steps.mean()
    apart = np.diff(1.0 / (found[:, 1] - closed))
    assert np.all(np.diff(np.abs(found[:, 1] - closed)) < 0.0) and np.ptp(apart) < 0.1 * np.abs(apart).mean()


def test_two_meshes() -> None:
    """Triangles graded towards edges and quadrilaterals agree about baffles of all kinds."""
    for baffles in (Baffles(2, 0.142), Baffles(1, 0.0, 0.005), Baffles(1, 0.139, 0.004, 0.3)):
        one = spectrum(quads(40, 3, 2, baffles)).frequency[:4]
        other = spectrum(condense(triangles(R, A, 64, layers=3, baffles=baffles, tip_size=2e-5))).frequency[
            :4
        ]
        # Waves in waves of 64 cells, (4 2 pi/64)^4/720; the cells at an edge, 2e-5 m, hold 2e-3 of its
        # energy.
        assert np.abs(one / other - 1.0).max() < 2e-4


@pytest.mark.parametrize("kind", ["quads", "triangles"])
@pytest.mark.parametrize("order", [1, 2])
def test_order_of_convergence(kind: str, order: int) -> None:
    errors = []
    for cells in (24, 48, 96):
        if kind == "quads":
            section = ring(R, A, cells, cells // 12, order=order)
        else:
            section = triangles(R, A, cells, order=order, layers=cells // 12)
        errors.append(wave_errors(condense(section)))
    # Eigenvalues converge with twice the degree; the coarsest meshes are not quite there.
    orders = np.log2(np.array(errors)[:-1] / np.array(errors)[1:])
    assert np.all(orders[-1] > 2.0 * order - 0.25), orders


def test_n_1_to_eight_digits() -> None:
    assert np.all(wave_errors(quads(128, 8), modes=(1,)) < 1e-8)


def test_edges_keep_the_order() -> None:
    found = [
        spectrum(condense(ring(R, A, 16, 2, baffles=Baffles(1, 0.142), times=times))).frequency[:4]
        for times in (1, 2, 4)
    ]
    # Fourth order, with the graded mesh's logarithm.
    orders = np.log2(np.abs(found[1] - found[0]) / np.abs(found[2] - found[1]))
    assert np.all(orders > 3.2), orders


@pytest.mark.parametrize(
    ("surface", "around", "across", "modes", "bound"),
    [
        (R * (1.0 - 1e-3), 96, 2, (1, 2, 3), 5e-5),  # thin
        (0.05 * R, 32, 16, (1, 2, 3), 1e-4),  # nearly full
        (A, 256, 6, (12,), 1e-4),  # many crests
    ],
)
def test_extremes(surface: float, around: int, across: int, modes: tuple[int, ...], bound: float) -> None:
    system = condense(ring(R, surface, around, across))
    assert np.all(wave_errors(system, math.log(R / surface), modes) < bound)
    answer = forced_response(system, SPIN, 1.37 * SPIN)
    exact = force_ratio((R / surface) ** 2, 1.37)
    assert abs(answer.force_ratio - exact) < bound * max(1.0, abs(float(exact)))


def test_nothing_depends_on_scale_or_turn() -> None:
    one = spectrum(quads(48, 2, 2, Baffles(3, 0.142))).frequency[:6]
    other = spectrum(
        condense(ring(10.0 * R, 10.0 * A, 48, 2, baffles=Baffles(3, 1.42, first_angle=1.0)))
    ).frequency[:6]
    assert np.allclose(one, other, rtol=1e-8)
    slow, fast = (sloshing_modes(quads(48, 2), spin, 4).frequency for spin in (1.0, 1000.0))
    assert np.allclose(fast, 1000.0 * slow, rtol=1e-12)


def test_equal_sectors_share_their_frequencies() -> None:
    modes = sloshing_modes(quads(48, 2, 2, Baffles(4)), SPIN, 6)
    assert modes.multiplicity.tolist() == [4, 4, 4, 4, 4, 4]
    assert modes.circulations == 0 and modes.converged
    # Told apart by their harmonics: of the four only two push the drum.
    push = np.linalg.norm(modes.amplitude[:4] @ quads(48, 2, 2, Baffles(4)).moment.T, axis=1)
    assert np.count_nonzero(push > 1e-6 * push.max()) == 2


@pytest.mark.parametrize(
    ("baffles", "expected"),
    [(Baffles(3), 0), (Baffles(3, 0.142), 1), (Baffles(3, 0.0, 0.004), 1), (Baffles(3, 0.139, 0.004), 4)],
)
def test_steady_flows_are_counted(baffles: Baffles, expected: int) -> None:
    system = quads(24, 2, 2, baffles)
    assert system.circulations == expected
    assert np.linalg.eigvalsh(system.surface).min() > 0.0
    assert np.linalg.eigvalsh(system.inertia).min() > 0.0


def test_a_whirl_on_the_wave_is_unbounded() -> None:
    system = quads(24, 2)
    known = spectrum(system)
    # Such that the slip, rounded, is the frequency to the last digit.
    half = replace(known, frequency=np.round(known.frequency * 2.0**40) / 2.0**40)
    answer = forced_response(system, 1.0, [1.0 - half.frequency[0], 2.0], half)
    assert np.isinf(answer.force_ratio[0]) and np.isinf(answer.tensor[0]).all()
    assert np.isfinite(answer.force_ratio[1])


def test_bad_input() -> None:
    system = quads(24, 2)
    for call in (
        lambda: sloshing_modes(system, 0.0, 3),
        lambda: sloshing_modes(system, 40.0, 0),
        lambda: forced_response(system, 40.0, math.nan),
        lambda: forced_response(system, -1.0, 3.0),
        lambda: ring(R, R, 24, 2),
        lambda: ring(R, A, 7, 2),
        lambda: ring(R, A, 24, 0),
        lambda: ring(R, A, 24, 2, order=3),
        lambda: ring(R, A, 24, 2, towards_wall=0.5),
        lambda: ring(R, A, 5000, 1000),
    ):
        with pytest.raises(InputError):
            call()


def test_more_modes_than_there_are() -> None:
    modes = sloshing_modes(condense(ring(R, A, 8, 1, order=1)), SPIN, 100)
    assert len(modes.frequency) == 7
