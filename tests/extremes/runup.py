"""Run-ups at the ends of what may be asked: an answer with its error, or a plain no.

`python -m tests.extremes.runup` prints the table of docs/accuracy.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up

_MASS, _NATURAL, _CHAMBER = 30.0, 25.0, Chamber(0.25, 0.04)
_RAMP = Ramp(15.0, 60.0, 15.0, 4.0)

_FRICTION = Friction(FrictionLaw.LINEAR, 3.0)


@dataclass(frozen=True)
class RunupExtreme:
    """One machine on one ramp."""

    name: str  #: what is extreme in it
    stiffness: float = 1.0  #: over those of the ordinary machine
    damping: float = 1.0
    unbalance: float = 0.1  #: kg m
    share: float = 5e-4 / _CHAMBER.capacity  #: of each chamber that is filled
    chambers: int = 1  #: how many, of 40 mm height together
    friction: Friction = _FRICTION  #: on the walls
    gravity: float = 0.0  #: across the axis, m/s^2
    ramp: Ramp = _RAMP  #: of the spin
    cells: int = 64  #: of each layer


def runup_extremes() -> Iterator[RunupExtreme]:
    """The run-ups of the table."""
    base = RunupExtreme("ordinary")
    yield base
    for stiffness in (1e-3, 1e4, 1e12):
        yield replace(base, name=f"stiffness times {stiffness:g}", stiffness=stiffness)
    yield replace(base, name="no damping of the supports", damping=0.0)
    yield replace(base, name="no damping, no friction", damping=0.0, friction=Friction())
    yield replace(base, name="damping times 100", damping=100.0)
    yield replace(base, name="friction of 1e4 1/s", friction=Friction(FrictionLaw.LINEAR, 1e4))
    yield replace(base, name="quadratic friction, c_f = 1", friction=Friction(FrictionLaw.QUADRATIC, 1.0))
    for share in (0.0, 1e-9, 1e-4, 0.5, 0.99, 1.0):
        yield replace(base, name=f"filled to {share:g}", share=share)
    yield replace(base, name="no unbalance", unbalance=0.0)
    yield replace(base, name="unbalance times 10", unbalance=1.0)
    for rate in (1.0, 1e2, 1e4):
        ramp = Ramp(15.0, 60.0, rate, max(1.2 * 45.0 / rate, 0.5))
        yield replace(base, name=f"{rate:g} rad/s2", ramp=ramp)
    yield replace(base, name="up and down", ramp=replace(base.ramp, back=True))
    yield replace(base, name="16 chambers", chambers=16)
    for gravity in (9.81, 50.0):
        yield replace(base, name=f"horizontal, {gravity:g} m/s2", gravity=gravity)
    for cells in (8, 1024):
        yield replace(base, name=f"{cells} cells", cells=cells)


def answer(case: RunupExtreme) -> RunupHistory:
    """Run it, with the companion that estimates the error."""
    stiffness = case.stiffness * _MASS * _NATURAL**2
    rotor = Jeffcott(_MASS, stiffness, case.damping * 2.0 * 0.06 * _MASS * _NATURAL, case.unbalance)
    chamber = replace(_CHAMBER, height=_CHAMBER.height / case.chambers)
    fill = Fill(chamber, Liquid("water", 1000.0, 1e-6), case.share * chamber.capacity)
    numerics = RunupNumerics(cells=case.cells, samples=400)
    fills = [fill] * case.chambers
    return run_up(rotor.system(), fills, case.ramp, case.friction, case.gravity, numerics)


def table() -> str:
    """The outcomes, as a table in Markdown."""
    lines = [
        "| case | answer | peak, mm | at, rad/s | error estimate | energy left | mass error | says |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for case in runup_extremes():
        found = answer(case)
        top = int(np.argmax(found.amplitude))
        error = "" if math.isnan(found.error_estimate) else f"{found.error_estimate:.0e}"
        lines.append(
            f"| {case.name} | {'yes' if found.converged else 'no'} | {1e3 * found.amplitude[top]:.4g} "
            f"| {found.speed[top]:.1f} | {error} | {found.audit.closure:.0e} | {found.mass_error:.0e} "
            f"| {found.reason} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
