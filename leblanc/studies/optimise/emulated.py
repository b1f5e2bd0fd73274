"""A vibration over the volumes by an emulator of a sweep, for searches with very many evaluations."""

from __future__ import annotations

import re
from pathlib import Path

from leblanc.results.optimum import EmulatedAnswer
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies.sweep.emulator import Emulator, emulate_store, varied_fields
from leblanc.studies.sweep.store import read_store
from meshes.arrays import Array
from meshes.errors import InputError

_VOLUME = re.compile(r"chambers\.(\d+)\.volume")


class EmulatedVibration:
    """Vibration of a machine by an emulator over the volumes of some of its chambers."""

    def __init__(self, emulator: Emulator, chambers: tuple[int, ...]) -> None:
        self.emulator, self.chambers = emulator, chambers

    def exact(self, volumes: Array) -> Array:
        """See `leblanc.studies.optimise.objectives.Vibration`; as exact as the emulator is."""
        return self.emulator.output(volumes[:, self.chambers])

    def answer(self, volume: Array) -> EmulatedAnswer:
        """What it says of one set of volumes, shape (c,)."""
        value, deviation = self.emulator.predict(volume[None, self.chambers])
        return EmulatedAnswer(float(value[0]), float(deviation[0]), self.emulator.error)

    def inside(self, low: Array, high: Array, own: Array) -> tuple[Array, Array]:
        """Bounds of the volumes cut to what the emulator knows; other chambers keep their own volume."""
        least, most = own.copy(), own.copy()
        for k, chamber in enumerate(self.chambers):
            least[chamber] = max(low[chamber], self.emulator.low[k])
            most[chamber] = min(high[chamber], self.emulator.high[k])
            if not least[chamber] <= most[chamber]:
                span = f"{self.emulator.low[k]:g} to {self.emulator.high[k]:g} m^3"
                allowed = f"such that they meet the samples of the sweep, {span}"
                raise InputError(f"optimise.volumes.{chamber}", (low[chamber], high[chamber]), allowed)
        return least, most


def emulated_vibration(store: Path, scene: Scene, task: Optimisation, seed: int = 0) -> EmulatedVibration:
    """Emulator of the vibration that an optimisation is after, from a sweep over the volumes."""
    found = read_store(store)
    if found.attributes()["scene_digest"] != scene.digest:
        raise InputError("--emulator", str(store), "the store of a sweep of this very scene")
    matches = [_VOLUME.fullmatch(name) for name in varied_fields(found)]
    chambers = tuple(int(match[1]) for match in matches if match is not None)
    if len(chambers) != len(matches):
        raise InputError("--emulator", str(store), "a sweep that varies volumes and nothing else")
    return EmulatedVibration(emulate_store(found, _output(scene, task), seed), chambers)


def _output(scene: Scene, task: Optimisation) -> str:
    """Output of a sweep that is the vibration of the objective."""
    if task.objective == "working_speed" and task.working_speed in (None, scene.speeds.stop):
        return "last_amplitude"
    if task.objective == "peak" and (task.steady or scene.speed_plan is None):
        return "peak_amplitude"
    allowed = "working_speed at the last speed, or peak of the steady response, with an emulator"
    raise InputError("--objective", task.objective, allowed)
