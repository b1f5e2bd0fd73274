"""Unknown values of a scene from what was measured: least squares from several starts [theory: fit]."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from leblanc import units
from leblanc.results.base import Note
from leblanc.results.fit import POOR, REACH, FitCode, FitResult, Measured, fit_notes, poor_note
from leblanc.scene.scene import Scene, dry_rotor, require_no_balls
from leblanc.scene.schema.load import SceneError
from leblanc.studies.drives import numerics_of, planned
from leblanc.studies.models.choose import across_gravity, choose_all, liquid_models, prepare
from leblanc.studies.runup import chosen_run, drive_of
from leblanc.units import Dimension
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.runup.runup import RunupHistory
from solvers.synchronous.response import Response, response

FIELD = "measured"
MOST_ROWS = 100_000
_HEAD = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
# Of the first guess: how far off the other starts are.
_SPREAD = 2.0
# Left of a measured quantity where the scene has no answer with some values, over its size.
_NO_ANSWER = 1e3
# Of the logarithms, for derivatives; the peaks of run-ups whose walls run dry jump by a per cent.
_STEP, _PEAK_STEP = 1e-4, 2e-2
# What may have either sign is looked for about its first guess in steps of these, m and rad.
_SPANS = {"position": 0.1, "angle": 1.0}
_ALIKE = 0.05  # two answers whose unknowns differ by less than this are one
_OVER = {"speed": units.ANGULAR_SPEED, "time": units.TIME, "added": units.VOLUME}
SCALES = ("given", "free", "each")
_QUANTITIES = {
    "amplitude": units.LENGTH,
    "peak": units.LENGTH,
    "phase": units.ANGLE,
    "liquid_offset": units.LENGTH,
    "liquid_angle": units.ANGLE,
}
_ANGLES = ("phase", "liquid_angle")


@dataclass(frozen=True)
class Measurement:
    """What was measured on a machine."""

    over: str  #: "speed", "time", or "added" for liquid added to the first chamber
    at: Array  #: rad/s, s or m^3, rising, shape (n,)
    columns: tuple[tuple[str, Array], ...]  #: name and values of each quantity, SI, shape (n,)


def read_measured(path: str | PathLike[str], coordinates: Sequence[str], free: bool = False) -> Measurement:
    """A table of measured values: a header of names with units, then numbers, commas between them.

    Parameters
    ----------
    path : of the file, as in "speed [rpm], amplitude [mm]"
    coordinates : of the rotor, which may be measured over time
    free : the scale of the quantities is not known, their units are any

    Raises
    ------
    InputError : no such file, a column that is none of these, a value that is no number
    """
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as fault:
        raise InputError(FIELD, str(path), f"a table of text that can be read ({fault})") from fault
    rows = [row for row in csv.reader(text.splitlines()) if row and not row[0].lstrip().startswith("#")]
    if len(rows) < 3 or len(rows) > MOST_ROWS:
        raise InputError(FIELD, f"{len(rows)} rows", f"a header and from 2 to {MOST_ROWS} rows of numbers")
    heads = [_head(cell, k, coordinates, free) for k, cell in enumerate(rows[0])]
    over = [name for name, _ in heads if name in _OVER]
    if len(over) != 1 or len(heads) < 2:
        raise InputError(
            FIELD, ", ".join(rows[0]), "speed, time or added, one of them, and what was measured over it"
        )
    values = np.array([_numbers(row, len(heads), k + 2) for k, row in enumerate(rows[1:])])
    values = values * np.array([factor for _, factor in heads])
    columns = {name: values[:, k] for k, (name, _) in enumerate(heads)}
    order = np.argsort(columns[over[0]], kind="stable")
    at = columns.pop(over[0])[order]
    if over[0] == "speed" and not (at > 0.0).all():
        raise InputError(FIELD, float(at.min()), "speeds above 0")
    if over[0] == "added" and not (at >= 0.0).all():
        raise InputError(FIELD, float(at.min()), "volumes of at least 0")
    return Measurement(over[0], at, tuple((name, column[order]) for name, column in columns.items()))


def _head(cell: str, k: int, coordinates: Sequence[str], free: bool) -> tuple[str, float]:
    """Name of a column and the SI value of its unit."""
    found = _HEAD.fullmatch(cell)
    turns = {"alpha", "beta", "gamma"}
    known = (
        _OVER | _QUANTITIES | {name: units.ANGLE if name in turns else units.LENGTH for name in coordinates}
    )
    if found is None or found[1] not in known:
        raise InputError(
            f"{FIELD}, column {k + 1}", cell, "one of " + ", ".join(known) + ", as in speed [rpm]"
        )
    name, unit = found[1], found[2] or ""
    if free and name not in (*_OVER, *_ANGLES):
        return name, 1.0
    return name, _unit(unit, known[name], f"{FIELD}, column {k + 1}")


def _unit(unit: str, dimension: Dimension, field: str) -> float:
    return units.parse(f"1 {unit}" if unit else 1.0, dimension, field)


def _numbers(row: Sequence[str], count: int, line: int) -> list[float]:
    try:
        found = [float(cell) for cell in row]
    except ValueError as fault:
        raise InputError(f"{FIELD}, row {line}", ", ".join(row), "numbers with decimal points") from fault
    if len(found) != count or not all(map(math.isfinite, found)):
        raise InputError(f"{FIELD}, row {line}", ", ".join(row), f"{count} finite numbers")
    return found


def require_scale(scale: str, field: str = "scale") -> str:
    """What is known of the scale of the measured lengths.

    Parameters
    ----------
    scale : "given", "free" for one factor of all lengths, "each" for one of every quantity
    field : what it is called where it was typed

    Raises
    ------
    InputError : none of them
    """
    if scale not in SCALES:
        raise InputError(field, scale, "one of " + ", ".join(SCALES))
    return scale


def fit_scene(
    scene: Scene,
    measurement: Measurement,
    unknown: Sequence[str],
    starts: int = 4,
    seed: int = 0,
    scale: str = "given",
    progress: Callable[[float], None] | None = None,
) -> FitResult:
    """Values of a scene that bring its answer closest to what was measured [theory: fit, eq. 1-3].

    Parameters
    ----------
    scene : the machine; its values are the first guess
    measurement : of the steady response over speed, of the scene's run-up over time, or of amplitude at its
        last speed and largest amplitude over liquid added
    unknown : paths of the unknowns in the scene
    starts : searches, the first from the scene's values, the others from values up to twice as large or small
    seed : of the others
    scale : "given"; "free": that of the measured lengths is not known, one factor for all of them is found as
        well; "each": one for every quantity
    progress : called with the share of the starts that is done

    Raises
    ------
    InputError : no unknown, one that is no number above 0 in the scene, fewer points than unknowns
    """
    from scipy.optimize import least_squares

    if measurement.over != "time":
        require_no_balls(scene, f"a fit over {measurement.over}; with balls it takes a run-up over time")
    first = _first(scene, unknown)
    points = measurement.at.size * len(measurement.columns)
    problem = _Problem(scene, tuple(unknown), first, measurement, require_scale(scale))
    if points <= len(unknown) + problem.factors:
        raise InputError("unknown", len(unknown), f"fewer than the {points} measured values")
    problem.residual(np.zeros(len(unknown)))
    limit, random = math.log(REACH), np.random.default_rng(seed)
    begins = np.log(_SPREAD) * random.uniform(-1.0, 1.0, (max(starts, 1) - 1, len(unknown)))
    tried: list[Any] = []
    for k, begin in enumerate([np.zeros(len(unknown)), *begins]):
        tried.append(
            least_squares(
                problem.residual, begin, bounds=(-limit, limit), x_scale=0.1, diff_step=problem.step
            )
        )
        if progress is not None:
            progress((k + 1) / max(starts, 1))
    best = min(tried, key=lambda each: float(each.cost))
    return problem.result(best, tried, limit)


def _others(tried: Sequence[Any], best: Any, told: Flags) -> int:
    """Searches that ended elsewhere, by unknowns that the data tell, with an answer as good to a tenth."""
    alike = [each.cost <= 1.1 * best.cost + 1e-18 for each in tried]
    far = [float(np.abs(each.x - best.x)[told].max(initial=0.0)) > _ALIKE for each in tried]
    return sum(good and other for good, other in zip(alike, far, strict=True))


def _first(scene: Scene, unknown: Sequence[str]) -> Array:
    """First guess of each unknown, SI."""
    if not unknown:
        raise InputError("unknown", "none", "at least one path such as rotor.mass")
    found, table = [], scene.table()
    for k, path in enumerate(unknown):
        if path in unknown[:k]:
            raise InputError("unknown", path, "different paths")
        value: Any = table
        signed = _span(path) is not None
        try:
            for key in path.split("."):
                value = value[int(key)] if isinstance(value, list | tuple) else value[key]
        except (KeyError, IndexError, TypeError, ValueError) as fault:
            raise InputError("unknown", path, "the path of a value that stands in the scene") from fault
        if isinstance(value, bool) or not isinstance(value, int | float) or not (signed or value > 0.0):
            allowed = "the path of a number above 0, or of a position or angle, the first guess"
            raise InputError("unknown", path, allowed)
        found.append(float(value))
    return np.array(found)


def _span(path: str) -> float | None:
    """Step of an unknown that may have either sign, m or rad; None where its logarithm is looked for."""
    names = [key for key in path.split(".") if not key.isdigit()]
    return _SPANS.get(names[-1])


@dataclass
class _Problem:
    """The residual of a fit over its unknowns, by their logarithms or steps from the first guess."""

    scene: Scene
    unknown: tuple[str, ...]
    first: Array
    measurement: Measurement
    scale: str
    evaluations: int = 0

    @property
    def factors(self) -> int:
        """How many factors of lengths are found besides the unknowns."""
        lengths = sum(name not in _ANGLES for name, _ in self.measurement.columns)
        return {"given": 0, "free": 1, "each": lengths}[self.scale]

    @property
    def step(self) -> float:
        """Of the logarithms, for derivatives."""
        return _PEAK_STEP if any(name == "peak" for name, _ in self.measurement.columns) else _STEP

    @property
    def spans(self) -> Array:
        """Steps of unknowns that may have either sign, nan of those whose logarithm is looked for."""
        return np.array([np.nan if (span := _span(path)) is None else span for path in self.unknown])

    def values(self, logs: Array) -> Array:
        """The unknowns, SI [theory: fit, eq. 5]."""
        spans = self.spans
        return np.where(np.isnan(spans), self.first * np.exp(logs), self.first + spans * logs)

    def answer(self, logs: Array) -> list[Array]:
        """The measured quantities by the scene with other values, before they are scaled."""
        values = dict(zip(self.unknown, self.values(logs).tolist(), strict=True))
        self.evaluations += 1
        names = [name for name, _ in self.measurement.columns]
        return _answer(self.scene.replace(values), self.measurement.over, self.measurement.at, names)

    def scales(self, found: Sequence[Array]) -> list[float]:
        """Best factor of each quantity [theory: fit, eq. 2]; 1 of angles, and where it is given."""
        pairs = list(zip(found, self.measurement.columns, strict=True))
        if self.scale == "each":
            return [1.0 if name in _ANGLES else _factor([(own, value)]) for own, (name, value) in pairs]
        lengths = [(own, value) for own, (name, value) in pairs if name not in _ANGLES]
        common = _factor(lengths) if self.scale == "free" else 1.0
        return [1.0 if name in _ANGLES else common for name, _ in self.measurement.columns]

    def residual(self, logs: Array) -> Array:
        """What is left of each quantity over the root of its mean square, shape (n columns,)."""
        try:
            found = self.answer(logs)
        except (InputError, SceneError):
            if self.evaluations <= 1:
                raise
            found = []
        if not found or not all(np.isfinite(part).all() for part in found):
            return np.full(self.measurement.at.size * len(self.measurement.columns), _NO_ANSWER)
        parts = []
        for own, (name, value), scale in zip(
            found, self.measurement.columns, self.scales(found), strict=True
        ):
            if name in _ANGLES:
                parts.append(np.angle(np.exp(1j * (own - value))))
            else:
                parts.append((scale * own - value) / _size(value))
        return np.concatenate(parts)

    def result(self, best: Any, tried: Sequence[Any], limit: float) -> FitResult:
        """What was found, with its uncertainty from the curvature about it [theory: fit, eq. 3]."""
        found, count = self.answer(best.x), best.fun.size
        scales, value = self.scales(found), self.values(best.x)
        edge = [abs(abs(x) - limit) < 1e-6 for x in best.x.tolist()]
        std, correlation = _uncertainty(best.jac, float(best.fun @ best.fun), count - self.factors)
        std = std * np.where(np.isnan(self.spans), value, self.spans)
        others = _others(tried, best, np.isfinite(std))
        notes = fit_notes(self.unknown, value, std, correlation, edge, others, self.spans)
        notes += self._scale_notes(scales)
        rms = float(np.sqrt(np.mean(np.square(best.fun))))
        if rms > POOR:
            notes.append(poor_note(rms))
        if self.measurement.over == "speed" and best.fun @ best.fun < 1e-18 * count:
            text = "The scene meets the data to rounding: their noise is not known, nor are the errors."
            notes.append(Note(FitCode.NO_SPREAD, {}, text))
        parts = []
        for own, (name, measured), scale in zip(found, self.measurement.columns, scales, strict=True):
            unit = "rad" if name in (*_ANGLES, "alpha", "beta", "gamma") else "m"
            if self.scale != "given" and name not in _ANGLES:
                own, unit = scale * own, ""
            parts.append(Measured(name, unit, measured, own))
        scene = self.scene
        return FitResult(
            name=scene.name,
            source=scene.source,
            assumed=scene.assumed,
            digest=scene.digest,
            unknown=self.unknown,
            value=value,
            std=std,
            first=self.first,
            correlation=correlation,
            over=self.measurement.over,
            at=self.measurement.at,
            measured=tuple(parts),
            scale=next((s for s in scales if s != 1.0), 1.0),
            residual_rms=rms,
            converged=bool(best.success) and bool((best.fun < _NO_ANSWER).all()),
            evaluations=self.evaluations,
            notes=tuple(notes),
            signed=tuple(path for path in self.unknown if _span(path) is not None),
            freedom=count - len(self.unknown) - self.factors,
        )

    def _scale_notes(self, scales: Sequence[float]) -> list[Note]:
        """The factors that were found."""
        if self.scale == "free":
            scale = next((s for s in scales if s != 1.0), 1.0)
            text = f"One factor for all lengths was found as well: {units.number(scale)} of the scene's."
            return [Note(FitCode.SCALE, {"scale": scale}, text)]
        names = [name for name, _ in self.measurement.columns]
        pairs = {name: s for name, s in zip(names, scales, strict=True) if name not in _ANGLES}
        if self.scale == "given" or not pairs:
            return []
        told = ", ".join(f"{name} {units.number(s)}" for name, s in pairs.items())
        text = f"A factor for each quantity was found as well, of the scene's: {told}."
        return [Note(FitCode.SCALE, {"scale": pairs}, text)]


def _factor(pairs: Sequence[tuple[Array, Array]]) -> float:
    """The factor that brings some arrays closest to others, taken together."""
    squares = sum(float(own @ own) for own, _ in pairs)
    return sum(float(own @ value) for own, value in pairs) / squares if squares > 0.0 else 1.0


def _size(value: Array) -> float:
    """Root of the mean square, 1 where all is 0."""
    return float(np.sqrt(np.mean(np.square(value)))) or 1.0


def _uncertainty(jacobian: Array, squares: float, count: int) -> tuple[Array, Array]:
    """Standard errors of the logarithms, nan where nothing tells them, and their correlation.

    Parameters
    ----------
    jacobian : of the residual, shape (n, p)
    squares : sum of the residual's squares
    count : n, less what else was found
    """
    unknowns = jacobian.shape[1]
    _, size, turn = np.linalg.svd(jacobian, full_matrices=False)
    told = size > 1e-7 * max(float(size.max()), 1e-300)
    noise = squares / max(count - unknowns, 1)
    inverse = np.where(told, 1.0 / np.where(told, size, 1.0), 0.0)
    covariance = noise * (turn.T * np.square(inverse)) @ turn
    lost = np.abs(turn[~told]).max(axis=0, initial=0.0) > 1e-3
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    outer = np.outer(deviation, deviation)
    correlation = np.divide(covariance, outer, out=np.eye(unknowns), where=outer > 0.0)
    return np.where(lost, np.nan, deviation), correlation


def _answer(scene: Scene, over: str, at: Array, names: Sequence[str]) -> list[Array]:
    """Quantities of a scene at measured speeds or times, or with liquid added."""
    if over == "speed":
        speed, where = np.unique(at, return_inverse=True)
        found = _steady(scene, speed)
        return [np.asarray(_quantity(found, name))[where] for name in names]
    if over == "added":
        filled = [_with_more(scene, volume) for volume in at.tolist()]
        return [np.array([_of_fill(each, name) for each in filled]) for name in names]
    history = _history(scene)
    own = {name: history.coordinates[:, k] for k, name in enumerate(dry_rotor(scene).system().coordinates)}
    own["amplitude"] = history.amplitude
    for name in names:
        if name not in own:
            raise InputError(FIELD, name, "measured over speed or liquid added, or one of " + ", ".join(own))
    return [np.interp(at, history.time, own[name], right=np.nan) for name in names]


def _with_more(scene: Scene, volume: float) -> Scene:
    """The scene with more liquid in its first chamber, m^3."""
    return scene.replace({"chambers.0.volume": scene.liquids[0].volume + volume})


def _of_fill(scene: Scene, name: str) -> float:
    """A quantity of one fill: the steady amplitude at the last speed, the largest one of the run-up, m."""
    if name == "peak":
        return float(_history(scene).amplitude.max())
    if name == "amplitude":
        return float(_steady(scene, np.array([scene.speeds.stop])).amplitude[0])
    raise InputError(FIELD, name, "amplitude or peak over liquid added")


def _history(scene: Scene) -> RunupHistory:
    """The scene's run-up or programme, without the second run that tells its error."""
    plan = planned(scene)
    drive, numerics = drive_of(plan, scene.rotor), numerics_of(plan, check=False)
    return chosen_run(scene, drive, across_gravity(scene), numerics).history


def _steady(scene: Scene, speed: Array) -> Response:
    """Synchronous response at some speeds by the liquid model that the scene asks for."""
    if scene.model.liquid not in ("auto", "statics", "linear"):
        raise InputError("model.liquid", scene.model.liquid, "auto, statics or linear for a fit over speed")
    machine = replace(prepare(scene), speed=speed)
    (choice,) = choose_all([machine])
    return response(machine.rotor, scene.fills, speed, machine.axial_gravity, liquid_models(choice))


def _quantity(found: Response, name: str) -> Array:
    """A measured quantity of a response."""
    if name == "phase":
        return np.angle(found.deflection)
    if name not in ("amplitude", "liquid_offset", "liquid_angle"):
        raise InputError(
            FIELD, name, "measured over time, or one of amplitude, phase, liquid_offset, liquid_angle"
        )
    return np.asarray(getattr(found, name))
