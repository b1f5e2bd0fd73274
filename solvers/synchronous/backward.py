"""How the liquid answers the part of an orbit that turns against the spin.

It does so by linear theory, whatever model the forward part has; where baffles stand in the liquid or the
section is no circle, that takes finite elements. This is all that the synchronous answer takes from sloshing.
"""

from __future__ import annotations

from fluid.fill import Fill
from fluid.friction import NO_FRICTION
from fluid.waves import force_ratio
from solvers.sloshing.reduced import section_layer


def backward_mass(fill: Fill) -> float:
    """Mass with which a layer resists a backward whirl at the speed of its spin, kg.

    m_f G(kappa, -1), G = 1 - 8/(1 + 7 kappa) [theory: rotor, eq. 28]; that of the liquid where it fills its
    chamber; with baffles in the liquid the part of the answer that turns with the whirl.
    """
    full = fill.volume >= fill.chamber.capacity * (1.0 - 1e-9)
    if full or fill.surface_radius == 0.0:
        return fill.mass
    if fill.uneven:
        layer = section_layer(fill, NO_FRICTION)
        assert layer is not None
        whole = layer.density * layer.liquid.enclosed_area
        return whole * float(layer.liquid.force_ratio([-2.0])[0])
    curvature = (fill.chamber.radius / fill.surface_radius) ** 2
    return fill.full_mass * float(force_ratio(curvature, -1.0)) if curvature > 1.0 else 0.0
