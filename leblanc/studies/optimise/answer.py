"""What `optimise` answers: the best volumes of a scene's chambers and what they were chosen from."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from fluid.friction.laws import Friction
from leblanc.core.answer import Answer
from leblanc.core.blocks import (
    Block,
    Cell,
    Check,
    Checks,
    Columns,
    Headline,
    Notes,
    Picture,
    Section,
    Table,
    Words,
    check,
)
from leblanc.core.netcdf import Variable, variable
from leblanc.core.notes import Note, texts
from leblanc.core.units import (
    LENGTH,
    MASS,
    ML,
    NOT_FOUND,
    UNBALANCE,
    VOLUME,
    amplitudes_are,
    celsius,
    in_peak,
    in_rpm,
    number,
    over_rpm,
    unit_for,
    with_unit,
)
from leblanc.liquid.choice import ModelSpan
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies.loads.answer import load_table
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.words import amplitude_place, checks, of_models, quality_words, why
from leblanc.studies.sweep.answer import EmulatorError
from meshes.arrays import Array, Flags
from meshes.quantity import Q

_FIGURES = "leblanc.studies.optimise.figure"
_TRIED, _FRONT, _CONDITION = ("candidate",), ("front",), ("condition",)
_HEAT, _LOAD = ("temperature_step",), ("unbalance_step",)
_SIZES = "size of each of the rotor's unbalances"
_DIMENSIONS = {dimension.unit.replace("*", " "): dimension for dimension in (LENGTH, MASS, UNBALANCE)}
INFEASIBLE = "no volumes meet every constraint; these exceed them least"
_MODEL = (
    "The search takes one model for all volumes, the exact equilibrium unless the scene names another: a "
    "change of model within its tolerance would look like a better volume."
)
_RUN_UP = "The objective itself is evaluated by run-ups in time with this model."
LISTED, _POINTS = 7, 12  # conditions of a table, points of the front


@dataclass(frozen=True)
class ConstraintValue:
    """A constraint at what was found best."""

    limit: float  #: in the unit; the value must not be above the limit
    value: float
    satisfied: bool  #: it is not
    unit: str  #: of both, and what they are
    meaning: str


@dataclass(frozen=True, kw_only=True)
class Best(Answer):
    """What every search answers."""

    command = "optimise"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: tuple[str, ...]  #: values that no source gives
    digest: Annotated[str, Q(text="of the scene")]
    task: Optimisation
    unused: tuple[str, ...] = ()
    value: Annotated[float, Q(name="value of the objective, SI")]
    constraints: Annotated[dict[str, ConstraintValue], Q(text="what it must keep to, by name")]
    evaluations: Annotated[int, Q("1", "volumes, balls or layouts evaluated", data=False)]

    @property
    def feasible(self) -> Annotated[bool, Q(name="every constraint is met")]:
        return not self.exceeded

    @property
    def exceeded(self) -> dict[str, ConstraintValue]:
        """Constraints that are not met, by name."""
        return {name: own for name, own in self.constraints.items() if not own.satisfied}

    def exceeded_words(self) -> str:
        """What is exceeded, and by how much."""
        return "; ".join(
            f"{what} {value}, at most {limit}"
            for what, value, limit in map(_constraint_words, self.exceeded, self.exceeded.values())
        )

    def constraint_table(self) -> Table:
        """Each constraint: what it is, value, limit, verdict."""
        rows = [
            (
                *_constraint_words(name, own),
                Cell("kept" if own.satisfied else "EXCEEDED", warning=not own.satisfied),
            )
            for name, own in self.constraints.items()
        ]
        return Table(rows, ("Constraint", "value", "at most", "verdict"))

    def exceeded_check(self) -> Check:
        names = ", ".join(name.replace("_", " ") for name in self.exceeded)
        return check("Constraints exceeded", names or "none", bool(names))


def about(scene: Scene, task: Optimisation) -> dict[str, Any]:
    """What every answer says of its scene."""
    names = "name", "source", "assumed", "digest"
    return {name: getattr(scene, name) for name in names} | {"task": task}


def _constraint_words(name: str, own: ConstraintValue) -> tuple[str, str, str]:
    value = shown(own.value, own.unit) if math.isfinite(own.value) else NOT_FOUND
    return f"{name.replace('_', ' ')}: {own.meaning}", value, shown(own.limit, own.unit)


def shown(value: float, unit: str) -> str:
    """A value in the unit that engineers use."""
    if unit in _DIMENSIONS:
        return with_unit(value, _DIMENSIONS[unit])
    if unit == "m/s":
        return f"{number(value * 1e3)} mm/s"
    return f"{number(value)} {unit}" if unit != "1" else number(value)


@dataclass(frozen=True)
class WettingVolumes:
    """Volumes of one chamber that wet its wall at a deflection and a speed, analytical."""

    deflection: float  #: e, m
    speed: float  #: rad/s
    #: the least that leaves no part of the wall dry over its whole height, m^3 [theory: statics, eq. 8]
    optimal_volume: float
    #: the least that wets the whole wall up to the lid, m^3; more liquid adds nothing, unless the surface has
    #: reached an inner wall [theory: statics, eq. 23]
    full_volume: float
    #: liquid's unbalance with the former over that with the latter
    unbalance_share: float


@dataclass(frozen=True)
class ParetoFront:
    """Points of which none is better than another in everything; m points of c chambers."""

    volume: Annotated[Array, Q("m3", "volume on the front", over=("front", "chamber"))]
    vibration: Annotated[Array, Q("m", "vibration on the front", "zero to peak", over=_FRONT)]
    mass: Annotated[Array, Q("kg", "mass of liquid on the front", over=_FRONT)]
    #: decay of the small whirl that decays slowest at the operating speeds; below 0 it grows
    stability_margin: Annotated[
        Array, Q("s-1", "stability margin on the front", over=_FRONT, variable="front_margin")
    ]


@dataclass(frozen=True)
class Candidates:
    """Sets of volumes that were evaluated; m of c chambers."""

    volume: Annotated[Array, Q("m3", "volume of liquid", over=("candidate", "chamber"))]
    objective: Array  #: in its unit, shape (m,)
    excess: Annotated[
        Array,
        Q("1", "excess", "of the constraint exceeded most; 0 or below: none is", over=_TRIED),
    ]
    vibration: Annotated[Array, Q("m", "vibration", "zero to peak", over=_TRIED)]
    mass: Annotated[Array, Q("kg", "mass", over=_TRIED)]
    exact: Annotated[
        Flags,
        Q(
            name="sure",
            text="else the vibration is an estimate from below",
            over=_TRIED,
            flags="no yes",
            key="sure",
        ),
    ]
    #: name of the constraint that is exceeded most, empty where all hold, one for each; none at all where
    #: that is not known
    exceeded: tuple[str, ...] = ()


@dataclass(frozen=True)
class EmulatedAnswer:
    """What an emulator says of the best volumes."""

    value: float  #: vibration and its standard deviation, m
    deviation: float
    error: EmulatorError  #: of the emulator on unseen samples


@dataclass(frozen=True)
class ConditionTable:
    """Amplitudes with the best volumes over temperature and unbalance; n conditions were evaluated.

    t temperatures and u steps of the unbalances from least to most, of p unbalances each.
    """

    #: a single nan where no range was given, shape (t,)
    temperature: Annotated[Array, Q("K", "temperature", over=_HEAT, variable="robust_temperature")]
    unbalance: Annotated[
        Array,
        Q("kg m", "unbalance", _SIZES, over=(*_LOAD, "rotor_unbalance"), variable="robust_unbalance"),
    ]
    amplitude: Annotated[
        Array,
        Q("m", "amplitude", "with the best volumes", over=(*_HEAT, *_LOAD), variable="robust_amplitude"),
    ]
    amplitude_dry: Annotated[
        Array, Q("m", "amplitude", "without liquid", over=_LOAD, variable="robust_amplitude_dry")
    ]
    #: of the small whirl that decays slowest at the operating speeds, which no unbalance changes
    stability_margin: Annotated[
        Array, Q("s-1", "stability margin", over=_HEAT, variable="robust_stability_margin")
    ]
    # Of the conditions that the volumes were chosen for.
    condition_temperature: Annotated[Array, Q("K", "temperature", over=_CONDITION)]
    condition_unbalance: Annotated[
        Array, Q("kg m", "unbalance", _SIZES, over=(*_CONDITION, "rotor_unbalance"))
    ]
    condition_amplitude: Annotated[Array, Q("m", "amplitude", "in a condition", over=_CONDITION)]
    condition_amplitude_dry: Annotated[Array, Q("m", "amplitude", "without liquid", over=_CONDITION)]
    quantile: Annotated[
        float, Q("1", name="quantile of the amplitudes that was to be small", text="1: the worst", data=False)
    ]
    decisive: int  #: the condition that has this amplitude

    @property
    def heated(self) -> bool:
        """Temperatures were given."""
        return not bool(np.isnan(self.temperature).any())

    @property
    def worst(self) -> Annotated[dict[str, Any], Q(text="the condition that decides")]:
        names = "temperature", "unbalance", "amplitude", "amplitude_dry"
        return {name: getattr(self, f"condition_{name}")[self.decisive] for name in names}

    def words(self) -> str:
        """The condition that decides."""
        worst, count = self.worst, self.condition_amplitude.size
        heat = f" and {celsius(float(worst['temperature']))}" if self.heated else ""
        what = "Worst" if self.quantile == 1.0 else f"{number(self.quantile)} quantile"
        wet, dry = (with_unit(float(worst[name]), LENGTH) for name in ("amplitude", "amplitude_dry"))
        load = load_words(worst["unbalance"].tolist())
        return f"{what} of {count} conditions: {wet} at {load}{heat} ({dry} without liquid)"

    def table(self) -> Table:
        """Amplitudes over some of the temperatures and unbalances."""
        length = unit_for(LENGTH, *self.amplitude.ravel().tolist(), *self.amplitude_dry.tolist())
        loads = [load_words(size) for size in self.unbalance.tolist()]
        dry, unit = [length.number(size) for size in self.amplitude_dry.tolist()], in_peak(length.name)
        rows: list[Sequence[str]]
        if self.heated:
            rows = [
                (
                    celsius(float(self.temperature[k])),
                    *(length.number(size) for size in self.amplitude[k].tolist()),
                    number(float(self.stability_margin[k])),
                )
                for k in _some(self.temperature.size)
            ]
            head = f"Amplitude ({unit})", *loads, "stability margin (1/s)"
            return Table([*rows, ("without liquid", *dry, "")], head, right=True)
        rows = [(loads[k], length.number(float(self.amplitude[0, k])), dry[k]) for k in _some(len(loads))]
        return Table(rows, ("Unbalance", f"amplitude ({unit})", f"without liquid ({unit})"), right=True)


def load_words(sizes: list[float]) -> str:
    """Unbalances in one unit."""
    unit = unit_for(UNBALANCE, *sizes)
    return f"{', '.join(map(unit.number, sizes))} {unit.name}"


def _some(count: int, most: int = LISTED) -> list[int]:
    """Places of a few lines of a long table, its ends among them."""
    return sorted(set(np.linspace(0, count - 1, most).round().astype(int).tolist()))


@dataclass(frozen=True)
class Poured:
    """Volumes near the best ones that a person measures out, and what they give."""

    volume: Annotated[Array, Q("m3", text="volumes", data=False)]
    value: Annotated[float, Q(name="value of the objective with them, SI")]
    feasible: Annotated[bool, Q(name="every constraint is met")]

    def words(self) -> str:
        """Volumes as a person writes them."""
        return " and ".join(with_unit(volume, VOLUME) for volume in self.volume.tolist())


@dataclass(frozen=True)
class CandidateChamber:
    """A chamber of the scene whose volume was looked for."""

    capacity: float  #: m^3
    liquid_name: str  #: as the scene names it


@dataclass(frozen=True, kw_only=True)
class OptimumAnswer(Best):
    """The best volumes of a scene and what they were chosen from; c chambers.

    Examples
    --------
    >>> import leblanc as lb
    >>> best = lb.optimise(lb.example("horizontal_rig"), front=False)
    >>> best.feasible, sorted(best.constraints), best.volume.shape
    (True, ['capacity', 'stability', 'wetting'], (2,))
    """

    title = "Best volume of liquid"
    data, page = "optimum.nc", "optimise.html"
    figure = f"{_FIGURES}:objective_figure"

    assumed: Annotated[tuple[str, ...], Q(text="values that no source gives")]
    chambers: tuple[CandidateChamber, ...]  #: whose volumes were looked for
    friction: Friction  #: of the liquid
    tolerance: float  #: relative error that the scene allows
    in_time: bool  #: the objective is evaluated by run-ups in time
    objective: Annotated[str, Q(text="what the volumes were chosen for")]
    meaning: Annotated[str, Q(text="what its value is")]
    unit: Annotated[str, Q(text="of its value")]
    working_speed: Annotated[float, Q("rad s-1", "working speed", data=False)]
    volume: Annotated[Array, Q("m3", "best volume", over=("chamber",), variable="best_volume")]
    baseline: Annotated[float, Q(name="value without liquid, SI")]
    #: the value itself unless that is a mass
    vibration: Annotated[float, Q("m", "vibration", "zero to peak", data=False)]
    vibration_baseline: Annotated[float, Q("m", "vibration without liquid", "zero to peak", data=False)]
    mass: Annotated[float, Q("kg", "mass of the liquid", data=False)]
    growth: float  #: of the fastest-growing small whirl at the operating speeds, 1/s
    #: for each chamber, at the deflection that the answer itself has; empty where it has none
    closed_form: Annotated[tuple[WettingVolumes, ...], Q(text="volumes that wet the walls, analytical")]
    #: of such volumes those with the least liquid are the answer
    equal_within: Annotated[
        float, Q("1", name="relative difference below which values count as equal", data=False)
    ]
    candidates: Annotated[Candidates, Q(part=True, json=False)]  #: all sets of volumes evaluated
    #: None if it was not computed
    front: Annotated[ParetoFront | None, Q(prefix="front", json=False)] = None
    #: from no liquid to the fullest chamber, shares as in the answer; None with the front
    sweep: ParetoFront | None = None
    notes: Annotated[tuple[Note, ...], Q(text="validity limits and findings")]
    #: of the machine with these volumes over the scene's speeds; None where the liquid model of the search
    #: gives no steady answer, or where it was not computed; its models are those of the search
    response: RunAnswer | None = None
    emulator: Annotated[
        EmulatedAnswer | None, Q(text="what the emulator of the search says", when="emulator")
    ] = None
    #: amplitudes over temperature and unbalance, for the objective of that name; None for any other
    robust: Annotated[
        ConditionTable | None,
        Q(text="amplitudes over temperature and unbalance", when="robust"),
        Q(part=True, json=False, key="conditions"),
    ] = None
    #: unbalance of rotor and liquid together over the rotor's mass times the working speed, and that of the
    #: rotor alone; None where this is not known
    balance_quality: Annotated[
        float | None,
        Q("m s-1", "balance quality", data=False, when="balance_quality", by="balance_quality, eq. 1"),
    ] = None
    balance_quality_dry: Annotated[
        float | None, Q("m s-1", "balance quality", "without liquid", data=False, when="balance_quality")
    ] = None
    #: from the keyboard; the answer is the best of what was tried until then
    interrupted: Annotated[bool, Q(name="ended before its time")] = False
    #: of the fewest digits that lose next to nothing; None where no liquid is best
    poured: Annotated[Poured | None, Q(text="best volumes rounded as a person pours them", when="poured")] = (
        None
    )
    #: a fifth more; None where the best volumes leave no wall dry in part when a little is missing
    with_margin: Annotated[
        Poured | None, Q(text="the same with a margin against a dry wall", when="with_margin")
    ] = None
    stopped: Annotated[str, Q(name="limit that ended the search", data=False)] = ""  #: likewise

    @property
    def candidate(self) -> Annotated[Array, Q("1", "candidate", over=_TRIED, json=False)]:
        return np.arange(self.candidates.mass.size, dtype=np.int32)

    @property
    def chamber(self) -> Annotated[Array, Q("1", "chamber", over=("chamber",), json=False)]:
        return np.arange(1, self.volume.size + 1, dtype=np.int32)

    @property
    def tried(self) -> Annotated[Variable, Q(text="its values", variable="objective", json=False)]:
        return variable(_TRIED, self.candidates.objective, self.unit, "objective", self.meaning)

    @property
    def stability_margin(
        self,
    ) -> Annotated[
        float, Q("s-1", "stability margin", "decay of the slowest small whirl, operating", data=False)
    ]:
        return -self.growth

    @property
    def pareto(self) -> Annotated[list[dict[str, Any]], Q(text="trade-off, point by point")]:
        """Empty if it was not computed."""
        names = ("volume", "vibration", "mass", "stability_margin")
        front = self.front
        count = 0 if front is None else front.mass.size
        return [{name: getattr(front, name)[k] for name in names} for k in range(count)]

    @property
    def models(self) -> tuple[ModelSpan, ...]:
        """Which liquid model the search took at the scene's speeds, and why."""
        return () if self.response is None else self.response.models

    @property
    def own(self) -> Mapping[str, Any]:
        found = {name: getattr(self, name) for name in ("objective", "meaning", "value", "baseline")}
        flags = {name: "yes" if getattr(self, name) else "no" for name in ("feasible", "interrupted")}
        return found | flags

    @property
    def faults(self) -> tuple[str, ...]:
        return () if self.feasible else (f"{INFEASIBLE} ({self.exceeded_words()})",)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.evaluations} sets of volumes evaluated"

    @property
    def place(self) -> str:
        """Plane of the amplitudes, in words; empty for a rotor that moves in one plane."""
        return "" if self.response is None else amplitude_place(self.response)

    def blocks(self) -> tuple[Block, ...]:
        return tuple(self._blocks())

    def _blocks(self) -> Iterator[Block]:
        at = f" {self.place}" if self.place and self.unit in ("m", "kg", "kg m") else ""
        about = f"Objective {self.objective}: the {self.meaning}{at}."
        yield Headline(f"{self._sentence()}{at}.", about, shown="both")
        if self.poured is not None:
            yield Words(self._poured(self.poured))
        if self.with_margin is not None:
            yield Words(self._margin(self.with_margin))
        yield Words(about, shown="text")
        yield self._volumes()
        chosen = self.volume if self.poured is None else self.poured.volume
        paste = ", ".join(f'"{volume * ML:.6g} ml"' for volume in chosen.tolist())
        yield Words(f"volume = {paste}", name="For the scene, chamber by chamber", code=True)
        yield Columns((self._values(), Table(tuple(self._facts()))), (Checks(self.checks(), head=_AT),))
        yield self.constraint_table()
        loads = None if self.response is None else self.response.loads
        if loads is not None:
            yield replace(load_table(loads), shown="page")
        if self.robust is not None:
            yield self.robust.table()
            yield Words(f"{self.robust.words()}.")
        if self.front is not None:
            yield self._trade_off(self.front)
        yield Notes(texts(self.notes))
        yield self._models()
        yield Section("Figures", tuple(self._pictures()), width="124mm", shown="page")

    def _sentence(self) -> str:
        """The best volumes and what they give."""
        volumes = " and ".join(with_unit(volume, VOLUME) for volume in self.volume.tolist())
        liquid = f"{volumes}, {with_unit(self.mass, MASS)}" if self.volume.any() else "no liquid"
        kept = "" if self.feasible else f" ({INFEASIBLE})"
        if self.unit == "kg":
            both = shown(self.vibration, "m"), shown(self.vibration_baseline, "m")
            return f"With {liquid}{kept}, the amplitude is {both[0]} instead of {both[1]}"
        instead = f" instead of {shown(self.baseline, self.unit)}" if self.baseline > 0.0 else ""
        return f"With {liquid}{kept}, the {self.meaning} is {shown(self.value, self.unit)}{instead}"

    def _poured(self, poured: Poured) -> str:
        """The rounded volumes, and what rounding costs."""
        value = shown(poured.value, self.unit)
        doubt = "" if poured.feasible or not self.feasible else ", beyond a constraint"
        return f"To pour: {poured.words()}, with which it is {value}{doubt}."

    def _margin(self, more: Poured) -> str:
        value, doubt = shown(more.value, self.unit), "" if more.feasible else ", beyond a constraint"
        return (
            "A little less leaves a wall dry in part; with a margin of a fifth: "
            f"{more.words()}, with which it is {value}{doubt}."
        )

    def _volumes(self) -> Table:
        """The answer chamber by chamber, with the analytical checks at the deflection it has."""
        forms, rows = self.closed_form, []
        liquid = unit_for(VOLUME, *self.volume.tolist(), *(form.optimal_volume for form in forms))
        length = unit_for(LENGTH, *(form.deflection for form in forms))
        for k, (chamber, volume) in enumerate(zip(self.chambers, self.volume.tolist(), strict=True)):
            row = [f"{k + 1}", liquid.number(volume), chamber.liquid_name]
            row.append(number(100.0 * volume / chamber.capacity))
            if forms:
                row += [length.number(forms[k].deflection), liquid.number(forms[k].optimal_volume)]
                row += [number(100.0 * forms[k].unbalance_share)]
                row += [liquid.number(forms[k].full_volume)]
            rows.append(row)
        head = ["Chamber", f"best volume ({liquid.name})", "liquid", "% of what it holds"]
        if forms:
            head += [f"deflection at {in_rpm(forms[0].speed)} ({length.name})"]
            head += [f"wetting volume ({liquid.name})", "% of the effect"]
            head += [f"wet to the lid ({liquid.name})"]
        return Table(rows, head)

    def _values(self) -> Table:
        """Objective, and vibration where that is another, with the best volumes and without liquid."""
        told = [("Objective", self.value, self.baseline, self.unit)]
        if self.unit == "kg":
            told.append(("Vibration", self.vibration, self.vibration_baseline, "m"))
        rows = []
        for label, value, baseline, unit in told:
            comparable = baseline > 0.0 and math.isfinite(value) and math.isfinite(baseline)
            ratio = number(value / baseline) if comparable else ""
            rows.append((label, shown(value, unit), shown(baseline, unit), ratio))
        return Table(rows, ("", "best volumes", "no liquid", "ratio"))

    def _facts(self) -> Iterator[tuple[str, str]]:
        yield amplitudes_are(self.place)
        yield "Working speed", in_rpm(self.working_speed)
        yield "Mass of the liquid", with_unit(self.mass, MASS)
        yield f"Stability margin {self._operating()}", f"{number(self.stability_margin)} 1/s"
        if self.balance_quality is not None and self.balance_quality_dry is not None:
            both = quality_words(self.balance_quality), quality_words(self.balance_quality_dry)
            yield f"Balance quality at {in_rpm(self.working_speed)}", "; without liquid ".join(both)
        yield "Sets of volumes evaluated", f"{self.evaluations}"
        if self.unit == "m":
            yield "Equal values", f"within {number(100.0 * self.equal_within)} %, of them the least liquid"

    def _operating(self) -> str:
        """Speeds at which the machine is used, in words."""
        if self.task.operating is not None:
            low, high = self.task.operating
        elif self.response is not None:
            low, high = self.response.speed.min(), self.response.speed.max()
        else:
            return "at the operating speeds"
        return over_rpm(float(low), float(high))

    def checks(self) -> list[Check]:
        """Where the answer is not what it seems: the volumes by themselves, and the machine with them."""
        lost = math.isnan(self.growth)
        grows = "not found" if lost else "yes" if self.growth > 0.0 else "no"
        found = [self.exceeded_check()]
        if self.interrupted:
            found.append(check("Interrupted", "see the notes", True))
        if self.stopped:
            found.append(check("Ended by a limit", self.stopped, True))
        found.append(
            check(f"A small whirl grows somewhere {self._operating()}", grows, lost or self.growth > 0.0)
        )
        # What is chosen for one speed is not touched by what happens on the way.
        at = (self.working_speed,) if self.objective == "working_speed" else None
        machine = [] if self.response is None else checks(self.response, at)
        return [*found, *machine]

    def _trade_off(self, edge: ParetoFront) -> Table:
        """A few points of which none is better than another in everything, by rising mass."""
        chosen = set(np.flatnonzero((edge.volume == self.volume).all(axis=1)).tolist())
        mass = unit_for(MASS, *edge.mass.tolist())
        liquid = unit_for(VOLUME, *edge.volume.ravel().tolist())
        size = unit_for(LENGTH, *edge.vibration.tolist())
        merged: dict[tuple[str, ...], set[int]] = {}  # points that read alike are listed once
        for k in range(edge.mass.size):
            row = (
                mass.number(float(edge.mass[k])),
                ", ".join(liquid.number(volume) for volume in edge.volume[k].tolist()),
                size.number(float(edge.vibration[k])),
                number(float(edge.stability_margin[k])),
            )
            merged.setdefault(row, set()).add(k)
        spread = _some(len(merged), _POINTS)
        rows = [
            (f"{first}{' (chosen)' if own & chosen else ''}", *rest)
            for k, ((first, *rest), own) in enumerate(merged.items())
            if k in spread or own & chosen
        ]
        of = f"Liquid ({mass.name}), {len(rows)} of {len(merged)} points"
        head = (of, f"volumes ({liquid.name})", f"vibration ({size.name})", "stability margin (1/s)")
        return Table(rows, head, title="Trade-off (Pareto front)", shown="page")

    def _models(self) -> Section:
        """Which liquid model answers at which speeds, how well, and why."""
        names = [span.model for span in self.models] + (["long_wave"] if self.in_time else [])
        reason = Words(f"{_MODEL} {_RUN_UP if self.in_time else ''}".strip(), small=True)
        section = of_models(names, why(self.models))
        return replace(section, blocks=(*section.blocks, reason))

    def _pictures(self) -> Iterator[Picture]:
        if self.candidates.mass.size > 2:
            yield Picture("objective", "Objective over the volumes", self.figure)
        if self.front is not None and self.front.mass.size > 1:
            yield Picture("front", "Vibration, liquid and stability", f"{_FIGURES}:front_figure")
        if self.robust is not None and self.robust.amplitude.size > 1:
            yield Picture("conditions", "Amplitude over the conditions", f"{_FIGURES}:conditions_figure")


_AT = "with the best volumes, at"
