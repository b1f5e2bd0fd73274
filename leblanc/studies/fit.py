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
from leblanc.results.fit import FitCode, FitResult, Measured, fit_notes
from leblanc.scene.scene import Scene
from leblanc.scene.schema.load import SceneError
from leblanc.studies.drives import numerics_of, planned
from leblanc.studies.models.choose import across_gravity, choose_all, liquid_models, prepare
from leblanc.studies.runup import chosen_run, drive_of
from leblanc.units import Dimension
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.synchronous.response import Response, response

FIELD = "measured"
MOST_ROWS = 100_000
_HEAD = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
# Of the first guess: how far the search looks, and how far off its other starts are.
_REACH, _SPREAD = 100.0, 2.0
# Left of a measured quantity where the scene has no answer with some values, over its size.
_NO_ANSWER = 1e3
_ALIKE = 0.05  # two answers whose unknowns differ by less than this are one
_OVER = {"speed": units.ANGULAR_SPEED, "time": units.TIME}
_QUANTITIES = {
    "amplitude": units.LENGTH,
    "phase": units.ANGLE,
    "liquid_offset": units.LENGTH,
    "liquid_angle": units.ANGLE,
}
_ANGLES = ("phase", "liquid_angle")


@dataclass(frozen=True)
class Measurement:
    """What was measured on a machine.

    Parameters
    ----------
    over : "speed" or "time"
    at : rad/s or s, rising, shape (n,)
    columns : name and values of each quantity, SI, shape (n,)
    """

    over: str
    at: Array
    columns: tuple[tuple[str, Array], ...]


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
            FIELD, ", ".join(rows[0]), "speed or time, one of them, and what was measured over it"
        )
    values = np.array([_numbers(row, len(heads), k + 2) for k, row in enumerate(rows[1:])])
    values = values * np.array([factor for _, factor in heads])
    columns = {name: values[:, k] for k, (name, _) in enumerate(heads)}
    order = np.argsort(columns[over[0]], kind="stable")
    at = columns.pop(over[0])[order]
    if over[0] == "speed" and not (at > 0.0).all():
        raise InputError(FIELD, float(at.min()), "speeds above 0")
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


def is_free(scale: str, field: str = "scale") -> bool:
    """Whether the scale of the measured lengths is found as well.

    Parameters
    ----------
    scale : "given" or "free"
    field : what it is called where it was typed
    """
    if scale not in ("given", "free"):
        raise InputError(field, scale, "given or free")
    return scale == "free"


def fit_scene(
    scene: Scene,
    measurement: Measurement,
    unknown: Sequence[str],
    starts: int = 4,
    seed: int = 0,
    free: bool = False,
    progress: Callable[[float], None] | None = None,
) -> FitResult:
    """Values of a scene that bring its answer closest to what was measured [theory: fit, eq. 1-3].

    Parameters
    ----------
    scene : the machine; its values are the first guess
    measurement : of the steady response over speed, or of the scene's run-up over time
    unknown : paths of the unknowns in the scene
    starts : searches, the first from the scene's values, the others from values up to twice as large or small
    seed : of the others
    free : the scale of the measured lengths is not known: one factor for all of them is found as well
    progress : called with the share of the starts that is done

    Raises
    ------
    InputError : no unknown, one that is no number above 0 in the scene, fewer points than unknowns
    """
    from scipy.optimize import least_squares

    first = _first(scene, unknown)
    points = measurement.at.size * len(measurement.columns)
    if points <= len(unknown) + int(free):
        raise InputError("unknown", len(unknown), f"fewer than the {points} measured values")
    problem = _Problem(scene, tuple(unknown), first, measurement, free)
    problem.residual(np.zeros(len(unknown)))
    limit, random = math.log(_REACH), np.random.default_rng(seed)
    begins = np.log(_SPREAD) * random.uniform(-1.0, 1.0, (max(starts, 1) - 1, len(unknown)))
    tried: list[Any] = []
    for k, begin in enumerate([np.zeros(len(unknown)), *begins]):
        tried.append(
            least_squares(problem.residual, begin, bounds=(-limit, limit), x_scale=0.1, diff_step=1e-4)
        )
        if progress is not None:
            progress((k + 1) / max(starts, 1))
    best = min(tried, key=lambda each: float(each.cost))
    return problem.result(best, _others(tried, best), limit)


def _others(tried: Sequence[Any], best: Any) -> int:
    """Searches that ended elsewhere with an answer that is as good to a tenth."""
    alike = [each.cost <= 1.1 * best.cost + 1e-18 for each in tried]
    far = [float(np.abs(each.x - best.x).max()) > _ALIKE for each in tried]
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
        try:
            for key in path.split("."):
                value = value[int(key)] if isinstance(value, list | tuple) else value[key]
        except (KeyError, IndexError, TypeError, ValueError) as fault:
            raise InputError("unknown", path, "the path of a value that stands in the scene") from fault
        if isinstance(value, bool) or not isinstance(value, int | float) or not value > 0.0:
            raise InputError("unknown", path, "the path of a number above 0, the first guess")
        found.append(float(value))
    return np.array(found)


@dataclass
class _Problem:
    """The residual of a fit as a function of the logarithms of its unknowns over the first guess."""

    scene: Scene
    unknown: tuple[str, ...]
    first: Array
    measurement: Measurement
    free: bool
    evaluations: int = 0

    def answer(self, logs: Array) -> list[Array]:
        """The measured quantities by the scene with other values, before they are scaled."""
        values = dict(zip(self.unknown, (self.first * np.exp(logs)).tolist(), strict=True))
        self.evaluations += 1
        names = [name for name, _ in self.measurement.columns]
        return _answer(self.scene.replace(values), self.measurement.over, self.measurement.at, names)

    def scale(self, found: Sequence[Array]) -> float:
        """Best factor of all lengths; 1 where it is not free."""
        if not self.free:
            return 1.0
        pairs = zip(found, self.measurement.columns, strict=True)
        lengths = [(own, value) for own, (name, value) in pairs if name not in _ANGLES]
        squares = sum(float(own @ own) for own, _ in lengths)
        return sum(float(own @ value) for own, value in lengths) / squares if squares > 0.0 else 1.0

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
        scale = self.scale(found)
        parts = []
        for own, (name, value) in zip(found, self.measurement.columns, strict=True):
            if name in _ANGLES:
                parts.append(np.angle(np.exp(1j * (own - value))))
            else:
                parts.append((scale * own - value) / _size(value))
        return np.concatenate(parts)

    def result(self, best: Any, others: int, limit: float) -> FitResult:
        """What was found, with its uncertainty from the curvature about it [theory: fit, eq. 3]."""
        found, count = self.answer(best.x), best.fun.size
        scale, value = self.scale(found), self.first * np.exp(best.x)
        edge = [abs(abs(x) - limit) < 1e-6 for x in best.x.tolist()]
        std, correlation = _uncertainty(best.jac, float(best.fun @ best.fun), count - int(self.free))
        std = std * value
        notes = fit_notes(self.unknown, value, std, correlation, edge, others)
        if self.free:
            text = f"One factor for all lengths was found as well: {units.number(scale)} of the scene's."
            notes.append(Note(FitCode.SCALE, {"scale": scale}, text))
        if self.measurement.over == "speed" and best.fun @ best.fun < 1e-18 * count:
            text = "The scene meets the data to rounding: their noise is not known, nor are the errors."
            notes.append(Note(FitCode.NO_SPREAD, {}, text))
        parts = []
        for own, (name, measured) in zip(found, self.measurement.columns, strict=True):
            unit = "rad" if name in (*_ANGLES, "alpha", "beta", "gamma") else "m"
            if self.free and name not in _ANGLES:
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
            scale=scale,
            residual_rms=float(np.sqrt(np.mean(np.square(best.fun)))),
            converged=bool(best.success) and bool((best.fun < _NO_ANSWER).all()),
            evaluations=self.evaluations,
            notes=tuple(notes),
        )


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
    """Quantities of a scene at measured speeds or times."""
    if over == "speed":
        speed, where = np.unique(at, return_inverse=True)
        found = _steady(scene, speed)
        return [np.asarray(_quantity(found, name))[where] for name in names]
    plan = planned(scene)
    taken = chosen_run(
        scene, drive_of(plan, scene.rotor), across_gravity(scene), numerics_of(plan, check=False)
    )
    history = taken.history
    own = {name: history.coordinates[:, k] for k, name in enumerate(prepare(scene).system.coordinates)}
    own["amplitude"] = history.amplitude
    return [np.interp(at, history.time, own[name], right=np.nan) for name in names]


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
        raise InputError(FIELD, name, "measured over time, or one of " + ", ".join(_QUANTITIES))
    return np.asarray(getattr(found, name))
