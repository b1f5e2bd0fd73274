"""Which wing answers a question about a kind of machine: the one place that names wings."""

from __future__ import annotations

# "module:function" of a scene, by kind of machine and by question.
WINGS: dict[str, dict[str, str]] = {
    "balls": {"run": "leblanc.studies.balls.study:run_balls"},
    "exciter": {
        "run": "leblanc.wings.exciter.study:run_exciter",
        "explain": "leblanc.wings.exciter.study:explain_exciter",
    },
    "magnetic": {
        "run": "leblanc.wings.magnetic.study:run_magnetic",
        "explain": "leblanc.wings.magnetic.study:explain_magnetic",
        "view": "leblanc.wings.magnetic.geometry:magnetic_view",
    },
    "spindle": {
        "run": "leblanc.wings.spindle.study:run_spindle",
        "view": "leblanc.wings.spindle.geometry:spindle_view",
    },
}


def answerer(question: str, kind: str) -> str | None:
    """What answers a question about a kind of machine; None where the core does."""
    return WINGS.get(kind, {}).get(question)
