"""A filled bowl that is tilted numerically: its energy by quadrature, without any second variation."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import optimize

from meshes.chamber import Chamber

GRAVITY = 9.81
RHO = 998.0


@dataclass(frozen=True)
class Bowl:
    """A chamber whose floor lies `floor` above the fixed point, spun at `speed` and filled to `fill`."""

    chamber: Chamber
    floor: float
    speed: float
    fill: float

    @property
    def volume(self) -> float:
        return self.fill * self.chamber.capacity

    def layers(self, tilt: float, level: float) -> tuple[float, float]:
        """Volume of the liquid {Phi < level} and the integral of level - Phi over it, chamber tilted.

        Phi = g z' - Omega^2 r'^2/2 in the axes fixed in space, written in those of the chamber: quadratic
        along each vertical line of the chamber and each ray of its floor, so that the surface and its
        waterlines are roots of quadratics and each piece is smooth.
        """
        s, c, w2 = np.sin(tilt), np.cos(tilt), self.speed**2
        phi = 2.0 * np.pi * (np.arange(64) + 0.5) / 64
        k = 1.0 - (np.cos(phi) * s) ** 2
        lines = []
        for z in (self.floor, self.floor + self.chamber.height):
            b = np.cos(phi) * s * (GRAVITY + w2 * z * c)
            d = GRAVITY * z * c - 0.5 * w2 * (z * s) ** 2 - level
            root = np.sqrt(np.maximum(b * b + 2.0 * w2 * k * d, 0.0))
            radius = np.where(d > 0.0, (b + root) / (w2 * k), 0.0)
            lines.append(np.clip(radius, self.chamber.inner_radius, self.chamber.radius))
        lines.append(np.full(phi.shape, self.chamber.radius))

        node, weight = np.polynomial.legendre.leggauss(20)
        volume = energy = 0.0
        for low, high in pairwise(lines):
            half = 0.5 * (high - low)
            r = (low + half)[:, None] + half[:, None] * node
            plan = half[:, None] * weight * r * (2.0 * np.pi / 64)
            x = r * np.cos(phi)[:, None]
            slope = c * (GRAVITY + w2 * x * s)
            rest = level - GRAVITY * x * s + 0.5 * w2 * (r * r - (x * s) ** 2)
            surface = 2.0 * rest / (slope + np.sqrt(slope**2 - 2.0 * w2 * s * s * rest))
            top = np.clip(surface, self.floor, self.floor + self.chamber.height)
            volume += float(np.sum(plan * (top - self.floor)))

            def below(z: np.ndarray) -> np.ndarray:
                return rest * z - slope * z * z / 2.0 + w2 * s * s * z**3 / 6.0  # noqa: B023

            energy += float(np.sum(plan * (below(top) - below(np.full(top.shape, self.floor)))))
        return volume, energy

    def level(self, tilt: float) -> float:
        """Level of Phi that holds the volume."""
        span = self.speed**2 * self.chamber.radius**2 + GRAVITY * (self.chamber.height + abs(self.floor))
        return float(
            optimize.brentq(lambda c: self.layers(tilt, c)[0] - self.volume, -2 * span, 2 * span, xtol=1e-14)
        )

    def energy(self, tilt: float) -> float:
        """Least energy of the liquid at fixed volume: an error in the level counts only in second order."""
        level = self.level(tilt)
        return RHO * (level * self.volume - self.layers(tilt, level)[1])

    def frozen(self) -> tuple[float, float]:
        """C0 - A0 and the static moment M x_c3 of the upright liquid, ring by ring."""
        beta, constant = self.speed**2 / (2.0 * GRAVITY), self.level(0.0) / GRAVITY
        node, weight = np.polynomial.legendre.leggauss(8)
        cuts = (np.array([self.floor, self.floor + self.chamber.height]) - constant) / beta
        low, high = self.chamber.inner_radius**2, self.chamber.radius**2
        marks = [low, *np.clip(cuts, low, high), high]
        difference = moment = 0.0
        for start, stop in pairwise(marks):
            t = 0.5 * (start + stop) + 0.5 * (stop - start) * node
            ring = np.pi * 0.5 * (stop - start) * weight
            top = np.clip(beta * t + constant, self.floor, self.floor + self.chamber.height)
            depth, second = top - self.floor, (top**3 - self.floor**3) / 3.0
            difference += float(np.sum(ring * (0.5 * t * depth - second)))
            moment += float(np.sum(ring * 0.5 * (top**2 - self.floor**2)))
        return RHO * difference, RHO * moment


BOWLS = {
    "surface on the wall only": Bowl(Chamber(0.2, 0.2), 0.15, 5.0, 0.5),
    "surface from floor to lid": Bowl(Chamber(0.2, 0.05), 0.1, 14.0, 0.5),
    "floor dry, wall wetted": Bowl(Chamber(0.2, 0.2), -0.1, 14.0, 0.2),
    "below the fixed point": Bowl(Chamber(0.2, 0.1), -0.4, 9.0, 0.6),
    "annulus": Bowl(Chamber(0.2, 0.08, inner_radius=0.08), 0.1, 11.0, 0.5),
}
