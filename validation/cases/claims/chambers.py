"""Equal liquid in one to four rings: are several chambers the most effective [DR18, below eq. 20]?

The machine is the vertical rig of the examples, 30 kg on soft brackets, with one litre of water in all and
the outer envelope of its balancer, 400 mm by 40 mm. The source's rings are concentric; it does not say what
they are compared with, so rings stacked along the axis within the same envelope are asked as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np

from leblanc.scene.chambers import Chamber
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.studies.run.study import run_scene
from leblanc.studies.runup.study import runup_scene
from validation.case import Case, Claims, shape_verdict
from validation.page import Figure, page
from validation.study import launch, shown

CLAIMS = Claims("claims")

Kind = Literal["concentric", "stacked"]

COUNTS = (1, 2, 3, 4)
KINDS: tuple[Kind, ...] = ("concentric", "stacked")
_RADII = (0.2, 0.15, 0.1, 0.05)  # m, the outer walls of the rig and one ring more inside
_HEIGHT, _LIQUID = 0.04, 1e-3  # m, assumed; m^3, the sum of the source's three chambers
_SAMPLES = 200
_CELLS = 32  # round each wall in time; 128 change the largest deflection by 1.7 % at most


@dataclass(frozen=True)
class Gain:
    """Deflections with liquid over those without."""

    at_speed: float  #: at the nominal speed, 90 rad/s
    peak: float  #: the largest at any constant speed, stable or not
    run_up: float  #: the largest of a run-up at 4 rad/s^2
    added: float  #: full mass of all rings over that of the rotor
    #: largest unbalance that the liquid can have about the geometric axis, kg m: all of it at the walls
    most: float


def rings(count: int, kind: Kind) -> tuple[Chamber, ...]:
    """Chambers that share a litre of water within one envelope.

    Concentric: 50 mm wide, from the outside in, all layers equally deep; else of equal height, stacked.
    """
    if kind == "stacked":
        one = Chamber(radius=_RADII[0], height=_HEIGHT / count, volume=_LIQUID / count, liquid="water")
        return (one,) * count
    outer = _RADII[:count]
    inner = (*outer[1:], 0.0)
    return tuple(
        Chamber(
            radius=radius,
            inner_radius=wall,
            height=_HEIGHT,
            volume=_LIQUID * radius / sum(outer),
            liquid="water",
        )
        for radius, wall in zip(outer, inner, strict=True)
    )


def machine(count: int, kind: Kind) -> Scene:
    """Vertical rig with these `rings`."""
    rig = example("vertical_rig").altered(chambers=rings(count, kind), assumed=())
    # The swing of the passage is over long before the nominal speed.
    return rig.replace({"runup.stop": 50.0, "runup.duration": 12.0})


def steady_gain(count: int, kind: Kind) -> tuple[float, float]:
    """Deflection at the nominal speed and largest at any, over those without liquid."""
    found = run_scene(machine(count, kind))
    return (
        float(found.amplitude[-1] / found.amplitude_dry[-1]),
        found.peak["amplitude"] / found.peak_dry["amplitude"],
    )


@cache
def gain(count: int, kind: Kind) -> Gain:
    """Steady gains and that of the run-up."""
    if count == 1 and kind == "stacked":
        return gain(1, "concentric")
    scene = machine(count, kind)
    at_speed, peak = steady_gain(count, kind)
    density = scene.fills[0].liquid.density
    return Gain(
        at_speed=at_speed,
        peak=peak,
        run_up=_largest(scene) / _largest_dry(),
        added=sum(fill.full_mass for fill in scene.fills) / scene.rotor.machine().mass,  # type: ignore[union-attr]
        most=sum(density * fill.volume * fill.chamber.radius for fill in scene.fills),
    )


def _largest(scene: Scene) -> float:
    """Largest deflection of a run-up, m."""
    # At any step: the samples need not be close.
    return float(runup_scene(scene, cells=_CELLS, samples=_SAMPLES, check=False).history.largest.max())


@cache
def _largest_dry() -> float:
    """The same without liquid, m."""
    scene = machine(1, "concentric")
    return _largest(scene.altered(chambers=tuple(ring.holding(0.0) for ring in scene.liquids)))


def cases() -> list[Case]:
    """Gain of rings over one ring: at speed, at the resonance, in a run-up."""
    return [_case(kind, *each) for kind in KINDS for each in _MEASURES]


_MEASURES = (
    ("at_speed", "deflection at 90 rad/s over that without liquid"),
    ("peak", "largest deflection at constant speed over that without liquid"),
    ("run_up", "largest deflection of a run-up at 4 rad/s^2 over that without liquid"),
)
_EVEN = 1e-6  # relative difference that is none


def _case(kind: Kind, measure: str, meaning: str) -> Case:
    """One measure of one kind of rings."""
    sizes = np.array([getattr(gain(count, kind), measure) for count in COUNTS])
    better = bool(np.all(sizes[1:] < sizes[0] * (1.0 - _EVEN)))
    outcome = "the same"
    if not better:
        alike = bool(np.all(np.abs(sizes / sizes[0] - 1.0) <= _EVEN))
        outcome = "no effect" if alike else "not throughout" if sizes.min() < sizes[0] else "the opposite"
    words = {"key": measure.replace("_", "-"), "meaning": meaning, "kind": kind, "difference": outcome}
    added = ", ".join(f"{gain(count, kind).added:.3g}" for count in COUNTS)
    told = ", ".join(f"{size:{'.2f' if measure == 'run_up' else '.4g'}}" for size in sizes)
    return CLAIMS.case("chambers", told, verdict=shape_verdict(better), added=added, **words)


# Of each measure: what it is, colour and mark.
_LOOKS = {
    "at_speed": ("at 90 rad/s", "#0072B2", "o"),
    "peak": ("largest at constant speed", "#D55E00", "s"),
    "run_up": ("largest of a run-up at 4 rad/s\N{SUPERSCRIPT TWO}", "#009E73", "^"),
}


def rings_figure() -> Figure:
    """Deflection over that without liquid, over the number of rings."""
    text = (
        "The vertical rig with one litre of water in one to four rings within 400 mm by 40 mm: "
        "concentric ones 50 mm wide with layers of equal depth, or rings of equal height one above the "
        "other. Steady: exact equilibrium and linear layers; run-up: annular long waves, 32 cells. "
        "Assumed: 30 kg, 40 mm, damping ratio 0.01, smooth walls, the ramp."
    )
    with page([2.9], text) as (figure, [[axes]]):
        for kind in KINDS:
            for measure, (label, color, mark) in _LOOKS.items():
                sizes = [getattr(gain(count, kind), measure) for count in COUNTS]
                look = {"color": color, "marker": mark, "markersize": 4.5, "linewidth": 1.3}
                if kind == "stacked":
                    look |= {"linestyle": (0, (5, 1.5)), "markerfacecolor": "white"}
                axes.plot(COUNTS, sizes, label=f"{kind}, {label}", **look)
        axes.axhline(1.0, color="0.45", linewidth=0.8)
        axes.set(xticks=COUNTS, xlim=(0.8, 4.2), ylim=(0.0, 1.2))
        axes.set_xlabel("Number of rings that share one litre")
        axes.set_ylabel("Deflection over that without liquid (\N{EN DASH})")
    return figure


if __name__ == "__main__":
    launch(shown(claims_rings=rings_figure))
