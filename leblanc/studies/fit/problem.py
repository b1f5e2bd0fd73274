"""The scene's answer to a measurement over its unknowns, and their residuals."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from leblanc.liquid.choose import across_gravity, choose_all, liquid_models, models_at, prepare
from leblanc.liquid.models import synchronous_model
from leblanc.scene.scene import JeffcottRotor, Scene, dry_rotor
from leblanc.scene.schema.load import SceneError
from leblanc.studies.drives import drive_of, numerics_of, planned
from leblanc.studies.fit.answer import REACH
from leblanc.studies.fit.measured import ANGLES, FIELD, SIZES, TURNS, Measurement
from leblanc.studies.runup.study import chosen_run
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.runup.runup import RunupHistory
from solvers.synchronous.response import Response, joined, machine_responses, response

# Left of a measured quantity where the scene has no answer with some values, over its size.
NO_ANSWER = 1e3
# Of the logarithms, for derivatives; the peaks of run-ups whose walls run dry jump by a per cent.
_STEP, _PEAK_STEP = 1e-4, 2e-2
# What may have either sign is looked for about its first guess in steps of these, m and rad.
_SPANS = {"position": 0.1, "angle": 1.0}
# Of the largest measured value: below it logarithms are cut off, in the search alone.
_CUT = 1e-3
LIMIT = math.log(REACH)
_KEPT = 4096  # answers; a search asks again for what the one before it has asked
SCALES = ("given", "free", "each")

Residual = Callable[[Array], Array]


def ties_of(scene: Scene, unknown: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Paths that are one unknown each, from texts such as "rotor.mass" or "A=B", which ties B to A."""
    if not unknown:
        raise InputError("unknown", "none", "at least one path such as rotor.mass")
    found = tuple(tuple(path.strip() for path in text.split("=")) for text in unknown)
    paths = [path for group in found for path in group]
    for k, path in enumerate(paths):
        if path in paths[:k]:
            raise InputError("unknown", path, "different paths")
        first_guess(scene, path)
    return found


def first_guess(scene: Scene, path: str) -> float:
    """Value of the scene at a path, SI."""
    value: Any = scene.table()
    try:
        for key in path.split("."):
            value = value[int(key)] if isinstance(value, list | tuple) else value[key]
    except (KeyError, IndexError, TypeError, ValueError) as fault:
        raise InputError("unknown", path, "the path of a value that stands in the scene") from fault
    signed = span_of(path) is not None
    if isinstance(value, bool) or not isinstance(value, int | float) or not (signed or value > 0.0):
        allowed = "the path of a number above 0, or of a position or angle, the first guess"
        raise InputError("unknown", path, allowed)
    return float(value)


def span_of(path: str) -> float | None:
    """Step of an unknown that may have either sign, m or rad; None where its logarithm is looked for."""
    names = [key for key in path.split(".") if not key.isdigit()]
    return _SPANS.get(names[-1]) if names else None


def require_scale(scale: str) -> str:
    """What is known of the scale of the measured lengths."""
    if scale not in SCALES:
        raise InputError("scale", scale, "one of " + ", ".join(SCALES))
    return scale


@dataclass
class Problem:
    """The answers of a scene over its unknowns, by their logarithms or steps from the first guess."""

    scene: Scene
    unknown: tuple[tuple[str, ...], ...]  #: paths that are tied to one value, p of them
    first: Array  #: SI, shape (p,)
    measurement: Measurement
    scale: str
    evaluations: int = 0
    kept: dict[bytes, list[Array] | None] = field(default_factory=dict)

    @property
    def names(self) -> list[str]:
        """The measured quantities."""
        return [name for name, _ in self.measurement.columns]

    @property
    def count(self) -> int:
        """Measured values."""
        return self.measurement.at.size * len(self.measurement.columns)

    @property
    def factors(self) -> int:
        """How many factors of lengths are found besides the unknowns."""
        lengths = sum(name not in ANGLES for name in self.names)
        return {"given": 0, "free": 1, "each": lengths}[self.scale]

    @property
    def freedom(self) -> int:
        """Measured values less all that is found."""
        return self.count - len(self.unknown) - self.factors

    @property
    def spans(self) -> Array:
        """Steps of unknowns that may have either sign, nan of those whose logarithm is looked for."""
        found = [span_of(group[0]) for group in self.unknown]
        return np.array([np.nan if span is None else span for span in found])

    @property
    def sizes(self) -> list[float]:
        """Root of the mean square of each quantity, 1 where all is 0."""
        return [float(np.sqrt(np.mean(np.square(value)))) or 1.0 for _, value in self.measurement.columns]

    def values(self, x: Array) -> Array:
        """The unknowns, SI [theory: fit, eq. 5]."""
        spans = self.spans
        return np.where(np.isnan(spans), self.first * np.exp(x), self.first + spans * x)

    def with_values(self, x: Array) -> Scene:
        """The scene with other values."""
        pairs = zip(self.unknown, self.values(x).tolist(), strict=True)
        return self.scene.replace({path: value for group, value in pairs for path in group})

    def answer(self, x: Array) -> list[Array] | None:
        """The measured quantities by the scene with other values, before they are scaled.

        None where the scene has no answer with them; that of the first guess is raised.
        """
        key = np.ascontiguousarray(x).tobytes()
        if key in self.kept:
            return self.kept[key]
        found: list[Array] | None = None
        try:
            measured = self.measurement
            found = answer(self.with_values(x), measured.over, measured.at, self.names)
        except (InputError, SceneError, np.linalg.LinAlgError):
            if not self.evaluations:
                raise
        return self._keep(x, found)

    def ahead(self, points: Sequence[Array]) -> None:
        """Answers at several values at once, kept: of planar rotors they take little longer than one."""
        fresh = [x for x in points if np.ascontiguousarray(x).tobytes() not in self.kept]
        if self.measurement.over != "speed" or not isinstance(self.scene.rotor, JeffcottRotor):
            return
        answered, scenes = [], []
        for x in fresh:
            try:
                scenes.append(self.with_values(x))
                answered.append(x)
            except (InputError, SceneError):
                continue
        if len(scenes) < 2:
            return
        speed, where = np.unique(self.measurement.at, return_inverse=True)
        try:
            responses = planar_steady(scenes, speed)
        except (InputError, np.linalg.LinAlgError):
            return  # one by one it is seen which of them has no answer
        for x, own in zip(answered, responses, strict=True):
            self._keep(x, [np.asarray(_quantity(own, name))[where] for name in self.names])

    def _keep(self, x: Array, found: list[Array] | None) -> list[Array] | None:
        """An answer, kept; None where some of it is not finite."""
        self.evaluations += 1
        if found is not None and not all(np.isfinite(part).all() for part in found):
            found = None
        if len(self.kept) >= _KEPT:
            self.kept.clear()
        self.kept[np.ascontiguousarray(x).tobytes()] = found
        return found

    def scales(self, found: Sequence[Array], sigma: Sequence[Array] | None = None) -> list[float]:
        """Best factor of each quantity [theory: fit, eq. 2]; 1 of angles, and where it is given."""
        weights = [1.0 / each for each in sigma] if sigma is not None else [np.ones(1)] * len(found)
        triples = list(zip(found, self.measurement.columns, weights, strict=True))
        if self.scale == "each":
            return [
                1.0 if name in ANGLES else _factor([(own * weight, value * weight)])
                for own, (name, value), weight in triples
            ]
        lengths = [(own * w, value * w) for own, (name, value), w in triples if name not in ANGLES]
        common = _factor(lengths) if self.scale == "free" else 1.0
        return [1.0 if name in ANGLES else common for name in self.names]

    def scaled(self, x: Array, sigma: Sequence[Array] | None = None) -> list[Array] | None:
        """The scene's answer in the scale of the sensors."""
        found = self.answer(x)
        if found is None:
            return None
        return [own * s for own, s in zip(found, self.scales(found, sigma), strict=True)]

    def left(self, found: Sequence[Array]) -> list[Array]:
        """Answer less what was measured, angles by their difference on the circle."""
        return [
            np.angle(np.exp(1j * (own - value))) if name in ANGLES else own - value
            for own, (name, value) in zip(found, self.measurement.columns, strict=True)
        ]

    def weighted(self, sigma: Sequence[Array]) -> Residual:
        """Residual of each value over its error sigma [theory: fit, eq. 1], shape (n columns,)."""

        def residual(x: Array) -> Array:
            found = self.scaled(x, sigma)
            if found is None:
                worst = [np.full(self.measurement.at.size, NO_ANSWER * size) for size in self.sizes]
                return np.concatenate([each / s for each, s in zip(worst, sigma, strict=True)])
            return np.concatenate([each / s for each, s in zip(self.left(found), sigma, strict=True)])

        return residual

    def logarithmic(self, x: Array) -> Array:
        """Residuals of the logarithms of sizes, of others over their size; wider valleys for a search."""
        found = self.scaled(x)
        if found is None:
            return np.full(self.count, NO_ANSWER)
        parts = []
        left = self.left(found)
        for own, rest, size, (name, value) in zip(
            found, left, self.sizes, self.measurement.columns, strict=True
        ):
            if name in ANGLES:
                parts.append(rest)
            elif name in SIZES:
                cut = _CUT * float(value.max()) or 1.0
                # Noise may put a small size below zero.
                parts.append(np.log((np.abs(own) + cut) / (np.maximum(value, 0.0) + cut)))
            else:
                parts.append(rest / size)
        return np.concatenate(parts)

    def plain(self) -> list[Array]:
        """Errors of one size for each quantity: its root of the mean square, 1 rad of angles."""
        return [
            np.full(value.shape, 1.0 if name in ANGLES else size)
            for size, (name, value) in zip(self.sizes, self.measurement.columns, strict=True)
        ]

    def jacobian(
        self, residual: Residual, x: Array, free: Flags | None = None, central: bool = False
    ) -> Array:
        """Derivatives of a residual by differences, by the unknowns that are free, shape (n columns, p)."""
        step = _PEAK_STEP if "peak" in self.names else _STEP
        moves = np.flatnonzero(np.ones(x.size) if free is None else free).tolist()
        ways = (step, -step) if central else (step,)
        self.ahead([x, *(x + way * np.eye(x.size)[k] for k in moves for way in ways)])
        middle, columns = residual(x), []
        for k in moves:
            ends = []
            for way in (step, -step):
                moved = x.copy()
                moved[k] += way
                # On the inner side of a value from which on the scene has no answer.
                if abs(moved[k]) <= LIMIT and self.answer(moved) is not None:
                    ends.append((way, residual(moved)))
                    if not central:
                        break
            if len(ends) == 2:
                columns.append((ends[0][1] - ends[1][1]) / (2.0 * step))
            else:
                columns.append((ends[0][1] - middle) / ends[0][0] if ends else np.zeros(middle.size))
        return np.stack(columns, axis=1)


def _factor(pairs: Sequence[tuple[Array, Array]]) -> float:
    """The factor that brings some arrays closest to others, taken together."""
    squares = sum(float(own @ own) for own, _ in pairs)
    return sum(float(own @ value) for own, value in pairs) / squares if squares > 0.0 else 1.0


def answer(scene: Scene, over: str, at: Array, names: Sequence[str]) -> list[Array]:
    """Quantities of a scene at measured speeds or times, or with liquid added."""
    if over == "speed":
        speed, where = np.unique(at, return_inverse=True)
        found = steady(scene, speed)
        return [np.asarray(_quantity(found, name))[where] for name in names]
    if over == "added":
        first = scene.liquids[0].volume
        filled = [scene.replace({"chambers.0.volume": first + volume}) for volume in at.tolist()]
        return [np.array([_of_fill(each, name) for each in filled]) for name in names]
    history = _history(scene)
    own = {name: history.coordinates[:, k] for k, name in enumerate(dry_rotor(scene).system().coordinates)}
    own["amplitude"] = history.amplitude
    for name in names:
        if name not in own:
            raise InputError(FIELD, name, "measured over speed or liquid added, or one of " + ", ".join(own))
    return [np.interp(at, history.time, own[name], right=np.nan) for name in names]


def _of_fill(scene: Scene, name: str) -> float:
    """A quantity of one fill: the steady amplitude at the last speed, the largest one of the run-up, m."""
    if name == "peak":
        return float(_history(scene).amplitude.max())
    if name == "amplitude":
        return float(steady(scene, np.array([scene.speeds.stop])).amplitude[0])
    raise InputError(FIELD, name, "amplitude or peak over liquid added")


def _history(scene: Scene) -> RunupHistory:
    """The scene's run-up or programme, without the second run that tells its error."""
    plan = planned(scene)
    drive, numerics = drive_of(plan, scene.rotor), numerics_of(plan, check=False)
    return chosen_run(scene, drive, across_gravity(scene), numerics).history


def steady(scene: Scene, speed: Array) -> Response:
    """Synchronous response of a supported machine at some speeds by the liquid model that it asks for."""
    if scene.model.liquid not in ("auto", "statics", "linear"):
        raise InputError("model.liquid", scene.model.liquid, "auto, statics or linear for a fit over speed")
    machine = replace(prepare(scene, free=True), speed=speed)
    (choice,) = choose_all([machine])
    return response(machine.rotor, scene.fills, speed, machine.axial_gravity, liquid_models(choice))


def planar_steady(scenes: Sequence[Scene], speed: Array) -> list[Response]:
    """`steady` of several planar machines at once."""
    machines = [replace(prepare(scene, free=True), speed=speed) for scene in scenes]
    names = np.concatenate([models for models, _ in models_at(machines)])
    owner = np.repeat(np.arange(len(scenes)), speed.size)
    pairs = [(machine.planar, machine.scene.fills) for machine in machines]
    gravity = np.array([machine.axial_gravity for machine in machines])
    rows = [np.flatnonzero(names == name) for name in np.unique(names)]
    parts = [
        machine_responses(
            pairs,
            owner[row],
            np.tile(speed, len(scenes))[row],
            gravity,
            synchronous_model(str(names[row[0]])),
        )
        for row in rows
    ]
    whole = joined(parts).at(np.argsort(np.concatenate(rows)))
    return [whole.at(np.flatnonzero(owner == k)) for k in range(len(scenes))]


def model_error(scene: Scene, speed: Array) -> Array:
    """Relative error of the steady answer as the package estimates it, nan where it has none, shape (n,)."""
    (choice,) = choose_all([replace(prepare(scene, free=True), speed=speed)])
    return np.asarray(choice.error)


def _quantity(found: Response, name: str) -> Array:
    """A measured quantity of a response."""
    if name == "phase":
        return np.angle(found.deflection)
    if name not in ("amplitude", "liquid_offset", "liquid_angle"):
        raise InputError(
            FIELD, name, "measured over time, or one of amplitude, phase, liquid_offset, liquid_angle"
        )
    return np.asarray(getattr(found, name))


def is_turn(name: str) -> bool:
    """Whether a quantity is an angle, rad."""
    return name in ANGLES or name in TURNS
