"""A scene: one machine with its liquid, in SI units, frozen, every value checked."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

from fluid.fill import Fill
from meshes.chamber import Chamber
from study.friction import Friction
from study.scene_file import check_table, read_toml
from study.scene_table import RotorTable, SceneTable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_DIGITS = 10  # of each number in the digest; spellings of one value differ in the sixteenth


@dataclass(frozen=True)
class Rotor:
    """A rotor on an isotropic support, moving in one plane.

    Parameters
    ----------
    kind : "jeffcott"
    mass : M without the liquid, kg
    stiffness : K, N/m
    damping : C of the support, external, N s/m
    unbalance : U0 = m e, kg m
    axis : "horizontal" if gravity lies across the axis, "vertical" if along it
    """

    kind: Literal["jeffcott"]
    mass: float
    stiffness: float
    damping: float
    unbalance: float
    axis: Literal["horizontal", "vertical"]


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
    """

    liquid: str
    friction: Friction


@dataclass(frozen=True)
class Runup:
    """A ramp of the spin speed, then held.

    Parameters
    ----------
    start, stop : rad/s
    rate : rad/s^2
    duration : ramp and hold together, s
    cells : of each liquid layer
    back : down again at the same rate
    """

    start: float
    stop: float
    rate: float
    duration: float
    cells: int
    back: bool


@dataclass(frozen=True)
class Scene:
    """One machine.

    Parameters
    ----------
    name, source : free text
    assumed : paths of the values that the source does not give
    gravity : m/s^2
    rotor : without the liquid
    chambers : each with its liquid, at least one
    speeds : at which the machine is studied
    model : of the liquid
    runup : None unless the scene has one
    """

    name: str
    source: str
    assumed: tuple[str, ...]
    gravity: float
    rotor: Rotor
    chambers: tuple[Fill, ...]
    speeds: Speeds
    model: Model
    runup: Runup | None

    def speed_array(self) -> NDArray[np.float64]:
        """Spin speeds, rad/s, shape (count,)."""
        import numpy as np

        return np.linspace(self.speeds.start, self.speeds.stop, self.speeds.count)

    @property
    def digest(self) -> str:
        """Fingerprint of the content (SHA-256): the same however units, keys and blanks are written."""
        content = json.dumps(_rounded(asdict(self)), sort_keys=True)
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
    return scene_from_table(read_toml(path), str(path))


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
        rotor=_rotor(table.rotor),
        chambers=tuple(
            Fill(Chamber(one.radius, one.height, one.inner_radius, one.plane), one.liquid, one.volume)
            for one in table.chambers
        ),
        speeds=Speeds(**table.speeds.model_dump()),
        model=Model(table.model.liquid, Friction(law, coefficient)),
        runup=None if table.runup is None else Runup(**table.runup.model_dump()),
    )


def _rotor(table: RotorTable) -> Rotor:
    """Stiffness and damping from a critical speed and a damping ratio, both of the rotor without liquid.

    K = M omega^2 and C = 2 zeta sqrt(K M).
    """
    stiffness, damping = table.stiffness, table.damping
    if table.critical_speed is not None:
        stiffness = table.mass * table.critical_speed**2
    assert stiffness is not None
    if table.damping_ratio is not None:
        damping = 2.0 * table.damping_ratio * math.sqrt(stiffness * table.mass)
    assert damping is not None
    return Rotor(table.kind, table.mass, stiffness, damping, table.unbalance, table.axis)


def _rounded(value: Any) -> Any:
    """The same with every float as a text of a few digits."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(entry) for entry in value]
    return f"{value:.{_DIGITS}g}" if isinstance(value, float) else value
