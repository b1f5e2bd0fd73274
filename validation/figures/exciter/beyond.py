"""What the exciter's balls do beyond the critical speed: `python -m validation.figures.exciter.beyond`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style
from meshes.arrays import Array
from solvers.rotor.exciter.machine import Dimensionless
from solvers.rotor.exciter.regimes import Kind
from solvers.rotor.exciter.spectrum import spectrum
from solvers.rotor.exciter.stability import capture_unbalance
from solvers.rotor.exciter.tangent import follow
from validation.cases.exciter.beyond import (
    CHAOTIC,
    CHAOTIC_SPEED,
    DATA,
    MAPS,
    THREE_SPEED,
    start_state,
    three_frequencies,
)

_APART = 0.65  # inches between two plots side by side
# Of a map: which runs are meant, the shift of the mark to the side, and its looks.
_MARKS: tuple[tuple[str, Callable[[dict[str, Any]], bool], float, dict[str, Any]], ...] = (
    (
        "balanced",
        lambda row: row["kind"] == Kind.BALANCED.value,
        -0.045,
        {"marker": "s", "s": 16, "color": "black", "linewidths": 0.0},
    ),
    (
        "third speed",
        lambda row: row["kind"] == Kind.THIRD.value,
        0.0,
        {"marker": "o", "s": 36, "facecolors": "none", "edgecolors": "C0", "linewidths": 1.2},
    ),
    (
        "chaotic for 5 decay times or longer",
        lambda row: row["chaos"] >= 5.0,
        0.045,
        {"marker": "x", "s": 28, "color": "C1", "linewidths": 1.2},
    ),
)


def beyond_figure(directory: Path) -> Path:
    """Spectra of three frequencies and of chaos, and two maps of what is reached over drag and unbalance."""
    rows: list[dict[str, Any]] = json.loads(DATA.read_text(encoding="utf-8"))["runs"]
    with style():
        figure = Figure()
        top = [figure.add_axes((0, 0, 1, 1), label=f"spectrum {k}") for k in range(2)]
        bottom = [figure.add_axes((0, 0, 1, 1), label=f"map {k}") for k in range(2)]
        _three(top[0])
        _chaos(top[1])
        for axes, (smallness, damping) in zip(bottom, MAPS, strict=True):
            chosen = [row for row in rows if row["smallness"] == smallness and row["damping"] == damping]
            _map(axes, chosen, smallness, damping)
        top[0].set_ylabel("Amplitude (\N{EN DASH})")
        bottom[0].set_ylabel("Drag b (\N{EN DASH})")
        text = (
            "Above: spectrum of the platform with one ball at the resonance and one at the third stuck "
            "speed (eps = 0.01, b = 0.4, delta = 0.05, h = 0.03, n = 8.15), and in chaos over two decay "
            "times (eps = 0.00695, b = 0.132, delta = 0.891, h = 0.0485, n = 34). Below: what four starts "
            "end in at 1.25 times the critical speed, marks of one machine side by side; line: the unbalance "
            "past which one ball of two can slip, the other at the resonance (theory: exciter, eq. 7)."
        )
        frame = Frame(left=0.6, top=0.25, between=0.75, below=0.45)
        lay_out(figure, [top, bottom], [1.7, 2.4], frame, text)
        for pair in (top, bottom):
            for axes in pair:
                box = axes.get_position()
                shift = 0.5 * _APART / 6.3 if axes is pair[1] else 0.0
                axes.set_position((box.x0 + shift, box.y0, box.width - 0.5 * _APART / 6.3, box.height))
    return save(figure, directory, "exciter_beyond", "Beyond the critical speed").png


def _three(axes: Any) -> None:
    """Lines of three frequencies, each with its name."""
    motion = three_frequencies().regime.motion
    frequency, amplitude = spectrum(motion.samples, motion.sample_time)
    axes.plot(frequency, amplitude, color="black", linewidth=0.8)
    third = float(three_frequencies().regime.ball_speed.max())
    names = (("resonance", 0.98, "left"), ("third", third, "right"), ("shaft", THREE_SPEED, "left"))
    for name, at, side in names:
        height = float(amplitude[np.abs(frequency - at) < 0.05].max())
        shift = -3 if side == "right" else 3
        axes.annotate(name, (at, height), (shift, 2), textcoords="offset points", ha=side, fontsize=7)
    axes.set_title("Three frequencies")
    _scales(axes, 10.0)


def _chaos(axes: Any) -> None:
    """Broad spectrum of a chaotic motion."""
    state = start_state(CHAOTIC, CHAOTIC_SPEED, "both third")
    time = 2.0 / (CHAOTIC.smallness * CHAOTIC.drag)
    found = follow(CHAOTIC, CHAOTIC_SPEED, state, time, samples=1 << 16, sampled=0.9)
    frequency, amplitude = spectrum(found.samples, found.sample_time)
    axes.plot(frequency, amplitude, color="C1", linewidth=0.5)
    axes.set_title(f"Chaos, growth {found.growth.mean():.2f}")
    _scales(axes, 60.0)


def _scales(axes: Any, end: float) -> None:
    axes.set_yscale("log")
    axes.set_ylim(1e-4, 30.0)
    axes.set_yticks([1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0])
    axes.yaxis.set_major_formatter(number)
    axes.yaxis.set_minor_formatter("")
    axes.set_xlim(0.0, end)
    axes.set_xlabel("Frequency (\N{EN DASH})")


def _map(axes: Any, rows: list[dict[str, Any]], smallness: float, damping: float) -> None:
    """Marks of what is reached from any of the starts, and the bounds of the third speed."""
    for name, chosen, shift, look in _MARKS:
        places = sorted({(row["unbalance"], row["drag"]) for row in rows if chosen(row)})
        if places:
            unbalance, drag = np.array(places).T
            axes.scatter(unbalance + shift, drag, label=name, zorder=3, **look)
    drags = sorted({row["drag"] for row in rows})
    bound = np.array([_bound(rows, drag, smallness, damping) for drag in drags])
    axes.plot(bound, drags, color="0.45", linewidth=1.0, label="bound of the third speed")
    axes.set_xlim(-0.1, 1.1)
    axes.set_xticks(sorted({row["unbalance"] for row in rows}))
    axes.xaxis.set_major_formatter(lambda value, _place: f"{value:.2g}")
    axes.set_ylim(0.05, 0.65)
    axes.set_xlabel("Unbalance \N{GREEK SMALL LETTER DELTA} (\N{EN DASH})")
    axes.set_title(f"\N{GREEK SMALL LETTER EPSILON} = {smallness:g}, h = {damping:g}")


def _bound(rows: list[dict[str, Any]], drag: float, smallness: float, damping: float) -> float:
    """Largest unbalance past which one of two balls can slip, at the runs' mean speed."""
    speeds: Array = np.array([row["speed"] for row in rows if row["drag"] == drag])
    return capture_unbalance(Dimensionless(smallness, drag, 0.0, damping), float(speeds.mean()), 0.5)


def main() -> None:
    """Draw it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    path = beyond_figure(parser.parse_args().out)
    path.with_suffix(".svg").unlink()
    print(path)


if __name__ == "__main__":
    main()
