"""What the liquid answers to one prescribed whirl, and the wave that figures show of it.

Angles run with the spin. In the frame of the deflection they start there, in the frame of the drum at a mark
on it; in both the origin is the geometric axis.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from leblanc.core.answer import Result, carried, versions
from leblanc.core.netcdf import NamedArrays, variable
from leblanc.core.notes import Note, NoteCode, one_line, percent, texts
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.liquid_history import LayerHistory

FEWEST = 3  # angles of a wave
SLACK = 1e-9  # rounding of a depth, over the radius


class LayerCode(NoteCode):
    """What the notes of a layer say."""

    NO_ANSWER = "no_answer"
    OUT_OF_RANGE = "out_of_range"
    INNER_WALL = "inner_wall"
    AGAINST_WHIRL = "against_whirl"
    DRY_WALL = "dry_wall"
    LEE_WAVES = "lee_waves"
    NO_SMOOTH_WAVE = "no_smooth_wave"
    NO_EXACT_WAVE = "no_exact_wave"
    TWO_GRIDS = "two_grids"
    FRICTION_FREQUENCY = "friction_frequency"


@dataclass(frozen=True)
class Number:
    """A dimensionless number and the range in which the model holds."""

    name: str  #: what it is
    meaning: str
    value: float  #: not finite where it has no bound or was not found
    least: float | None  #: the model's range; None where it sets none
    most: float | None
    in_range: bool  #: the value is within

    def __str__(self) -> str:
        least, most = self.least or 0.0, math.inf if self.most is None else self.most
        allowed = f"at least {least:g}" if math.isinf(most) else f"{least:g} to {most:g}"
        return f"{self.meaning} = {self.value:.2g}, the model's range is {allowed}"


def no_answer(reason: str) -> Note:
    """Why there is no answer, or none to rely on."""
    return Note(LayerCode.NO_ANSWER, {}, reason)


def out_of_range(numbers: tuple[Number, ...]) -> tuple[Note, ...]:
    """The numbers that are out of their range, a note for each."""
    return tuple(
        Note(LayerCode.OUT_OF_RANGE, asdict(number), str(number)) for number in numbers if not number.in_range
    )


def inner_wall() -> Note:
    """The surface reaches the inner wall."""
    return Note(LayerCode.INNER_WALL, {}, "the surface reaches the inner wall")


def against_whirl(share: float) -> Note:
    """The liquid answers against the whirl as well, at a share of its answer with the whirl."""
    text = f"the liquid also answers against the whirl, {share:.3g} times as strongly"
    return Note(LayerCode.AGAINST_WHIRL, {"share": share}, text)


def dry_wall() -> Note:
    """The wall is dry in part."""
    return Note(LayerCode.DRY_WALL, {}, "the wall is dry in part")


def lee_waves() -> Note:
    """Shorter waves ride on the wave of the whirl."""
    return Note(LayerCode.LEE_WAVES, {}, "shorter waves ride on the wave, as they do in the lee of a whirl")


def no_smooth_wave(whirl: float, largest: float, fold: bool) -> Note:
    """The whirl is larger than any up to which a smooth steady wave follows it: in place of its number.

    Parameters
    ----------
    whirl, largest : of the axis, and where such waves end, over the mean depth
    fold : they end at a fold, above the resonance; else the flow chokes
    """
    way = "it turns back" if fold else "the flow chokes"
    text = f"no smooth steady wave follows a whirl as it grows to {whirl:.2g} of the mean depth: "
    text += f"without friction {way} at {largest:.2g}"
    return Note(LayerCode.NO_SMOOTH_WAVE, {"whirl": whirl, "largest": largest, "fold": fold}, text)


def no_exact_wave(reason: str) -> Note:
    """Why no exact wave was found where the closed form has a smooth one, so that another model answers."""
    return Note(LayerCode.NO_EXACT_WAVE, {}, f"no smooth exact wave was found: {reason}")


def two_grids(gap: float) -> Note:
    """The whirl is larger than smooth waves follow: the error is that between two grids."""
    text = (
        "without friction no smooth steady wave follows so large a whirl: this one is as steep as the cells "
    )
    text += f"let it be, and the force on half as many differs by {percent(gap)}"
    return Note(LayerCode.TWO_GRIDS, {"gap": gap}, text)


def friction_frequency(frequency: float, alone: bool) -> Note:
    """The one frequency that laminar friction takes where gravity acts across the axis.

    Parameters
    ----------
    frequency : seen from the drum, rad/s
    alone : nothing else moves; else it is a mean of that of the whirl and that of gravity
    """
    of = "gravity, which turns in the drum" if alone else "whirl and gravity, weighted with their energies"
    text = f"laminar friction is that of {frequency:.4g} rad/s seen from the drum, the frequency of {of}"
    return Note(LayerCode.FRICTION_FREQUENCY, {"frequency": frequency}, text)


@dataclass(frozen=True)
class LayerCase:
    """The layer and the whirl of a question."""

    model: str  #: of the liquid
    radius: float  #: wall, inner wall (0 if none), layer undisturbed, m
    inner_radius: float
    mean_depth: float
    speed: float  #: spin; whirl in space, negative against the spin, rad/s
    whirl_speed: float
    whirl_amplitude: float  #: m
    solver: str = ""  #: of the model's equations, by its name in py-pde; empty where that does not solve them
    dispersion: bool = False  #: of the finite depth, in a model that may have it or not
    reason: str = ""  #: why that model was taken, where the question left it open


@dataclass(frozen=True)
class ExactWave:
    """What the exact wave alone can tell."""

    state: str | None  #: "resolved"; in time also "short_waves" or "broken"; None where no wave was found
    branch: str | None  #: "one_crest", "many_crests", or "lee_waves" where shorter waves ride on it
    crest: float  #: greatest and least depth over the mean depth
    trough: float
    #: speed of the liquid at the crest over that of the crest, 1 for the highest wave; nan where the wave
    #: stands still in the drum
    crest_number: float
    error_estimate: float  #: of the force, relative; in time the gap between pressure and momentum
    #: at which waves of this speed end, or up to which they were found, m; nan where the whirl that was asked
    #: for has a wave
    largest_whirl: float


@dataclass(frozen=True)
class ExactPeriods:
    """What the exact wave in time alone can tell."""

    state: str  #: "resolved", "short_waves" that the nodes do not resolve, or "broken"
    crest: float  #: greatest and least depth so far over the mean depth
    trough: float
    crest_number: float  #: greatest speed so far of the liquid at a crest over that of the crest
    nodes: int  #: round the wall at the end
    force_gap: float  #: largest difference of the forces by pressure and by momentum, over the largest force


@dataclass(frozen=True)
class LayerResult(Result):
    """Force and centre of mass of a liquid layer; complex: along the deflection, 90 deg ahead of it.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.layer(radius="150 mm", volume="671 ml", height="50 mm", speed=40.0, whirl_speed=32.0,
    ...                  whirl_amplitude="0.15 mm")
    >>> f"{found.force_ratio.real:.4f}", found.in_range
    ('2.5615', True)
    """

    case: LayerCase  #: the layer and the whirl
    force_ratio: complex  #: force on the drum over m_f omega_w^2 A
    offset: complex  #: liquid's centre of mass from the drum's axis, m
    #: of the force ratio, over the larger of its size and 1; nan where the model has none
    error_estimate: float
    mass_error: float  #: of the surface that the model draws, relative
    converged: bool  #: the force is finite
    in_range: bool  #: the model holds; `validity` and `notes` say why not
    mean_rotation: float  #: of the liquid relative to the drum, rad/s
    wall_time: float  #: s
    #: angle from the deflection, rad, and depth of the layer there, m, nan if no wave was found, shape (k,)
    theta: Array
    depth: Array
    notes: tuple[Note, ...]  #: what the model leaves out here
    #: steady part of the offset under gravity across the axis, in space, m: up is negative
    gravity_offset: float
    captured: bool  #: centrifugal acceleration at the surface exceeds gravity
    validity: tuple[Number, ...]  #: dimensionless numbers the model rests on, each with its range
    exact: ExactWave | None = None  #: what the exact wave alone tells; None for other models

    solver, model, model_reason = carried("case.solver"), carried("case.model"), carried("case.reason")
    dispersion = carried("case.dispersion")
    figure = "leblanc.figures.wave:layer_figure"
    summary = "leblanc.text.liquid:layer_summary"

    def wave(self) -> Wave:
        """The layer as figures show it."""
        return Wave(
            title="Layer under a whirl",
            model=self.case.model,
            radius=self.case.radius,
            inner_radius=self.case.inner_radius,
            mean_depth=self.case.mean_depth,
            whirl_amplitude=self.case.whirl_amplitude,
            spin=self.case.speed,
            whirl_speed=self.case.whirl_speed,
            theta=self.theta,
            depth=drawn_depth(self.depth, self.case),
            force_ratio=self.force_ratio,
            offset=self.offset,
            notes=texts(self.notes),
        )

    def to_json(self, profile: bool = True) -> dict[str, Any]:
        """What `layer` prints for scripts, SI and radians.

        Parameters
        ----------
        profile : with the depth around the wall
        """
        names = ["force_ratio", "error_estimate", "offset", "mass_error", "converged", "in_range"]
        names += ["mean_rotation", "wall_time", *(("theta", "depth") if profile else ())]
        found: dict[str, Any] = {name: getattr(self, name) for name in names}
        return found | {
            **_taken(self.case),
            "solver": self.solver,
            "notes": texts(self.notes),
            "gravity_offset": self.gravity_offset,
            "captured": self.captured,
            "validity": tuple(map(asdict, self.validity)),
            **({} if self.exact is None else asdict(self.exact)),
        }

    def named_arrays(self) -> NamedArrays:
        """The depth over `theta`; everything else in variables without a dimension and in attributes."""
        along = ("theta",)
        columns = {
            "depth": variable(along, self.depth, "m", "depth of the layer"),
            "force_ratio_real": variable((), self.force_ratio.real, "1", "force ratio, along the deflection"),
            "force_ratio_imag": variable((), self.force_ratio.imag, "1", "force ratio, 90 deg ahead of it"),
            "offset_real": variable((), self.offset.real, "m", "centre of mass, along the deflection"),
            "offset_imag": variable((), self.offset.imag, "m", "centre of mass, 90 deg ahead of it"),
            "mean_rotation": variable((), self.mean_rotation, "rad s-1", "mean rotation in the drum"),
            "error_estimate": variable((), self.error_estimate, "1", "estimated error of the force ratio"),
            "mass_error": variable((), self.mass_error, "1", "relative error of the liquid's volume"),
            "gravity_offset": variable((), self.gravity_offset, "m", "steady offset by gravity, in space"),
        }
        coords = {"theta": variable(along, self.theta, "rad", "angle from the deflection, with the spin")}
        return NamedArrays(columns, coords, _attributes(self.case, self.converged, self.in_range, self.notes))


@dataclass(frozen=True)
class FreeWaveResult(Result):
    """A wave that runs round the drum by itself, behind the drum or ahead of it, with one shape.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.layer(radius="100 mm", volume="119.4 ml", height="20 mm", speed=1.0, model="potential",
    ...                  free=1.2)
    >>> [f"{speed:.4f}" for speed in found.whirl_speed]
    ['0.7512', '1.4952']
    """

    case: LayerCase  #: the layer; its whirl speed is that of the wave behind the drum, its whirl none
    mode: int  #: crests round the drum
    #: at which the crests go round in space, behind the drum and ahead of it, rad/s, shape (2,)
    whirl_speed: Array
    crest: float  #: as of `ExactWave`; no branch of a model that tells none
    trough: float
    crest_number: float
    branch: str | None
    converged: bool  #: the wave was found
    in_range: bool  #: the model holds; `validity` and `notes` say why not
    mass_error: float  #: of the surface that the model draws, relative
    error_estimate: float  #: of the speeds along the wall, relative; nan where the model has none
    wall_time: float  #: s
    theta: Array  #: angle from a crest, rad, and depth of the layer there, m, shape (k,)
    depth: Array
    notes: tuple[Note, ...]  #: why there is no answer, and where the model is out of its range
    validity: tuple[Number, ...]  #: dimensionless numbers the model rests on, each with its range

    model, model_reason = carried("case.model"), carried("case.reason")
    dispersion = carried("case.dispersion")
    figure = "leblanc.figures.wave:layer_figure"
    summary = "leblanc.text.liquid:free_wave_summary"

    def wave(self) -> Wave:
        """The wave behind the drum as figures show it; the one ahead has the same shape."""
        return Wave(
            title="Free wave" if self.mode == 1 else f"Free wave of {self.mode} crests",
            model=self.case.model,
            radius=self.case.radius,
            inner_radius=self.case.inner_radius,
            mean_depth=self.case.mean_depth,
            whirl_amplitude=0.0,
            spin=self.case.speed,
            whirl_speed=self.case.whirl_speed if self.converged else self.case.speed,
            theta=self.theta,
            depth=self.depth,
            force_ratio=complex(math.nan, math.nan),
            offset=complex(math.nan, math.nan),
            notes=texts(self.notes),
            towards="crest",
        )

    def to_json(self, profile: bool = True) -> dict[str, Any]:
        """What `layer --free` prints for scripts, SI and radians.

        Parameters
        ----------
        profile : with the depth around the wall
        """
        names = ("mode", "whirl_speed", "crest", "trough", "crest_number", "branch", "converged", "in_range")
        names += ("mass_error", "error_estimate", "wall_time", *(("theta", "depth") if profile else ()))
        found: dict[str, Any] = {name: getattr(self, name) for name in names}
        shown = {"validity": tuple(map(asdict, self.validity)), "notes": texts(self.notes)}
        return found | _taken(self.case) | shown

    def named_arrays(self) -> NamedArrays:
        """The depth over `theta`, the two speeds over `sense`; the rest without a dimension."""
        columns = {
            "depth": variable(("theta",), self.depth, "m", "depth of the layer"),
            "whirl_speed": variable(("sense",), self.whirl_speed, "rad s-1", "speed of the crests in space"),
            "crest": variable((), self.crest, "1", "greatest depth over the mean depth"),
            "trough": variable((), self.trough, "1", "least depth over the mean depth"),
            "crest_number": variable((), self.crest_number, "1", "speed of the liquid at the crest over its"),
        }
        coords = {
            "theta": variable(("theta",), self.theta, "rad", "angle from a crest, with the spin"),
            "sense": variable(("sense",), np.array([-1, 1]), "1", "behind the drum, ahead of it"),
        }
        return NamedArrays(columns, coords, _attributes(self.case, self.converged, self.in_range, self.notes))


@dataclass(frozen=True)
class LayerPeriodsResult(Result):
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

    case: LayerCase  #: the layer and the whirl
    history: LayerHistory  #: force, centre of mass and depths period by period, and the depth at the end
    notes: tuple[Note, ...]  #: why there is no answer, and where the model is out of its range
    validity: tuple[Number, ...]  #: dimensionless numbers the model rests on, each with its range
    exact: ExactPeriods | None = None  #: what the exact wave alone tells; None for other models

    solver, model, model_reason = carried("case.solver"), carried("case.model"), carried("case.reason")
    dispersion = carried("case.dispersion")
    figure = "leblanc.figures.wave:periods_figure"
    summary = "leblanc.text.liquid:periods_summary"

    @property
    def converged(self) -> bool:
        """Every period was finished."""
        return self.history.converged

    @property
    def in_range(self) -> bool:
        """The model holds."""
        return all(note.code == LayerCode.FRICTION_FREQUENCY for note in self.notes)

    time = carried("history.time")
    force_ratio = carried("history.force_ratio")
    mean_rotation = carried("history.mean_rotation")
    depth_max = carried("history.depth_max")
    depth_min = carried("history.depth_min")
    offset = carried("history.offset")
    pressure_ratio = carried("history.pressure_ratio")
    mass_error = carried("history.mass_error")
    theta = carried("history.theta")
    depth = carried("history.depth")

    def to_json(self, profile: bool = True) -> dict[str, Any]:
        """What `layer --duration` prints for scripts, SI and radians.

        Parameters
        ----------
        profile : with the depth around the wall at the end
        """
        names = ("time", "force_ratio", "mean_rotation", "depth_max", "depth_min", "offset", "pressure_ratio")
        names += ("mass_error", "converged", *(("theta", "depth") if profile else ()))
        found: dict[str, Any] = {name: getattr(self.history, name) for name in names}
        return found | {
            **_taken(self.case),
            "solver": self.solver,
            "in_range": self.in_range,
            "validity": tuple(map(asdict, self.validity)),
            "notes": texts(self.notes),
            **({} if self.exact is None else asdict(self.exact)),
        }

    def named_arrays(self) -> NamedArrays:
        """Means over whirl periods over `time`, the depth at the end over `theta`."""
        h, over = self.history, ("time",)
        columns = {
            "mean_rotation": variable(over, h.mean_rotation, "rad s-1", "mean rotation in the drum"),
            "depth_max": variable(over, h.depth_max, "m", "largest depth"),
            "depth_min": variable(over, h.depth_min, "m", "least depth"),
            "depth": variable(("theta",), h.depth, "m", "depth of the layer at the end"),
            "mass_error": variable((), h.mass_error, "1", "relative change of the liquid's volume"),
        }
        parts = (("real", "along the deflection"), ("imag", "90 deg ahead of it"))
        for name, unit, text in (
            ("force_ratio", "1", "force ratio by momentum"),
            ("pressure_ratio", "1", "force ratio by pressure"),
            ("offset", "m", "centre of mass"),
        ):
            for part, where in parts:
                values = getattr(getattr(h, name), part)
                columns[f"{name}_{part}"] = variable(over, values, unit, f"{text}, {where}")
        coords = {
            "time": variable(over, h.time, "s", "middle of the whirl period"),
            "theta": variable(("theta",), h.theta, "rad", "angle from the deflection, with the spin"),
        }
        return NamedArrays(columns, coords, _attributes(self.case, self.converged, self.in_range, self.notes))


def drawn_depth(depth: Array, case: LayerCase) -> Array:
    """Depths for a picture: of the layer at rest where no wave was found, shape (k,), m."""
    return np.where(np.isnan(depth), case.mean_depth, depth)


def _taken(case: LayerCase) -> dict[str, Any]:
    """The model that answered, and why where the question left it open."""
    return {"model": case.model, "dispersion": case.dispersion, "model_reason": case.reason}


def _attributes(case: LayerCase, converged: bool, in_range: bool, notes: tuple[Note, ...]) -> dict[str, Any]:
    """The question, whether it was answered, versions."""
    return {
        "title": "Layer under a whirl",
        **asdict(case),
        "dispersion": "yes" if case.dispersion else "no",
        "reason": case.reason or "the model was asked for",
        "converged": "yes" if converged else "no",
        "in_range": "yes" if in_range else "no",
        "notes": "\n".join(map(one_line, texts(notes))) or "none",
        "history": "written by leblanc layer",
        **{f"version_{package}": version for package, version in versions().items()},
    }


@dataclass(frozen=True)
class Wave:
    """A layer under a prescribed whirl as figures show it, in the frame of the deflection.

    Raises
    ------
    InputError : a value out of its range, arrays that do not fit together
    """

    title: str  #: of the figure; of the liquid
    model: str
    radius: float  #: wall, inner wall (0 if none), layer undisturbed, m
    inner_radius: float
    mean_depth: float
    whirl_amplitude: float  #: m
    spin: float  #: rad/s; the spin positive, the whirl in space and negative against it
    whirl_speed: float
    theta: Array  #: angle from the deflection in any order, rad, and depth there, m, shape (n,), n > 2
    depth: Array
    #: on the drum over that of a full drum; along the deflection, 90 deg ahead; nan if none found
    force_ratio: complex
    offset: complex  #: centre of mass from the geometric axis, same axes, m; nan if none was found
    notes: tuple[str, ...] = ()  #: limits of validity and findings, in words
    #: what lies at angle 0: the "deflection", or a "crest" of a wave that no whirl holds
    towards: str = "deflection"

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)
        require_not_negative("inner_radius", self.inner_radius)
        require_not_negative("mean_depth", self.mean_depth)
        if self.inner_radius + self.mean_depth > self.radius * (1.0 + SLACK):
            raise InputError("mean_depth", self.mean_depth, "at most the room between the walls")
        require_not_negative("whirl_amplitude", self.whirl_amplitude)
        require_positive("spin", self.spin)
        if not math.isfinite(self.whirl_speed):
            raise InputError("whirl_speed", self.whirl_speed, "a finite number")
        _require_angles(self.theta)
        _require_depth(self.depth, self.theta.shape, self.radius)

    @property
    def seen_from_the_drum(self) -> float:
        """Whirl speed less spin speed, rad/s."""
        return self.whirl_speed - self.spin

    def require_room(self, frames: WaveFrames) -> None:
        """Raise `InputError` unless the depths of some frames fit the wall."""
        _require_depth(frames.depth, frames.depth.shape, self.radius)


@dataclass(frozen=True)
class WaveFrames:
    """A layer over time, in the frame of the drum.

    Raises
    ------
    InputError : values out of their range, arrays that do not fit together
    """

    time: Array  #: rising, s, shape (k,)
    theta: Array  #: angle from a mark on the drum, rad, shape (n,), n > 2
    depth: Array  #: m, shape (k, n)
    deflection: Complex  #: complex, the mark on the real axis, m, shape (k,); of a free wave towards a crest
    #: means over periods of the whirl seen from the drum: force as in `Wave`, middle of the period, s, and
    #: the liquid's rotation in the drum, rad/s; shape (p,)
    force_ratio: Complex | None = None
    period_time: Array | None = None
    mean_rotation: Array | None = None

    def __post_init__(self) -> None:
        count = self.time.size
        if self.time.ndim != 1 or not count or not np.isfinite(self.time).all():
            raise InputError("time", self.time.shape, "a list of at least one finite time")
        if np.any(np.diff(self.time) <= 0.0):
            raise InputError("time", "not rising", "rising")
        _require_angles(self.theta)
        _require_depth(self.depth, (count, self.theta.size), math.inf)
        if self.deflection.shape != (count,) or not np.isfinite(self.deflection).all():
            raise InputError("deflection", self.deflection.shape, f"finite and of shape {(count,)}")
        means = (self.force_ratio, self.period_time, self.mean_rotation)
        shapes = {None if mean is None else mean.shape for mean in means}
        if len(shapes) > 1:
            raise InputError("force_ratio", str(shapes), "of the shape of period_time and mean_rotation")


def _require_angles(theta: Array) -> None:
    if theta.ndim != 1 or theta.size < FEWEST or not np.isfinite(theta).all():
        raise InputError("theta", theta.shape, f"a list of at least {FEWEST} finite angles")


def _require_depth(depth: Array, shape: tuple[int, ...], radius: float) -> None:
    if depth.shape != shape:
        raise InputError("depth", depth.shape, f"of shape {shape}")
    slack = SLACK * radius if math.isfinite(radius) else 0.0
    low, high = float(np.min(depth)), float(np.max(depth))
    if not (math.isfinite(low) and math.isfinite(high) and -slack <= low and high <= radius + slack):
        raise InputError("depth", (low, high), "finite, 0 or above, and at most the radius")
