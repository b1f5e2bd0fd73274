"""Limit cycles: rotor and layer marched in time, linear limit, torque, symmetries, what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from itertools import islice
from typing import Any

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from fluid.whirl import layer_rate, plane_layer
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.cycles.balance import circular
from solvers.cycles.branch import Cycle, Follower, _Point
from solvers.cycles.cycles import _BROKEN, CELLS, Branch, LimitCycles, _Finder, _Row, limit_cycles
from solvers.cycles.edges import small_whirl_edges
from solvers.cycles.estimate import Estimate, _by_rule, _settling, undamped_bands
from solvers.cycles.wave import Answer, StandingWave, Whirling
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import settle
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import Support, TwoPlane
from solvers.whirl.edges import unstable_bands
from tests.mutants import kills
from tests.oracles.exact import force_with_friction
from tests.solvers.whirl.test_growth import HEIGHT, NATURAL, RADIUS, WATER, machine

FRICTION = Friction("linear", 0.03 * NATURAL)
MU = 0.1
RPM = math.pi / 30.0

# Rotor and layer marched in time for 500/omega_n at constant spin, 128 cells (64 for the thin layer):
# Omega/omega_n, amplitude over the depth, whirl speed over omega_n where it was kept. Settling left 0.2 %.
MARCHED = {
    (0.1, 0.02): (
        (1.2, 0.4147, 0.94461),
        (1.3, 0.5664, 0.95072),
        (1.4, 0.6784, 0.95453),
        (1.55, 0.8126, 0.95872),
        (1.7, 0.9238, 0.96205),
        (2.0, 1.1065, 0.96755),
    ),
    (0.05, 0.02): ((1.1, 0.4497, None), (1.2, 0.7197, None), (1.3, 0.8998, None), (1.5, 1.1690, None)),
    (0.1, 0.01): ((1.2, 0.7175, None), (1.3, 0.9104, None), (1.4, 1.0590, None), (1.55, 1.2406, None)),
}
# Branch that machines leave, by Newton's method on the wave over a whirl period.
SEPARATRIX = ((1.503, 0.164), (1.551, 0.291), (1.685, 0.505), (2.03, 0.841))


@cache
def found(depth: float, zeta: float, top: float) -> tuple[LimitCycles, Fill]:
    """Limit cycles of a Jeffcott rotor with m_f/M of a tenth up to a speed over the natural one."""
    rotor, fill = machine(MU, depth, zeta)
    return limit_cycles(rotor, [fill], (0.9 * NATURAL, top * NATURAL), FRICTION), fill


@pytest.fixture(scope="module")
def branches() -> tuple[LimitCycles, Fill]:
    return found(0.1, 0.02, 2.05)


def stable_at(cycles: LimitCycles, speed: float) -> tuple[float, float, float]:
    """Amplitude, whirl speed and lag of the only stable whirl at a speed."""
    whirls = [whirl for branch in cycles.branches for whirl in branch.at(speed) if whirl[3]]
    assert len(whirls) == 1
    return whirls[0][:3]


@pytest.mark.parametrize(("depth", "zeta"), MARCHED)
def test_time_marching_comes_to_the_same_whirl(depth: float, zeta: float) -> None:
    # 0.3 % of cells (64 against 128) and settling.
    cycles, fill = found(depth, zeta, round(max(row[0] for row in MARCHED[depth, zeta]) + 0.05, 2))
    for speed, amplitude, whirl_speed in MARCHED[depth, zeta]:
        size, turning, _ = stable_at(cycles, speed * NATURAL)
        assert size / fill.depth == pytest.approx(amplitude, rel=0.004)
        if whirl_speed is not None:
            assert turning / NATURAL == pytest.approx(whirl_speed, rel=2e-4)


def test_the_branch_a_machine_leaves(branches: tuple[LimitCycles, Fill]) -> None:
    cycles, fill = branches
    for speed, amplitude in SEPARATRIX:
        left = [w for branch in cycles.branches for w in branch.at(speed * NATURAL) if not w.stable]
        # Next to the edge the amplitude rises steeply: half a digit of the speed is 2 % of it at 1.503.
        assert min(abs(w[0] / fill.depth / amplitude - 1.0) for w in left) < (0.02 if speed < 1.52 else 0.005)


def test_folds() -> None:
    for zeta, top, speed, size in ((0.02, 2.05, 1.1186, 0.09), (0.01, 1.6, 1.1008, 0.25)):
        cycles, fill = found(0.1, zeta, top)
        (branch,) = (own for own in cycles.branches if own.fold_speed)
        assert branch.fold_speed[0] / NATURAL == pytest.approx(speed, rel=1e-3)
        assert branch.fold_amplitude[0] / fill.depth == pytest.approx(size, abs=0.02)
        # It is stable on one side of the fold only.
        k = branch.folds[0]
        assert not branch.stable[: k - 1].any() and branch.stable[k + 3 :].all()


@pytest.mark.slow
def test_the_large_whirl_ends_in_a_fold() -> None:
    for zeta, top, speed, size in ((0.02, 3.2, 3.06, 1.5), (0.04, 2.0, 1.92, None)):
        cycles, fill = found(0.1, zeta, top)
        # From edge to edge, through the fold.
        (branch,) = cycles.branches
        last = int(np.argmax(branch.fold_speed))
        assert branch.fold_speed[last] / NATURAL == pytest.approx(speed, rel=0.01)
        if size is not None:
            assert branch.fold_amplitude[last] / fill.depth == pytest.approx(size, rel=0.01)


def test_growth_of_disturbances(branches: tuple[LimitCycles, Fill]) -> None:
    # Multipliers of the coupled machine's map over a period by ARPACK, 64 cells.
    cycles, _ = branches
    main, left = cycles.branches
    for branch, speed, rate in ((main, 1.3, -0.0197), (left, 1.503, 0.022), (left, 1.685, 0.055)):
        found = np.interp(speed, branch.speed / NATURAL, branch.growth / NATURAL)
        assert found == pytest.approx(rate, rel=0.1)


def test_the_wall_feeds_what_the_supports_take(branches: tuple[LimitCycles, Fill]) -> None:
    # Exact for the scheme: what is left is what the Newton iteration leaves.
    rotor, _ = machine(MU, 0.1, 0.02)
    for branch in branches[0].branches:
        taken = rotor.damping * branch.whirl_speed * branch.amplitude**2
        assert branch.torque == pytest.approx(taken, rel=1e-4)
        assert branch.power == pytest.approx(taken * branch.speed, rel=1e-4)


@pytest.mark.parametrize("ratio", [0.7, 0.8, 0.9])
def test_a_small_whirl_is_that_of_linear_theory(ratio: float) -> None:
    # tanh(L) against L, a third of L^2 of the wave's stiffness, and second order in the width of the cells.
    chamber = Chamber(RADIUS, HEIGHT)
    fill = Fill(chamber, WATER, (1.0 - 0.98**2) * chamber.capacity)
    wave = StandingWave(fill, Friction("linear", 0.05), 128)
    given = Whirling(ratio, 2e-5, 0.05)
    answer = wave.settle(given)
    assert answer is not None
    layer = plane_layer(fill, Friction("linear", 0.05))
    assert layer is not None
    exact = complex(force_with_friction(layer.layer_tanh, 1.0, ratio, layer.rate))
    assert abs(answer.force - exact) < 0.01 * abs(exact)


def test_the_fixed_point_is_what_marching_comes_to() -> None:
    rotor, fill = machine(MU, 0.1, 0.02)
    cycles = limit_cycles(rotor, [fill], (1.2 * NATURAL, 1.4 * NATURAL), FRICTION, cells=48)
    branch = cycles.branches[0]
    k = int(np.argmin(np.abs(branch.speed - 1.3 * NATURAL)))
    wave = StandingWave(fill, FRICTION, 48)
    speed, whirl_speed = float(branch.speed[k]), float(branch.whirl_speed[k])
    given = Whirling(whirl_speed / speed, branch.amplitude[k] / RADIUS, wave.drag(speed, whirl_speed))
    for part in range(12):
        assert wave.period(given._replace(size=given.size * (part + 1) / 12.0)) is not None
    answer = wave.settle(given)
    assert answer is not None
    v = whirl_speed / NATURAL
    # Steps of 0.8 of a cell in place of 0.5: second order in time, some 1e-4 of G.
    assert abs(1.0 - v**2 + 0.04j * v - MU * v**2 * answer.force) < 1e-3 * MU


def same(first: Branch, second: Branch, amplitude: float) -> None:
    """Two branches are alike within a relative difference of amplitudes."""
    for speed in (1.2, 1.35):
        size, other = (
            max(w.amplitude for w in branch.at(speed * NATURAL) if w.stable) for branch in (first, second)
        )
        assert size == pytest.approx(other, rel=amplitude)


def test_a_chamber_cut_in_two_and_a_rotor_of_two_planes_that_moves_in_one() -> None:
    rotor, fill = machine(MU, 0.1, 0.02)
    half = Fill(Chamber(RADIUS, 0.5 * HEIGHT), WATER, 0.5 * fill.volume)
    range_ = (1.15 * NATURAL, 1.4 * NATURAL)
    one = limit_cycles(rotor, [fill], range_, FRICTION, cells=32)
    two = limit_cycles(rotor, [half, half], range_, FRICTION, cells=32)
    same(two.branches[0], one.branches[0], 2e-3)
    supports = tuple(Support(z, 0.5 * rotor.stiffness, 0.5 * rotor.damping) for z in (-0.1, 0.1))
    planes = TwoPlane(rotor.mass, 0.05, 0.02, supports)
    level = limit_cycles(planes, [fill], range_, FRICTION, cells=32)
    same(level.branches[0], one.branches[0], 2e-3)


def test_what_keeps_no_whirl_is_told() -> None:
    rotor, fill = machine(MU, 0.1, 0.02)
    range_ = (1.1 * NATURAL, 1.3 * NATURAL)
    assert "without friction" in limit_cycles(rotor, [fill], range_, Friction()).reason
    free = Jeffcott(rotor.mass, rotor.stiffness, 0.0, 0.0)
    assert "without damping" in limit_cycles(free, [fill], range_, FRICTION).reason
    system = rotor.system()
    uneven = replace(system, stiffness=system.stiffness @ np.diag([1.0, 1.2]))
    found = limit_cycles(uneven, [fill], range_, FRICTION)
    assert not found.branches and "ellipse" in found.reason
    assert "no chamber" in limit_cycles(rotor, [replace(fill, volume=0.0)], range_, FRICTION).reason
    calm = limit_cycles(rotor, [fill], (0.3 * NATURAL, 0.5 * NATURAL), FRICTION)
    assert calm.reason == "no self-excited whirl in this range"
    with pytest.raises(InputError, match="cells"):
        limit_cycles(rotor, [fill], range_, FRICTION, cells=8)
    with pytest.raises(InputError, match="speeds"):
        limit_cycles(rotor, [fill], (2.0, 1.0), FRICTION)


@pytest.mark.parametrize("friction", [Friction("stokes"), Friction("quadratic", 0.02)])
def test_the_other_laws_of_friction(friction: Friction) -> None:
    rotor, fill = machine(MU, 0.1, 0.02)
    cycles = limit_cycles(rotor, [fill], (1.2 * NATURAL, 1.4 * NATURAL), friction, cells=32)
    size, _, _ = stable_at(cycles, 1.3 * NATURAL)
    (estimate,) = whirl_estimate(rotor, [fill], np.array([1.3 * NATURAL]), friction)
    assert estimate is not None and size == pytest.approx(estimate.amplitude, rel=0.15)
    larger = friction.coefficient or fill.liquid.viscosity
    # As the root of the friction: with four times of it (the laminar drag goes with the viscosity's root).
    if friction.coefficient:
        more, fills = Friction(friction.law, 2.0 * larger), [fill]
    else:
        more, fills = friction, [Fill(fill.chamber, Liquid("thick", 1000.0, 4e-6), fill.volume)]
    grown, _, _ = stable_at(
        limit_cycles(rotor, fills, (1.2 * NATURAL, 1.4 * NATURAL), more, cells=32), 1.3 * NATURAL
    )
    assert 1.2 < grown / size < 1.7


@kills("solvers.cycles.wave:StandingWave._wall", "top / (radius * spin)", "top / radius")
@kills("solvers.cycles.wave:StandingWave._wall", "coefficient / spin", "coefficient")
def test_the_law_of_the_wall_in_another_unit_of_time() -> None:
    """A wave's force and lag: by limit cycles' steps over 1/Omega, and by a layer's, in s."""
    law = Friction("wall")  # type: ignore[arg-type]
    _, fill = machine(MU, 0.1, 0.02)
    spin, whirl_speed = 1.3 * NATURAL, 0.95 * NATURAL
    size = 0.1 * fill.depth
    wave = StandingWave(fill, law, 32)
    given = Whirling(whirl_speed / spin, size / fill.chamber.radius, wave.drag(spin, whirl_speed))
    here = wave.settle(given)
    whirl = Whirl(spin, whirl_speed, size, 0.0)
    there = settle(fill, whirl, law, Numerics(cells=32))
    assert here is not None
    # With Courant numbers of 0.5 and 0.8 the scheme itself is apart by some 1e-3 on 32 cells.
    assert here.force == pytest.approx(complex(there.force_ratio[-1]), abs=0.01 * abs(here.force))
    assert here.turning * spin == pytest.approx(float(there.mean_rotation[-1]), rel=0.02)


def test_the_size_of_a_whirl_follows_the_law_of_the_wall() -> None:
    """Against the rule, and with a rough wall, whose larger drag holds a larger whirl."""
    rotor, fill = machine(MU, 0.1, 0.02)
    sizes = []
    for law in (Friction("wall"), Friction("wall", roughness=0.05 * fill.depth)):  # type: ignore[arg-type]
        cycles = limit_cycles(rotor, [fill], (1.15 * NATURAL, 1.4 * NATURAL), law, cells=32)
        size, _, _ = stable_at(cycles, 1.3 * NATURAL)
        (estimate,) = whirl_estimate(rotor, [fill], np.array([1.3 * NATURAL]), law)
        assert estimate is not None and size == pytest.approx(estimate.amplitude, rel=0.2)
        sizes.append(size)
    assert sizes[1] > 1.2 * sizes[0]


def test_the_estimate_in_one_line(branches: tuple[LimitCycles, Fill]) -> None:
    cycles, fill = branches
    rotor, _ = machine(MU, 0.1, 0.02)
    speeds = np.array([1.0, 1.2, 1.3, 1.4, 1.6]) * NATURAL
    none, *inside, beyond = whirl_estimate(rotor, [fill], speeds, FRICTION)
    assert none is None and beyond is None
    for speed, estimate in zip(speeds[1:-1], inside, strict=True):
        size, whirl_speed, lag = stable_at(cycles, float(speed))
        assert estimate is not None
        assert estimate.amplitude == pytest.approx(size, rel=0.1)
        assert estimate.whirl_speed == pytest.approx(whirl_speed, rel=0.01)
        # By the rule's share of the lower edge without friction and damping.
        assert estimate.lag == pytest.approx(lag, rel=0.1)
    v = inside[1].whirl_speed / NATURAL if inside[1] else math.nan
    assert v == pytest.approx(1.0 / math.sqrt(1.0 + MU))


def whirl_estimate(
    rotor: Jeffcott, fills: list[Fill], speeds: np.ndarray, friction: Friction
) -> tuple[Estimate | None, ...]:
    """Size of the whirl at each speed inside a band, by rule; None outside the bands."""
    settling = _settling(rotor, fills, friction)
    assert settling is not None
    bands = list(undamped_bands(rotor, fills, (0.6 * float(speeds[0]), 1.5 * float(speeds[-1]))))
    return _by_rule(rotor, fills, settling, bands, speeds, friction)


def weakly_rubbed() -> tuple[Jeffcott, list[Fill]]:
    """Water in two thin rings and ten per cent of damping: friction far weaker than the supports'."""
    fills = [Fill(Chamber(radius, 0.02), WATER, 1e-5) for radius in (0.065, 0.05)]
    mass, natural = 4.0, 1051.0 * RPM
    return Jeffcott(mass, mass * natural**2, 2.0 * 0.1 * mass * natural, 0.0), fills


def test_every_mode_has_its_edges() -> None:
    # With linear friction those of the exact theory of the band; straight lines between 201 spins.
    rotor, fill = machine(MU, 0.1, 0.02)
    plain = circular(rotor.system(), [fill], FRICTION)
    edges = small_whirl_edges(plain, (0.9 * NATURAL, 1.8 * NATURAL))
    (bands,) = unstable_bands(rotor, [[fill]], np.linspace(0.9, 1.8, 60) * NATURAL, FRICTION)
    assert [edge.spin for edge in edges] == pytest.approx(np.ravel(bands).tolist(), rel=2e-4)
    # Two layers: the modes of both have edges, the inner ones within the band of the other mode.
    rotor, fills = weakly_rubbed()
    pair = circular(rotor.system(), fills, Friction("stokes"))
    found = small_whirl_edges(pair, (600.0 * RPM, 2000.0 * RPM))
    assert len(found) == 4
    for edge in found:
        slip = edge.whirl_speed - edge.spin
        forces = [
            complex(
                force_with_friction(
                    place.layer.layer_tanh,
                    edge.spin,
                    edge.whirl_speed,
                    layer_rate(place.layer, edge.spin, slip).real,
                )
            )
            for place in pair.places
        ]
        left = pair.gap(edge.whirl_speed, edge.spin, edge.moved, forces)
        push = edge.whirl_speed**2 * sum(
            p.full_mass * abs(f) for p, f in zip(pair.places, forces, strict=True)
        )
        assert np.abs(left).max() < 2e-3 * push * np.abs(edge.moved).max()


@pytest.mark.parametrize("overlap", [0, 2])
def test_two_parts_of_a_branch_are_one(branches: tuple[LimitCycles, Fill], overlap: int) -> None:
    # Cut past its fold, and followed from both ends up to the cut or beyond it: the same whirls, each once.
    whole = next(branch for branch in branches[0].branches if branch.folds)
    fill = branches[1]
    pair = circular(machine(MU, 0.1, 0.02)[0].system(), [fill], FRICTION)
    follower = Follower(pair, FRICTION, CELLS, NATURAL)
    size = np.array([whole.speed, whole.whirl_speed, whole.amplitude]).T / follower.scales
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(size, axis=0), axis=1))])
    names = ("speed", "whirl_speed", "deflection", "lag", "growth", "torque", "thinnest")
    rows = [_Row(**{name: getattr(whole, name)[k] for name in names}, arc=arc[k]) for k in range(len(arc))]
    cut, finder = whole.folds[0] + 2, _Finder(pair, FRICTION, CELLS, (0.0, np.inf), None)
    back = [replace(row, arc=arc[-1] - row.arc) for row in reversed(rows[cut - overlap :])]
    for part in (rows[:cut], back):
        finder._add(follower, part, ("edge of the band", _BROKEN))
    (joined,) = finder.branches
    assert joined.reason == ("edge of the band", "edge of the band")
    assert joined.speed == pytest.approx(whole.speed, rel=1e-12)
    assert joined.folds == whole.folds
    assert joined.fold_speed == pytest.approx(whole.fold_speed, rel=1e-4)
    # Where they do not meet, or did not break, they stay two.
    apart = _Finder(pair, FRICTION, CELLS, (0.0, np.inf), None)
    apart._add(follower, rows[:cut], ("edge of the band", _BROKEN))
    apart._add(follower, back[: len(back) // 2], ("edge of the band", _BROKEN))
    apart._add(follower, back, ("edge of the band", "end of the range of speeds"))
    assert len(apart.branches) == 3


def from_edges(zeta: float, top: float, cells: int) -> tuple[Branch, ...]:
    """Branches without the growth of disturbances."""
    rotor, fill = machine(MU, 0.1, zeta)
    pair = circular(rotor.system(), [fill], FRICTION)
    finder = _Finder(pair, FRICTION, cells, (0.54 * NATURAL, top * NATURAL), None, judged=False)
    finder.search(rotor, [fill])
    return tuple(finder.branches)


@pytest.fixture(scope="module")
def whole() -> Branch:
    """The branch from edge to edge."""
    (found,) = from_edges(0.04, 2.0, 32)
    return found


@kills("solvers.cycles.cycles:_Finder._follow", "b.reason[1] == _BROKEN and", "False and")
@kills("solvers.cycles.cycles:_Finder._add", "rows[-1].place, 0.0, _ON", "rows[-1].place, 0.0, 9.0 * _SAME")
def test_what_the_first_edge_does_not_lead_to_the_other_one_does(
    whole: Branch, monkeypatch: pytest.MonkeyPatch
) -> None:
    # One branch from edge to edge. From the first edge no more than some whirls are found, as next to a kink
    # that Newton's steps do not pass: those from the other edge go on to it, and all whirls are told once.
    after = Follower.after
    for most in (5, 20):
        left = [most]

        def some(self: Follower, cycle: Cycle, left: list[int] = left) -> Iterator[Cycle]:
            yield from islice(after(self, cycle), left.pop() if left else None)

        with monkeypatch.context() as changed:
            changed.setattr(Follower, "after", some)
            found = from_edges(0.04, 2.0, 32)
        assert len(found) == 1
        joined = found[0]
        assert joined.reason == whole.reason == ("edge of the band", "edge of the band")
        assert joined.fold_speed == pytest.approx(whole.fold_speed, rel=1e-3)
        assert abs(joined.speed.size - whole.speed.size) < 6


@kills("solvers.cycles.branch:Follower._cycle", "found != sense", "False")
@kills("solvers.cycles.branch:Follower._cycle", "size * _TURN > 1.0", "True")
@kills("solvers.cycles.branch:Follower.step", "length, cycle.sense", "length")
def test_a_branch_goes_on_where_it_turns_in_a_corner() -> None:
    # At a kink it may turn by more than a right angle: seen from a direction like this the way on leads back,
    # and the determinant alone tells it. A determinant that rounding upset does not turn a straight branch.
    rotor, fill = machine(MU, 0.1, 0.02)
    pair = circular(rotor.system(), [fill], FRICTION)
    follower = Follower(pair, FRICTION, 32, 1.3 * NATURAL)
    start = follower.start(np.array([1.0 + 0.0j]), 0.95 * NATURAL, 1.3 * NATURAL, 0.5)
    assert start is not None
    point = _Point(start.state, follower.unknowns(start.moved, start.whirl_speed, start.spin))
    ahead = start.tangent[-point.vector.size :]
    across = np.linalg.qr(np.column_stack([ahead, np.eye(ahead.size)[:, 0]]))[0][:, 1]
    for slope, onward in ((0.3, 1.0), (-0.3, 1.0), (-0.9, -1.0)):
        towards = slope * ahead + math.sqrt(1.0 - slope**2) * across
        found = follower._cycle(point, towards, 0.0, start.sense)
        assert found is not None and found.sense == start.sense
        assert found.tangent == pytest.approx(onward * start.tangent, rel=1e-6, abs=1e-9)
    opposite = replace(start, sense=-start.sense)
    found = follower.step(opposite, 0.01)
    assert found is not None and found.sense == -start.sense
    assert found.tangent[-ahead.size :] @ ahead > 0.9


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_branches_do_not_hang_on_rounding(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    # Newton's steps come to a kink of the limiter at 127.7 rad/s: with the noise of rounding on each of the
    # layer's steps they pass it or not. The fold in it is found and the branch told once either way.
    advance, cell, noise = StandingWave._advance, StandingWave.cell, np.random.default_rng(seed)

    def rounded(step: Callable[..., Answer | None]) -> Callable[..., Answer | None]:
        def noisy(self: StandingWave, *given: Any) -> Answer | None:
            found = step(self, *given)
            if found is not None:
                found.state[:] *= 1.0 + 1e-15 * noise.standard_normal(found.state.size)
            return found

        return noisy

    monkeypatch.setattr(StandingWave, "_advance", rounded(advance))
    monkeypatch.setattr(StandingWave, "cell", rounded(cell))
    rotor, fills = weakly_rubbed()
    friction = Friction("stokes")
    pair = circular(rotor.system(), fills, friction)
    finder = _Finder(pair, friction, CELLS, (360.0 * RPM, 2000.0 * RPM), None, judged=False)
    finder.search(rotor, fills)
    assert finder.reason() == "" and len(finder.branches) == 2
    (branch,) = (branch for branch in finder.branches if branch.fold_speed)
    assert branch.fold_speed == pytest.approx((130.42, 127.69), rel=5e-4)
    assert branch.speed.size < 70


@pytest.mark.slow
def test_weak_friction_beside_damping() -> None:
    # Rotor and layers in time with 64 cells and the friction at the whirl's own slip, from kicks of 4 mm:
    # rpm, amplitude in mm, whirl speed in rpm. No kick comes to a larger whirl. Settling left 1 %.
    rotor, fills = weakly_rubbed()
    cycles = limit_cycles(rotor, fills, (900.0 * RPM, 1450.0 * RPM), Friction("stokes"))
    for rpm, amplitude, whirl_speed in (
        (1100, 0.0529, 971.2),
        (1206, 0.1587, 1031.1),
        (1300, 0.0414, 1096.3),
    ):
        size, turning, _ = stable_at(cycles, rpm * RPM)
        assert 1e3 * size == pytest.approx(amplitude, rel=0.01)
        assert turning / RPM == pytest.approx(whirl_speed, rel=1e-3)
    # Small whirls grow from 1045 to 1415 rpm: the branches reach down to them, and each is told once.
    assert cycles.reason == "" and len(cycles.branches) == 2
    assert min(branch.speed.min() for branch in cycles.branches) < 1055.0 * RPM
    assert max(branch.speed.max() for branch in cycles.branches) > 1405.0 * RPM


def test_the_rule_for_weak_friction_beside_damping() -> None:
    # The rule without the share that weak growth leaves says 6 times as much. Growth knows the Coriolis force
    # on floor and lid, as the waves do under the law of the wall: these limit cycles, a minute's work, are
    # 0.0553 mm at 1150 rpm.
    rotor, fills = weakly_rubbed()
    rules = whirl_estimate(rotor, fills, np.linspace(1065.0, 1345.0, 15) * RPM, Friction("wall"))
    largest = max(rule.amplitude for rule in rules if rule is not None)
    assert 0.5 < 1e3 * largest / 0.0553 < 2.0
