"""Baffles as an internal condition, run as plain Python with seeded faults; see `uncompiled_layer`."""

from __future__ import annotations

import numpy as np
import pytest

from fluid import long_wave as lw
from fluid.fill import Fill
from fluid.friction import baffles as law
from fluid.friction.wall import NO_TABLE
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.layer import baffles, finite_volume
from solvers.layer.drag import friction_of
from solvers.layer.records import Outcome, records
from solvers.layer.state import ring
from solvers.layer.step import calm
from solvers.runup.state import GAINS, LAYER, MEASURES
from solvers.runup.steps import layer as kernel
from tests.mutants import kills

SPIN = 1.3


def table(faces: list[int], tip: float, gap: float = 0.0, loss: float = -1.0) -> np.ndarray:
    rows = np.zeros((len(faces), baffles.COLUMNS))
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3] = faces, tip, gap, loss
    return rows


def middles(n: int) -> np.ndarray:
    return 2 * np.pi * (np.arange(n) + 0.5) / n


def rates(
    area: np.ndarray, q: np.ndarray, plates: np.ndarray, pull: complex = 0.0, dt: float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rates of A and q, and the fluxes of mass."""
    n = area.size
    step, d_area, d_q = 2 * np.pi / n, np.empty(n), np.empty(n)
    work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
    cell, face = (
        pull.real * np.cos(angle) + pull.imag * np.sin(angle)
        for angle in (middles(n), middles(n) - 0.5 * step)
    )
    none = np.empty(0)
    finite_volume.rates(
        *(area, q, none, SPIN, 0.0, cell, face, plates, 1.0, 0.0, step, dt, False, work, d_area, d_q, none)
    )
    return d_area, d_q, work[finite_volume._MASS, : n + 1].copy()


@kills(
    "solvers.layer.finite_volume:_drain",
    "push_l[face] = flow[face] - kept * (",
    "push_l[face] = push_l[face] - 0.0 * (",
)
@kills(
    "solvers.layer.finite_volume:_drain",
    "push_r[face] = flow[face] - kept * (",
    "push_r[face] = push_r[face] - 0.0 * (",
)
def test_a_film_that_runs_dry_is_no_faster_than_its_front() -> None:
    """On a steep bed a film's state at a face is deep; it pushes with the share of it that there is.

    In the step that empties the film it gets no more than the speed of that state's front, twice its waves'.
    """
    n, dt, spin_pull = 48, 2e-3, 2.5 * SPIN**2
    area = np.zeros(n)
    area[6:8] = 5e-5
    deepest = spin_pull / SPIN**2 * np.pi / n
    front = 2.0 * lw.wave_celerity(0.0, -0.5 * np.log(1.0 - 2.0 * deepest), SPIN)[1]
    for turned in np.arange(8) * 0.25 * np.pi:
        d_q = rates(area, -SPIN * area**2, table([], 0.05), spin_pull * np.exp(1j * turned), dt)[1]
        assert np.abs(d_q[6:8]).max() * dt < front * 5e-5


def wild(n: int) -> tuple[np.ndarray, np.ndarray]:
    theta = middles(n)
    area = 0.06 + 0.03 * np.cos(2 * theta) + np.where(np.arange(n) % 7 == 0, 0.02, 0.0)
    return area, (0.2 * np.sin(theta) - 0.1) * area - SPIN * area**2


@kills("solvers.layer.baffles:obstruct", "<= _DRY", "< 0.0")
def test_a_dry_face() -> None:
    """Where both cells beside a baffle are dry nothing passes, and no rate is lost."""
    area, q = wild(32)
    area[6:11], q[6:11] = 0.0, 0.0
    for height in (0.0, 0.05, 0.5):
        d_area, d_q, mass = rates(area, q, table([8], height), 0.1)
        assert np.isfinite(d_area).all() and np.isfinite(d_q).all() and mass[8] == 0.0


@kills("solvers.layer.baffles:resistance", "- 1.0) / max(depth, 1e-12)", "- 1.0) / depth")
def test_a_slit_beside_a_dry_wall() -> None:
    """Nothing that stands before a slit at the wall meets no resistance, not one that is no number."""
    (row,) = table([0], 0.3, gap=0.1)
    assert baffles.resistance(0.0, row) == 0.0
    # A layer as deep as the slit passes freely as well, a deeper one does not.
    assert baffles.resistance(0.1, row) == 0.0 and baffles.resistance(0.2, row) > 0.0


@kills("solvers.layer.baffles:obstruct", "open_ * (mass[i] - free)", "open_ * mass[i]")
@kills("solvers.layer.baffles:obstruct", "flow[i] - own_l - slope_l", "flow[i] - slope_l")
@kills("solvers.layer.baffles:obstruct", "flow[i] - own_r - slope_r", "flow[i] - slope_r")
@kills("solvers.layer.baffles:resistance", "share) - 1.0)", "share) - 0.9)")
def test_nothing_in_the_way() -> None:
    """Baffles without height are none, to rounding of the fluxes."""
    area, q = wild(32)
    bare = rates(area, q, table([], 0.0), 0.1)
    for plates in (table([0, 8, 21], 0.0), table([0, 8, 21], 0.3, 0.3), table([5], 0.05, loss=0.0)):
        for one, other in zip(rates(area, q, plates, 0.1), bare, strict=True):
            np.testing.assert_allclose(one, other, atol=1e-14)


@kills("solvers.layer.baffles:obstruct", "mass[n], flow[n] = through, flow_l", "pass")
@kills("solvers.layer.baffles:obstruct", "if held >= 0.0 else 0.0", "if held >= 0.0 else 1.0")
@kills("solvers.layer.baffles:_past", "if held < 0.0:", "if held < -9.0:")
def test_compartments_keep_their_liquid() -> None:
    """Past closed baffles nothing goes, however the layer moves; next to dry walls as well."""
    n, faces = 32, [0, 8, 16, 24]
    area, q = wild(n)
    area[8:12], q[8:12] = 0.0, 0.0
    held = area.reshape(4, 8).sum(axis=1)
    for _ in range(40):
        d_area, d_q, mass = rates(area, q, table(faces, 0.4), 0.1, 0.02)
        assert np.all(mass[[0, 8, 16, 24, 32]] == 0.0)
        area, q = np.maximum(area + 0.02 * d_area, 0.0), q + 0.02 * d_q
        calm(area, q, SPIN)
    assert area.min() > -1e-15 and abs(area[12:16].sum()) > 1e-3
    np.testing.assert_allclose(area.reshape(4, 8).sum(axis=1), held, rtol=1e-13)


@kills("solvers.layer.baffles:wall_beds", "i >= 0 and shut", "i < 0 and shut")
@kills("solvers.layer.baffles:wall_beds", "bed[n] = bed[0]", "bed[n] = bed[1]")
def test_a_wall_bears_its_liquid_beside_dry_cells() -> None:
    """Liquid at rest in one compartment between dry ones: its baffles take the torque of the body force."""
    pull, gaps = 0.2, []
    for n in (32, 64):
        for first in (0, n // 4, 3 * n // 4):
            theta, faces = middles(n), [0, n // 4, n // 2, 3 * n // 4]
            area = np.zeros(n)
            own = slice(first, first + n // 4)
            surface = lw.surface_at_head(np.full(n // 4, 0.12 * SPIN**2), SPIN, pull * np.cos(theta[own]))
            area[own] = 0.5 * (1.0 - surface**2)
            plates = table(faces, 0.6)
            d_area, d_q, _ = rates(area, -SPIN * area**2, plates, pull)
            assert np.abs(d_area).max() < 1e-14 and np.abs(d_q).max() < 1e-14
            lever = (1.0 - surface) * (1.0 + surface + surface**2) / 3.0
            asked = -pull * np.sum(lever * np.sin(theta[own])) * 2.0 * np.pi / n
            gaps.append(abs(plates[:, baffles.TORQUE].sum() / asked - 1.0))
    # Second order: the trapezium's error of a quarter of the circle, 1/12 of the step squared, and the same
    # again for the levels within a cell. The other bed takes a part of first order, 8 % with 32 cells.
    assert max(gaps[:3]) < (2.0 * np.pi / 32) ** 2 / 6.0
    assert max(gaps[3:]) < (2.0 * np.pi / 64) ** 2 / 6.0


@kills("solvers.layer.baffles:obstruct", "min(max(flow_r, 0.0), after[4, i])", "flow_r")
@kills("solvers.layer.baffles:obstruct", "min(max(flow_l, 0.0), before[4, i])", "flow_l")
@kills("solvers.layer.baffles:obstruct", "min(max(flow_r, 0.0), after[4, i])", "after[4, i]")
def test_a_wall_neither_pulls_nor_drives_away() -> None:
    """On liquid that runs away a closed baffle presses by no more than at rest, and never pulls.

    A film at the foot of a steep bed, whose state at the face is much deeper, is the case where more came.
    """
    n, faces = 32, [8, 16, 20, 24, 28, 0]
    for deep, pull in ((0.05, 0.0), (3e-4, 0.5), (3e-4, 0.0)):
        for way in (1, -1):
            presses = []
            for speed in (-1.0, 0.0, 0.05, 1.0, 10.0, 100.0):
                area, plates = np.zeros(n), table(faces, 0.6)
                area[slice(8, 16) if way > 0 else slice(0, 8)] = 0.05
                area[8 if way > 0 else 7] = deep
                rates(area, way * speed * area - SPIN * area**2, plates, pull * way)
                presses.append(-way * plates[0, baffles.TORQUE])
            rest = presses[1]
            assert presses[0] > rest > 0.0
            assert max(presses[2:]) <= rest and min(presses) >= 0.0
            assert deep < 0.05 or presses[-1] == 0.0


@kills("solvers.layer.baffles:take", "-= table[k, TORQUE]", "+= table[k, TORQUE]")
@kills("solvers.layer.baffles:obstruct", "flow_r = own_r", "flow_r = own_l")
def test_compartments_rest() -> None:
    """Levels that differ from one closed compartment to the next stay, with a force across the axis."""
    n, faces, pull = 32, [0, 8, 16, 24], 0.2
    head = np.repeat([0.05, 0.09, 0.12, 0.02], 8) * SPIN**2 + 0.2
    surface = lw.surface_at_head(head - 1.0 * 0.2, SPIN, pull * np.cos(middles(n)))
    area = 0.5 * (1 - surface**2)
    d_area, d_q, _ = rates(area, -SPIN * area**2, table(faces, 0.6), pull)
    wet = area > 0.0
    assert wet.sum() > 16
    # Rounding of the fluxes over the width of a cell.
    assert np.abs(d_area).max() < 1e-14 and np.abs(d_q).max() < 1e-14


@kills("solvers.layer.baffles:_past", "whole * whole + 4.0 * held", "whole * whole + 2.0 * held")
@kills("solvers.layer.baffles:obstruct", "whole = wave_l + wave_r", "whole = out_l - out_r")
@kills("solvers.layer.baffles:obstruct", "u_l - spin * area_l", "u_l + spin * area_l")
@kills("solvers.layer.baffles:obstruct", "+ area_r * wave_r", "- area_r * wave_r")
@kills("solvers.layer.baffles:resistance", "0.5 * lost * lost", "lost * lost")
@kills("fluid.friction.baffles:open_share", "held - tip", "tip")
def test_weak_flow() -> None:
    """A weak uniform flow loses K Q^2/(2 h^2) of its head; the two waves that this sends out say the rest."""
    area, n, face = 0.08, 16, 5
    depth, log = 1.0 - np.sqrt(1 - 2 * area), float(lw.layer_log(area))
    share = 1.0 - 0.05 / depth
    k = (1 / ((0.55 + 0.45 * share**1.8) * share) - 1) ** 2 / (2 * depth**2)
    wave = np.sqrt((SPIN * log) ** 2 + log * SPIN**2)
    for u in (1e-6, -1e-6):
        rest = np.full(n, area)
        plates = table([face], 0.05)
        d_area, d_q, mass = rates(rest, u * rest - SPIN * rest**2, plates)
        flow = u * log
        less = -k * flow * abs(flow) / (2 * wave / log)
        # Of second order in the flow; the next order is smaller by 1e-5.
        assert abs((mass[face] - flow) / less - 1) < 2e-5 / abs(u) * 1e-6 + 1e-4
        step = 2 * np.pi / n
        np.testing.assert_allclose([d_area[face - 1], d_area[face]], [-less / step, less / step], rtol=1e-3)
        # Waves leave at Omega L -+ c; the momentum in them is what the cells gain.
        gained = np.array([(SPIN * log - wave) * less, (SPIN * log + wave) * less])
        by_area = _momentum_in_wave(area, np.array([-wave, wave]))
        # dq = (dq/dA) dA, dA = dQ/lambda, and the flux changes by lambda dq.
        np.testing.assert_allclose(
            [d_q[face - 1], d_q[face]], [-by_area[0] * less / step, by_area[1] * less / step], rtol=1e-3
        )
        assert gained.shape == (2,)
        # The baffle takes A times the head that is lost.
        assert abs(plates[0, baffles.TORQUE] / (area * k * flow * abs(flow)) - 1) < 1e-3
        assert abs(plates[0, baffles.POWER] / (k * abs(flow) ** 3) - 1) < 1e-3


def _momentum_in_wave(area: float, half: np.ndarray) -> np.ndarray:
    """dq/dA of q = u A - Omega A^2 at rest along a wave, du/dA = Omega +- c/L."""
    log = float(lw.layer_log(area))
    return area * (SPIN + half / log) - 2.0 * SPIN * area


@kills("solvers.layer.baffles:resistance", "0.5 * row[LOSS]", "row[LOSS]")
def test_given_loss() -> None:
    """A coefficient given takes zeta u^2/2 times the mean depth from a flow of that depth."""
    area, u = 0.08, 1e-6
    depth, log = 1.0 - np.sqrt(1 - 2 * area), float(lw.layer_log(area))
    rest, plates = np.full(16, area), table([3], 0.05, loss=4.0 / depth)
    rates(rest, u * rest - SPIN * rest**2, plates)
    assert abs(plates[0, baffles.TORQUE] / (area * 4.0 * (u * log) ** 2 / (2 * depth**2)) - 1) < 1e-4
    assert law.CLOSED < 1e-3


@kills("solvers.layer.baffles:keep_heat", "d_energy[i - 1] -= 0.5 *", "d_energy[i - 1] -= 0.0 *")
def test_heat_at_baffles_is_none_behind_bores() -> None:
    """What leaves the mean flow is heat at the baffles, or feeds the fluctuations, and never both."""
    n = 32
    area = 0.06 + 0.01 * np.cos(middles(n))
    smeared = table([-1], 0.05)
    smeared[:, baffles.DENSITY] = 8.0 / (2.0 * np.pi)
    for plates in (table([8, 24], 0.05), smeared):
        q, pull = 0.2 * area - SPIN * area**2, np.zeros(n)
        step, d_area, d_q, d_energy = 2.0 * np.pi / n, np.empty(n), np.empty(n), np.empty(n)
        work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
        finite_volume.rates(
            *(area, q, np.zeros(n), SPIN, 0.0, pull, pull, plates, 1.0, 0.0, step, 0.0, False, work),
            *(d_area, d_q, d_energy),
        )

        u, by_head = q / area + SPIN * area, np.square(q / area + SPIN * area)
        log = -0.5 * np.log(1.0 - 2.0 * area)
        by_area = 0.5 * by_head / (1.0 - 2.0 * area) + u * log * (2.0 * SPIN - u / area) + SPIN**2 * area
        lost = -step * float((by_area * d_area + u * log / area * d_q).sum())
        heat = baffles.taken(plates)[1]
        assert heat > 0.0
        assert step * d_energy.sum() == pytest.approx(lost - heat, rel=1e-6, abs=1e-9 * heat)


@kills("solvers.runup.steps.layer:layer_step", "gains.torque -= 0.5 * dt * held", "pass")
@kills("solvers.runup.steps.layer:layer_step", "gains.baffles += 0.5 * dt * power", "pass")
@kills("solvers.runup.steps.layer:layer_step", "(spin * held + power)", "power")
@kills("solvers.layer.baffles:obstruct", "max(held, 0.0) * abs(passed) * passed * passed", "0.5 * abs(held)")
def test_gains() -> None:
    """The drum gets what the layer loses of angular momentum; its work goes into the layer and into heat."""
    n, spins = 32, np.array([SPIN, SPIN])
    area = 0.06 + 0.01 * np.cos(middles(n))
    q = -0.15 * area - SPIN * area**2
    gains, spare, ends = records(GAINS)[0], kernel.layer_scratch(1, n)[0], records(MEASURES, 2)
    plates = table([0, 8, 16, 24], 0.03)
    kernel.measure(area, q, SPIN, ring(n), plates, spare, ends[0])
    done = kernel.layer_step(
        *(finite_volume.rates, friction_of(0), area, q, area[:0], spins, np.zeros(4), records(LAYER)[0]),
        *(0.0, 0.0, NO_TABLE, 0.02, ring(n), plates, 1.0, 0.0, spare, gains),
    )
    assert done[0] == Outcome.DONE
    kernel.measure(area, q, SPIN, ring(n), plates, spare, ends[1])
    gained = ends[1].spinning - ends[0].spinning
    assert gains.torque > 1e-7 and abs(gained - gains.torque) < 1e-13
    left = SPIN * gains.torque - gains.loss - gains.baffles - (ends[1].energy - ends[0].energy)
    assert abs(left) < 1e-13
    # The head lost at a plate works on the flow past it: the torque times the mean turning, and some more.
    turning = -0.15 * gains.torque
    assert 0.5 * abs(turning) < gains.baffles < 1.5 * abs(turning)


def rotor_part(area: np.ndarray, q: np.ndarray, plates: np.ndarray) -> np.record:
    out = records(MEASURES)[0]
    kernel.measure(area, q, SPIN, ring(area.size), plates, kernel.layer_scratch(1, area.size)[0], out)
    return out


@kills("solvers.runup.steps.layer:_held_back", "out.flow_x -= flow * x", "pass")
@kills("solvers.runup.steps.layer:_held_back", "out.flow_y -= flow * y", "out.flow_y += flow * y")
@kills("solvers.runup.steps.layer:_held_back", "j = (i - 1 + side) % n", "j = (i + side) % n")
@kills("solvers.runup.steps.layer:_held_back", "out.xy +=", "out.xy -=")
@kills("solvers.runup.steps.layer:_held_back", "out.xx +=", "out.xx -=")
@kills("solvers.runup.steps.layer:_held_back", "out.yy +=", "out.yy -=")
def test_a_closed_baffle_keeps_momentum_from_the_rotor() -> None:
    """Of a ring cut by walls the momentum is the rate of the first moment: nothing passes the walls.

    Flow that ran through them would do gravity's work on the rotor, with no liquid lowered.
    """
    n = 192
    theta, plates = middles(n), table([0, 16, 28, 40], 0.2)
    surface = np.sqrt(1.0 - 2.0 * (area := 0.08 + 0.001 * np.cos(theta)))
    # A flow that vanishes at no wall, in a ring that no symmetry helps.
    q = (0.1 + 0.001 * np.sin(theta)) * area - SPIN * area**2
    d_area, d_q, _ = rates(area, q, plates)
    assert not plates[:, baffles.OPEN].any()
    moved = complex(np.sum(surface * np.exp(1j * theta) * d_area) * 2.0 * np.pi / n)
    out, free = rotor_part(area, q, plates), rotor_part(area, q, plates[:0])
    # Second order in a cell of 1/192 of a turn.
    assert abs(complex(out.flow_x, out.flow_y) - moved) < 1e-3 * abs(moved)
    assert abs(complex(free.flow_x, free.flow_y) - moved) > abs(moved)
    # A push changes it as the inertia says, to a tenth of what the walls take of a free ring's.
    for push in (1.0, 1j):
        later = rotor_part(area, q + rates(area, q, plates, 1e-4 * push)[1] - d_q, plates)
        change = complex(later.flow_x - out.flow_x, later.flow_y - out.flow_y) / 1e-4
        inertia, whole = (
            push.real * complex(of.xx, of.xy) + push.imag * complex(of.xy, of.yy) for of in (out, free)
        )
        assert abs(change - inertia) < 0.1 * abs(whole - inertia)


@kills("solvers.layer.baffles:_piled", "0.5 * (half + other", "(half + other")
@kills("solvers.layer.baffles:_piled", "- flow - spin", "+ flow - spin")
@kills("solvers.layer.baffles:_piled", "- spin * (_log(area) + log)", "+ spin * (_log(area) + log)")
@kills("solvers.layer.baffles:_piled", "area + (mass - passed) /", "area - (mass - passed) /")
def test_what_piles_up() -> None:
    """The area behind the bore keeps the mass at the bore's speed; a weak bore is a wave."""
    area, log = 0.06, float(lw.layer_log(0.06))
    for turning in (0.1, -0.1):
        u, half = turning * (1.0 - 2.0 * area), lw.wave_celerity(turning, log, SPIN)[1]
        for share in (0.999, 0.6, 0.2):
            mass, star = u * log if u > 0.0 else 0.02, area
            passed = share * mass
            for _ in range(60):
                star = 0.5 * (star + baffles._piled(area, mass, passed, u, half, SPIN, 0.45, star))
            deep = float(lw.layer_log(star))
            after = lw.wave_celerity(passed / deep / (1.0 - 2.0 * star), deep, SPIN)
            # Speed of the waves against the flow, before the bore and behind it, as eq. 9 has it.
            back = 0.5 * ((half - u - SPIN * log) + (after[1] - passed / deep - SPIN * deep))
            # Halved sixty times: rounding is left.
            assert abs(back * (star - area) / (mass - passed) - 1.0) < 1e-9 and star > area
            if share == 0.999 and u > 0.0:
                # A bore that is a thousandth as strong is slower by no more than twice that.
                assert abs((star - area) * (half - u - SPIN * log) / (mass - passed) - 1.0) < 2e-3
    assert baffles._piled(area, 0.01, 0.01, 0.1, half, SPIN, 0.45, 0.2) == area
    # No more than the gap holds.
    assert baffles._piled(area, 0.5, 0.0, 0.1, half, SPIN, 0.07, 0.07) == 0.07


@kills("solvers.layer.baffles:_through", "area_r, -mass_r, -u_r", "area_r, -mass_r, u_r")
@kills("solvers.layer.baffles:_through", "half, way * spin", "half, spin")
@kills(
    "solvers.layer.baffles:_past", "_BEFORE * before + (1.0 - _BEFORE)", "_BEFORE * behind + (1.0 - _BEFORE)"
)
def test_mirrored_flow() -> None:
    """A flow past a baffle and its mirror image, spin and all, pass alike."""
    row, found = table([3], 0.05)[0], []
    for way in (1.0, -1.0):
        before, after = (0.07, 0.02, 0.25, 0.4), (0.05, 0.011, 0.2, 0.3)
        first = (before[0], way * before[1], way * before[2], before[3])
        second = (after[0], way * after[1], way * after[2], after[3])
        pair = (first, second) if way > 0.0 else (second, first)
        found.append(baffles._through((way * 0.9, 11.0, way * SPIN, *pair[0], *pair[1]), row, 0.45))
    np.testing.assert_allclose(found[0], (-found[1][0], found[1][1]), rtol=1e-13)
    # Without what piles up it would pass less.
    least = baffles.resistance(0.55 * baffles._depth(0.07) + 0.45 * baffles._depth(0.05), row)
    assert found[0][0] > 1.02 * 1.8 / (11.0 + np.sqrt(121.0 + 3.6 * least)) > 0.0


@kills("solvers.layer.baffles:_through", "low + (high - low) * more / (more - less)", "0.5 * (star + high)")
@kills("solvers.layer.baffles:_through", "_SETTLED * star", "1e-3 * star")
def test_one_flow_passes() -> None:
    """Flow and pile agree at any speed of the liquid, and follow the state without jumps.

    Liquid that shoots at a baffle piles up steeply with what does not pass: rounds of a fixed point swing
    about their answer there, and the last of them would be the flow.
    """
    row, area, behind = table([3], 0.04)[0], 0.124, 0.082
    for drive in (20.0, 77.0, 150.0):
        before = None
        for k in range(400):
            u = 6.0 + 0.01 * k
            log = float(lw.layer_log(area))
            half = float(lw.wave_celerity(u / (1.0 - 2.0 * area), log, 0.4)[1])
            sides = (drive, 43.0, 0.4, area, u * log, u, half, behind, 0.3, 3.0, 3.0)
            passed, held = baffles._through(sides, row, 0.158)
            known = (area, u * log, passed, u, half, 0.4, 0.158)

            def miss(star: float, known: tuple[float, ...] = known) -> float:
                return float(baffles._piled(*known, star)) - star

            # The pile whose depth has this resistance.
            least, most = area, 0.158
            for _ in range(60):
                star = 0.5 * (least + most)
                lies = baffles.resistance(
                    0.55 * baffles._depth(star) + 0.45 * min(baffles._depth(star), baffles._depth(behind)),
                    row,
                )
                least, most = (star, most) if lies > held else (least, star)
            assert abs(miss(least)) < 1e-7 * area or (least > 0.1579 and miss(least) > 0.0), (drive, u)
            if before is not None:
                assert abs(passed - before) < 0.02 * passed
            before = passed


@kills("solvers.layer.baffles:_side", "way * velocity < -half", "way * velocity > half")
@kills("solvers.layer.baffles:_side", "velocity *= left", "pass")
def test_choked() -> None:
    """What runs away faster than its waves counts as fast as they are; what comes keeps its speed."""
    area, log = 0.06, float(lw.layer_log(0.06))
    for way in (1.0, -1.0):
        for speed in (0.2, 0.8):
            q = -way * speed * area - SPIN * area**2
            half = float(lw.wave_celerity(-way * speed / (1.0 - 2.0 * area), log, SPIN)[1])
            found = baffles._side(area, q, 1.0, way, SPIN, 1.0, 0.0, 0.0, area)
            assert abs(abs(found[0]) - min(speed, half)) < 1e-14 and (half > speed) == (speed == 0.2)
            assert abs(found[4] * speed - abs(found[0])) < 1e-14
            other = baffles._side(area, q, 1.0, -way, SPIN, 1.0, 0.0, 0.0, area)
            assert abs(other[0] + way * speed) < 1e-14 and other[4] == 1.0


@kills("solvers.layer.baffles:_side", "_stiffness(area, full, slot)", "slot if area > full else 0.0")
@kills("solvers.layer.baffles:_side", "slot * max(area - full, 0.0)", "0.0")
@kills("fluid.long_wave:slot_stiffness", "/ CLOSING + 1.0", "/ CLOSING")
def test_a_gap_that_fills() -> None:
    """Nothing beside a baffle jumps where the gap begins to be full; then the waves are those of the slot."""
    full, slot, reach = 0.06, 64.0 * SPIN**2, lw.CLOSING * 0.06

    def beside(area: float) -> np.ndarray:
        q = 0.3 * area - SPIN * area**2
        return np.array(baffles._side(area, q, 1.0, 1.0, SPIN, full, slot, 0.02, area))

    # Between two areas so near there is room for a slope of a full wave's speed over the ramp, and no jump.
    steps = np.linspace(full - 1.5 * reach, full + 0.5 * reach, 401)
    found = np.array([beside(area) for area in steps])
    assert np.abs(np.diff(found, axis=0)).max(axis=0)[2] < 0.1 * np.ptp(found[:, 2])
    log = float(lw.layer_log(full))
    assert abs(beside(full * (1.0 + 1e-12))[3] / np.sqrt(slot * log) - 1.0) < 0.02
    open_ = lw.wave_celerity(0.3 / (1.0 - 2.0 * steps[0]), float(lw.layer_log(steps[0])), SPIN)[1]
    assert abs(found[0, 3] - open_) < 1e-14
    # Beyond it the head rises with the slot, and by the layer's own little.
    rise = (beside(1.02 * full)[1] - beside(1.01 * full)[1]) / (0.01 * full)
    assert slot < rise < 1.1 * slot


@kills("solvers.layer.baffles:slope_aside", "<= _WEAKEST", "<= 9e9")
@kills("solvers.layer.baffles:slope_aside", "0.5 * way *", "way *")
@kills("solvers.layer.baffles:slope_aside", "near * far > 0.0 and", "")
@kills("solvers.layer.baffles:slope_aside", "most <= full or", "")
@kills("solvers.layer.baffles:slope_aside", "smooth and not plain", "smooth")
def test_slopes_beside() -> None:
    """On lines that jump at the baffles the cells beside them have the lines' slopes; at kinks none."""
    n, ghosts, faces = 24, 2, [0, 8, 15]
    cells = np.arange(n)
    piece = np.searchsorted(faces, cells, side="right") - 1
    area, slope = np.full(n, 0.06), np.array([0.3, -0.2, 0.5])[piece]
    line = slope * cells + np.array([0.0, 7.0, -9.0])[piece]
    for kink in (False, True):
        line[5] += 3.0 * kink
        value = np.concatenate((line[-ghosts:], line, line[:ghosts]))
        half = np.full(n + 2 * ghosts, 9.0)
        baffles.slope_aside(table(faces, 0.05), area, 1.0, value, half, ghosts)
        beside = [0, 7, 8, 14, 15, 23]
        wanted = 0.5 * slope[beside]
        # The kink at 5 is a summit for the cell 7: 5 to 6 falls, 6 to 7 rises.
        wanted[1] *= not kink
        np.testing.assert_allclose(half[np.array(beside) + ghosts], wanted, atol=1e-14)
        assert half[1] == half[n + 1] and half[n + ghosts] == half[ghosts]
        assert (half == 9.0).sum() == n + 2 * ghosts - 8
    # Where the gap begins to be full there is none either.
    half[:], area[16] = 9.0, 0.2
    baffles.slope_aside(table(faces, 0.05), area, 0.1, value, half, ghosts)
    assert half[15 + ghosts] == 0.0 and half[14 + ghosts] != 0.0
    # Pieces of fewer than six cells in the mean have none at their ends, and keep those between.
    n, faces = 16, [0, 5, 10]
    value = np.arange(n + 2.0 * ghosts)
    half = np.full(n + 2 * ghosts, 9.0)
    baffles.slope_aside(table(faces, 0.05), np.full(n, 0.06), 1.0, value, half, ghosts)
    assert np.all(half[np.array([0, 4, 5, 9, 10, 15]) + ghosts] == 0.0) and half[2 + ghosts] == 9.0


@kills("solvers.layer.baffles:straighten", "2 * (k % 2) - 1", "1")
@kills("solvers.layer.baffles:straighten", "bent[n + ghosts] = value[n + ghosts]", "pass")
@kills("solvers.layer.baffles:straighten", "bent[ghosts - 1] = value[ghosts - 1]", "pass")
def test_cells_beside_are_straight() -> None:
    """Cells on both sides of a baffle lose what bends them, all round the ring; no others do."""
    n, ghosts = 24, 2
    value = np.arange(n + 2.0 * ghosts)
    bent = value + 1.0
    baffles.straighten(table([0, 8], 0.05), n, value, bent, ghosts)
    straight = np.flatnonzero(bent == value) - ghosts
    assert straight.tolist() == [-1, 0, 7, 8, 23, 24]


@kills("solvers.layer.baffles:_aside", "1.5 - 0.5 * ratio", "1.5 - 0.4 * ratio")
@kills("solvers.layer.baffles:_aside", "2.0 * ratio", "3.0 * ratio")
@kills("solvers.layer.baffles:_aside", "min(1.0,", "min(2.0,")
def test_slopes_of_second_order() -> None:
    """Where it bends up from the baffle, a parabola has its own slope in the cell beside it."""
    # Differences of (x + a)^2 from the first cell on are 2 a + 1 and 2 a + 3, and its slope there is 2 a.
    for a in (0.75, 1.0, 5.0):
        near, far = 2.0 * a + 1.0, 2.0 * a + 3.0
        assert abs(near * baffles._aside(far / near) - 2.0 * a) < 1e-14 * near
    # Where it bends down, no more than the near difference; towards a summit it goes over into none.
    assert [baffles._aside(ratio) for ratio in (0.0, 0.25, 0.5, 0.8, 1.0, 3.0, 9.0)] == [
        0.0, 0.5, 1.0, 1.0, 1.0, 0.0, 0.0
    ]  # fmt: skip


def smeared(density: float, tip: float, loss: float = -1.0) -> np.ndarray:
    row = table([-1], tip, loss=loss)
    row[0, baffles.DENSITY] = density / (2 * np.pi)
    return row


@kills("solvers.layer.baffles:smear", "log * log * abs(velocity)", "log * abs(velocity)")
@kills("solvers.layer.baffles:smear", "pull /= np.sqrt(1.0 + (pull * dt) ** 2)", "pass")
def test_smeared_decay() -> None:
    """Past a sink with a constant loss 1/u rises in a straight line; no step turns the flow round.

    du/dt = -N zeta L^2 u|u|/(4 pi h_0 h), h = h_0. Heun's steps are of second order: 40 of them over the
    time in which u halves err by less than (1/40)^2.
    """
    area, loss, number, u = 0.08, 2.0, 20, -0.15
    depth, log = 1.0 - np.sqrt(1 - 2 * area), float(lw.layer_log(area))
    slope = number * loss * log**2 / (4 * np.pi * depth**2)
    plates, n = smeared(number, 0.05, loss / depth), 8
    for dt, steps in ((1 / (40 * slope * 0.15), 80), (50 / (slope * 0.15), 4)):
        a, q = np.full(n, area), np.full(n, u * area - SPIN * area**2)
        for _ in range(steps):
            first_a, first_q, _ = rates(a, q, plates, dt=dt)
            _, second_q, _ = rates(a + dt * first_a, q + dt * first_q, plates, dt=dt)
            q = q + 0.5 * dt * (first_q + second_q)
            assert np.all(np.abs(first_a) < 1e-12)
        left = q / area + SPIN * area
        assert np.all(left <= 0.0) and np.all(left > u)
        if steps == 80:
            np.testing.assert_allclose(1 / np.abs(left), 1 / abs(u) + slope * dt * steps, rtol=1e-3)


@kills("solvers.layer.baffles:smear", "* middle * np.sqrt(middle)", "")
@kills("solvers.layer.baffles:smear", "spin + velocity / middle", "spin")
@kills("solvers.layer.baffles:smear", "row[POWER] += step * log * pull", "row[POWER] += step * pull")
@kills("solvers.layer.baffles:smear", "row[TORQUE] += step * area[i]", "row[TORQUE] += area[i]")
@kills("solvers.layer.baffles:smeared_resistance", "depth + loss * head - before", "depth + head - before")
@kills("solvers.layer.baffles:smeared_resistance", "lost * lost * depth / before", "lost * lost")
@kills("solvers.layer.baffles:smeared_resistance", "0.5 * loss / (depth * depth)", "loss / (depth * depth)")
def test_smeared_law() -> None:
    """A uniform lag meets the torque of the law, pile-up and all; the heat is torque times turning.

    The law has the layer's depth and the mean radius r_m where the long waves have L and u/r: L^2 r_m/h^2
    is between them, 1 for a thin layer.
    """
    chamber = Chamber(1.0, 1.0, baffles=Baffles(12, 0.9))
    depth, n = 0.2, 8
    area = depth - 0.5 * depth**2
    fill = Fill(chamber, Liquid("one", 1.0, 1e-6), 2 * np.pi * area)
    for lag in (0.01, 0.05, 0.2):
        wanted = law.baffle_torque(fill, SPIN, np.array([lag])).torque[0]
        u = -lag * SPIN * (1 - area)
        a, plates = np.full(n, area), smeared(12, 0.1)
        rates(a, u * a - SPIN * a**2, plates)
        log = float(lw.layer_log(area))
        between = (log / depth) ** 2 * np.sqrt(1 - area)
        # Both find the fixed point to 1e-9 and better.
        assert abs(plates[0, baffles.TORQUE] / -(wanted * between) - 1) < 1e-7
        heat = abs(plates[0, baffles.TORQUE] * u) * log / area
        assert abs(plates[0, baffles.POWER] / heat - 1) < 1e-12


@kills("solvers.layer.baffles:smeared_resistance", "missing <= _LEFT * before", "missing <= 0.1 * before")
def test_smeared_pile_up() -> None:
    """Newton's steps end at the fixed point that bisection finds, from nearly closed to open."""
    depth = 0.057
    for tip in (0.025, 0.05, 0.0565):
        for head in (0.0, 1e-4, 1e-2, 1.0):
            wanted = law.pile_up(np.array([depth]), tip, 0.0, np.array([head]))[0][0]
            row = smeared(8.0, tip)[0]
            found = 2.0 * depth**2 * baffles.smeared_resistance(depth, head, row)
            assert abs(found / wanted - 1) < 1e-6
    assert baffles.smeared_resistance(depth, 0.1, smeared(8.0, 0.06)[0]) < 0.0
