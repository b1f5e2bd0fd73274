"""Seeded faults of the exciter: its numbers, equations, stuck speeds and steps."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.rotor import test_exciter as oracle
from tests.solvers.rotor import test_exciter_motion as motion
from tests.solvers.rotor import test_exciter_stuck as roots

_EXCITER, _STUCK, _MOTION = (
    "solvers.rotor.exciter.machine",
    "solvers.rotor.exciter.stuck",
    "solvers.rotor.exciter.motion",
)
_STEPS, _PRINTED = "solvers.rotor.exciter.steps", "solvers.rotor.exciter.motion"

FAULTS: tuple[Fault, ...] = (
    Fault(_EXCITER, "return 1.0 + own_inertia / (mass", "return own_inertia / (mass", oracle.check_rolling),
    Fault(_EXCITER, "(mass * radius**2)", "(mass * radius)", oracle.check_rolling),
    Fault(
        _EXCITER,
        "return self.platform_mass + self.ball_count * self.ball_mass",
        "return self.platform_mass + self.ball_mass",
        oracle.check_units,
    ),
    Fault(
        _EXCITER,
        "smallness=balls / (self.rolling * mass)",
        "smallness=balls / mass",
        oracle.check_printed_numbers,
    ),
    Fault(
        _EXCITER,
        "drag=self.ball_damping * mass / (balls * self.ball_mass * frequency)",
        "drag=self.ball_damping * mass / (balls * balls * frequency)",
        oracle.check_units,
    ),
    Fault(
        _EXCITER,
        "unbalance=self.unbalance / (balls * self.track_radius)",
        "unbalance=self.unbalance / balls",
        oracle.check_printed_numbers,
    ),
    Fault(
        _EXCITER,
        "damping=self.damping / (2.0 * mass * frequency)",
        "damping=self.damping / (mass * frequency)",
        oracle.check_printed_numbers,
    ),
    Fault(
        _EXCITER,
        "gravity=gravity / (self.length * frequency**2)",
        "gravity=gravity / (self.length * frequency)",
        oracle.check_units,
    ),
    Fault(_EXCITER, "np.array([-1j * self.unbalance]", "np.array([1j * self.unbalance]", oracle.check_units),
    Fault(_EXCITER, "load = delta * n * n *", "load = delta * n *", oracle.check_equations),
    Fault(_EXCITER, "- 2.0 * h * velocity", "- h * velocity", oracle.check_equations),
    Fault(_EXCITER, "velocity - state[0]", "velocity + state[0]", oracle.check_equations),
    Fault(_EXCITER, "own = -eps * b * (rate - n)", "own = -eps * b * (rate + n)", oracle.check_equations),
    Fault(_EXCITER, "np.cos(angle - alpha)", "np.cos(angle + alpha)", oracle.check_equations),
    Fault(_EXCITER, "(rate * rate * np.sin(angle) -", "(rate * np.sin(angle) -", oracle.check_equations),
    Fault(_EXCITER, "- own * cosine)", "+ own * cosine)", oracle.check_equations),
    Fault(_EXCITER, "load / (1.0 - eps * carried", "load / (1.0 + eps * carried", oracle.check_equations),
    Fault(
        _EXCITER, "-= eps * acceleration * np.cos", "+= eps * acceleration * np.cos", oracle.check_equations
    ),
    Fault(
        _EXCITER, "complex(1.0 - frequency**2,", "complex(frequency**2 - 1.0,", oracle.check_platform_motion
    ),
    Fault(
        _EXCITER, "return frequency**2 / complex", "return frequency / complex", oracle.check_platform_motion
    ),
    Fault(
        _STUCK,
        "return together**2 * machine.damping",
        "return together * machine.drag",
        roots.check_printed_roots,
    ),
    Fault(_STUCK, "chi * q**5 /", "chi * q**4 /", roots.check_balance),
    Fault(_STUCK, "np.square(2.0 * h * q)", "np.square(h * q)", roots.check_printed_characteristic),
    Fault(_STUCK, "4.0 * h * h - 2.0", "2.0 * h * h - 2.0", roots.check_printed_characteristic),
    Fault(_STUCK, "polysub(5.0 * bell", "polysub(4.0 * bell", roots.check_printed_characteristic),
    Fault(_STUCK, "+ 1.5 * root +", "+ 1.25 * root +", roots.check_expansion),
    Fault(_STUCK, "+ 2.0 * root**2", "+ 1.0 * root**2", roots.check_expansion),
    Fault(_STUCK, "53.0 / 24.0", "23.0 / 8.0", roots.check_expansion),
    Fault(_STUCK, "9.0 / 16.0 * chi", "9.0 / 8.0 * chi", roots.check_expansion),
    Fault(_STUCK, "1.5 * (1.0 + 27.0", "0.5 * (1.0 + 27.0", roots.check_expansion),
    Fault(_STUCK, "resonance = 0.25 * chi", "resonance = 0.5 * chi", roots.check_expansion),
    Fault(_PRINTED, "(4.0 * (b + eps * second)", "(2.0 * (b + eps * second)", roots.check_regression),
    Fault(_PRINTED, "(h + eps * third)", "(h - eps * third)", roots.check_regression_by_hand),
    Fault(_PRINTED, "(1.0 + eps * first)", "(1.0 - eps * first)", roots.check_regression_by_hand),
    Fault(_STEPS, "step * weights[stage] * slopes", "step * weights[0] * slopes", motion.check_step),
    Fault(_STEPS, "(1.0 if stage == 3 else 0.5)", "(0.5 if stage == 3 else 0.5)", motion.check_step),
    Fault(_STEPS, "time = (block * steps + i) * step", "time = i * step + step", motion.check_steps),
    Fault(_STEPS, "before[j]) / (steps * step)", "before[j]) / steps", motion.check_steps),
    Fault(_MOTION, "np.hypot(sums[2], sums[3])", "np.hypot(sums[0], sums[3])", motion.check_projection),
    Fault(_MOTION, "np.hypot(sums[0], sums[1])", "np.hypot(sums[0], sums[0])", motion.check_projection),
    Fault(_MOTION, "state[1] = (1j * (stuck", "state[1] = -(1j * (stuck", motion.check_starts),
    Fault(_MOTION, "state[0] = (slow + fast).imag", "state[0] = (slow + fast).real", motion.check_starts),
    Fault(
        _MOTION,
        "np.linspace(0.0, start.separation",
        "np.linspace(0.0, 2.0 * start.separation",
        motion.check_starts,
    ),
    Fault(_MOTION, "            low = middle\n", "            high = middle\n", motion.check_critical_speed),
)
