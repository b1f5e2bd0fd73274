"""Every quantity of every answer has a unit and a meaning; the list is what answers hold."""

from __future__ import annotations

import json
import re

import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.answer import Answer
from leblanc.core.quantities import quantities, types_of
from leblanc.studies.outputs.answer import Output
from leblanc.studies.outputs.study import answers
from meshes.errors import InputError
from tests.leblanc.core.answers import ASKED, answer
from tests.mutants import kills

NO_NUMBERS = {"bool", "str", "str_", "Note"}


def _classes() -> list[type]:
    """All classes that declare quantities, those of records in answers among them."""
    found: list[type] = []
    left: list[type] = list(answers())
    while left:
        kind = left.pop()
        if kind not in found:
            found.append(kind)
            left += [one for key in quantities(kind) for one in types_of(kind, key) if quantities(one)]
    return found


@pytest.mark.parametrize("kind", _classes(), ids=lambda kind: kind.__name__)
def test_every_quantity_has_a_unit_and_a_meaning(kind: type) -> None:
    """Of numbers whose unit depends on the question the meaning says that they are SI."""
    for key, q in quantities(kind).items():
        types = types_of(kind, key)
        if q.part or any(quantities(one) for one in types):
            continue
        names = {one.__name__ for one in types}
        assert q.name or q.text, key
        number = names & {"int", "float", "complex", "float64"} or (q.over and not names & NO_NUMBERS)
        assert q.unit or q.flags or not number or "SI" in q.name + q.text, key
        assert "rad/s" not in q.text + q.name or not q.unit, key


def test_amplitudes_are_zero_to_peak() -> None:
    for one in lb.outputs().quantities:
        if one.unit == "m" and re.search("amplitude|vibration", f"{one.name} {one.meaning}"):
            assert "error" in one.name or re.search("zero to peak|peak to peak", one.meaning), one


def test_errors_are_quantities_of_the_same_answer() -> None:
    found = lb.outputs().quantities
    names = {(one.answer, one.name) for one in found}
    errors = [one for one in found if one.error]
    assert {one.question for one in errors} >= {"run", "runup", "layer", "volume"}
    for one in errors:
        own = (one.answer, one.error), (one.answer, f"{one.name.rpartition('.')[0]}.{one.error}")
        assert names & {*own} or "." in one.name, one


@pytest.mark.parametrize("kind", ASKED)
def test_the_list_is_what_an_answer_holds(kind: str) -> None:
    """Every key of the JSON, every variable of the data file."""
    found = answer(kind)
    listed = [one for one in lb.outputs(found.command).quantities if one.answer == type(found).__name__]
    heads = {one.name.split(".")[0].removesuffix("[]") for one in listed}
    assert found.to_json().keys() <= heads
    stored = {one.variable for one in listed}
    arrays = found.named_arrays().arrays.keys() - {"pole_real", "pole_imag"}  # which a record makes itself
    assert {name.removesuffix("_real").removesuffix("_imag") for name in arrays} <= stored


@kills("leblanc.studies.outputs.study:_outputs", "if q.part:", "if False:")
def test_parts_of_answers_are_listed() -> None:
    """The response is a part of the answer of a run, its peak a record in it."""
    found = {one.name: one for one in lb.outputs("run").quantities if one.answer == "RunAnswer"}
    assert "response" not in found and found["peak.speed"].variable == "peak_speed"
    assert "amplitude" in found
    amplitude = found["amplitude"]
    assert (amplitude.unit, amplitude.over, amplitude.error) == ("m", ("speed",), "error_estimate")
    assert amplitude.meaning.startswith("amplitude; zero to peak, of the axis")


def test_all_machines_and_questions_are_there() -> None:
    """Those of wings and of balls as well; a question is found by its answer, without a list."""
    kinds = {kind.__name__: kind.command for kind in answers()}
    assert {"RunAnswer", "BallsAnswer", "ExciterAnswer", "MagneticAnswer", "SpindleAnswer"} <= {
        name for name, command in kinds.items() if command == "run"
    }
    assert {"bearing", "fit", "layer", "map", "modes", "optimise", "runup", "sweep", "volume"} <= {
        *kinds.values()
    }
    assert all(issubclass(kind, Answer) for kind in answers())
    with pytest.raises(InputError, match="one of: bearing, "):
        lb.outputs("bear")


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["outputs", "bearing", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["quantities"]
    assert [Output(**{**one, "over": tuple(one["over"])}) for one in found] == list(
        lb.outputs("bearing").quantities
    )
    assert main(["outputs", "bearing"]) == 0
    words = capsys.readouterr().out
    assert "Name" in words and "rad s-1" in words and "spindle, eq. 17" in words
    assert main(["outputs", "bear"]) == 2
    assert "<table>" in lb.outputs("bearing")._repr_html_()
