"""What a sweep keeps of each sample: outputs of `run` or `runup` over speed, and a few numbers of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Annotated, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from leblanc.core.quantities import quantities
from leblanc.scene.scene import Scene
from leblanc.studies.loads.answer import MachineLoads
from leblanc.studies.loads.study import loaded_machine
from meshes.arrays import Array, Flags, Index
from meshes.quantity import Q

_OVER = ("speed",)
_LAG = "from the unbalance, positive with the spin, a lag is negative"
_MOST = "of the fastest-growing whirl"
_BALLS = "balanced_from"  # None without balls
_MOTOR, _ASKED = "motor_work", "limited_time"  # with a motor, and one that a programme asks
_DRIVEN, _FLOOR, _GAPS = "motor_torque", "floor_force", "clearance"  # None where a scene has no such parts

LEVELS = 100  # bands of the spin speed in which the largest amplitude of a run-up is kept


@dataclass(frozen=True, kw_only=True)
class Worst:
    """The worst loads of n scenes on their way, SI, shape (n,); nan where not known."""

    floor_force: Annotated[
        Array | None, Q("N", "largest force of the floor", "under any foot", when=_FLOOR)
    ] = None
    walking_margin: Annotated[
        Array | None, Q("1", "least margin against walking", "1 at rest, at 0 it walks", when=_FLOOR)
    ] = None
    clearance: Annotated[Array | None, Q("m", "least clearance", "of all points with a gap", when=_GAPS)] = (
        None
    )
    motor_torque: Annotated[Array | None, Q("N m", "largest torque of the drive", when=_DRIVEN)] = None
    motor_power: Annotated[Array | None, Q("W", "largest power of the drive", when=_DRIVEN)] = None


def worst_of(loads: MachineLoads | None) -> dict[str, Any]:
    """The worst loads of one scene as `Worst` has them; nothing where it asks for none."""
    if loads is None:
        return {}
    found = {
        "motor_torque": loads.largest(loads.torque).value,
        "motor_power": loads.largest(loads.power).value,
    }
    if loads.stands:
        found["floor_force"] = float(np.fmax.reduce([foot.value for foot in loads.feet]))
        found["walking_margin"] = loads.walking.value
    if clearances := [least.value for least in loads.clearances.values()]:
        found["clearance"] = float(np.fmin.reduce(clearances))
    return {name: np.array([value]) for name, value in found.items()}


@dataclass(frozen=True)
class Answers(Worst):
    """Outputs of `run` of n scenes at s speeds each, SI; shape (n, s), or (n,) of what is not over speed."""

    speed: Annotated[Array, Q("rad s-1", "spin speed", "of the rotor about its axis", over=_OVER)]
    amplitude: Annotated[Array, Q("m", "amplitude", "of the branch reported", over=_OVER)]
    amplitude_dry: Annotated[Array, Q("m", "amplitude", "without liquid", over=_OVER)]
    phase: Annotated[Array, Q("rad", "phase of the deflection", _LAG, over=_OVER)]
    liquid_offset: Annotated[Array, Q("m", "liquid offset", "rotation axis to centre of mass", over=_OVER)]
    liquid_angle: Annotated[Array, Q("rad", "angle of the liquid's centre of mass", _LAG, over=_OVER)]
    growth: Annotated[Array, Q("s-1", "growth rate", f"{_MOST}; above 0 unstable", over=_OVER)]
    whirl_speed: Annotated[Array, Q("rad s-1", "whirl speed", f"{_MOST}, in space", over=_OVER)]
    dry_patch: Annotated[Flags, Q("1", "dry patch", "the wall is dry somewhere", over=_OVER, flags="no yes")]
    stable: Annotated[
        Flags,
        Q(
            *("1", "the branch reported is stable", "against slow disturbances and whirls"),
            over=_OVER,
            flags="no yes",
        ),
    ]
    in_range: Annotated[Flags, Q("1", "in range", "the liquid model holds there", over=_OVER, flags="no yes")]
    converged: Annotated[Flags, Q("1", "converged", "every branch was found", over=_OVER, flags="no yes")]
    model: Annotated[NDArray[np.str_], Q("", "liquid model", "used at this speed", over=_OVER)]
    #: nan where unknown
    error_estimate: Annotated[
        Array, Q("1", "estimated error", "relative, of amplitude and liquid the larger", over=_OVER)
    ]
    #: found between the speeds as well; with balls at the speeds themselves
    peak_amplitude: Annotated[Array, Q("m", "largest amplitude", "over the speeds at which it holds")]
    peak_amplitude_dry: Annotated[
        Array, Q("m", "largest amplitude", "over the range of speeds, without liquid")
    ]
    amplitude_without: Annotated[
        Array | None, Q("m", "amplitude", "without balls, with the liquid", over=_OVER, when=_BALLS)
    ] = None
    state: Annotated[
        NDArray[np.str_] | None,
        Q("", "how the balls rest", "balanced, together, apart or none", over=_OVER, when=_BALLS),
    ] = None
    balanced: Annotated[
        Flags | None,
        Q(
            *("1", "the balanced state is stable", "whichever state is reported"),
            over=_OVER,
            flags="no yes",
            when=_BALLS,
        ),
    ] = None
    #: nan if at none
    balanced_from: Annotated[
        Array | None,
        Q("rad s-1", "speed from which on the balanced state is stable", "of these", when=_BALLS),
    ] = None

    @property
    def last_amplitude(self) -> Annotated[Array, Q("m", "amplitude at the last speed")]:
        return self.amplitude[:, -1]

    @property
    def last_amplitude_dry(self) -> Annotated[Array, Q("m", "amplitude at the last speed", "without liquid")]:
        return self.amplitude_dry[:, -1]

    @property
    def peak_growth(
        self,
    ) -> Annotated[Array, Q("s-1", "largest growth rate", "over the speeds; above 0 unstable")]:
        # fmax takes the other of two where one is not a number; a whole row without numbers gives none.
        most = np.fmax.reduce(self.growth, axis=1)
        # Where no whirl is known to grow and some are not known, whether one grows is not known either.
        return np.where(np.isnan(self.growth).any(axis=1) & ~(most > 0.0), np.nan, most)

    @property
    def reasons(self) -> list[str]:
        """Why a scene did not converge everywhere, empty where it did."""
        what = "bounded deflection" if self.balanced_from is None else "state of the balls"
        count = self.converged.shape[1]
        lost = np.count_nonzero(~np.asarray(self.converged), axis=1).tolist()
        return [f"no {what} found at {own} of {count} speeds" if own else "" for own in lost]


@dataclass(frozen=True)
class RunupAnswers(Worst):
    """Outputs of `runup` of n scenes, SI, over s bands of the spin speed; shape (n, s) or (n,)."""

    speed: Annotated[Array, Q("rad s-1", "spin speed", "middle of the band", over=_OVER)]
    #: nan where the spin did not come there
    amplitude: Annotated[Array, Q("m", "amplitude", "largest while the spin is in the band", over=_OVER)]
    amplitude_dry: Annotated[Array, Q("m", "amplitude", "the same without liquid", over=_OVER)]
    time: Annotated[Array, Q("s", "time", "at which the spin is first in the band", over=_OVER)]
    peak_amplitude: Annotated[Array, Q("m", "largest amplitude", "on the whole way")]
    peak_amplitude_dry: Annotated[Array, Q("m", "largest amplitude", "on the whole way, without liquid")]
    peak_speed: Annotated[Array, Q("rad s-1", "spin speed at the largest amplitude")]
    peak_time: Annotated[Array, Q("s", "time of the largest amplitude")]
    last_amplitude: Annotated[Array, Q("m", "amplitude at the end")]
    last_amplitude_dry: Annotated[Array, Q("m", "amplitude at the end", "without liquid")]
    last_speed: Annotated[Array, Q("rad s-1", "spin speed at the end")]
    top_speed: Annotated[Array, Q("rad s-1", "highest spin speed", "on the whole way")]
    #: a hundredth of the way short of it counts, which a motor approaches without an end
    top_time: Annotated[Array, Q("s", "time at which the highest speed is reached", "to 1 % of the way")]
    duration: Annotated[Array, Q("s", "time that the way takes")]
    motor_work: Annotated[Array, Q("J", "work of the motor", when=_MOTOR)]
    limited_time: Annotated[Array, Q("s", "time in which the motor gives less than asked", when=_ASKED)]
    in_range: Annotated[Flags, Q("1", "in range", "the liquid model holds all the way", flags="no yes")]
    converged: Annotated[Flags, Q("1", "converged", "it came to its end and is physical", flags="no yes")]
    model: Annotated[NDArray[np.str_], Q("", "liquid model")]
    #: nan where unknown
    error_estimate: Annotated[
        Array, Q("1", "estimated error", "of the amplitude by model and steps, over its largest")
    ]
    reasons: NDArray[np.str_]  #: why a run did not converge, empty where it did


A = TypeVar("A", Answers, RunupAnswers)


def together(parts: Sequence[A], order: Index | None = None) -> A:
    """Answers one behind the other, or in an order; what one of them has not is None."""
    found: dict[str, Any] = {}
    for name in (field.name for field in fields(parts[0])):
        each = [getattr(part, name) for part in parts]
        if any(values is None for values in each):
            continue
        found[name] = np.concatenate(each) if order is None else np.concatenate(each)[order]
    return type(parts[0])(**found)


@dataclass(frozen=True)
class Kept:
    """What the store of a sweep keeps of each sample."""

    kind: type[Answers | RunupAnswers]
    parts: frozenset[str]  #: outputs that are not there in every sweep, by what they go with
    speeds: int  #: or bands of speed, s
    check: bool = False  #: run-ups are made with half the cells as well

    @property
    def outputs(self) -> Mapping[str, Q]:
        """Each by its name."""
        there = {name: q for name, q in quantities(self.kind).items() if not q.when or q.when in self.parts}
        return {name: there[name] for name in sorted(there, key=quantities(Worst).__contains__)}  # loads last

    @property
    def single(self) -> Mapping[str, Q]:
        """Those that are one number a sample."""
        return {name: q for name, q in self.outputs.items() if not q.over and kind_of(q) == "float64"}

    @property
    def over_speed(self) -> list[str]:
        """Names of those over speed."""
        return [name for name, q in self.outputs.items() if q.over]


def kept_of(scene: Scene, command: str = "run", check: bool = False) -> Kept:
    """What is kept of scenes that differ from one in values alone."""
    machine, plan = loaded_machine(scene), scene.speed_plan
    motor = plan is not None and plan.motor is not None
    there = {
        _BALLS: bool(scene.balls),
        _MOTOR: motor,
        _ASKED: motor and scene.programme is not None,
        _DRIVEN: machine is not None,
        _FLOOR: scene.cabinet is not None,
        _GAPS: any(point.gap is not None for point in scene.points),
    }
    parts = frozenset(name for name, given in there.items() if given)
    if command == "runup":
        return Kept(RunupAnswers, parts, LEVELS, check)
    return Kept(Answers, parts, scene.speeds.count)


def kind_of(output: Q) -> str:
    """How a store keeps an output: "int8", -1 where there is no answer, "str", or "float64"."""
    return "int8" if output.flags else "float64" if output.unit else "str"


def blank(output: Q, samples: int, speeds: int) -> NDArray[np.generic]:
    """Values of samples without an answer: nan, -1 or an empty text."""
    shape, kind = (samples, speeds) if output.over else (samples,), kind_of(output)
    if kind == "str":
        return np.full(shape, "", dtype=object)
    return np.full(shape, np.nan if kind == "float64" else -1, dtype=kind)
