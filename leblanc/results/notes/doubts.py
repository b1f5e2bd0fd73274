"""Notes on values of a scene that are allowed but hardly meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from leblanc.core.notes import Note, NoteCode

if TYPE_CHECKING:
    pass


class DoubtCode(NoteCode):
    """What a value of a scene is that is allowed but hardly meant."""

    SIZE = "doubtful_size"
    FILM = "doubtful_film"
    LIQUID = "doubtful_liquid"
    LIQUID_MASS = "doubtful_liquid_mass"
    DAMPING = "doubtful_damping"
    UNBALANCE = "doubtful_unbalance"
    PLACE = "doubtful_place"
    FREE = "free_direction"
    GRAVITY = "doubtful_gravity"
    SPEED = "doubtful_speed"


def doubt(code: DoubtCode, field: str, looks: str, likely: str) -> Note:
    """A value at a path of the scene that is hardly meant, why, and what may have been meant (or empty)."""
    meant = f"; did you mean {likely}?" if likely else ""
    return Note(
        code, {"field": field, "likely": likely}, f"Check {field}: {looks}{meant}{'' if meant else '.'}"
    )
