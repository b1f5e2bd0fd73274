"""Whether the best fill depends on the objective as a real washing machine's did.

The machine is a top loader with an upright drum; its ring, speeds and load are not known. The model's machine
is assumed: what is compared is which of the objectives wants more liquid, and the shape over the volume.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from leblanc.scene.chambers import Chamber
from leblanc.scene.scene import JeffcottRotor, Model, Runup, Scene, Speeds
from leblanc.studies.optimise.answers import FilledMachine
from leblanc.studies.optimise.objectives import RunupPeak
from leblanc.units import RPM
from meshes.arrays import Array
from validation.cases.case import Case, Effect, shape_verdict
from validation.cases.rigs import data

_ML = 1e-6  # m^3
_GROUP, _SOURCE = "fill_sweep", "washing machine with a balance ring, see fill_sweep.json"
# All assumed: 40 kg that swing on a suspension of 2 Hz, damping ratio 0.1, 0.4 kg of laundry 200 mm from the
# axis; a ring of 240 mm radius outside, 205 inside, 40 mm high, baffled (friction 3 1/s); spun up to 700 rpm.
MASS, NATURAL, RATIO, UNBALANCE = 40.0, 2.0 * np.pi * 2.0, 0.1, 0.08
OUTER, INNER, HEIGHT, FRICTION = 0.24, 0.205, 0.04, 3.0
START, CRUISE, RATE, DURATION = 40.0 / RPM, 700.0 / RPM, 5.0, 20.0
_ASSUMED = (
    "assumed: 40 kg, 2 Hz, damping ratio 0.1, unbalance 0.08 kg m, upright; ring 240/205 mm, 40 mm high, "
    "friction 3 1/s; 40 to 700 rpm at 5 rad/s^2"
)


def machine() -> Scene:
    """The assumed machine, its ring empty."""
    stiffness, damping = MASS * NATURAL**2, 2.0 * RATIO * MASS * NATURAL
    return Scene(
        name="Top loader",
        assumed=("rotor", "chambers", "runup"),
        rotor=JeffcottRotor(
            mass=MASS, stiffness=stiffness, damping=damping, unbalance=UNBALANCE, axis="vertical"
        ),
        chambers=[Chamber(radius=OUTER, height=HEIGHT, inner_radius=INNER, liquid="water", volume=0.0)],
        speeds=Speeds(start=START, stop=CRUISE, count=201),
        model=Model(friction={"linear": FRICTION}),
        runup=Runup(start=START, stop=CRUISE, rate=RATE, duration=DURATION, cells=32),
    )


@cache
def model_curves() -> tuple[Array, Array, Array, Array]:
    """Volumes, ml; peak of the run-up, steady resonance peak, steady amplitude at cruise, m."""
    volume = np.array(data("fill_sweep.json")["added_ml"], dtype=float)
    scene, fills = machine(), volume[:, None] * _ML
    filled = FilledMachine(scene)
    cruise = filled.at(fills, np.full(volume.size, CRUISE)).amplitude
    return volume, RunupPeak(scene).exact(fills), filled.peaks(fills, scene.speeds), cruise


def cases() -> list[Case]:
    """What was measured, what the assumed machine does, and whether the objectives stand in one order."""
    measured = data("fill_sweep.json")
    added = np.array(measured["added_ml"], dtype=float)
    volume, runup, resonance, cruise = model_curves()
    rows = (
        ("resonance-peak", "resonance peak over the fill", measured["resonance_peak"], resonance),
        ("peak", "peak of the whole run over the fill", measured["peak"], runup),
        ("cruise", "mean at cruising speed over the fill", measured["cruise_mean"], cruise),
    )
    found = [_shape(name, text, added, np.array(seen, float), volume, own) for name, text, seen, own in rows]
    return [*found, _order(added, measured, volume, (resonance, runup, cruise))]


def _shape(name: str, text: str, added: Array, seen: Array, volume: Array, own: Array) -> Case:
    """One objective: where it is least and how far it falls."""
    same = _kind(seen) == _kind(own)
    effect = Effect("least over that without liquid", _least(seen), _least(own), without=1.0)
    return Case(
        name=f"{_GROUP}/{name}",
        source=_SOURCE,
        quantity=f"{text}, from 0 to {added[-1]:g} ml",
        printed=_words(added, seen),
        computed=_words(volume, own),
        difference=("the same shape" if same else f"measured it is {_kind(seen)}, computed {_kind(own)}")
        + ("" if effect.alike else "; the effect is not as large"),
        verdict=shape_verdict(same, effect),
        note=_ASSUMED,
        effect=effect,
    )


def _least(value: Array) -> float:
    """What is left of a curve at its least, over that without liquid."""
    return float(value.min() / value[0])


def _kind(value: Array) -> str:
    """Where a curve is least."""
    k = int(np.argmin(value * (1.0 + 1e-9 * np.arange(value.size))))
    return "least without liquid" if k == 0 else "least with most" if k == value.size - 1 else "least between"


def _words(volume: Array, value: Array) -> str:
    """A curve as text: where it is least, and by what factor it changes."""
    k = int(np.argmin(value * (1.0 + 1e-9 * np.arange(value.size))))
    fall = "falls all the way" if np.all(np.diff(value) < 0.0) else "not monotone"
    return f"least at {volume[k]:g} ml, {value[k] / value[0]:.2f} of that without; {fall}"


def _order(added: Array, measured: dict[str, list[float]], volume: Array, curves: tuple[Array, ...]) -> Case:
    """Which objective wants more liquid."""
    seen = [added[int(np.argmin(measured[name]))] for name in ("resonance_peak", "peak", "cruise_mean")]
    own = [volume[int(np.argmin(curve * (1.0 + 1e-9 * np.arange(curve.size))))] for curve in curves]
    same = bool(own[0] >= own[1] >= own[2]) and len(set(own)) > 1
    # The objective whose best volume is furthest off.
    far = max(zip(seen, own, strict=True), key=lambda pair: abs(pair[1] - pair[0]) / max(*pair, 1.0))
    effect = Effect("best volume of an objective, the one furthest off, ml", *map(float, far))
    return Case(
        name=f"{_GROUP}/order",
        source=_SOURCE,
        quantity="best volumes for resonance peak, peak of the run, and cruise, ml",
        printed=", ".join(f"{best:g}" for best in seen),
        computed=", ".join(f"{best:g}" for best in own),
        difference=("the same order" + (", two of them alike" if len(set(own)) < 3 else ""))
        if same
        else "another order",
        verdict=shape_verdict(same, effect),
        effect=effect,
        note="in both the best volume depends on the objective; " + _ASSUMED
        if len(set(own)) > 1
        else _ASSUMED,
    )
