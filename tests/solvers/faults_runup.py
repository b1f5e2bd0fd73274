"""Seeded faults of the run-up around its compiled steps."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.runup import test_linear as linear
from tests.solvers.runup import test_runup as oracle

RUN, SET, READ, FILL = (
    f"solvers.{name}" for name in ("runup", "coupled_machine", "coupled_reading", "coupled_fill")
)
DRIVE, LINEAR = "solvers.runup.drive", "solvers.runup.linear"
FAULTS: tuple[Fault, ...] = (
    Fault(
        DRIVE, "self.start + self.rate * rise", "self.start + 0.9 * self.rate * rise", oracle.check_capture
    ),
    Fault(DRIVE, "self.duration + rise, self.start", "self.duration + rise, top", oracle.check_capture),
    Fault(RUN, "np.diff(corners[1]) / np.diff(corners[0])", "np.diff(corners[1])", oracle.check_capture),
    Fault(RUN, "np.exp(-1j * self.angle)", "np.exp(1j * self.angle)", oracle.check_steady),
    Fault(RUN, "places @ self.layer_mass", "0.5 * places @ self.layer_mass", oracle.check_steady),
    Fault(RUN, "self.gravity + self.captured", "self.gravity - self.captured", oracle.check_capture),
    Fault(RUN, "cells = numerics.cells // 2", "cells = numerics.cells", oracle.check_error_estimate),
    Fault(SET, "plane.T @ momentum * (not kept)", "plane.T @ momentum * kept", oracle.check_switch),
    Fault(SET, "_RELEASE * machine.capture", "machine.capture", oracle.check_capture),
    Fault(SET, "1.2 * machine.spin", "1.4 * machine.spin", oracle.check_switch),
    Fault(
        SET, "-machine.spin * np.square(machine.area[anew])", "0.0 * machine.area[anew]", oracle.check_switch
    ),
    Fault(
        SET,
        "mass += layer[MASS] * plane.T @ plane",
        "mass -= layer[MASS] * plane.T @ plane",
        oracle.check_switch,
    ),
    Fault(READ, "(1.0 + surface + np.square(surface)) / 3.0", "(1.0 + surface) / 2.0", oracle.check_reading),
    Fault(READ, "1j * (lever @ angles[1])", "1j * (lever @ angles[0])", oracle.check_reading),
    Fault(
        READ,
        "velocity += machine.spin * machine.area",
        "velocity -= machine.spin * machine.area",
        oracle.check_reading,
    ),
    Fault(READ, "1.0 - surface.max(axis=1", "1.0 - surface.min(axis=1", oracle.check_reading),
    Fault(FILL, "gravity / fill.surface_radius", "gravity / fill.chamber.radius * 0.5", oracle.check_capture),
    Fault(LINEAR, "lost += machine.masses[j]", "lost -= machine.masses[j]", linear.check_switch),
    Fault(LINEAR, "0.98 * machine.capture", "machine.capture", linear.check_capture),
    Fault(LINEAR, "1j * m.place[n + 1 :: 2]", "-1j * m.place[n + 1 :: 2]", linear.check_steady),
    Fault(
        LINEAR,
        "(m.layers[:, 1] - 1.0) * np.abs(offset)",
        "m.layers[:, 1] * np.abs(offset)",
        linear.check_depth,
    ),
)
