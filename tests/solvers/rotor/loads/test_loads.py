"""Forces and clearances of machines against closed forms, balances and other ways to write a machine."""

from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.loads.bearings import bearing_forces, hub_load
from solvers.rotor.loads.floor import Cabinet, floor_forces, margins
from solvers.rotor.loads.frame import frame_of, holders_of, tensor
from solvers.rotor.loads.machine import LoadedMachine, Point
from solvers.rotor.loads.turn import cubic_mean, damping_power, orbits, turn_extremes
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import unbalance_response
from solvers.synchronous.response import response
from tests.mutants import kills

LOADS = "solvers.rotor.loads"
ROUNDING = 1e-11  # relative, of a few dozen sums and products and one solution of a well posed system
TUB = Tub(
    tub_mass=48.0,
    drum_mass=12.0,
    tub_inertia=(1.3, 1.5, 1.2),
    drum_polar_inertia=0.3,
    drum_transverse_inertia=0.2,
    drum_position=(0.01, 0.09, -0.02),
    unbalance=0.1,
    unbalance_position=0.15,
    springs=(
        Mount((0.2, 0.02, 0.2), 6000.0, (0.26, 0.0, 0.97)),
        Mount((-0.2, -0.03, 0.2), 6000.0, (-0.26, 0.1, 0.97)),
        Mount((0.1, 0.1, 0.2), along_axes=(1200.0, 1000.0, 1100.0)),
        Mount((-0.1, -0.1, -0.2), along_axes=(500.0, 700.0, 300.0)),
    ),
    dampers=(
        Mount((0.12, 0.0, -0.22), 155.0, (0.34, 0.0, -0.94)),
        Mount((-0.12, 0.05, -0.22), along_axes=(20.0, 30.0, 20.0)),
    ),
)
FEET = ((0.25, 0.2, -0.45), (-0.25, 0.2, -0.45), (-0.25, -0.3, -0.45), (0.25, -0.3, -0.45))
CABINET = Cabinet(20.0, (0.0, -0.05, -0.1), FEET, 0.4)
FILLS = (Fill(Chamber(0.18, 0.04, inner_radius=0.15, plane=0.115), Liquid("brine", 1190.0, 1.6e-6), 5e-4),)


def _moving(seed: int, n: int, count: int = 7) -> np.ndarray:
    """Coordinates, rates and accelerations of some size, shape (3, count, n)."""
    scale = np.array([1e-3, 1e-2, 1e-1])
    return scale[:, None, None] * np.random.default_rng(seed).normal(size=(3, count, n))


@kills(f"{LOADS}.turn:turn_extremes", "(1j * spin * turned).real", "(-1j * turned).real")
@kills(f"{LOADS}.frame:holders_of", "rotor.damping * across", "0.0 * across")
@kills(f"{LOADS}.machine:LoadedMachine.holding", "rate @ (holder.damping", "0.5 * rate @ (holder.damping")
def test_jeffcott_rotor_presses_with_its_turning_force() -> None:
    """|K + i C Omega| |w| up and down around the weight: spring and damper at right angles."""
    rotor = Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
    speed = np.array([40.0, 105.0, 200.0])
    answer = unbalance_response(rotor.system(), speed)
    feet = ((-0.2, 0.3, 0.2), (-0.2, -0.3, 0.2), (-0.2, 0.3, -0.2), (-0.2, -0.3, -0.2))
    cabinet = Cabinet(10.0, (0.0, 0.0, 0.0), feet, 0.5)
    found = turn_extremes(LoadedMachine(rotor, cabinet=cabinet), answer, speed)
    force = np.abs(4.4e4 + 84.0j * speed) * np.abs(answer[:, 0])
    weight = 14.0 * 9.81
    # 180 angles miss (1 - cos(pi/180)) of the amplitude. A force along the floor at a height tips as well.
    miss = 1.6e-4 * force
    tip = np.abs(force[:, None] * (0.25 + 0.2 / (4.0 * 0.3) * np.array([1j, -1j, 1j, -1j])))
    assert np.all(np.abs(found.floor_force - 0.25 * weight - tip) < 1e-9 + miss[:, None])
    # The support's own size: the weight and the turning force together at most.
    turning = np.abs(found.holder[:, 0] - 4.0 * 9.81 - force)
    np.testing.assert_array_less(turning, 1e-9 + miss)
    # All the power is the damper's: C v^2.
    power = damping_power(LoadedMachine(rotor), answer, speed)
    np.testing.assert_allclose(power, 84.0 * (speed * np.abs(answer[:, 0])) ** 2, rtol=ROUNDING)


@kills(f"{LOADS}.frame:holders_of", "in s.across)", "in reversed(s.across))")
def test_supports_unlike_in_two_directions_hold_as_a_tub_on_springs_does() -> None:
    """Their tensors beside those of mounts along the axes, which know nothing of supports."""
    rotor = TwoPlane(10.0, 0.5, 0.1, (Support(0.2, (3e4, 2e4), (20.0, 50.0)), Support(-0.2, 1e4, 5.0)))
    for found, place, along in zip(
        holders_of(rotor), (0.2, -0.2), ((3e4, 2e4, 20.0, 50.0), (1e4, 1e4, 5.0, 5.0)), strict=True
    ):
        assert found.position == (0.0, 0.0, place)
        for matrix, pair in ((found.stiffness, along[:2]), (found.damping, along[2:])):
            np.testing.assert_array_equal(matrix, tensor(Mount((0.0, 0.0, place), along_axes=(*pair, 0.0))))


@kills(f"{LOADS}.floor:floor_forces", "np.ones(a.size), b, -a", "np.ones(a.size), b, a")
@kills(f"{LOADS}.floor:floor_forces", "moment - np.cross(height, force)", "moment")
@kills(f"{LOADS}.floor:floor_forces", "- turn * north", "+ turn * north")
@kills(f"{LOADS}.floor:floor_forces", "push_a, push_b = -force[..., first], -force[..., second]",
       "push_a, push_b = force[..., first], force[..., second]")  # fmt: skip
@pytest.mark.parametrize("vertical", [False, True])
def test_floor_holds_the_cabinet(vertical: bool) -> None:
    """Forces and moments of floor and loads cancel: vertical ones and, with friction, those along it."""
    frame = frame_of(TUB, vertical)
    feet = np.array(FEET) if not vertical else np.array(FEET)[:, [1, 2, 0]]
    cabinet = replace(CABINET, feet=tuple(map(tuple, feet.tolist())))
    force, moment = _moving(3, 3)[1:] * np.array([1e3, 2e2])[:, None, None]
    force[:, frame.up] -= 900.0
    floor = floor_forces(cabinet, frame, force, moment)
    first, second, up = (frame.up + 1) % 3, (frame.up + 2) % 3, frame.up
    assert np.all(floor.vertical > 0.0)
    about = moment - np.cross(np.eye(3)[up] * feet[0, up], force)
    scale = 900.0 * ROUNDING
    np.testing.assert_allclose(floor.vertical.sum(axis=1), -force[:, up], atol=scale)
    np.testing.assert_allclose(floor.vertical @ feet[:, second], -about[:, first], atol=scale)
    np.testing.assert_allclose(floor.vertical @ -feet[:, first], -about[:, second], atol=scale)
    # Rectangle: closed form of eq. 6 of the theory page about its middle.
    middle = feet.mean(axis=0)
    arms = feet - middle
    own = about - np.cross(middle * (1.0 - np.eye(3)[up]), force)
    a2, b2 = np.square(arms[0, first]), np.square(arms[0, second])
    closed = -force[:, [up]] + own[:, [second]] * arms[:, first] / a2 - own[:, [first]] * arms[:, second] / b2
    np.testing.assert_allclose(floor.vertical, 0.25 * closed, atol=scale)
    # Along the floor: the size of each foot's share, found again from the twist about the centre of load.
    share = floor.vertical / floor.vertical.sum(axis=1, keepdims=True)
    centre = share @ feet
    for k in range(len(force)):
        spokes = feet - centre[k]
        spokes[:, up] = 0.0
        push = -force[k] * (1.0 - np.eye(3)[up])
        sense = np.cross(np.eye(3)[up], spokes)
        turn = (-about[k, up] - np.cross(centre[k], push)[up]) / (share[k] @ np.square(spokes).sum(axis=1))
        each = share[k][:, None] * (push + turn * sense)
        np.testing.assert_allclose(each.sum(axis=0), push, atol=scale)
        assert np.cross(feet, each).sum(axis=0)[up] == pytest.approx(-about[k, up], abs=scale)
        np.testing.assert_allclose(floor.across[k], np.linalg.norm(each, axis=1), atol=scale)


@kills(f"{LOADS}.machine:LoadedMachine._weight", "np.cross(weight.position, self.pull)",
       "np.cross(self.pull, weight.position)")  # fmt: skip
@kills(f"{LOADS}.frame:weights_of", "Weight(rotor.drum_mass, rotor.drum_position)",
       "Weight(rotor.drum_mass, (0.0, 0.0, 0.0))")  # fmt: skip
def test_weight_at_rest() -> None:
    """Feet carry all weights, their centre of load is the centre of mass, and springs carry the rotor's."""
    machine = LoadedMachine(TUB, FILLS, cabinet=CABINET)
    rest = machine.resting.vertical
    parts = [(48.0, (0.0, 0.0, 0.0)), (12.0, TUB.drum_position), (FILLS[0].mass, (0.01, 0.115, -0.02))]
    rotor = sum(mass for mass, _ in parts)
    whole = np.array([mass * np.array(place) for mass, place in (*parts, (20.0, CABINET.centre))]).sum(axis=0)
    assert rest.sum() == pytest.approx((rotor + 20.0) * 9.81, rel=ROUNDING)
    centre = rest @ np.array(FEET) / rest.sum()
    np.testing.assert_allclose(centre[:2], whole[:2] / (rotor + 20.0), atol=1e-13)
    still = machine.holding(machine.sunk, np.zeros(6)).sum(axis=0)
    np.testing.assert_allclose(still, [0.0, 0.0, -rotor * 9.81], atol=rotor * 9.81 * ROUNDING)
    margin = margins(CABINET, machine.resting, machine.resting)
    assert [float(margin.lift_off), float(margin.slip), float(margin.walking)] == pytest.approx([1.0] * 3)


@kills(f"{LOADS}.machine:LoadedMachine.on_cabinet", "np.cross(places, forces)", "np.cross(forces, places)")
@kills(f"{LOADS}.frame:tensor", "np.outer(unit, unit)", "np.eye(3)")
def test_cabinet_takes_the_generalised_force() -> None:
    """Springs and dampers one by one are K q + C q' of the equations of motion."""
    place, rate, _ = _moving(4, 6)
    system = TUB.system()
    force, moment = LoadedMachine(TUB).on_cabinet(place, rate)
    expected = place @ system.stiffness.T + rate @ system.damping.T
    np.testing.assert_allclose(np.hstack([force, moment]), expected, atol=ROUNDING * np.abs(expected).max())


@kills(f"{LOADS}.bearings:hub_load", "acceleration * tub", "0.0 * acceleration")
@kills(
    f"{LOADS}.bearings:bearing_forces", "load[..., 3] + z * load[..., 1]", "load[..., 3] - z * load[..., 1]"
)
@kills(f"{LOADS}.bearings:bearing_forces", "load[..., 5] - x * load[..., 1]", "load[..., 5]")
@kills(f"{LOADS}.bearings:bearing_forces", "-about_z - first", "about_z - first")
def test_bearings_are_the_drum_s_own_balance() -> None:
    """Without liquid: minus Newton and Euler of the drum with its unbalance and gyroscopic moment."""
    speed = np.array([6.0, 25.0, 60.0, 120.0])
    system = TUB.system()
    answer = unbalance_response(system, speed)
    spin = speed[:, None]
    load = hub_load(TUB, *(part * answer for part in (1.0, 1j * spin, -np.square(spin))))  # type: ignore[arg-type]
    drum = system.mass - np.diag([48.0] * 3 + [1.3, 1.5, 1.2])
    own = np.square(spin) * (answer @ drum.T + system.unbalance - 1j * answer @ system.gyroscopic.T)
    # The balance was solved for: what is left is rounding of the stiffness times the answer.
    np.testing.assert_allclose(load, own, atol=ROUNDING * np.abs(load).max())
    places = (-0.3, -0.1)
    force = bearing_forces(TUB, places, load)
    along = np.stack([force[..., 1].sum(axis=1), load[:, 1], force[..., 0].sum(axis=1)], axis=1)
    np.testing.assert_allclose(along, load[:, :3], atol=ROUNDING * np.abs(load).max())
    moment = np.cross([0.01, 0.0, -0.02], load[:, :3] * [0.0, 1.0, 0.0])
    for k, y in enumerate(places):
        part = np.stack([force[:, k, 1], 0.0 * speed, force[:, k, 0]], axis=1)
        moment = moment + np.cross([0.01, y, -0.02], part)
    np.testing.assert_allclose(moment[:, [0, 2]], load[:, [3, 5]], atol=ROUNDING * np.abs(load).max())


def test_power_of_the_supports_is_the_unbalance_s() -> None:
    """In a steady turn the unbalance puts in what the dampers take, liquid or not."""
    speed = np.array([10.0, 30.0, 60.0])
    system = TUB.system()
    for fills in ((), FILLS):
        answer = response(TUB, fills, speed, 0.0)
        push = np.square(speed)[:, None] * system.unbalance
        put_in = 0.5 * (push.conj() * (1j * speed[:, None] * answer.coordinates)).sum(axis=1).real
        heat = damping_power(LoadedMachine(TUB, fills), answer.coordinates, speed)
        # Of the balance of harmonics 1e-9 of the largest force may be left, more than its heat near no peak.
        np.testing.assert_allclose(heat, put_in, rtol=1e-5)


@kills(f"{LOADS}.turn:orbits", "0.5 * (size + pair)", "0.5 * size")
@kills(f"{LOADS}.machine:LoadedMachine._towards", "point.direction is None", "True")
def test_points() -> None:
    """A point of the tub by hand, its ellipse by many moments, the rim of a leaning drum."""
    place = np.array([1e-3, 2e-3, -1e-3, 2e-3, 3e-3, -1e-3])
    points = (
        Point("door", (0.1, 0.2, 0.3), "tub", 0.025),
        Point("rim", (0.11, 0.2, -0.02), "drum", 0.01, (0.0, -2.0, 0.0)),
        Point("back", (0.3, -0.2, 0.3), "axis", 0.02),
    )
    machine = LoadedMachine(TUB, points=points)
    moment = place[None], np.zeros((1, 6)), np.zeros((1, 6)), np.array([np.pi])
    loads = machine.loads(*moment)
    shift = place[:3] + np.cross(place[3:], (0.1, 0.2, 0.3))
    assert loads.moved[0, 0] == pytest.approx(np.linalg.norm(shift), rel=ROUNDING)
    assert loads.clearance[0, 0] == pytest.approx(0.025 - np.hypot(shift[0], shift[2]), rel=ROUNDING)
    # The spoke of the rim pointed along x and points against it after half a turn.
    rim = place[:3] + np.cross(place[3:], (0.01, 0.2, -0.02)) + np.cross([2e-3, 0.0, -1e-3], (-0.1, 0.0, 0.0))
    assert loads.clearance[0, 1] == pytest.approx(0.01 + rim[1], rel=ROUNDING)
    back = place[:3] + np.cross(place[3:], (0.01, -0.2, -0.02))
    assert loads.clearance[0, 2] == pytest.approx(0.02 - np.hypot(back[0], back[2]), rel=ROUNDING)
    speed = np.array([30.0])
    answer = unbalance_response(TUB.system(), speed)
    angle = np.linspace(0.0, 2.0 * np.pi, 3600)
    path = np.real(np.exp(1j * angle)[:, None] * (machine.frame.moving((0.1, 0.2, 0.3)) @ answer[0]))
    size = np.linalg.norm(path, axis=1)
    large, small = orbits(machine, answer)
    # A tenth of a degree off an extreme is 0.5 (pi/1800)^2 of the size.
    assert [large[0, 0], small[0, 0]] == pytest.approx([size.max(), size.min()], abs=2e-6 * size.max())


def test_machines_in_other_words() -> None:
    """A machine turned about the upright, or with its parts in another order, has the same feet."""
    speed = np.linspace(5.0, 60.0, 9)
    axis = (-0.2, 0.25)
    supports = tuple(Support(z, 1e4, 50.0) for z in axis)
    rotor = TwoPlane(20.0, 0.4, 0.1, supports, (PlaneUnbalance(0.1, 0.01),))
    feet = ((-0.4, 0.2, 0.3), (-0.4, -0.2, 0.3), (-0.4, 0.1, -0.3))
    machine = LoadedMachine(rotor, cabinet=Cabinet(9.0, (-0.1, 0.02, 0.01), feet, 0.3))
    found = turn_extremes(machine, unbalance_response(rotor.system(), speed), speed)
    # Seen from the other side the axis points the other way and the rotor spins backwards; half a turn about
    # the upright x does the same to y and z.
    back = TwoPlane(
        20.0, 0.4, 0.1, tuple(Support(-z, 1e4, 50.0) for z in reversed(axis)), (PlaneUnbalance(-0.1, 0.01),)
    )
    turned = Cabinet(9.0, (-0.1, -0.02, -0.01), tuple((x, -y, -z) for x, y, z in reversed(feet)), 0.3)
    other = LoadedMachine(back, cabinet=turned)
    system = back.system()
    against = unbalance_response(replace(system, unbalance=system.unbalance.conj(),
                                         gyroscopic=-system.gyroscopic), speed)  # fmt: skip
    same = turn_extremes(other, against, speed)
    np.testing.assert_allclose(same.floor_force[:, ::-1], found.floor_force, rtol=1e-9)
    np.testing.assert_allclose(same.walking, found.walking, atol=1e-9)
    np.testing.assert_allclose(same.holder[:, ::-1], found.holder, rtol=1e-9)


def test_what_is_refused() -> None:
    """Feet in a line, at two heights, with the weight outside them; bearings and tubs that are not there."""
    with pytest.raises(InputError, match="straight line"):
        LoadedMachine(
            TUB, cabinet=replace(CABINET, feet=((0.0, 0.0, -1.0), (1.0, 1.0, -1.0), (2.0, 2.0, -1.0)))
        )
    with pytest.raises(InputError, match="one height"):
        LoadedMachine(TUB, cabinet=replace(CABINET, feet=(*FEET[:3], (0.25, -0.3, -0.4))))
    with pytest.raises(InputError, match=r"cabinet\.feet\.2"):
        LoadedMachine(TUB, cabinet=replace(CABINET, centre=(0.0, 3.0, 0.0)))
    with pytest.raises(InputError, match=r"rotor\.bearings"):
        LoadedMachine(Jeffcott(4.0, 4.4e4, 84.0, 6e-4), bearings=(0.0, 1.0))
    with pytest.raises(InputError, match=r"points\.0\.on"):
        LoadedMachine(Jeffcott(4.0, 4.4e4, 84.0, 6e-4), points=(Point("a", (0.0, 0.0, 0.0), "tub"),))


@kills(f"{LOADS}.turn:cubic_mean", "np.cbrt(np.mean(values**3", "np.sqrt(np.mean(values**2")
def test_mean_load_of_a_bearing() -> None:
    """By the cube over a turn: of weight alone and unbalance alone their own, between both less than the sum.

    |F|^2 = W^2 + U^2 + 2 W U cos(t); the fourth mean in closed form bounds the cubic one from above, the
    square one from below.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    for weight, turning in ((100.0, 0.0), (0.0, 80.0), (100.0, 80.0), (30.0, 200.0)):
        force = np.hypot(weight + turning * np.cos(angle), turning * np.sin(angle))
        mean = float(cubic_mean(force, axis=0))
        square = weight**2 + turning**2
        fourth = (square**2 + 2.0 * (weight * turning) ** 2) ** 0.25
        assert square**0.5 * (1.0 - 1e-12) <= mean <= fourth * (1.0 + 1e-12)
        # Without one of both all means are alike; with both, (W U)^2/(4 square^2) apart to lowest order.
        assert (mean < 1.001 * square**0.5) == (weight * turning == 0.0)


@kills(f"{LOADS}.turn:extremes", "cubic_mean(loads.bearing", "np.max(loads.bearing")
def test_mean_over_a_turn_is_that_of_its_moments() -> None:
    """Of the turn's forces at other angles: a bearing under weight, unbalance and tilt."""
    machine, speed = LoadedMachine(TUB, FILLS, bearings=(-0.06, -0.15)), np.array([8.0, 60.0])
    moved = unbalance_response(TUB.system(), speed)
    found = turn_extremes(machine, moved, speed)
    angle = np.linspace(0.0, 2.0 * np.pi, 97, endpoint=False)
    for k, spin in enumerate(speed.tolist()):
        turned = moved[k] * np.exp(1j * angle)[:, None]
        each = machine.loads(
            turned.real, (1j * spin * turned).real, (-(spin**2) * turned).real, angle
        ).bearing
        mean = (each**3).mean(axis=0) ** (1.0 / 3.0)
        np.testing.assert_allclose(
            found.bearing_mean[k], mean, rtol=1e-6
        )  # of a smooth function of the angle
        assert np.all(found.bearing_mean[k] <= found.bearing[k])
