"""A layout of springs and dampers as text."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import LENGTH, MM, number, with_unit
from leblanc.results.machine.layout import LayoutResult, MountPlace, pair_names

Rows = list[tuple[str, ...]]

MOUNTS = "mount", "at x, y, z (mm)", "before", "direction", "before"
FREQUENCIES = "mode", "after (Hz)", "before (Hz)"
PAIR_HEAD = "coupling", "stiffness", "before", "damping", "before"
_SHOWN = 5e-4  # couplings below are printed as 0


def answer(result: LayoutResult) -> str:
    """What the layout gains, in one sentence."""
    was, now = (_measured(result, value) for value in (result.baseline, result.value))
    if result.measure == "couplings":
        text = f"The squared couplings of stiffness and damping add up to {now} in place of {was}"
    else:
        text = f"The natural frequencies keep {now} from the running speeds in place of {was}"
    held = "" if result.feasible else "; no layout within the bounds keeps the sag, this one exceeds it least"
    return f"{text}{held}."


def _measured(result: LayoutResult, value: float) -> str:
    if result.measure == "couplings":
        return f"{value:.3g}" if value >= _SHOWN**2 else "0"
    return f"{0.0 - 100.0 * value:.3g} %"


def facts(result: LayoutResult) -> list[tuple[str, str]]:
    """Main numbers: label and value."""
    limit = result.constraints["sag"]
    before, after = (
        ", ".join(number(float(rate) / (2.0 * math.pi)) for rate in row) for row in result.frequency
    )
    sags = f"{with_unit(limit.value, LENGTH)}, {with_unit(result.sag_before, LENGTH)} before"
    return [
        ("Scene", one_line(result.name)),
        ("Layout", answer(result)),
        ("Natural frequencies at rest", f"{after} Hz"),
        ("before", f"{before} Hz"),
        ("Sag under the weight", f"{sags}, at most {with_unit(limit.limit, LENGTH)}"),
        ("Couplings of the mass", _mass(result)),
        ("Layouts judged", str(result.evaluations)),
    ]


def _mass(result: LayoutResult) -> str:
    """What no mount changes."""
    found = [
        f"{pair} {value:.3g}"
        for pair, value in zip(pair_names(), result.mass_couplings.tolist(), strict=True)
        if abs(value) >= _SHOWN
    ]
    return ", ".join(found) + ", which no mount changes" if found else "none about the centre of mass"


def frequency_rows(result: LayoutResult) -> Rows:
    """Natural frequencies at rest by rising frequency, as `FREQUENCIES` heads them."""
    hertz = result.frequency / (2.0 * math.pi)
    return [
        (f"{k + 1}", number(float(after)), number(float(before)))
        for k, (before, after) in enumerate(hertz.T.tolist())
    ]


def remarks(result: LayoutResult) -> list[str]:
    """What the search assumes, a sentence or two each."""
    found = [
        "A layout is judged at rest and without liquid: frequencies are those without damping and spin, "
        "which couples alpha and gamma whatever the layout.",
        "A coupling is the term of the matrix about the common centre of mass of tub and drum over the root "
        "of the product of those on the diagonal: 0 where two motions are separate, 1 where they are one.",
        "Mounts at one place stay together, and springs and dampers keep their stiffness and damping.",
    ]
    if result.mirrored:
        found.append("Mounts are alike on both sides of x = 0, and stay so.")
    return found


def mount_rows(result: LayoutResult) -> Rows:
    """Places and directions, a row for each mount, as `MOUNTS` heads them."""
    return [_mount(mount) for mount in result.mounts]


def _mount(mount: MountPlace) -> tuple[str, ...]:
    places = (
        ", ".join(f"{length * MM:.1f}" for length in at) for at in (mount.position, mount.position_before)
    )
    ways = (
        "along x, y, z" if way is None else ", ".join(f"{part:.4f}" for part in way)
        for way in (mount.direction, mount.direction_before)
    )
    return (mount.name, *places, *ways)


def coupling_rows(result: LayoutResult) -> Rows:
    """Couplings that there are or were, as `PAIR_HEAD` heads them."""
    tables = result.couplings["stiffness"], result.couplings["damping"]
    rows = []
    for k, pair in enumerate(pair_names()):
        sizes = [float(table[layout, k]) for table in tables for layout in (1, 0)]
        if np.max(np.abs(sizes)) >= _SHOWN:
            rows.append((pair, *(f"{size:.3f}" if abs(size) >= _SHOWN else "0" for size in sizes)))
    return rows
