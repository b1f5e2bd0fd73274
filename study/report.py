"""The one-page summary of a study: one HTML file that needs nothing else."""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from meshes.border import InputError
from study.netcdf import replacing
from study.record import MM, RPM, StudyRecord, models_used, one_line, peak, versions
from study.words import NOT_FOUND
from study.words import number as number  # what else prints a study wants them too
from study.words import ranges as ranges

IMAGE_TYPES = {".svg": "image/svg+xml", ".png": "image/png"}
AGAINST = 0.5  # from here on a whirl counts as one with or against the spin

# Of the page in the template: mm, characters in a line.
PAGE_HEIGHT, LINE_HEIGHT, CHARACTERS = 262.0, 4.1, 125
INPUT_CHARACTERS = 38  # in a line of one column
TALL = 74.0  # height of a figure with room, mm
FIGURE_HEIGHTS = (40.0, 70.0)

# What the model does, and what it takes for granted.
MODELS = {
    "statics": (
        "At each speed the liquid rests in the turning drum, its free surface a paraboloid about the "
        "rotation axis that holds the given volume.",
        "This takes steady synchronous whirl for granted and a liquid that friction has brought up to the "
        "drum's speed; waves, self-excited whirl and surface tension are left out.",
    ),
    "linear": (
        "The liquid answers with small waves on a rigidly turning ring, by the exact linear theory of plane "
        "frictionless flow.",
        "This takes a wet wall all round for granted, disturbances small against the depth of the layer, and "
        "a layer of the same depth all along the axis.",
    ),
    "long_wave": (
        "The liquid answers with long waves of any height in an annular layer, bores included, which keep "
        "mass and angular momentum.",
        "This takes a layer thin against its waves for granted, the pressure of a layer without radial "
        "acceleration, and the same depth all along the axis.",
    ),
    "kdv": (
        "The liquid answers with one family of weakly nonlinear, dispersive waves that stand still as seen "
        "from the whirl.",
        "This takes whirl near the resonance of that family for granted, and waves low against the depth of "
        "the layer.",
    ),
    "fem": (
        "The liquid answers with small disturbances, by finite elements on the section of the chamber.",
        "This takes plane frictionless flow for granted, disturbances small against the depth of the layer, "
        "and an undisturbed surface that is a circle.",
    ),
}


@dataclass(frozen=True)
class Comparison:
    """With liquid, without, and their ratio, as printed."""

    label: str
    wet: str
    dry: str
    ratio: str


@dataclass(frozen=True)
class Input:
    """One value of the scene as printed."""

    label: str
    value: str
    assumed: bool


def comparisons(record: StudyRecord) -> list[Comparison]:
    """Largest and last amplitude, with and without liquid.

    Parameters
    ----------
    record : the study
    """
    r = record.response
    wet, dry = peak(record.amplitude), peak(record.amplitude_dry)
    at_wet, at_dry = (NOT_FOUND if i is None else number(r.speed[i] * RPM) for i in (wet, dry))
    return [
        _compared("Largest amplitude (mm)", record, wet, dry),
        Comparison("at the speed (rpm)", at_wet, at_dry, ""),
        _compared(f"Amplitude at {number(r.speed[-1] * RPM)} rpm (mm)", record, -1, -1),
    ]


def _compared(label: str, record: StudyRecord, wet: int | None, dry: int | None) -> Comparison:
    """Amplitudes at two places in the list of speeds."""
    with_liquid = math.nan if wet is None else float(record.amplitude[wet])
    without = math.nan if dry is None else float(record.amplitude_dry[dry])
    comparable = without > 0.0 and math.isfinite(without) and math.isfinite(with_liquid)
    ratio = number(with_liquid / without) if comparable else ""
    return Comparison(label, number(with_liquid * MM), number(without * MM), ratio)


def facts(record: StudyRecord) -> list[tuple[str, str]]:
    """What else a reader wants to know: label and value.

    Parameters
    ----------
    record : the study
    """
    r = record.response
    angle = "none"
    if r.liquid_offset[-1] > 0.0:
        angle = f"{number(math.degrees(r.liquid_angle[-1]))} deg from the unbalance"
    return [
        ("Mass of the liquid", f"{number(record.liquid_mass * 1e3)} g"),
        (f"Liquid at {number(r.speed[-1] * RPM)} rpm", angle),
        *_vibration(record),
        ("Dry patch on the wall", ranges(r.speed, r.dry_patch)),
        ("Model out of range", ranges(r.speed, ~r.in_range)),
        ("Reported answer unstable", ranges(r.speed, ~r.stable)),
        *_whirl(record),
        ("Not converged", ranges(r.speed, ~r.converged)),
    ]


def _whirl(record: StudyRecord) -> list[tuple[str, str]]:
    """Where a whirl grows by itself, by its refined edges."""
    if record.whirl is None:
        return []
    words = [f"{low * RPM:.5g} to {high * RPM:.5g} rpm" for low, high in record.whirl.bands]
    return [("Self-excited whirl", ", ".join(words) or "none")]


def _vibration(record: StudyRecord) -> list[tuple[str, str]]:
    """Critical speeds and natural frequencies; "b" marks a whirl against the spin."""
    if record.motion is None:
        return [
            ("Critical speed with liquid", f"{number(record.critical_speed_wet * RPM)} rpm"),
            ("Critical speed without liquid", f"{number(record.critical_speed_dry * RPM)} rpm"),
        ]

    def listed(speeds: tuple[tuple[float, float], ...]) -> str:
        words = [f"{speed * RPM:.4g}" + (" b" if sense < -AGAINST else "") for speed, sense in speeds]
        return ", ".join(words) + " rpm" if words else "none"

    at_rest = [
        f"{one.frequency / (2.0 * math.pi):.3g} ({one.damping_ratio:.2g})" for one in record.motion.modes
    ]
    return [
        ("Critical speeds with liquid", listed(record.motion.critical_speeds_wet)),
        ("Critical speeds without liquid", listed(record.motion.critical_speeds_dry)),
        ("Natural frequencies at rest (damping ratios)", ", ".join(at_rest) + " Hz"),
    ]


def machine(record: StudyRecord) -> str:
    """What was studied, in one sentence.

    Parameters
    ----------
    record : the study
    """
    r = record.response
    count = len(record.chambers)
    volume = number(sum(chamber.volume for chamber in record.chambers) * 1e6)
    liquids = " and ".join(dict.fromkeys(one_line(c.liquid_name) for c in record.chambers))
    chambers = f"{count} chambers, together" if count > 1 else "one chamber"
    carries = f"{chambers} with {volume} ml of {liquids}" if count else "no chamber"
    speeds = f"at {number(r.speed[0] * RPM)} rpm"
    if r.speed.size > 1:
        speeds = (
            f"from {number(r.speed[0] * RPM)} to {number(r.speed[-1] * RPM)} rpm in {r.speed.size} speeds"
        )
    return f"A rotor with a {record.axis} axis that carries {carries}, {speeds}."


def remarks(record: StudyRecord) -> list[str]:
    """Notes of the record and what its numbers themselves ask a reader to bear in mind.

    Parameters
    ----------
    record : the study
    """
    r, found = record.response, [one_line(note) for note in record.notes]
    highest = peak(record.amplitude)
    if highest is None:
        found.append("No answer was found at any speed.")
    elif r.speed.size > 1 and r.speed[highest] in (r.speed.min(), r.speed.max()):
        found.append("The largest amplitude lies at an end of the range of speeds.")
    if (infinite := np.isinf(record.amplitude)).any():
        found.append(f"Undamped, the amplitude is infinite at: {ranges(r.speed, infinite)}.")
    if highest is not None and not r.in_range[highest]:
        found.append("The largest amplitude lies where the liquid model is out of range.")
    if record.motion is not None and any(way < -AGAINST for _, way in record.motion.critical_speeds_dry):
        found.append("Critical speeds marked b belong to whirl against the spin.")
    if not r.in_range[-1]:
        found.append("At the last speed the liquid model is out of range.")
    return found


def inputs(record: StudyRecord) -> list[Input]:
    """Values of the scene; those that no source gives are marked, a whole table by its own path.

    Parameters
    ----------
    record : the study
    """
    marked = tuple(record.assumed)
    return [
        Input(one_line(label), one_line(value), any(path == a or path.startswith(f"{a}.") for a in marked))
        for label, value, path in record.inputs
    ]


def models(record: StudyRecord) -> list[tuple[str, str, str]]:
    """Each liquid model that was used: its name, where it was used, what it does and takes for granted."""
    r = record.response
    names = models_used(r)
    return [
        (name, ranges(r.speed, r.model == name) if len(names) > 1 else "", " ".join(MODELS.get(name, ())))
        for name in names
    ]


def _figure_height(texts: list[str], rows: int) -> float:
    """Height in mm that leaves two rows of figures and all texts on one page.

    Parameters
    ----------
    texts : that run over the width of the page
    rows : lines of the tables and headings
    """
    lines = rows + sum(math.ceil(len(text) / CHARACTERS) for text in texts)
    low, high = FIGURE_HEIGHTS
    return round(min(max(0.5 * (PAGE_HEIGHT - LINE_HEIGHT * lines), low), high), 1)


def _input_rows(values: list[Input]) -> int:
    """Lines of the three columns of inputs; long ones take two."""
    lines = sum(math.ceil((len(value.label) + len(value.value) + 4) / INPUT_CHARACTERS) for value in values)
    return math.ceil(lines / 3)


def write_summary(record: StudyRecord, figures: Mapping[str, Path], path: Path) -> None:
    """Write the summary as one HTML file that holds its figures; one page, two for a rotor that tilts.

    Parameters
    ----------
    record : the study
    figures : title and file (SVG or PNG) of each figure, in the order of the page
    path : the file to write or replace

    Raises
    ------
    InputError : a figure that is neither SVG nor PNG
    """
    from jinja2 import Environment, StrictUndefined

    fields = [field for _, _, field in record.inputs]
    elsewhere = [a for a in record.assumed if not any(f == a or f.startswith(f"{a}.") for f in fields)]
    parts: dict[str, Any] = {
        "name": one_line(record.name),
        "source": one_line(record.source),
        "machine": machine(record),
        "inputs": inputs(record),
        "elsewhere": ", ".join(map(one_line, elsewhere)),
        "comparisons": comparisons(record),
        "facts": facts(record),
        "models": models(record),
        "remarks": remarks(record),
        "versions": versions(),
        "digest": record.digest,
        "figures": [(title, _embedded(file)) for title, file in figures.items()],
    }
    texts = [parts["name"] * 2, parts["source"] + parts["machine"], parts["elsewhere"], *parts["remarks"]]
    texts += [text for _, _, text in parts["models"]]
    rows = len(parts["comparisons"]) + len(parts["facts"]) // 2 + _input_rows(parts["inputs"]) + 9
    # What a rotor that tilts has to say leaves no room for figures: they stand on a second page.
    height = _figure_height(texts, rows) if record.motion is None else TALL
    page = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    template = resources.files("study").joinpath("templates", "summary.html.j2").read_text(encoding="utf-8")
    text = page.from_string(template).render(parts, figure_height=height, figure_columns=2)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _embedded(file: Path) -> str:
    """Address that holds the whole picture."""
    if file.suffix not in IMAGE_TYPES:
        raise InputError("figures", str(file), " or ".join(IMAGE_TYPES))
    content = base64.b64encode(file.read_bytes()).decode("ascii")
    return f"data:{IMAGE_TYPES[file.suffix]};base64,{content}"
