"""`fit`: the truth found again within its own errors, and what the data cannot tell said in words."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.scene import scene_from_table
from leblanc.studies.fit.answer import Noise
from leblanc.studies.fit.errors import averaged, curvature
from leblanc.studies.fit.measured import Measurement, read_measured
from leblanc.studies.fit.noise import Judged, alike_by_chance, refine
from leblanc.studies.fit.notes import FitCode
from leblanc.studies.fit.problem import Problem
from leblanc.studies.fit.problem import answer as _answer
from leblanc.studies.fit.study import fit_scene
from meshes.arrays import Array
from meshes.errors import InputError
from tests.leblanc.studies.random_fits import DRY, covered, drawn
from tests.mutants import kills
from validation.cases.rotors.rigs import _fit, _liquid_angle, horizontal_rig
from validation.study import data

RIG = lb.example("horizontal_rig")
# Most of these tests are of statistics: a machine without liquid answers ten times sooner.
MACHINE = scene_from_table(DRY)
SPEED = np.linspace(10.0, 60.0, 30)
UNKNOWN = ("rotor.stiffness", "rotor.damping")
TRUTH = np.array([18750.0, 90.0])
LIKELY = 2.0 * math.log(3.0)  # minus twice the logarithm of a likelihood of a third
GUESS = MACHINE.replace({"rotor.stiffness": 15e3, "rotor.damping": 60.0})


@pytest.fixture
def one_valley(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two searches, three at most: for tests that are of no search, of data with one valley."""
    less = {"_UNSEEN": math.inf, "_MOST": (3, 0), "_TRIED": 4, "_VALLEYS": 1}
    for name, value in less.items():
        monkeypatch.setattr(f"leblanc.studies.fit.search.{name}", value)


def over_speed(amplitude: Array, speed: Array = SPEED) -> Measurement:
    return Measurement("speed", speed, (("amplitude", amplitude),))


def measured(noise: float, seed: int, scale: float = 1.0) -> Measurement:
    (amplitude,) = _answer(MACHINE, "speed", SPEED, ["amplitude"])
    random = np.random.default_rng(seed)
    size = noise * np.sqrt(np.mean(np.square(amplitude)))
    return over_speed(scale * (amplitude + size * random.standard_normal(30)))


@pytest.mark.usefixtures("one_valley")
@kills("leblanc.studies.fit.noise:_noise", "np.sqrt(mean / share)", "np.sqrt(9.0 * mean / share)")
@kills("leblanc.studies.fit.study:_answer", "value, problem.spans)", "9.0 * value, problem.spans)")
def test_truth_within_its_errors() -> None:
    """Errors are as large as they are said to be: over five sets of noise their squares average to one."""
    squares = []
    for seed in range(5):
        found = fit_scene(GUESS, measured(0.02, seed), UNKNOWN, starts=1)
        assert found.converged and found.accepted
        squares.append(np.square((found.value - TRUTH) / found.std))
    # Of ten squares of a normal variable: a mean of 1 with a chance of 1e-3 each of less and of more.
    assert 0.148 < np.mean(squares) < 2.96


@pytest.mark.usefixtures("one_valley")
def test_without_noise() -> None:
    """The truth to rounding, whatever the seed; no errors without noise, and the same answer again."""
    for seed in (0, 1):
        found = fit_scene(GUESS, measured(0.0, 0), UNKNOWN, starts=3, seed=seed)
        # The search ends where a step changes the sum by 1e-8 of it, or the values by 1e-8.
        np.testing.assert_allclose(found.value, TRUTH, rtol=1e-5)
        assert found.residual_rms < 1e-5 and found.accepted
    again = fit_scene(GUESS, measured(0.02, 3), UNKNOWN, starts=2, seed=5)
    assert again.parameters == fit_scene(GUESS, measured(0.02, 3), UNKNOWN, starts=2, seed=5).parameters


@pytest.mark.usefixtures("one_valley")
@kills("leblanc.studies.fit.noise:_noise", "is None else before", "is None or 1 else before")
def test_a_free_scale() -> None:
    """A sensor in its own units: the same values, and its scale."""
    plain = fit_scene(GUESS, measured(0.02, 1), UNKNOWN, starts=1)
    found = fit_scene(GUESS, measured(0.02, 1, 8192.0), UNKNOWN, starts=1, scale="free")
    # The factor takes up noise that the values would have to: a standard error or two, about 1 % each.
    assert found.scale == pytest.approx(8192.0, rel=0.05)
    np.testing.assert_allclose(found.value, plain.value, rtol=0.05)
    assert FitCode.SCALE in [note.code for note in found.notes]
    assert found.measured[0].unit == ""
    (amplitude,) = _answer(MACHINE, "speed", SPEED, ["amplitude"])
    noise = 1.0 + 0.2 * np.random.default_rng(0).standard_normal(30)
    found = fit_scene(MACHINE, over_speed(50.0 * amplitude * noise), UNKNOWN[1:], starts=1, scale="free")
    # Relative noise is that of what is shown; a factor that weighs all points alike leaves 2.6 % more.
    (one,) = found.measured
    assert found.noise.kind == "relative"
    size = math.sqrt(float(np.sum(np.square(one.value / one.fitted - 1.0))) / found.freedom)
    assert found.noise.size[0] == pytest.approx(size, rel=1e-5)


@pytest.mark.usefixtures("one_valley")
def test_what_the_data_cannot_tell() -> None:
    """Far above the resonance damping does nothing, and mass and unbalance only by their ratio: said so."""
    fast = np.linspace(600.0, 900.0, 12)
    (amplitude,) = _answer(MACHINE, "speed", fast, ["amplitude"])
    random = np.random.default_rng(0)
    table = over_speed(amplitude * (1.0 + 0.01 * random.standard_normal(12)), fast)
    found = fit_scene(MACHINE, table, ("rotor.damping",), starts=1)
    told = {note.code for note in found.notes}
    assert told & {FitCode.VAGUE, FitCode.NOT_TOLD, FitCode.AT_BOUND, FitCode.PLATEAU}
    assert math.isnan(found.std[0]) and found.accepted
    together = fit_scene(MACHINE, table, ("rotor.mass", "rotor.unbalance"), starts=1)
    (flat,) = [note for note in together.notes if note.code == FitCode.FLAT]
    # The stiffness is 1e-3 of the mass's force there.
    np.testing.assert_allclose(np.array(flat.data["powers"]), [math.sqrt(0.5)] * 2, rtol=5e-3)
    assert np.isnan(together.std).all()
    assert together.value[1] / together.value[0] == pytest.approx(0.004 / 30.0, rel=0.02)


@pytest.mark.usefixtures("one_valley")
@kills("leblanc.studies.fit.answer:quantile", "stdtrit(freedom, _UPPER)", "stdtrit(99, _UPPER)")
@kills("leblanc.studies.fit.answer:FitAnswer.interval", "self.value / factor", "self.value - factor")
def test_interval() -> None:
    """Student's t of the table, 2.306 for eight degrees of freedom, about the logarithm; wider for fewer."""
    speed = np.linspace(12.0, 50.0, 10)
    (amplitude,) = _answer(MACHINE, "speed", speed, ["amplitude"])
    noisy = over_speed(amplitude * (1.0 + 0.1 * np.random.default_rng(1).standard_normal(10)), speed)
    found = fit_scene(GUESS, noisy, UNKNOWN, starts=1)
    assert found.freedom == 8
    bent = replace(found, profile=None)
    ends = np.log(bent.interval / bent.value[:, None]) * (bent.value / bent.std)[:, None]
    # The table has four digits.
    np.testing.assert_allclose(ends, [[-2.306, 2.306]] * 2, rtol=2e-4)
    vague = replace(bent, std=9.0 * found.value)
    np.testing.assert_allclose(vague.interval / vague.first[:, None], [[0.01, 100.0]] * 2, rtol=1e-12)
    assert fit_scene(GUESS, noisy, UNKNOWN, 1, scale="free").freedom == 7
    # The normal distribution's where the noise is known.
    assert fit_scene(GUESS, noisy, UNKNOWN, 1, noise="10 %").quantile == pytest.approx(1.95996, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["absolute", "relative", "estimate"])
def test_coverage_of_60_trials(kind: str) -> None:
    """The truth lies in its interval in 95 % of 60 sets of noise of each kind, for each of three unknowns.

    Of 60 trials 57 +- sqrt(60 * 0.95 * 0.05) = 1.7 are inside; four of those below. All points weighted
    alike leave 24 of relative noise. `random_fits.py --coverage 400` counts more.
    """
    inside = np.sum([covered(kind, seed) for seed in range(1000, 1060)], axis=0)
    assert (inside >= 50).all(), inside


@pytest.mark.slow
def test_ten_random_fits() -> None:
    """Of ten machines drawn at random none is wrong without a note; `random_fits.py --count` draws more."""
    verdicts = [drawn(seed).verdict for seed in range(10)]
    assert verdicts.count("silent") == 0 and verdicts.count("noted") <= 3, verdicts


@pytest.mark.usefixtures("one_valley")
def test_liquid_added() -> None:
    """What was in the ring before, from amplitudes with more and more liquid, in units of the sensor."""
    scene = lb.example("runup").replace({"speeds.stop": 21.0, "chambers.0.volume": "60 ml"})
    added = np.linspace(0.0, 2e-4, 3)
    (amplitude,) = _answer(scene, "added", added, ["amplitude"])
    exact = lb.run(scene.replace({"chambers.0.volume": "160 ml", "speeds.start": 20.0, "speeds.count": 2}))
    assert amplitude[1] == pytest.approx(exact.amplitude[-1], rel=1e-9)
    guess = scene.replace({"chambers.0.volume": "80 ml"})
    table = Measurement("added", added, (("amplitude", 7.0 * amplitude),))
    found = fit_scene(guess, table, ("chambers.0.volume",), starts=1, scale="each")
    # The search ends where a step changes the sum, or the value, by 1e-8 of it.
    assert found.value[0] == pytest.approx(60e-6, rel=1e-4)
    assert found.scale == pytest.approx(7.0, rel=1e-4)


@pytest.mark.usefixtures("one_valley")
@kills("leblanc.studies.fit.problem:_factor", "own @ value", "own @ own")
def test_a_factor_for_each_quantity() -> None:
    """Two sensors in two units: both factors are found, and angles have none."""
    names, speed = ["amplitude", "liquid_offset", "liquid_angle"], np.linspace(60.0, 180.0, 8)
    parts = _answer(RIG, "speed", speed, names)
    sensors = zip(names, parts, (3.0, 50.0, 1.0), strict=True)
    table = Measurement("speed", speed, tuple((name, factor * part) for name, part, factor in sensors))
    guess = RIG.replace({"rotor.damping_ratio": 0.07})
    found = fit_scene(guess, table, ("rotor.damping_ratio",), starts=1, scale="each")
    assert found.value[0] == pytest.approx(0.1, rel=1e-5)
    (note,) = [note for note in found.notes if note.code == FitCode.SCALE]
    assert note.data["scale"] == pytest.approx({"amplitude": 3.0, "liquid_offset": 50.0}, rel=1e-5)


@kills("leblanc.studies.fit.errors:curvature", "np.square(inverse)", "inverse")
def test_uncertainty_of_a_straight_line() -> None:
    """The textbook's covariance, and nan for what no row of the Jacobian knows."""
    x = np.linspace(0.0, 1.0, 20)
    jacobian = np.stack([np.ones(20), x], axis=1)
    bent = curvature(jacobian / 0.2)
    exact = 0.04 * np.linalg.inv(jacobian.T @ jacobian)
    np.testing.assert_allclose(bent.std, np.sqrt(np.diag(exact)), rtol=1e-12)
    assert bent.correlation[0, 1] == pytest.approx(
        exact[0, 1] / np.sqrt(exact[0, 0] * exact[1, 1]), rel=1e-12
    )
    assert not bent.flat
    blind = curvature(np.stack([np.ones(20), np.zeros(20)], axis=1))
    assert math.isfinite(blind.std[0]) and math.isnan(blind.std[1])
    np.testing.assert_allclose(np.abs(blind.flat[0]), [0.0, 1.0], atol=1e-12)


@kills("leblanc.studies.fit.errors:averaged", "0.5 * min", "2.0 * min")
@kills("leblanc.studies.fit.errors:averaged", " + np.square(other.x - best.x)", "")
def test_two_kinds_of_noise() -> None:
    """Chances of 3 to 1: the variance of a mixture of two normal distributions about the likelier mean."""
    noise, none = Noise("absolute", False, (), ()), (np.ones(1),)
    best, other = (Judged(np.array([x]), noise, none, u, True) for x, u in ((0.0, 4.0), (0.3, 4.0 + LIKELY)))
    mixed = averaged(curvature(np.eye(1) / 0.1), best, curvature(np.eye(1) / 0.2), other)
    random = np.random.default_rng(0)
    trials = np.where(
        random.random(200_000) < 0.25,
        0.3 + 0.2 * random.standard_normal(200_000),
        0.1 * random.standard_normal(200_000),
    )
    # Four standard errors of a mean square of 200 000, whose own scatter is about twice its size.
    assert mixed.std[0] ** 2 == pytest.approx(np.mean(np.square(trials)), rel=0.018)
    assert mixed.unsure is not None and mixed.unsure[0] == pytest.approx(10.0 * mixed.std[0])
    # An error that the other kind tells better is kept.
    assert averaged(curvature(np.eye(1)), best, curvature(np.eye(1) / 0.2), other).std[0] == 1.0


@kills("leblanc.studies.fit.noise:unlikely", " + float(told)", "")
def test_likelihood_of_a_kind() -> None:
    """That of the readings whatever the value: its integral, the value known to a factor of e before."""
    paths, table = ("rotor.stiffness",), measured(0.02, 3)
    problem = Problem(MACHINE, (paths,), TRUTH[:1], table, "given")
    judged = refine(problem, np.zeros(1), ("estimate", 0.0), "absolute")
    residual = problem.weighted(judged.sigma)
    places = judged.x + np.linspace(-0.02, 0.02, 101)[:, None]
    problem.ahead(list(places))
    sums = [float(np.sum(np.square(residual(x)))) for x in places]
    chance = np.exp(-0.5 * np.array(sums)) / math.sqrt(2.0 * math.pi)
    whole = 2.0 * sum(float(np.log(each).sum()) for each in judged.sigma) - 2.0 * math.log(
        float(np.trapezoid(chance, places[:, 0]))
    )
    # The value is reported to 1e-3, over which the answer bends by some per cent at most.
    assert judged.unlikely == pytest.approx(whole, abs=0.05)


@pytest.mark.usefixtures("one_valley")
def test_over_time() -> None:
    """A run-up: the stiffness and the damping of a dry machine from its amplitude over time."""
    scene = lb.example("runup").replace(
        {"chambers.0.volume": 0.0, "runup.duration": "1 s", "runup.samples": 100}
    )
    time = np.linspace(0.2, 1.0, 20)
    (amplitude,) = _answer(scene, "time", time, ["amplitude"])
    paths = tuple(path for path in ("rotor.critical_speed", "rotor.stiffness") if _stands(scene, path))
    guess = scene.replace({paths[0]: 1.05 * _value(scene, paths[0])})
    found = fit_scene(guess, Measurement("time", time, (("amplitude", amplitude),)), paths[:1], starts=1)
    assert found.value[0] == pytest.approx(_value(scene, paths[0]), rel=1e-4)


def _loaded(position: float, angle: float) -> lb.Scene:
    """The tub of the examples, dry, with a second load in its drum."""
    load = {"size": 0.05, "position": position, "angle": angle}
    changes = {"chambers.0.volume": 0.0, "rotor.unbalance": 0.1, "rotor.loads": [load]}
    return lb.example("tub").replace(changes)


@pytest.mark.usefixtures("one_valley")
@kills("leblanc.studies.fit.problem:Problem.values", "np.isnan(spans)", "spans == spans")
@kills("leblanc.studies.fit.study:_answer", "value, problem.spans)", "value, value)")
@kills(
    "leblanc.studies.fit.answer:FitAnswer.interval",
    "self.value - wide, self.value + wide",
    "ends[:, 0], ends[:, 1]",
)
def test_where_a_load_lies() -> None:
    """Position and angle, from a guess of 0 and of the other sign; errors of linear least squares."""
    speed, truth, step = np.linspace(20.0, 90.0, 10), np.array([0.02, 0.1]), 1e-3
    names = ["amplitude", "phase"]
    paths = ("rotor.loads.0.position", "rotor.loads.0.angle")
    amplitude, phase = _answer(_loaded(0.02, 0.1), "speed", speed, names)
    random = np.random.default_rng(5)
    columns = (
        ("amplitude", amplitude * (1.0 + 0.02 * random.standard_normal(10))),
        ("phase", phase + 0.02 * random.standard_normal(10)),
    )
    off = fit_scene(_loaded(0.0, -0.2), Measurement("speed", speed, columns), paths, starts=1)
    slopes = []
    for move in step * np.eye(2):
        size, turn = _answer(_loaded(*(truth + move)), "speed", speed, names)
        slopes.append(np.concatenate([size / amplitude - 1.0, np.angle(np.exp(1j * (turn - phase)))]) / step)
    exact = 0.02 * np.sqrt(np.diag(np.linalg.inv(np.array(slopes) @ np.array(slopes).T)))
    # A chance of 1e-4 each that a normal variable is further off; the noise of each quantity is known from
    # ten values, to 1 over the root of 20: three of those.
    assert np.all(np.abs(off.value - truth) < 4.0 * off.std)
    np.testing.assert_allclose(off.std, exact, rtol=0.67)
    assert off.signed == paths
    middle = off.interval.mean(axis=1)
    np.testing.assert_allclose(middle, off.value, rtol=1e-12)
    # Student's t of the table for 18 degrees of freedom.
    np.testing.assert_allclose(np.diff(off.interval, axis=1)[:, 0], 2.0 * 2.101 * off.std, rtol=3e-4)


@pytest.mark.slow
def test_water_that_leaves_a_load() -> None:
    """Share and time constant of what laundry sheds, from the amplitude over a programme with noise."""
    steps = ["to 900 rpm at 120 rpm/s", "hold 8 s"]
    changes = {"chambers.0.volume": 0.0, "programme": {"start": "60 rpm", "steps": steps, "cells": 16}}
    sheds = {"share": 0.4, "time_constant": "3 s", "above": "300 rpm"}
    scene = lb.example("tub").altered(runup=None).replace(changes | {"rotor.sheds": sheds})
    time = np.linspace(1.0, 14.5, 80)
    (amplitude,) = _answer(scene, "time", time, ["amplitude"])
    noisy = amplitude * (1.0 + 0.01 * np.random.default_rng(0).standard_normal(80))
    guess = scene.replace({"rotor.sheds.share": 0.3, "rotor.sheds.time_constant": 4.0})
    paths = ("rotor.sheds.share", "rotor.sheds.time_constant")
    found = fit_scene(guess, Measurement("time", time, (("amplitude", noisy),)), paths, starts=1)
    # A chance of 1e-4 each that a normal variable is further off.
    assert np.all(np.abs(found.value - [0.4, 3.0]) < 4.0 * found.std)
    assert np.all(found.std < [0.004, 0.1])


@pytest.mark.usefixtures("one_valley")
def test_measured_angles_of_a_rig() -> None:
    """The rig's six angles: what a least squares of its own finds."""
    angles = read_measured(Path("docs/examples/rig_angles.csv"), ("x", "y"))
    found = fit_scene(RIG, angles, ("rotor.damping_ratio", "rotor.critical_speed"), starts=1)
    seen = data("dr18_fig24.json")
    speed = np.array(seen["speed_rpm"]) * math.pi / 30.0
    np.testing.assert_allclose(angles.at, speed)
    wet, _ = _fit(
        lambda x: _liquid_angle(speed, x[0], x[1] * 1000.0 * math.pi / 30.0),
        np.array(seen["angle_deg"], dtype=float),
        [0.1, 1.0],
    )
    # There the liquid's added mass counts as the rotor's; the square of the speed goes as 1 over the mass.
    heavier = math.sqrt(1.0 + sum(fill.full_mass for fill in horizontal_rig()) / 4.0)
    dry = wet * heavier * np.array([1.0, 1000.0 * math.pi / 30.0])
    np.testing.assert_allclose(found.value, dry, rtol=1e-3)
    # Four values more than unknowns scatter as noise does; that 0.19 rad is much for noise is said.
    assert found.accepted and np.isfinite(found.std).all()
    assert [note.code for note in found.notes] == [FitCode.LARGE]


@pytest.mark.usefixtures("one_valley")
@kills("leblanc.studies.fit.study:_is_near", "[told]", "")
def test_an_unknown_that_nothing_tells() -> None:
    """An empty chamber's radius: not reported; searches that differ in it alone are no other answer."""
    chamber = {"radius": 0.1, "height": 0.05, "volume": 0.0, "liquid": "water"}
    scene = scene_from_table({**DRY, "chambers": [chamber], "model": {"liquid": "linear"}})
    found = fit_scene(scene, measured(0.02, 2), ("rotor.stiffness", "chambers.0.radius"), starts=3)
    assert abs(found.value[0] - TRUTH[0]) < 4.0 * found.std[0]
    assert math.isnan(found.std[1])
    assert {note.code for note in found.notes} == {FitCode.NOT_TOLD}


@pytest.mark.usefixtures("one_valley")
def test_too_few_values_to_judge() -> None:
    """Three values more than unknowns do not show whether a few per cent are noise; stated noise does."""
    speed = np.array([15.0, 22.0, 26.0, 32.0, 45.0])
    (amplitude,) = _answer(MACHINE, "speed", speed, ["amplitude"])
    table = over_speed(amplitude * (1.0 + 0.03 * np.array([1.0, -1.0, -0.5, 1.0, -1.0])), speed)
    found = fit_scene(GUESS, table, UNKNOWN, starts=1)
    assert found.freedom == 3 and not found.accepted and np.isnan(found.std).all()
    assert FitCode.FEW in {note.code for note in found.notes}
    assert fit_scene(GUESS, table, UNKNOWN, starts=1, noise="3 %").accepted
    exact = fit_scene(GUESS, over_speed(amplitude, speed), UNKNOWN, starts=1)
    assert exact.accepted
    np.testing.assert_allclose(exact.value, TRUTH, rtol=1e-5)


@kills("leblanc.studies.fit.noise:alike_by_chance", "trace / freedom,", "-trace / freedom,")
@kills("leblanc.studies.fit.noise:alike_by_chance", "both - trace**2", "both + trace**2")
@kills("leblanc.studies.fit.noise:alike_by_chance", "- 2.0 * float", "- float")
def test_how_alike_neighbours_are_by_chance() -> None:
    """Mean and variance of the neighbours' correlation: traces of the written-out matrices, and trials."""
    random = np.random.default_rng(0)
    basis, _ = np.linalg.qr(random.standard_normal((16, 3)))
    mean, variance = alike_by_chance(basis, 8)
    beside = np.kron(np.eye(2), 0.5 * (np.eye(8, k=1) + np.eye(8, k=-1)))
    left = np.eye(16) - basis @ basis.T
    product = left @ beside
    trace = float(np.trace(product))
    assert mean == pytest.approx(trace / 13, rel=1e-12)
    exact = 2.0 * (13 * np.trace(product @ product) - trace**2) / (13**2 * 15)
    assert variance == pytest.approx(exact, rel=1e-12)
    trials = random.standard_normal((20_000, 16)) @ left
    ratio = np.einsum("ij,jk,ik->i", trials, beside, trials) / np.sum(np.square(trials), axis=1)
    # Four standard errors of a mean, and of a variance, of 20 000.
    assert abs(ratio.mean() - mean) < 4.0 * math.sqrt(variance / 20_000)
    assert ratio.var() == pytest.approx(variance, rel=4.0 * math.sqrt(2.0 / 20_000))


@pytest.mark.usefixtures("one_valley")
def test_a_wrong_scene_is_not_accepted() -> None:
    """Damping that the search may not touch is wrong by a half: a few per cent are left, and are no noise."""
    wrong = MACHINE.replace({"rotor.damping": 110.0})
    table = measured(0.005, 4)
    paths = ("rotor.stiffness", "rotor.unbalance")
    found = fit_scene(wrong, table, paths, starts=1)
    assert 0.02 < found.residual_rms < 0.2  # far below what no sensor has
    assert not found.accepted and np.isnan(found.std).all()
    assert FitCode.POOR in {note.code for note in found.notes}
    size = 0.005 * found.measured[0].value.std() * 1e3
    assert not fit_scene(wrong, table, paths, starts=1, noise=f"{size} mm").accepted
    assert fit_scene(wrong, table, (*paths, "rotor.damping"), starts=1).accepted


@pytest.mark.usefixtures("one_valley")
def test_rows_that_repeat_tell_their_noise() -> None:
    """Readings that repeat to 0.1 % and lie 10 % off the scene, up and down as noise would."""
    speed = np.repeat(np.linspace(15.0, 45.0, 8), 2)
    (amplitude,) = _answer(MACHINE, "speed", speed, ["amplitude"])
    off = np.repeat([0.1, -0.05, -0.1, 0.1, 0.05, -0.1, -0.05, 0.1], 2)
    twin = 1.0 + off + 1e-3 * np.random.default_rng(0).standard_normal(16)
    found = fit_scene(MACHINE, over_speed(amplitude * twin, speed), UNKNOWN, starts=1)
    (note,) = [note for note in found.notes if note.code == FitCode.POOR]
    assert not found.accepted and "repeat" in note.text


@pytest.mark.usefixtures("one_valley")
@kills("leblanc.studies.fit.noise:unexplained", "rms > POOR and", "0 and")
@kills("leblanc.studies.fit.noise:unexplained", "and _replicates(problem) <= _FEW", "")
def test_noise_of_a_half() -> None:
    """A resonance in the wrong place passes for it: it must be stated, or shown by rows that repeat."""
    speed = np.linspace(12.0, 55.0, 7)
    (amplitude,) = _answer(
        MACHINE.replace({"rotor.stiffness": 2.2 * TRUTH[0]}), "speed", speed, ["amplitude"]
    )
    wrong = over_speed(amplitude * (1.0 + 0.02 * np.random.default_rng(0).standard_normal(7)), speed)
    found = fit_scene(MACHINE, wrong, ("rotor.damping", "rotor.unbalance"), starts=1)
    assert found.residual_rms > 0.3 and not found.accepted
    each = np.repeat(SPEED[::5], 4)
    (amplitude,) = _answer(MACHINE, "speed", each, ["amplitude"])
    size = 0.4 * math.sqrt(float(np.mean(np.square(amplitude))))
    noisy = np.abs(amplitude + size * np.random.default_rng(0).standard_normal(24))
    shown = fit_scene(MACHINE, over_speed(noisy, each), UNKNOWN[:1], starts=1)
    assert shown.residual_rms > 0.3 and shown.accepted
    # The same readings at speeds that do not repeat.
    apart = over_speed(noisy, each * (1.0 + 1e-6 * np.arange(24)))
    assert not fit_scene(MACHINE, apart, UNKNOWN[:1], starts=1).accepted
    assert fit_scene(MACHINE, apart, UNKNOWN[:1], starts=1, noise=f"{1e3 * size} mm").accepted


def test_a_plateau_has_one_end() -> None:
    """More liquid than keeps the wall wet does nothing: the data bound the volume from below alone.

    The wall falls dry where the deflection e reaches the layer's thickness: V = pi h (R^2 - (R - e)^2).
    """
    table = RIG.table()
    table.pop("assumed")
    machine = table | {"chambers": table["chambers"][:1], "model": {"liquid": "statics"}}
    scene, speed = scene_from_table(machine), np.linspace(80.0, 140.0, 8)
    (amplitude,) = _answer(scene, "speed", speed, ["amplitude"])
    radius, height, most = 0.065, 0.02, float(amplitude.max())
    edge = math.pi * height * (radius**2 - (radius - most) ** 2)
    found = fit_scene(scene, over_speed(amplitude, speed), ("chambers.0.volume",), starts=1)
    (note,) = [note for note in found.notes if note.code == FitCode.PLATEAU]
    # Just below the edge the answer changes as the power 3/2 of the distance: 1e-6 of it at 2e-3.
    assert note.data["edge"] == pytest.approx(edge, rel=5e-3)
    assert found.interval[0, 0] == note.data["edge"]
    assert math.isnan(found.std[0]) and found.accepted


@kills("leblanc.studies.fit.search:search", "enough and _again(problem, found) > 1", "True or enough")
def test_a_guess_in_the_wrong_valley() -> None:
    """Two modes, guesses three times off: a first search ends at 4 % where the truth leaves half of that."""
    speed, random = np.linspace(43.0, 143.0, 10), np.random.default_rng(0)
    (amplitude,) = _answer(_two_modes(), "speed", speed, ["amplitude"])
    table = over_speed(amplitude * (1.0 + 0.01 * random.standard_normal(10)), speed)
    truth = {
        "rotor.unbalances.0.size": 1.757e-3,
        "rotor.transverse_inertia": 1.631,
        "rotor.supports.0.damping": 600.0,
    }
    off = dict(zip(truth, (2.8 * 1.757e-3, 4.0 * 1.631, 8.3 * 600.0), strict=True))
    found = fit_scene(_two_modes().replace(off), table, tuple(truth), starts=1)
    assert found.accepted
    # A chance of 1e-4 each that a normal variable is further off.
    assert np.all(np.abs(found.value - list(truth.values())) < 4.0 * found.std)
    assert np.all(found.std < 0.05 * found.value)


@kills("leblanc.studies.fit.problem:Problem.with_values", "for path in group", "for path in group[:1]")
def test_tied_supports() -> None:
    """Two springs that are alike are one unknown."""
    alike = ("rotor.supports.0.stiffness", "rotor.supports.1.stiffness")
    speed = np.linspace(43.0, 143.0, 8)
    even = dict.fromkeys(alike, 2e5)
    (amplitude,) = _answer(_two_modes().replace(even), "speed", speed, ["amplitude"])
    guess = _two_modes().replace(dict(zip(alike, (1e5, 4e5), strict=True)))
    found = fit_scene(guess, over_speed(amplitude, speed), ("=".join(alike),), starts=1)
    assert found.value[0] == pytest.approx(2e5, rel=1e-5)
    assert found.unknown == alike[:1] and found.tied == (alike[1:],)
    for wrong in ("rotor.mass=rotor.mass", "rotor.mass=rotor.masse", "=rotor.mass"):
        with pytest.raises(InputError):
            fit_scene(guess, over_speed(amplitude, speed), (wrong,))


def _two_modes() -> lb.Scene:
    """A dry rotor on two supports, both of whose modes lie within 43 to 143 rad/s."""
    supports = [
        {"position": -0.2, "stiffness": 1.673e5, "damping": 600.0},
        {"position": 0.25, "stiffness": 2.509e5, "damping": 600.0},
    ]
    rotor = {
        "kind": "two_plane",
        "mass": 81.5,
        "transverse_inertia": 1.631,
        "polar_inertia": 0.815,
        "axis": "horizontal",
        "supports": supports,
        "unbalances": [{"position": 0.05, "size": 1.757e-3, "angle": 0.4}],
    }
    return scene_from_table({"name": "two modes", "rotor": rotor, "speeds": DRY["speeds"]})


@pytest.mark.usefixtures("one_valley")
def test_data_that_the_scene_cannot_meet() -> None:
    """A curve that rises and falls without sense is not met, and the answer says so."""
    found = fit_scene(MACHINE, over_speed(1e-3 * (1.0 + np.arange(30) % 2 * 4.0)), UNKNOWN[:1], starts=1)
    assert found.residual_rms > 0.3 and FitCode.POOR in {note.code for note in found.notes}
    assert not found.accepted


def _value(scene: lb.Scene, path: str) -> float:
    table = scene.table()
    for key in path.split("."):
        table = table[key]
    return float(table)  # type: ignore[arg-type]


def _stands(scene: lb.Scene, path: str) -> bool:
    try:
        _value(scene, path)
    except (KeyError, TypeError):
        return False
    return True


SCENE = """name = "Dry"
[rotor]
kind = "jeffcott"
mass = "30 kg"
stiffness = "15 N/mm"
damping = "90 N*s/m"
unbalance = "4 kg*mm"
axis = "vertical"
[speeds]
start = "80 rpm"
stop = "900 rpm"
count = 5
"""


def _size(data: Measurement) -> float:
    """One per cent of the size of a measurement, mm."""
    return 10.0 * float(np.sqrt(np.mean(np.square(data.columns[0][1]))))


def table(folder: Path, text: str) -> Path:
    (folder / "m.csv").write_text(text, encoding="utf-8")
    return folder / "m.csv"


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """JSON keys that scripts rely on, files, units of the scene, and wrong inputs in one line each."""
    scene = str(tmp_path / "dry.toml")
    Path(scene).write_text(SCENE, encoding="utf-8")
    data = measured(0.01, 0)
    lines = [f"{s * 30 / math.pi};{a * 2e6}" for s, a in zip(SPEED, data.columns[0][1], strict=True)]
    path = str(table(tmp_path, "Drehzahl [rpm];Schwingweg [um pp]\n" + "\n".join(lines)))
    out = tmp_path / "out"
    words = ["fit", scene, path, "--starts", "1", "--out", str(out), "--column", "speed=Drehzahl [rpm]"]
    asked = [*words, "--column", "amplitude=Schwingweg [um pp]", "--noise", f"{_size(data)} mm"]
    assert main([*asked, "--unknown", UNKNOWN[0], "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found["parameters"][UNKNOWN[0]]) == {"value", "std"}
    assert {"residual_rms", "correlation", "accepted"} <= found.keys()
    assert found["accepted"] is True and found["noise"] == "absolute"
    assert found["parameters"][UNKNOWN[0]]["value"] == pytest.approx(TRUTH[0], rel=0.01)
    assert {"fit.nc", "fit.svg"} <= {file.name for file in out.iterdir()}
    for unknown in ("rotor.masse", "name", "rotor"):
        assert main([*asked, "--unknown", unknown]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    for wrong in (["--noise", "3 kg"], ["--column", "amplitude"], ["--column", "amplitude=Weg"]):
        assert main([*words, "--unknown", UNKNOWN[0], *wrong]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    assert main([*asked, "--unknown", UNKNOWN[0]]) == 0
    shown = capsys.readouterr().out
    # 18 750 N/m in the unit of the file, and the conversion said.
    assert "N/mm" in shown and "18.7" in shown and "peak to peak" in shown


@pytest.mark.usefixtures("one_valley")
def test_the_fitted_curve() -> None:
    """A curve between the points with its peak: of the dry machine u w^2/(k |1 - r^2 + 2 i d r|)."""
    found = fit_scene(GUESS, measured(0.0, 0), UNKNOWN, starts=1)
    assert found.curve is not None
    speed = found.curve.at
    stiffness, damping = TRUTH
    exact = 0.004 * speed**2 / np.abs(stiffness - 30.0 * speed**2 + 1j * damping * speed)
    # The search ends within 1e-5 of the values.
    np.testing.assert_allclose(found.curve.values[0], exact, rtol=1e-4)
    assert found.curve.values[0].max() > 1.02 * found.measured[0].value.max()
    assert set(found.at) <= set(speed)
