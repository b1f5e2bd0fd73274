"""The table of a study file: its keys, the rule of each value, and every fault in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, ValidationError

from study.faults import SceneFault, SceneFaults, field_path, shown
from study.rules import OneOf, Refused, Text, Whole
from study.table import Table

METHODS = ("grid", "latin_hypercube", "sobol", "random", "saltelli")
MAX_SAMPLES = 10_000_000
MAX_VARIED = 1000  # fields
MAX_SEED = 2**63 - 1  # the largest whole number of TOML

_EXAMPLE = '"rotor.mass" = { uniform = ["3 kg", "12 kg"] }'


class Varying:
    """[vary]: fields of the scene by their paths, each with one distribution."""

    allowed = f"a table of 1 to {MAX_VARIED} fields of the scene by their paths, such as {_EXAMPLE}"

    def __call__(self, value: object) -> dict[str, Any]:
        """The fields, each with what the file says about it."""
        if isinstance(value, dict) and 1 <= len(value) <= MAX_VARIED:
            return value
        raise Refused(self.allowed)


class StudyTable(Table):
    """The whole file."""

    scene: Annotated[str, BeforeValidator(Text(4000))]
    method: Annotated[str, BeforeValidator(OneOf(METHODS))]
    samples: Annotated[int | None, BeforeValidator(Whole(1, MAX_SAMPLES))] = None
    seed: Annotated[int, BeforeValidator(Whole(0, MAX_SEED))] = 0
    vary: Annotated[dict[str, Any], BeforeValidator(Varying())]


def check_study(table: Mapping[str, Any], file: str) -> StudyTable:
    """Every value of a study but the varied fields, which need the scene, checked.

    Parameters
    ----------
    table : content of a study file
    file : its name, for the messages

    Raises
    ------
    SceneFaults : with all that is wrong
    """
    if "rotor" in table and "vary" not in table:
        text = "a study with the keys scene, method and [vary]; this is a scene, which `leblanc run` answers"
        raise SceneFaults([SceneFault(file, "", None, text)])
    faults: list[SceneFault] = []
    checked = None
    try:
        checked = StudyTable.model_validate(table)
    except ValidationError as error:
        faults.extend(_broken_rules(error, file))
    faults.extend(_samples(table, file))
    if checked is None or faults:
        raise SceneFaults(faults)
    return checked


def _broken_rules(error: ValidationError, file: str) -> Iterator[SceneFault]:
    """One fault for each broken rule."""
    for item in error.errors(include_url=False):
        cause = item.get("ctx", {}).get("error")
        value = None if item["type"] == "missing" else shown(item["input"])
        if item["type"] == "extra_forbidden":
            allowed = "left out or spelled as one of: " + ", ".join(StudyTable.model_fields)
        elif isinstance(cause, Refused):
            allowed = cause.allowed
        else:
            allowed = f"given: {_rule(str(item['loc'][0]))}"
        yield SceneFault(file, field_path(item["loc"]), value, allowed)


def _samples(table: Mapping[str, Any], file: str) -> Iterator[SceneFault]:
    """The number of samples, which a grid has by its levels."""
    method = table.get("method")
    if method == "grid" and "samples" in table:
        yield SceneFault(file, "samples", shown(table["samples"]), "left out where method is grid")
    elif method in METHODS and method != "grid" and "samples" not in table:
        yield SceneFault(file, "samples", None, f"given: {_rule('samples')}")


def _rule(name: str) -> str:
    """The rule of a field in words."""
    for rule in StudyTable.model_fields[name].metadata:
        if isinstance(rule, BeforeValidator):
            return str(getattr(rule.func, "allowed", ""))
    return ""
