"""The cases of the blood pump, and what its page says of the current and of coils."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from solvers.rotor.magnetic.control import Synergetic
from solvers.rotor.magnetic.linear import closed_loop
from solvers.rotor.magnetic.motion import Ending, Load, SpeedLaw, integrate
from tests.mutants import kills
from tests.oracles.cases import come_out_again, kept_group, verdicts
from validation.cases.rotors import blood_pump
from validation.cases.rotors.blood_pump import LOAD, MACHINE, SPEED, control, controllers, slow_coils


@kills("solvers.rotor.magnetic.machine:Magnets.force", "(near - far)", "(np.sqrt(near) - np.sqrt(far))")
@kills(
    "solvers.rotor.magnetic.machine:MagneticRotor.motor_pull", "across.T @ across + own", "across.T @ across"
)
@kills("solvers.rotor.magnetic.machine:dimensionless", "machine.drag * time", "machine.drag")
@kills(
    "solvers.rotor.magnetic.machine:MagneticRotor.unbalance_load",
    "1j * np.asarray(angle)",
    "-1j * np.asarray(angle)",
)
def test_cases_of_the_pump() -> None:
    found = kept_group("blood_pump")
    errata = {"pi-h", "pi-h-table", "eq-39-order", "numbering", "poles", "stability"}
    assert verdicts(found, "erratum") == errata
    assert verdicts(found, "trend") == {"accuracy", "startup"}
    assert len(verdicts(found, "agrees")) == len(found) - 8
    loop = closed_loop(MACHINE, control(), SPEED)
    come_out_again([*blood_pump._table(), *blood_pump._equations(), *blood_pump._stability(loop)])


def test_every_parameter_is_changed_twice() -> None:
    found = blood_pump.variants()
    assert len(found) == 14 and all(machine != MACHINE for machine in found.values())
    for name, factor in (("Pi_2 doubled", 2.0), ("Pi_2 halved", 0.5)):
        across, about = found[name].transverse_inertia, found[name].polar_inertia
        assert about / across == MACHINE.polar_inertia / MACHINE.transverse_inertia
        assert MACHINE.transverse_inertia / across == factor


def test_the_condition_of_the_source_is_not_enough() -> None:
    """With h = 1 the rotor is soon at a magnet, in the full equations; by Routh's rule, D P < mu Z."""
    weak: Synergetic = control(weight=1.0)
    assert weak.weight * weak.rate > 0.0
    place, rate, memory = weak.feedback
    assert np.all(place * rate < weak.rates * memory)
    motion = integrate(MACHINE, weak, SpeedLaw(SPEED), 0.2, place=(1e-6, 0.0, 0.0, 0.0))
    assert motion.ending is Ending.TOUCHED and motion.time[-1] < 0.05


def test_the_page_on_currents() -> None:
    """Both controllers need 10 mA for 1.2 N in the end; at first the stiff PID takes more."""
    largest = []
    # The stiff one is at rest sooner.
    for controller, time in zip(controllers(), (0.4, 0.2), strict=True):
        still = replace(MACHINE, eccentricity=0.0, inertia_tilt=0.0)
        motion = integrate(still, controller, SpeedLaw(SPEED), time, [Load((LOAD, 0.0))], samples=4001)
        largest.append(np.abs(motion.current).max())
        settled = closed_loop(still, controller, SPEED).answer([LOAD, 0.0, 0.0, 0.0], 0.0)[1]
        np.testing.assert_allclose(np.abs(motion.current[-1]), [0.01, 0.0, 0.01, 0.0], atol=2e-6)
        np.testing.assert_allclose(settled.real, [-0.01, 0.0, -0.01, 0.0], atol=1e-9)
    assert 0.0105 < largest[0] < 0.0109 and 0.0125 < largest[1] < 0.0135


def test_the_page_on_coils() -> None:
    bandwidth = np.array([500.0, 2e3, 8e4])
    synergetic, pid = (slow_coils(controller, bandwidth) for controller in controllers())
    assert synergetic.sensitivity[1] > 15.0 and 2.5 < pid.sensitivity[1] < 3.0
    assert np.isnan(pid.sensitivity[0]) and pid.damping[0] < 0.0 < synergetic.damping[0] < 0.02
    assert synergetic.sensitivity[2] < 3.0
