"""Unknown values of a scene from what was measured: least squares from several starts [theory: fit]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from leblanc.core import units
from leblanc.core.notes import Note
from leblanc.liquid.validity import require_supported
from leblanc.scene.scene import Scene, dry_rotor, require_no_balls
from leblanc.scene.schema.load import given_at
from leblanc.scene.schema.paths import rule_at
from leblanc.scene.schema.rules import Refused
from leblanc.studies.fit.answer import FitAnswer, FittedCurve, Measured, quantile
from leblanc.studies.fit.errors import Curvature, Profiles, averaged, curvature, profiles
from leblanc.studies.fit.measured import ANGLES, Measurement, read_measured
from leblanc.studies.fit.noise import (
    ESTIMATE,
    Judged,
    here,
    kinds_of,
    parse_noise,
    refine,
    relative_rms,
    unexplained,
)
from leblanc.studies.fit.notes import (
    LARGE,
    FitCode,
    fit_notes,
    flat_note,
    large_note,
    lopsided_note,
    plateau_note,
    repeated_note,
)
from leblanc.studies.fit.problem import (
    LIMIT,
    Problem,
    answer,
    first_guess,
    is_turn,
    require_scale,
    ties_of,
)
from leblanc.studies.fit.search import Searched, Valley, descend, floor, search
from meshes.arrays import Array, Flags
from meshes.errors import InputError

_ALIKE = 0.05  # two answers whose unknowns differ by less than this are one
_CANDIDATES = 3  # ends of searches that are compared by their likelihood
_ROUNDING = 1e-9  # of the size: less left is nothing but rounding
_ROUNDS = 4  # times that a profile may find better values
_JOINTLY = 0.99  # of noise: less far from the best values by all unknowns at once
_MOST_STARTS = 1000
_POINTS = 400  # of the fitted curve
_LOPSIDED = 4.0  # one arm of an interval over the other
_TOLD = 0.2  # share of an unknown in a direction that the data do not tell


def answer_fit(
    scene: Scene,
    measured: Path,
    unknown: Sequence[str],
    starts: int,
    seed: int,
    scale: str,
    noise: str,
    column: Mapping[str, str] | None,
) -> FitAnswer:
    """What `fit` answers of a table of measured values."""
    if not 1 <= starts <= _MOST_STARTS:
        raise InputError("starts", starts, f"from 1 to {_MOST_STARTS}")
    if seed < 0:
        raise InputError("seed", seed, "a whole number, 0 or above")
    free = require_scale(scale) != "given"
    table = read_measured(measured, dry_rotor(scene).system().coordinates, free, column or {})
    return fit_scene(scene, table, unknown, starts, seed, scale, noise)


def fit_scene(
    scene: Scene,
    measurement: Measurement,
    unknown: Sequence[str],
    starts: int = 2,
    seed: int = 0,
    scale: str = "given",
    noise: str = ESTIMATE,
) -> FitAnswer:
    """Values of a scene that bring its answer closest to what was measured [theory: fit, eq. 1-13].

    The scene's values are the first guess; "A=B" ties B to A. After at least `starts` searches more follow
    until the best values have been found twice and noise may explain what they leave. Scale "free" finds one
    factor for all measured lengths, "each" one for every quantity.
    """
    if measurement.over != "time":
        require_no_balls(scene, f"a fit over {measurement.over}; with balls it takes a run-up over time")
        require_supported(scene)
    stated = parse_noise(noise)
    groups = ties_of(scene, unknown)
    first = np.array([first_guess(scene, group[0]) for group in groups])
    problem = Problem(scene, groups, first, measurement, require_scale(scale))
    if problem.freedom < 1:
        allowed = f"fewer than the {problem.count} measured values"
        raise InputError("unknown", len(unknown), allowed)
    problem.answer(np.zeros(first.size))

    def explained(x: Array) -> bool:
        return any(
            unexplained(problem, here(problem, x, stated, k)) is None for k in kinds_of(problem, stated)
        )

    searched = search(problem, starts, seed, explained)
    best, other = _likeliest(problem, searched, stated)
    reason = unexplained(problem, best)
    bent, profile, best = _errors(problem, best, other, stated, reason is None)
    reason = unexplained(problem, best)
    return _answer(problem, searched, best, bent, profile, reason)


def _likeliest(
    problem: Problem, searched: Searched, stated: tuple[str, float]
) -> tuple[Judged, Judged | None]:
    """Best values by the likeliest kind of noise, of the ends of good searches; those by another kind."""
    best = searched.valleys[0]
    starts: list[Valley] = []
    for valley in searched.valleys:
        good = valley.cost <= 4.0 * best.cost + floor(problem)
        if good and all(np.abs(valley.x - other.x).max() > _ALIKE for other in starts):
            starts.append(valley)
    kinds = kinds_of(problem, stated)
    if best.cost <= problem.count * _ROUNDING**2:
        return here(problem, best.x, stated, kinds[0]), None
    found = [refine(problem, valley.x, stated, kind) for valley in starts[:_CANDIDATES] for kind in kinds]
    likeliest = min(found, key=lambda judged: judged.unlikely)
    others = [judged for judged in found if judged.noise.kind != likeliest.noise.kind]
    return likeliest, min(others, key=lambda judged: judged.unlikely, default=None)


def _errors(
    problem: Problem, best: Judged, other: Judged | None, stated: tuple[str, float], wanted: bool
) -> tuple[Curvature, Profiles, Judged]:
    """Curvature and profiles about the best values, which a profile may improve."""
    for _ in range(_ROUNDS):
        bent = _curvature(problem, best)
        if wanted and other is not None:
            bent = averaged(bent, best, _curvature(problem, other), other)
        none = Profiles((None,) * best.x.size, None)
        if not wanted:
            return bent, none, best
        wide = quantile(problem.freedom, best.noise.stated)
        profile = profiles(problem, best.x, best.sigma, bent, wide, _at_bound(best.x))
        if profile.better is None:
            return bent, profile, best
        best = refine(problem, profile.better, stated, best.noise.kind)
    return bent, none, best


def _curvature(problem: Problem, judged: Judged) -> Curvature:
    return curvature(problem.jacobian(problem.weighted(judged.sigma), judged.x, central=True))


def _at_bound(x: Array) -> Flags:
    return np.asarray(np.abs(np.abs(x) - LIMIT) < 1e-6)


def _others(problem: Problem, searched: Searched, best: Judged, told: Flags) -> list[Array]:
    """Ends of searches elsewhere, by unknowns that the data tell, that noise does not rule out.

    In one of a hundred cases the sum of the truth rises further for all unknowns [theory: fit, eq. 11].
    """
    from scipy.special import chdtri, fdtri

    residual = problem.weighted(best.sigma)
    least = float(np.sum(np.square(residual(best.x))))
    count = best.x.size
    estimated = count * float(fdtri(count, problem.freedom, _JOINTLY))
    rise = float(chdtri(count, 1.0 - _JOINTLY)) if best.noise.stated else estimated
    limit = least + rise + floor(problem)
    found: list[Array] = []
    tried = 0
    for valley in searched.valleys:
        if valley.cost > 4.0 * searched.valleys[0].cost + floor(problem) or tried == _CANDIDATES:
            break
        if _is_near(valley.x, (best.x, *found), told):
            continue
        tried += 1
        other = descend(problem, residual, valley.x)
        if other.cost <= limit and not _is_near(other.x, (best.x, *found), told):
            found.append(other.x)
    return found


def _is_near(x: Array, places: Sequence[Array], told: Flags) -> bool:
    return any(np.abs(x - place)[told].max(initial=0.0) <= _ALIKE for place in places)


def _answer(
    problem: Problem,
    searched: Searched,
    best: Judged,
    bent: Curvature,
    profile: Profiles,
    reason: Note | None,
) -> FitAnswer:
    """What was found, with its uncertainty and notes."""
    measurement, scene, paths = problem.measurement, problem.scene, [group[0] for group in problem.unknown]
    raw = problem.answer(best.x)
    found = raw if raw is not None else [np.full(measurement.at.shape, np.nan)] * len(problem.names)
    scales = problem.scales(found, best.sigma)
    left = problem.left([own * s for own, s in zip(found, scales, strict=True)])
    rms = relative_rms(problem, left)
    accepted = reason is None
    value = problem.values(best.x)
    slope = np.where(np.isnan(problem.spans), value, problem.spans)
    std, ends, notes = _intervals(problem, best, bent, profile, slope)
    edge = _at_bound(best.x)
    std[edge] = np.nan
    rounding = rms < _ROUNDING
    if not accepted or rounding:
        std[:] = np.nan
    lopsided = {note.data["path"] for note in notes if note.code in (FitCode.PLATEAU, FitCode.LOPSIDED)}
    told = np.isfinite(bent.std) & np.array([path not in lopsided for path in paths])
    if accepted:
        shown = [path in lopsided for path in paths]
        notes = notes + fit_notes(
            paths, value, bent.std * slope, bent.correlation, edge.tolist(), shown, problem.spans
        )
    others = _others(problem, searched, best, told) if accepted else []
    if others:
        notes.append(_other_note(problem, paths, others))
    notes = [*measurement.notes, *notes, *_scale_notes(problem, scales)]
    if searched.again < 2 and len(searched.valleys) > 1 and not rounding:
        notes.append(repeated_note(len(searched.valleys)))
    if reason is not None:
        notes.append(reason)
    elif rms > LARGE and not best.noise.stated:
        notes.append(large_note(rms))
    if rounding and accepted:
        text = "The scene meets the data to rounding: their noise is not known, nor are the errors."
        notes.append(Note(FitCode.NO_SPREAD, {}, text))
    parts = []
    for own, (name, measured), factor in zip(found, measurement.columns, scales, strict=True):
        unit = "rad" if is_turn(name) else "m"
        if problem.scale != "given" and name not in ANGLES:
            own, unit = factor * own, ""
        parts.append(Measured(name, unit, measured, own))
    return FitAnswer(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        unknown=tuple(paths),
        value=value,
        std=std,
        first=problem.first,
        correlation=bent.correlation,
        over=measurement.over,
        at=measurement.at,
        measured=tuple(parts),
        scale=next((s for s in scales if s != 1.0), 1.0),
        residual_rms=rms,
        converged=best.ended and raw is not None,
        evaluations=problem.evaluations,
        notes=tuple(notes),
        signed=tuple(path for path, span in zip(paths, problem.spans, strict=True) if not np.isnan(span)),
        freedom=problem.freedom,
        accepted=accepted,
        noise=best.noise,
        profile=ends if accepted else None,
        tied=tuple(group[1:] for group in problem.unknown),
        curve=_curve(problem, best.x, scales),
        units=_units(scene, paths),
    )


def _intervals(
    problem: Problem, best: Judged, bent: Curvature, profile: Profiles, slope: Array
) -> tuple[Array, Array, list[Note]]:
    """Standard errors, SI, ends of intervals by profiles, nan elsewhere, and notes of plateaus."""
    std = bent.std * slope
    ends = np.full((best.x.size, 2), np.nan)
    notes: list[Note] = []
    paths = [group[0] for group in problem.unknown]
    value = problem.values(best.x)
    for k, sides in enumerate(profile.sides):
        if sides is None:
            continue
        for j, side in enumerate(sides):
            moved = best.x.copy()
            moved[k] = side.end
            ends[k, j] = problem.values(moved)[k]
        below, above = sides
        arms = np.array([best.x[k] - below.end, above.end - best.x[k]])
        if below.open and above.open:
            std[k] = np.nan
        elif below.open or above.open:
            std[k] = np.nan
            notes.append(plateau_note(paths[k], value[k], float(ends[k, 0 if above.open else 1]), above.open))
        elif arms.max() > _LOPSIDED * max(arms.min(), 1e-12):
            std[k] = np.nan
            notes.append(lopsided_note(paths[k], *ends[k].tolist()))
        else:
            std[k] = arms.mean() / quantile(problem.freedom, best.noise.stated) * slope[k]
    for direction in bent.flat:
        share = np.abs(direction) > _TOLD
        std[share & ~(bent.std * 2.0 < 1.0)] = np.nan
        if np.count_nonzero(share) > 1:
            some = [path for path, own in zip(paths, share, strict=True) if own]
            notes.append(flat_note(some, direction[share].tolist()))
    return std, ends, notes


def _other_note(problem: Problem, paths: Sequence[str], others: Sequence[Array]) -> Note:
    """That the data allow other values as well, and which."""
    values = [problem.values(x).tolist() for x in others]
    told = "; ".join(
        ", ".join(f"{path} = {units.number(v)}" for path, v in zip(paths, row, strict=True))
        for row in values[:3]
    )
    text = f"Another answer fits within the noise: the data allow {told} (SI) as well."
    return Note(FitCode.OTHER_MINIMUM, {"starts": len(others), "values": values}, text)


def _scale_notes(problem: Problem, scales: Sequence[float]) -> list[Note]:
    """The factors that were found."""
    if problem.scale == "free":
        scale = next((s for s in scales if s != 1.0), 1.0)
        text = f"One factor for all lengths was found as well: {units.number(scale)} of the scene's."
        return [Note(FitCode.SCALE, {"scale": scale}, text)]
    pairs = {name: s for name, s in zip(problem.names, scales, strict=True) if name not in ANGLES}
    if problem.scale == "given" or not pairs:
        return []
    told = ", ".join(f"{name} {units.number(s)}" for name, s in pairs.items())
    text = f"A factor for each quantity was found as well, of the scene's: {told}."
    return [Note(FitCode.SCALE, {"scale": pairs}, text)]


def _curve(problem: Problem, x: Array, scales: Sequence[float]) -> FittedCurve | None:
    """The fitted answer between the measured points; none over liquid added, where each point is a run."""
    measurement = problem.measurement
    if measurement.over == "added" or problem.answer(x) is None:
        return None
    at = np.linspace(measurement.at[0], measurement.at[-1], _POINTS)
    at = np.union1d(at, measurement.at)
    try:
        found = answer(problem.with_values(x), measurement.over, at, problem.names)
    except (InputError, np.linalg.LinAlgError):
        return None
    return FittedCurve(at, tuple(own * s for own, s in zip(found, scales, strict=True)))


def _units(scene: Scene, paths: Sequence[str]) -> tuple[units.Unit, ...]:
    """Units in which the scene's file has its values, SI units without a file."""
    found = []
    for path in paths:
        try:
            dimension = getattr(rule_at(Scene, scene.table(), path), "dimension", units.NUMBER)
        except Refused:  # of a run-up or programme, which no sweep varies
            dimension = units.NUMBER
        stands, given, _ = given_at(scene.file, path) if scene.file else (False, None, None)
        found.append(units.unit_typed(given if stands else None, dimension))
    return tuple(found)
