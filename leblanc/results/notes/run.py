"""Notes of the response to an unbalance: limits of validity and findings, one function a sentence."""

from __future__ import annotations

import numpy as np

from leblanc.results.choice import Choice
from leblanc.results.note import Note, NoteCode, percent
from leblanc.results.response import SelfExcited
from leblanc.units import ML, MM, RPM
from meshes.arrays import Array


class RunCode(NoteCode):
    """What the notes of a response say."""

    LIQUID_MODEL = "liquid_model"
    TOLERANCE_MISSED = "tolerance_missed"
    NOT_CARRIED = "not_carried"
    SLOW_DISTURBANCES = "slow_disturbances"
    PLANE = "plane"
    AGAINST_SPIN = "against_spin"
    SELF_EXCITED = "self_excited"
    SEVERAL_ANSWERS = "several_answers"
    WALL = "wall"
    MESH = "mesh"


# What a page that shows the table of models says there already.
OF_MODELS = (RunCode.LIQUID_MODEL, RunCode.TOLERANCE_MISSED)


def liquid_models(choice: Choice) -> Note | None:
    """How many speeds each model answers; None where the scene names the model."""
    if choice.cut:
        text = "Liquid model: finite elements for small disturbances; their error is not estimated."
        return Note(RunCode.LIQUID_MODEL, {"fem": choice.models.size}, text)
    if choice.asked:
        return None
    exact, count = int(np.count_nonzero(choice.models == "statics")), choice.models.size
    text = (
        f"Liquid model: linear theory at {count - exact} of {count} speeds, where it is within "
        f"{percent(choice.tolerance)}; exact equilibrium at {exact}."
    )
    return Note(RunCode.LIQUID_MODEL, {"linear": count - exact, "statics": exact}, text)


def tolerance_missed(choice: Choice, speed: Array) -> Note | None:
    """Where the estimated error is larger than the tolerance; None where it is nowhere.

    Parameters
    ----------
    choice : the models
    speed : rad/s, shape (n,)
    """
    missed = choice.missed & choice.in_range
    if choice.cut or not missed.any():
        return None
    (first, last), worst = speed[missed][[0, -1]], choice.error[missed].max()
    size = f"up to {percent(worst)}" if np.isfinite(worst) else "without a bound"
    whose = " of the model asked for" if choice.asked else ""
    text = (
        f"Between {first * RPM:.4g} and {last * RPM:.4g} rpm the estimated error{whose} is {size}, more than "
        f"the tolerance of {percent(choice.tolerance)}."
    )
    return Note(RunCode.TOLERANCE_MISSED, {"first": first, "last": last, "error": worst}, text)


def not_carried(below: float) -> Note:
    """Gravity across the axis holds the liquid back.

    Parameters
    ----------
    below : speed above which the liquid rides with the drum, rad/s
    """
    text = (
        f"Below {below * RPM:.3g} rpm gravity across the axis keeps the liquid from riding with the drum: "
        "out of range."
    )
    return Note(RunCode.NOT_CARRIED, {"below": below}, text)


def slow_disturbances() -> Note:
    """What the stability of branches of a planar rotor means."""
    text = "Branches are judged against slow disturbances, the liquid always in equilibrium."
    return Note(RunCode.SLOW_DISTURBANCES, {}, text)


def plane(position: float, zero: str, chambers: bool) -> Note:
    """Where the motion of a rotor that tilts is measured.

    Parameters
    ----------
    position : of the plane, m
    zero : what angles count from
    chambers : the plane is that of the first chamber
    """
    place = "the first chamber" if chambers else "the origin of positions"
    start = "the unbalance" if zero == "unbalance" else zero
    text = (
        f"Amplitude: largest radius of the orbit at {place}, {position * MM:.4g} mm. Angles: of its part "
        f"that turns with the spin, from {start}."
    )
    return Note(RunCode.PLANE, {"position": position}, text)


def against_spin(share: float, speed: float) -> Note:
    """How far the orbit is from a circle.

    Parameters
    ----------
    share : of the orbit that goes against the spin, at most
    speed : where it does, rad/s
    """
    text = (
        f"Up to {share:.2g} of the orbit goes against the spin, at {speed * RPM:.4g} rpm; the liquid answers "
        "that part by linear theory."
    )
    return Note(RunCode.AGAINST_SPIN, {"share": share, "speed": speed}, text)


def self_excited(whirl: SelfExcited) -> Note:
    """Whether a whirl grows by itself, where, and how fast at most."""
    theory = f"linear theory of an even layer, liquid friction: {whirl.friction}"
    data: dict[str, object] = {"bands": whirl.bands}
    if np.isnan(whirl.growth).any():
        text = f"Whether a whirl grows by itself was not found at every speed ({theory})."
        return Note(RunCode.SELF_EXCITED, data, text)
    if not whirl.bands:
        text = f"No whirl grows by itself at these speeds ({theory})."
        return Note(RunCode.SELF_EXCITED, data, text)
    listed = ", ".join(f"{low * RPM:.5g} to {high * RPM:.5g} rpm" for low, high in whirl.bands)
    most, fastest = int(np.argmax(whirl.growth)), ""
    if whirl.growth[most] > 0.0:
        growth, turning = float(whirl.growth[most]), float(whirl.whirl_speed[most])
        data |= {"growth": growth, "whirl_speed": turning}
        fastest = f", fastest at {growth:.3g} 1/s, whirling at {turning * RPM:.4g} rpm"
    text = f"A whirl grows by itself from {listed}{fastest}: unstable there ({theory})."
    return Note(RunCode.SELF_EXCITED, data, text)


def several_answers(first: float, last: float, stable: bool) -> Note:
    """More than one deflection satisfies the balance.

    Parameters
    ----------
    first, last : speeds between which they do, rad/s
    stable : the largest stable one is reported; else the largest
    """
    which = "largest stable one" if stable else "largest"
    text = (
        f"Several deflections satisfy the balance between {first * RPM:.4g} and {last * RPM:.4g} rpm; "
        f"reported is the {which}, where a slow run-up arrives."
    )
    return Note(RunCode.SEVERAL_ANSWERS, {"first": first, "last": last}, text)


def wall(chamber: int, speed: float, volume: float, enough: float, deflection: float) -> Note:
    """How much liquid just covers the wall of a chamber.

    Parameters
    ----------
    chamber : its number, from 0
    speed : rad/s
    volume, enough : of the liquid, and what just covers the wall, m^3
    deflection : of the axis there, m
    """
    has = "wet all round" if volume > enough else "dry in part"
    text = (
        f"Chamber {chamber + 1} at {speed * RPM:.4g} rpm: wall {has} with {volume * ML:.4g} ml; "
        f"{enough * ML:.4g} ml just cover it, deflection {deflection * MM:.3g} mm."
    )
    data = {"chamber": chamber, "speed": speed, "volume": volume, "enough": enough, "deflection": deflection}
    return Note(RunCode.WALL, data, text)


def mesh(chamber: int, finding: str) -> Note:
    """What is poor in the mesh of a chamber's section.

    Parameters
    ----------
    chamber : its number, from 0
    finding : in words
    """
    return Note(RunCode.MESH, {"chamber": chamber}, f"Mesh of chamber {chamber + 1}: {finding}.")
