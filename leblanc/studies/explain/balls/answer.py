"""A scene with balls in numbers: what they hold, how quickly they follow, from where on they balance."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from leblanc.core.blocks import Block, Section, Table, Words
from leblanc.core.notes import one_line
from leblanc.core.units import LENGTH, MASS, MM, RPM, UNBALANCE, in_rpm, number, ranges, with_unit
from leblanc.studies.explain.answer import ExplainAnswer, Explained, Rows, described_blocks, machine_rows
from meshes.arrays import Array, Flags
from meshes.quantity import Q
from solvers.rotor.balls.two_plane_balance import Balancing

_RATE = "rad s-1"


@dataclass(frozen=True)
class RaceNumbers:
    """One race with its balls in numbers."""

    count: Annotated[int, Q("1", "count", "of the balls")]
    mass: Annotated[float, Q("kg", "mass", "of one ball")]
    plane: Annotated[float, Q("m", "plane", "along the axis")]
    capacity: Annotated[float, Q("kg m", "capacity", "largest unbalance that the balls hold")]
    #: nan where no shares of the races balance it
    share: Annotated[float, Q("kg m", "share", "of the unbalance, that they must hold to balance the rotor")]
    #: 0 where their diameter is not known
    crowding: Annotated[float, Q("1", "crowding", "share of the way round that they take side by side")]
    #: infinite without drag
    fade_time: Annotated[
        float, Q("s", "decay time", "the speed of a free ball against its drum falls to 1/e")
    ]
    drag: Annotated[float, Q("1", "drag", "over a ball's mass, rolling share and the critical speed")]
    sticking: Annotated[
        float,
        Q(
            "m",
            "sticking",
            "deflection below which balls that resist to rolling stay, without gravity across the axis",
        ),
    ]


@dataclass(frozen=True)
class BallExplainAnswer(Explained):
    """A scene with balls in numbers; s speeds.

    Examples
    --------
    >>> import leblanc as lb
    >>> told = lb.explain(lb.example("balls"))
    >>> told.can_balance, round(told.balanced_from / told.machine.critical_speed_dry, 2)
    (True, 1.12)
    """

    figure = "leblanc.studies.explain.balls.figure:numbers_figure"

    machine: Annotated[ExplainAnswer, Q(part=True)]  #: the same scene without its balls
    races: Annotated[tuple[RaceNumbers, ...], Q(text="in their order", rows="race")]
    unbalance: Annotated[float, Q("kg m", "unbalance of the rotor", "all of its sizes together")]
    ball_mass: Annotated[float, Q("kg", "mass of all balls")]
    can_balance: Annotated[bool, Q(name="the balls hold the unbalance", flags="no yes")]
    reason: Annotated[str, Q(text="why not, or that they can", key="can_balance_why")]
    #: nan if at none of the scene's
    balanced_from: Annotated[float, Q(_RATE, "speed from which on the rotor is balanced")]
    speed: Annotated[Array, Q(_RATE, "spin speed", over=("ball_at",), json=False, variable="ball_speed")]
    #: nan where there is no balanced state
    growth: Annotated[
        Array,
        Q(
            *("s-1", "growth about the balanced state", "of small motions", ("ball_at",)),
            json=False,
            variable="balanced_growth",
        ),
    ]
    #: conditions of balancing in two planes; None where the rotor or its races have none
    balancing: Balancing | None
    #: shape (s,); None elsewhere than in the plane of the only race
    single_plane: Annotated[Flags | None, Q(text="condition of balancing in one plane")]
    lacking: tuple[str, ...]  #: what is not computed, a sentence each

    @property
    def not_told(self) -> Annotated[tuple[str, ...], Q(text="what is not computed, a sentence each")]:
        return (*self.machine.not_told, *self.lacking)

    @property
    def balanced_growth(self) -> Annotated[dict[str, Array], Q(text="growth (1/s) over speed (rad/s), SI")]:
        return {"speed": self.speed, "growth": self.growth}

    @property
    def conditions(
        self,
    ) -> Annotated[dict[str, Any] | None, Q(text="of balancing in two planes", key="balancing")]:
        found = self.balancing
        if found is None:
            return None
        whole = {
            name: getattr(found, name)
            for name in ("speed", "possible", "above", "resonances", "long", "growth")
        }
        return whole | {"conditions": [{"name": each.name, "above": each.above} for each in found.conditions]}

    @property
    def name(self) -> str:
        """Of the scene."""
        return self.machine.name

    @property
    def source(self) -> str:
        """Where its values come from."""
        return self.machine.source

    @property
    def assumed(self) -> tuple[str, ...]:
        """Paths of the values that no source gives."""
        return self.machine.assumed

    @property
    def digest(self) -> str:
        """Fingerprint of the scene."""
        return self.machine.digest

    def blocks(self) -> tuple[Block, ...]:
        last = float(self.speed[-1])
        text = described_blocks(self.machine)
        for k, race in enumerate(self.races):
            text += [Words(f"race {k + 1}"), Table(race_rows(race, last), indent=2)]
        lacking = (("not reported", each) for each in self.lacking)
        text += [Words("balls"), Table([*ball_rows(self), *lacking], indent=2)]
        return Table(facts(self), shown="page"), Section("", text, shown="text")


def race_rows(race: RaceNumbers, last: float) -> Rows:
    """One race with its balls; label and text."""
    held = f"{with_unit(race.capacity, UNBALANCE)} at most"
    if math.isfinite(race.share) and race.share > 0.0:
        held += f", {race.capacity / race.share:.4g} times its share, {with_unit(race.share, UNBALANCE)}"
    rows = [
        ("balls", f"{race.count} of {with_unit(race.mass, MASS)}, in the plane {number(race.plane * MM)} mm")
    ]
    rows.append(("hold", held))
    if race.crowding > 0.0:
        rows.append(("room", f"side by side they take {race.crowding:.3g} of the way round"))
    rows.append(("follow the drum", _fades(race, last)))
    if race.sticking > 0.0:
        rows.append(("stick", f"while the axis moves by less than {with_unit(race.sticking, LENGTH)}"))
    return rows


def _fades(race: RaceNumbers, last: float) -> str:
    if math.isinf(race.fade_time):
        return "never: nothing drags on them"
    turns = race.fade_time * last / (2.0 * math.pi)
    return (
        f"their speed against it decays with {number(race.fade_time)} s, {number(turns)} turns at "
        f"{in_rpm(last)}; drag {race.drag:.3g} of mass times critical speed"
    )


def ball_rows(answer: BallExplainAnswer) -> Rows:
    """Whether and from where on the balls balance; label and text."""
    can = "yes" if answer.can_balance else "no"
    rows = [
        (
            "unbalance",
            f"{with_unit(answer.unbalance, UNBALANCE)}; all balls weigh {with_unit(answer.ball_mass, MASS)}",
        ),
        ("can balance it", f"{can}: {answer.reason}"),
    ]
    if answer.can_balance:
        rows.append(("balanced state", _stable_from(answer)))
    if answer.single_plane is not None:
        where = ranges(answer.speed, answer.single_plane)
        rows.append(("one plane", f"light balls balance this plane at {where}"))
    rows += _two_planes(answer)
    return rows


def _stable_from(answer: BallExplainAnswer) -> str:
    known = np.isfinite(answer.growth)
    last = f"at {in_rpm(float(answer.speed[-1]))} small motions "
    rate = float(answer.growth[-1]) if known[-1] else math.nan
    last += (
        "are not known"
        if math.isnan(rate)
        else f"{'grow' if rate > 0.0 else 'decay'} with {number(abs(rate))} 1/s"
    )
    if math.isnan(answer.balanced_from):
        return f"stable at none of the speeds to the end of the scene's; {last}"
    ratio = answer.balanced_from / answer.machine.critical_speed_dry
    return f"stable from {in_rpm(answer.balanced_from)} on, {ratio:.3g} times the critical speed; {last}"


def _two_planes(answer: BallExplainAnswer) -> Rows:
    """Conditions of balancing in two planes, and what these balls do."""
    found = answer.balancing
    if found is None:
        return []
    whole = (
        "not possible at any speed" if math.isinf(found.above) else f"possible above {in_rpm(found.above)}"
    )
    rows = [("two planes", f"{whole}, by the conditions without damping; at the last speed {found.why(-1)}")]
    if found.growth is not None:
        rows.append(("with these balls", f"stable at {ranges(found.speed, found.holds)}"))
    return rows


def facts(answer: BallExplainAnswer) -> Rows:
    """Main numbers of a scene: label and value."""
    last = float(answer.speed[-1])
    return [
        ("Scene", one_line(answer.name)),
        *machine_rows(answer.machine)[:3],
        *ball_rows(answer),
        *(
            (f"race {k + 1}: {label}", text)
            for k, race in enumerate(answer.races)
            for label, text in race_rows(race, last)
        ),
    ]


def alt(answer: BallExplainAnswer) -> str:
    """What the figure shows."""
    if not answer.can_balance:
        return f"No balanced state: {answer.reason}."
    rpm = answer.speed * RPM
    return (
        f"Growth of small motions about the balanced state from {rpm[0]:.4g} to {rpm[-1]:.4g} rpm: "
        f"{_stable_from(answer)}."
    )
