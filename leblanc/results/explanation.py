"""A scene in numbers, with the liquid model at each speed."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fluid.numbers import LayerNumbers
from leblanc.core.answer import Result, attributes, carried
from leblanc.core.netcdf import NamedArrays, Variable, flags
from leblanc.core.netcdf import variable as var
from leblanc.core.quantities import named_arrays, plain, to_json
from leblanc.results.choice import HeldCost, ModelSpan, SpeedEstimate
from leblanc.studies.closed_forms.answer import ClosedForms
from leblanc.studies.run.motion import RestMode

if TYPE_CHECKING:
    pass


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

    numbers: LayerNumbers  #: dimensionless numbers, shape (2,) where they depend on speed
    depth: float  #: mean depth of the layer at fast spin, m
    added_mass_ratio: float  #: mass of a full chamber over the rotor's, m_f/M
    liquid_mass_ratio: float  #: mass of the liquid over the rotor's
    #: that just covers the wall at the dry rotor's deflection at the last speed, m^3; nan where baffles cut
    #: the liquid or the section is no circle
    optimal_volume: float
    walls: str = ""  #: baffles, or the file of the section, in words; empty for a plain ring
    #: speed from which the walls carry the liquid round from rest, rad/s, inf where they never do; None if
    #: the axis stands, or the section is no circle
    carried_from: float | None = None
    #: by the law of the wall; None under another law of friction, and where it does not know the walls
    spin_up: SpinUp | None = None
    #: what the baffles can do on the ramp of the run-up; None without one of both, and for baffles that part
    #: the liquid
    carrying: BaffleOutlook | None = None


@dataclass(frozen=True)
class WhirlOutlook:
    """How large a self-excited whirl may grow, by rule and not by solving for it [theory: whirl, eq. 29]."""

    speed: float  #: spin speed, the middle of the band of self-excited whirl that has the largest one, rad/s
    #: of the axis at the chambers there, m; mostly within a factor of 1.5
    amplitude: float
    whirl_speed: float  #: in space, rad/s
    lag: float  #: of the liquid behind the drum, rad/s


# Of the scene, not part of the JSON, and what has keys of its own there.
_ABOUT = ("source", "assumed", "digest", "closed_forms")


@dataclass(frozen=True)
class Explanation(Result):
    """A scene in numbers.

    Examples
    --------
    >>> import leblanc as lb
    >>> explanation = lb.explain(lb.example("horizontal_rig"))
    >>> sorted({span.model for span in explanation.models})
    ['linear']
    """

    figure: ClassVar[str] = "leblanc.figures.explanation:model_figure"
    summary: ClassVar[str] = "leblanc.text.explanation:facts"

    name: str  #: of the scene
    #: without liquid, and with it at small deflections, rad/s; of several the one at which the unbalance
    #: moves the axis most
    critical_speed_dry: float
    critical_speed_wet: float
    #: of the support; of several modes the one next to the dry critical speed, at that speed
    damping_ratio: float
    speed_ratio: tuple[float, float]  #: first and last speed over the dry critical speed
    #: speed above which the liquid rides with the drum, rad/s; None if at every speed
    captured_from: float | None
    layers: tuple[LayerExplanation | None, ...]  #: one for each chamber; None for an empty one
    models: tuple[ModelSpan, ...]  #: which model answers at each speed, how well, and why
    tolerance: float  #: relative error that the scene allows
    #: of the dry rotor at rest; none for a planar rotor, whose only one is the critical speed
    modes: tuple[RestMode, ...] = ()
    runup: str = ""  #: which liquid model the run-up will take, in words; empty without one
    #: how large the whirl grows by itself; None where none does, or nothing bounds it
    whirl: WhirlOutlook | None = None
    #: what it takes to hold in time what steady models do not answer; None where they answer all
    held: HeldCost | None = None
    estimates: tuple[SpeedEstimate, ...] = ()  #: what is expected at every speed
    source: str = ""  #: of the scene
    assumed: tuple[str, ...] = ()
    digest: str = ""
    #: what the sources' closed forms say of it without an answer, and what it lacks for them
    closed_forms: ClosedForms = field(default_factory=ClosedForms)

    upright = carried("closed_forms.upright")
    balancing = carried("closed_forms.balancing")
    cage_speed = carried("closed_forms.cage_speed")
    not_told = carried("closed_forms.lacking")

    def to_json(self) -> dict[str, Any]:
        """What `explain` prints for scripts, SI; null for what is not finite."""
        own = {name: value for name, value in asdict(self).items() if name not in _ABOUT}
        if not self.layers:
            own["critical_speed_wet"] = None
        answer: dict[str, Any] = plain(
            {**own, **to_json(self.closed_forms), "not_told": list(self.closed_forms.lacking)}
        )
        return answer

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `chamber`, `end` (first and last speed) and `span` (of one model)."""
        rate, span = "rad s-1", ("span",)
        ends = np.array(self.speed_ratio) * self.critical_speed_dry
        captured = math.nan if self.captured_from is None else self.captured_from
        spans = {
            each.name: np.array([getattr(span, each.name) for span in self.models])
            for each in fields(ModelSpan)
        }
        return NamedArrays(
            {
                "critical_speed_dry": var((), self.critical_speed_dry, rate, "critical speed without liquid"),
                "critical_speed_wet": var((), self.critical_speed_wet, rate, "critical speed with liquid"),
                "damping_ratio": var((), self.damping_ratio, "1", "damping ratio", "of the support"),
                "capture_speed": var((), captured, rate, "capture speed", "the liquid rides with the drum"),
                **_whirl_variables(self.whirl),
                **_held_variables(self.held),
                "tolerance": var((), self.tolerance, "1", "tolerance", "relative error that is allowed"),
                "first": var(span, spans["first"], rate, "first speed of a liquid model"),
                "last": var(span, spans["last"], rate, "last speed of a liquid model"),
                "model": var(span, spans["model"], "1", "liquid model"),
                "in_range": flags(span, spans["in_range"], "no yes", "the model holds there"),
                "error": var(span, spans["error"], "1", "estimated error", "largest, relative"),
                "reason": var(span, spans["reason"], "1", "why that model"),
                **_layer_variables(self.layers),
                **_estimate_variables(self.estimates),
                **_at(self.closed_forms),
            },
            coords={"speed": var(("end",), ends, rate, "spin speed", "first and last of the scene")},
            attrs=attributes(self, "explain", {}, ()),
        )


def _whirl_variables(whirl: WhirlOutlook | None) -> dict[str, Variable]:
    """The estimate of the self-excited whirl, nan where there is none."""
    parts = {
        "whirl_spin": ("speed", "rad s-1", "spin speed"),
        "whirl_amplitude": ("amplitude", "m", "amplitude"),
        "whirl_speed": ("whirl_speed", "rad s-1", "whirl speed"),
        "whirl_lag": ("lag", "rad s-1", "lag of the liquid"),
    }
    return {
        name: var((), math.nan if whirl is None else getattr(whirl, own), unit, words, "by rule")
        for name, (own, unit, words) in parts.items()
    }


def _held_variables(held: HeldCost | None) -> dict[str, Variable]:
    """What motions held in time take, none where there are none."""
    count, seconds = (0, 0.0) if held is None else (held.speeds, held.seconds)
    return {
        "held_speeds": var((), count, "1", "speeds to hold in time"),
        "held_seconds": var((), seconds, "s", "processor time to hold them", "good to a factor of two"),
    }


def _estimate_variables(estimates: tuple[SpeedEstimate, ...]) -> dict[str, Variable]:
    """What is expected at every speed."""
    parts = {
        "speed": ("rad s-1", "spin speed"),
        "error": ("1", "estimated error of the mean amplitude"),
        "liquid_error": ("1", "estimated error of the liquid's mean offset"),
        "ripple": ("1", "estimated ripple of the amplitude"),
        "liquid_ripple": ("m", "estimated ripple of the liquid's centre of mass"),
    }
    return {
        f"at_{name}": var(("at",), np.array([getattr(each, name) for each in estimates]), unit, words)
        for name, (unit, words) in parts.items()
    }


def _or_nan(value: float | None) -> float:
    """A number for an array."""
    return math.nan if value is None else value


def _layer_variables(layers: tuple[LayerExplanation | None, ...]) -> dict[str, Variable]:
    """Numbers of every chamber, nan for an empty one."""
    units = {"depth": "m", "optimal_volume": "m3", "added_mass_ratio": "1", "liquid_mass_ratio": "1"}
    units["carried_from"] = "rad s-1"
    found = {
        name: var(
            ("chamber",),
            np.array([_or_nan(None if layer is None else getattr(layer, name)) for layer in layers]),
            unit,
            name.replace("_", " "),
        )
        for name, unit in units.items()
    }
    for each in fields(LayerNumbers):
        values = [
            np.full(2, math.nan) if layer is None else np.broadcast_to(getattr(layer.numbers, each.name), 2)
            for layer in layers
        ]
        table = np.array(values, dtype=float).reshape(-1, 2)
        found[each.name] = var(("chamber", "end"), table, "1", each.name.replace("_", " "))
    return found


def _at(forms: ClosedForms) -> dict[str, Variable]:
    """Variables of closed forms over the speeds of an explanation."""
    return {
        name: Variable(tuple("at" if dim == "speed" else dim for dim in each.dims), each.values, each.attrs)
        for name, each in named_arrays(forms).arrays.items()
    }
