"""Published experiments: each statement beside what the package computes, and what was derived for it."""

from __future__ import annotations

import math
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

from fluid.friction.laws import NO_FRICTION
from fluid.waves import free_wave_frequencies
from fluid.whirl import plane_layer, slower_slip
from meshes.arrays import Array
from solvers.rotor.vibration import modes
from solvers.sloshing.modes import spectrum, surface_displacement
from solvers.sloshing.system import condense, wall_points
from solvers.synchronous.response import response
from tests.mutants import kills
from tests.oracles.cases import come_out_again, kept_group, verdicts
from validation.case import Case
from validation.cases.published import absorber, balancer, damping, partitions, ring, tilt
from validation.cases.published.table import table

CASES = "validation.cases.published"
PAGE = Path(__file__).parents[2] / "docs" / "evidence.md"


def sector_waves(sectors: int, share: float, terms: int = 60, turning: float = 1.0) -> Array:
    """Frequencies over the spin of the liquid in one sector, by a sum of functions that its walls allow.

    sin(m pi theta/angle) on the surface with the harmonic function that vanishes at the wall; `turning` 0
    leaves the Coriolis force out. To 1e-4 with 60 terms; nothing of it is in the package.
    """
    depth, angle = -0.5 * math.log(1.0 - share), 2.0 * math.pi / sectors
    m = np.arange(1, terms + 1)
    own = m * math.pi / angle
    inertia, surface = np.diag(0.5 * angle * own / np.tanh(own * depth)), np.diag(0.5 * angle * own**2)
    row, column = np.meshgrid(m, m, indexing="ij")
    odd = (row + column) % 2 == 1
    gap = np.where(odd, row**2 - column**2, 1)
    gyration = turning * np.where(odd, 2.0 * row * column / gap, 0.0)
    nothing = np.zeros_like(inertia)
    left = np.block([[surface, nothing], [nothing, inertia]]).astype(complex)
    right = np.block([[nothing, surface], [surface, -2j * gyration]])
    found = eigh(right, left, eigvals_only=True)
    return np.asarray(found[found > 0.0])


@pytest.fixture(scope="module")
def computed() -> list[Case]:
    """All cases but those of partitions, which take as long as the others together."""
    return [case for module in (damping, tilt, absorber, ring, balancer) for case in module.cases()]


def test_cases_come_out_again(computed: list[Case]) -> None:
    found = kept_group("published")
    # Of an even number of half waves theory has more than of the next odd one; see the case.
    assert verdicts(found, "differs") == {"odd"}
    # Bands of a clear ring and of three sectors.
    come_out_again([*islice(partitions.cases(), 4), *computed])


def test_the_page_has_the_table(computed: list[Case]) -> None:
    """Made from the cases: `python -m validation.cases.published.table` prints it."""
    page = PAGE.read_text(encoding="utf-8").partition("## Published experiments")[2].partition("\n## ")[0]
    rows = [line for line in page.splitlines() if line.startswith("| ")][2:]
    shown = repr(table([case.to_json() for case in computed])).splitlines()[2:]
    assert rows[-len(shown) :] == shown
    # A line for each statement on partitions: one rule for all bands, and five more.
    assert len(rows) == len(shown) + 6


@kills(f"{CASES}.partitions:wave_ratio", "math.sqrt(1.0 - share)", "1.0 - share")
def test_waves_of_sectors_are_those_of_a_sum_of_functions() -> None:
    """Of a clear ring as its closed form has them; half as many elements are less than 1e-3 off."""
    page = PAGE.read_text(encoding="utf-8")
    for share in partitions.SHARES:
        for sectors in (3, 4, 5):
            exact = sector_waves(sectors, share)[0]
            assert f"{exact:.3f}" in page
            # Elements of half the size change it by 3e-4 at most.
            assert partitions.wave_ratio(sectors, share) == pytest.approx(exact, rel=4e-4)
            coarse = partitions.wave_ratio(sectors, share, 24)
            assert abs(coarse / exact - 1.0) < 1e-3
        backward = -float(free_wave_frequencies(1, -0.5 * math.log(1.0 - share), 1.0)[1])
        assert partitions.wave_ratio(0, share) == pytest.approx(backward, rel=1e-4)


@kills(f"{CASES}.partitions:rule", "1.0 - ratio) if", "1.0 + ratio) if")
@kills(f"{CASES}.partitions:rule", "mass / (mass +", "mass / (mass -")
def test_a_light_liquid_has_its_band_where_the_rule_says() -> None:
    """What is left is of first order in the liquid's mass: a tenth of it with ten times the rotor."""
    for sectors, share in ((0, 0.25), (3, 0.5)):
        left = []
        for mass in (10.0, 100.0):
            low, high = partitions.widest(partitions.bands(sectors, share, mass=mass))
            left.append(0.5 * (low + high) / partitions.rule(sectors, share, mass) - 1.0)
        assert abs(left[1]) < 0.15 * abs(left[0]) < 0.15 * 0.07


@kills(f"{CASES}.partitions:whirl_over_critical", "(mass + fill.added_mass)", "(mass - fill.added_mass)")
@kills(f"{CASES}.partitions:whirl_over_critical", "np.argmax(growth)", "np.argmin(growth)")
def test_a_light_liquid_whirls_at_the_critical_speed() -> None:
    """Where the growth is largest; to first order in its mass, a sixtieth of the rotor's."""
    for sectors in (0, 3):
        band = partitions.widest(partitions.bands(sectors, 0.25, mass=100.0))
        assert partitions.whirl_over_critical(sectors, 0.25, band, 100.0) == pytest.approx(1.0, abs=0.006)


@kills(f"{CASES}.damping:width_of_two", "rotor_decay + wave_decay)", "rotor_decay - wave_decay)")
@kills(f"{CASES}.damping:width_of_two", "growth**2 / (rotor", "growth / (rotor")
def test_width_of_two_modes_by_their_eigenvalues() -> None:
    """lambda of two modes with opposite energies: at the edge the larger real part is zero."""
    alpha, gamma, kappa, ratio = 0.7, 0.3, 1.1, 0.26
    edge = 0.5 * damping.width_of_two(alpha, gamma, kappa, ratio) * (1.0 - ratio)
    for distance, grows in ((0.999 * edge, True), (1.001 * edge, False)):
        modes = np.array([[-alpha, kappa], [kappa, -gamma - 1j * distance]])
        assert (np.linalg.eigvals(modes).real.max() > 0.0) == grows


@kills(f"{CASES}.damping:decay_of_wave", ")[1].imag", ")[0].imag")
def test_bands_of_two_modes_are_as_wide_as_computed() -> None:
    """Roots of the mass ratio, 0.016, are left out: 5 % at the largest decay, which is twice the growth."""
    for wave, decays in (damping.WEAK, damping.STRONG):
        found, known = damping.widths(wave, decays)
        np.testing.assert_allclose(found, known, rtol=0.05, atol=1e-12)
    assert known[-1] == 0.0


@kills(f"{CASES}.damping:ratios", "whirl_speed / speeds", "speeds / whirl_speed")
def test_least_ratio_of_whirl_to_spin() -> None:
    """1 - c of each share, 2 - sqrt(2) for a full chamber, to first order in the liquid's mass."""
    found = damping.ratios(100.0)[:, 0]
    layers = [plane_layer(partitions.chamber_with(0, share), NO_FRICTION) for share in damping._SHARES]
    known = [1.0 - slower_slip(layer.layer_tanh) for layer in layers if layer is not None]
    np.testing.assert_allclose(found, known, atol=0.016)
    assert 1.0 - slower_slip(1.0) == pytest.approx(2.0 - math.sqrt(2.0), rel=1e-14)


@kills(f"{CASES}.tilt:wave_in_space", "1.0 - slower_slip", "slower_slip")
@kills(f"{CASES}.tilt:endless", "(middle, beyond) if grows(middle)", "(middle, beyond) if not grows(middle)")
def test_a_very_fast_rotor_whirls_where_tilt_and_wave_go_together() -> None:
    """I_p/I_t = 1 - c in a range as wide as the root of the liquid's mass, sqrt(10) times with ten."""
    for share in tilt.SHARES:
        (low, high), (wide_low, wide_high) = tilt.endless(share), tilt.endless(share, 1.0)
        assert low < tilt.wave_in_space(share) < high
        assert 0.5 * (low + high) == pytest.approx(tilt.wave_in_space(share), rel=0.005)
        # With ten times it, up to terms of the mass itself, 0.04 of the rotor's inertia.
        assert (wide_high - wide_low) / (high - low) == pytest.approx(math.sqrt(10.0), rel=0.12)


@kills(f"{CASES}.tilt:rule", "space * system.gyroscopic", "system.gyroscopic")
@kills(f"{CASES}.tilt:rule", "space**2 * system.mass", "system.mass")
def test_where_the_tilting_whirl_meets_the_wave() -> None:
    """A natural frequency of the empty rotor at that speed is (1 - c) times it."""
    for ratio in (0.2, 0.5):
        speed = tilt.rule(ratio, 0.5)
        known = modes(tilt.rotor(ratio).system(), np.array([speed])).frequency[0]
        assert np.abs(known / (tilt.wave_in_space(0.5) * speed) - 1.0).min() < 1e-9


def twisted(half_waves: int, depth: float) -> float:
    """What drives a wave of a thin layer: |integral of u|^2 over its energy, by long waves both ways.

    u = sin(j b t) e^(i k t) with k = j b sqrt(L/(1 + L)) over a sector of the angle pi/b, the sum of the two
    that the Coriolis force makes unlike; its energy is half of j^2 in one unit.
    """
    twist = half_waves * math.sqrt(depth / (1.0 + depth))
    sides = abs(1.0 - (-1.0) ** half_waves * np.exp(1j * math.pi * twist))
    return float((half_waves * sides / (half_waves**2 - twist**2)) ** 2 / half_waves**2)


@kills(f"{CASES}.absorber:angular_momentum", "x * area", "y * area")
@kills(f"{CASES}.absorber:sector_waves", "0.0 * system.gyration", "system.gyration")
def test_what_drives_the_waves_of_a_sector() -> None:
    """In a thin layer as long waves have it; without the Coriolis force nothing drives an even number."""
    share = 0.02
    depth = -0.5 * math.log(1.0 - share)
    for sectors in (2, 6):
        found = absorber.sector_waves(sectors, share).coupling
        known = np.array([twisted(j, depth) for j in (1, 2, 3)])
        # Of first order in the depth, and by linear sums over triangles as long as a tenth of a wave.
        np.testing.assert_allclose(found[:3] / found[0], known / known[0], rtol=0.06, atol=3e-4)
        still = absorber.sector_waves(sectors, 0.3, coriolis=False)
        assert still.coupling[1::2].max() < 1e-12 < 1e-3 < still.coupling[2]
        assert np.abs(still.running).max() < 1e-6


@kills(f"{CASES}.absorber:angular_momentum", "-((along_x", "((along_x")
def test_torque_of_a_wave_is_the_pressure_on_the_walls() -> None:
    """Of even waves too: d(angular momentum)/dt and p r along the walls, theory: sloshing, eq. 17.

    The pressure is the less accurate: 1 % of the third wave with 96 elements along the wall, 15 % with 24.
    """
    section = absorber.sector_liquid(4, 0.3, 96)
    system, walls = condense(section), wall_points(section)
    known = spectrum(system)
    first = np.intersect1d(section.wall[:, 0], section.surface[:, 1])
    last = np.intersect1d(section.wall[:, 1], section.surface[:, 0])
    for sigma, amplitude in zip(known.frequency[:3], known.amplitude[:3], strict=True):
        eta = system.on_nodes(amplitude[None])
        nodes, xi = surface_displacement(section, eta)
        pressure = np.zeros(len(section.points), dtype=complex)
        pressure[nodes] = -section.surface_radius * xi[0]
        ends = 0.5 * section.surface_radius**2 * (pressure[last].sum() - pressure[first].sum())
        slope = -(sigma**2) * (walls.slope @ eta[0])
        torque = (walls.weights * 0.5 * np.square(walls.points).sum(axis=1)) @ slope - ends
        rate = sigma**2 * absorber.angular_momentum(section, eta)[0]
        assert abs(torque / rate - 1.0) < 0.015


@kills(f"{CASES}.absorber:sector_liquid", "2.0 * math.pi / sectors", "math.pi / sectors")
@kills(f"{CASES}.absorber:tuned", "- order", "- 1.1 * order")
def test_tuned_amounts_are_those_of_the_sum_of_functions() -> None:
    """And the frequencies at a share of 0.3183, as an independent sum has them, known before."""
    known = {2: 0.399, 3: 0.594, 4: 0.784, 6: 1.145, 8: 1.477}
    for sectors, frequency in known.items():
        exact = sector_waves(sectors, 0.3183)[0]
        assert exact == pytest.approx(frequency, abs=6e-4)
        assert abs(absorber.sector_waves(sectors, 0.3183).frequency[0]) == pytest.approx(exact, rel=1e-3)
    share = absorber.tuned(4, 1, 1)
    assert share is not None and sector_waves(4, share)[0] == pytest.approx(1.0, rel=2e-3)
    assert absorber.tuned(2, 1, 1) is None and sector_waves(2, 0.97)[0] < 1.0


@kills(f"{CASES}.ring:swing_by_elements", "speed, -speed,", "speed, 0.5 * speed,")
@kills(f"{CASES}.ring:swing_by_elements", "-1j * speed *", "-2j * speed *")
def test_swing_by_elements() -> None:
    """On cells twice as large a few times farther from the closed form, both to their fourth order."""
    exact = 9.81 * (1.0 - ring.SHARE) / 40.0
    assert ring.swing_by_elements(40.0) == pytest.approx(exact, rel=5e-5)


@kills(f"{CASES}.ring:lag", ".wall_drift / speed", ".wall_drift")
def test_lag_over_the_spin() -> None:
    """(3/4) Gamma^2/kappa^2."""
    gamma = 9.81 / (40.0**2 * ring.RADIUS)
    assert ring.lag(40.0) == pytest.approx(0.75 * (gamma * (1.0 - ring.SHARE)) ** 2, rel=1e-12)


@kills(f"{CASES}.ring:shifts", "0.5 * depth * _GRAVITY", "depth * _GRAVITY")
@kills(f"{CASES}.ring:shifts", "0.5 * depth * float(", "0.25 * depth * float(")
def test_gravity_in_the_frame_of_a_modulated_drum() -> None:
    """Means over a turn of what stands in space: gravity itself, and the surface that it has moved."""
    depth, speed = 0.01, 40.0
    time = 2.0 * math.pi / speed * np.arange(4096) / 4096
    turned = np.exp(-1j * (speed * time + depth * np.sin(speed * time)))
    mean = abs(turned.mean())
    carried, slipping = ring.shifts(depth, speed)
    assert carried == pytest.approx(mean * 9.81 / speed**2, rel=depth**2)
    kappa = 1.0 / (1.0 - ring.SHARE)
    assert slipping == pytest.approx(mean * (kappa - 1.0) * 9.81 / (2.0 * kappa * speed**2), rel=depth**2)


@kills(f"{CASES}.balancer:over_speed", "stiffer * soft.stiffness", "soft.stiffness")
def test_rigid_supports_leave_the_liquid_in_place() -> None:
    """Its unbalance is m_f/K Omega^2 of the rotor's, to first order in the deflection: 1/K."""
    mass, fill = partitions.MASS, partitions.chamber_with(0, 0.25)
    for stiffer in (1e4, 1e6):
        found = balancer.over_speed(stiffer)
        known = fill.full_mass * found.speed**2 / (stiffer * mass * partitions.NATURAL**2)
        liquid = fill.mass * found.liquid_offset / 1e-3
        np.testing.assert_allclose(liquid, known, rtol=30.0 / stiffer)


@kills(f"{CASES}.balancer:angles", "1.2 * second", "0.8 * second")
def test_the_liquid_goes_over_at_each_critical_speed() -> None:
    """Signs of a stiffness without damping: the force of an unbalance in one plane on another one's place."""
    for place in (tilt.filled(0.25).chamber.plane, -0.15):
        (first, second), fill, machine = balancer.two_criticals(place)
        system = machine.system()
        push, at = system.at(place)[0], system.at(fill.chamber.plane)[0]
        added = fill.added_mass * np.outer(at, at)
        signs = []
        for speed in (0.5 * first, math.sqrt(first * second), 1.2 * second):
            # A forward circle sees the gyroscopic moment as less inertia of its lean.
            mass = system.mass[::3, ::3] + added[::3, ::3] - np.diag([0.0, machine.polar_inertia])
            moved = np.linalg.solve(system.stiffness[::3, ::3] - speed**2 * mass, push[::3])
            signs.append(float(at[::3] @ moved) > 0.0)
        assert [angle < 90.0 for angle in balancer.angles(place)] == signs


@kills(f"{CASES}.balancer:two_criticals", "> 0.0]", "< 0.0]")
def test_critical_speeds_of_the_forward_whirls() -> None:
    """An unbalance, which turns forward, is largest there."""
    (first, second), fill, machine = balancer.two_criticals(-0.15)
    for critical in (first, second):
        around = critical * np.array([0.97, 1.0, 1.03])
        size = response(machine, [fill], around, gravity=0.0).amplitude
        assert size[1] > 1.5 * max(size[0], size[2])
