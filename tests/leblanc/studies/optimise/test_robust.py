"""The objective robust against the machine itself in each condition."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fluid.liquid import known_liquid, liquid_at
from leblanc.core.quantities import to_json
from leblanc.scene.rotors import TwoPlaneRotor
from leblanc.scene.scene import Scene, Speeds, load_scene
from leblanc.scene.tasks import Optimisation
from leblanc.scene.unbalances import unbalances_of
from leblanc.studies.optimise.answer import OptimumAnswer
from leblanc.studies.optimise.filled import FilledMachine
from leblanc.studies.optimise.objectives import AtSpeed
from leblanc.studies.optimise.problem import growth, growth_speeds, problem_of
from leblanc.studies.optimise.robust import (
    MOST_CONDITIONS,
    OperatingCondition,
    Robust,
    condition_table,
    operating_conditions,
    unbalance_range,
)
from leblanc.studies.optimise.study import optimise_scene
from leblanc.studies.run.study import run_scene
from meshes.errors import InputError
from tests.mutants import kills

EXAMPLES = Path(__file__).parents[4] / "examples"
WATER = known_liquid("water")
CELSIUS = 273.15


def scene(name: str) -> Scene:
    read = load_scene(EXAMPLES / f"{name}.toml")
    return read.altered(model=read.model.altered(liquid="statics"), optimise=None, runup=None)


def amplitude(machine: Scene, speed: float) -> float:
    return float(run_scene(machine.altered(speeds=Speeds.at(speed))).amplitude[0])


def _filled(machine: Scene, kelvin: float, volumes: tuple[float, ...]) -> Scene:
    """The machine with its liquids warmed by hand: mass stays, density falls."""
    chambers = []
    for chamber, volume in zip(machine.chambers, volumes, strict=True):
        warm = replace(liquid_at(chamber.liquid, kelvin), name="warm")
        held = volume * chamber.liquid.density / warm.density
        chambers.append(chamber.altered(liquid=warm, volume=held))
    return machine.altered(chambers=tuple(chambers))


@kills(
    "leblanc.studies.optimise.robust:in_condition",
    "liquid=liquid_at(chamber.liquid, condition.temperature), volume",
    "liquid=chamber.liquid, volume",
)
@kills("leblanc.studies.optimise.robust:Robust.exact", "self.quantile, axis=0", "1.0 - self.quantile, axis=0")
@kills("leblanc.studies.optimise.robust:UnbalanceRange.at", "low + (high - low)", "low + (high + low)")
def test_robust() -> None:
    """Worst case and median over a grid, from the machine itself with those unbalances and densities."""
    machine = scene("runup")
    volume = np.array([[4e-4]])
    around = operating_conditions(unbalance_range((0.1,), (0.05, 0.2)), (283.15, 333.15))
    assert len(around) == 9
    sizes = sorted({condition.unbalance for condition in around})
    np.testing.assert_allclose(np.ravel(sizes), (0.05, 0.125, 0.2), rtol=1e-12)
    density = {283.15: 999.70, 308.15: 994.03, 333.15: 983.20}  # handbook
    found = []
    for condition in around:
        assert condition.temperature is not None
        liquid = replace(WATER, name="other", density=density[condition.temperature])
        held = 4e-4 * WATER.density / liquid.density
        rotor = machine.rotor.altered(unbalance=condition.unbalance[0])
        fills = (machine.chambers[0].altered(liquid=liquid, volume=held),)
        found.append(amplitude(machine.altered(rotor=rotor, chambers=fills), 100.0))
    worst = Robust(machine, 100.0, around, 1.0)
    # The densities are given with five digits; the amplitude depends on them through the added mass.
    assert worst.exact(volume)[0] == pytest.approx(max(found), rel=1e-4)
    assert Robust(machine, 100.0, around, 0.5).exact(volume)[0] == pytest.approx(sorted(found)[4], rel=1e-4)
    full = machine.fills[0].chamber.capacity
    assert worst.around.fullest(np.array([[full]]))[0] == pytest.approx(WATER.density / 983.20, rel=1e-4)


def test_tub_against_each_condition() -> None:
    """A tub with its laundry and its brine changed by hand."""
    machine, speed = scene("tub"), 60.0
    around = operating_conditions(unbalance_range((machine.rotor.unbalance,), (0.4, 0.9)), (293.15, 333.15))
    around = tuple(condition for condition in around if condition.unbalance[0] != 0.65)
    volumes = tuple(0.3 * fill.chamber.capacity for fill in machine.fills)
    found = []
    for condition in around:
        warm = _filled(machine, condition.temperature or 0.0, volumes)
        loaded = warm.altered(rotor=machine.rotor.altered(unbalance=condition.unbalance[0]))
        found.append(amplitude(loaded, speed))
    robust = Robust(machine, speed, around, 1.0)
    assert max(found) > 1.05 * min(found)
    assert robust.exact(np.array([volumes]))[0] == pytest.approx(max(found), rel=1e-9)
    np.testing.assert_allclose(robust.around.amplitudes(np.array([volumes]))[:, 0], found, rtol=1e-9)


@pytest.mark.parametrize("together", [True, False])
@kills("leblanc.scene.unbalances:with_unbalances", "part.altered(size=size)", "part.altered(size=sizes[0])")
def test_two_planes_against_each_condition(together: bool) -> None:
    """All unbalances by one factor, or each in its own range: the sizes written into the machine by hand."""
    machine, speed = scene("two_plane_rig"), 150.0
    assert isinstance(machine.rotor, TwoPlaneRotor)
    own = tuple(part.size for part in machine.rotor.unbalances)
    assert len(own) == 2
    wanted = (0.5 * max(own), 2.0 * max(own)) if together else ((0.0, own[0]), (own[1], 3.0 * own[1]))
    around = operating_conditions(unbalance_range(own, wanted), None)
    expected = (
        [(factor * own[0], factor * own[1]) for factor in (0.5, 1.25, 2.0)]
        if together
        else [(a * own[0], b * own[1]) for a in (0.0, 0.5, 1.0) for b in (1.0, 2.0, 3.0)]
    )
    np.testing.assert_allclose([condition.unbalance for condition in around], expected, rtol=1e-12)
    volumes = tuple(0.2 * fill.chamber.capacity for fill in machine.fills)
    found = []
    for sizes in expected:
        parts = zip(machine.rotor.unbalances, sizes, strict=True)
        heavy = machine.rotor.altered(unbalances=tuple(part.altered(size=size) for part, size in parts))
        filled = _filled(machine.altered(rotor=heavy), 293.15, volumes)
        found.append(amplitude(filled, speed))
    np.testing.assert_allclose(
        Robust(machine, speed, around, 1.0).around.amplitudes(np.array([volumes]))[:, 0], found, rtol=1e-9
    )


def test_one_condition_is_the_working_speed() -> None:
    """The limit of the objective, through the whole optimiser: no range at all."""
    machine = scene("runup").altered(speeds=Speeds(start=100.0, stop=150.0, count=2))
    plain = Optimisation(volumes=((0.0, 0.05 * machine.fills[0].chamber.capacity),))
    single = plain.altered(objective="robust", unbalance=(machine.rotor.unbalance,) * 2)
    first, other = (
        optimise_scene(machine, task=task, front=False, response=False) for task in (plain, single)
    )
    np.testing.assert_array_equal(first.volume, other.volume)
    assert (first.value, first.baseline) == (other.value, other.baseline)
    assert other.robust is not None and other.robust.amplitude.shape == (1, 1)
    assert float(other.robust.amplitude[0, 0]) == first.value


@pytest.mark.parametrize("name", ["two_plane_rig", "tub"])
def test_one_condition_is_one_speed(name: str) -> None:
    """The same of rotors that tilt: each unbalance in a range of no width."""
    machine, speed = scene(name), 60.0
    sizes = unbalances_of(machine.rotor)
    (single,) = operating_conditions(unbalance_range(sizes, tuple((size, size) for size in sizes)), None)
    assert single == OperatingCondition(sizes, None)
    shares = np.array([[0.0], [0.1], [0.6]])
    volumes = shares * [fill.chamber.capacity for fill in machine.fills]
    plain = AtSpeed(FilledMachine(machine), np.array([speed]), np.ones(1))
    np.testing.assert_array_equal(Robust(machine, speed, [single], 1.0).exact(volumes), plain.exact(volumes))


@pytest.mark.slow
@pytest.mark.parametrize(("name", "levels"), [("tub", 41), ("two_plane_rig", 9)])
def test_the_best_volumes_against_a_grid(name: str, levels: int) -> None:
    """No volumes of a grid are better in their worst condition, by more than what counts as equal."""
    machine = scene(name)
    sizes = unbalances_of(machine.rotor)
    task = Optimisation(objective="robust", temperature=(283.15, 333.15), unbalance=(0.0, 2.0 * max(sizes)))
    best = optimise_scene(machine, task=task, front=False, response=False)
    around = operating_conditions(unbalance_range(sizes, task.unbalance), task.temperature)
    worst = [condition for condition in around if condition.unbalance[0] == 2.0 * sizes[0]]
    assert len(worst) == 3
    axes = [
        np.concatenate(([0.0], np.geomspace(1e-3, 1.0, levels - 1))) * fill.chamber.capacity / 1.02
        for fill in machine.fills
    ]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    robust = Robust(machine, machine.speeds.stop, worst, 1.0)
    assert best.value == pytest.approx(robust.exact(best.volume[None])[0], rel=1e-12)
    # Where an answer is costly the search counts a thousandth of the least that it found as equal and takes
    # the least liquid; what it found may be above the grid's, since it ends where a round gains too little.
    assert best.feasible and best.value <= robust.exact(grid).min() * (1.0 + 2e-3)


@pytest.fixture(scope="module")
def best() -> OptimumAnswer:
    task = Optimisation(objective="robust", unbalance=(0.05, 0.2), temperature=(278.15, 333.15))
    return optimise_scene(scene("runup"), task=task, front=False, response=False)


def test_table_of_the_answer(best: OptimumAnswer) -> None:
    """Each entry is the machine's own amplitude; the worst one is the value; the dry ones stand beside."""
    table, machine = best.robust, scene("runup")
    assert table is not None
    speed = machine.speeds.stop
    assert table.amplitude.shape == (25, 3) and table.condition_amplitude.shape == (9,)
    for k, j in ((0, 0), (7, 1), (24, 2)):
        loaded = machine.altered(rotor=machine.rotor.altered(unbalance=float(table.unbalance[j, 0])))
        own = _filled(loaded, float(table.temperature[k]), tuple(best.volume.tolist()))
        assert table.amplitude[k, j] == pytest.approx(amplitude(own, speed), rel=1e-9)
        speeds = growth_speeds(machine, Optimisation())
        held = np.array([[own.chambers[0].volume]])
        assert table.stability_margin[k] == pytest.approx(-growth(own, held, speeds)[0], rel=1e-9)
    assert table.condition_amplitude.max() == best.value
    assert table.condition_amplitude[table.decisive] == best.value
    assert table.amplitude.max() == pytest.approx(best.value, rel=1e-12)
    dry = machine.altered(chambers=tuple(c.altered(volume=0.0) for c in machine.chambers))
    heavy = dry.altered(rotor=dry.rotor.altered(unbalance=0.2))
    assert table.amplitude_dry[2] == pytest.approx(amplitude(heavy, speed), rel=1e-12)
    said = json.loads(json.dumps(best.to_json()["robust"]))
    assert said["worst"]["amplitude"] == best.value
    assert said["worst"]["unbalance"] == [0.2] and said["worst"]["temperature"] == 333.15
    assert np.array(said["amplitude"]).shape == (25, 3)
    data = best.to_dataset()
    np.testing.assert_array_equal(data["robust_amplitude"], table.amplitude)
    assert data["condition_unbalance"].dims == ("condition", "rotor_unbalance")


def test_quantile_names_its_condition() -> None:
    machine = scene("runup")
    spread = unbalance_range((0.1,), (0.05, 0.2))
    task = Optimisation(objective="robust", unbalance=(0.05, 0.2), quantile=0.5)
    robust = Robust(machine, 100.0, operating_conditions(spread, None), 0.5)
    table = condition_table(machine, task, robust, np.array([2e-4]), spread, lambda warm, held: 0.0)
    assert table.condition_unbalance[table.decisive, 0] == pytest.approx(0.125)
    assert not table.heated and to_json(table)["worst"]["temperature"] is None
    assert table.amplitude.shape == (1, 25)


def test_a_law_in_the_scene_is_taken() -> None:
    """Water written as a table gives the answer of water."""
    kelvins = [278.15 + 5.0 * k for k in range(12)]
    held = [liquid_at(WATER, kelvin) for kelvin in kelvins]
    table = {
        "density": {"temperatures": kelvins, "values": [liquid.density for liquid in held]},
        "viscosity": {"temperatures": kelvins, "values": [liquid.viscosity for liquid in held]},
    }
    task = Optimisation(objective="robust", temperature=(278.15, 333.15))
    machine = scene("runup")
    sampled = machine.replace({"chambers.0.liquid": table})
    volume = np.array([[4e-4]])
    first, other = (
        problem_of(one, task, FilledMachine(one), lambda _: pytest.fail("no search")).vibration
        for one in (machine, sampled)
    )
    assert other.exact(volume)[0] == pytest.approx(first.exact(volume)[0], rel=1e-6)


def test_stability_holds_at_every_temperature() -> None:
    """The margin is that of the temperature at which it is least; viscosity changes it by much."""
    machine = scene("washing_machine").replace({"chambers.0.liquid": "glycerol"})
    task = Optimisation(objective="robust", temperature=(278.15, 353.15), stability_margin=0.0)
    problem = problem_of(machine, task, FilledMachine(machine), lambda _: pytest.fail("no search"))
    (limit,) = (c for c in problem.constraints if c.name == "stability")
    volume = np.array([[0.2 * machine.fills[0].chamber.capacity]])
    each = []
    for kelvin in (278.15, 315.65, 353.15):
        warm = _filled(machine, kelvin, (float(volume[0, 0]),))
        each.append(
            float(growth(warm, np.array([[warm.chambers[0].volume]]), growth_speeds(machine, task))[0])
        )
    assert max(each) > min(each) + 1e-3
    assert limit.value(volume)[0] == pytest.approx(max(each), rel=1e-9)


def test_what_cannot_be_judged_is_refused() -> None:
    machine, two = scene("runup"), scene("two_plane_rig")
    own, mercury = (0.1, 0.2), machine.replace({"chambers.0.liquid": "mercury"})
    for ask, field in (
        (lambda: unbalance_range((), None), "rotor.unbalances"),
        (lambda: unbalance_range((0.0, 0.0), (0.1, 0.2)), "rotor.unbalances"),
        (lambda: unbalance_range(own, ((0.1, 0.2),)), "optimise.unbalance"),
        (
            lambda: operating_conditions(unbalance_range((0.1,) * 7, ((0.1, 0.2),) * 7), None),
            "optimise.samples",
        ),
        (lambda: Robust(machine, 100.0, [OperatingCondition((0.1,), 400.0)], 1.0), "temperature"),
        (
            lambda: Robust(mercury, 1.0, [OperatingCondition((0.1,), 300.0)], 1.0),
            "liquid",
        ),
        (
            lambda: optimise_scene(
                two.altered(rotor=two.rotor.altered(unbalances=())), task=Optimisation(objective="robust")
            ),
            "rotor.unbalances",
        ),
    ):
        with pytest.raises(InputError, match=field):
            ask()
    assert math.prod((3,) * 6) == MOST_CONDITIONS
    many = operating_conditions(unbalance_range((0.1,) * 7, ((0.1, 0.2),) * 7), None, samples=50, seed=1)
    assert len(many) == 50 and len({condition.unbalance for condition in many}) == 50
