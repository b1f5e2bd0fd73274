"""Run-ups as one array program beside those of the compiled steps."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.runup.ensemble import EnsembleTask
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Motor, Ramp
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from tests.mutants import kills

jax = pytest.importorskip("jax", reason="jax is not installed (extra gpu)")
from solvers.runup import arrays  # noqa: E402
from solvers.runup.arrays import ArrayRun, runups  # noqa: E402

WATER = Liquid("water", 1000.0, 1e-6)
ROTOR = Jeffcott(30.0, 30.0 * 25.0**2, 2.0 * 0.06 * 30.0 * 25.0, 0.1)
CHAMBER = Chamber(0.25, 0.04)
PASSAGE = Ramp(20.0, 35.0, 12.0, 1.4)  # of the resonance
LANES = arrays.GROUP


def task(number: int, law: str = "linear", samples: int = 40, **changes: Any) -> EnsembleTask:
    """One of many machines: volume, unbalance, damping, friction and ramp go with its number."""
    draw = np.random.default_rng([5, number]).uniform(0.8, 1.2, 5)
    rotor = Jeffcott(30.0, 30.0 * 25.0**2, ROTOR.damping * draw[0], 0.05 * draw[1])
    rate = {"linear": 0.5 * draw[2], "quadratic": 0.02}.get(law, 0.0)
    found = EnsembleTask(
        rotor.system(),
        (Fill(CHAMBER, WATER, 5e-4 * draw[3]),),
        replace(PASSAGE, rate=12.0 * draw[4]),
        Friction(law, rate),  # type: ignore[arg-type]
        0.0,
        RunupNumerics(cells=24, samples=samples, companion=False),
        couple,
    )
    return replace(found, **changes)


@cache
def compiled(number: int, law: str, samples: int) -> RunupHistory:
    return stepped(task(number, law, samples))


def stepped(asked: EnsembleTask) -> RunupHistory:
    return run_up(asked.system, asked.fills, asked.drive, asked.friction, 0.0, asked.numerics)


def missed(run: ArrayRun, history: RunupHistory) -> float:
    """Largest difference of a run to that of the compiled steps, over the largest deflection or depth."""
    assert (run.outcome, run.reason) == (history.outcome, history.reason)
    np.testing.assert_array_equal(run.time, history.time)
    # Multiples of the steps' rounding.
    np.testing.assert_allclose(run.speed, history.speed, rtol=1e-12)
    peak, wave = history.largest.max(), history.depth_max.max()
    apart = [np.abs(getattr(run, name) - getattr(history, name)).max() for name in ("deflection", "largest")]
    deep = [np.abs(getattr(run, name) - getattr(history, name)).max() for name in ("depth_min", "depth_max")]
    return float(max(*(each / peak for each in apart), *(each / wave for each in deep)))


def same(one: ArrayRun, other: ArrayRun) -> bool:
    """Whether two runs have the same digits."""
    names = "time", "deflection", "largest", "largest_speed", "largest_time", "depth_min", "depth_max"
    arrays_ = all(np.array_equal(getattr(one, name), getattr(other, name)) for name in names)
    return arrays_ and (one.steps, one.outcome) == (other.steps, other.outcome)


# Samples so close that each is reached in one step: both take the same steps.
FINE = 1600


@pytest.mark.parametrize("law", ["linear", "wall"])
def test_batch_beside_the_compiled_steps(law: str) -> None:
    """As the compiled steps: with the same steps to 1e-9 of the peak, with steps of their own to 1e-6."""
    asked = [task(0, law, FINE), *(task(number, law) for number in range(5))]
    fine, *others = runups(asked, LANES)
    history = compiled(0, law, FINE)
    assert fine.steps == history.steps == fine.time.size - 1
    # Some hundred steps of rounding 1e-16 in a motion that forgets its past; 1e-9 is what is promised.
    assert missed(fine, history) < 1e-9
    for number, run in enumerate(others):
        assert missed(run, compiled(number, law, 40)) < 1e-6
        assert run.converged and np.isfinite(run.amplitude).all()


def test_an_answer_does_not_depend_on_its_companions() -> None:
    """Alone, among others, in another order, in lanes that others have left: the same digits."""
    asked = [task(number) for number in range(LANES + 3)]
    together = runups(asked, LANES)
    order = np.random.default_rng(1).permutation(len(asked)).tolist()
    shuffled = runups([asked[number] for number in order], LANES)
    assert all(same(together[number], run) for number, run in zip(order, shuffled, strict=True))
    for number in (0, LANES + 2):
        assert same(together[number], runups([asked[number]], LANES)[0])


def overloaded(share: float, unbalance: float) -> EnsembleTask:
    """A machine whose liquid, so much of its chamber, piles up towards the axis."""
    rotor = Jeffcott(30.0, 30.0 * 25.0**2, 20.0, unbalance)
    return task(0, system=rotor.system(), fills=(Fill(CHAMBER, WATER, share * CHAMBER.capacity),))


def test_a_lane_that_fails_says_so_and_hurts_no_other() -> None:
    asked = [task(1), overloaded(0.7, 2.0), task(2), overloaded(0.9, 0.5), task(3)]
    runs = runups(asked, LANES)
    for one, number in zip(runs[::2], (1, 2, 3), strict=True):
        assert same(one, runups([task(number)], LANES)[0])
    for one, other in zip(runs[1::2], asked[1::2], strict=True):
        history = stepped(other)
        assert one.outcome is history.outcome is Outcome.AT_AXIS
        assert "towards the axis" in one.reason and not one.converged
        assert one.time.size == history.time.size < 40
        assert np.isfinite(one.deflection).all() and np.isfinite(one.depth_max).all()


def test_numbers_that_overflow_end_a_lane() -> None:
    system = task(0).system
    huge = replace(system, unbalance=system.unbalance * 1e160)
    lost, other = runups([task(0, system=huge), task(1)], LANES)
    assert not lost.converged and lost.reason and lost.time.size == 1
    assert np.isfinite(lost.largest).all() and np.isfinite(lost.deflection).all()
    assert same(other, runups([task(1)], LANES)[0])


def test_an_interrupt_keeps_what_was_reached(monkeypatch: pytest.MonkeyPatch) -> None:
    whole, rounds, calls = runups([task(0)], LANES)[0], arrays._rounds, []

    def interrupted(*given: Any) -> Any:
        calls.append(given)
        if len(calls) > 1:
            raise KeyboardInterrupt
        return rounds(*given[:3], 400)

    monkeypatch.setattr(arrays, "_rounds", interrupted)
    runs = runups([task(number) for number in range(LANES + 1)], LANES)
    assert all(run.outcome is Outcome.INTERRUPTED for run in runs)
    reached = runs[0].time.size
    assert 1 < reached < whole.time.size
    np.testing.assert_array_equal(runs[0].deflection, whole.deflection[:reached])
    assert runs[-1].time.size == 1  # never seated


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"drive": Motor(20.0, 1.0, (0.0, 50.0), (1.0, 1.0), 1.0)}, "tasks.1.drive"),
        ({"model": couple_linear}, "tasks.1.model"),
        ({"numerics": RunupNumerics(cells=24, dispersion=True)}, "tasks.1.dispersion"),
        ({"numerics": RunupNumerics(cells=24, enstrophy=True)}, "tasks.1.enstrophy"),
        ({"numerics": RunupNumerics(cells=32, samples=40)}, "tasks.1"),
        ({"friction": Friction("quadratic", 0.02)}, "tasks.1"),
        ({"gravity": 9.81}, "tasks.1.fills"),
        ({"fills": ()}, "tasks.1.fills"),
        ({"fills": (Fill(replace(CHAMBER, baffles=Baffles(4, 0.02)), WATER, 5e-4),)}, "tasks.1.fills"),
    ],
)
def test_other_machines_are_refused(changes: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as refused:
        runups([task(0), task(1, **changes)], LANES)
    assert refused.value.field == field


@pytest.mark.parametrize("lanes", [0, -32, 8])
def test_lanes_come_in_groups(lanes: int) -> None:
    with pytest.raises(InputError, match="lanes"):
        runups([task(0)], lanes)


def test_no_machines() -> None:
    assert runups([]) == []


# --- line by line: by numpy, where seeded faults show ---

PLANES = TwoPlane(
    10.0, 0.5, 0.3,
    (Support(0.3, 2e4, 40.0), Support(-0.2, 1e4, 60.0)),
    (PlaneUnbalance(0.2, 4e-2, 0.4), PlaneUnbalance(-0.2, 2e-2, 2.5)),
)  # fmt: skip


class Written:
    """An array that is written into as jax writes into its own."""

    def __init__(self, values: np.ndarray) -> None:
        self.values = values

    @property
    def at(self) -> Written:
        return self

    def __getitem__(self, where: tuple[Any, ...]) -> Written:
        self.where = where
        return self

    def set(self, rows: np.ndarray, mode: str) -> Written:
        steps, _, lanes = self.where
        for row, step, lane in zip(rows, steps, lanes, strict=True):
            if step < len(self.values):
                self.values[step, :, lane] = row
        return self


def by_numpy(given: arrays.Given, now: arrays.Now, law: int, most: int) -> tuple[arrays.Now, int]:
    kept, made = Written(now.moments), 0
    now = now._replace(moments=kept)
    with np.errstate(all="ignore"):
        while made < most and (now.status == -1).any():
            now, made = arrays.round_of(given, now, law), made + 1
    return now._replace(moments=kept.values), made


@pytest.fixture
def lines(monkeypatch: pytest.MonkeyPatch) -> None:
    """The program's lines one by one, by numpy, for a single lane."""
    monkeypatch.setattr(arrays, "jnp", np)
    monkeypatch.setattr(arrays, "lax", SimpleNamespace(optimization_barrier=lambda values: values))
    monkeypatch.setattr(arrays, "_rounds", by_numpy)
    monkeypatch.setattr(arrays, "GROUP", 1)


def two_rings(law: str, rate: float, first: float) -> EnsembleTask:
    """Two rings on a rotor that tilts: the first runs dry on a side, the second fills its gap."""
    fills = (
        Fill(Chamber(0.2, 0.03, plane=0.1), Liquid("oil", 900.0, 1e-3), first),
        Fill(Chamber(0.22, 0.04, 0.215, plane=-0.05), WATER, 1.6e-4),
    )
    numerics = RunupNumerics(cells=12, samples=60, companion=False)
    ramp, friction = Ramp(45.0, 55.0, 100.0, 0.25), Friction(law, rate)  # type: ignore[arg-type]
    return EnsembleTask(PLANES.system(), fills, ramp, friction, 0.0, numerics, couple)


@cache
def reference(law: str, rate: float, first: float) -> RunupHistory:
    return stepped(two_rings(law, rate, first))


@kills("solvers.runup.arrays:profile", "2.0 * (q + spin * square)", "2.0 * (q - spin * square)")
@kills("solvers.runup.arrays:_half_slope", "0.25 * abs", "0.5 * abs")
@kills("solvers.runup.arrays:half_slopes", "(least > full)", "(least > DRY)")
@kills("solvers.runup.arrays:half_slopes", "velocity_1 - behind * head_1", "velocity_1 + behind * head_1")
@kills("solvers.runup.arrays:side", "4.0 * quick", "quick")
@kills("solvers.runup.arrays:side", "jnp.where(level < rim, beyond, level)", "level")
@kills("solvers.runup.arrays:rates", "1.5 * back_r - 0.5 * ahead_r", "back_r")
@kills("solvers.runup.arrays:rates", "PRESSED, 1.0", "1.0, 1.0")
@kills("solvers.runup.arrays:rates", "-euler * area", "euler * area")
@kills("solvers.runup.arrays:rub", "abs(velocity) / (rest * top)", "abs(velocity) / top")
@kills("solvers.runup.arrays:rub", "kept * (1.0 - gone), gone * mean", "kept * (1.0 - gone), 0.0")
@kills("solvers.runup.arrays:layer_step", "0.5 * (begin + q_2)", "0.5 * (q + q_2)")
@kills("solvers.runup.arrays:layer_step", "jnp.maximum(speed_1, speed_2), speed_1", "speed_1, speed_1")
@kills("solvers.runup.arrays:measure", "share * x * y", "0.0 * x")
@kills("solvers.runup.arrays:_relative", "measures[2] - spin", "measures[2] + spin")
@kills("solvers.runup.arrays:change_of", "0.25 * dt * dt * stiffness", "0.0 * stiffness")
@kills("solvers.runup.arrays:change_of", "0.5 * (spins[0] + spins[1]) * gyroscopic", "0.0")
@kills("solvers.runup.arrays:expected", "-linear - bend - curve", "-linear - bend")
@kills("solvers.runup.arrays:round_of", "0.5 * now.share", "0.25 * now.share")
@pytest.mark.parametrize(
    ("law", "rate", "first"),
    [
        ("wall", 0.0, 1.5e-5),
        ("linear", 2.0, 3e-5),
        ("quadratic", 0.05, 3e-5),
        ("stokes", 0.0, 2.6e-5),
    ],
)
def test_line_by_line(law: str, rate: float, first: float, lines: None) -> None:
    """The lines of the program beside the compiled steps: films, full gaps, steps taken again."""
    run, history = runups([two_rings(law, rate, first)], 1)[0], reference(law, rate, first)
    assert run.steps == history.steps > 60  # some were shortened
    # Full gaps are stiff: rounding of 1e-16 grows there to some 1e-11. With these fills it decides no round.
    assert missed(run, history) < 1e-9


@kills("solvers.runup.arrays:rates", "wide[2:-2] / lost, 1.0", "1.0, 1.0")
@kills("solvers.runup.arrays:rates", "1.5 * ahead_l - 0.5 * back_l", "ahead_l")
@kills("solvers.runup.arrays:rub", "area > DRY", "area > THIN")
def test_a_wall_that_runs_dry_line_by_line(lines: None) -> None:
    run, history = runups([two_rings("none", 0.0, 1e-5)], 1)[0], reference("none", 0.0, 1e-5)
    assert history.depth_min[:, 0].min() < 1e-13
    assert missed(run, history) < 1e-9


@kills("solvers.runup.arrays:round_of", "jnp.clip(relaxed, -1.0, 1.0)", "1.0")
@kills("solvers.runup.arrays:round_of", "-now.relaxed * (now.miss", "now.relaxed * (now.miss")
def test_a_rotor_lighter_than_its_liquid_line_by_line(lines: None) -> None:
    """Six rounds a step, of which the later ones relax the guess."""
    rotor = Jeffcott(0.3, 560.0, 20.0, 0.02)
    asked = task(0, system=rotor.system(), fills=(Fill(CHAMBER, WATER, 0.5 * CHAMBER.capacity),))
    run, history = runups([asked], 1)[0], stepped(asked)
    assert history.layer_steps > 5 * history.steps
    assert missed(run, history) < 1e-9
