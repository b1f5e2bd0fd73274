"""What rounding does to a run-up: an ensemble of runs whose unbalance differs in its last digits."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pytest import approx

from leblanc.cli import main
from leblanc.scene.scene import load_scene
from leblanc.studies.runup.answer import RunupAnswer
from leblanc.studies.runup.figure import speed_figure, time_figure
from leblanc.studies.runup.study import runup_scene
from leblanc.studies.runup.words import describe_model
from meshes.errors import InputError
from solvers.runup.ensemble import CHANGE, Member, ensemble, spread_over
from tests.mutants import kills

ROOT = Path(__file__).parents[3]
SHORT = load_scene(ROOT / "examples/runup.toml").replace(
    {"runup.duration": "1 s", "runup.start": 20.0, "runup.cells": 16, "runup.samples": 40}
)


def members(**changes: Any) -> RunupAnswer:
    return runup_scene(SHORT, check=False, **{"ensemble": 3, **changes})


@pytest.fixture(scope="module")
def found() -> RunupAnswer:
    return members()


def test_the_range_holds_the_run_itself_and_every_other(found: RunupAnswer) -> None:
    spread = found.spread
    assert spread is not None and spread.members == spread.asked == 4 and spread.lost == 0
    assert np.all(spread.amplitude_min <= found.amplitude) and np.all(found.amplitude <= spread.amplitude_max)
    assert np.all(spread.amplitude_min <= spread.amplitude_median)
    assert np.all(spread.amplitude_median <= spread.amplitude_max)
    assert spread.peaks[0] == found.history.largest.max() and spread.peaks.shape == (4,)


def test_a_run_without_bores_enlarges_nothing(found: RunupAnswer) -> None:
    # A second of it: the amplitude goes with the unbalance, so that the range is at most twice the change and
    # what rounding adds in some thousand steps.
    spread = found.spread
    assert spread is not None and 0.0 < spread.peak_spread < 10.0 * CHANGE
    (note,) = (note for note in found.notes if note.code == "rounding")
    assert "does not matter" in note.text


def test_any_number_of_workers_gives_the_same(found: RunupAnswer) -> None:
    there = members(workers=2)
    assert found.spread is not None and there.spread is not None
    for name in ("amplitude_min", "amplitude_max", "amplitude_median", "peaks"):
        assert np.array_equal(getattr(there.spread, name), getattr(found.spread, name)), name


@kills(
    "solvers.runup.ensemble:ensemble",
    "np.random.default_rng([seed, member])",
    "np.random.default_rng([seed, count])",
)
@kills("solvers.runup.ensemble:ensemble", "default_rng([seed, member])", "default_rng([0, member])")
def test_changes_are_seeded_and_small() -> None:
    from fluid.friction.laws import NO_FRICTION
    from leblanc.scene.scene import dry_rotor
    from solvers.runup.long_wave import couple
    from solvers.runup.machine import Ramp
    from solvers.runup.runup import RunupNumerics

    system = dry_rotor(SHORT).system()

    def changes(count: int, seed: int) -> list[float]:
        run = Ramp(1.0, 2.0, 1.0, 1.0), NO_FRICTION, 0.0, RunupNumerics(), couple
        tasks = ensemble(system, SHORT.fills, *run, count, seed)
        assert not any(task.numerics.companion for task in tasks)
        which = int(np.argmax(np.abs(system.unbalance)))
        return [float((task.system.unbalance[which] / system.unbalance[which]).real - 1.0) for task in tasks]

    first = changes(5, 1)
    assert first[:3] == changes(3, 1) and len(set(first)) == 5 and first != changes(5, 2)
    assert max(map(abs, first)) <= CHANGE * 1.01
    for count, seed, field in ((0, 0, "ensemble"), (3, -1, "seed"), (10**6, 0, "ensemble")):
        with pytest.raises(InputError, match=field):
            changes(count, seed)


@kills("solvers.runup.ensemble:spread_over", "np.nanmedian", "np.nanmax")
@kills("solvers.runup.ensemble:spread_over", "row[:reached] = found[:reached]", "row[:] = 0.0")
@kills("solvers.runup.ensemble:_lost", "run.amplitude.size < count", "run.amplitude.size <= count")
def test_ranges_by_hand() -> None:
    """A member that ends early counts where it was."""
    rows = [[1.0, 2.0, 4.0], [1.5, 2.5, 5.0], [2.0, 6.0]]
    spread = spread_over([Member(np.array(row), np.array(row)) for row in rows], 3, 3, 0)
    assert spread.amplitude_min.tolist() == [1.0, 2.0, 4.0] and spread.lost == 1
    assert spread.amplitude_max.tolist() == [2.0, 6.0, 5.0]
    assert spread.amplitude_median.tolist() == [1.5, 2.5, 4.5]
    assert spread.peaks.tolist() == [4.0, 5.0, 6.0]
    assert spread.peak_spread == approx(0.4) and spread.largest_spread == approx(4.0 / 5.0)


def test_json_data_and_figures_carry_it(found: RunupAnswer) -> None:
    told = found.to_json()["ensemble"]
    data = found.to_dataset()
    assert told["amplitude_max"] == approx(data["amplitude_max"].values)
    assert data.attrs["ensemble_members"] == told["members"] == 4
    for figure in (speed_figure(found), time_figure(found)):
        labels = {text for axes in figure.axes for text in axes.get_legend_handles_labels()[1]}
        assert "range over 4 runs that differ by rounding, thinner than the line" in labels
    assert "ensemble" not in runup_scene(SHORT, check=False).to_json()


def test_a_scene_says_what_its_bores_leave() -> None:
    rolling = SHORT.replace({"runup.bore": "enstrophy"})
    assert rolling.digest != SHORT.digest
    assert SHORT.replace({"runup.bore": "none"}).digest == SHORT.digest
    found = runup_scene(rolling, check=False)
    assert found.bore == "enstrophy" and "jumps with enstrophy" in describe_model(found)
    assert "bores" not in describe_model(runup_scene(SHORT, check=False))
    assert found.named_arrays().attrs["bore"] == "enstrophy"


@pytest.mark.usefixtures("undrawn")
def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "s.toml"
    text = (ROOT / "examples/runup.toml").read_text().replace('duration = "14 s"', 'duration = "0.5 s"')
    path.write_text(text)
    begin = ["runup", str(path), "--no-check", "--cells", "16", "--samples", "20", "--out", str(tmp_path)]
    main([*begin, "--ensemble", "2", "--workers", "1"])
    shown = capsys.readouterr().out
    assert "By rounding alone" in shown and "Rounding does not matter" in shown
    assert "By rounding alone" in (tmp_path / "runup.html").read_text()
    assert main([*begin, "--ensemble", "-1"]) == 2
    assert "ensemble = -1: must be from 1 to 10000" in capsys.readouterr().err
