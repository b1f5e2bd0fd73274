"""A scene: one machine with its liquid, in SI units, frozen, every value checked."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

from fluid.fill import Fill
from fluid.friction import Friction
from leblanc.scene.load import check_table, read_scene
from leblanc.scene.optimise import Aim, aim_of
from leblanc.scene.rotors import AnyRotor, rotor_from_table
from leblanc.scene.rotors import Exciter as Exciter  # what a scene's rotor may be
from leblanc.scene.rotors import Rotor as Rotor
from leblanc.scene.rotors import TubRotor as TubRotor
from leblanc.scene.rotors import TwoPlaneRotor as TwoPlaneRotor
from leblanc.scene.runup import RunupTable
from leblanc.scene.tables import SceneTable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_DIGITS = 10  # of each number in the digest; spellings of one value differ in the sixteenth


@dataclass(frozen=True)
class Speeds:
    """Evenly spaced spin speeds.

    Parameters
    ----------
    start, stop : first and last, rad/s
    count : how many
    """

    start: float
    stop: float
    count: int


@dataclass(frozen=True)
class Model:
    """How the liquid is modelled.

    Parameters
    ----------
    liquid : "auto", "statics", "linear", "long_wave", "kdv" or "fem"
    friction : on the wall
    tolerance : relative error that "auto" may make
    """

    liquid: str
    friction: Friction
    tolerance: float = 1e-3


@dataclass(frozen=True)
class Motor:
    """A motor that drives the rotor.

    Parameters
    ----------
    inertia : of all that it turns, about the axis, kg m^2
    speeds : rising, rad/s
    torques : at those speeds, straight lines between them, N m
    """

    inertia: float
    speeds: tuple[float, ...]
    torques: tuple[float, ...]


@dataclass(frozen=True)
class Runup:
    """A ramp of the spin speed, then held; or the speed that a motor reaches.

    Parameters
    ----------
    start, stop : rad/s
    rate : rad/s^2; None with a motor
    duration : ramp and hold together, s
    cells : of each liquid layer
    back : down again at the same rate
    dispersion : the layers' waves disperse
    samples : of the results over time
    motor : None with a ramp
    """

    start: float
    stop: float
    rate: float | None
    duration: float
    cells: int
    back: bool
    dispersion: bool = False
    samples: int = 2000
    motor: Motor | None = None


@dataclass(frozen=True)
class Scene:
    """One machine.

    Parameters
    ----------
    name, source : free text
    assumed : paths of the values that the source does not give
    gravity : m/s^2
    rotor : without the liquid; its `kind` tells which of the four it is
    chambers : each with its liquid
    speeds : at which the machine is studied
    model : of the liquid
    runup : None unless the scene has one
    optimise : what its liquid is chosen for; None unless the scene says so
    """

    name: str
    source: str
    assumed: tuple[str, ...]
    gravity: float
    rotor: AnyRotor
    chambers: tuple[Fill, ...]
    speeds: Speeds
    model: Model
    runup: Runup | None
    optimise: Aim | None = None

    def speed_array(self) -> NDArray[np.float64]:
        """Spin speeds, rad/s, shape (count,)."""
        import numpy as np

        return np.linspace(self.speeds.start, self.speeds.stop, self.speeds.count)

    @property
    def digest(self) -> str:
        """Fingerprint of the content (SHA-256): the same however units, keys and blanks are written."""
        sections = [fill.chamber.section for fill in self.chambers]
        clear = tuple(replace(fill, chamber=replace(fill.chamber, section=None)) for fill in self.chambers)
        values = asdict(replace(self, chambers=clear))
        # A scene without a part that came later is the scene it was before there was one.
        if self.optimise is None:
            del values["optimise"]
        for fill, section in zip(values["chambers"], sections, strict=True):
            del fill["chamber"]["section"]
            if section is not None:
                fill["chamber"]["section"] = section.digest
            if fill["chamber"]["baffles"] is None:
                del fill["chamber"]["baffles"]
        content = json.dumps(_rounded(values), sort_keys=True)
        return hashlib.sha256(content.encode()).hexdigest()


def load_scene(path: str | PathLike[str]) -> Scene:
    """Scene from a TOML file.

    Parameters
    ----------
    path : the file

    Raises
    ------
    SceneFaults : with everything that is wrong, not just the first
    """
    return scene_from_table(read_scene(path), str(path))


def scene_from_table(table: Mapping[str, Any], file: str = "scene") -> Scene:
    """Scene from the content of a TOML file.

    Parameters
    ----------
    table : keys and values as `tomllib` reads them
    file : what to call it in messages

    Raises
    ------
    SceneFaults : with everything that is wrong
    """
    return _scene(check_table(table, file))


def _scene(table: SceneTable) -> Scene:
    """Typed parts from checked values."""
    law, coefficient = table.model.friction
    return Scene(
        name=table.name,
        source=table.source,
        assumed=table.assumed,
        gravity=table.gravity,
        rotor=rotor_from_table(table.rotor),
        chambers=tuple(Fill(one.chamber(), one.liquid, one.volume) for one in table.chambers),
        speeds=Speeds(**table.speeds.model_dump()),
        model=Model(table.model.liquid, Friction(law, coefficient), table.model.tolerance),
        runup=None if table.runup is None else _runup(table.runup),
        optimise=None if table.optimise is None else aim_of(table.optimise),
    )


def _runup(table: RunupTable) -> Runup:
    values = table.model_dump(exclude={"motor"})
    return Runup(**values, motor=None if table.motor is None else Motor(**table.motor.model_dump()))


def _rounded(value: Any) -> Any:
    """The same with every float as a text of a few digits."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(entry) for entry in value]
    return f"{value:.{_DIGITS}g}" if isinstance(value, float) else value
