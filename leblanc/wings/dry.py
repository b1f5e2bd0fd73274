"""What every answer over speed says of the liquid, of a machine that carries none."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from leblanc.core.answer import Answer
from meshes.arrays import Array, Flags
from meshes.quantity import Q

_OVER = ("speed",)


class DryAnswer(Answer):
    """Base of an answer over speed without liquid."""

    speed: Array

    @property
    def liquid_offset(self) -> Annotated[Array, Q("m", "none: no liquid", over=_OVER, data=False)]:
        """Nan, shape (n,)."""
        return np.full(self.speed.shape, np.nan)

    @property
    def liquid_angle(self) -> Annotated[Array, Q("rad", "none: no liquid", over=_OVER, data=False)]:
        """Nan, shape (n,)."""
        return self.liquid_offset

    @property
    def dry_patch(self) -> Annotated[Flags, Q(name="no wall can run dry", over=_OVER, data=False)]:
        """False, shape (n,)."""
        return np.zeros(self.speed.shape, dtype=np.bool_)
