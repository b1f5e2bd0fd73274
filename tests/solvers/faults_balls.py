"""Seeded faults of the ball balancers."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.rotor import test_balls as oracle

_MOTION, _RUN, _STEPS = (
    "solvers.rotor.balls.motion",
    "solvers.rotor.balls.balancers",
    "solvers.rotor.balls.steps",
)

FAULTS: tuple[Fault, ...] = (
    Fault(
        _MOTION, "* cosine - turning[1, i] * sine", "* cosine + turning[1, i] * sine", oracle.check_equations
    ),
    Fault(_MOTION, "cosine, sine = spin * spin *", "cosine, sine = spin *", oracle.check_equations),
    Fault(_MOTION, "push - drawn - held", "push - drawn + held", oracle.check_equations),
    Fault(_MOTION, "damping[i, k] * state[n + k]", "damping[k, i] * state[n + k]", oracle.check_equations),
    Fault(_MOTION, "-drag * radius * radius * (rate", "-drag * radius * (rate", oracle.check_equations),
    Fault(_MOTION, "slip - weight * gravity", "slip + weight * gravity", oracle.check_equations),
    Fault(_MOTION, "weight * radius * rate * rate\n", "weight * radius * rate\n", oracle.check_equations),
    Fault(
        _MOTION,
        "torque / (rolling * weight * radius * radius)",
        "torque / (weight * radius * radius)",
        oracle.check_equations,
    ),
    Fault(
        _MOTION,
        "x * axes[j, 0, i] + y * axes[j, 1, i], x * axes",
        "x * axes[j, 0, i] - y * axes[j, 1, i], x * axes",
        oracle.check_equations,
    ),
    Fault(
        _MOTION,
        "away * outward - torque / (rolling * radius)",
        "away * outward + torque / (rolling * radius)",
        oracle.check_equations,
    ),
    Fault(_MOTION, "(1.0 - 1.0 / rolling) * along", "1.0 / rolling * along", oracle.check_equations),
    Fault(
        _MOTION,
        "out[second + j] -= along * out[n + i]",
        "out[second + j] += along * out[n + i]",
        oracle.check_equations,
    ),
    Fault(
        _MOTION,
        "out[n + k] -= share * out[n + i]",
        "out[n + k] += share * out[n + i]",
        oracle.check_equations,
    ),
    Fault(_MOTION, "out[work] += (push - drawn)", "out[work] += (push + drawn)", oracle.check_energy),
    Fault(_MOTION, "out[work] += slip * rate", "out[work] += slip", oracle.check_energy),
    Fault(_MOTION, "out[work + 1] += abs(slip * rate)", "out[work + 1] += abs(slip)", oracle.check_turnover),
    Fault(_MOTION, "abs(push * state[n + i])", "abs(push * state[i])", oracle.check_turnover),
    Fault(_MOTION, "(rolling - 1.0) * np.square", "rolling * np.square", oracle.check_energy),
    Fault(_MOTION, "carried[:, 0] - radius * rate", "carried[:, 0] + radius * rate", oracle.check_energy),
    Fault(_MOTION, "lifted = gravity * np.sum", "lifted = -gravity * np.sum", oracle.check_energy),
    Fault(_MOTION, "0.5 * q @ stiffness @ q", "q @ stiffness @ q", oracle.check_energy),
    Fault(_STEPS, "2.0 * middle", "1.0 * middle", oracle.check_steps),
    Fault(_STEPS, "(sample - 1) * steps + i)", "(sample - 1) + i)", oracle.check_steps),
    Fault(_RUN, "cosine = (needed - odd) / pairs", "cosine = (needed + odd) / pairs", oracle.check_places),
    Fault(_RUN, "cmath.phase(unbalance) + math.pi", "cmath.phase(unbalance)", oracle.check_places),
    Fault(_RUN, "complex(unbalance + moment *", "complex(unbalance - moment *", oracle.check_places),
    Fault(_RUN, "couple - first * static", "couple + first * static", oracle.check_two_plane_places),
    Fault(
        _RUN,
        "damping = system.damping + speed * system.gyroscopic",
        "damping = system.damping",
        oracle.check_two_planes,
    ),
    Fault(_RUN, "1j * self.speed * self.time", "2j * self.speed * self.time", oracle.check_subcritical),
    Fault(
        _RUN,
        "self.ball_angle - self.speed * self.time",
        "self.ball_angle + self.speed * self.time",
        oracle.check_supercritical,
    ),
)
