"""Words below the figures of a study."""

from __future__ import annotations

from leblanc.results.provenance import one_line
from leblanc.results.record import StudyRecord, models_used


def caption(record: StudyRecord, text: str) -> str:
    """What the figure shows, the scene, the model and the values it assumes."""
    assumed = ", ".join(map(one_line, record.assumed)) or "nothing"
    model = ", ".join(models_used(record.response))
    return f"{text} Scene: {one_line(record.name)}. Liquid model: {model}. Assumed: {assumed}."


def zero_of(record: StudyRecord) -> str:
    """What angles count from."""
    motion = record.motion
    return "the unbalance" if motion is None or motion.zero == "unbalance" else motion.zero
