"""What `layer` answers: force under a whirl, settled or period by period, or a wave that runs by itself.

Angles run with the spin. In the frame of the deflection they start there, in the frame of the drum at a mark
on it; in both the origin is the geometric axis.
"""

from __future__ import annotations

import cmath
import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Annotated, Any, TypeAlias

import numpy as np

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Notes, Picture, Table, Words
from leblanc.core.notes import Note, texts
from leblanc.core.units import LENGTH, NUMBER, Dimension, in_rpm, number, unit_for, with_unit
from leblanc.liquid.notes import Number
from leblanc.studies.layer.wave import Wave
from meshes.arrays import Array, Complex
from meshes.quantity import Q
from solvers.liquid_history import LayerHistory

VALIDITY_HEAD = ("The model rests on", "value", "holds for", "that is")
GAP = Words("", shown="text")  # a line between tables
MOST_ANGLES = 24  # of a profile on a terminal
_HELP = {
    "statics": "less liquid or a smaller whirl may help",
    "linear": "friction takes the bound off: --model kdv or long_wave",
    "fem": "a whirl speed off the natural sloshing waves may help",
    "kdv": "friction may help, or --model long_wave",
    "long_wave": "friction or --duration may help",
    "potential": "a smaller wave or another speed may help; long_wave has hydraulic jumps",
}
_RATE, _AXES, _ROUND, _OVER = "rad s-1", ("along the deflection", "90 deg ahead of it"), ("theta",), ("time",)
Rows: TypeAlias = list[tuple[str, str]]


@dataclass(frozen=True)
class LayerCase:
    """The layer and the whirl of a question."""

    model: Annotated[str, Q(text="model of the liquid")]
    radius: Annotated[float, Q("m", "radius of the wall", json=False)]
    inner_radius: Annotated[float, Q("m", "radius of the inner wall", "0 without one", json=False)]
    mean_depth: Annotated[float, Q("m", "depth of the layer undisturbed", json=False)]
    speed: Annotated[float, Q(_RATE, "spin speed", json=False)]
    whirl_speed: float  #: in space, negative against the spin, rad/s
    whirl_amplitude: Annotated[float, Q("m", "radius of the whirl", "zero to peak", json=False)]
    solver: str = ""  #: of the model's equations, by its name in py-pde; empty where that does not solve them
    dispersion: Annotated[bool, Q(text="dispersion of the finite depth, in a model that may have it")] = False
    reason: str = ""  #: why that model was taken, where the question left it open

    @property
    def model_reason(self) -> Annotated[str, Q(text="why that model, where the question left it open")]:
        return self.reason

    @property
    def words(self) -> str:
        """The layer and its spin."""
        inner = f", inner wall {with_unit(self.inner_radius, LENGTH)}" if self.inner_radius > 0.0 else ""
        return (
            f"Wall of radius {with_unit(self.radius, LENGTH)}{inner}, mean depth "
            f"{with_unit(self.mean_depth, LENGTH)}; spin {in_rpm(self.speed)}"
        )


@dataclass(frozen=True)
class ExactWave:
    """Quantities of the fully nonlinear wave alone."""

    state: Annotated[str | None, Q(text="resolved; None where no wave was found")]
    branch: Annotated[str | None, Q(text="one_crest, many_crests, or lee_waves: shorter waves ride on it")]
    crest: Annotated[float, Q("1", "greatest depth over the mean depth")]
    trough: Annotated[float, Q("1", "least depth over the mean depth")]
    #: nan where the wave stands still in the drum
    crest_number: Annotated[
        float, Q("1", "speed of the liquid at the crest over its", "1 for the highest wave")
    ]
    error_estimate: Annotated[float, Q("1", "estimated error of the force, relative", data=False)]
    #: nan where the whirl that was asked for has a wave
    largest_whirl: Annotated[float, Q("m", "radius of the whirl at which waves of this speed end")]


@dataclass(frozen=True)
class ExactPeriods:
    """Quantities of the fully nonlinear wave in time alone."""

    state: Annotated[str, Q(text="resolved, short_waves that the nodes do not resolve, or broken")]
    crest: Annotated[float, Q("1", "greatest depth so far over the mean depth")]
    trough: Annotated[float, Q("1", "least depth so far over the mean depth")]
    crest_number: Annotated[float, Q("1", "greatest speed so far of the liquid at a crest over the crest's")]
    nodes: Annotated[int, Q("1", "nodes round the wall at the end")]
    force_gap: Annotated[
        float,
        Q("1", "largest difference of the forces by pressure and by momentum", "over the largest force"),
    ]


@dataclass(frozen=True, kw_only=True)
class _Layered(Answer):
    """What all answers on a layer have."""

    command, data = "layer", "layer.nc"
    figure = "leblanc.studies.layer.figure:layer_figure"

    case: Annotated[LayerCase, Q(part=True)]
    converged: Annotated[bool, Q(text="there is an answer")]
    in_range: Annotated[bool, Q(text="the model holds; validity and notes say why not")]
    validity: Annotated[tuple[Number, ...], Q(text="dimensionless numbers of the model, with their ranges")]
    notes: Annotated[tuple[Note, ...], Q(text="why there is no answer, and what the model leaves out")]
    #: of what goes through time again for a film: parameters of `study.layer_film`
    asked: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)
    profile: bool = True  #: the depth around the wall is printed

    @property
    def own(self) -> Mapping[str, Any]:
        yes = {True: "yes", False: "no"}
        return {
            "title": "Layer under a whirl",
            **asdict(self.case),
            "dispersion": yes[self.case.dispersion],
            "reason": self.case.reason or "the model was asked for",
            "converged": yes[self.converged],
            "in_range": yes[self.in_range],
        }

    @property
    def faults(self) -> tuple[str, ...]:
        reason = self.notes[0].text if self.notes else "no answer"
        return () if self.converged else (f"{reason}; {_HELP[self.case.model]}",)

    def to_json(self) -> dict[str, Any]:
        left_out = () if self.profile else ("theta", "depth")
        return {name: value for name, value in super().to_json().items() if name not in left_out}

    @property
    def about(self) -> str:
        """The layer and the whirl in words."""
        case = self.case
        whirl = f"whirl of {with_unit(case.whirl_amplitude, LENGTH)} at {in_rpm(case.whirl_speed)}"
        return f"{case.words}, {whirl}"

    @abstractmethod
    def facts(self) -> Rows:
        """The main numbers, as labels and values."""

    def tables(self) -> Iterator[Table]:
        """What else is printed of it."""
        if self.profile:
            yield depth_table(self.theta, self.depth)

    def blocks(self) -> tuple[Block, ...]:
        return (
            Words(self.about),
            Table(self.facts()),
            *(block for table in self.tables() if table.rows for block in (GAP, table)),
            GAP,
            Table(validity_rows(self.validity), VALIDITY_HEAD),
            Notes(texts(self.notes)),
            *self.pictures(),
        )

    def pictures(self) -> tuple[Picture, ...]:
        """Its figure, where there is anything to draw."""
        return (Picture("wave", "Wave on the annulus", self.figure),)

    def _model(self) -> Rows:
        """The model, why that one where the question left it open, and what of py-pde solves it."""
        case = self.case
        rows = [("Liquid model", case.model)]
        rows += [("Why that model", case.reason)] if case.reason else []
        return rows + ([("Solver of py-pde", case.solver)] if case.solver else [])

    def _verdict(self) -> Rows:
        """Whether there is an answer that holds."""
        wrong = "; ".join(str(entry) for entry in self.validity if not entry.in_range)
        verdict = "yes" if self.in_range else wrong or "no"
        return [("Converged", "yes" if self.converged else "no"), ("Model in range", verdict)]


@dataclass(frozen=True, kw_only=True)
class LayerAnswer(_Layered):
    """Force and centre of mass of a liquid layer; complex: along the deflection, 90 deg ahead of it.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.layer(radius="150 mm", volume="671 ml", height="50 mm", speed=40.0, whirl_speed=32.0,
    ...                  whirl_amplitude="0.15 mm")
    >>> f"{found.force_ratio.real:.4f}", found.in_range
    ('2.5615', True)
    """

    force_ratio: Annotated[
        complex,
        Q(
            "1",
            "force coefficient",
            "on the drum, over that of a full drum",
            axes=_AXES,
            error="error_estimate",
        ),
    ]
    offset: Annotated[complex, Q("m", "centre of mass", "from the drum's axis", axes=_AXES)]
    #: nan where the model has none
    error_estimate: Annotated[
        float, Q("1", "estimated error of the force coefficient", "over the larger of its size and 1")
    ]
    mass_error: Annotated[
        float, Q("1", "relative error of the liquid's volume", "of the surface that the model draws")
    ]
    mean_rotation: Annotated[float, Q(_RATE, "mean rotation in the drum")]
    wall_time: Annotated[float, Q("s", "time taken")]
    theta: Annotated[Array, Q("rad", "angle from the deflection, with the spin", over=_ROUND)]
    #: nan if no wave was found
    depth: Annotated[Array, Q("m", "depth of the layer", over=_ROUND)]
    gravity_offset: Annotated[float, Q("m", "steady offset by gravity, in space", "up is negative")]
    #: at the edge of the wall's layer; 0 without gravity, nan with baffles or without an annular layer
    wall_drift: Annotated[
        float,
        Q(_RATE, "mean drift along the wall by gravity", "in the drum, with the spin", by="waves, eq. 15"),
    ] = math.nan
    captured: Annotated[bool, Q(text="centrifugal acceleration at the surface exceeds gravity")]
    exact: Annotated[ExactWave | None, Q(part=True)] = None  #: None for other models

    @property
    def solver(self) -> Annotated[str, Q(text="solver of py-pde")]:
        return self.case.solver

    def wave(self) -> Wave:
        """The layer as figures show it."""
        return Wave(
            title="Layer under a whirl",
            **shape_of(self.case),
            whirl_amplitude=self.case.whirl_amplitude,
            whirl_speed=self.case.whirl_speed,
            theta=self.theta,
            depth=drawn_depth(self.depth, self.case),
            force_ratio=self.force_ratio,
            offset=self.offset,
            notes=texts(self.notes),
        )

    def facts(self) -> Rows:
        rate, error, exact = self.mean_rotation, self.error_estimate, self.exact
        rows = [*self._model(), ("Force coefficient", _at_angle(self.force_ratio))]
        rows += [("Its estimated error", number(error))] if math.isfinite(error) else []
        rows += [("Centre of mass", _at_angle(self.offset, LENGTH))]
        rows += [("Mean rotation in the drum", _rate(rate))]
        if self.gravity_offset != 0.0:
            offset = f"{with_unit(self.gravity_offset, LENGTH)} in space"
            rows += [("Centre of mass under gravity", offset)]
        if self.wall_drift < 0.0:
            rows += [("Drift along the wall by gravity", _rate(self.wall_drift))]
        if not self.captured:
            rows += [("Annulus not reached from rest", "gravity is stronger at its surface")]
        if exact is not None and exact.state is not None:
            rows += _shape(exact)
        elif exact is not None and math.isfinite(exact.largest_whirl):
            rows += [("Largest whirl with a wave", with_unit(exact.largest_whirl, LENGTH))]
        return [*rows, ("Error of the liquid's volume", number(self.mass_error)), *self._verdict()]


@dataclass(frozen=True, kw_only=True)
class FreeWaveAnswer(_Layered):
    """A wave that runs round the drum by itself, behind the drum or ahead of it, with one shape.

    The whirl speed of its case is that of the wave behind the drum.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.layer(radius="100 mm", volume="119.4 ml", height="20 mm", speed=1.0, model="potential",
    ...                  free=1.2)
    >>> [f"{speed:.4f}" for speed in found.whirl_speed]
    ['0.7512', '1.4952']
    """

    mode: Annotated[int, Q("1", "crests round the drum")]
    whirl_speed: Annotated[
        Array, Q(_RATE, "speed of the crests in space", over=("sense",), error="error_estimate")
    ]
    crest: Annotated[float, Q("1", "greatest depth over the mean depth")]
    trough: Annotated[float, Q("1", "least depth over the mean depth")]
    crest_number: Annotated[float, Q("1", "speed of the liquid at the crest over its")]
    branch: Annotated[str | None, Q(text="as of the fully nonlinear wave; None of a model without branches")]
    mass_error: Annotated[
        float, Q("1", "relative error of the liquid's volume", "of the surface that the model draws")
    ]
    #: nan where the model has none
    error_estimate: Annotated[float, Q("1", "estimated error of the speeds along the wall", "relative")]
    wall_time: Annotated[float, Q("s", "time taken")]
    theta: Annotated[Array, Q("rad", "angle from a crest, with the spin", over=_ROUND)]
    depth: Annotated[Array, Q("m", "depth of the layer", over=_ROUND)]

    @property
    def sense(self) -> Annotated[Array, Q("1", "behind the drum, ahead of it", over=("sense",), json=False)]:
        return np.array([-1, 1])

    def wave(self) -> Wave:
        """The wave behind the drum as figures show it; the one ahead has the same shape."""
        return Wave(
            title="Natural sloshing wave"
            if self.mode == 1
            else f"Natural sloshing wave of {self.mode} crests",
            **shape_of(self.case),
            whirl_amplitude=0.0,
            whirl_speed=self.case.whirl_speed if self.converged else self.case.speed,
            theta=self.theta,
            depth=self.depth,
            force_ratio=complex(math.nan, math.nan),
            offset=complex(math.nan, math.nan),
            notes=texts(self.notes),
            towards="crest",
        )

    @property
    def about(self) -> str:
        return self.case.words

    def facts(self) -> Rows:
        rows = [*self._model(), ("Crests", f"{self.mode}")]
        if self.converged:
            behind, ahead = (in_rpm(float(speed)) for speed in self.whirl_speed)
            rows += [("Crests go round, behind the drum", behind), ("Crests go round, ahead of it", ahead)]
            rows += _shape(self)
            if math.isfinite(self.error_estimate):
                rows += [("Estimated error of the speed", number(self.error_estimate))]
            rows += [("Error of the liquid's volume", number(self.mass_error))]
        return rows + self._verdict()


@dataclass(frozen=True, kw_only=True)
class PeriodsAnswer(_Layered):
    """Whirl periods of a layer that starts from rest in its drum; k periods, n angles.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.layer(radius="150 mm", volume="671 ml", height="50 mm", speed=40.0, whirl_speed=32.0,
    ...                  whirl_amplitude="0.15 mm", model="long_wave", cells=32,
    ...                  duration="2 s", ramp="1 s")
    >>> found.converged, found.history.time.shape == found.history.force_ratio.shape
    (True, True)
    """

    figure = "leblanc.studies.layer.figure:periods_figure"

    history: LayerHistory  #: as the solver gives it
    exact: Annotated[ExactPeriods | None, Q(part=True)] = None  #: None for other models

    @property
    def solver(self) -> Annotated[str, Q(text="solver of py-pde")]:
        return self.case.solver

    @property
    def time(self) -> Annotated[Array, Q("s", "middle of the whirl period", over=_OVER)]:
        return self.history.time

    @property
    def force_ratio(
        self,
    ) -> Annotated[Complex, Q("1", "force coefficient by momentum", over=_OVER, axes=_AXES)]:
        return self.history.force_ratio

    @property
    def pressure_ratio(
        self,
    ) -> Annotated[Complex, Q("1", "force coefficient by pressure", over=_OVER, axes=_AXES)]:
        return self.history.pressure_ratio

    @property
    def offset(self) -> Annotated[Complex, Q("m", "centre of mass", over=_OVER, axes=_AXES)]:
        return self.history.offset

    @property
    def mean_rotation(self) -> Annotated[Array, Q(_RATE, "mean rotation in the drum", over=_OVER)]:
        return self.history.mean_rotation

    @property
    def depth_max(self) -> Annotated[Array, Q("m", "largest depth", "mean over the period", over=_OVER)]:
        return self.history.depth_max

    @property
    def depth_min(self) -> Annotated[Array, Q("m", "least depth", "mean over the period", over=_OVER)]:
        return self.history.depth_min

    @property
    def theta(self) -> Annotated[Array, Q("rad", "angle from the deflection, with the spin", over=_ROUND)]:
        return self.history.theta

    @property
    def depth(self) -> Annotated[Array, Q("m", "depth of the layer at the end", over=_ROUND)]:
        return self.history.depth

    @property
    def end(self) -> Annotated[Array, Q("s", "start, and ends of the periods", over=("end",), json=False)]:
        return self.history.ends.time

    @property
    def angle(self) -> Annotated[Array, Q("rad", "angle in the drum", over=("angle",), json=False)]:
        return self.history.ends.theta

    @property
    def depths(
        self,
    ) -> Annotated[
        Array, Q("m", "depth of the layer over time and angle", over=("end", "angle"), json=False)
    ]:
        return self.history.ends.depth

    @property
    def deflection(
        self,
    ) -> Annotated[
        Complex,
        Q("m", "deflection seen from the drum", over=("end",), axes=("angle 0", "90 deg ahead"), json=False),
    ]:
        return self.history.ends.deflection

    @property
    def mass_error(self) -> Annotated[float, Q("1", "relative change of the liquid's volume")]:
        return self.history.mass_error

    def facts(self) -> Rows:
        rows = self._model()
        if not self.time.size:
            return [*rows, ("Answer", self.history.reason), *self._exact()]
        rows += [("Whirl periods", f"{self.time.size}")]
        rows += [("Force coefficient of the last one", _at_angle(complex(self.force_ratio[-1])))]
        rows += [("Mean rotation in the drum", _rate(float(self.mean_rotation[-1])))]
        return rows + self._exact() + self._verdict()

    def _exact(self) -> Rows:
        """Quantities of the fully nonlinear wave in time alone."""
        exact = self.exact
        if exact is None:
            return []
        return [
            ("State of the wave", exact.state.replace("_", " ")),
            ("Deepest and shallowest", f"{number(exact.crest)} and {number(exact.trough)} mean depths"),
            ("Speed of the liquid at a crest", f"up to {number(exact.crest_number)} of the crest's"),
            ("Nodes round the wall", f"{exact.nodes}"),
            ("Gap of the two forces", number(exact.force_gap)),
        ]

    def tables(self) -> Iterator[Table]:
        unit = unit_for(LENGTH, *self.depth_max.tolist(), *np.abs(self.offset).tolist())
        head = (
            "time (s)", "force coefficient", "at (deg)", "by pressure", "rotation (rad/s)",
            f"deepest ({unit.name})", f"shallowest ({unit.name})", f"centre of mass ({unit.name})",
        )  # fmt: skip
        rows = [
            (
                number(float(self.time[k])),
                number(abs(complex(self.force_ratio[k]))),
                number(math.degrees(cmath.phase(complex(self.force_ratio[k])))),
                number(abs(complex(self.pressure_ratio[k]))),
                number(float(self.mean_rotation[k])),
                unit.number(float(self.depth_max[k])),
                unit.number(float(self.depth_min[k])),
                unit.number(abs(complex(self.offset[k]))),
            )
            for k in range(self.time.size)
        ]
        yield Table(rows, head, right=True)

    def pictures(self) -> tuple[Picture, ...]:
        return (Picture("periods", "Whirl periods of a layer", self.figure),) if self.time.size else ()


AnyLayerAnswer: TypeAlias = LayerAnswer | PeriodsAnswer | FreeWaveAnswer


def drawn_depth(depth: Array, case: LayerCase) -> Array:
    """Depths for a picture: of the layer at rest where no wave was found, shape (k,), m."""
    return np.where(np.isnan(depth), case.mean_depth, depth)


def shape_of(case: LayerCase) -> dict[str, Any]:
    """What a picture of a wave takes from its case."""
    names = ("model", "radius", "inner_radius", "mean_depth")
    return {name: getattr(case, name) for name in names} | {"spin": case.speed}


def validity_rows(numbers: tuple[Number, ...]) -> list[tuple[str, ...]]:
    """Dimensionless numbers, each with the range of the model: cells of `VALIDITY_HEAD`."""
    rows: list[tuple[str, ...]] = []
    for entry in numbers:
        most, least = math.inf if entry.most is None else entry.most, entry.least or 0.0
        allowed = f"at least {number(least)}" if math.isinf(most) else f"{number(least)} to {number(most)}"
        if entry.least is None and entry.most is None:
            allowed = "any"
        value = f"{number(entry.value)}{'' if entry.in_range else ', OUT OF RANGE'}"
        rows.append((entry.name.replace("_", " "), value, allowed, entry.meaning))
    return rows


def depth_table(theta: Array, depth: Array) -> Table:
    """The depth around the wall, at no more than `MOST_ANGLES` of its angles."""
    unit = unit_for(LENGTH, *depth.tolist())
    step = max(1, math.ceil(theta.size / MOST_ANGLES))
    rows = [
        (number(math.degrees(float(angle))), unit.number(float(deep)))
        for angle, deep in zip(theta[::step], depth[::step], strict=True)
    ]
    every = f", one in {step} of {theta.size}" if step > 1 else ""
    return Table(rows, (f"angle (deg){every}", f"depth ({unit.name})"), right=True, shown="text")


def _shape(wave: ExactWave | FreeWaveAnswer) -> Rows:
    """Kind and size of a wave, as labels and values."""
    rows = [("Kind of wave", wave.branch.replace("_", " "))] if wave.branch else []
    rows += [("Deepest and shallowest", f"{number(wave.crest)} and {number(wave.trough)} mean depths")]
    if math.isfinite(wave.crest_number):
        rows += [("Speed of the liquid at the crest", f"{number(wave.crest_number)} of the crest's")]
    return rows


def _rate(value: float) -> str:
    """An angular velocity, or that the model has none."""
    return f"{number(value)} rad/s" if math.isfinite(value) else "not known to this model"


def _at_angle(value: complex, dimension: Dimension = NUMBER) -> str:
    """Size and angle from the deflection."""
    if not cmath.isfinite(value):
        return "not found"
    angle = f"{number(round(math.degrees(cmath.phase(value))))} deg from the deflection"
    size = with_unit(abs(value), dimension) if dimension.unit else number(abs(value))
    return f"{size} at {angle}"
