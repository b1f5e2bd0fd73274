"""A scene in numbers, with the liquid model at each speed: what `explain` answers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Annotated

import numpy as np

from fluid.numbers import LayerNumbers
from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Section, Table, Words
from leblanc.core.netcdf import NamedArrays
from leblanc.core.notes import one_line, percent
from leblanc.core.units import LENGTH, RPM, TORQUE, VOLUME, in_rpm, number, over_rpm, with_unit
from leblanc.liquid.choice import KNOWN, HeldCost, ModelSpan, SpeedEstimate
from leblanc.studies.closed_forms.answer import ClosedForms, closed_form_table
from leblanc.studies.run.motion import RestMode
from leblanc.studies.run.words import described, error_words, speeds_words
from leblanc.studies.volume.answer import WallVolumes
from meshes.arrays import Array
from meshes.quantity import Q

Rows = list[tuple[str, str]]

_HZ = 60.0  # rpm in one hertz
_RATE = "rad s-1"


@dataclass(frozen=True)
class SpinUp:
    """How a smooth or rough wall carries the liquid of a chamber along [theory: friction, eq. 1-5]."""

    regime: str  #: laminar, transition or turbulent
    reynolds: float  #: of the flow against the wall, by the hydraulic diameter
    #: of that flow, rad/s: what the ramp asks of the wall, but no more than the whole last speed; that speed
    #: itself where there is no ramp
    lag: float
    ramp: bool  #: whether a ramp asks
    #: in which the lag comes down to a tenth at the last speed, the liquid being at rest in space, s
    time: float
    ramp_time: float | None  #: of the ramp, s; None without


@dataclass(frozen=True)
class BaffleOutlook:
    """Whether baffles carry a layer round on the ramp of a run-up, by their law [theory: baffles, eq. 4]."""

    speed: float  #: at which they can least, where the run-up finds a layer first, rad/s
    available: float  #: largest torque that they exert there before the liquid shoots over them, N m
    asked: float  #: torque that the ramp asks to take the liquid along, N m
    enough_from: float  #: speed above which they suffice, rad/s

    @property
    def left_behind(self) -> bool:
        """The ramp asks for more than they can."""
        return self.asked > self.available


@dataclass(frozen=True)
class LayerExplanation:
    """One chamber in numbers, at the first and the last speed where they change."""

    numbers: Annotated[LayerNumbers, Q(text="dimensionless", prefix="numbers")]
    depth: Annotated[float, Q("m", "depth", "mean, of the layer at fast spin", variable="depth")]
    added_mass_ratio: Annotated[
        float, Q("1", "added mass ratio", "full chamber over rotor, m_f/M", variable="added_mass_ratio")
    ]
    liquid_mass_ratio: Annotated[
        float, Q("1", "liquid mass ratio", "liquid over rotor", variable="liquid_mass_ratio")
    ]
    #: nan where baffles cut the liquid or the section is no circle
    optimal_volume: Annotated[
        float,
        Q(
            *("m3", "optimal volume", "wets the wall at the deflection without liquid at the last speed"),
            variable="optimal_volume",
        ),
    ]
    #: empty for a plain ring
    walls: Annotated[str, Q(text="baffles, or the file of the section, in words")] = ""
    #: inf where they never do; None if the axis stands, or the section is no circle
    carried_from: Annotated[
        float | None,
        Q(
            _RATE,
            "annulus from rest above",
            "the walls drag the liquid round from rest",
            variable="carried_from",
        ),
    ] = None
    #: None under another law of friction, and where it does not know the walls
    spin_up: Annotated[SpinUp | None, Q(text="by the law of the wall")] = None
    #: None without baffles or ramp, and for baffles that part the liquid
    carrying: Annotated[BaffleOutlook | None, Q(text="what the baffles can do on the ramp of the run-up")] = (
        None
    )


@dataclass(frozen=True)
class WhirlOutlook:
    """How large a self-excited whirl may grow, by rule and not by solving for it [theory: whirl, eq. 29]."""

    #: the middle of the band of self-excited whirl that has the largest one
    speed: Annotated[float, Q(_RATE, "spin speed", "by rule", variable="whirl_spin")]
    #: of the axis at the chambers there; mostly within a factor of 1.5
    amplitude: Annotated[float, Q("m", "amplitude", "by rule")]
    whirl_speed: Annotated[float, Q(_RATE, "whirl speed", "by rule, in space", variable="whirl_speed")]
    lag: Annotated[float, Q(_RATE, "slip speed of the liquid", "by rule, behind the drum")]


@dataclass(frozen=True)
class Cure:
    """A change of a machine, and the bands of self-excited whirl with it over the machine's speeds."""

    kind: Annotated[str, Q(text="less or more liquid, viscosity, walls, twice the damping, damping")]
    #: m^3, m^2/s, number of walls, damping ratio; nan where none of those tried does it
    value: Annotated[float, Q(text="what it takes, SI")]
    bands: Annotated[tuple[tuple[float, float], ...], Q("rad s-1", text="bands that are left", data=False)]
    text: Annotated[str, Q(text="in words")]


class Explained(Answer):
    """Base of what `explain` answers of machines with liquid or balls."""

    command = "explain"

    def named_arrays(self) -> NamedArrays:
        """Closed forms are reported at every speed, the coordinate is the ends of the scene's range."""
        found = super().named_arrays()
        moved = {
            name: replace(each, dims=tuple("at" if dim == "speed" else dim for dim in each.dims))
            for name, each in found.variables.items()
        }
        return replace(found, variables=moved)


@dataclass(frozen=True)
class ExplainAnswer(Explained):
    """A scene in numbers.

    Examples
    --------
    >>> import leblanc as lb
    >>> explanation = lb.explain(lb.example("horizontal_rig"))
    >>> sorted({span.model for span in explanation.models})
    ['linear']
    """

    figure = "leblanc.studies.explain.figure:model_figure"

    name: Annotated[str, Q(text="of the scene")]
    #: of several the one at which the unbalance moves the axis most, of the next as well
    critical_speed_dry: Annotated[float, Q(_RATE, "critical speed without liquid")]
    #: at small deflections; nan without chambers
    critical_speed_wet: Annotated[float, Q(_RATE, "critical speed with liquid")]
    #: of several modes the one next to the critical speed without liquid, at that speed
    damping_ratio: Annotated[float, Q("1", "damping ratio", "of the support")]
    speed_ratio: Annotated[
        tuple[float, float], Q("1", "first and last speed over the critical speed without liquid", data=False)
    ]
    #: None if at every speed
    captured_from: Annotated[
        float | None,
        Q(_RATE, "centrifuging speed", "the liquid rides with the drum", variable="capture_speed"),
    ]
    layers: Annotated[
        tuple[LayerExplanation | None, ...], Q(text="of each chamber, none of an empty one", rows="chamber")
    ]
    models: Annotated[
        tuple[ModelSpan, ...], Q(text="model at each speed, how well it answers, and why", rows="span")
    ]
    tolerance: Annotated[float, Q("1", "tolerance", "relative error that is allowed")]
    #: none for a planar rotor, whose only one is the critical speed
    modes: Annotated[tuple[RestMode, ...], Q(text="of the rotor without liquid at rest")] = ()
    #: empty without one
    runup: Annotated[str, Q(text="which liquid model the run-up will take")] = ""
    #: None where none does, or nothing bounds it
    whirl: Annotated[WhirlOutlook | None, Q(text="size of the self-excited whirl", prefix="whirl")] = None
    #: of a planar rotor; empty where none grows
    cures: Annotated[
        tuple[Cure, ...], Q(text="what would end the self-excited whirl", rows="cure", when="cures")
    ] = ()
    #: None where steady models answer all
    held: Annotated[
        HeldCost | None, Q(text="cost of what steady models do not answer", prefix="held", data=False)
    ] = None
    estimates: Annotated[tuple[SpeedEstimate, ...], Q(text="what is expected at every speed", rows="at")] = ()
    source: str = ""  #: of the scene
    assumed: tuple[str, ...] = ()
    digest: str = ""
    #: at which the surface meets an edge of a chamber, for the deflection without liquid
    wall_volumes: Annotated[WallVolumes | None, Q(part=True)] = None
    #: analytical checks of the sources, without an answer
    closed_forms: Annotated[ClosedForms, Q(part=True)] = field(default_factory=ClosedForms)

    @property
    def speed(
        self,
    ) -> Annotated[
        Array, Q(_RATE, "spin speed", "first and last of the scene", ("end",), json=False, coordinate=True)
    ]:
        return np.array(self.speed_ratio) * self.critical_speed_dry

    @property
    def held_speeds(self) -> Annotated[int, Q("1", "speeds to hold in time", json=False)]:
        return 0 if self.held is None else self.held.speeds

    @property
    def held_seconds(
        self,
    ) -> Annotated[
        float,
        Q("s", "processor time to hold them", "good to a factor of two", by="held, eq. 11-13", json=False),
    ]:
        return 0.0 if self.held is None else self.held.seconds

    @property
    def not_told(
        self,
    ) -> Annotated[tuple[str, ...], Q(text="analytical checks for which the scene lacks values")]:
        return self.closed_forms.lacking

    #: what is printed: every number and why each model answers, or the main ones in twelve lines
    full: bool = True

    def blocks(self) -> tuple[Block, ...]:
        said = described_blocks(self) if self.full else short_blocks(self)
        return Table(facts(self), shown="page"), Section("", said, shown="text")


_CHAMBERS, _SPANS = 2, 4  # rows of each kind among twelve lines


def short_blocks(answer: ExplainAnswer) -> list[Block]:
    """The main numbers, a line each."""
    first, last = answer.speed_ratio
    dry = answer.critical_speed_dry
    rows = machine_rows(answer)[:2]
    if math.isfinite(dry):
        wet = f", {in_rpm(answer.critical_speed_wet)} with the liquid" if answer.layers else ""
        spread = f"speeds {first:.3g} to {last:.3g} times that"
        rows = [("critical speed", f"{in_rpm(dry)}{wet}; {spread}")]
        rows.append(("damping ratio", f"{answer.damping_ratio:.4g} of the support"))
    for k, layer in enumerate(answer.layers[:_CHAMBERS]):
        left = len(answer.layers) - _CHAMBERS
        more = f"; {left} more" if left > 0 and k == _CHAMBERS - 1 else ""
        rows.append((f"chamber {k + 1}", f"{_short_layer(answer, k, layer)}{more}"))
    if answer.captured_from is not None:
        rows.append(("annular layer", f"above {in_rpm(answer.captured_from)}; gravity dominates below"))
    if answer.whirl is not None:
        size, speed = with_unit(answer.whirl.amplitude, LENGTH), in_rpm(answer.whirl.speed)
        rows.append(("whirl", f"excites itself, to about {size} at {speed} (`leblanc map --cycles`)"))
    spans = answer.models
    rows += [_short_span(span) for span in spans[:_SPANS]]
    if len(spans) > _SPANS:
        rows.append(("", f"and {len(spans) - _SPANS} more ranges of speed"))
    if answer.held is not None:
        cost = f"{answer.held.speeds} speeds, {answer.held.words}"
        rows.append(("in time", f"{cost}: no steady model is good enough there"))
    told = Words("Every number, and why each model answers: leblanc explain --full")
    return [Words(answer.name), Table(rows, indent=2), told]


def _short_layer(answer: ExplainAnswer, chamber: int, layer: LayerExplanation | None) -> str:
    """One chamber on a line."""
    if layer is None:
        return "empty"
    added = f"adds {layer.added_mass_ratio:.3g} of the mass"
    text = f"{100.0 * layer.numbers.fill:.3g} % full, {with_unit(layer.depth, LENGTH)} deep, {added}"
    found = answer.wall_volumes
    if found is None or not np.isfinite(found.wetting_volume[chamber, -1]):
        return text
    wet = with_unit(float(found.wetting_volume[chamber, -1]), VOLUME)
    return f"{text}; {wet} wet it at {in_rpm(float(answer.speed[-1]))}"


def _short_span(span: ModelSpan) -> tuple[str, str]:
    """The model of a range of speeds, and how far it is right."""
    beyond = ", out of range" if not span.in_range else ""
    return f"{speeds_words(span)} rpm", f"{span.model}{beyond}, error {error_words(span)}"


def described_blocks(answer: ExplainAnswer) -> list[Block]:
    """The explanation as text; of the liquid only where there is any."""
    found: list[Block] = [Words(answer.name), Table(machine_rows(answer), indent=2)]
    if answer.cures:
        rows = [(cure.kind, cure.text) for cure in answer.cures]
        found += [Words("what would end the self-excited whirl, each alone"), Table(rows, indent=2)]
    if answer.modes:
        found += [
            Words("natural frequencies at rest, without liquid"),
            Table(mode_rows(answer.modes), indent=2),
        ]
    for k, layer in enumerate(answer.layers):
        rows = layer_rows(layer, own_model_of(answer)) + ([] if layer is None else volume_rows(answer, k))
        found += [Words(f"chamber {k + 1}"), Table(rows, indent=2)]
    if answer.models:
        found.append(Words(f"liquid model, with a tolerance of {percent(answer.tolerance)}"))
    for span in answer.models:
        beyond = "" if span.in_range else " (out of range)"
        rows = [("estimated error", error_words(span)), ("why", span.reason), ("next better", span.better)]
        found += [Words(f"  {speeds_words(span)} rpm: {span.model}{beyond}"), Table(rows, indent=4)]
    if estimates := estimate_rows(answer):
        found += [
            Words("  estimated: error of the means, ripple about them once a turn by gravity"),
            Table(estimates, ESTIMATES, indent=4),
        ]
    if answer.models:
        found.append(Table(described(span.model for span in answer.models), indent=2))
    told = [*closed_form_table(answer.closed_forms).rows]
    told += [("not reported", text) for text in answer.closed_forms.lacking]
    if told:
        found += [Words("analytical checks"), Table(told, indent=2)]
    if answer.runup:
        found += [Words("liquid model of the run-up"), Table([(answer.runup,)], indent=2)]
    return found


def own_model_of(answer: ExplainAnswer) -> str:
    """Name of the model of one's own that answers; empty where a built-in one does."""
    return next((span.model for span in answer.models if span.model not in KNOWN), "")


def machine_rows(answer: ExplainAnswer) -> Rows:
    """The rotor as a whole; label and text."""
    dry, wet = (in_rpm(speed) for speed in (answer.critical_speed_dry, answer.critical_speed_wet))
    beside = f", {wet} with it at small deflections" if answer.layers else ""
    first, last = answer.speed_ratio
    rows = [
        ("critical speed", f"{dry} without liquid{beside}"),
        ("damping ratio", f"{answer.damping_ratio:.4g}"),
        ("speeds", f"{first:.3g} to {last:.3g} times the critical speed without liquid"),
    ]
    if math.isnan(answer.critical_speed_dry):
        free = [mode.moves for mode in answer.modes if mode.frequency == 0.0]
        rows = [
            ("free to move", f"{len(free)} motions that nothing holds: {', '.join(free)}"),
            ("critical speed", "none is given: the axis moves freely, and `leblanc run` refuses the machine"),
        ]
    if answer.captured_from is not None:
        captured = f"exists above {in_rpm(answer.captured_from)}; gravity dominates below"
        rows.append(("annular layer", captured))
    if answer.whirl is not None:
        size, speed = with_unit(answer.whirl.amplitude, LENGTH), in_rpm(answer.whirl.speed)
        turning = in_rpm(answer.whirl.whirl_speed)
        text = f"self-excited, about {size} at {speed}, the middle of its band, turning at {turning}"
        rows.append(("whirl", f"{text}: an estimate, see `map --cycles`"))
    if own := own_model_of(answer):
        text = f"not estimated: the rule is that of an even layer, not of {own}; `run` and `map` ask it"
        rows.append(("whirl", text))
    if answer.held is not None:
        rows.append(("integrated in time", _held_words(answer.held, answer.tolerance)))
    return rows


def _held_words(held: HeldCost, tolerance: float) -> str:
    """Steps of time-domain states, and why they are computed."""
    where = f"{held.speeds} speeds {over_rpm(held.first, held.last)}, {held.words}, good to a factor of two"
    if held.asked:
        return f"{where}; the cores share it"
    why = f"no steady model is within {percent(tolerance)} there, or whirl is self-excited"
    return f'{where}, with [model] held = "auto": {why}'


def mode_rows(modes: tuple[RestMode, ...]) -> Rows:
    """Natural frequencies at rest; frequency and text."""
    return [
        (
            f"{number(mode.frequency * RPM / _HZ)} Hz",
            f"{in_rpm(mode.frequency)}, damping ratio {mode.damping_ratio:.3g}: {mode.moves}",
        )
        for mode in modes
    ]


def layer_rows(layer: LayerExplanation | None, own: str = "") -> Rows:
    """One chamber, its liquid by a model of one's own where one is named; label and text."""
    if layer is None:
        return [("fill", "empty")]
    n = layer.numbers
    steepness = f"{_ends(n.steepness)}: rise of the surface over the radius in chamber heights"
    if math.isinf(n.steepness[0]):
        steepness = "a cylinder: no gravity along the axis"
    added = f"{layer.added_mass_ratio:.4g} of the rotor's mass while the wall is wet"
    if own:
        added = f"as {own} has it, not that of an even layer"
    return [
        *([("walls", layer.walls)] if layer.walls else []),
        *([("baffles' torque", carrying_words(layer.carrying))] if layer.carrying else []),
        ("fill", f"{n.fill:.4g} of the capacity"),
        ("layer at fast spin", f"{with_unit(layer.depth, LENGTH)} deep, h0/R = {n.relative_depth:.4g}"),
        ("curvature", f"kappa = {n.curvature:.5g}"),
        ("added mass", added),
        ("mass of the liquid", f"{layer.liquid_mass_ratio:.4g} of the rotor's mass"),
        ("centrifuge number", f"{_ends(n.centrifuge)}: acceleration at the surface over gravity"),
        ("steepness", steepness),
        ("Reynolds number", _ends(n.reynolds)),
        ("wall layer", f"{_ends(n.skin)} of the depth"),
        *(_spin_up_rows(layer.spin_up) if layer.spin_up is not None else []),
        *([] if layer.carried_from is None else [("spin-up from rest", _carried(layer.carried_from))]),
    ]


def volume_rows(answer: ExplainAnswer, chamber: int) -> Rows:
    """Volumes that meet an edge of a chamber at its deflection without liquid, first to last speed."""
    found = answer.wall_volumes
    if found is None or not np.isfinite(found.full_volume[chamber]).any():
        return [("wetting volume", "not known for such a chamber")]
    wet, lid, full = (each[chamber] for each in (found.wetting_volume, found.lid_volume, found.full_volume))
    at = "at the deflection without liquid"
    if np.array_equal(wet, full, equal_nan=True):
        touched = "the inner wall"
        rows = [("wetting volume", f"{_first_to_last(full)} {at}: wets the wall; more adds nothing")]
    else:
        touched = "the lid, or the inner wall"
        rows = [
            ("wetting volume", f"{_first_to_last(wet)} {at}: wets the wall all round at the floor"),
            ("full volume", f"{_first_to_last(full)}: wets it up to the lid; more adds nothing"),
        ]
    if np.isfinite(lid).any():
        rows.append(("lid volume", f"{_first_to_last(lid)}: touches {touched}"))
    return rows


_LEAST = 1e-9  # m^3, below which a volume is no amount


def _first_to_last(volume: Array) -> str:
    """From the first speed to the last."""
    first, last = (
        with_unit(each, VOLUME) if each >= _LEAST else f"under {with_unit(_LEAST, VOLUME)}"
        for each in (float(volume[0]), float(volume[-1]))
    )
    return f"{first} to {last}"


def _carried(speed: float) -> str:
    """From where on liquid at the bottom becomes a ring, in words."""
    if math.isinf(speed):
        return "never: no friction acts on it"
    return (
        f"a ring forms from about {in_rpm(speed)} on, held there: slow run-ups do it at 0.6 to 1.6 times that"
    )


def _spin_up_rows(found: SpinUp) -> Rows:
    """How the wall carries the liquid along."""
    asked = "that the ramp asks of the wall" if found.ramp else "of liquid at rest in space at the last speed"
    flow = f"{found.regime}, Re = {number(found.reynolds)} with a lag of {in_rpm(found.lag)}, {asked}"
    if math.isinf(found.time):
        return [("flow at the wall", flow), ("spun up", "never: nothing drags on the liquid")]
    carried = f"to a tenth of its lag in {number(found.time)} s at the last speed, without gravity"
    if found.ramp_time is not None:
        slow = found.time > found.ramp_time
        carried += f"; the ramp takes {number(found.ramp_time)} s: the liquid " + (
            "stays behind" if slow else "can follow"
        )
    return [("flow at the wall", flow), ("spun up", carried)]


def carrying_words(found: BaffleOutlook) -> str:
    """Torque that the baffles can exert against what the ramp asks."""
    able = f"{with_unit(found.available, TORQUE)} at {in_rpm(found.speed)}"
    text = f"the ramp asks for {with_unit(found.asked, TORQUE)}, they can {able}"
    if not found.left_behind:
        return text
    return f"{text}: the liquid slips up to {in_rpm(found.enough_from)}"


_SHOWN = 9  # speeds in the table of estimates


def estimate_rows(answer: ExplainAnswer) -> list[tuple[str, ...]]:
    """What is expected at some of the speeds, as `ESTIMATES` heads it; none where no gravity lies across."""
    every = answer.estimates
    if not any(each.liquid_ripple != 0.0 for each in every):
        return []
    picked = {round(k * (len(every) - 1) / (_SHOWN - 1)) for k in range(_SHOWN)}
    return [_estimate_row(every[k]) for k in sorted(picked)]


ESTIMATES = "speed (rpm)", "model", "mean", "liquid's mean", "ripple", "liquid's ripple"


def _estimate_row(each: SpeedEstimate) -> tuple[str, ...]:
    if not each.in_range:
        return number(each.speed * RPM), each.model, "not carried", "", "", ""
    shares = [_share(each.error), _share(each.liquid_error), _share(each.ripple)]
    return number(each.speed * RPM), each.model, *shares, with_unit(each.liquid_ripple, LENGTH)


def _share(value: float) -> str:
    if math.isnan(value):
        return "not known"
    return percent(value) if math.isfinite(value) else "no bound"


def facts(answer: ExplainAnswer) -> Rows:
    """Main numbers of a scene: label and value."""
    spans = [(f"{speeds_words(span)} rpm", f"{span.model}, {error_words(span)}") for span in answer.models]
    return [("Scene", one_line(answer.name)), *machine_rows(answer), *spans]


def _ends(values: Array) -> str:
    """From the first speed to the last."""
    return f"{number(float(values[0]))} to {number(float(values[1]))}"
