"""One family of steady waves as a liquid model: KdV-Burgers, or Whitham with the exact dispersion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fluid import kdv
from fluid.fill import Fill
from fluid.friction import NO_FRICTION, Friction, FrictionLaw, damping_rate
from meshes.errors import InputError
from solvers.liquid_model import (
    LONG,
    THIN_LAYERS,
    LiquidWave,
    Range,
    WaveModel,
    Whirl,
    kept_limits,
    numbers_of,
    whirl_answer,
)


@dataclass(frozen=True)
class OneFamily(WaveModel):
    """Steady wave of the family whose resonance is nearer [theory: kdv, eq. 18].

    Parameters
    ----------
    friction : on the wall, not quadratic
    points : of the profile, at least; more where the wave has more modes
    dispersion : the exact one in place of KdV's

    Raises
    ------
    InputError : quadratic friction
    """

    friction: Friction = NO_FRICTION
    points: int = 256
    dispersion: bool = False

    name = "kdv"
    ranges: ClassVar[Mapping[str, Range]] = {
        "relative_depth": LONG, "wave_amplitude": (0.0, 0.3), "other_family": (0.0, 0.2),
        "wall_layer": THIN_LAYERS,
    }  # fmt: skip

    def __post_init__(self) -> None:
        if self.friction.law is FrictionLaw.QUADRATIC:
            raise InputError("friction", self.friction.law, "none, stokes or linear for one family of waves")

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """See `WaveModel`; the error is the response of the other family over that of this one.

        Raises
        ------
        InputError : gravity across the axis, no free surface
        """
        from solvers.waves.steady import family_problem, solve

        chamber, surface = fill.chamber, fill.surface_radius
        if whirl.gravity != 0.0:
            raise InputError("gravity", whirl.gravity, "0 for one family of waves")
        if not chamber.inner_radius < surface < chamber.radius:
            allowed = "less than what fills the chamber, for a free surface"
            raise InputError("volume", fill.volume, allowed)
        pair = [kdv.coefficients(chamber.radius, surface, whirl.spin, sign) for sign in (1, -1)]
        family = min(pair, key=lambda c: abs(whirl.slip - c.linear_speed))
        gamma = float(kdv.decay(family, self._friction_rate(fill, whirl)))
        problem = family_problem(family, whirl.speed**2 * whirl.amplitude, self.dispersion, gamma)
        wave = solve(problem, whirl.slip)
        points = max(self.points, 2 * wave.modes.size + 2)
        eta = wave.profile(points)
        offset = complex(kdv.offset(family, eta))
        theta = 2.0 * math.pi * np.arange(points) / points
        around = np.mod(theta + math.pi, 2.0 * math.pi) - math.pi
        order = np.argsort(around)
        area = np.clip(family.mean_area + eta, 0.0, 0.5 * chamber.radius**2)
        size = kdv.validity(family, eta, whirl.slip)
        other = float(size.neglected)
        numbers = numbers_of(fill, whirl, {"wave_amplitude": float(size.amplitude), "other_family": other})
        # Below nothing and above all that the drum holds there is no layer, whatever the equation says.
        dry = float(size.thinnest) <= 0.0
        possible = not dry and float(eta.max()) < 0.5 * surface**2
        ratio = complex(kdv.force_ratio(family, offset, whirl.amplitude)) if whirl.amplitude else 0j
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=ratio,
            offset=offset,
            limits=kept_limits(numbers, self.ranges),
            dry_patch=dry,
            converged=wave.converged and possible,
            error=other,
        )
        return LiquidWave(
            answer=answer,
            theta=around[order],
            depth=(chamber.radius - np.sqrt(chamber.radius**2 - 2.0 * area))[order],
            numbers=numbers,
            ranges=self.ranges,
            mass_error=abs(float(area.mean()) / family.mean_area - 1.0),
            mean_rotation=math.nan,
            reason=wave.reason if possible else "the wave would run the wall dry or fill the drum",
        )

    def _friction_rate(self, fill: Fill, whirl: Whirl) -> float:
        """Rate at which the wall friction stops the mean layer, 1/s [theory: long_wave, eq. 9]."""
        radius = fill.chamber.radius
        law, coefficient = self.friction.at(fill.liquid.viscosity, whirl.slip, radius)
        area = fill.volume / (2.0 * math.pi * fill.chamber.height * radius**2)
        lid = 2.0 * radius / fill.chamber.height
        return float(damping_rate(law, coefficient, lid, fill.depth / radius, area, 0.0))
