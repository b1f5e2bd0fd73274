"""What `run` answers of a rotor with balls: where they rest in the drum at each speed, and what is left."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Result, attributes, carried
from leblanc.core.netcdf import NamedArrays, Variable, finite, flags
from leblanc.core.netcdf import variable as var
from leblanc.core.notes import Note, one_line, texts
from leblanc.results.base import number_or_none
from leblanc.results.machine.loads import MachineLoads
from leblanc.results.motion.closed_forms import ClosedForms
from leblanc.results.races.balls import GravityOnBalls, RaceOfBalls, ball_moment
from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.balls.steady import GROWS, BallKind, BallStates

_EQUAL = 1e-7  # relative; of amplitudes, and of growth over the spin
STATE_NAMES: Mapping[int, str] = {kind: kind.name.lower() for kind in BallKind}


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
class BallsResult(Result):
    """States of rotor, balls and liquid; s speeds, at most b states at each, N balls.

    Examples
    --------
    >>> import leblanc as lb
    >>> result = lb.run(lb.example("balls"))
    >>> print(result.state[0], result.state[-1])
    together balanced
    """

    figure: ClassVar[str] = "leblanc.figures.races.balls:balls_figure"
    summary: ClassVar[str] = "leblanc.text.races.balls:facts"

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    inputs: tuple[tuple[str, str, str], ...]  #: label, value with its unit, field path
    kind: str  #: of the rotor; "horizontal" or "vertical"
    axis: str
    races: tuple[RaceOfBalls, ...]  #: that hold the balls
    position: float  #: along the axis of the plane whose motion is reported, m
    states: BallStates  #: all that were found at each speed
    forward: Complex  #: parts of the orbit there, m, shape (s, b), nan where there are fewer states
    backward: Complex
    deflection_without: Complex  #: forward part of the rotor without balls, with its liquid, m, shape (s,)
    amplitude_without: Array  #: its amplitude, m, shape (s,)
    amplitude_dry: Array  #: amplitude without balls and without liquid, m, shape (s,)
    liquid: Complex  #: first moment of all liquid about the rotation axis, kg m, in the drum, shape (s, b)
    liquid_mass: float  #: kg
    dry: Flags  #: a wall is dry over its whole height somewhere, shape (s, b)
    capacity: tuple[float, ...]  #: largest unbalance that the balls of each race hold, kg m
    can_balance: bool  #: the balls can take all unbalance away
    #: deflection in the plane of each race below which its balls stay where they are, m
    sticking: tuple[float, ...]
    notes: tuple[Note, ...]  #: limits of validity and findings
    #: least and largest growth of small motions over the members of the reported state's family, 1/s, twice
    #: its own growth where it is the only member, shape (s, 2); None where it was not asked for
    growth_range: Array | None = None
    #: bands of speed in which the balanced state is stable, rad/s, their edges solved; None where they were
    #: not, as of a family of such states
    balanced_bands: tuple[tuple[float, float], ...] | None = None
    #: forces and clearances of the state reported where it is stable; None where the scene asks for none
    loads: MachineLoads | None = None
    #: what the sources' closed forms say of the rotor
    closed_forms: ClosedForms = field(default_factory=ClosedForms)
    liquid_model: str = ""  #: name of the liquid's model; empty without liquid
    #: estimated relative error of the state reported by that model, of amplitude and liquid the larger one,
    #: the balls held where they are, shape (s,); None without liquid
    error_estimate: Array | None = None
    #: gravity across the axis leaves liquid and balls on their walls, shape (s,); None where it does not act
    in_range: Flags | None = None
    #: above which a ring of liquid stands against it, rad/s; None where it does not act
    capture_speed: float | None = None
    gravity: GravityOnBalls | None = None  #: what it does to the balls; None where it does not act
    tolerance: float | None = None  #: relative error that the scene allows

    balancing = carried("closed_forms.balancing")
    cage_speed = carried("closed_forms.cage_speed")

    @property
    def speed(self) -> Array:
        """Spin speed, rad/s, shape (s,)."""
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
    def converged(self) -> Flags:
        """A state was found, shape (s,)."""
        return np.asarray(self.chosen >= 0)

    @property
    def stable(self) -> Flags:
        """Small motions about the state reported do not grow, shape (s,)."""
        return self._of_chosen(self.states.stable, False)

    @property
    def amplitude(self) -> Array:
        """Largest distance of the axis from where it rests, m, shape (s,)."""
        return self._of_chosen(self.sizes, np.nan)

    @property
    def deflection(self) -> Complex:
        """Forward part of the axis' motion in the drum, m, shape (s,)."""
        return self._of_chosen(self.forward, complex(np.nan, np.nan))

    @property
    def phase(self) -> Array:
        """Angle from the drum's zero mark to the deflection, rad, shape (s,)."""
        return np.asarray(np.angle(self.deflection))

    @property
    def state(self) -> NDArray[np.str_]:
        """How the balls rest: balanced, together or apart; none where nothing was found, shape (s,)."""
        kinds = self._of_chosen(self.states.kind, 0)
        return np.array([STATE_NAMES[kind] for kind in kinds.tolist()])

    @property
    def growth(self) -> Array:
        """Largest growth of small motions about the state reported, 1/s, below 0 where they fade."""
        return self._of_chosen(self.states.growth, np.nan)

    @property
    def family_dimension(self) -> Index:
        """Dimension of the family of the state reported, 0 of a single one, -1 without one, shape (s,)."""
        return self._of_chosen(self.states.dimension, -1)

    @property
    def elsewhere(self) -> Flags:
        """The member told is not stable, and others of its family are, shape (s,)."""
        if self.growth_range is None:
            return np.zeros(self.speed.shape, dtype=bool)
        return np.asarray(~self.stable & (self.growth_range[:, 0] <= GROWS * self.speed))

    @property
    def ball_angle(self) -> Array:
        """Angle of each ball from the drum's zero mark, rad, shape (s, N)."""
        return self._of_chosen(self.states.places, np.nan)

    @property
    def ball_unbalance(self) -> Array:
        """Size of the unbalance of all balls together, kg m, shape (s,)."""
        return np.asarray(np.abs(ball_moment(self.races, self.ball_angle)))

    @property
    def liquid_position(self) -> Complex:
        """Liquid's centre of mass from the rotation axis in the drum, m, shape (s,); nan without liquid."""
        if self.liquid_mass == 0.0:
            return np.full(self.speed.shape, complex(np.nan, np.nan))
        return np.asarray(self._of_chosen(self.liquid, complex(np.nan, np.nan)) / self.liquid_mass)

    @property
    def liquid_offset(self) -> Array:
        """Its distance from the rotation axis, m, shape (s,)."""
        return np.asarray(np.abs(self.liquid_position))

    @property
    def liquid_angle(self) -> Array:
        """Its angle from the drum's zero mark, rad, shape (s,)."""
        return np.asarray(np.angle(self.liquid_position))

    @property
    def dry_patch(self) -> Flags:
        """A wall is dry over its whole height somewhere, shape (s,)."""
        return self._of_chosen(self.dry, False)

    @property
    def model(self) -> NDArray[np.str_]:
        """What answers at each speed, shape (s,)."""
        return np.full(self.speed.shape, f"balls and {self.liquid_model}" if self.liquid_model else "balls")

    @property
    def balanced(self) -> Flags:
        """The balanced state is stable, shape (s,)."""
        wanted = self.states.kind == BallKind.BALANCED
        return np.asarray((wanted & self.states.stable).any(axis=1))

    @property
    def balanced_from(self) -> float:
        """Lowest speed from which on the balanced state is stable, rad/s; nan if at none.

        Of the scene's own speeds where the edges of bands were not solved.
        """
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

    def to_json(self) -> dict[str, Any]:
        """What `run` prints for scripts: SI units, radians, null for what is not there."""
        over = ["speed", "amplitude", "amplitude_dry", "amplitude_without", "phase", "liquid_offset"]
        over += ["liquid_angle", "dry_patch", "stable", "model", "state", "growth", "ball_angle"]
        over += ["ball_unbalance", "converged", "capacity", "can_balance", "sticking", "position", "name"]
        return {name: getattr(self, name) for name in (*over, "digest", "assumed")} | {
            "balanced_from": number_or_none(self.balanced_from),
            "growth_range": None if self.growth_range is None else finite(self.growth_range),
            "family_dimension": [None if size < 0 else size for size in self.family_dimension.tolist()],
            "states": [self._states_at(k) for k in range(self.speed.size)],
            "notes": texts(self.notes),
            **({} if self.loads is None else self.loads.to_json()),
            **self.closed_forms.to_json(),
            **({} if self.error_estimate is None else {"error_estimate": finite(self.error_estimate)}),
            **({} if self.in_range is None else {"in_range": self.in_range.tolist()}),
            **({} if self.gravity is None else {"gravity": self.gravity.to_json()}),
        }

    def _estimates(self) -> dict[str, Variable]:
        """Arrays of what the states leave out."""
        found = {} if self.gravity is None else self.gravity.variables()
        if self.error_estimate is not None:
            text = "by the liquid's model, the balls held where they are"
            found["error_estimate"] = var(("speed",), self.error_estimate, "1", "estimated error", text)
        if self.in_range is not None:
            text = "gravity leaves liquid and balls on their walls"
            found["in_range"] = flags(("speed",), self.in_range, "no yes", "in range", text)
        return found

    def _ranges(self) -> dict[str, Variable]:
        """Growth over the family, where it was asked for."""
        if self.growth_range is None:
            return {}
        text = "over all members of the state's family"
        least, largest = self.growth_range.T
        return {
            "growth_least": var(("speed",), least, "s-1", "least growth of small motions", text),
            "growth_largest": var(("speed",), largest, "s-1", "largest growth of small motions", text),
        }

    def _states_at(self, k: int) -> list[dict[str, Any]]:
        """All states at one speed."""
        found = self.states
        return [
            {
                "state": STATE_NAMES[int(found.kind[k, j])],
                "amplitude": float(self.sizes[k, j]),
                "stable": bool(found.stable[k, j]),
                "growth": float(found.growth[k, j]),
                "ball_angle": found.places[k, j].tolist(),
            }
            for j in np.flatnonzero(found.kind[k]).tolist()
        ]

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `speed`, `state` (those found) and `ball`."""
        over, every = ("speed",), ("speed", "state")
        kinds = " ".join(STATE_NAMES.values())
        here = "of the axis from where it rests, state reported"
        return NamedArrays(
            {
                "amplitude": var(over, self.amplitude, "m", "amplitude", here),
                "amplitude_without": var(over, self.amplitude_without, "m", "amplitude without balls"),
                "amplitude_dry": var(over, self.amplitude_dry, "m", "amplitude without balls and liquid"),
                "phase": var(over, self.phase, "rad", "angle of the deflection in the drum"),
                "stable": flags(over, self.stable, "no yes", "small motions do not grow"),
                "growth": var(over, self.growth, "s-1", "growth of small motions"),
                "ball_angle": var(("speed", "ball"), self.ball_angle, "rad", "angle of the ball in the drum"),
                "ball_unbalance": var(over, self.ball_unbalance, "kg m", "unbalance of all balls together"),
                "liquid_offset": var(over, self.liquid_offset, "m", "liquid's centre of mass from the axis"),
                "family_dimension": var(
                    over, self.family_dimension.astype(np.int32), "1", "dimension of the state's family"
                ),
                **self._ranges(),
                "state_kind": var(every, self.states.kind.astype(np.int32), "1", f"0 to 3: {kinds}"),
                "state_amplitude": var(every, self.sizes, "m", "amplitude of each state found"),
                "state_growth": var(every, self.states.growth, "s-1", "its growth of small motions"),
                **({} if self.loads is None else self.loads.variables()),
                **self.closed_forms.variables(),
                **self._estimates(),
            },
            coords={"speed": var(over, self.speed, "rad s-1", "spin speed")},
            attrs=attributes(
                self,
                "run",
                {"inputs": "\n".join(one_line("{}: {} [{}]".format(*entry)) for entry in self.inputs)},
                self.notes,
            ),
        )
