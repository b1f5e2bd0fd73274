"""Names of the JSON of loads for the results that carry them."""

from __future__ import annotations

from typing import Any

from leblanc.core.quantities import to_json
from leblanc.studies.loads.answer import MachineLoads


def told(name: str) -> Any:
    """A key of the JSON of the loads as an attribute of the result."""

    def value(result: Any) -> Any:
        found = None if result.loads is None else to_json(result.loads)
        if found is None or name not in found:
            raise AttributeError(name)
        return found[name]

    return property(value)


class Loaded:
    """A result with loads: what `MachineLoads.to_json` tells, under the same names."""

    loads: MachineLoads | None

    displacement = told("displacement")
    clearance = told("clearance")
    clearance_over_time = told("clearance_over_time")
    orbit = told("orbit")
    mount_force = told("mount_force")
    bearing_force = told("bearing_force")
    bearing_impulse = told("bearing_impulse")
    bearing_impulse_time = told("bearing_impulse_time")
    motor_torque = told("motor_torque")
    motor_power = told("motor_power")
    floor_force = told("floor_force")
    floor_force_least = told("floor_force_least")
    floor_force_rest = told("floor_force_rest")
    lift_off_margin = told("lift_off_margin")
    slip_margin = told("slip_margin")
    walking_margin = told("walking_margin")
    walking_margin_over_time = told("walking_margin_over_time")
    worst = told("worst")
