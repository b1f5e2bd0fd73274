"""`leblanc validate`: published cases, printed, computed, difference."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Callable

    from validation.case import Case

# Of each group the modules below `validation.cases`, and the function there, where it is not `cases`.
GROUPS = {
    "errata": "errata.tub errata.formulas errata.machines errata.machines:statements",
    "optimal_volume": "liquid.optimal_volume",
    "vector_model": "rotors.vector_model",
    "horizontal_rig": "rotors.rigs:horizontal_cases",
    "vertical_rig": "rotors.rigs:vertical_cases",
    "layer": "liquid.layer:all_cases",
    "whirl": "rotors.whirl",
    "tub": "rotors.tub",
    "two_plane": "two_plane.conditions two_plane.damping two_plane.layers",
    "exciter": "exciter.speeds exciter.traces exciter.beyond",
    "runup": "rotors.runup",
    "fill_sweep": "fill_sweep.judged",
    "baffles": "baffles.flow",
    "exact_wave": "liquid.exact_wave",
    "claims": "claims.chambers claims.swing claims.layout",
    "blood_pump": "rotors.blood_pump",
    "spindle": "rotors.spindle",
    "turning": "rotors.turning",
    "measured_balls": "measured_balls.cases",
    "bearings": "rotors.bearings",
    "kdv": "liquid.kdv",
    "published": " ".join(
        f"published.{each}" for each in ("partitions", "damping", "tilt", "absorber", "ring", "balancer")
    ),
    "lying_drum": "liquid.lying_drum",
}


def validate(
    case: Annotated[
        str | None, typer.Argument(help="One group: " + ", ".join(GROUPS) + " [default: all].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of a table.")] = False,
) -> None:
    """Published cases beside what the package computes."""
    from leblanc.core.progress import working
    from leblanc.core.terminal import print_json

    with working("cases") as update:
        found = all_cases(case, update)
    if json:
        print_json({"cases": [result.to_json() for result in found]})
        return
    for result in found:
        print(f"{result.name}  [{result.source}]  {result.verdict.upper()}")
        print(f"    {result.quantity}")
        print(f"    {result.origin.kind} {_shown(result.printed)} | computed {_shown(result.computed)}")
        if result.origin.name not in ("", result.source):
            print(f"    {result.origin}")
        print(f"    difference {_shown(result.difference)}" + (f"; {result.note}" if result.note else ""))
        if (effect := result.effect) is not None:
            print(f"    {effect.quantity}: {effect.measured:.3g} | computed {effect.computed:.3g}")
    counts = {verdict: sum(result.verdict == verdict for result in found) for verdict in _VERDICTS}
    print(", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count))


_VERDICTS = ("agrees", "erratum", "trend", "differs")


def all_cases(
    group: str | None = None, progress: Callable[[int, int, str], object] = lambda *_: None
) -> list[Case]:
    """Cases of one group, or of all; progress: groups done, groups, name of the next."""
    from meshes.errors import InputError

    if group is not None and not (isinstance(group, str) and group in GROUPS):
        raise InputError("case", str(group), "one of " + ", ".join(GROUPS))
    chosen = tuple(GROUPS) if group is None else (group,)
    found: list[Case] = []
    for done, name in enumerate(chosen):
        progress(done, len(chosen), name.replace("_", " "))
        for place in GROUPS[name].split():
            module, _, function = place.partition(":")
            found += getattr(import_module(f"validation.cases.{module}"), function or "cases")()
    return found


def _shown(value: float | str | None) -> str:
    if value is None:
        return "nothing"
    return value if isinstance(value, str) else f"{value:.6g}"
