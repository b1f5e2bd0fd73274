"""No whirl mode that grows most is missed: zeros counted, all of them computed, mirrored machines."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fluid.friction.laws import Friction
from fluid.whirl import plane_layer
from leblanc.scene.scene import dry_rotor, scene_from_table
from solvers.whirl import laminar
from solvers.whirl.count import Region, missed_modes
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills
from tests.oracles import random_machines
from tests.oracles.machines import MACHINES

STOKES = Friction("stokes")
CUTS = (1.0, 3.0)  # imaginary parts of their ends
KINDS = {"two_plane": random_machines.two_plane, "tub": random_machines.tub}


def polynomial(roots: np.ndarray) -> Any:
    """Logarithm of (lambda - r_1) ... (lambda - r_m)."""

    def at(points: np.ndarray, owner: np.ndarray) -> np.ndarray:
        return np.asarray(np.log(points[:, None] - roots[owner]).sum(axis=1))

    return at


def test_at_no_speed_nothing_is_missed() -> None:
    nowhere = np.zeros(0)
    region = Region(nowhere, np.zeros((0, 2)), nowhere, nowhere)
    found = missed_modes(polynomial(np.zeros((0, 6))), 6, np.zeros((0, 6), dtype=complex), region)
    assert found.shape == (0,)


@kills("solvers.whirl.count:missed_modes", "0.5 * (degree - held)", "0.5 * degree")
@kills("solvers.whirl.count:_upper", "known.imag < -near, np.abs", "known.imag < -1e9, np.abs")
def test_zeros_of_polynomials_are_counted() -> None:
    """Pairs and real zeros on both sides of lines on both sides of 0; some known, some with both signs."""
    rng = np.random.default_rng(5)
    for line in (-0.7, 0.0, 0.6):
        pairs = rng.normal(size=(40, 4)) + 1j * np.exp(rng.normal(size=(40, 4), scale=2.0))
        alone = rng.normal(size=(40, 2)) + 0j
        pairs[::3, 1] = pairs[::3, 0] * (1.0 + 1e-9)  # as good as twice the same
        every = np.concatenate([pairs, pairs.conj(), alone], axis=1)
        kept = rng.random(every.shape) < 0.5
        kept[:, 4:8] &= ~kept[:, :4]  # of a pair at most one
        kept[::3, 4:6] = False  # of two alike the same one, or they count as one
        known = np.where(kept, every, complex(np.nan, np.nan))
        right = every.real > line
        # A mode known by one of its signs is known by both.
        told = kept.copy()
        told[:, :4] |= kept[:, 4:8]
        told[:, 4:8] |= kept[:, :4]
        unit = np.ones(40)
        region = Region(line * unit, np.outer(unit, CUTS), unit, np.abs(every).max(axis=1))
        found = missed_modes(polynomial(every), 10, known, region)
        np.testing.assert_array_equal(found, (right & ~told).sum(axis=1))


@kills("solvers.whirl.count:_phase", "(first + second).imag[even]", "first.imag[even]")
def test_a_pair_close_to_the_line_is_seen() -> None:
    """However close to the line, on either side, and far from the points that are looked at first."""
    for away in (1e-2, 1e-5, 1e-8):
        for side in (-1.0, 1.0):
            twice = np.array([[side * away + 3.3217j, side * away * 1.5 + 3.3219j]])
            every = np.concatenate([twice, twice.conj(), [[-1.0 + 2.0j, -1.0 - 2.0j]]], axis=1)
            known, unit = every[:, 4:], np.ones(1)
            found = missed_modes(
                polynomial(every), 6, known, Region(0.0 * unit, unit[:, None], unit, 5.0 * unit)
            )
            assert found[0] == (4.0 if side > 0.0 else 0.0)


@kills("solvers.whirl.count:_phase", "<= _CROWD", ">= 0")
def test_a_phase_of_rounding_is_not_followed() -> None:
    """An ill-conditioned determinant: what halving finds is noise, of which there is ever more: not known.

    Unbounded, the steps to be halved doubled in each round until no memory was left.
    """
    every, asked = np.array([[-1.0 + 2.0j, -1.0 - 2.0j]]), [0]
    exact = polynomial(every)

    def noisy(points: np.ndarray, owner: np.ndarray) -> np.ndarray:
        asked[0] += points.size
        assert asked[0] < 1e6
        here = exact(points, owner)
        return np.asarray(here + np.where(points.imag < 50.0, 3.0 * np.sin(points.imag * 1e13), 0.0) * 1j)

    unit = np.ones(1)
    nothing = np.full((1, 2), complex(np.nan, np.nan))
    assert np.isnan(
        missed_modes(noisy, 2, nothing, Region(0.0 * unit, unit[:, None], unit, 5.0 * unit))
    ).all()
    # A few rounds of at most so many steps.
    assert asked[0] < 5000


@pytest.mark.parametrize("kind", KINDS)
@kills("solvers.whirl.sheets:standing_roots", "3.0 * apart, 3.0 * both", "3.0 * both, 3.0 * apart")
@kills("solvers.whirl.sheets:standing_roots", "stiffness - 0.5 * unit", "stiffness + 0.5 * unit")
@kills("solvers.whirl.sheets:standing_roots", "(roots[0].real > 0.0) &", "")
def test_all_modes_at_once(kind: str) -> None:
    """What the iteration finds is among the eigenvalues of one polynomial and grows as much as any."""
    rng = np.random.default_rng(7)
    for _ in range(6):
        scene = scene_from_table(KINDS[kind](rng))
        rotor, speed = dry_rotor(scene).system(), scene.speed_array()[::4]
        found = [(fill.chamber.plane, plane_layer(fill, STOKES)) for fill in scene.fills]
        # Of floor and lid, whose drags have other roots, the polynomial knows nothing.
        layers = [(plane, replace(layer, lids=0.0)) for plane, layer in found if layer is not None]
        every, modes = laminar.all_modes(rotor, layers, speed), laminar.laminar_modes(rotor, layers, speed)
        assert modes.complete.all()
        for k, spin in enumerate(speed):
            own, all_of_them = modes.root[k][modes.found[k]], every[k][np.isfinite(every[k])]
            scale = spin + np.abs(own)
            # Two waves of one film are as close as 1e-5; eigenvalues keep half of their digits there.
            assert np.all(np.abs(own[:, None] - all_of_them).min(axis=1) < 1e-6 * scale)
            assert all_of_them.real.max() < own.real.max() + 1e-7 * spin


@pytest.mark.parametrize("kind", KINDS)
def test_a_mirrored_machine_grows_alike(kind: str) -> None:
    """At every speed, and known at every speed: one search that fails and one that does not would differ."""
    rng = np.random.default_rng(5)
    for _ in range(12):
        table = KINDS[kind](rng)
        growths = []
        for own in (table, random_machines.mirrored(table)):
            scene = scene_from_table(own)
            growths.append(asynchronous_growth(dry_rotor(scene), scene.fills, scene.speed_array(), STOKES)[0])
        assert np.isfinite(growths[0]).all()
        within = 1e-9 * scene.speed_array()
        np.testing.assert_array_less(np.abs(growths[0] - growths[1]), within + 1e-9 * np.abs(growths[0]))


@kills("solvers.whirl.count:missed_modes", "pairs, region, beside)", "pairs, region, beside[:, :0])")
def test_what_is_near_a_mode_does_not_hide_it() -> None:
    """A mode right of the line beside a rough one left of it is missed all the same."""
    chance = np.random.default_rng(8)
    size = 200
    away = 10.0 ** chance.uniform(-4.0, -1.0, (2, size))
    height = chance.uniform(0.1, 2.0, size)
    near = away[0] + 1j * (height + 0.3 * chance.normal(size=size) * away.sum(axis=0))
    # A well known mode on the line, and one right of it.
    modes = np.stack([np.full(size, 0.5j), near], axis=1)
    every, rough = np.hstack([modes, modes.conj()]), (-away[1] + 1j * height)[:, None]
    unit = np.ones(size)
    region = Region(-1e-7 * unit, np.zeros((size, 0)), unit, 5.0 * unit)
    found = missed_modes(polynomial(every), 4, modes[:, :1], region, rough)
    np.testing.assert_array_equal(found, 2.0)


@kills("solvers.whirl.laminar:_followed", "~modes.complete", "~(modes.complete | True)")
def test_those_that_grow_most_serve_at_many_speeds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside known speeds few modes are followed, and all of them where the count misses one."""
    followed: list[int] = []
    aberth = laminar._aberth

    def watched(*given: Any, **more: Any) -> Any:
        followed.extend(int(flags.sum()) for flags in given[3:])
        return aberth(*given, **more)

    monkeypatch.setattr(laminar, "_aberth", watched)
    for kind in ("two_plane", "tub"):
        scene = scene_from_table(MACHINES[kind])
        rotor, speed = dry_rotor(scene), np.linspace(40.0, 300.0, 90)
        # Of few speeds all modes are computed, each from its own start.
        few = [asynchronous_growth(rotor, scene.fills, part, STOKES)[0] for part in np.split(speed, 3)]
        followed.clear()
        for less in (laminar._LESS, 1e-5, -1.0):
            monkeypatch.setattr(laminar, "_LESS", less)
            found = asynchronous_growth(rotor, scene.fills, speed, STOKES)[0]
            np.testing.assert_allclose(found, np.concatenate(few), rtol=1e-9, atol=1e-10)
        assert 0 < followed[0] < 6 * speed.size and followed[-1] == 0
        monkeypatch.undo()
        monkeypatch.setattr(laminar, "_aberth", watched)


@pytest.mark.parametrize("kind", KINDS)
@kills("solvers.whirl.laminar:Met.near", "+ self.slope[at]", "+ 1e3 * self.slope[at]")
def test_what_is_known_is_where_others_start(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """At other speeds the modes found alone are among those led to, which takes fewer points."""
    rng = np.random.default_rng(11)
    asked, points, eliminate = [0], [0, 0], laminar._eliminate

    def counted(problem: Any, root: Any, spin: Any, slopes: bool = True) -> Any:
        asked[0] += root.size * slopes
        return eliminate(problem, root, spin, slopes)

    for _ in range(4):
        scene = scene_from_table(KINDS[kind](rng))
        system = dry_rotor(scene).system()
        found = [(fill.chamber.plane, plane_layer(fill, STOKES)) for fill in scene.fills]
        layers = [(plane, layer) for plane, layer in found if layer is not None]
        speed = np.geomspace(scene.speeds.start, scene.speeds.stop, 90)
        between = np.sqrt(speed[1:] * speed[:-1])[::9]
        met, taken = laminar.Met(), []
        first = laminar.laminar_modes(system, layers, speed, met=met)
        laminar.laminar_modes(system, layers, speed * (1.0 + 1e-6), near=first, met=met)
        with monkeypatch.context() as patch:
            patch.setattr(laminar, "_eliminate", counted)
            for k, known in enumerate((met, None)):
                asked[0] = 0
                taken.append(laminar.laminar_modes(system, layers, between, met=known))
                points[k] += asked[0]
        led, alone = taken
        assert led.complete.all() and alone.complete.all()
        for k, spin in enumerate(between):
            one, other = led.root[k][led.found[k]], alone.root[k][alone.found[k]]
            assert np.abs(one[:, None] - other).min(axis=0).max() < 1e-6 * spin
            assert one.real.max() == pytest.approx(other.real.max(), abs=1e-9 * spin)
    assert points[0] < 0.85 * points[1]


@kills("solvers.whirl.laminar:_all_counted", "~modes.complete", "~(modes.complete | True)")
@kills("solvers.whirl.laminar:_counted", "complete[unsure] = count == 0.0", "complete[unsure] = True")
def test_a_search_that_fails_is_seen_and_repeated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the starts of the waves modes are missed; the count says so and all are computed at once."""
    scene = scene_from_table(MACHINES["two_plane"])
    rotor, speed = dry_rotor(scene), np.linspace(40.0, 300.0, 14)
    whole = asynchronous_growth(rotor, scene.fills, speed, STOKES)[0]
    assert (whole > 0.0).any()
    starts = laminar._starts
    monkeypatch.setattr(laminar, "_starts", lambda *given: starts(*given)[:, :8])
    again = asynchronous_growth(rotor, scene.fills, speed, STOKES)[0]
    np.testing.assert_allclose(again, whole, rtol=1e-9, atol=1e-10)
    # With too many coordinates for that, what is missed is not known.
    monkeypatch.setattr(laminar, "_MOST", 0)
    lost = asynchronous_growth(rotor, scene.fills, speed, STOKES)[0]
    assert np.isnan(lost).any()
    known = ~np.isnan(lost)
    np.testing.assert_allclose(lost[known], whole[known], rtol=1e-9, atol=1e-10)
    # Where no speed is known whole, there is nothing that others could start from.
    monkeypatch.setattr(laminar, "_starts", lambda *given: starts(*given)[:, :4])
    met, rotor = laminar.Met(), rotor.system()
    layers = [(fill.chamber.plane, plane_layer(fill, STOKES)) for fill in scene.fills]
    first = laminar.laminar_modes(rotor, layers, speed, met=met)
    assert met.speed.size == 0
    laminar.laminar_modes(rotor, layers, speed * (1.0 + 1e-6), near=first, met=met)
