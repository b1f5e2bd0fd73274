"""Figures and table of the page on the blood pump: `python -m validation.figures.rotors.blood_pump`."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style
from leblanc.scene.examples import example
from leblanc.wings.magnetic.figure import magnetic_figure
from leblanc.wings.magnetic.study import run_magnetic
from meshes.arrays import Array
from solvers.rotor.magnetic.control import Controller, Pid
from solvers.rotor.magnetic.linear import closed_loop, margins
from validation.cases.rotors.blood_pump import MACHINE, SPEED, control

HERTZ = 2.0 * math.pi
BANDWIDTHS = np.geomspace(300.0, 5e6, 43)  # of the coils, Hz
TOLD = (500.0, 1e3, 2e3, 5e3, 1e4, 1e5, 1e6)  # in the table, Hz
_LOOKS: dict[str, dict[str, Any]] = {
    "synergetic": {"color": "C0", "linestyle": "-", "label": "synergetic control"},
    "pid": {"color": "C1", "linestyle": "--", "label": "PID control"},
}


@dataclass(frozen=True)
class Coils:
    """A loop with coils that take time; n bandwidths."""

    bandwidth: Array  #: Hz, shape (n,)
    sensitivity: Array  #: largest, nan where the loop is not stable, shape (n,)
    damping: Array  #: least damping ratio of all poles, below 0 where the loop is not stable, shape (n,)
    delay: Array  #: delay margin, s, nan where the loop is not stable, shape (n,)


def controllers() -> tuple[Controller, ...]:
    """That of the source and the PID control of the example."""
    pid = Pid(MACHINE, proportional=150e3, integral=7.5e6, derivative=41.0, cutoff=5e4)
    return control(), pid


def slow_coils(controller: Controller, bandwidth: Array) -> Coils:
    """Pump at 9000 rpm with coils of some bandwidths, Hz, the controller unchanged."""
    found = []
    for hertz in bandwidth.tolist():
        machine = replace(MACHINE, magnets=replace(MACHINE.magnets, bandwidth=HERTZ * hertz))
        loop = closed_loop(machine, controller, SPEED)
        edge, poles = margins(loop), loop.poles
        found.append((edge.sensitivity, float((-poles.real / np.abs(poles)).min()), edge.delay))
    return Coils(bandwidth, *np.array(found).T)


def table() -> str:
    """Margins over the bandwidth of the coils, as a table in Markdown."""
    lines = [
        "| bandwidth | synergetic: sensitivity | least damping | PID: sensitivity | least damping |",
        "|---:|---:|---:|---:|---:|",
    ]
    synergetic, pid = (slow_coils(controller, np.array(TOLD)) for controller in controllers())
    for k, hertz in enumerate(TOLD):
        cells = [f"{hertz:g} Hz"]
        for coils in (synergetic, pid):
            lost = math.isnan(coils.sensitivity[k])
            cells.append("not stable" if lost else f"{coils.sensitivity[k]:.2f}")
            cells.append(f"{coils.damping[k]:.3f}")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def coils_figure(directory: Path) -> Path:
    """Sensitivity and damping over the bandwidth of the coils."""
    with style():
        figure = Figure()
        above: Any = figure.add_axes((0, 0, 1, 1), label="sensitivity")
        below: Any = figure.add_axes((0, 0, 1, 1), label="damping")
        for controller in controllers():
            coils = slow_coils(controller, BANDWIDTHS)
            above.plot(1e-3 * BANDWIDTHS, coils.sensitivity, **_LOOKS[controller.name])
            below.plot(1e-3 * BANDWIDTHS, coils.damping, **_LOOKS[controller.name])
        above.axhline(3.0, color="0.25", linewidth=0.8, linestyle=":", label="3, a new machine (ISO 14839-3)")
        below.axhline(0.0, color="0.45", linewidth=0.8)
        for axes in (above, below):
            axes.set_xscale("log")
            axes.set_xlim(1e-3 * float(BANDWIDTHS[0]), 1e-3 * float(BANDWIDTHS[-1]))
            axes.xaxis.set_major_formatter(number)
            axes.xaxis.set_minor_formatter("")
        above.set_yscale("log")
        above.set_ylim(0.9, 100.0)
        above.yaxis.set_major_formatter(number)
        above.yaxis.set_minor_formatter("")
        above.tick_params(labelbottom=False)
        above.set_ylabel("Largest sensitivity (\N{EN DASH})")
        below.set_ylabel("Least damping ratio (\N{EN DASH})")
        below.set_xlabel("Bandwidth of the coils (kHz)")
        text = (
            "Blood pump at 9000 rpm: largest sensitivity and least damping ratio over the bandwidth "
            "of coils and amplifiers, controllers unchanged. The source's controller is made for coils that "
            "follow at once. Magnets, bias current and PID control are assumed."
        )
        frame = Frame(left=0.72, top=0.12, between=0.12, below=0.42)
        lay_out(figure, [[above], [below]], [1.7, 1.4], frame, text)
    return save(figure, directory, "blood_pump_coils", "Coils that take time").png


def trial_figure(directory: Path) -> Path:
    """Trial of the scene in time and its unbalance response."""
    result = run_magnetic(example("blood_pump"))
    return save(magnetic_figure(result), directory, "blood_pump", "Blood pump in magnetic bearings").png


def main() -> None:
    """Draw all figures and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    options = parser.parse_args()
    for path in (trial_figure(options.out), coils_figure(options.out)):
        path.with_suffix(".svg").unlink()
        print(path)
    print(table())


if __name__ == "__main__":
    main()
