"""A comparison of made-up answers, whose differences are known in closed form."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from leblanc.core.blocks import Words
from leblanc.core.terminal import print_json
from leblanc.studies.compare.answer import CompareAnswer, ModelAnswer, comparison_head, comparison_rows
from leblanc.studies.compare.figure import LOOKS
from leblanc.studies.held.answer import Held
from leblanc.studies.run.answer import RunAnswer
from meshes.errors import InputError
from tests.mutants import kills
from tests.oracles.records import ADDED, MASS, RPM, dry_deflection, record_of, response_of

SPEED = np.linspace(100.0, 2000.0, 96) * RPM


def comparison(*answers: ModelAnswer) -> CompareAnswer:
    return CompareAnswer("Rig", "a book", ("rotor.mass",), "abc", answers)


def answer(model: str, result: RunAnswer | None = None) -> ModelAnswer:
    if result is None:
        return ModelAnswer(model, "model.liquid must be another", None, None)
    return ModelAnswer(model, "", 0.25, result)


def wet(added: float) -> RunAnswer:
    return record_of(response_of(SPEED, added))


def three() -> CompareAnswer:
    return comparison(answer("linear", wet(0.5 * ADDED)), answer("kdv"), answer("statics", wet(ADDED)))


@kills(
    "leblanc.studies.compare.answer:apart",
    "own.amplitude[known] - reference",
    "own.amplitude[known] + reference",
)
@kills(
    "leblanc.studies.compare.answer:apart",
    "found / size if",
    "found / own.amplitude[known].max() if",
)
def test_differences_of_known_answers() -> None:
    """Half the added mass against all of it: both amplitudes are those of a dry rotor of another mass."""
    found = three()
    own, other = (np.abs(dry_deflection(SPEED, MASS + share * ADDED)) for share in (0.5, 1.0))
    expected = (own - other) / other.max()
    np.testing.assert_allclose(found.difference("linear"), expected, rtol=0.0, atol=1e-14)
    assert found.largest_difference("linear") == pytest.approx(np.abs(expected).max(), rel=1e-12)
    assert found.reference == "statics" and found.models == ("linear", "kdv", "statics")
    assert not found.difference("statics").any() and found.largest_difference("statics") == 0.0


def test_speeds_without_a_finite_amplitude_are_left_out() -> None:
    response = response_of(SPEED)
    broken = response.deflection.copy()
    broken[3], broken[7] = np.inf, np.nan
    lost = record_of(replace(response, deflection=broken))
    found = comparison(answer("linear", lost), answer("statics", wet(ADDED)))
    assert np.flatnonzero(np.isnan(found.difference("linear"))).tolist() == [3, 7]
    assert found.largest_difference("linear") == 0.0
    other_way = comparison(answer("statics", wet(ADDED)), answer("linear", lost))
    assert other_way.largest_difference("statics") == 0.0
    assert found.plot().axes and other_way.plot().axes


def test_a_machine_that_does_not_move_has_no_difference_from_itself_only() -> None:
    still = record_of(replace(response_of(SPEED), deflection=np.zeros(SPEED.size, dtype=complex)))
    assert comparison(answer("linear", still), answer("statics", still)).largest_difference("linear") == 0.0
    found = comparison(answer("linear", wet(ADDED)), answer("statics", still))
    assert found.largest_difference("linear") is None


def test_without_an_answer_there_is_no_comparison() -> None:
    with pytest.raises(InputError, match="at least one model that answers"):
        comparison(answer("kdv"), answer("long_wave"))


def test_json_dataset_and_table_say_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    found = three()
    print_json(found.to_json())
    said = json.loads(capsys.readouterr().out)
    assert {*said} == {"models", "reference", "speed", "amplitude_dry", "name", "digest"}
    entries, data = said["models"], found.to_dataset()
    keys = ["model", "answered", "reason", "cpu_time", "amplitude", "liquid_offset"]
    more = ["amplitude_min", "amplitude_max", "state", "in_range", "error_estimate"]
    last = ["peak_amplitude", "largest_difference", "largest_error", "in_range_share", "held"]
    assert all({*entry} == {*keys, *more, *last} for entry in entries)
    linear, kdv, _ = entries
    assert kdv["reason"] and not kdv["answered"] and not linear["reason"] and linear["answered"]
    assert [kdv[key] for key in keys[3:]] == [None] * 3 and kdv["largest_difference"] is None
    assert dict(data.sizes) == {"model": 3, "speed": 96}
    over = ("amplitude", "liquid_offset", "amplitude_min", "amplitude_max")
    for key in (*over, "peak_amplitude", "largest_difference", "in_range_share", "cpu_time"):
        assert data[key].attrs["units"] and data[key].attrs["long_name"]
        np.testing.assert_array_equal(data[key].sel(model="linear"), linear[key])
        assert np.isnan(data[key].sel(model="kdv")).all()
    assert data.answered.values.tolist() == [1, 0, 1]
    np.testing.assert_array_equal(data.amplitude_dry, said["amplitude_dry"])
    table = comparison_rows(found)
    assert [row[0] for row in table] == ["linear", "kdv", "statics"] and table[2][3] == "reference"
    assert table[0][1] == f"{1e3 * linear['peak_amplitude']:.4g}"
    assert {len(row) for row in table} == {len(comparison_head(found))}
    assert ("kdv", "model.liquid must be another") in [
        (block.name, block.text) for block in found.blocks() if isinstance(block, Words)
    ]


@kills(
    "leblanc.studies.compare.answer:ModelAnswer.held",
    "held.at & (held.state == kind)",
    "held.state == kind",
)
def test_held_states_have_a_column_of_their_own() -> None:
    """Of 20 speeds at the end of the range that were held, five repeat and two are limit cycles."""
    steady, size = wet(ADDED), SPEED.size
    at, state = np.arange(size) >= size - 20, np.full(size, "steady", dtype="U11")
    state[-20:-15], state[-2:] = "periodic", "limit_cycle"
    some, nothing = np.where(at, 1e-3, np.nan), np.full(size, np.nan)
    least, most = 0.5 * steady.amplitude, np.where(at, 1.5 * steady.amplitude, np.nan)
    liquid = np.zeros((size, 1), dtype=complex)
    nobody = np.full(size, "")
    motions = Held(
        *(at, state, least, most, nothing, liquid, np.abs(liquid), some, state, nothing, 64),
        *(nobody, nothing, nothing, nothing),
    )
    waves = replace(steady, held=motions, error_estimate=np.where(at, 0.02, 0.001))
    found = comparison(answer("statics", steady), answer("long_wave", waves))
    kinds = {"steady": 13, "periodic": 5, "limit_cycle": 2, "not_settled": 0}
    assert [entry["held"] for entry in found.to_json()["models"]] == [None, kinds]
    head, (first, second) = comparison_head(found), comparison_rows(found)
    column = head.index("time-domain states")
    assert (first[column], second[column]) == ("none", "13 steady, 5 periodic, 2 limit cycle")
    within = f"{100.0 * waves.in_range.mean():.3g}"
    assert second[head.index("estimate (%)")] == "2" and second[head.index("in range (%)")] == within
    data = found.to_dataset()
    assert data.held_limit_cycle.values.tolist() == [0, 2]
    np.testing.assert_array_equal(data.amplitude_max.sel(model="long_wave"), waves.amplitude_max)
    bands = [band for band in found.plot().axes[0].collections if "least to largest" in str(band.get_label())]
    assert len(bands) == 1 and "5 periodic" in found.plot().alt
    assert "time-domain states" not in comparison_head(three())


def test_what_has_not_converged_is_no_difference() -> None:
    response = response_of(SPEED)
    known = np.arange(SPEED.size) != 5
    lost = record_of(replace(response, converged=known, deflection=np.where(known, response.deflection, 1.0)))
    found = comparison(answer("kdv", lost), answer("statics", wet(ADDED)))
    assert np.flatnonzero(np.isnan(found.difference("kdv"))).tolist() == [5]
    assert found.largest_difference("kdv") == 0.0


def test_lines_of_the_figure_are_told_apart_without_colour() -> None:
    found = three()
    above, below = found.plot().axes
    curves = [line for line in above.lines if line.get_label() in found.models]
    assert len({str(line.get_linestyle()) + str(line.get_linewidth()) for line in curves}) == 2
    assert len({(str(look["linestyle"]), look["linewidth"]) for look in LOOKS}) == len(LOOKS)
    for line, name in zip(curves, ("linear", "statics"), strict=True):
        np.testing.assert_allclose(line.get_xdata(), SPEED / RPM, rtol=1e-12)
        np.testing.assert_array_equal(line.get_ydata(), found.results[name].amplitude * 1e3)
    drawn = below.lines[0].get_ydata()
    np.testing.assert_array_equal(drawn, 100.0 * found.difference("linear"))
    assert below.get_ylabel() == "Difference (%)"


def test_one_model_needs_no_differences() -> None:
    figure = comparison(answer("statics", wet(ADDED))).plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["Amplitude (mm 0-p)"]


def test_narrow_resonances_are_drawn_wider_below() -> None:
    """The same lines in a span about the peaks, amplitudes above differences."""
    speed = np.linspace(100.0, 6000.0, 2000) * RPM
    light = 2.0 * 0.01 * MASS * 1000.0 * RPM

    def narrow(added: float) -> RunAnswer:
        response = response_of(speed, added)
        own, dry = (dry_deflection(speed, MASS + share, light) for share in (added, 0.0))
        return record_of(replace(response, deflection=own, deflection_dry=dry))

    found = comparison(answer("linear", narrow(0.5 * ADDED)), answer("statics", narrow(ADDED)))
    above, below, wide, apart = found.plot().axes
    low, high = wide.get_xlim()
    assert apart.get_xlim() == (low, high) and above.get_xlim() == below.get_xlim()
    assert high - low < 0.2 * (above.get_xlim()[1] - above.get_xlim()[0])
    for line, whole in zip(wide.lines, above.lines, strict=False):
        top = np.nanmax(whole.get_ydata())
        assert (
            np.nanmax(line.get_ydata()) == top and low < line.get_xdata()[np.argmax(line.get_ydata())] < high
        )
        assert above.get_ylim()[1] > top and wide.get_ylim()[1] > top
    assert (below.get_xlabel(), apart.get_xlabel()) == ("", "Speed (rpm)")
