"""The waves of py-pde as liquid models: nonlinear long waves, and one family, KdV-Burgers or Whitham.

py-pde itself is loaded where a wave is asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from scipy.optimize import brentq

from fluid import kdv
from fluid.fill import Fill, Fills
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw, damping_rate
from fluid.friction.wall import lag_drag
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.layer.state import Numerics
from solvers.liquid_history import LayerHistory
from solvers.liquid_model import (
    CAPTURED,
    LONG,
    ROUNDING,
    SMOOTH,
    THIN_LAYERS,
    LiquidAnswer,
    LiquidWave,
    Range,
    WaveModel,
    Whirl,
    Whirls,
    kept_limits,
    numbers_of,
    smooth_whirl,
    wave_amplitude,
    whirl_answer,
)
from solvers.wave_error import family_error, long_wave_error
from solvers.waves.modes import WaveTerms

if TYPE_CHECKING:
    from solvers.pypde.family_law import Standing

_MOST_POINTS = 65536
_LAGS, _MOST_LAG = 0.01, 0.8  # of the spin: steps in which a lag is looked for, and the most of it

Progress = Callable[[float], object] | None


# A jump is as steep as the cells let it be, and its error goes with their size: what half as many change is
# the error that is left. It may be as large as that of long waves with a jump beside computed two-phase flow.
_GRIDS: Range = (0.0, 0.05)


def _bounds(ranges: Mapping[str, Range], friction: Friction) -> Mapping[str, Range]:
    """Ranges of a model; friction rounds a fold off: where smooth waves end is known without it alone."""
    if friction.law is FrictionLaw.NONE:
        return ranges
    return {name: bounds for name, bounds in ranges.items() if name != "smooth_whirl"}


@dataclass(frozen=True)
class LongWave(WaveModel):
    """Nonlinear long waves, held under the whirl until they settle [theory: long_wave, eq. 4].

    Parameters
    ----------
    friction : on the wall
    numerics : resolution
    solver : its name in py-pde
    progress : called with the share of the longest time that is done
    """

    friction: Friction = NO_FRICTION
    numerics: Numerics = field(default_factory=Numerics)
    solver: str = "finite_volume"
    progress: Progress = field(default=None, compare=False, repr=False)

    name = "long_wave"
    takes_baffles = True
    ranges: ClassVar[Mapping[str, Range]] = {
        "relative_depth": LONG, "centrifuge": CAPTURED, "wall_layer": THIN_LAYERS, "force_gap": (0.0, 0.1),
        "smooth_whirl": SMOOTH, "grid_gap": _GRIDS,
    }  # fmt: skip

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """See `WaveModel`; the error is that of smooth waves beside exact ones [theory: model_error, eq. 35].

        Under gravity across the axis and with baffles it is the gap between the forces by momentum and by
        pressure. A whirl larger than smooth waves follow is answered on half as many cells as well: its error
        is the difference.
        """
        from solvers.pypde.settle import settle

        history = settle(fill, whirl, self.friction, self.numerics, self.solver, self.progress)
        gap = math.nan
        if smooth_whirl(fill, whirl).get("smooth_whirl", 0.0) > SMOOTH[1] and history.converged:
            cells = self.numerics.cells
            half = replace(self.numerics, cells=cells // 2 if cells >= 16 else 2 * cells)
            other = settle(fill, whirl, self.friction, half, self.solver)
            here = complex(history.force_ratio[-1])
            there = complex(other.force_ratio[-1]) if other.force_ratio.size else complex(math.inf)
            gap = abs(here - there) / max(1.0, abs(here))
        return self.wave_at_end(fill, whirl, history, steady=True, grid_gap=gap)

    def wave_at_end(
        self,
        fill: Fill,
        whirl: Whirl,
        history: LayerHistory,
        steady: bool = False,
        grid_gap: float = math.nan,
    ) -> LiquidWave:
        """The wave as a history leaves it, with the last means as its answer.

        `steady`: it was followed until it no longer changed, so that it counts where smooth waves end;
        `grid_gap` is the difference of the force on half as many cells, over the larger of it and 1.
        """
        chamber, answered = fill.chamber, history.force_ratio.size > 0
        none = complex(math.nan, math.nan)
        force, offset = (history.force_ratio[-1], history.offset[-1]) if answered else (none, none)
        gap, found = math.nan, {}
        if answered:
            gap = float(abs(force - history.pressure_ratio[-1])) / max(1.0, float(abs(force)))
            extremes = np.concatenate([history.depth_max, history.depth_min])
            found = {"force_gap": gap, "wave_amplitude": wave_amplitude(extremes, fill.depth)}
        found |= smooth_whirl(fill, whirl) if steady else {}
        folded = not math.isnan(grid_gap)
        numbers = numbers_of(fill, whirl, found | ({"grid_gap": grid_gap} if folded else {}))
        ranges = _bounds(self.ranges, self.friction)
        deepest = float(history.depth.max(initial=0.0))
        limits = {"inner_wall": deepest <= chamber.radius - chamber.inner_radius}
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=complex(force),
            offset=complex(offset),
            limits=kept_limits(numbers, ranges) | limits,
            dry_patch=float(history.depth.min(initial=math.inf)) <= 0.0,
            converged=history.converged,
            error=grid_gap
            if folded
            else gap
            if whirl.gravity or chamber.baffles
            else self._error(fill, whirl),
        )
        return LiquidWave(
            answer=answer,
            theta=history.theta,
            depth=history.depth,
            numbers=numbers,
            ranges=ranges,
            mass_error=history.mass_error,
            mean_rotation=float(history.mean_rotation[-1]) if answered else math.nan,
            reason=history.reason,
        )

    def _error(self, fill: Fill, whirl: Whirl) -> float:
        """Error of a smooth wave without friction; nan where there is none."""
        layer, size = fill.depth / fill.chamber.radius, whirl.amplitude / fill.depth
        numerics = self.numerics
        return float(long_wave_error(layer, whirl.detuning, size, numerics.dispersion, numerics.cells))


@dataclass(frozen=True)
class OneFamily(WaveModel):
    """Steady wave of the family whose resonance is nearer [theory: kdv, eq. 18].

    Parameters
    ----------
    friction : on the wall, not quadratic
    points : of the profile, at least; more where the wave has more modes
    dispersion : the exact one in place of KdV's
    solver : its name in py-pde; "steady_newton" needs no time steps
    progress : called with the share of the longest time that is done, where there are time steps

    Raises
    ------
    InputError : quadratic friction, another number of points
    """

    friction: Friction = NO_FRICTION
    points: int = 256
    dispersion: bool = False
    solver: str = "steady_newton"
    progress: Progress = field(default=None, compare=False, repr=False)

    name = "kdv"
    ranges: ClassVar[Mapping[str, Range]] = {
        "relative_depth": LONG, "wave_amplitude": (0.0, 0.3), "other_family": (0.0, 0.2),
        "wall_layer": THIN_LAYERS, "smooth_whirl": SMOOTH,
    }  # fmt: skip

    def __post_init__(self) -> None:
        kdv.refuse_quadratic(self.friction, "friction")
        if not 8 <= self.points <= _MOST_POINTS:
            raise InputError("cells", self.points, f"from 8 to {_MOST_POINTS}")

    def at_rest(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `WaveModel`; the error is the distance from the exact pull on a wet wall [theory: kdv, eq. 33].

        A deflection without a wave is answered as if the last wave grew with it, and has not converged. In a
        chamber without a free surface there is no wave to look for: its liquid goes with the drum.
        """
        size, chamber, found = whirls.amplitude, fills.chamber, self._standing(fills, whirls.amplitude)
        numbers = {
            "relative_depth": fills.depth / chamber.radius, "wave_amplitude": found.change,
            "other_family": found.other,
        }  # fmt: skip
        limits = {name: ~found.waves | (value <= self.ranges[name][1]) for name, value in numbers.items()}
        own, raised = fills.mass, fills.added_mass - fills.mass
        exact = (own + raised) * size
        unbalance = (own + raised * found.share) * size
        missing = np.divide(exact - unbalance, exact, out=np.zeros_like(size), where=exact > 0.0)
        return LiquidAnswer.at_rest(
            fills,
            whirls,
            unbalance=unbalance,
            slope=own + raised * found.slope,
            dry_patch=~found.found,
            converged=found.found,
            limits={**limits, "inner_wall": found.deepest <= chamber.radius - chamber.inner_radius},
            error=np.abs(missing) + ROUNDING,
        )

    def added_mass(self, fills: Fills) -> Array:
        """See `LiquidModel`: one family brings up a part of what the fully nonlinear wave does."""
        found = self._standing(fills, np.zeros(len(fills)))
        return np.asarray(fills.mass + (fills.added_mass - fills.mass) * found.slope)

    def steepest(self, fills: Fills) -> Array:
        """See `LiquidModel`: the wave of one family grows faster than the deflection."""
        found = self._standing(fills, np.zeros(len(fills)))
        return np.asarray(fills.mass + (fills.added_mass - fills.mass) * found.steepest)

    def _standing(self, fills: Fills, deflection: Array) -> Standing:
        from solvers.pypde.family_law import standing

        return standing(fills, deflection, self.dispersion)

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """See `WaveModel`; the error is that beside fully nonlinear waves [theory: model_error, eq. 36]."""
        chamber, surface = fill.chamber, fill.surface_radius
        if whirl.gravity != 0.0:
            raise InputError("gravity", whirl.gravity, "0 for unidirectional waves")
        if not chamber.inner_radius < surface < chamber.radius:
            allowed = "less than what fills the chamber, for a free surface"
            raise InputError("volume", fill.volume, allowed)
        lag, held = self._lag(fill, whirl)
        acting = self._terms(fill, whirl, lag)
        family = acting.c
        eta, reason = self._steady(acting, whirl)
        reason = reason or held
        points = eta.size
        offset = complex(kdv.offset(family, eta))
        theta = 2.0 * math.pi * np.arange(points) / points
        around = np.mod(theta + math.pi, 2.0 * math.pi) - math.pi
        order = np.argsort(around)
        area = np.clip(family.mean_area + eta, 0.0, 0.5 * chamber.radius**2)
        size = kdv.validity(family, eta, acting.whirl_speed)
        other = float(size.neglected)
        found = {"wave_amplitude": float(size.amplitude), "other_family": other}
        numbers = numbers_of(fill, whirl, found | smooth_whirl(fill, whirl))
        ranges = _bounds(self.ranges, self.friction)
        # Below nothing and above all that the drum holds there is no layer, whatever the equation says.
        dry = float(size.thinnest) <= 0.0
        highest = float(eta.max())
        possible = not dry and highest < 0.5 * surface**2
        ratio = complex(kdv.force_ratio(family, offset, whirl.amplitude)) if whirl.amplitude else 0j
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=ratio,
            offset=offset,
            limits=kept_limits(numbers, ranges)
            | {"inner_wall": surface**2 - 2.0 * highest >= chamber.inner_radius**2},
            dry_patch=dry,
            converged=not reason and possible,
            error=family_error(
                fill.depth / chamber.radius,
                whirl.speed / whirl.spin,
                whirl.amplitude / fill.depth,
                self.dispersion,
            ),
        )
        return LiquidWave(
            answer=answer,
            theta=around[order],
            depth=np.where(reason, math.nan, chamber.radius - np.sqrt(chamber.radius**2 - 2.0 * area))[order],
            numbers=numbers,
            ranges=ranges,
            mass_error=abs(float(area.mean()) / family.mean_area - 1.0),
            mean_rotation=-lag if self._friction_rate(fill, whirl) else math.nan,
            reason=reason if possible else "the wave would run the wall dry or fill the drum",
        )

    def _terms(self, fill: Fill, whirl: Whirl, lag: float) -> WaveTerms:
        """The wave's equation in liquid that lags behind the drum, rad/s [theory: kdv, eq. 34, 39]."""
        radius, surface, rate = fill.chamber.radius, fill.surface_radius, self._friction_rate(fill, whirl)
        spins = whirl.spin, whirl.spin - lag
        pair = [[kdv.coefficients(radius, surface, spin, sign) for spin in spins] for sign in (1, -1)]
        # The same family with a lag as without one.
        _, family = min(pair, key=lambda each: abs(whirl.slip - each[0].linear_speed))
        forcing = float(kdv.forcing(family, whirl.speed**2 * whirl.amplitude))
        diffusion = float(kdv.diffusion(family, forcing)) if rate else 0.0
        gamma = float(kdv.decay(family, rate))
        return WaveTerms(family, self.dispersion, diffusion, gamma, forcing, whirl.slip + lag)

    def _lag(self, fill: Fill, whirl: Whirl) -> tuple[float, str]:
        """Lag at which the wall's drag holds the whirl's torque, rad/s, and why there is none, or empty.

        The first one that liquid comes to which begins at rest in the drum [theory: kdv, eq. 36]. Without
        friction none is told: nothing would hold it.
        """
        if not (self._friction_rate(fill, whirl) and whirl.amplitude):
            return 0.0, ""
        from solvers.pypde.settle_family import steady_wave

        inertia = fill.mass * fill.chamber.radius**2

        def left(lag: float) -> float:
            """Torque of the wall less that of the whirl, N m."""
            terms = self._terms(fill, whirl, lag)
            wave = steady_wave(terms, self.points)
            offset = kdv.offset(terms.c, wave.profile(max(self.points, 2 * wave.modes.size + 2)))
            ratio = complex(kdv.force_ratio(terms.c, offset, whirl.amplitude))
            fed = fill.full_mass * (whirl.speed * whirl.amplitude) ** 2 * ratio.imag
            drag = lag_drag(fill, self.friction, abs(lag), whirl.spin, abs(whirl.slip))
            return inertia * math.copysign(drag, lag) - fed

        way = -math.copysign(1.0, left(0.0))
        step, least = _LAGS * whirl.spin, 0.0
        while way * left(way * (least + step)) < 0.0:
            least += step
            if least + step > _MOST_LAG * whirl.spin:
                return way * least, "the wall's drag does not hold the liquid against the whirl's torque"
        ends = way * least, way * (least + step)
        return float(brentq(left, *ends, xtol=1e-9 * whirl.spin, rtol=1e-12)), ""

    def _steady(self, terms: WaveTerms, whirl: Whirl) -> tuple[Array, str]:
        """Heights at equal steps of the angle from the deflection, m^2, and why they are none, or empty."""
        from solvers.pypde.settle_family import steady_state, steady_wave

        if self.solver == "steady_newton":
            wave = steady_wave(terms, self.points)
            return wave.profile(max(self.points, 2 * wave.modes.size + 2)), wave.reason
        return steady_state(terms, whirl, self.points, self.solver, self.progress)

    def _friction_rate(self, fill: Fill, whirl: Whirl) -> float:
        """Rate at which the wall friction stops the mean layer, 1/s [theory: long_wave, eq. 9]."""
        if whirl.slip == 0.0:
            # The wave stands still in the drum. One family alone would have its liquid flow through it, which
            # the other family stops.
            return 0.0
        radius = fill.chamber.radius
        law, coefficient = self.friction.at(fill.liquid.viscosity, whirl.slip, radius)
        area = fill.volume / (2.0 * math.pi * fill.chamber.height * radius**2)
        lid = self.friction.lid(radius, fill.chamber.height, whirl.slip, whirl.spin)
        return float(damping_rate(law, coefficient, lid, fill.depth / radius, area, 0.0))
