"""Whether the cells of a layer are enough for its baffles to stand each in its place."""

from __future__ import annotations

from collections.abc import Sequence

from fluid.fill import Fill

# Waves between two baffles need so many cells.
FEWEST_CELLS = 4


def is_smeared(fill: Fill, cells: int) -> bool:
    """Whether a layer has so many baffles that they act as a sink all over it.

    Parameters
    ----------
    fill : chamber and liquid
    cells : round the wall
    """
    plates = fill.chamber.baffles
    return plates is not None and cells < FEWEST_CELLS * plates.count


def fewest_cells(fills: Sequence[Fill]) -> int:
    """Round each wall, so that every compartment has enough of them; 8 without compartments.

    Parameters
    ----------
    fills : chambers and their liquid
    """
    return max([8, *(FEWEST_CELLS * fill.compartments for fill in fills)])
