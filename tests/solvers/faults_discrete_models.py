"""Seeded faults of the liquid models on a grid."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers.synchronous import test_discrete as oracle

_MODULE = "solvers.synchronous.discrete"

FAULTS: tuple[Fault, ...] = (
    Fault(
        _MODULE,
        "(np.arange(cells) + 0.5) / cells",
        "(np.arange(cells) + 0.25) / cells",
        oracle.check_scheme_at_rest,
    ),
    Fault(_MODULE, "- np.square(e * sine)", "+ np.square(e * sine)", oracle.check_scheme_at_rest),
    Fault(
        _MODULE,
        "below = level - e * (away - away[0])",
        "below = level - 2.0 * e * (away - away[0])",
        oracle.check_wet_wall,
    ),
    Fault(
        _MODULE, "seen = 1.0 + e * cosine + chord", "seen = 1.0 - e * cosine + chord", oracle.check_wet_wall
    ),
    Fault(
        _MODULE,
        "lever = depth * (3.0 - depth * (3.0 - depth)) / 3.0",
        "lever = depth * (2.0 - depth) / 2.0",
        oracle.check_wet_wall,
    ),
    Fault(_MODULE, "moment = fills.volume * deflection + size", "moment = size", oracle.check_wet_wall),
    Fault(
        _MODULE,
        "np.mean(depth * (2.0 - depth), axis=1) - film",
        "np.mean(2.0 * depth, axis=1) - film",
        oracle.check_wet_wall,
    ),
    Fault(
        _MODULE,
        "share = np.divide(surface, chord,",
        "share = np.divide(chord, surface + 1.0,",
        oracle.check_slope,
    ),
    Fault(_MODULE, "np.square(arm - middle[:, None])", "np.square(arm)", oracle.check_slope),
    Fault(_MODULE, "fills.volume + size * spread, dry", "size * spread, dry", oracle.check_slope),
    Fault(
        _MODULE,
        "0.5 * math.pi * np.square(chamber.radius)",
        "math.pi * np.square(chamber.radius)",
        oracle.check_range,
    ),
    Fault(_MODULE, "drop = level + e * away[0]", "drop = level - e", oracle.check_range),
    Fault(
        _MODULE,
        "slope = float(here.volume) + 2.0 * spread",
        "slope = float(here.volume) + spread",
        oracle.check_elements_slope,
    ),
    Fault(_MODULE, "square - arm * arm / plan", "square", oracle.check_elements_slope),
    Fault(_MODULE, "level - (far - near)", "level + (far - near)", oracle.check_elements_converge),
    Fault(_MODULE, "axis, plane = (-e, 0.0)", "axis, plane = (e, 0.0)", oracle.check_elements_converge),
    Fault(
        _MODULE,
        "float(steep[k]) * height / radius**2",
        "float(steep[k]) * height / radius",
        oracle.check_elements_converge,
    ),
)
