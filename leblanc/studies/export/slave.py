"""The class within an FMU of `leblanc export`, copied into it; at the other end leblanc must be installed."""

from __future__ import annotations

from uuid import NAMESPACE_URL, uuid5
from xml.etree.ElementTree import Element, SubElement

from pythonfmu import DefaultExperiment, Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Integer, Real
from pythonfmu.enums import Fmi2Status

from leblanc.studies.export.cosimulation import OUTPUTS, Cosimulation, Refusal

# Of the SI: exponents of kg, m, s and rad.
_UNITS = {
    "rad/s": {"s": -1, "rad": 1},
    "m": {"m": 1},
    "kg.m": {"kg": 1, "m": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
}
_INPUTS = {
    "motor_torque": (
        "N.m",
        "torque of the motor on the rotor's axis over the next step; read with drive = 2",
    ),
    "speed_demand": ("rad/s", "spin speed at the end of the next step; read with drive = 1"),
}
_DRIVE = (
    "0: the scene's own run-up or programme, inputs are not read; 1: speed_demand, reached along a straight "
    "line over each step; 2: motor_torque"
)
_SAME = 1e-6  # of a step: times that differ by less are one


class _Quantity(Real):  # type: ignore[misc]  # an extra that may be missing
    """A real variable with its unit."""

    def __init__(self, name: str, unit: str, **given: object) -> None:
        super().__init__(name, **given)
        self.unit = unit

    def to_xml(self) -> Element:
        """As of any, with the unit."""
        found: Element = super().to_xml()
        found[0].set("unit", self.unit)
        return found


class LeblancRunup(Fmi2Slave):  # type: ignore[misc]
    """Run-up of a machine with its liquid."""

    def __init__(self, **given: object) -> None:
        super().__init__(**given)
        self._run = Cosimulation.from_resources(self.resources)
        scene = self._run.scene
        self.guid = uuid5(NAMESPACE_URL, scene.digest)
        self.description = f"Run-up of {scene.name}, by leblanc"
        self.default_experiment = DefaultExperiment(0.0, self._run.duration, self._run.usual_step)
        self.drive, self.motor_torque, self.speed_demand = 0, 0.0, self._run.start_speed
        self._start = 0.0
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(Integer("drive", description=_DRIVE, **fixed))
        for name, (unit, text) in _INPUTS.items():
            self.register_variable(_Quantity(name, unit, description=text, causality=Fmi2Causality.input))
        exact = {"causality": Fmi2Causality.output, "initial": Fmi2Initial.exact}
        for name, (unit, text) in OUTPUTS.items():
            self.register_variable(_Quantity(name, unit, description=text, **exact))
        self._show()

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """The model description, with its units."""
        root: Element = super().to_xml(model_options or {})
        units = Element("UnitDefinitions")
        for name, base in _UNITS.items():
            exponents = {part: str(power) for part, power in base.items()}
            SubElement(SubElement(units, "Unit", {"name": name}), "BaseUnit", exponents)
        root.insert(1, units)
        return root

    def _show(self) -> None:
        for name, value in self._run.outputs().items():
            setattr(self, name, value)

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        """Time at which the run-up begins."""
        self._start = start_time

    def exit_initialization_mode(self) -> None:
        """Begin as the parameter and the inputs say."""
        self._run.begin(self.drive, self.speed_demand)
        self._show()

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Go on; False, with the reason in the log, where that cannot be done."""
        if abs(current_time - self._start - self._run.time) > _SAME * step_size > 0.0:
            self.log(
                f"it goes on from {self._start + self._run.time:g} s, not {current_time:g} s",
                Fmi2Status.error,
            )
            return False
        try:
            self._run.step(step_size, self.speed_demand, self.motor_torque)
        except Refusal as refused:
            self.log(str(refused), Fmi2Status.error)
            return False
        self._show()
        return True
