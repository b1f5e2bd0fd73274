"""Answer of `run` with balls: their rest places in the drum at each speed, and the residual amplitude."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer, input_lines
from leblanc.core.blocks import Block, Check, Checks, Columns, Headline, Notes, Picture, Section, Table, Words
from leblanc.core.notes import Note
from leblanc.core.units import (
    LENGTH,
    MOST_RANGES,
    NOT_FOUND,
    RPM,
    UNBALANCE,
    amplitudes_are,
    in_peak,
    in_rpm,
    number,
    ranges,
    rpm_bands,
    unit_for,
    with_unit,
)
from leblanc.studies.balls.notes import rounded
from leblanc.studies.balls.races import GravityOnBalls, RaceOfBalls, StuckBalls, ball_moment
from leblanc.studies.closed_forms.answer import ClosedForms, closed_form_table
from leblanc.studies.loads.answer import MachineLoads, bearing_tables, load_table
from leblanc.studies.run.notes import plane_words
from leblanc.studies.run.words import failing_at
from leblanc.studies.volume.answer import WallVolumes
from meshes.arrays import Array, Complex, Flags, Index
from meshes.quantity import Q
from solvers.rotor.balls.steady import GROWS, BallKind, BallStates

FAR = math.radians(15.0)  # swing of a ball up to which small swings tell it
_OVER, _EVERY = ("speed",), ("speed", "state")
_EQUAL = 1e-7  # relative; of amplitudes, and of growth over the spin
STATE_NAMES: Mapping[int, str] = {kind: kind.name.lower() for kind in BallKind}
_KINDS = " ".join(STATE_NAMES.values())
_FAMILY = "over all members of the state's family"


def reported_state(states: BallStates, sizes: Array) -> Index:
    """Which state is reported at each speed, shape (s,): of the stable ones that with the largest amplitude.

    Where none is stable it is the one whose small motions grow least; -1 where none was found.
    """
    if states.kind.shape[1] == 0:
        return np.full(states.speed.shape, -1)
    stable = np.where(states.stable, sizes, -1.0)
    # Of amplitudes that are equal the first: rounding does not choose.
    largest = np.argmax(stable >= stable.max(axis=1, keepdims=True) * (1.0 - _EQUAL), axis=1)
    growth = np.where(states.kind > 0, np.nan_to_num(states.growth, nan=np.inf), np.inf)
    slack = _EQUAL * states.speed[:, None]
    least = np.argmax(growth <= growth.min(axis=1, keepdims=True) + slack, axis=1)
    found = np.where(states.stable.any(axis=1), largest, least)
    return np.where((states.kind > 0).any(axis=1), found, -1)


@dataclass(frozen=True)
class BallsAnswer(Answer):
    """States of rotor, balls and liquid; s speeds, at most b states at each, N balls.

    Examples
    --------
    >>> import leblanc as lb
    >>> result = lb.run(lb.example("balls"))
    >>> print(result.state[0], result.state[-1])
    together balanced
    """

    command, title = "run", "Balls at rest in the drum"
    data, page, unused = "response.nc", "summary.html", ("runup", "optimise")
    figure = "leblanc.studies.balls.figure:balls_figure"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: Annotated[tuple[str, ...], Q(text="paths of the values that no source gives")]
    digest: Annotated[str, Q(text="of the scene")]
    inputs: tuple[tuple[str, str, str], ...]  #: label, value with its unit, field path
    kind: str  #: of the rotor; "horizontal" or "vertical"
    axis: str
    races: tuple[RaceOfBalls, ...]  #: that hold the balls
    position: Annotated[float, Q("m", "plane reported", "along the axis", data=False)]
    states: BallStates  #: all that were found at each speed
    forward: Complex  #: parts of the orbit there, m, shape (s, b), nan where there are fewer states
    backward: Complex
    deflection_without: Complex  #: forward part of the rotor without balls, with its liquid, m, shape (s,)
    amplitude_without: Annotated[Array, Q("m", "amplitude without balls", over=_OVER)]
    amplitude_dry: Annotated[Array, Q("m", "amplitude without balls and liquid", over=_OVER)]
    liquid: Complex  #: first moment of all liquid about the rotation axis, kg m, in the drum, shape (s, b)
    liquid_mass: float  #: kg
    dry: Flags  #: a wall is dry over its whole height somewhere, shape (s, b)
    capacity: Annotated[
        tuple[float, ...], Q("kg m", "largest unbalance that the balls of each race hold", data=False)
    ]
    can_balance: Annotated[bool, Q(text="the balls can take all unbalance away")]
    sticking: Annotated[
        tuple[float, ...],
        Q(
            "m",
            "deflection below which balls stay where they are",
            "in the plane of each race, without gravity across the axis",
            data=False,
        ),
    ]
    notes: Annotated[tuple[Note, ...], Q(text="limits of validity and findings")]
    #: over the members of the reported state's family, twice its own growth where it is the only member,
    #: shape (s, 2); None where it was not asked for
    growth_range: Annotated[
        Array | None, Q("s-1", "least and largest growth of small motions", data=False)
    ] = None
    #: bands of speed in which the balanced state is stable, rad/s, their edges solved; None where they were
    #: not, as of a family of such states
    balanced_bands: tuple[tuple[float, float], ...] | None = None
    #: forces and clearances of the state reported where it is stable; None where the scene asks for none
    loads: Annotated[MachineLoads | None, Q(part=True)] = None
    #: at which the surface meets an edge of a chamber, for the state reported; None without liquid
    wall_volumes: Annotated[WallVolumes | None, Q(part=True)] = None
    #: analytical checks of the sources
    closed_forms: Annotated[ClosedForms, Q(part=True)] = field(default_factory=ClosedForms)
    liquid_model: str = ""  #: name of the liquid's model; empty without liquid
    #: relative, of the state reported, of amplitude and liquid the larger one; None without liquid
    error_estimate: Annotated[
        Array | None,
        Q(
            *("1", "estimated error", "by the liquid's model, the balls held where they are", _OVER),
            when="error_estimate",
        ),
    ] = None
    #: None where gravity does not act across the axis
    in_range: Annotated[
        Flags | None,
        Q(
            *("", "in range", "gravity leaves liquid and balls on their walls", _OVER),
            flags="no yes",
            when="in_range",
        ),
    ] = None
    #: above which a ring of liquid stands against it, rad/s; None where it does not act
    capture_speed: float | None = None
    #: what it does to the balls; None where it does not act
    gravity: Annotated[GravityOnBalls | None, Q(prefix="gravity", when="gravity")] = None
    tolerance: float | None = None  #: relative error that the scene allows
    #: what balls that resist to rolling leave; None where they do not
    stuck: Annotated[StuckBalls | None, Q(prefix="stuck", when="stuck")] = None

    @property
    def speed(self) -> Annotated[Array, Q("rad s-1", "spin speed", over=_OVER)]:
        return self.states.speed

    @property
    def sizes(self) -> Array:
        """Amplitude of each state, m, nan where there is none, shape (s, b)."""
        return np.asarray(np.abs(self.forward) + np.abs(self.backward))

    @property
    def chosen(self) -> Index:
        """Which state is reported at each speed: of the stable ones the one with the largest amplitude.

        Where none is stable it is the one whose small motions grow least; -1 where none was found.
        """
        return reported_state(self.states, self.sizes)

    def _of_chosen(self, values: NDArray[Any], missing: Any) -> NDArray[Any]:
        """Values of the states that are reported."""
        rows, chosen = np.arange(self.speed.size), self.chosen
        known = (chosen >= 0).reshape(-1, *[1] * (values.ndim - 2))
        return np.where(known, values[rows, chosen], missing)

    @property
    def converged(self) -> Annotated[Flags, Q(text="a state was found", over=_OVER)]:
        return np.asarray(self.chosen >= 0)

    @property
    def stable(self) -> Annotated[Flags, Q("", "small motions do not grow", "", _OVER, flags="no yes")]:
        return self._of_chosen(self.states.stable, False)

    @property
    def amplitude(
        self,
    ) -> Annotated[
        Array,
        Q("m", "amplitude", "of the axis from where it rests, state reported", _OVER, error="error_estimate"),
    ]:
        return self._of_chosen(self.sizes, np.nan)

    @property
    def deflection(self) -> Complex:
        """Forward part of the axis' motion in the drum, m, shape (s,)."""
        return self._of_chosen(self.forward, complex(np.nan, np.nan))

    @property
    def phase(self) -> Annotated[Array, Q("rad", "angle of the deflection in the drum", over=_OVER)]:
        return np.asarray(np.angle(self.deflection))

    @property
    def state(
        self,
    ) -> Annotated[
        NDArray[np.str_], Q(text="how the balls rest: balanced, together, apart or none", over=_OVER)
    ]:
        kinds = self._of_chosen(self.states.kind, 0)
        return np.array([STATE_NAMES[kind] for kind in kinds.tolist()])

    @property
    def growth(self) -> Annotated[Array, Q("s-1", "growth of small motions", over=_OVER)]:
        return self._of_chosen(self.states.growth, np.nan)

    @property
    def family_dimension(self) -> Index:
        """Dimension of the family of the state reported, 0 of a single one, -1 without one, shape (s,)."""
        return self._of_chosen(self.states.dimension, -1)

    @property
    def state_dimension(
        self,
    ) -> Annotated[
        Index,
        Q("1", "dimension of the state's family", "", _OVER, json=False, variable="family_dimension"),
    ]:
        return self.family_dimension.astype(np.int32)

    @property
    def elsewhere(self) -> Flags:
        """The member reported is not stable, and others of its family are, shape (s,)."""
        if self.growth_range is None:
            return np.zeros(self.speed.shape, dtype=bool)
        return np.asarray(~self.stable & (self.growth_range[:, 0] <= GROWS * self.speed))

    @property
    def ball_angle(
        self,
    ) -> Annotated[Array, Q("rad", "angle of the ball in the drum", over=("speed", "ball"))]:
        return self._of_chosen(self.states.places, np.nan)

    @property
    def ball_unbalance(self) -> Annotated[Array, Q("kg m", "unbalance of all balls together", over=_OVER)]:
        return np.asarray(np.abs(ball_moment(self.races, self.ball_angle)))

    @property
    def liquid_position(self) -> Complex:
        """Liquid's centre of mass from the rotation axis in the drum, m, shape (s,); nan without liquid."""
        if self.liquid_mass == 0.0:
            return np.full(self.speed.shape, complex(np.nan, np.nan))
        return np.asarray(self._of_chosen(self.liquid, complex(np.nan, np.nan)) / self.liquid_mass)

    @property
    def liquid_offset(self) -> Annotated[Array, Q("m", "liquid's centre of mass from the axis", over=_OVER)]:
        return np.asarray(np.abs(self.liquid_position))

    @property
    def liquid_angle(
        self,
    ) -> Annotated[
        Array, Q("rad", "angle of the liquid's centre of mass in the drum", over=_OVER, data=False)
    ]:
        return np.asarray(np.angle(self.liquid_position))

    @property
    def dry_patch(
        self,
    ) -> Annotated[Flags, Q(text="a wall is dry over its whole height somewhere", over=_OVER)]:
        return self._of_chosen(self.dry, False)

    @property
    def model(self) -> Annotated[NDArray[np.str_], Q(text="what answers", over=_OVER)]:
        return np.full(self.speed.shape, f"balls and {self.liquid_model}" if self.liquid_model else "balls")

    @property
    def balanced(self) -> Flags:
        """The balanced state is stable, shape (s,)."""
        wanted = self.states.kind == BallKind.BALANCED
        return np.asarray((wanted & self.states.stable).any(axis=1))

    @property
    def balanced_from(
        self,
    ) -> Annotated[float, Q("rad s-1", "speed from which on the balanced state is stable", data=False)]:
        # Of the scene's own speeds where the edges of bands were not solved.
        if self.balanced_bands is not None:
            last = self.balanced_bands[-1] if self.balanced_bands else (math.nan, math.nan)
            return last[0] if last[1] >= self.speed.max() else math.nan
        failing = np.flatnonzero(~self.balanced)
        first = 0 if not failing.size else int(failing[-1]) + 1
        return float(self.speed[first]) if first < self.speed.size else float("nan")

    @property
    def unstable(self) -> Flags:
        """No state found is stable, nor a member of the family reported, shape (s,)."""
        return np.asarray(~self.states.stable.any(axis=1) & ~self.elsewhere)

    @property
    def family_dimensions(
        self,
    ) -> Annotated[
        list[int | None], Q("1", text="dimension of the state's family", key="family_dimension", data=False)
    ]:
        return [None if size < 0 else size for size in self.family_dimension.tolist()]

    @property
    def growth_least(
        self,
    ) -> Annotated[Array | None, Q("s-1", "least growth of small motions", _FAMILY, _OVER, json=False)]:
        return None if self.growth_range is None else self.growth_range[:, 0]

    @property
    def growth_largest(
        self,
    ) -> Annotated[Array | None, Q("s-1", "largest growth of small motions", _FAMILY, _OVER, json=False)]:
        return None if self.growth_range is None else self.growth_range[:, 1]

    @property
    def state_kind(self) -> Annotated[Index, Q("1", f"0 to 3: {_KINDS}", over=_EVERY, json=False)]:
        return self.states.kind.astype(np.int32)

    @property
    def state_amplitude(
        self,
    ) -> Annotated[Array, Q("m", "amplitude of each state found", over=_EVERY, json=False)]:
        return self.sizes

    @property
    def state_growth(
        self,
    ) -> Annotated[Array, Q("s-1", "its growth of small motions", over=_EVERY, json=False)]:
        return self.states.growth

    @property
    def every_state(
        self,
    ) -> Annotated[list[list[dict[str, Any]]], Q(text="all states found at each speed", key="states")]:
        found = self.states
        return [
            [
                {
                    "state": STATE_NAMES[int(found.kind[k, j])],
                    "amplitude": float(self.sizes[k, j]),
                    "stable": bool(found.stable[k, j]),
                    "growth": float(found.growth[k, j]),
                    "ball_angle": found.places[k, j].tolist(),
                }
                for j in np.flatnonzero(found.kind[k]).tolist()
            ]
            for k in range(self.speed.size)
        ]

    @property
    def own(self) -> dict[str, str]:
        return {"inputs": input_lines(self.inputs)}

    @property
    def faults(self) -> tuple[str, ...]:
        lost = "no state of the balls was found at some speeds; they are empty"
        return () if self.converged.all() else (lost,)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.speed.size} speeds done"

    def blocks(self) -> tuple[Block, ...]:
        low, high = number(float(self.speed[0]) * RPM), number(float(self.speed[-1]) * RPM)
        count, races = sum(race.count for race in self.races), len(self.races)
        about = (
            f"A rotor with {count} ball{'' if count == 1 else 's'} in {races} "
            f"race{'' if races == 1 else 's'}, from {low} to {high} rpm in {self.speed.size} speeds."
        )
        machine = (Picture("machine", "Clearances and forces on the floor", f"{_FIGURES}:loads_figure"),)
        forms = closed_form_table(self.closed_forms)
        return (
            Headline(sentence(self), about, shown="both"),
            Section(
                "Results",
                (
                    *([] if self.loads is None else [load_table(self.loads), *bearing_tables(self.loads)]),
                    Picture("balls", "Amplitude with balls and where they rest", self.figure),
                    *(() if self.loads is None else machine),
                    Columns((Table(facts(self)), Checks(checks(self)), forms), (_every_state(self),)),
                ),
                width="110mm",
            ),
            Section("Model", (Words(MODEL, name="balls", small=True),), shown="page"),
            Notes([note.text for note in self.notes]),
        )


_FIGURES = "leblanc.studies.balls.figure"
MODEL = (
    "Balls that roll or slide in races on a rotor with all its coordinates: states in which they rest in "
    "the drum, found from starts of many kinds, and the roots of small motions about each."
)


def sentence(result: BallsAnswer) -> str:
    """From where on the balls balance the rotor, and what they do at the largest amplitude."""
    bare = int(np.argmax(np.where(np.isfinite(result.amplitude_without), result.amplitude_without, -1.0)))
    without = (
        f"{with_unit(float(result.amplitude_without[bare]), LENGTH)} at {in_rpm(float(result.speed[bare]))}"
    )
    first = "The balls balance the rotor at none of these speeds"
    if math.isfinite(result.balanced_from):
        first = f"From {in_rpm(result.balanced_from)} on the balls balance the rotor"
    if not result.stable.any():
        found = result.converged.any()
        nothing = (
            "no state that creeping balls come to is stable"
            if found
            else "no state of balls at rest was found"
        )
        return f"{first}: {nothing}; without balls the largest amplitude is {without}."
    most = int(np.argmax(np.where(result.stable, result.amplitude, -1.0)))
    peak = f"{with_unit(float(result.amplitude[most]), LENGTH)} at {in_rpm(float(result.speed[most]))}"
    stuck = result.stuck
    if stuck is not None and stuck.sticks[-1]:
        last = in_rpm(float(result.speed[-1]))
        left = f"{rounded(float(stuck.low[-1]))} to {rounded(float(stuck.high[-1]))}"
        first = f"{first}; balls that stick leave {left} at {last}"
    return f"{first}; the largest amplitude of a stable state is {peak}, without balls {without}."


def _balanced_at(result: BallsAnswer) -> str:
    """Speeds at which the balanced state is stable."""
    bands = result.balanced_bands
    if not bands or len(bands) > MOST_RANGES:
        return ranges(result.speed, result.balanced)
    whole = bands[0][0] <= result.speed.min() and bands[0][1] >= result.speed.max()
    return "all speeds" if whole else rpm_bands(bands)


def facts(result: BallsAnswer) -> list[tuple[str, str]]:
    """What the balls can hold, where they balance, and the state at the last speed: label and value."""
    last = in_rpm(float(result.speed[-1]))
    held = ", ".join(with_unit(size, UNBALANCE) for size in result.capacity)
    known = bool(result.converged[-1])
    places = ", ".join(number(math.degrees(angle)) for angle in result.ball_angle[-1])
    rows = [
        ("Unbalance that the balls of each race hold", held),
        ("Balanced state stable at", _balanced_at(result)),
        (f"Balls at {last}", f"{result.state[-1]}, at {places} deg" if known else NOT_FOUND),
        (f"Amplitude at {last}", with_unit(float(result.amplitude[-1]), LENGTH)),
        (f"Without balls at {last}", with_unit(float(result.amplitude_without[-1]), LENGTH)),
        (
            f"Growth of small motions at {last}",
            f"{number(float(result.growth[-1]))} 1/s" if known else NOT_FOUND,
        ),
    ]
    if result.growth_range is not None and result.family_dimension[-1] > 0:
        least, largest = map(float, result.growth_range[-1])
        rows.append((f"Growth over the family at {last}", f"{number(least)} to {number(largest)} 1/s"))
    tilts = result.kind != "jeffcott"
    rows.append(amplitudes_are(plane_words(result.position, chambers=True) if tilts else ""))
    if result.stuck is not None:
        rows += _stuck_rows(result, result.stuck)
    return rows


def _stuck_rows(result: BallsAnswer, stuck: StuckBalls) -> list[tuple[str, str]]:
    """Rows of balls that resist to rolling."""
    last = in_rpm(float(result.speed[-1]))
    low, middle, high = (rounded(float(part[-1])) for part in (stuck.low, stuck.median, stuck.high))
    return [
        ("Balls can stick at", ranges(result.speed, stuck.sticks)),
        (f"Deflection up to which they stay at {last}", rounded(float(stuck.hold[-1].max()))),
        (f"Amplitude that they leave at {last}", f"{low} to {high}, median {middle}"),
    ]


def checks(result: BallsAnswer) -> list[Check]:
    """Where the answer is not what it seems: each check with what fails it."""
    several = result.states.stable.sum(axis=1) > 1
    missed = np.zeros(result.speed.shape, dtype=bool)
    if result.error_estimate is not None and result.tolerance is not None:
        missed = result.converged & ~(result.error_estimate <= result.tolerance)
    found = [
        ("No state found", ~result.converged),
        ("No state is stable", result.unstable & result.converged),
        ("Stable only elsewhere in the family", result.elsewhere),
        ("Several states are stable, the largest is reported", several),
        ("More amplitude than without balls", result.amplitude > result.amplitude_without),
    ]
    if result.liquid_model and result.tolerance is not None:
        found.append((f"Error above {number(100.0 * result.tolerance)} % or unknown", missed))
    if result.gravity is not None and result.in_range is not None:
        far = np.nan_to_num(result.gravity.ball_swing).max(axis=1) > FAR
        found += [
            ("Gravity outweighs the spin", ~result.in_range),
            (f"Balls swing by more than {number(math.degrees(FAR))} deg", far & result.in_range),
        ]
    at = [float(result.speed[-1])]
    if np.isfinite(result.amplitude).any():
        at.append(float(result.speed[np.nanargmax(result.amplitude)]))
    return [failing_at(at, label, result.speed, mask) for label, mask in found]


def alt(result: BallsAnswer) -> str:
    """What the figure shows."""
    return (
        "Curves of the amplitude over speed with balls and without, and the angles at which the balls rest "
        f"in the drum. {sentence(result)}"
    )


def _every_state(result: BallsAnswer) -> Table:
    """All states found at a few speeds spread over those of the scene."""
    wanted = np.unique(np.linspace(0, result.speed.size - 1, 6).astype(int)).tolist()
    unit = unit_for(LENGTH, *(size for k in wanted for size in result.sizes[k] if np.isfinite(size)))
    rows = []
    for k in wanted:
        for j in np.flatnonzero(result.states.kind[k]).tolist():
            stable, growth = bool(result.states.stable[k, j]), float(result.states.growth[k, j])
            name = STATE_NAMES[int(result.states.kind[k, j])]
            size = unit.number(float(result.sizes[k, j]))
            rows.append(
                (number(result.speed[k] * RPM), name, size, "yes" if stable else "no", number(growth))
            )
    head = ("Speed (rpm)", "balls", f"amplitude ({in_peak(unit.name)})", "stable", "growth (1/s)")
    return Table(rows, head, title="States", shown="page")
