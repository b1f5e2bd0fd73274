"""Whether the cells of a layer are enough for its baffles to stand each in its place."""

from __future__ import annotations

from collections.abc import Sequence

from fluid.fill import Fill

# Waves between two baffles need so many cells.
FEWEST_CELLS = 4


def is_smeared(fill: Fill, cells: int) -> bool:
    """Whether a layer has so many baffles that they act as a sink all over it."""
    plates = fill.chamber.baffles
    return plates is not None and cells < FEWEST_CELLS * plates.count


def fewest_cells(fills: Sequence[Fill]) -> int:
    """Fewest cells round each wall that every compartment needs; 8 without compartments."""
    return max([8, *(FEWEST_CELLS * fill.compartments for fill in fills)])
