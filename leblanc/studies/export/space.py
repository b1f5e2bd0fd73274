"""State space of a scene: of each chamber and of the planar machine, as MAT and JSON."""

from __future__ import annotations

import json
from io import BytesIO
from pathlib import Path

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import FrictionLaw
from fluid.whirl import Layer, covering_speed, plane_layer
from leblanc.core.files import writing
from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.units import in_rpm
from leblanc.liquid.choose import across_gravity, axial_gravity
from leblanc.scene.scene import (
    JeffcottRotor,
    Scene,
    jeffcott,
    require_chambers,
    require_clear,
    require_no_balls,
    require_whirl,
)
from meshes.errors import InputError, require_positive
from solvers.whirl.state_space import BAND, Liquid, StateSpace, chamber_space, largest_error, machine_space

_WHAT = "a state space, whose liquid is a ring with circular walls"
# Of each pair of states, inputs and outputs by the first letters of its name.
_UNITS = {"acceleration": "m s-2", "force": "N", "liquid_force": "N", "liquid": "m", "deflection": "m"}


class SpaceCode(NoteCode):
    """What a state space is good for."""

    EXACT = "state_space_exact"
    FITTED = "state_space_fitted"
    CHAMBERS_ALONE = "state_space_of_chambers_alone"
    SMALL = "state_space_of_small_waves"


def spaces(scene: Scene, speed: float | None) -> tuple[dict[str, tuple[str, StateSpace]], tuple[Note, ...]]:
    """Content and state space of each file by its name, and how exact they are."""
    require_whirl(scene, known=True)
    require_chambers(scene, "a state space")
    require_no_balls(scene, "a state space")
    require_clear(scene, _WHAT)
    scene = scene.as_read()
    if across_gravity(scene) > 0.0:
        text = (
            "0 for a state space: transverse gravity turns in the drum frame, which has no constant matrices"
        )
        raise InputError("gravity", scene.gravity, text)
    spin = float(scene.speed_array()[-1]) if speed is None else speed
    require_positive("speed", spin)
    least = max(covering_speed(fill, axial_gravity(scene)) for fill in scene.fills)
    if spin <= least:
        raise InputError("speed", spin, f"above {least:.6g} rad/s, from which the liquid covers its walls")
    liquids = [_liquid(scene, fill) for fill in scene.fills]
    found = {}
    for k, liquid in enumerate(liquids):
        text = f"chamber {k + 1}: acceleration of its axis to force of the liquid"
        found[f"chamber_{k + 1}"] = (text, chamber_space(liquid, spin))
    notes = [_exactness(liquids, [space for _, space in found.values()], spin)]
    if isinstance(scene.rotor, JeffcottRotor):
        text = "machine: force on its axis to deflection and force of the liquid"
        found["machine"] = (text, machine_space(jeffcott(scene), liquids, spin))
    else:
        kind = scene.rotor.kind.replace("_", " ")
        said = f"A {kind} rotor is not planar: there are files of its chambers only."
        notes.append(Note(SpaceCode.CHAMBERS_ALONE, {"kind": scene.rotor.kind}, said))
    if scene.model.friction.law is FrictionLaw.QUADRATIC:
        notes.append(Note(SpaceCode.SMALL, {}, "Small waves do not feel quadratic friction: it is left out."))
    return found, tuple(notes)


def _liquid(scene: Scene, fill: Fill) -> Liquid:
    """The layer of a fill, or the mass of liquid without a free surface."""
    return plane_layer(fill, scene.model.friction) or fill.mass


def _exactness(liquids: list[Liquid], found: list[StateSpace], spin: float) -> Note:
    laminar = any(isinstance(each, Layer) and each.stokes + each.lids > 0.0 for each in liquids)
    at = f"At {in_rpm(spin)}, in the drum frame"
    if not laminar:
        return Note(SpaceCode.EXACT, {"speed": spin}, f"{at}: the linear model exactly.")
    error = max(largest_error(*each) for each in ((a, spin, b) for a, b in zip(liquids, found, strict=True)))
    low, high = BAND
    text = (
        f"{at}: laminar drag is a rational fit for slips from {low:g} to {high:g} times the spin; there the "
        f"force of the liquid is within {percent(error)} of the linear model's."
    )
    return Note(SpaceCode.FITTED, {"speed": spin, "error": error, "band": list(BAND)}, text)


def content(space: StateSpace, notes: tuple[Note, ...]) -> dict[str, object]:
    """What a file holds, by name; of the error and band, rad/s from the drum, see the notes."""
    units = {
        f"{kind}_units": [_unit(name) for name in getattr(space, kind)] for kind in ("inputs", "outputs")
    }
    matrices = {name: getattr(space, name) for name in "ABCD"}
    names = {name: list(getattr(space, name)) for name in ("inputs", "outputs", "states")}
    frame = "drum: x and y turn with the spin"
    return {
        **matrices,
        **names,
        **units,
        "speed": space.speed,
        "largest_error": next((note.data["error"] for note in notes if note.code is SpaceCode.FITTED), 0.0),
        "band": [part * space.speed for part in BAND],
        "frame": frame,
        "notes": [note.text for note in notes],
    }


def _unit(name: str) -> str:
    return _UNITS[name.rpartition("_")[0]]


def write_spaces(
    found: dict[str, tuple[str, StateSpace]], notes: tuple[Note, ...], folder: Path
) -> dict[str, str]:
    """A MAT file (level 5) and a JSON file of each; what they hold by their names."""
    from scipy.io import savemat

    made: dict[str, str] = {}
    for name, (text, space) in sorted(found.items()):
        said, memory = content(space, notes), BytesIO()
        plain = {k: each.tolist() if isinstance(each, np.ndarray) else each for k, each in said.items()}
        with writing(folder / f"{name}.json") as part:
            part.write_text(json.dumps(plain, indent=1) + "\n", encoding="utf-8")
        texts = {
            k: np.array(each, dtype=object) if isinstance(each, list) else each for k, each in said.items()
        }
        savemat(memory, texts, oned_as="column")
        with writing(folder / f"{name}.mat") as part:
            part.write_bytes(memory.getvalue())
        made |= {f"{name}.json": text, f"{name}.mat": text}
    return made
