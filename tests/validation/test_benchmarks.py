"""The harness of the benchmarks with made-up contestants; our errors fall with resolution."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tests.mutants import kills
from validation.benchmarks import growth, leblanc_codes, report, timing
from validation.benchmarks import leblanc_codes as layers
from validation.benchmarks import report as table
from validation.benchmarks.__main__ import PEERS
from validation.benchmarks.growth import Growth
from validation.benchmarks.peers import pypde as peer_pypde
from validation.benchmarks.problems import (
    WANTED,
    distance,
    retrograde,
    spectrum,
    steady_problem,
    travelling_problem,
)
from validation.benchmarks.report import Section
from validation.benchmarks.timing import Contestant, Go, Sample


def sample(code: str, seconds: float, error: float, setting: str = "any") -> Sample:
    return Sample(code, setting, 0, seconds, error, 0.0, 1)


def contestant(code: str, values: list[float], log: list[str]) -> Contestant:
    """One that hands out its values run by run and notes when it is built, set back and run."""
    left = iter(values)

    def prepare():  # type: ignore[no-untyped-def]
        log.append(f"{code} built")

        def fresh() -> Go:
            log.append(f"{code} set back")

            def go() -> np.ndarray:
                log.append(code)
                return np.array([next(left)])

            return go

        return fresh

    return Contestant(code, "any", prepare)


def test_runs_take_turns_and_each_starts_afresh() -> None:
    log: list[str] = []
    pair = [contestant("a", [0.5, 0.5, 0.5], log), contestant("b", [0.25] * 3, log)]
    found = timing.measure(pair, lambda answer: float(answer[0].real), repeats=2)
    assert [s.error for s in found] == [0.5, 0.25] and [s.repeats for s in found] == [2, 2]
    assert all(s.seconds > 0.0 and not s.note for s in found)
    runs = [entry for entry in log if entry in "ab"]
    assert runs == ["a", "b"] * 3
    assert log.count("a built") == 1 and log.count("a set back") == 3


def test_who_breaks_down_is_reported() -> None:
    def broken() -> None:
        raise RuntimeError("no convergence\nat all")

    log: list[str] = []
    pair = [Contestant("x", "any", broken), contestant("y", [math.nan], log)]  # type: ignore[arg-type]
    found = timing.measure(pair, lambda answer: float(answer[0].real))
    assert [s.note for s in found] == ["no convergence", "diverged"]
    assert all(math.isnan(s.seconds) and s.repeats == 0 for s in found)
    text = table.markdown(Section("s", "Title", "error", tuple(found), ("z",), 1e-3), "x")
    assert "| x | any | no convergence |" in text and "| z | not installed |" in text
    assert "no answer of x" in text


def test_table_compares_at_the_target() -> None:
    samples = (
        sample("ours", 2e-3, 1e-5, "fine"),
        sample("ours", 1e-3, 1e-2, "coarse"),
        sample("other", 0.5, 1e-4),
        sample("third", 1e-6, 0.1),
    )
    text = table.markdown(Section("s", "Title", "error", samples, (), 1e-4), "ours")
    assert "ours 2 ms (fine)" in text and "250 times" in text and "third does not get there" in text
    assert [table.duration(t) for t in (2.5, 0.0123, 4.56e-5, 1e-9)] == [
        "2.5 s",
        "12.3 ms",
        "45.6 us",
        "0.001 us",
    ]


def test_ratio_at_equal_error_is_taken_between_the_samples() -> None:
    mine = [sample("ours", 1.0, 1e-2), sample("ours", 100.0, 1e-4)]
    theirs = [sample("other", 30.0, 1e-3), sample("other", 1.0, 0.1), sample("other", 50.0, 1e-4)]
    # Beaten in both, and one without an answer: neither counts.
    mine.append(sample("ours", 150.0, 1e-3))
    theirs.append(sample("other", math.nan, math.nan))
    # A straight line in the logarithms: ours needs 10 s for 1e-3.
    assert table.at_equal_error(mine, theirs) == [(1e-3, pytest.approx(3.0)), (1e-4, pytest.approx(0.5))]


def test_growth_table_leaves_out_what_was_not_run() -> None:
    text = table.growth_markdown([Growth("a", "cells", [1, 2], [0.1, 0.2]), Growth("b", "cells", [2], [3.0])])
    assert "| 1 | 100 ms |  |" in text and "| 2 | 200 ms | 3 s |" in text


def test_a_peer_that_is_not_there_is_said_to_be_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(report, "version", lambda _: None)
    short = lambda *_: Section("s", "t", "e", (), (), 1.0)  # noqa: E731
    named: dict[str, list[str]] = {}

    def kept(here, missing, *_, **__):  # type: ignore[no-untyped-def]
        named["missing"] = [module.CODE for module in missing]
        assert not here
        return short()

    monkeypatch.setattr(report, "_wave", kept)
    monkeypatch.setattr(report, "_layers", lambda *_: ([short()], []))
    for name in ("over_cells", "over_speeds"):
        monkeypatch.setattr(report.growth, name, lambda _: [])
    monkeypatch.setattr(report.growth, "curve_time", lambda: (0.0, True))
    monkeypatch.setattr(report.growth, "first_calls", dict)
    results = report.collect(PEERS, True, 1)
    assert [results.versions[code] for code in named["missing"]] == ["not installed"] * len(PEERS)


def test_what_is_written(tmp_path: Path) -> None:
    steady = Section(
        "one", "A wave", "error", (sample("ours", 1e-3, 1e-5), sample("other", 1.0, 1e-3)), (), 1e-4
    )
    results = report.Results(
        versions={"Python": "3", "other": "not installed"},
        sections=[steady],
        over_cells=[Growth("long_wave, one right-hand side", "cells", [16, 32], [1e-6, 1e-6])],
        over_speeds=[Growth("linear", "speeds", [1, 10], [1e-4, 1e-3])],
        curve=0.2,
        curve_complete=True,
        first={"nothing compiled": 2.0},
        remarks=["A remark."],
    )
    report.write(results, tmp_path, "one core")
    text = (tmp_path / "benchmarks.md").read_text(encoding="utf-8")
    assert "other not installed" in text and "up to 32 million cells" in text and "A remark." in text
    for name in ("one", "benchmark_cells", "benchmark_speeds"):
        assert f"({name}.png)" in text and (tmp_path / f"{name}.png").stat().st_size > 0
    json.dumps(results.versions)


def test_first_calls_run(capsys: pytest.CaptureFixture[str]) -> None:
    """The script that a fresh process is given for the first calls has all that it needs."""
    exec(growth.FIRST, {})
    loaded, first, again = map(float, capsys.readouterr().out.split())
    assert loaded > 0.0 and first > 0.0 and again > 0.0


@kills("validation.benchmarks.problems:spectrum", "np.exp(-1j * first *", "np.exp(1j * first *")
def test_distance() -> None:
    """Modes from anywhere on the circle; what one wave lacks counts."""
    theta = 0.3 + 2.0 * np.pi * np.arange(32) / 32
    modes = spectrum(1.0 + np.cos(theta) + 0.5 * np.sin(3.0 * theta), 0.3)
    np.testing.assert_allclose(modes[:4], [0.5, 0.0, -0.25j, 0.0], atol=1e-15)
    assert distance(modes[:2], modes) == pytest.approx(0.25 / math.hypot(0.5, 0.25))


@kills(
    "validation.benchmarks.leblanc_codes:_run",
    "done, problem.c.linear_speed",
    "done, -problem.c.linear_speed",
)
def test_errors_fall() -> None:
    """Newton's wave and the stepper's come to the converged and to the exact one; both from rest and free."""
    problem = steady_problem()
    errors = [
        distance(one.prepare()()(), problem.exact)
        for one in leblanc_codes.steady(problem)
        if "Newton" in one.setting
    ]
    # Each step in points divides by far more than 10; the last is rounding.
    assert all(after < 0.1 * before for before, after in pairwise(errors))
    assert errors[0] < 1e-2 and errors[3] < 1e-8
    assert 5.0 < problem.time < 50.0
    stepped = next(one for one in leblanc_codes.steady(problem) if "64 points, dt" in one.setting)
    assert distance(stepped.prepare()()(), problem.exact) < WANTED
    free = travelling_problem(1.0)
    ends = [distance(one.prepare()()(), free.exact) for one in leblanc_codes.travelling(free, quick=True)]
    assert ends[1] < 0.1 * ends[0] and ends[1] < 1e-5


@kills(
    "validation.benchmarks.leblanc_codes:offset",
    "np.power(1.0 - 2.0 * area, 1.5)",
    "np.power(1.0 - 2.0 * area, 0.5)",
)
@kills("validation.benchmarks.leblanc_codes:_integral", "+ turns * sums[-1]", "")
def test_layer_problem() -> None:
    """A shifted profile has the offset and the error of its shift; a finer grid is nearer to a fine one."""
    theta = 2.0 * np.pi * (np.arange(256) + 0.5) / 256
    small = 1e-3
    wave = np.stack([theta - 1.0, 0.1 * (1.0 + small * np.cos(theta))])
    coarse = np.stack([theta[:64] * 4.0 - theta[0] * 3.0, wave[1].reshape(64, 4).mean(axis=1)])
    coarse[0] = 2.0 * np.pi * (np.arange(64) + 0.5) / 64 - 1.0
    assert layers.profile_error(coarse, wave) < 1e-10
    turned = np.stack([coarse[0] + 0.01, coarse[1]])
    # The mean of |cos(x + e) - cos x| over that of |cos x| is e; pieces of constant area round the corners.
    assert layers.profile_error(turned, wave) == pytest.approx(0.01, rel=0.05)
    assert layers.force_error(turned, coarse) == pytest.approx(0.01, rel=1e-3)
    # A dent of one cell of 256 at the deflection shifts the centre of mass by a first moment of (1 - r^3)/3.
    flat = np.stack([theta - theta[0], np.full(256, 0.1)])
    dented = flat.copy()
    dented[1, 0] = 0.05
    lost = ((1.0 - 0.8**1.5) - (1.0 - 0.9**1.5)) / 3.0
    assert layers.offset(dented) == pytest.approx(-lost / (255 * 0.1 + 0.05))
    problem = layers.LayerProblem(3)
    reference = layers.answer(problem, 256)
    errors = [layers.profile_error(layers.answer(problem, n), reference) for n in (16, 32, 64)]
    # Smooth in three periods: near second order.
    assert errors[1] < 0.5 * errors[0] and errors[2] < 0.5 * errors[1]


@kills(
    "validation.benchmarks.leblanc_codes:LayerProblem.force",
    "grown * cmath.exp(1j *",
    "grown * cmath.exp(-1j *",
)
@kills(
    "validation.benchmarks.leblanc_codes:LayerProblem.force",
    "/ (2.0 * math.pi)\n        size",
    "/ math.pi\n        size",
)
def test_force() -> None:
    """The body force of the peers is the axis' acceleration turned round: its size, sense and ramp."""
    problem = layers.LayerProblem(1)
    whirl = problem.whirl
    late = problem.force(2.0 * whirl.ramp * 40.0)
    size = whirl.amplitude / 0.15 * (whirl.speed / 40.0) ** 2
    assert late == pytest.approx(size * np.exp(2j * whirl.slip * whirl.ramp))
    # A quarter of the ramp: 1/4 - 1/(2 pi).
    early = (0.25 - 0.5 / math.pi) * size * np.exp(0.25j * whirl.slip * whirl.ramp)
    assert problem.force(0.25 * whirl.ramp * 40.0) == pytest.approx(early)


@kills("validation.benchmarks.problems:SteadyProblem.constants", '"c": self.drift', '"c": -self.drift - 1.0')
def test_equation_of_py_pde() -> None:
    """The text that py-pde is given, evaluated by hand, leaves the steady wave where it is."""
    problem = steady_problem()
    n = np.arange(1, problem.exact.size + 1)
    values = lambda modes: np.fft.irfft(np.concatenate(([0.0], modes)), 512, norm="forward")  # noqa: E731
    u, first, second, third = (values(problem.exact * (1j * n) ** k) for k in range(4))
    x = 2.0 * np.pi * np.arange(512) / 512
    fields = {"d_dx(laplace(u))": third, "d_dx(u)": first, "laplace(u)": second, "sin(x)": np.sin(x)}
    text, names = peer_pypde.FORCED, {}
    for k, (phrase, field) in enumerate(fields.items()):
        text = text.replace(phrase, f"field{k}")
        names[f"field{k}"] = field
    consts = problem.constants
    left = eval(text, {"u": u} | names | consts)
    # The wave's 511 points of derivative multiply rounding and the tail; 1e-8 of the largest term.
    assert np.max(np.abs(left)) < 1e-8 * np.max(np.abs(consts["a"] * u * first))


def test_family_is_the_retrograde_one() -> None:
    assert retrograde().family == -1 and retrograde().linear_speed < 0.0
