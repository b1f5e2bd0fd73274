"""Words below the figures of a response."""

from __future__ import annotations

from leblanc.figures.page import Caption
from leblanc.results.base import one_line
from leblanc.results.response import RunResult


def caption(result: RunResult, text: str) -> Caption:
    """What the figure shows, the scene, the model and the values it assumes."""
    assumed = ", ".join(map(one_line, result.assumed)) or "nothing"
    model = ", ".join(result.models_used)
    return Caption(text, f"Scene: {one_line(result.name)}. Liquid model: {model}. Assumed: {assumed}.")


def zero_of(result: RunResult) -> str:
    """What angles count from."""
    motion = result.motion
    return "the unbalance" if motion is None or motion.zero == "unbalance" else motion.zero
