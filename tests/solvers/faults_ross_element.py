"""Seeded faults of the layer as elements of ROSS."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_ross as oracle

_MODULE = "solvers.ross"
_PEER = "validation.benchmarks.peer_ross"

FAULTS: tuple[Fault, ...] = (
    Fault(_MODULE, "* (1.0 + offset)", "* (1.0 - offset)", oracle.check_field),
    Fault(_MODULE, "-layer.mass * np.square(w)", "layer.mass * np.square(w)", oracle.check_field),
    Fault(_MODULE, "slip = w - omega", "slip = w + omega", oracle.check_laminar),
    Fault(_MODULE, "rate = layer.rate + stokes", "rate = 2.0 * layer.rate + stokes", oracle.check_field),
    Fault(
        _MODULE,
        "stokes_rate(layer.stokes, slip)",
        "stokes_rate(layer.stokes, -slip)",
        oracle.check_laminar,
    ),
    Fault(_MODULE, "0.5 * (forward + backward)", "0.5 * (forward - backward)", oracle.check_both_whirls),
    Fault(_MODULE, "0.5 * (forward - backward)", "(forward - backward)", oracle.check_both_whirls),
    Fault(_MODULE, "half.imag / w", "mean.imag / w", oracle.check_both_whirls),
    Fault(_MODULE, "half.real / w", "-half.real / w", oracle.check_both_whirls),
    Fault(
        _MODULE,
        "mean.real + mass * np.square(w)",
        "mean.real - mass * np.square(w)",
        oracle.check_both_whirls,
    ),
    Fault(_MODULE, ", -mean.imag)", ", mean.imag)", oracle.check_both_whirls),
    Fault(_MODULE, "else fill.full_mass", "else fill.mass", oracle.check_synchronous),
    Fault(
        _MODULE,
        "layer.mass * (1.0 + layer.layer_tanh) / (1.0",
        "layer.mass * (1.0 - layer.layer_tanh) / (1.0",
        oracle.check_link,
    ),
    Fault(_MODULE, "2.0 * layer.mass * layer.rate", "layer.mass * layer.rate", oracle.check_link),
    Fault(_MODULE, "4.0 * inertia * omega", "2.0 * inertia * omega", oracle.check_self_excited_band),
    Fault(_MODULE, "-2.0 * inertia", "2.0 * inertia", oracle.check_self_excited_band),
    Fault(
        _MODULE,
        "np.square(omega), damping * omega",
        "np.square(omega), -damping * omega",
        oracle.check_growth,
    ),
    Fault(_MODULE, "+ crossed[:, None", "- crossed[:, None", oracle.check_link),
    Fault(_MODULE, "m[:, i, j]", "m[:, j, i]", oracle.check_names),
    Fault(_MODULE, "np.square(_AXIAL", "(_AXIAL", oracle.check_names),
    Fault(_PEER, "place @ held", "-place @ held", oracle.check_peer_answer),
    Fault(
        _PEER,
        "(rotor.transverse_inertia - rotor.polar",
        "(rotor.transverse_inertia + rotor.polar",
        oracle.check_peer_answer,
    ),
    Fault(_PEER, "direct * turning - crossed**2", "direct * turning + crossed**2", oracle.check_peer_answer),
    Fault(_PEER, "held.sum(axis=0) - rotor.mass", "held.sum(axis=0) + rotor.mass", oracle.check_peer_answer),
    Fault(_PEER, "turning - arm * crossed", "turning + arm * crossed", oracle.check_peer_answer),
    Fault(_PEER, "self.diameter**2 / 16.0", "self.diameter**2 / 8.0", oracle.check_peer_inertia),
    Fault(_PEER, "places - masses @ places", "places + masses @ places", oracle.check_peer_inertia),
)
