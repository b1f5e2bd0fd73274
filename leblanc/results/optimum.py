"""The best volumes of a scene's chambers and what they were chosen from."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any

import numpy as np

from fluid.friction.laws import Friction
from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays, Variable, flags
from leblanc.core.netcdf import variable as var
from leblanc.core.notes import Note, NoteCode, texts
from leblanc.core.units import LENGTH, VOLUME, in_rpm, with_unit
from leblanc.results.base import ConstraintValue
from leblanc.results.choice import ModelSpan
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.sweep.answer import EmulatorError
from meshes.arrays import Array, Flags


class Feasibility(Enum):
    """Whether some volumes meet every constraint, and what that means."""

    FEASIBLE = "every constraint is met"
    INFEASIBLE = "no volumes meet every constraint; these exceed them least"


class OptimumCode(NoteCode):
    """What the notes of an optimum say."""

    GIVEN_DEFLECTION = "given_deflection"
    FEW_CELLS = "few_cells"
    NO_DUTY = "no_duty"
    NO_LIMIT = "no_limit"
    NO_RANGE = "no_range"
    TOO_DEEP = "too_deep"
    EMULATED = "emulated"
    LAMINAR = "laminar"
    NO_LIQUID = "no_liquid"
    INTERRUPTED = "interrupted"
    PARTED = "parted"


def given_deflection(deflection: float, speed: float, gap: float) -> Note:
    """The volumes are the least that wet the walls at a deflection, m, and a speed, rad/s.

    `gap` is the largest relative difference of search and closed form.
    """
    text = (
        f"The deflection is given, {with_unit(deflection, LENGTH)} at {in_rpm(speed)}: the volumes are the "
        "least that leave no part of a wall dry over its whole height; search and closed form differ by "
        f"{gap:.1e}."
    )
    data = {"deflection": deflection, "speed": speed, "gap": gap}
    return Note(OptimumCode.GIVEN_DEFLECTION, data, text)


def few_cells(few: int, all_of_them: int) -> Note:
    """The search ran run-ups on fewer cells than the scene's."""
    text = (
        f"The search ran the machine up with {few} cells round each wall; the best volumes were run "
        f"again with the scene's {all_of_them}."
    )
    return Note(OptimumCode.FEW_CELLS, {"cells": few, "scene_cells": all_of_them}, text)


def no_duty() -> Note:
    """The mean is over speeds that count alike."""
    text = "No duty cycle is given: the mean is over the scene's speeds, all alike."
    return Note(OptimumCode.NO_DUTY, {}, text)


def no_limit(limit: float) -> Note:
    """The vibration limit is one per cent above the least that is possible, m."""
    share = f"{with_unit(limit, LENGTH)}, one per cent above the least possible"
    text = f"No vibration limit is given: taken is {share}."
    return Note(OptimumCode.NO_LIMIT, {"limit": limit}, text)


def no_range() -> Note:
    """The unbalances are half to twice the scene's."""
    text = "No range is given: taken are unbalances from half to twice the scene's."
    return Note(OptimumCode.NO_RANGE, {}, text)


def too_deep(chamber: int, limit: float) -> Note:
    """The layer of a chamber, counted from 0, is deeper than a share of its radius."""
    text = f"Out of range: the layer in chamber {chamber + 1} is deeper than {limit:g} of its radius."
    return Note(OptimumCode.TOO_DEEP, {"chamber": chamber + 1, "limit": limit}, text)


def parted(chamber: int, count: int, volume: float) -> Note:
    """Baffles cut the liquid of a chamber into compartments up to some volume, m^3."""
    text = (
        f"Chamber {chamber + 1}: below {with_unit(volume, VOLUME)} its {count} baffles cut the liquid into "
        "compartments. There the steady answer is that of finite elements for small deflections, with an "
        "error that is not known."
    )
    return Note(OptimumCode.PARTED, {"chamber": chamber, "count": count, "volume": volume}, text)


def laminar() -> Note:
    """Small whirls are judged with a friction that the scene leaves out."""
    text = (
        "The scene has no friction, without which every layer makes some small whirl grow: small whirls are "
        "judged with the laminar friction of the liquid."
    )
    return Note(OptimumCode.LAMINAR, {}, text)


def no_liquid(by_mass: bool, forbidden: tuple[str, ...]) -> Note:
    """The answer is no liquid: it is the least for a limit, or constraints forbid what vibrates less."""
    if by_mass:
        text = "The limit is met without liquid."
    elif forbidden:
        names = " or ".join(name.replace("_", " ") for name in forbidden)
        text = f"No liquid is allowed that would help: whatever vibrates less exceeds {names}."
    else:
        text = "No liquid is best: whatever was tried vibrates as much or more with it."
    return Note(OptimumCode.NO_LIQUID, {"by_mass": by_mass, "forbidden": list(forbidden)}, text)


def interrupted(evaluations: int, searched: bool = False) -> Note:
    """The search was interrupted after so many sets of volumes, or what comes after it was."""
    if searched:
        text = "INTERRUPTED after the search was done: the best volumes stand, the front is missing."
        return Note(OptimumCode.INTERRUPTED, {"evaluations": evaluations, "searched": True}, text)
    text = (
        f"INTERRUPTED after {evaluations} sets of volumes: these are the best of them, not of all that would "
        "have been tried."
    )
    return Note(OptimumCode.INTERRUPTED, {"evaluations": evaluations, "searched": False}, text)


def emulated(answer: EmulatedAnswer) -> Note:
    """How far an emulator could have led the search astray."""
    error = answer.error
    text = (
        f"The search asked an emulator of {error.samples} samples, off by {error.root_mean_square:.2g} on "
        f"unseen ones (root mean square; largest {error.largest:.2g}); the best volumes it found were judged "
        f"by the solvers. By the emulator alone: {with_unit(answer.value, LENGTH)}, give or take "
        f"{with_unit(2.0 * answer.deviation, LENGTH)}."
    )
    return Note(OptimumCode.EMULATED, asdict(answer), text)


@dataclass(frozen=True)
class WettingVolumes:
    """Volumes of one chamber that wet its wall at a deflection and a speed, in closed form."""

    deflection: float  #: e, m
    speed: float  #: rad/s
    #: the least that leaves no part of the wall dry over its whole height, m^3 [theory: statics, eq. 8]
    optimal_volume: float
    #: the least that wets the whole wall up to the lid, beyond which more liquid adds nothing, m^3; infinite
    #: where the chamber does not hold it [theory: optimum, eq. 1]
    full_volume: float
    #: liquid's unbalance with the optimal volume over the largest possible one at this deflection
    unbalance_share: float

    def to_json(self) -> dict[str, float | None]:
        """As `optimise` prints it; null for a volume that the chamber does not hold."""
        return asdict(self) | {"full_volume": self.full_volume if math.isfinite(self.full_volume) else None}


@dataclass(frozen=True)
class ParetoFront:
    """Points of which none is better than another in everything; m points of c chambers."""

    volume: Array  #: m^3, shape (m, c)
    vibration: Array  #: m, shape (m,)
    mass: Array  #: of the liquid, kg, shape (m,)
    #: decay of the small whirl that dies out slowest at the operating speeds, 1/s; below 0 it grows; shape
    #: (m,)
    stability_margin: Array

    def to_json(self) -> list[dict[str, Any]]:
        """Its points."""
        names = ("volume", "vibration", "mass", "stability_margin")
        return [{name: getattr(self, name)[k] for name in names} for k in range(self.mass.size)]


@dataclass(frozen=True)
class Candidates:
    """Sets of volumes that were evaluated; m of c chambers."""

    volume: Array  #: m^3, shape (m, c)
    objective: Array  #: in its unit, shape (m,)
    excess: Array  #: of the constraint that is exceeded most, relative; 0 or below where all hold, shape (m,)
    vibration: Array  #: m and kg, shape (m,)
    mass: Array
    exact: Flags  #: the vibration is known, not an estimate from below, shape (m,)
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
    """Amplitudes with the best volumes over temperature and unbalance; n conditions were judged.

    t temperatures and u steps of the unbalances from least to most, of p unbalances each.
    """

    temperature: Array  #: K; a single nan where no range was given; shape (t,)
    unbalance: Array  #: size of each of the rotor's unbalances, kg m, shape (u, p)
    amplitude: Array  #: m, shape (t, u)
    amplitude_dry: Array  #: without liquid, which no temperature changes, m, shape (u,)
    #: decay of the small whirl that dies out slowest at the operating speeds, 1/s, which no unbalance
    #: changes; below 0 it grows; shape (t,)
    stability_margin: Array
    #: of the conditions that the volumes were chosen for, K and kg m, shape (n,) and (n, p)
    condition_temperature: Array
    condition_unbalance: Array
    condition_amplitude: Array  #: m, shape (n,)
    condition_amplitude_dry: Array
    quantile: float  #: of the amplitudes that was to be small; 1 is the worst case
    decisive: int  #: the condition that has this amplitude

    @property
    def heated(self) -> bool:
        """Temperatures were given."""
        return not bool(np.isnan(self.temperature).any())

    def to_json(self) -> dict[str, Any]:
        """As `optimise` prints it; null for a temperature that was not given."""
        rows = {name: getattr(self, name).tolist() for name in _ROBUST_ARRAYS}
        known = (margin if math.isfinite(margin) else None for margin in rows["stability_margin"])
        rows["stability_margin"] = list(known)
        if not self.heated:
            rows |= {name: [None] * len(rows[name]) for name in ("temperature", "condition_temperature")}
        worst = self.decisive
        case = {name: rows[f"condition_{name}"][worst] for name in _OF_CONDITION}
        return rows | {"quantile": self.quantile, "worst": case}

    def variables(self) -> dict[str, Variable]:
        """For a data file."""
        table, along = ("temperature_step", "unbalance_step"), ("unbalance_step",)
        of, each = ("condition",), ("condition", "rotor_unbalance")
        mass = "size of each of the rotor's unbalances"
        dry = "without liquid"
        return {
            "robust_temperature": var(table[:1], self.temperature, "K", "temperature"),
            "robust_unbalance": var((*along, "rotor_unbalance"), self.unbalance, "kg m", "unbalance", mass),
            "robust_amplitude": var(table, self.amplitude, "m", "amplitude", "with the best volumes"),
            "robust_amplitude_dry": var(along, self.amplitude_dry, "m", "amplitude", dry),
            "robust_stability_margin": var(table[:1], self.stability_margin, "s-1", "stability margin"),
            "condition_temperature": var(of, self.condition_temperature, "K", "temperature"),
            "condition_unbalance": var(each, self.condition_unbalance, "kg m", "unbalance", mass),
            "condition_amplitude": var(of, self.condition_amplitude, "m", "amplitude", "in a condition"),
            "condition_amplitude_dry": var(of, self.condition_amplitude_dry, "m", "amplitude", dry),
        }


_OF_CONDITION = ("temperature", "unbalance", "amplitude", "amplitude_dry")
_ROBUST_ARRAYS = (*_OF_CONDITION, "stability_margin", *(f"condition_{name}" for name in _OF_CONDITION))


@dataclass(frozen=True)
class CandidateChamber:
    """A chamber of the scene whose volume was looked for."""

    capacity: float  #: m^3
    liquid_name: str  #: as the scene names it


def _quality_json(result: OptimumResult) -> dict[str, float | None]:
    """Balance quality; null where it has no bound."""
    names = "balance_quality", "balance_quality_dry"
    found: list[float | None] = [getattr(result, name) for name in names]
    if None in found:
        return {}
    return {
        name: value if value is not None and math.isfinite(value) else None
        for name, value in zip(names, found, strict=True)
    }


@dataclass(frozen=True)
class OptimumResult(Result):
    """The best volumes of a scene and what they were chosen from; c chambers.

    Examples
    --------
    >>> import leblanc as lb
    >>> best = lb.optimise(lb.example("horizontal_rig"), front=False)
    >>> best.feasible, sorted(best.constraints), best.volume.shape
    (True, ['capacity', 'stability', 'wetting'], (2,))
    """

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    chambers: tuple[CandidateChamber, ...]  #: whose volumes were looked for
    friction: Friction  #: of the liquid
    tolerance: float  #: relative error that the scene allows
    in_time: bool  #: the objective is judged by run-ups in time
    objective: str  #: name, description and unit of the value
    meaning: str
    unit: str
    working_speed: float  #: rad/s
    volume: Array  #: the answer, m^3, shape (c,)
    value: float  #: of the objective with these volumes and without liquid
    baseline: float
    vibration: float  #: m; the value itself unless that is a mass
    vibration_baseline: float
    feasibility: Feasibility  #: whether every constraint is met
    constraints: dict[str, ConstraintValue]  #: by name
    mass: float  #: of the liquid, kg
    growth: float  #: of the small whirl that grows most at the operating speeds, 1/s
    #: for each chamber, at the deflection that the answer itself has; empty where it has none
    closed_form: tuple[WettingVolumes, ...]
    #: relative difference below which values count as equal; of their volumes those with the least liquid are
    #: the answer
    equal_within: float
    evaluations: int  #: sets of volumes evaluated
    candidates: Candidates  #: all of them
    front: ParetoFront | None  #: what must be given up for what; None if it was not computed
    #: from no liquid to the fullest chamber, shares as in the answer; None with the front
    sweep: ParetoFront | None
    notes: tuple[Note, ...]  #: limits and findings
    #: of the machine with these volumes over the scene's speeds; None where the liquid model of the search
    #: gives no steady answer, or where it was not computed; its models are those of the search
    response: RunAnswer | None = None
    #: what the emulator that the search asked says of the answer; None without one
    emulator: EmulatedAnswer | None = None
    #: amplitudes over temperature and unbalance, for the objective of that name; None for any other
    robust: ConditionTable | None = None
    #: unbalance of rotor and liquid together over the rotor's mass times the working speed, and that of the
    #: rotor alone, m/s [theory: balance_quality, eq. 1]; None where this is not known
    balance_quality: float | None = None
    balance_quality_dry: float | None = None
    interrupted: bool = False  #: from the keyboard; the answer is the best of what was tried until then

    figure = "leblanc.figures.optimise:objective_figure"
    summary = "leblanc.text.optimum:summary"

    @property
    def feasible(self) -> bool:
        """Every constraint is met."""
        return self.feasibility is Feasibility.FEASIBLE

    @property
    def exceeded(self) -> dict[str, ConstraintValue]:
        """Constraints that are not met, by name."""
        return {name: own for name, own in self.constraints.items() if not own.satisfied}

    @property
    def models(self) -> tuple[ModelSpan, ...]:
        """Which liquid model the search took at the scene's speeds, and why."""
        return () if self.response is None else self.response.models

    @property
    def stability_margin(self) -> float:
        """Decay of the small whirl that dies out slowest at the operating speeds, 1/s; below 0 it grows."""
        return -self.growth

    @property
    def pareto(self) -> list[dict[str, Any]]:
        """What must be given up for what, point by point; empty if it was not computed."""
        return [] if self.front is None else self.front.to_json()

    def to_json(self) -> dict[str, Any]:
        """What `optimise` prints for scripts, SI."""
        names = ("objective", "volume", "value", "baseline", "feasible", "evaluations", "unit", "meaning")
        more = ("working_speed", "vibration", "vibration_baseline", "mass", "stability_margin")
        search = ("equal_within", "interrupted")
        found: dict[str, Any] = {name: getattr(self, name) for name in (*names, *more, *search)}
        return (
            found
            | ({} if self.emulator is None else {"emulator": asdict(self.emulator)})
            | _quality_json(self)
            | ({} if self.robust is None else {"robust": self.robust.to_json()})
            | {
                "constraints": {name: asdict(value) for name, value in self.constraints.items()},
                "closed_form": [form.to_json() for form in self.closed_form],
                "pareto": self.pareto,
                "name": self.name,
                "digest": self.digest,
                "assumed": self.assumed,
                "notes": texts(self.notes),
            }
        )

    def named_arrays(self) -> NamedArrays:
        """All volumes that were evaluated, over `candidate` and `chamber`, and the front."""
        over, tried = ("candidate",), self.candidates
        excess = "of the constraint exceeded most; 0 or below: none is"
        estimate = "else the vibration is an estimate from below"
        columns = {
            "volume": var(("candidate", "chamber"), tried.volume, "m3", "volume of liquid"),
            "objective": var(over, tried.objective, self.unit, "objective", self.meaning),
            "excess": var(over, tried.excess, "1", "excess", excess),
            "best_volume": var(("chamber",), self.volume, "m3", "best volume"),
            "sure": flags(over, tried.exact, "no yes", "sure", estimate),
            "vibration": var(over, tried.vibration, "m", "vibration"),
            "mass": var(over, tried.mass, "kg", "mass"),
        }
        if self.front is not None:
            along, front = ("front",), self.front
            margin = front.stability_margin
            columns |= {
                "front_volume": var(("front", "chamber"), front.volume, "m3", "volume on the front"),
                "front_vibration": var(along, front.vibration, "m", "vibration on the front"),
                "front_mass": var(along, front.mass, "kg", "mass of liquid on the front"),
                "front_margin": var(along, margin, "s-1", "stability margin on the front"),
            }
        if self.robust is not None:
            columns |= self.robust.variables()
        tries, chambers = np.arange(tried.volume.shape[0]), np.arange(1, self.volume.size + 1)
        coords = {
            "candidate": var(over, tries.astype(np.int32), "1", "candidate"),
            "chamber": var(("chamber",), chambers.astype(np.int32), "1", "chamber"),
        }
        return NamedArrays(columns, coords, self._attributes())

    def _attributes(self) -> dict[str, Any]:
        """Scene, objective, versions."""
        own: dict[str, Any] = {
            "objective": self.objective,
            "meaning": self.meaning,
            "value": self.value,
            "baseline": self.baseline,
            "feasible": "yes" if self.feasible else "no",
            "interrupted": "yes" if self.interrupted else "no",
        }
        return attributes(self, "optimise", own, self.notes)
