"""Independent answers about sloshing: series for closed sectors, damping of the ring by hand."""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import eigh

Array = np.ndarray


def sector_matrices(
    angle: float, layer_log: float, terms: int, first: float = 0.0
) -> tuple[Array, Array, Array, Array]:
    """Sector between two full baffles by sines of the angle, without finite elements, for a = 1.

    eta = sum q_m sin(nu_m theta) sinh(nu_m ln(R/r))/sinh(nu_m L), nu_m = m pi/angle. Returns the diagonals of
    K and B, C, which couples sines of different parity, and P, rows for x and y, the sector starting at
    `first`.
    """
    m = np.arange(1.0, terms + 1.0)
    nu = m * np.pi / angle
    k, b = 0.5 * angle * nu / np.tanh(nu * layer_log), 0.5 * angle * nu**2
    p, q = np.meshgrid(m, m, indexing="ij")
    odd = (p + q) % 2.0 == 1.0
    # oint q' cos(q') sin(p') dtheta: nu_q times 2 p/(p^2 - q^2) angle/pi.
    c = np.where(odd, 2.0 * p * q / np.where(odd, p * p - q * q, 1.0), 0.0)
    # oint e^{i theta} nu cos(nu theta) dtheta with e^{i nu angle} = (-1)^m; half the angle for nu = 1.
    whole = np.exp(1j * angle) * (-1.0) ** m - 1.0
    gap = 1.0 - np.square(nu)
    alike = np.abs(gap) < 1e-12
    moment = np.where(alike, 0.5 * angle, whole / (1j * np.where(alike, 1.0, gap)))
    moment = nu * np.exp(1j * first) * moment
    return k, b, c, np.array([moment.real, moment.imag])


def sector_frequencies(angle: float, layer_log: float, terms: int, count: int) -> Array:
    """Slowest frequencies of a closed sector over the spin."""
    k, b, c, _ = sector_matrices(angle, layer_log, terms)
    matrix = np.zeros((2 * terms, 2 * terms), dtype=complex)
    matrix[:terms, terms:] = matrix[terms:, :terms] = np.diag(np.sqrt(b / k))
    matrix[terms:, terms:] = -2j * c / np.sqrt(np.outer(k, k))
    return np.asarray(
        eigh(matrix, subset_by_index=(terms, terms + count - 1), eigvals_only=True), dtype=float
    )


def sectors_force(count: int, radius_ratio: float, slip: float, terms: int) -> Array:
    """Force tensor of equal closed sectors over rho pi R^2 h f at unit spin; radius_ratio = R/a."""
    angle, log = 2.0 * np.pi / count, math.log(radius_ratio)
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    pull = np.zeros((2, 2), dtype=complex)
    for one in range(count):
        k, b, c, moment = sector_matrices(angle, log, terms, one * angle)
        matrix = np.diag(b - slip**2 * k) + 2j * slip * c
        pull += moment @ np.linalg.solve(matrix, moment.T.astype(complex))
    change = 1j * slip * np.eye(2) + turn
    area = np.pi * (radius_ratio**2 - 1.0)
    return np.asarray((area * np.eye(2) - change @ change @ pull) / (np.pi * radius_ratio**2))


def ring_decay(
    n: int,
    sigma: float,
    spin: float,
    radius: float,
    surface: float,
    height: float,
    viscosity: float,
    coriolis: bool,
) -> float:
    """Decay of the ring's mode by hand, from psi = (r/R)^n - (R/r)^n times e^{i (n theta - sigma t)}.

    The circle with e^{-i sigma t} has the amplitude n (R/r)^n/r, the other n (r/R)^n/r, the wall 2 n/R.
    """
    x = (surface / radius) ** n
    one = math.pi * n * (1.0 / x**2 - 1.0)
    other = math.pi * n * (1.0 - x**2)
    g = math.sqrt(0.5 * viscosity * abs(sigma))
    g_one, g_other = (math.sqrt(0.5 * viscosity * abs(2.0 * spin + turn * sigma)) for turn in (-1.0, 1.0))
    if not coriolis:
        g_one = g_other = g
    # Per density: wall 1/2 g U^2 over 2 pi R h; two plates g_1 alpha^2 + g_2 beta^2 each.
    lost = 0.5 * g * (2.0 * n / radius) ** 2 * 2.0 * math.pi * radius * height
    lost += 2.0 * (g_one * one + g_other * other)
    # Mean kinetic energy 1/4 int |u|^2, |u|^2 = 2 (alpha^2 + beta^2), and that of xi = psi_theta/(a (-i
    # sigma)).
    kinetic = 0.5 * (one + other) * height
    displacement = n * abs(x - 1.0 / x) / (surface * abs(sigma))
    centrifugal = 0.25 * spin**2 * surface**2 * displacement**2 * 2.0 * math.pi * height
    return lost / (2.0 * (kinetic + centrifugal))
