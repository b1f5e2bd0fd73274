"""The largest amplitude of a machine does not depend on the speeds that are asked for."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.core.units import MINUS, RPM, Unit, change_words, measured
from leblanc.liquid.choose import choose_all, liquid_models, prepare
from leblanc.scene.scene import Scene, load_scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies import peaks as search
from leblanc.studies.optimise.filled import FilledMachine, with_volumes
from leblanc.studies.optimise.objectives import PeakOver
from leblanc.studies.optimise.study import optimise_scene
from leblanc.studies.peaks import _distinct, responses_between
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.notes import RunCode
from leblanc.studies.run.study import run_scene
from leblanc.studies.run.words import alts, answer, comparisons, effect, error_at, remarks, unseen
from leblanc.studies.sweep.batch import answer_scenes
from meshes.arrays import Array
from solvers.synchronous.response import Response, by_speed, response
from tests.mutants import kills
from tests.oracles.pages import rows_of

EXAMPLES = Path(__file__).parents[3] / "examples"


def scene(name: str, count: int, **changes: Any) -> Scene:
    """An example at so many speeds, with other values; two underscores stand for a dot."""
    values = {path.replace("__", "."): value for path, value in changes.items()}
    return load_scene(EXAMPLES / f"{name}.toml").replace({"speeds.count": count, **values})


@cache
def run(name: str, count: int) -> RunAnswer:
    return run_scene(scene(name, count))


def both(own: Scene) -> Response:
    """The response of a scene at its speeds and between them, without a search for whirls."""
    machine = prepare(own)
    (choice,) = choose_all([machine])
    fills, gravity = own.fills, machine.axial_gravity
    found = response(machine.rotor, fills, machine.speed, gravity, liquid_models(choice))
    return by_speed([found, *responses_between([machine], [found])])


def sampled(own: Scene, count: int) -> Response:
    """The response at so many speeds, and no others."""
    machine = replace(prepare(own), speed=np.linspace(own.speeds.start, own.speeds.stop, count))
    (choice,) = choose_all([machine])
    return response(machine.rotor, own.fills, machine.speed, machine.axial_gravity, liquid_models(choice))


@pytest.mark.parametrize("name", ["tub", "centrifuge", "two_plane_rig"])
def test_peak_does_not_depend_on_the_speeds(name: str) -> None:
    """One machine at 30, 60 and 241 speeds has one peak, with liquid and without, to 1e-9."""
    found = [both(scene(name, count)) for count in (30, 60, 241)]
    for size in ("amplitude", "amplitude_dry"):
        largest = [float(getattr(each, size).max()) for each in found]
        np.testing.assert_allclose(largest, largest[-1], rtol=1e-9)


def test_closed_form() -> None:
    """e/(2 zeta sqrt(1 - zeta^2)) at omega/sqrt(1 - 2 zeta^2) without liquid, from 12 speeds."""
    ratio, rate = 1e-4, 1000.0 / RPM
    own = scene("horizontal_rig", 12, rotor__damping_ratio=ratio, rotor__critical_speed="1000 rpm")
    found = run_scene(own)
    eccentricity = own.rotor.machine().unbalance / own.rotor.machine().mass
    left = 2.0 * ratio * math.sqrt(1.0 - ratio**2)
    # Near the top, stiffness and inertia cancel to 1e-4 of them, and rounding counts 1e4 times.
    assert found.peak_dry["amplitude"] == pytest.approx(eccentricity / left, rel=1e-11)
    assert found.peak_dry["speed"] == pytest.approx(rate / math.sqrt(1.0 - 2.0 * ratio**2), rel=1e-12)
    assert found.amplitude.max() < 1e-2 * found.peak["amplitude"]  # what the speeds themselves see


def random_machine(seed: int) -> Scene:
    """A tub or a rotor in two bearings, with other dampers, unbalance, volumes and liquid model."""
    rng = np.random.default_rng(seed)
    own = load_scene(EXAMPLES / f"{'tub' if seed % 2 else 'two_plane_rig'}.toml")
    damping, size = 10.0 ** rng.uniform(-3, 0), 10.0 ** rng.uniform(-2, 0.3)
    if seed % 2:
        values = {"rotor.unbalance": own.rotor.unbalance * size * damping}
        for k, damper in enumerate(own.rotor.dampers):
            along = np.asarray(damper.damping) * damping
            values[f"rotor.dampers.{k}.damping"] = along.tolist()
    else:
        values = {f"rotor.supports.{k}.damping": 80.0 * damping * rng.uniform(0.3, 2.0) for k in range(2)}
        values |= {f"rotor.supports.{k}.stiffness": 4e4 * rng.uniform(0.5, 2.0) for k in range(2)}
        values |= {f"rotor.unbalances.{k}.size": 1e-3 * damping * size for k in range(2)}
    for k, fill in enumerate(own.fills):
        values[f"chambers.{k}.volume"] = fill.chamber.capacity * 10.0 ** rng.uniform(-2, -0.1)
    return own.replace(values | {"model.liquid": str(rng.choice(["auto", "linear"]))})


def assert_peaks(seed: int, fine: int) -> None:
    """No amplitude at so many speeds is above a peak that was found from 30 or 97."""
    own = random_machine(seed)
    found = [both(own.replace({"speeds.count": count})) for count in (30, 97)]
    dense = sampled(own, fine)
    for size in ("amplitude", "amplitude_dry"):
        largest = [float(getattr(each, size).max()) for each in found]
        assert largest[0] == pytest.approx(largest[1], rel=1e-9)
        assert min(largest) >= float(getattr(dense, size).max()) * (1.0 - 1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_random_machines(seed: int) -> None:
    """At 2001 speeds."""
    assert_peaks(seed, 2001)


@kills("solvers.synchronous.coupled:several_planes", "for above in (1, -1)", "for above in ()")
def test_a_speed_on_a_tongue_sees_it() -> None:
    """Of 97 speeds one lies on the tongue; it has the amplitude that 200 speeds lead to step by step."""
    own = random_machine(12)
    few = sampled(own, 97)
    k = int(np.argmin(np.abs(few.speed - 112.08)))
    machine = replace(prepare(own), speed=np.linspace(109.0, float(few.speed[k]), 200))
    (choice,) = choose_all([machine])
    near = response(machine.rotor, own.fills, machine.speed, machine.axial_gravity, liquid_models(choice))
    assert few.amplitude[k] == pytest.approx(float(near.amplitude[-1]), rel=1e-7)
    assert few.amplitude[k] > 10.0 * np.nanmin(few.branch_amplitude[k])


def test_a_tongue_between_the_speeds() -> None:
    """The upper branch of a sharp resonance, which most speeds do not see, is followed to where it ends."""
    own = random_machine(12).replace({"speeds.start": 105.0, "speeds.stop": 118.0})
    peaks = [float(both(own.replace({"speeds.count": n})).amplitude.max()) for n in (4, 9)]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6, 20))
def test_random_machines_at_many_speeds(seed: int) -> None:
    """At 20 001 speeds."""
    assert_peaks(seed, 20001)


def test_peak_at_an_end() -> None:
    """Below the resonance the largest amplitude is that of the last speed, above it that of the first."""
    below = run_scene(scene("horizontal_rig", 20, speeds__start="200 rpm", speeds__stop="700 rpm"))
    above = run_scene(scene("horizontal_rig", 20, speeds__start="1400 rpm", speeds__stop="2000 rpm"))
    assert below.peak == {"speed": below.speed[-1], "amplitude": below.amplitude[-1]}
    assert above.peak == {"speed": above.speed[0], "amplitude": above.amplitude[0]}
    assert "The largest amplitude lies at an end of the range of speeds." in remarks(below)


def assert_unbounded(own: Scene) -> RunAnswer:
    """A resonance that nothing damps has no peak that could be named, and everyone says so."""
    found = run_scene(own)
    assert math.isinf(found.peak["amplitude"]) and math.isinf(found.peak_dry["amplitude"])
    assert found.to_json()["peak"]["amplitude"] is None and found.to_json()["peak"]["speed"] > 0.0
    assert np.isfinite(found.amplitude).all()  # at the speeds asked for
    assert [note.data["speed"] for note in found.notes if note.code == RunCode.UNBOUNDED] == [
        found.peak["speed"]
    ]
    assert "grows without bound at" in answer(found)
    return found


def test_no_damping_no_bound() -> None:
    """Of a planar rotor; one with damping has a bound."""
    assert_unbounded(scene("horizontal_rig", 33, rotor__damping_ratio=0.0))
    damped = run("horizontal_rig", 33)
    assert not [note for note in damped.notes if note.code == RunCode.UNBOUNDED]


@kills("leblanc.studies.peaks:_without_bound", ">= _GROWN *", "< _GROWN *")
def test_no_damping_of_a_tilting_rotor() -> None:
    """Of a rotor whose resonances are found as roots: the amplitude goes as one over the distance."""
    own = scene("two_plane_rig", 5, **{f"rotor__supports__{k}__damping": 0.0 for k in range(2)})
    speed = assert_unbounded(own).peak["speed"]
    near = response(own.rotor.machine(), own.fills, speed * (1.0 - np.array([1e-3, 1e-5])), 0.0)
    assert near.amplitude[1] > 50.0 * near.amplitude[0]


def test_a_result_keeps_the_speeds_asked_for() -> None:
    """The lists over speed are those of the scene; what was looked at besides is a part of its own."""
    found = run("tub", 60)
    written, data = found.to_json(), found.to_dataset()
    assert len(written["speed"]) == len(written["amplitude"]) == 60
    assert written["peak"] == found.peak and written["peak_dry"] == found.peak_dry
    assert found.refined is not None and len(written["refined"]["speed"]) == found.refined.speed.size > 0
    assert written["peak"]["amplitude"] in written["refined"]["amplitude"]
    assert float(data["peak_amplitude"]) == found.peak["amplitude"]
    assert float(data["peak_dry_speed"]) == found.peak_dry["speed"]
    np.testing.assert_array_equal(data["refined_amplitude"], found.refined.amplitude)
    assert data["refined_amplitude"].dims == ("refined_speed",) and data["amplitude"].size == 60
    assert not np.isin(found.refined.speed, found.speed).any()
    assert (
        np.all(np.diff(found.curve.speed) > 0.0) and found.curve.speed.size == 60 + found.refined.speed.size
    )
    assert found.chamber_curve.shape == (found.curve.speed.size, 1)
    assert rows_of(found)["at the speed (rpm)"] == f"{found.peak['speed'] * RPM:.4g}"


def test_one_speed_has_no_range() -> None:
    """At a single speed the peak is the answer there."""
    found = run_scene(scene("tub", 1, speeds__start="100 rpm", speeds__stop="100 rpm"))
    assert found.peak == {"speed": found.speed[0], "amplitude": found.amplitude[0]}
    assert found.refined is not None and found.refined.speed.size == 0


def test_sweeps_and_comparisons() -> None:
    """Scenes at once, and models side by side, have the peaks of `run`."""
    scenes = [scene(name, 31) for name in ("centrifuge", "horizontal_rig", "tub")]
    answers = answer_scenes(scenes)
    for k, own in enumerate(scenes):
        alone = run_scene(own)
        assert answers.peak_amplitude[k] == pytest.approx(alone.peak["amplitude"], rel=1e-9)
        assert answers.peak_amplitude_dry[k] == pytest.approx(alone.peak_dry["amplitude"], rel=1e-9)
    models = lb.compare(scenes[0], ["linear", "statics"])
    assert models.answers[1].peak_amplitude == pytest.approx(
        run("centrifuge", 241).peak["amplitude"], rel=1e-3
    )


# Resonances below the speed at which gravity across the axis lets an annular layer be.
RIG = {"rotor.critical_speed": "90 rpm", "rotor.damping_ratio": 0.02, "rotor.unbalance": 1e-5}
PLANES = {f"rotor.supports.{k}.{name}": value for k in (0, 1) for name, value in
          (("stiffness", 700.0), ("damping", 2.0))}  # fmt: skip
PLANES |= {
    "rotor.unbalances.0.size": 1.5e-5,
    "rotor.unbalances.1.size": 1.2e-5,
    "rotor.unbalances.1.angle": 0.5,
}
LOW = {"speeds.start": "60 rpm", "speeds.stop": "400 rpm", "model.liquid": "statics", "assumed": []}
LYING = {"horizontal_rig": RIG | LOW, "two_plane_rig": PLANES | LOW}


def stands(own: Scene) -> float:
    """Speed at which centrifugal acceleration at the surface of the thickest layer is gravity, rad/s."""
    radii = []
    for fill in own.fills:
        area = math.pi * fill.chamber.radius**2 - fill.volume / fill.chamber.height
        radii.append(math.sqrt(area / math.pi))
    return max(math.sqrt(own.gravity / radius) for radius in radii)


@kills("solvers.synchronous.response:Response.holds", "self.converged & self.in_range", "self.converged")
def test_the_largest_amplitude_is_that_of_speeds_at_which_the_answer_holds() -> None:
    """An edge or a lower resonance above the speed of an annular layer, from few speeds as from many.

    At 1001 speeds nothing that holds is larger, and below the edge something is.
    """
    for name, changes in LYING.items():
        own = lb.example(name).replace(changes)
        edge = stands(own)
        dense = sampled(own, 1001)
        holds = dense.speed > edge
        found = [run_scene(own.replace({"speeds.count": count})) for count in (12, 60)]
        for each in found:
            assert each.peak["speed"] >= edge * (1.0 - 1e-12)
            assert each.peak["amplitude"] == pytest.approx(found[0].peak["amplitude"], rel=1e-8)
            # A dense grid misses the edge by up to a step, a quarter of a percent of the speed.
            assert each.peak["amplitude"] >= dense.amplitude[holds].max() * (1.0 - 1e-9)
            assert each.peak["amplitude"] <= dense.amplitude[holds].max() * 1.02
        assert dense.amplitude[~holds].max() > 2.0 * found[0].peak["amplitude"]
        if name == "horizontal_rig":  # falls from the edge on
            assert found[0].peak["speed"] == pytest.approx(edge, rel=1e-8)
        answers = answer_scenes([own.replace({"speeds.count": 12})])
        assert answers.peak_amplitude[0] == pytest.approx(found[0].peak["amplitude"], rel=1e-8)


@kills("leblanc.studies.peaks:_holding", "np.outer(wide, _EDGE_PARTS)", "0.0 * np.outer(wide, _EDGE_PARTS)")
@kills("leblanc.studies.peaks:_holding", "not known.holds[k]]", "known.holds[k]]")
@kills("leblanc.studies.peaks:_holding", "carried_from * (1.0 + ", "carried_from * (1.1 + ")
def test_the_edge_is_where_liquid_begins_to_ride(monkeypatch: pytest.MonkeyPatch) -> None:
    """Closed in on from both sides, and from the speed that holds the layer against gravity alone."""
    own = lb.example("horizontal_rig").replace(LYING["horizontal_rig"] | {"speeds.count": 12})
    for name, less in (("captured_speed", lambda _: None), ("_EDGE_PARTS", np.zeros(0))):
        with monkeypatch.context() as patch:
            patch.setattr(search, name, less)
            assert run_scene(own).peak["speed"] == pytest.approx(stands(own), rel=1e-8)


@cache
def lying(name: str) -> RunAnswer:
    return run_scene(lb.example(name).replace(LYING[name] | {"speeds.count": 12}))


def test_what_the_largest_amplitude_leaves_out_is_told() -> None:
    """The speeds that do not count, why, how large it is there, and whether the peak lies beside them."""
    for name, beside in (("horizontal_rig", True), ("two_plane_rig", False)):
        found = lying(name)
        (note,) = (note for note in found.notes if note.code is RunCode.LEFT_OUT)
        ((first, last),) = note.data["spans"]
        assert first == found.speed[0] and found.curve.speed[~found.curve.in_range][-1] == last
        assert note.data["amplitude"] == found.curve.amplitude.max() > found.peak["amplitude"]
        assert note.data["at_edge"] is beside and ("lies at the edge" in note.text) is beside
        assert "no annular layer exists" in note.text
        rows = rows_of(found)
        assert rows["at the speed (rpm)"] == f"{found.peak['speed'] * RPM:.4g}"
        assert "where the answer holds is" in answer(found)
        assert all("where the answer holds" in alts(found)[figure] for figure in ("amplitude", "chamber"))
    upright = run("centrifuge", 241)
    assert not [note for note in upright.notes if note.code is RunCode.LEFT_OUT]
    assert "holds" not in answer(upright)


@kills(
    "leblanc.studies.run.answer:RunAnswer.curve", "by_speed([self.response, self.refined])", "self.refined"
)
def test_one_curve_contains_its_peaks() -> None:
    """The largest amplitude of the curve, among the speeds in range, is the peak of the table."""
    for found in (run("centrifuge", 241), lying("two_plane_rig")):
        curve, data = found.to_json()["curve"], found.to_dataset()
        for size, inside in (
            (np.array(curve["amplitude"]), np.array(curve["in_range"])),
            (data["curve_amplitude"].values, data["curve_in_range"].values == 1),
        ):
            assert size[inside].max() == found.peak["amplitude"]
        assert max(curve["amplitude_dry"]) == found.peak_dry["amplitude"]
        assert np.all(np.diff(curve["speed"]) > 0.0) and data["curve_amplitude"].dims == ("curve_speed",)
        assert set(found.to_json()["speed"]) <= set(curve["speed"])


@kills("leblanc.studies.held.held:_between", "in (wet, refined.amplitude_dry)", "in (wet,)")
def test_a_dry_machine_has_one_peak_however_its_liquid_is_held() -> None:
    """The peak without liquid is the same one, integrated in time or not; the liquid is asked at it too."""
    own = lb.example("two_plane_rig").replace({"speeds.start": "400 rpm", "speeds.stop": "1200 rpm"})
    own = own.replace({"speeds.count": 4, "model.cells": 16, "model.friction": {"linear": 20.0}})
    steady, held = (run_scene(own.replace({"model.held": way})) for way in ("never", "always"))
    assert held.held is not None and held.held.at.all() and held.refined is not None
    assert held.peak_dry == steady.peak_dry and held.peak_dry["amplitude"] > held.amplitude_dry.max()
    # The held wave at the speed of the steady peak is as high as that peak, to what 16 cells are off.
    assert held.peak["speed"] in held.refined.speed and held.peak["amplitude"] > held.amplitude.max()
    assert held.peak["amplitude"] == pytest.approx(steady.peak["amplitude"], rel=0.02)
    assert any("one of the speeds held" in note.text for note in held.notes)


def test_a_peak_of_the_optimiser_does_not_fall_because_less_of_it_counts() -> None:
    """Its range begins where the thinnest layer can be: the same for every volume, none and full included."""
    own = lb.example("horizontal_rig").replace(LYING["horizontal_rig"])
    machine = FilledMachine(own)
    begin = math.sqrt(own.gravity / 0.05)  # of the smaller of the two walls
    assert machine.first_speed(own.speeds) == pytest.approx(begin, rel=1e-12)
    volumes = np.array([[0.0, 0.0], [1e-5, 1e-5], [0.999 * fill.chamber.capacity for fill in own.fills]])
    ends = machine.at(np.repeat(volumes, 2, axis=0), np.tile([begin, own.speeds.stop], 3))
    np.testing.assert_allclose(
        machine.peaks(volumes, own.speeds), ends.amplitude.reshape(3, 2).max(1), rtol=1e-9
    )


def over(own: Scene, volume: Array, count: int) -> float:
    """Largest amplitude that `run` finds with some volumes, by the model of the optimiser."""
    fine = with_volumes(own.replace({"speeds.count": count, "model.liquid": "statics"}), volume)
    return float(both(fine).amplitude.max())


@pytest.mark.parametrize(("name", "counts"), [("horizontal_rig", (9, 60)), ("centrifuge", (9,))])
def test_the_optimiser_promises_what_run_finds(name: str, counts: tuple[int, ...]) -> None:
    """The value of the best volumes is the peak at 2001 speeds, and no grid is there to profit from."""
    task = Optimisation(objective="peak", steady=True, stable=False)
    for count in counts:
        own = scene(name, count)
        best = optimise_scene(own, task=task, front=False)
        assert best.value == pytest.approx(over(own, best.volume, 2001), rel=1e-9)
        assert best.response is not None and best.response.peak["amplitude"] == pytest.approx(
            best.value, rel=1e-9
        )


@kills("leblanc.studies.optimise.filled:FilledMachine._planar_peaks", "found[outside] = (", "outside = (")
def test_peaks_over_a_range() -> None:
    """With many volumes at once, in ranges that hold the resonance and that do not, as `run` finds them."""
    for changes in ({}, {"speeds__stop": "900 rpm"}, {"speeds__start": "1300 rpm"}):
        own = scene("horizontal_rig", 25, **changes)
        volumes = np.array([[0.0, 0.0], [2e-6, 1e-6], [1e-5, 2e-5]])
        found = PeakOver(FilledMachine(own), own.speeds).exact(volumes)
        np.testing.assert_allclose(found, [over(own, volume, 25) for volume in volumes], rtol=1e-9)


@kills("leblanc.studies.peaks:_distinct", "> _TWIN * others", ">= 0.0")
@kills("leblanc.studies.peaks:_distinct", "> _TWIN * first", "> 0.0")
def test_resonances_that_are_one() -> None:
    """Twins a rounding apart, equal modes or wet and dry ones, get one speed; others keep their own."""
    once = np.array([3.0, 7.0, 11.0])
    nudged = once * (1.0 + 4e-16 * np.array([1.0, -1.0, 1.0]))
    both = np.sort(np.concatenate((once, nudged[nudged != once])))
    assert both.size == 5 or both.size == 6
    np.testing.assert_allclose(_distinct(both, nudged), once, rtol=1e-15)
    apart = once * (1.0 + 1e-11)
    assert _distinct(once, apart).size == 6 and _distinct(once[:0], apart).size == 3
    assert _distinct(apart, once[:0]).size == 3


@kills("leblanc.core.units:change_words", "size / without - 1.0", "without / size - 1.0")
@kills(
    "leblanc.studies.run.words:effect",
    "float(curve.amplitude[top]), bare",
    "float(curve.amplitude[-1]), bare",
)
@kills("leblanc.studies.run.words:effect", "float(curve.amplitude_dry[-1])", "float(curve.amplitude_dry[0])")
def test_the_direction_of_what_the_liquid_does() -> None:
    """In per cent at the last speed and, where the answer holds, between the two largest amplitudes."""
    found = lb.run(lb.example("horizontal_rig"))
    most, _, last, *_ = comparisons(found)
    said = effect(found)
    assert f"is {last.wet_text} instead of {last.dry_text}" in said and "does not hold" not in said
    for row in (most, last):
        share = 100.0 * (float(row.ratio) - 1.0)
        assert f"{MINUS}{abs(share):.{1 if abs(share) < 10.0 else 0}f} %" in said
    # No percentage of what is unstable.
    wild = effect(lb.run(lb.example("runup")))
    assert "(unstable): see leblanc runup." in wild and wild.count("%") == 1
    lying = effect(lb.run(lb.example("washing_machine")))
    assert "no annulus from rest below" in lying and lying.count("%") == 2  # one is the error


@kills("leblanc.studies.run.words:error_at", "np.maximum(error[left]", "np.fmax(error[left]")
@kills("leblanc.studies.run.words:error_at", "np.maximum(error[left]", "np.minimum(error[left]")
def test_between_two_speeds_the_larger_error_counts_and_none_where_one_is_not_known() -> None:
    found = lb.run(lb.example("runup"))
    top = found.curve.top
    assert top is not None and found.error_estimate is not None
    right = int(np.searchsorted(found.speed, found.curve.speed[top]))
    assert found.speed[right - 1] < found.curve.speed[top] < found.speed[right]
    for left_error, right_error in ((0.1, 0.2), (0.2, 0.1), (np.nan, 0.1), (0.1, np.nan), (np.inf, 0.1)):
        error = np.full(found.speed.shape, 0.3)
        error[right - 1], error[right] = left_error, right_error
        counted = error_at(replace(found, error_estimate=error), top)
        wanted = np.nan if np.isnan(left_error + right_error) else max(left_error, right_error)
        assert counted == wanted or (np.isnan(counted) and np.isnan(wanted))


def test_resonances_that_are_not_asked_for_are_named() -> None:
    scene = lb.example("tub")
    assert unseen(lb.run(scene.replace({"speeds.start": "20 rpm", "speeds.count": 60}))) == ""
    few = unseen(lb.run(scene.replace({"speeds.start": "100 rpm", "speeds.count": 60})))
    assert "of 6 critical speeds lie below the first speed" in few
    assert change_words(1.51, 1.0) == "+51 %" and change_words(1.0, 1.0) == "no change"
    assert change_words(1.0, 0.0) == change_words(math.inf, 1.0) == change_words(1.0, math.nan) == ""
    assert effect(lb.run(lb.example("runup").replace({"chambers.0.volume": 0.0}))) == ""


def test_damped_beyond_a_top() -> None:
    """With c^2 > 2 k (M + full liquid) the amplitude rises with the speed: no top, not one at no speed."""
    scene = lb.example("washing_machine")
    full = sum(998.2 * np.pi * c.radius**2 * c.height for c in scene.liquids)
    damping = 1.1 * np.sqrt(2.0 * 11196.0 * (scene.rotor.machine().mass + full))
    found = lb.run(scene.replace({"rotor.damping": float(damping)}))
    assert np.all(np.diff(found.curve.amplitude) > 0.0)
    assert found.peak == {"speed": found.speed[-1], "amplitude": found.amplitude[-1]}


@kills("leblanc.core.units:measured", "1 - math.floor", "2 - math.floor")
@kills("leblanc.core.units:measured", "3 - math.floor", "5 - math.floor")
def test_no_digit_is_finer_than_the_error() -> None:
    cases = (
        (7.952e-3, 0.72e-3, "7.95 \N{PLUS-MINUS SIGN} 0.72"),
        (5.5635e-3, 2.0e-3, "5.6 \N{PLUS-MINUS SIGN} 2.0"),
        (0.2863, 0.012, "286 \N{PLUS-MINUS SIGN} 12"),
        (12.863, 0.37, "12860 \N{PLUS-MINUS SIGN} 370"),
        (1.0855e-3, 1.9e-6, "1.086 \N{PLUS-MINUS SIGN} 0.002"),  # four digits at most
        (2.8634e-3, 1e-8, "2.863"),  # they say all
        (2.8634e-3, 3e-3, "2.863"),  # nothing is sure: said in words
        (2.8634e-3, math.nan, "2.863"),
        (math.inf, 1.0, "infinite"),
    )
    for value, error, shown in cases:
        assert measured(value, error, Unit("mm", 1e3)) == shown
