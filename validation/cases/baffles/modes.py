"""What radial baffles do to the slowest waves: a table over their number, depth and place.

`python -m validation.cases.baffles.modes` prints the tables of docs/howto/chamber.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from leblanc.studies.modes.study import Resolution, ring_sections
from meshes.baffles import Baffles
from solvers.sloshing.forced import forced_response, mode_damping
from solvers.sloshing.modes import sloshing_modes, spectrum
from solvers.sloshing.system import condense
from validation.page import Table
from validation.study import launch, shown

RADIUS, SURFACE, SPIN, HEIGHT, WATER = 0.15, 0.135, 40.0, 0.05, 1.004e-6
COUNTS, SHARES = (1, 2, 3, 4, 6, 8), (0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True)
class BaffleRow:
    """Slowest waves against and with the spin that push the drum, for one set of baffles."""

    count: int  #: baffles
    share: float  #: of the layer's depth that they take
    against: float  #: frequencies relative to the drum, rad/s; the same where the slowest stands
    along: float
    damping_against: float  #: decay rates in water, 1/s
    damping_along: float
    synchronous: float  #: force coefficient of a synchronous whirl
    error: float  #: largest relative error of the frequencies, estimated


def baffle_row(
    count: int, share: float, wall_gap: float = 0.0, fineness: Resolution | None = None
) -> BaffleRow:
    """Line of the table for a number of baffles, 0 for none.

    `share` of the layer's depth, from the wall or from a gap inwards; the gap is over the layer's depth.
    """
    depth = RADIUS - SURFACE
    tip = 0.0 if share + wall_gap >= 1.0 else RADIUS - (share + wall_gap) * depth
    baffles = Baffles(count, tip, wall_gap * depth) if count else None
    fine = fineness or Resolution(48, 4)
    coarse, system = (condense(section) for section in ring_sections(RADIUS, SURFACE, baffles, fine))
    known = spectrum(system)
    modes = sloshing_modes(system, SPIN, max(8, 2 * count + 2), known)
    # The slowest waves either way that move the centre of mass; between closed baffles all of them stand.
    push = np.linalg.norm(modes.amplitude @ system.moment.T, axis=1)
    felt = push > 0.1 * push.max()
    runs = modes.travelling > 0.5
    stands = not runs.any()
    against = int(np.flatnonzero(felt & (stands | (modes.frequency < 0.0)))[0])
    along = against if stands else int(np.flatnonzero(felt & runs & (modes.frequency > 0.0))[0])
    chosen = [against, along]
    damping = mode_damping(system, modes, WATER, HEIGHT).rate
    other = spectrum(coarse).frequency[chosen] * SPIN
    first, second = (float(modes.frequency[k]) for k in chosen)
    return BaffleRow(
        count=count,
        share=share,
        against=first,
        along=second,
        damping_against=float(damping[chosen[0]]),
        damping_along=float(damping[chosen[1]]),
        synchronous=float(forced_response(system, SPIN, SPIN, known).force_ratio.real),
        error=float(np.max(np.abs(other / np.abs([first, second]) - 1.0)) / (4.0**fine.order - 1.0)),
    )


def baffle_rows(counts: Sequence[int], shares: Sequence[float], wall_gap: float = 0.0) -> list[BaffleRow]:
    """All lines of a table: without baffles first."""
    rows = [baffle_row(0, 0.0)]
    return rows + [baffle_row(count, share, wall_gap) for count in counts for share in shares]


def table(rows: Sequence[BaffleRow]) -> Table:
    """Rows as a table; the first is that without baffles."""
    clear, lines = rows[0], []
    for row in rows:
        stands, size = row.against == row.along, abs(row.against)
        cells = [f"{row.count}", f"{100.0 * row.share:.0f} %"]
        cells += [f"{size:.3f} (stands)" if stands else f"{row.against:.3f}", _change(size, -clear.against)]
        cells += ["", ""] if stands else [f"{row.along:.3f}", _change(row.along, clear.along)]
        cells.append(f"{row.damping_against:.3f}" + ("" if stands else f", {row.damping_along:.3f}"))
        lines.append((*cells, f"{row.synchronous:.4f}"))
    head = ("against, rad/s", "change", "with, rad/s", "change", "decay, 1/s", "G(0)")
    worst = f"Errors of the frequencies below {max(row.error for row in rows):.1g}."
    return Table(("baffles", "of the depth", *head), tuple(lines), worst)


def _change(value: float, clear: float) -> str:
    return f"{100.0 * (value / clear - 1.0):+.2f} %"


if __name__ == "__main__":
    wall, gap = partial(baffle_rows, COUNTS, SHARES), partial(baffle_rows, COUNTS, SHARES[:3], 0.25)
    launch(shown(lambda: table(wall()), lambda: table(gap())))
