"""`leblanc explain`: a scene's dimensionless numbers and the liquid model at each speed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from leblanc.cli.output import print_json

if TYPE_CHECKING:
    from leblanc.studies.explain import Explanation, LayerExplanation
    from leblanc.text.models import ModelSpan
    from meshes.arrays import Array


def explain(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Key numbers of the machine; which liquid model answers, and why."""
    from leblanc.scene.scene import load_scene
    from leblanc.studies.explain import explain_scene

    machine = load_scene(scene)
    if machine.rotor.kind == "exciter":
        from leblanc.studies.explain import explain_exciter

        found = explain_exciter(machine)
        if json:
            print_json(found)
        else:
            print("\n".join(_exciter_lines(found)))
        return
    answer = explain_scene(machine)
    if json:
        print_json(answer)
    else:
        print("\n".join(_lines(answer)))


def _lines(answer: Explanation) -> list[str]:
    """The explanation in words."""
    from leblanc.text.models import percent
    from leblanc.units import RPM

    dry, wet = answer.critical_speed_dry * RPM, answer.critical_speed_wet * RPM
    first, last = answer.speed_ratio
    rows = [
        ("critical speed", f"{dry:.5g} rpm without liquid, {wet:.5g} rpm with it at small deflections"),
        ("damping ratio", f"{answer.damping_ratio:.4g}"),
        ("speeds", f"{first:.3g} to {last:.3g} times the dry critical speed"),
    ]
    if answer.captured_from is not None:
        rows.append(
            ("captured", f"above {answer.captured_from * RPM:.4g} rpm the liquid rides with the drum")
        )
    lines = [answer.name, *_table(rows)]
    if answer.modes:
        lines += ["natural frequencies at rest, without liquid", *_table(_mode_rows(answer))]
    for k, layer in enumerate(answer.layers):
        lines += [f"chamber {k + 1}", *_table([("fill", "empty")] if layer is None else _layer_rows(layer))]
    lines.append(f"liquid model, with a tolerance of {percent(answer.tolerance)}")
    for span in answer.models:
        lines += _span_lines(span)
    lines += _model_lines(answer)
    if answer.runup:
        from textwrap import wrap

        lines += ["liquid model of the run-up", *(f"  {line}" for line in wrap(answer.runup, 100))]
    return lines


def _span_lines(span: ModelSpan) -> list[str]:
    """One range of speeds: the model, its error, why, and what the next better one gives."""
    from textwrap import wrap

    from leblanc.text.models import error_words, speeds_words

    holds = "" if span.in_range else " (out of range)"
    lines = [f"  {speeds_words(span)} rpm: {span.model}{holds}"]
    told = (("estimated error", error_words(span)), ("why", span.reason), ("next better", span.better))
    for label, text in told:
        # A number stays with its unit.
        begin, *rest = (line.replace("\xa0", " ") for line in wrap(text.replace(" %", "\xa0%"), 88))
        lines += [f"    {label:17}{begin}", *(f"{'':21}{line}" for line in rest)]
    return lines


def _model_lines(answer: Explanation) -> list[str]:
    """What each model does and takes for granted."""
    from textwrap import wrap

    from leblanc.text.models import described

    lines = []
    for name, text in described(span.model for span in answer.models):
        lines += [f"  {name}", *(f"    {line}" for line in wrap(text, 105))]
    return lines


def _exciter_lines(found: dict[str, Any]) -> list[str]:
    """The explanation of a vibrating table in words."""
    from leblanc.units import RPM

    def rpm(value: float | None) -> str:
        return "none" if value is None else f"{value * RPM:.5g} rpm"

    numbers, speeds = found["dimensionless"], found["characteristic_speeds"]
    first, last = found["speed_ratio"]
    words = {
        "smallness": "share of the balls in the moving mass over their rolling inertia",
        "drag": "drag of the balls",
        "unbalance": "unbalance over that of the balls",
        "damping": "damping ratio of the platform",
    }
    return [
        found["name"],
        *_table(
            [
                ("natural frequency", rpm(found["natural_frequency"])),
                ("speeds", f"{first:.3g} to {last:.3g} times the natural frequency"),
                *((key, f"{numbers[key]:.4g}: {text}") for key, text in words.items()),
                ("three stuck speeds", f"from {rpm(speeds['second_pair'])} to {rpm(speeds['merger'])}"),
                ("printed critical", f"{rpm(found['critical_speed_printed'])} by the source's regression"),
            ]
        ),
    ]


def _mode_rows(answer: Explanation) -> list[tuple[str, str]]:
    """One mode each: frequency and words."""
    from leblanc.units import RPM

    return [
        (
            f"{one.frequency * RPM / 60.0:.4g} Hz",
            f"{one.frequency * RPM:.4g} rpm, damping ratio {one.damping_ratio:.3g}, mostly a {one.moves}",
        )
        for one in answer.modes
    ]


def _layer_rows(layer: LayerExplanation) -> list[tuple[str, str]]:
    """One chamber: label and words."""
    from math import isnan

    from leblanc.units import MM

    n = layer.numbers
    cylinder = n.steepness[0] > 1e20
    covers = "not known for such a chamber"
    if not isnan(layer.optimal_volume):
        covers = f"from {layer.optimal_volume * 1e6:.4g} ml at the dry rotor's last deflection"
    return [
        *([("walls", layer.walls)] if layer.walls else []),
        ("fill", f"{n.fill:.4g} of the capacity"),
        ("layer at fast spin", f"{layer.depth * MM:.4g} mm deep, h0/R = {n.relative_depth:.4g}"),
        ("curvature", f"kappa = {n.curvature:.5g}"),
        ("added mass", f"{layer.added_mass_ratio:.4g} of the rotor's mass while the wall is wet"),
        ("mass of the liquid", f"{layer.liquid_mass_ratio:.4g} of the rotor's mass"),
        ("centrifuge number", f"{_span(n.centrifuge)}: acceleration at the surface over gravity"),
        (
            "steepness",
            "a cylinder: no gravity along the axis"
            if cylinder
            else f"{_span(n.steepness)}: rise of the surface over the radius in chamber heights",
        ),
        ("Reynolds number", _span(n.reynolds)),
        ("wall layer", f"{_span(n.skin)} of the depth"),
        ("covers the wall", covers),
    ]


def _span(values: Array) -> str:
    """From the first speed to the last."""
    return f"{values[0]:.3g} to {values[1]:.3g}"


def _table(rows: list[tuple[str, str]]) -> list[str]:
    return [f"  {label:20}{text}" for label, text in rows]
