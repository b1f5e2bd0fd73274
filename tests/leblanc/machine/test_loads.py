"""What scenes say of feet, clearances and motors, against closed forms and balances."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.scene.schema.load import SceneError
from leblanc.scene.tasks import LOADS
from leblanc.studies.loads.answer import load_rows, verdict
from leblanc.studies.optimise.filled import FilledMachine
from leblanc.studies.optimise.objectives import LoadsOver, Passages
from leblanc.studies.optimise.study import optimise_scene
from meshes.errors import InputError
from tests.mutants import kills

FEET = [[-0.3, 0.15, 0.2], [-0.3, -0.15, 0.2], [-0.3, -0.15, -0.2], [-0.3, 0.15, -0.2]]
PARTS: dict[str, Any] = {
    "cabinet": {"mass": 10.0, "feet": FEET, "friction": 0.5},
    "points": [
        {"name": "rim", "on": "drum", "position": [0.07, 0.0, 0.0], "gap": "2 mm"},
        {"name": "shaft", "position": [0.0, 0.0, 0.1]},
    ],
}
# 180 angles of a turn miss (1 - cos(pi/180)) of an amplitude.
MISSED = 1.6e-4


def _rig(**changes: Any) -> lb.Scene:
    return lb.example("horizontal_rig").replace({"speeds.count": 41, **PARTS, **changes})


def _force(scene: lb.Scene, speed: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Size of the turning force on the support."""
    rotor = scene.rotor.machine()
    assert isinstance(scene.rotor, lb.JeffcottRotor)
    return np.asarray(np.abs(rotor.stiffness + 1j * rotor.damping * speed) * amplitude)  # type: ignore[union-attr]


@kills("leblanc.studies.run.study:loads_of", 'np.argsort(order, kind="stable")[: answer', "order[: answer")
@kills("solvers.rotor.loads.turn:damping_power", "0.5 * np.square(speed)", "np.square(speed)")
def test_planar_rotor_over_speed() -> None:
    """Feet, clearance and torque at every speed of the scene from its amplitude alone."""
    scene = _rig(**{"model.friction": "none"})
    result = lb.run(scene)
    found, speed = result.to_json(), result.speed
    force = _force(scene, speed, result.amplitude)
    weight = 9.81 * (14.0 + result.liquid_mass)
    # Upwards a quarter each; along the floor the force tips about the feet, 0.3 m below and 0.3 m apart.
    expected = 0.25 * weight + force * np.hypot(0.25, 0.3 / (4.0 * 0.15))
    floor = np.array(found["floor_force"])
    assert floor.shape == (41, 4)
    assert np.all(np.abs(floor - expected[:, None]) <= MISSED * force[:, None] + 1e-9 * weight)
    clear = np.array(found["clearance"]["rim"])
    np.testing.assert_allclose(clear, 2e-3 - result.amplitude, atol=1e-12)
    assert list(found["clearance"]) == ["rim"]
    np.testing.assert_allclose(found["orbit"]["shaft"]["major"], result.amplitude, rtol=1e-9)
    damping = scene.rotor.machine().damping  # type: ignore[union-attr]
    torque = damping * speed * np.square(result.amplitude)
    np.testing.assert_allclose(found["motor_torque"], torque, rtol=1e-9)
    # The worst is looked for between the speeds as well, where the peak is.
    assert result.loads is not None
    least = result.loads.clearances["rim"]
    assert least.value == pytest.approx(2e-3 - result.peak["amplitude"], abs=1e-12)
    assert least.speed == pytest.approx(result.peak["speed"])
    assert found["worst"]["clearance"]["rim"]["value"] == pytest.approx(least.value)
    data = result.to_dataset()
    np.testing.assert_array_equal(data["floor_force"].values, floor)
    assert data["point_name"].values.tolist() == ["rim", "shaft"]


def test_units_and_order_do_not_matter() -> None:
    """The same machine in other units, feet and points in another order."""
    first = lb.run(_rig()).to_json()
    feet = [[f"{1e3 * x:g} mm" for x in foot] for foot in FEET[::-1]]
    points = [{"name": "shaft", "position": [0, 0, "10 cm"]}, PARTS["points"][0] | {"gap": "0.2 cm"}]
    other = lb.run(_rig(cabinet={"mass": "10000 g", "feet": feet, "friction": 0.5}, points=points)).to_json()
    floor = np.array(first["floor_force"])[:, ::-1]
    np.testing.assert_allclose(other["floor_force"], floor, rtol=1e-9)
    for key in ("walking_margin", "lift_off_margin", "slip_margin", "motor_power"):
        np.testing.assert_allclose(other[key], first[key], rtol=1e-9)
    for key in ("clearance", "displacement", "mount_force"):
        assert other[key].keys() == first[key].keys()
        for name, values in first[key].items():
            np.testing.assert_allclose(other[key][name], values, rtol=1e-9)


def test_more_feet_and_friction_help() -> None:
    """The slip margin rises with friction, the margin against lift-off does not change."""
    low, high = (
        lb.run(_rig(cabinet=PARTS["cabinet"] | {"friction": friction})).to_json() for friction in (0.3, 0.9)
    )
    np.testing.assert_allclose(low["lift_off_margin"], high["lift_off_margin"], rtol=1e-12)
    slip = np.array([1.0 - np.array(part["slip_margin"]) for part in (low, high)])
    # The weight's part falls out: what is used of the friction goes with 1/mu only where the load is at rest.
    assert np.all(slip[0] > slip[1])
    assert np.all(np.array(low["walking_margin"]) <= np.minimum(low["lift_off_margin"], low["slip_margin"]))


def _tub_runup() -> Any:
    """A short run-up of the tub with its cabinet."""
    scene = lb.example("tub").replace({"runup.duration": "4 s", "runup.stop": "150 rpm", "runup.cells": 16})
    return lb.run_up(scene, samples=400, check=False)


@cache
def _known_runup() -> Any:
    """The same, for what is done with its answer."""
    return _tub_runup()


@kills("solvers.runup.loads:drive_torque", "0.5 * (inertia[1:]", "(inertia[1:]")
def test_run_up_over_time() -> None:
    """Shapes of the keys; the drive's work is that of the energy audit and what it takes to turn the drum."""
    result = _tub_runup()
    found = result.to_json()
    count = result.time.size
    floor = np.array(found["floor_force"])
    assert floor.shape == (count, 4)
    assert found["walking_margin"] == min(found["walking_margin_over_time"])
    for name, least in found["clearance"].items():
        assert least == min(found["clearance_over_time"][name])
    # At first nothing moves but by what a spline's end makes of it, 1e-5 of the later forces.
    np.testing.assert_allclose(floor[0], found["floor_force_rest"], rtol=1e-5)
    turned = np.diff(result.history.angle)
    work = float(np.array(found["motor_torque"])[1:] @ turned)
    audit = result.energy
    # On a ramp the drum's energy changes by J Omega' times the angle, exactly J/2 of the squares.
    drum = 0.5 * 0.32 * (result.speed[-1] ** 2 - result.speed[0] ** 2)
    assert work == pytest.approx(audit.unbalance + audit.drive + drum, rel=1e-9)
    data = result.to_dataset()
    assert data["floor_force"].dims == ("time", "foot")
    assert result.loads.bearings == ("bearing 1", "bearing 2")


def test_the_table_tells_the_hardest_blow() -> None:
    """Of all hand-overs and bearings, with its time; nothing where no liquid was handed over."""
    plain = _known_runup().loads
    label = "Bearing, largest impulse"
    jumps, impulse = plain.time[[100, 300]], np.array([[1.0, 2.0], [np.nan, 7.0]])
    (row,) = (row for row in load_rows(replace(plain, jumps=jumps, impulse=impulse)) if row.label == label)
    assert row.size == "7 N s" and "bearing 2" in row.remark
    none = replace(plain, jumps=plain.time[:0], impulse=np.zeros((0, 2)))
    assert label not in {row.label for row in load_rows(none)}


@kills("leblanc.studies.loads.answer:MachineLoads.over_turn", "- 2.0 * math.pi", "- math.pi")
def test_worst_over_a_turn() -> None:
    """By brute force."""
    loads = _known_runup().loads
    values = loads.worst.floor_force[:, 0]
    expected = [
        values[(loads.angle >= angle - 2.0 * np.pi) & (loads.angle <= angle)] for angle in loads.angle
    ]
    np.testing.assert_array_equal(loads.over_turn(values), [part.max() for part in expected])
    np.testing.assert_array_equal(loads.over_turn(values, least=True), [part.min() for part in expected])


@kills("leblanc.studies.loads.study:loads_over_speed", "if spin in states:", "if False:")
def test_motions_held_in_time_have_their_own_forces() -> None:
    """With gravity across the axis a layer throws its rotor about: forces follow the largest deflection."""
    speed = {"speeds.start": "1200 rpm", "speeds.stop": "1200 rpm", "speeds.count": 1}
    model = {"model.held": "always", "model.cells": 16, "model.friction": {"linear": 1.0}}
    result = lb.run(_rig(**speed, **model))
    assert result.loads is not None
    found = result.to_json()
    assert set(found["state"]) == {"limit_cycle"}
    # 48 steps a turn: between two of them a maximum is missed by (pi/48)^2/2, by the spline by less.
    np.testing.assert_allclose(found["displacement"]["shaft"], found["amplitude_max"], rtol=3e-3)
    assert np.all(np.array(found["amplitude_max"]) > 1.05 * np.array(found["amplitude"]))
    # Friction and bores of the layers heat up as well as the support.
    support = _rig().rotor.machine().damping * np.square(result.speed * result.amplitude)
    assert np.all(np.array(found["motor_power"]) > support)


def test_held_speed_is_the_steady_answer() -> None:
    """A rotor without liquid that is held for long presses on its feet as the steady answer says."""
    speeds = {"speeds.start": 100.0, "speeds.stop": 100.0, "speeds.count": 1}
    empty = {f"chambers.{k}.volume": 0.0 for k in range(2)}
    runup = {"start": 99.0, "stop": 100.0, "rate": 5.0, "duration": 4.0, "cells": 64, "samples": 500}
    scene = _rig().replace({**speeds, **empty, "runup": runup})
    steady, held = lb.run(scene).to_json(), lb.run_up(scene, check=False).loads
    assert held is not None
    last = held.time > 3.5
    # What is left of the start: e^-(C/2M) 2.8 s = e^-31. A step turns the rotor by 0.08 and lengthens its
    # period by 0.08^2/12; near the resonance with 10 % of damping that counts ten times.
    force = held.worst.floor_force[last].max(axis=0)
    np.testing.assert_allclose(force, steady["floor_force"][0], rtol=5e-3)
    assert held.worst.walking[last].min() == pytest.approx(steady["walking_margin"][0], abs=1e-2)
    torque = held.torque[last].mean()
    assert torque == pytest.approx(steady["motor_torque"][0], rel=1e-2)


def test_nothing_without_a_cabinet() -> None:
    """A scene without cabinet, points and bearings has none of it, and a digest as before."""
    scene = lb.example("horizontal_rig")
    assert lb.run(scene.replace({"speeds.count": 11})).loads is None
    assert scene.digest != _rig().digest
    assert _rig().digest != _rig(cabinet=PARTS["cabinet"] | {"mass": 11.0}).digest


@pytest.mark.parametrize(
    ("parts", "path"),
    [
        ({"cabinet": PARTS["cabinet"] | {"friction": 0.0}}, "cabinet.friction"),
        ({"cabinet": PARTS["cabinet"] | {"feet": FEET[:2]}}, "cabinet.feet"),
        ({"points": [{"name": "a", "on": "tub", "position": [0, 0, 0]}]}, "points.0.on"),
        ({"points": [{"name": "a", "position": [0, 0, 0]}] * 2}, "points.1.name"),
        ({"points": [{"name": "a", "position": [0, 0, 0], "direction": [0, 0, 0]}]}, "points.0.direction"),
    ],
)
def test_faults_name_their_path(parts: dict[str, Any], path: str) -> None:
    """Every value is checked where it is read."""
    with pytest.raises(SceneError, match=path.replace(".", r"\.")):
        lb.example("horizontal_rig").replace(parts)


def test_feet_that_do_not_carry() -> None:
    """What only the whole machine tells is an input fault as well."""
    with pytest.raises(InputError, match=r"cabinet\.feet\.0"):
        lb.run(_rig(cabinet=PARTS["cabinet"] | {"centre_of_mass": [0.0, -3.0, 0.0]}))
    with pytest.raises(InputError, match="above 0 with a cabinet"):
        lb.run(_rig(gravity=0.0))
    with pytest.raises(SceneError, match="bearings"):
        lb.example("tub").replace({"rotor.bearings": [{"position": 0.1}, {"position": 0.1}]})


def test_words() -> None:
    """The sentence says what the numbers do, and the table marks it."""
    loads = lb.run(_rig()).loads
    assert loads is not None
    assert verdict(loads).startswith("The machine does not walk")
    assert not any(row.failed for row in load_rows(loads))
    heavy = _rig(cabinet=PARTS["cabinet"] | {"mass": 0.0, "friction": 0.1})
    tight = heavy.replace({"points.0.gap": "0.1 mm"})
    walks = lb.run(tight).loads
    assert walks is not None
    assert walks.walking.value < 0.0
    assert "walks" in verdict(walks)
    assert "touches" in verdict(walks)
    assert sum(row.failed for row in load_rows(walks)) == 2


@kills("leblanc.studies.optimise.objectives:LoadsOver._sizes", "1.0 - loads.walking", "loads.walking")
@kills("leblanc.studies.optimise.objectives:LoadsOver._sizes", "1.0 - loads.slip", "loads.slip")
@kills("leblanc.studies.optimise.objectives:LoadsOver._sizes", "- self.least", "- 0.0")
def test_search_and_run_agree() -> None:
    """Loads over the speeds are those of `run` with the same volumes."""
    scene = _rig(**{"model.liquid": "statics"})
    over = LoadsOver(FilledMachine(scene), scene.speeds, 0.5e-3)
    loads = lb.run(scene).loads
    assert loads is not None
    volumes = np.array([[chamber.volume for chamber in scene.chambers]])
    # The top of the peak is found to 1e-6 of its size by both; the margin is less than 1.
    feet = max(worst.value for worst in loads.feet)
    assert over.of("floor_force", volumes)[0] == pytest.approx(feet, rel=1e-5)
    assert over.of("walking_margin", volumes)[0] == pytest.approx(1.0 - loads.walking.value, abs=1e-5)
    assert over.of("slip_margin", volumes)[0] == pytest.approx(1.0 - loads.worst.slip.min(), abs=1e-5)
    reach = (2e-3 - loads.clearances["rim"].value) / 1.5e-3
    assert over.of("point_clearance", volumes)[0] == pytest.approx(reach, rel=1e-5)
    assert over.of("motor_torque", volumes)[0] == pytest.approx(loads.torque.max(), rel=1e-5)


RUNUP = {"start": "300 rpm", "stop": "1500 rpm", "rate": "3000 rpm/s", "duration": "0.45 s", "cells": 16}


def _passing(**changes: Any) -> lb.Scene:
    """A rig with one chamber that passes its resonance in half a second."""
    one = _rig().replace({"chambers": [_rig().table()["chambers"][0]]})
    return one.replace(
        {"runup": RUNUP | {"samples": 200, "capture": "riding"}, "model.liquid": "linear", **changes}
    )


@kills("leblanc.studies.optimise.objectives:LoadsOver._one", "np.max([part[name]", "np.min([part[name]")
@kills(
    "leblanc.studies.optimise.objectives:Passages._one",
    "np.fmin.reduce(worst.slip)",
    "np.fmax.reduce(worst.slip)",
)
@kills("leblanc.studies.optimise.objectives:Passages._one", "found.torque.max()", "found.torque.min()")
def test_search_and_run_up_agree() -> None:
    """Loads over the run-up are those of `runup`, or the worse of them and those of `run`."""
    scene = _passing()
    found = lb.run_up(scene, check=False)
    loads, volumes = found.loads, np.array([[scene.chambers[0].volume]])
    assert loads is not None
    runs = Passages(scene, loaded=True)
    over = LoadsOver(FilledMachine(scene), None, 0.5e-3, runs)
    expected = {
        "floor_force": max(worst.value for worst in loads.feet),
        "walking_margin": 1.0 - loads.walking.value,
        "slip_margin": 1.0 - float(loads.worst.slip.min()),
        "point_clearance": (2e-3 - loads.clearances["rim"].value) / 1.5e-3,
        "motor_torque": float(loads.torque.max()),
    }
    steady = LoadsOver(FilledMachine(scene), scene.speeds, 0.5e-3)
    both = LoadsOver(FilledMachine(scene), scene.speeds, 0.5e-3, runs)
    for name, value in expected.items():
        assert over.of(name, volumes)[0] == pytest.approx(value, rel=1e-12), name
        larger = max(value, steady.of(name, volumes)[0])
        assert both.of(name, volumes)[0] == pytest.approx(larger, rel=1e-12), name
    # Passed at 3000 rpm/s the resonance has less than its steady amplitude: the two do differ.
    assert over.of("floor_force", volumes)[0] < 0.99 * steady.of("floor_force", volumes)[0]
    assert runs.of(volumes)[0].amplitude == pytest.approx(found.peak["amplitude"], rel=1e-12)


def test_optimise_over_the_run_up() -> None:
    """A limit of the passage alone is one that the steady answer would not keep; an objective falls."""
    scene = _passing().replace({"runup.samples": 60, "speeds.count": 21})
    volumes = np.array([[scene.chambers[0].volume], [0.0]])
    runs = Passages(scene, loaded=True)
    with_liquid, without = LoadsOver(FilledMachine(scene), None, 0.0, runs).of("floor_force", volumes)
    limit = 1.001 * max(with_liquid, without)
    task = {"floor_force": limit, "loads_over": "runup", "volumes": [["5 ml", "15 ml"]]}
    both = task | {"loads_over": "both", "volumes": [["10 ml", "10 ml"]]}
    steady = optimise_scene(scene.replace({"optimise": both}), front=False, response=False)
    assert not steady.feasible
    least = optimise_scene(
        scene.replace({"optimise": task | {"objective": "floor_force"}}), front=False, response=False
    )
    assert least.feasible and least.in_time
    assert least.unit == "N" and least.value <= with_liquid
    assert least.meaning == "largest force under a foot over the run-up in time"


def test_optimise_keeps_the_margins() -> None:
    """All limits hold at the best volumes, among them one that does not hold at those without limits."""
    scene = _rig().replace({"chambers": [_rig().table()["chambers"][0]]})
    free = optimise_scene(scene, front=False, response=False)
    used = LoadsOver(FilledMachine(scene), scene.speeds).of("walking_margin", free.volume[None])[0]
    limits = {"walking_margin": 1.0 - used + 0.002, "floor_force": "60 N", "point_clearance": "1.2 mm"}
    best = optimise_scene(scene.replace({"optimise": limits}), front=False, response=False)
    assert best.feasible
    kept = best.constraints["walking_margin"]
    assert used > kept.limit >= kept.value


def test_optimise_refuses_what_is_not_there() -> None:
    """A limit of what the scene does not have is named."""
    plain = lb.example("horizontal_rig")
    for task, field in (
        ({"walking_margin": 0.2}, "walking_margin"),
        ({"floor_force": 60.0}, "floor_force"),
        ({"point_clearance": 1e-3}, "point_clearance"),
        ({"slip_margin": 0.2}, "slip_margin"),
        ({"motor_torque": 1.0}, "motor_torque"),
        *(({"objective": name}, "objective") for name in LOADS),
    ):
        with pytest.raises(InputError, match=field):
            lb.optimise(plain.replace({"optimise": task}))
    with pytest.raises(InputError, match="loads_over"):
        lb.optimise(_rig(optimise={"walking_margin": 0.2, "loads_over": "runup"}, runup=None))
    with pytest.raises(InputError, match="deflection"):
        lb.optimise(_rig(optimise={"walking_margin": 0.2, "deflection": "1 mm"}))
