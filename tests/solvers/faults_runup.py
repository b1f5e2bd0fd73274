"""Seeded faults of the run-up around its compiled steps."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.runup import test_linear as linear
from tests.solvers.runup import test_runup as oracle

RUN, SET, FILL, DRIVE, LINEAR = (
    f"solvers.runup.{name}" for name in ("runup", "long_wave", "chamber", "drive", "linear")
)
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
    Fault(SET, "RELEASE * self.capture", "self.capture", oracle.check_capture),
    Fault(SET, "_AGAIN * self.spin", "1.4 * self.spin", oracle.check_switch),
    Fault(SET, "-self.spin * np.square(self.area[anew])", "0.0 * self.area[anew]", oracle.check_switch),
    Fault(
        SET,
        "mass += weight * plane.T @ plane",
        "mass -= weight * plane.T @ plane",
        oracle.check_switch,
    ),
    Fault(SET, "(1.0 + surface + np.square(surface)) / 3.0", "(1.0 + surface) / 2.0", oracle.check_reading),
    Fault(SET, "1j * (lever @ angles[1])", "1j * (lever @ angles[0])", oracle.check_reading),
    Fault(
        SET,
        "velocity += self.spin * self.area",
        "velocity -= self.spin * self.area",
        oracle.check_reading,
    ),
    Fault(SET, "1.0 - surface.max(axis=1", "1.0 - surface.min(axis=1", oracle.check_reading),
    Fault(FILL, "gravity / fill.surface_radius", "gravity / fill.chamber.radius * 0.5", oracle.check_capture),
    Fault(LINEAR, "lost += self.masses[j]", "lost -= self.masses[j]", linear.check_switch),
    Fault(LINEAR, "RELEASE * self.capture", "self.capture", linear.check_capture),
    Fault(LINEAR, "1j * m.place[n + 1 :: 2]", "-1j * m.place[n + 1 :: 2]", linear.check_steady),
    Fault(
        LINEAR,
        "(m.layers.curvature - 1.0) * np.abs(offset)",
        "m.layers.curvature * np.abs(offset)",
        linear.check_depth,
    ),
)
