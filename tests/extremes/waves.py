"""The wave models at the ends of what may be asked: an answer, or a plain no.

`python -m tests.extremes.waves` prints the table of docs/accuracy.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from leblanc.core.notes import texts
from leblanc.studies.layer.study import answer_layer, wave_notes
from meshes.chamber import Chamber
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.models import LongWave, OneFamily
from solvers.pypde.settle import simulate

_RADIUS, _HEIGHT = 0.15, 0.01


@dataclass(frozen=True)
class Extreme:
    """One layer under one whirl."""

    name: str  #: what is extreme in it
    model: str  #: `long_wave` or `kdv`
    depth: float = 0.1  #: h0/R
    spin: float = 40.0  #: Omega, rad/s
    viscosity: float = 1e-6  #: m^2/s; with it the laminar wall layer's friction
    amplitude: float = 0.05  #: w0/h0
    ratio: float = 0.7643970164  #: whirl speed over spin speed
    points: int = 128  #: cells, or points of the profile
    dispersion: bool = False  #: the exact one for `kdv`, the added one for `long_wave`
    periods: int = 3  #: whirl periods of the long waves, from rest, with a ramp of 20/Omega


@dataclass(frozen=True)
class Outcome:
    """What came of it."""

    converged: bool  #: an answer was reached
    in_range: bool  #: the model says it holds there
    finite: bool  #: every number of the answer is one
    mass_error: float  #: relative change of the liquid's volume
    least_depth: float  #: over h0
    force: float  #: modulus of the last force ratio; nan without an answer
    says: str  #: what the answer says of itself


def extremes(model: str) -> Iterator[Extreme]:
    """The layers of the table for one model, one value at its end at a time, then several at once."""
    base = Extreme("ordinary", model)
    yield base
    for depth in (1e-4, 1e-2, 0.3, 0.6, 0.9):
        yield replace(base, name=f"h0/R = {depth:g}", depth=depth)
    yield replace(base, name="h0/R = 0.9, w0/h0 = 0.005", depth=0.9, amplitude=0.005)
    for spin in (0.1, 1e3, 1e5):
        yield replace(base, name=f"Omega = {spin:g} rad/s", spin=spin)
    for viscosity in (0.0, 1e-4, 1e-1):
        yield replace(base, name=f"nu = {viscosity:g} m2/s", viscosity=viscosity)
    for amplitude in (0.0, 1e-6, 1.0, 10.0):
        yield replace(base, name=f"w0/h0 = {amplitude:g}", amplitude=amplitude)
    for ratio in (-0.5, 0.5, 0.75, 0.78, 1.0, 1.4, 1.4466248623, 1.5, 3.0):
        yield replace(base, name=f"whirl ratio {ratio:.4g}", ratio=ratio)
    for points in (16, 1024):
        yield replace(base, name=f"{points} points", points=points)
    # A fast whirl, whose periods are short.
    yield replace(base, name="8192 points, whirl ratio 3", points=8192, ratio=3.0, periods=1)
    yield replace(base, name="with dispersion", dispersion=True)
    yield replace(base, name="dispersion, w0/h0 = 1", dispersion=True, amplitude=1.0)
    yield replace(base, name="thin, violent, 16 points", depth=1e-4, amplitude=10.0, points=16)
    yield replace(base, name="thick, violent, no friction", depth=0.9, amplitude=1.0, viscosity=0.0)
    yield replace(base, name="syrup in a film", depth=1e-3, viscosity=1e-1, amplitude=1.0)


def outcome(case: Extreme) -> Outcome:
    """Answer of the model."""
    surface = _RADIUS * (1.0 - case.depth)
    volume = math.pi * (_RADIUS - surface) * (_RADIUS + surface) * _HEIGHT
    fill = Fill(Chamber(_RADIUS, _HEIGHT), Liquid("test", 1000.0, case.viscosity), volume)
    amplitude, speed = case.amplitude * case.depth * _RADIUS, case.ratio * case.spin
    friction = Friction(FrictionLaw.STOKES if case.viscosity else FrictionLaw.NONE)
    if case.model == "kdv":
        family = OneFamily(friction, case.points, case.dispersion)
        answer = answer_layer(fill, case.spin, speed, amplitude, family)
        return Outcome(
            converged=answer.converged,
            in_range=answer.in_range,
            finite=bool(
                np.isfinite([answer.force_ratio, answer.offset]).all() and np.isfinite(answer.depth).all()
            ),
            mass_error=answer.mass_error,
            least_depth=float(answer.depth.min()) / fill.depth,
            force=abs(answer.force_ratio),
            says="; ".join(texts(answer.notes)),
        )
    whirl = Whirl(case.spin, speed, amplitude, ramp=20.0 / case.spin)
    numerics = Numerics(case.points, case.dispersion)
    history = simulate(fill, whirl, case.periods * whirl.period, friction, numerics)
    numbers = (history.force_ratio, history.offset, history.mean_rotation, history.depth)
    notes = wave_notes(LongWave(friction, numerics).wave_at_end(fill, whirl, history))
    return Outcome(
        converged=history.converged,
        in_range=not notes,
        finite=all(bool(np.isfinite(values).all()) for values in numbers),
        mass_error=history.mass_error,
        least_depth=float(history.depth.min()) / fill.depth,
        force=float(abs(history.force_ratio[-1])) if history.force_ratio.size else math.nan,
        says="; ".join(texts(notes)),
    )


def table(model: str) -> str:
    """The outcomes of one model, as a table in Markdown."""
    lines = [
        "| case | answer | force ratio | least depth / h0 | mass error | says |",
        "|---|---|---|---|---|---|",
    ]
    for case in extremes(model):
        found = outcome(case)
        force = "" if math.isnan(found.force) else f"{found.force:.4g}"
        lines.append(
            f"| {case.name} | {'yes' if found.converged else 'no'} | {force} | {found.least_depth:.2g} "
            f"| {found.mass_error:.0e} | {found.says} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    for name in ("long_wave", "kdv"):
        print(f"\n### {name}\n\n{table(name)}")
