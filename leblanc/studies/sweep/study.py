"""A sweep from start to end: what is missing in the store is answered and written, then summarised."""

from __future__ import annotations

import functools
import re
import signal
import sys
import threading
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields, replace
from os import PathLike
from pathlib import Path
from types import FrameType

import numpy as np

from leblanc.core.files import out_dir
from leblanc.core.progress import update
from leblanc.core.units import NUMBER, Unit, unit_for
from leblanc.liquid.notes import slowed_by
from leblanc.scene.scene import Scene
from leblanc.scene.schema.load import SceneError, SceneFault, shown
from leblanc.scene.schema.paths import path_words, rule_at
from leblanc.studies.held.holding import cores
from leblanc.studies.run.notes import plane_words
from leblanc.studies.sweep.answer import QUANTILES, OverValue, Reason, Statistics, SweepAnswer
from leblanc.studies.sweep.block import DONE, FAILED, NOT_CONVERGED, Block, BlockAnswer, answered
from leblanc.studies.sweep.cluster import answer_blocks, require_scheduler
from leblanc.studies.sweep.plan import Sweep, Vary, varied
from leblanc.studies.sweep.sampling import Rows, sample_rows
from leblanc.studies.sweep.sensitivity import sensitivity
from leblanc.studies.sweep.store import Store, field_values, locked, open_store, read_store, write_block
from meshes.arrays import Array
from meshes.errors import InputError

OVER_VALUE = ("last_amplitude", "last_amplitude_dry", "peak_amplitude", "peak_amplitude_dry", "peak_growth")
OVER_SPEED = ("amplitude", "amplitude_dry", "amplitude_without")
_VALUES = 4_000_000  # read at once
_ROUNDING = 1e-12  # of the largest: numbers as near as this are equal
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\w.+-]*")


def answer_sweep(
    study: Sweep,
    out: str | PathLike[str] | None = None,
    vary: Vary | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    fresh: bool = False,
) -> SweepAnswer:
    """Answer what the store does not hold yet, and say what all samples have in common."""
    if workers is not None and workers < 0:
        raise InputError("workers", workers, "0 or more")
    study = varied(study, vary or {})
    folder = out_dir(study.name, None if out is None else Path(out))
    return summarise(run_sweep(study, folder, workers, scheduler, fresh), study)


def present(
    answer: SweepAnswer, netcdf: bool, emulate: bool, to: str | None = None, decimal: str = "point"
) -> SweepAnswer:
    """The answer with a copy of its store, with emulators of its outputs, and tables beside the store."""
    if to is not None:
        from leblanc.studies.export.tables import write_samples

        write_samples(answer.named_arrays(), answer.store.parent, to, decimal)
    if not emulate:
        return replace(answer, netcdf=netcdf)
    from leblanc.studies.sweep.emulator import emulated_outputs

    emulators = emulated_outputs(read_store(answer.store), answer.seed)
    return replace(answer, netcdf=netcdf, emulators=emulators)


def run_sweep(
    sweep: Sweep,
    folder: Path,
    workers: int | None = None,
    scheduler: str | None = None,
    fresh: bool = False,
) -> Store:
    """Answer every sample that the store does not hold yet.

    It may be ended at any moment, in any way; the same call continues from the finished blocks, and the store
    comes out the same, byte for byte, whatever the workers.
    """
    if fresh and scheduler is not None:
        require_scheduler(scheduler)  # before the old store is gone
    with locked(folder):
        store = open_store(folder, sweep, fresh)
        missing = store.pending
        finished = sweep.samples - sum(stop - start for start, stop in map(store.bounds, missing))
        slow = slowed_by(sweep.scene.fills) if sweep.command == "run" else ""
        update(finished, sweep.samples, f"samples{slow}")
        if not missing:
            return store
        _probe(sweep)
        rows = sample_rows(sweep)
        blocks = (block_of(sweep, store, rows, number) for number in missing)
        if workers is None:  # a single block needs no process of its own
            workers = 0 if len(missing) == 1 else min(cores(), len(missing))
        with _interrupts() as interrupted:
            for answer in answer_blocks(blocks, workers, scheduler):
                write_answer(sweep, store, rows, answer)
                start, stop = store.bounds(answer.number)
                finished += stop - start
                update(finished, sweep.samples)
                if interrupted.is_set():
                    raise KeyboardInterrupt
    return replace(store, pending=())


@contextmanager
def _interrupts() -> Iterator[threading.Event]:
    """Notices a Ctrl-C that was lost: Python drops one that comes while it destroys an object."""
    seen = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield seen  # only the main thread may set handlers
        return
    before, complain = signal.getsignal(signal.SIGINT), sys.unraisablehook

    def note(number: int, frame: FrameType | None) -> None:
        seen.set()
        if callable(before):
            before(number, frame)

    if callable(before):
        note = functools.wraps(before)(
            note
        )  # tells `leblanc.core.interrupts` that it passes on what it hears

    def drop(what: sys.UnraisableHookArgs) -> None:
        if what.exc_type is not KeyboardInterrupt:
            complain(what)

    if before is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, note)
    sys.unraisablehook = drop
    try:
        yield seen
    finally:
        signal.signal(signal.SIGINT, before)
        sys.unraisablehook = complain


def _probe(sweep: Sweep) -> None:
    """Answer the scene itself: what no sample can answer is one fault then, not as many as samples."""
    if any(field.path == "model.liquid" for field in sweep.fields):
        return
    try:
        answered([sweep.scene], sweep.kept)
    except InputError as error:
        raise SceneError(
            [SceneFault(sweep.scene_path, error.field, shown(error.value), error.allowed)]
        ) from error


def block_of(sweep: Sweep, store: Store, rows: Rows, number: int) -> Block:
    """The samples of a block, as a worker takes them."""
    drawn = rows(*store.bounds(number))
    values = tuple(
        tuple(field.value(value) for field, value in zip(sweep.fields, row, strict=True)) for row in drawn
    )
    return Block(number, sweep.table, tuple(field.keys for field in sweep.fields), values, sweep.kept)


def write_answer(sweep: Sweep, store: Store, rows: Rows, answer: BlockAnswer) -> None:
    """Write what a worker found of a block."""
    drawn = rows(*store.bounds(answer.number))
    variables = {field.path: field_values(field, drawn[:, j]) for j, field in enumerate(sweep.fields)}
    variables |= answer.values
    variables["reason"] = np.array(answer.reason, dtype=object)
    write_block(store, answer.number, variables, answer.status)


def summarise(store: Store, sweep: Sweep) -> SweepAnswer:
    """Statistics over all samples; reads a few of the store's columns at a time."""
    counts = np.bincount(store.read("status"), minlength=4)
    drawn = sample_rows(sweep)(0, store.samples)
    categorical = [field.categorical for field in sweep.fields]
    single, shares = {}, {}
    kept = sweep.kept
    for name in kept.single:
        values = store.read(name)
        single[name] = statistics(values)
        shares[name] = sensitivity(sweep.method, drawn, categorical, values, sweep.seed)
    return SweepAnswer(
        name=sweep.name,
        scene=sweep.scene.name,
        store=store.path,
        method=sweep.method,
        seed=sweep.seed,
        fields=tuple(field.path for field in sweep.fields),
        speeds=kept.speeds,
        command_of=sweep.command,
        varied=tuple((field.path, field.words()) for field in sweep.fields),
        samples=store.samples,
        done=int(counts[DONE]),
        failed=int(counts[FAILED]),
        not_converged=int(counts[NOT_CONVERGED]),
        reasons=_grouped(store),
        speed=_speed(store, sweep),
        outputs=single,
        over_speed={
            name: _over_speed(store, name, kept.speeds) for name in OVER_SPEED if name in kept.outputs
        },
        sensitivity=shares,
        over_value=_over_value(store, sweep, drawn),
        digest=sweep.digest,
        plane="" if sweep.scene.rotor.kind == "jeffcott" else _plane(sweep),
    )


def _over_value(store: Store, sweep: Sweep, drawn: Array) -> OverValue | None:
    """Outputs over the one field that varies on a grid; None where more vary, or at random."""
    if sweep.method != "grid" or len(sweep.fields) != 1:
        return None
    (field,) = sweep.fields
    value = drawn[:, 0]
    options: tuple[str, ...] = ()
    unit = Unit("", 1.0)
    if field.categorical:
        options = tuple(str(text) for text in field_values(field, value))
    else:
        value = np.array([field.value(one) for one in value], dtype=np.float64)
        rule = rule_at(Scene, sweep.table, field.path, sweep.command)
        unit = unit_for(getattr(rule, "dimension", NUMBER), *value.tolist())
    order = np.argsort(value, kind="stable")
    names = [name for name in OVER_VALUE if name in sweep.kept.outputs]
    stable = store.read("stable")[order] == 1 if "stable" in sweep.kept.outputs else None
    return OverValue(
        name=path_words(field.path, chambers=len(sweep.scene.chambers)),
        value=value[order],
        options=options,
        unit=unit,
        outputs={name: store.read(name)[order] for name in names},
        stable=None if stable is None else stable[:, -1],
        stable_speeds=None if stable is None else np.count_nonzero(stable, axis=1),
    )


def _speed(store: Store, sweep: Sweep) -> Array | None:
    """Speeds of all samples, rad/s; None where they differ."""
    if sweep.command == "run":
        own = any(field.path.startswith("speeds.") for field in sweep.fields)
        return None if own else sweep.scene.speed_array()
    found = store.read("speed")
    known = found[np.isfinite(found).all(axis=1)]
    return known[0] if known.size and np.all(known == known[0]) else None


def _plane(sweep: Sweep) -> str:
    """Plane of the amplitudes, with its place unless that varies."""
    if not sweep.scene.chambers:
        return plane_words(0.0, chambers=False)
    varied = any(field.path.startswith("chambers.0.plane") for field in sweep.fields)
    words = plane_words(sweep.scene.chambers[0].plane, chambers=True)
    return words.partition(" at ")[0] if varied else words


def statistics(values: Array) -> Statistics:
    """Statistics of the numbers that are finite."""
    known = np.sort(values[np.isfinite(values)])
    if known.size == 0:
        return Statistics(0, np.nan, np.nan, np.full(len(QUANTILES), np.nan))
    apart = known[-1] - known[0] > _ROUNDING * np.abs(known).max()
    spread = known.std(ddof=1) if apart else 0.0
    return Statistics(known.size, float(known.mean()), float(spread), np.quantile(known, QUANTILES))


def _over_speed(store: Store, name: str, speeds: int) -> Statistics:
    """Statistics at each speed, as many speeds read at once as a bounded memory takes."""
    width = max(1, _VALUES // store.samples)
    each = [
        statistics(column)
        for start in range(0, speeds, width)
        for column in store.read(name, columns=slice(start, start + width)).T
    ]
    return Statistics(*(np.array([getattr(one, part.name) for one in each]) for part in fields(Statistics)))


def _grouped(store: Store) -> tuple[Reason, ...]:
    """Reasons that differ in numbers only count as one."""
    counts: Counter[str] = Counter()
    examples: dict[str, str] = {}
    for start in range(0, store.samples, store.block):
        for reason in filter(None, store.read("reason", slice(start, start + store.block))):
            kind = _NUMBER.sub("#", reason)
            counts[kind] += 1
            examples.setdefault(kind, reason)
    return tuple(Reason(examples[kind], count) for kind, count in counts.most_common())
