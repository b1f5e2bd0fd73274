"""The liquid's equilibrium against high-precision quadrature, closed forms and limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from meshes.chamber import Chamber, Chambers
from meshes.errors import InputError
from solvers.statics import hydrostatics
from solvers.statics.hydrostatics import equilibrium, optimal_volume, wall_volumes
from tests.mutants import kills
from tests.oracles.statics import LiquidReference, liquid_reference

GRAVITY = 9.81
FIELDS = ("volume", "x", "z", "xx", "yy", "zz", "xz")

# Ten digits are promised; the integrals keep fourteen, and what is left is the reference's own rounding.
DIGITS = 1e-12


def reference(radius: float, height: float, e: float, speed: float, wetted: float) -> LiquidReference:
    """The liquid under the surface whose height at the farthest wall point is `wetted` heights."""
    beta = mpf(speed) ** 2 / (2 * mpf(GRAVITY))
    constant = mpf(wetted) * mpf(height) - beta * (mpf(radius) + mpf(e)) ** 2
    return liquid_reference(radius, height, e, beta, constant)


def check_state(radius: float, height: float, fill: float, e: float, speed: float) -> None:
    """The surface holds the volume, and all its moments are the reference's."""
    chamber = Chamber(radius, height)
    state = equilibrium(chamber, fill * chamber.capacity, e, speed, GRAVITY)
    assert state.converged
    with mp.workdps(40):
        exact = reference(radius, height, e, speed, float(state.wetted_height))
        assert abs(exact.volume / (mpf(fill) * mpf(chamber.capacity)) - 1) < DIGITS
        moments = state.moments()
        for field in FIELDS:
            value, right = mpf(float(getattr(moments, field))), getattr(exact, field)
            # The concentric chamber's first moments vanish but for the reference's own rounding.
            assert abs(value - right) <= DIGITS * abs(right) + mpf("1e-40"), field
        assert abs(mpf(float(state.unbalance()[0])) - exact.x) <= DIGITS * abs(exact.x) + mpf("1e-40")


@given(
    log_speed=st.floats(-2.0, 5.0),
    eps=st.one_of(
        st.floats(0.0, 2.0),
        st.floats(-12.0, 0.0).map(lambda p: 10.0**p),
        st.floats(-12.0, -1.0).map(lambda p: 1.0 - 10.0**p),
        st.floats(-12.0, -1.0).map(lambda p: 1.0 + 10.0**p),
    ),
    fill=st.one_of(
        st.floats(-9.0, 0.0).map(lambda p: 10.0**p), st.floats(0.0, 9.0).map(lambda p: 1 - 10**-p)
    ),
    slenderness=st.floats(-1.5, 1.0),
)
@example(log_speed=5.0, eps=1.0, fill=1e-9, slenderness=0.0)
@example(log_speed=-2.0, eps=2.0, fill=1e-9, slenderness=0.0)
@example(log_speed=5.0, eps=0.005, fill=0.0087, slenderness=-0.6)
@settings(max_examples=25)
def test_whole_box_against_high_precision(
    log_speed: float, eps: float, fill: float, slenderness: float
) -> None:
    assume(0.0 < fill < 1.0)
    radius = 0.2
    check_state(radius, radius * 10.0**slenderness, fill, eps * radius, 10.0**log_speed)


@pytest.mark.parametrize(
    ("radius", "height", "speed", "millilitres"),
    [
        (0.2, 0.05, 90.0, (54.43957239, 178.3088703, 603.5171603)),
        (0.2, 0.05, 20.0, (7.660266099, 68.48354943, 458.8148245)),
        (0.05, 0.02, 100.0, (5.179335154, 17.16556767, 55.38914207)),
    ],
)
def test_optimal_volume_values(
    radius: float, height: float, speed: float, millilitres: tuple[float, ...]
) -> None:
    deflection = np.array([1e-3, 3e-3, 10e-3])
    volume = optimal_volume(Chamber(radius, height), deflection, speed, GRAVITY) * 1e6
    np.testing.assert_allclose(volume, millilitres, rtol=6e-10)  # the values carry ten digits


def test_optimal_volume_fast_spin_limit() -> None:
    # The surface is a cylinder of radius R - e: the crescent between two circles that touch.
    chamber = Chamber(0.2, 0.05)
    e = np.array([1e-6, 1e-3, 0.05, 0.15])
    crescent = math.pi * 0.05 * e * (0.4 - e)
    np.testing.assert_allclose(optimal_volume(chamber, e, 1.0, gravity=0.0), crescent, rtol=1e-12)
    # At a finite speed the ramp of radial width h/(2 beta R) shifts it in proportion to that width.
    beta = 1e5**2 / (2 * GRAVITY)
    width = 0.05 / (2 * beta * 0.15)
    shift = np.abs(optimal_volume(chamber, e[1:], 1e5, GRAVITY) / crescent[1:] - 1.0)
    assert np.all(shift < 10.0 * width / e[1:])


def test_added_mass_while_the_wall_is_wet() -> None:
    """While the wall is wet all over, the unbalance is that of a full chamber at the deflection."""
    chamber = Chamber(0.2, 0.05)
    e = np.array([1e-5, 1e-3, 1e-2])
    state = equilibrium(chamber, 1e-3, e, 90.0, GRAVITY)
    assert np.all(state.nearest_depth > 1.0)
    moment, slope = state.unbalance()
    np.testing.assert_allclose(moment, math.pi * 0.2**2 * 0.05 * e, rtol=1e-13)
    np.testing.assert_allclose(slope, math.pi * 0.2**2 * 0.05, rtol=1e-9)


def test_clear_constant() -> None:
    """Surface clear of the wall, cutting floor and lid: C = h/2 - beta (R^2 - V/(pi h)) [DR18, eq. 17]."""
    chamber = Chamber(0.2, 0.05)
    volume = np.array([1e-3, 2e-3, 4e-3])
    state = equilibrium(chamber, volume, 0.002, 60.0, GRAVITY)
    beta = 60.0**2 / (2.0 * GRAVITY)
    closed = 0.025 - beta * (0.2**2 - volume / (math.pi * 0.05))
    np.testing.assert_allclose(state.surface_constant, closed, rtol=1e-12)


@kills(
    "solvers.statics.hydrostatics:Equilibrium.surface_constant",
    "np.square(1.0 + self.eccentricity / radius)",
    "1.0",
)
def test_bowl() -> None:
    """Floor covered and lid dry: a bowl, whose volume, unbalance and constant are polynomials."""
    chamber, volume, e, speed = Chamber(0.2, 0.5), 0.02, 0.01, 8.0
    beta = speed**2 / (2 * GRAVITY)
    state = equilibrium(chamber, volume, e, speed, GRAVITY)
    area = math.pi * 0.2**2
    constant = volume / area - beta * (0.2**2 / 2 + e**2)
    assert 0.0 < constant < 0.5
    np.testing.assert_allclose(state.surface_constant, constant, rtol=1e-12)
    moment, slope = state.unbalance()
    expected = volume + beta * math.pi * 0.2**4 / 2
    np.testing.assert_allclose(moment, expected * e, rtol=1e-12)
    np.testing.assert_allclose(slope, expected, rtol=1e-12)


def test_far_deflection() -> None:
    """A drop far out sits at the farthest wall point: its unbalance is V (R + e)."""
    chamber = Chamber(0.2, 0.05)
    for e in (0.01, 0.3):
        moment, _ = equilibrium(chamber, 1e-12, e, 1e4, GRAVITY).unbalance()
        np.testing.assert_allclose(moment, 1e-12 * (0.2 + e), rtol=1e-3)


@kills(
    "solvers.statics.hydrostatics:Equilibrium.unbalance",
    "2.0 * np.maximum(plan_xx - mean * plan_x, 0.0)",
    "2.0 * plan_xx",
)
@kills("solvers.statics.hydrostatics:Equilibrium.unbalance", "self.volume + 2.0 * np.max", "2.0 * np.max")
def test_slope() -> None:
    """Slope of the unbalance against a central difference, dry patch and annulus included."""
    for chamber, volume, e, speed in (
        (Chamber(0.2, 0.05), 2e-4, 0.012, 60.0),
        (Chamber(0.2, 0.05), 2e-4, 0.25, 60.0),
        (Chamber(0.2, 0.05, inner_radius=0.15), 2e-3, 0.02, 9.0),
        (Chamber(0.2, 0.05), 2e-4, 0.012, 1e4),
    ):
        step = 1e-5 * e
        around = equilibrium(chamber, volume, np.array([e - step, e, e + step]), speed, GRAVITY)
        moment, slope = around.unbalance()
        # Central difference: rounding 1e-15/1e-5, truncation 1e-10 times a curvature of order one to ten.
        np.testing.assert_allclose((moment[2] - moment[0]) / (2 * step), slope[1], rtol=1e-6)


@given(
    log_speed=st.floats(-1.0, 4.0),
    fill=st.floats(-6.0, 0.0),
    inner=st.sampled_from((0.0, 0.3, 0.8)),
)
@settings(max_examples=40)
def test_pull_never_decreases(log_speed: float, fill: float, inner: float) -> None:
    # The liquid's potential is the least over its shapes of functions linear in e, hence concave.
    chamber = Chamber(0.2, 0.05, inner_radius=0.2 * inner)
    volume = chamber.capacity * 10.0**fill
    e = np.concatenate(([0.0], np.geomspace(1e-6, 0.4, 60)))
    state = equilibrium(chamber, volume, e, 10.0**log_speed, GRAVITY)
    assert state.converged.all()
    moment, _ = state.unbalance()
    offset = moment / volume - e
    # Rounding of the first moment, which reaches V (R + e), and of the inner wall's share of it.
    slack = 1e-12 * chamber.radius * max(1.0, math.pi * 0.2**3 * 0.05 / (volume * 0.2))
    assert np.all(np.diff(offset) >= -slack)
    assert np.all((offset >= -slack) & (offset <= chamber.radius + slack))


@given(
    log_speed=st.floats(-1.0, 4.0),
    fill=st.floats(-6.0, 0.0),
    inner=st.floats(0.0, 0.95),
    horizontal=st.booleans(),
)
@settings(max_examples=60)
def test_unbalance_never_grows_faster_than_a_full_chamber(
    log_speed: float, fill: float, inner: float, horizontal: bool
) -> None:
    chamber = Chamber(0.2, 0.05, inner_radius=0.2 * inner)
    e = np.concatenate(([0.0], np.geomspace(1e-6, 0.4, 200)))
    gravity = 0.0 if horizontal else GRAVITY
    state = equilibrium(chamber, chamber.capacity * 10.0**fill, e, 10.0**log_speed, gravity)
    _, slope = state.unbalance()
    # The search for branches grants rounding a billionth.
    assert np.all(slope <= math.pi * 0.2**2 * 0.05 * (1.0 + 1e-9))


@kills(
    "meshes.chamber:Chambers.capacity",
    "(self.radius - self.inner_radius) * (self.radius + self.inner_radius)\n        return np",
    "(self.radius - self.inner_radius) * self.radius\n        return np",
)
def test_many_chambers() -> None:
    """One chamber for each state: as each alone, with and without inner walls."""
    ones = [Chamber(0.2, 0.05), Chamber(0.1, 0.3, 0.06), Chamber(0.35, 0.02, 0.3), Chamber(0.06, 0.08)]
    fill, e, speed = (
        np.array([0.2, 0.5, 0.9, 1.0]),
        np.array([0.02, 0.01, 0.05, 0.1]),
        np.array([9.0, 30.0, 60.0, 4.0]),
    )
    volume = fill * np.array([one.capacity for one in ones])
    np.testing.assert_allclose(Chambers.of(ones).capacity, [one.capacity for one in ones], rtol=1e-15)
    for gravity in (0.0, GRAVITY):
        many = equilibrium(Chambers.of(ones), volume, e, speed, gravity)
        assert many.converged.all()
        moment, slope = many.unbalance()
        for k, one in enumerate(ones):
            alone = equilibrium(one, volume[k], e[k], speed[k], gravity)
            # Powers of the radius are rounded differently for one and for many.
            np.testing.assert_allclose((moment[k], slope[k]), alone.unbalance(), rtol=1e-13)
            assert many.dry_patch[k] == alone.dry_patch
    with pytest.raises(InputError, match="capacity"):
        equilibrium(Chambers.of(ones), 1.1 * volume, e, speed)


@given(
    log_speed=st.floats(-2.0, 5.0),
    eps=st.floats(0.0, 2.0),
    fill=st.floats(-6.0, -0.001),
    ratio=st.floats(0.05, 0.95),
)
@example(log_speed=1.0, eps=0.05, fill=-0.1, ratio=0.7)
@settings(max_examples=20)
def test_annulus_against_high_precision(log_speed: float, eps: float, fill: float, ratio: float) -> None:
    chamber = Chamber(0.2, 0.05, inner_radius=0.2 * ratio)
    volume, e, speed = chamber.capacity * 10.0**fill, 0.2 * eps, 10.0**log_speed
    state = equilibrium(chamber, volume, e, speed, GRAVITY)
    assert state.converged
    moments = state.moments()
    with mp.workdps(40):
        outer = reference(0.2, 0.05, e, speed, float(state.wetted_height))
        beta = mpf(speed) ** 2 / (2 * mpf(GRAVITY))
        constant = mpf(float(state.wetted_height)) * mpf(0.05) - beta * (mpf(0.2) + mpf(e)) ** 2
        inner = liquid_reference(chamber.inner_radius, 0.05, e, beta, constant)
        for field in FIELDS:
            right = getattr(outer, field) - getattr(inner, field)
            # Both parts carry 1e-14; their difference is a thin annulus at worst.
            slack = 1e-13 * abs(getattr(outer, field)) + DIGITS * abs(right) + mpf("1e-40")
            assert abs(mpf(float(getattr(moments, field))) - right) <= slack, field


@pytest.mark.parametrize("gravity", [0.0, 9.81])
@pytest.mark.parametrize("speed", [0.0, 1e-8, 1e5])
@pytest.mark.parametrize("e", [0.0, 1e-9, 0.2, 0.5])
def test_extremes_have_the_right_limits(gravity: float, speed: float, e: float) -> None:
    chamber = Chamber(0.2, 0.05)
    volume = np.array([0.0, 1e-9 * chamber.capacity, 0.3 * chamber.capacity, chamber.capacity])
    state = equilibrium(chamber, volume, e, speed, gravity)
    moments = state.moments()
    assert state.converged.all()
    # Volume: rounding of zeta moves the volume by plan * zeta.
    np.testing.assert_allclose(moments.volume, volume, rtol=1e-12, atol=1e-25)
    assert moments.x[0] == 0.0
    np.testing.assert_allclose(moments.x[-1], chamber.capacity * e, rtol=1e-12)
    np.testing.assert_allclose(moments.z[-1], chamber.capacity * 0.025, rtol=1e-12)
    polar = chamber.capacity * (0.2**2 / 2 + e**2)
    np.testing.assert_allclose(moments.polar_inertia[-1], polar, rtol=1e-12)
    if speed == 0.0:
        np.testing.assert_allclose(moments.x, volume * e, rtol=1e-12, atol=1e-25)
        assert not state.dry_patch[1:].any()
    if e == 0.0:
        np.testing.assert_allclose(moments.x, 0.0, atol=1e-25)
        assert not state.dry_patch[1:].any()


def test_cylinder_limit_is_the_crescent() -> None:
    # Without gravity the liquid fills the chamber beyond a cylinder of radius rho about the rotation axis.
    chamber, e, volume = Chamber(0.2, 0.05), 0.03, 2e-4
    state = equilibrium(chamber, volume, e, 50.0, gravity=0.0)
    with mp.workdps(30):
        R, d = mpf(0.2), mpf(e)

        def angle(r: mpf) -> mpf:
            return mp.acos((r**2 + d**2 - R**2) / (2 * r * d))

        def beyond(rho: mpf) -> mpf:
            return mp.quad(lambda r: 2 * angle(r) * r, [rho, R + d]) * mpf(0.05) - mpf(volume)

        rho = mp.findroot(beyond, (mpf("0.2"), mpf("0.225")), solver="anderson")
        first = mp.quad(lambda r: 2 * mp.sin(angle(r)) * r**2, [rho, R + d]) * mpf(0.05)
        assert abs(mpf(float(state.unbalance()[0])) / first - 1) < 1e-12
    assert state.dry_patch
    assert state.surface_constant == -np.inf


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((-1e-6, 0.0, 1.0, 9.81), "volume"),
        ((1.0, 0.0, 1.0, 9.81), "volume"),
        ((math.nan, 0.0, 1.0, 9.81), "volume"),
        ((1e-6, -0.1, 1.0, 9.81), "eccentricity"),
        ((1e-6, math.inf, 1.0, 9.81), "eccentricity"),
        ((1e-6, 0.1, -1.0, 9.81), "speed"),
        ((1e-6, 0.1, 1.0, -9.81), "gravity"),
    ],
)
def test_bad_input_is_named(arguments: tuple[float, float, float, float], field: str) -> None:
    with pytest.raises(InputError) as caught:
        equilibrium(Chamber(0.2, 0.05), *arguments)
    assert caught.value.field == field


@kills("fluid.paraboloid:steepness", "fall = 2.0 * g * h", "fall = g * h")
def test_whole_box_at_four_corners() -> None:
    for fill, e, speed in ((0.02, 0.012, 40.0), (0.3, 0.25, 7.0), (0.01, 0.1, 1e4), (0.7, 0.05, 6.0)):
        check_state(0.2, 0.05, fill, e, speed)


@kills(
    "solvers.statics.hydrostatics:optimal_volume",
    "4.0 * steep * e / chamber.radius)",
    "2.0 * steep * e / chamber.radius)",
)
def test_optimal_volumes_of_one_chamber() -> None:
    found = optimal_volume(Chamber(0.2, 0.05), np.array([1e-3, 3e-3, 10e-3]), 90.0, GRAVITY) * 1e6
    np.testing.assert_allclose(found, (54.43957239, 178.3088703, 603.5171603), rtol=6e-10)  # ten digits


H = "solvers.statics.hydrostatics"


@kills(f"{H}:_clear_of_walls", "away <= surface - inner", "away <= surface")
@kills(f"{H}:_clear_of_walls", "away <= film / (radius + surface)", "away <= film / surface")
@kills(f"{H}:equilibrium", "eps * (2.0 + eps)", "eps * (2.0 - eps)")
@kills(f"{H}:Equilibrium.unbalance", "np.where(self.clear, line[1], slope)", "np.where(self.clear, x, slope)")
@kills(
    f"{H}:optimal_volume",
    "e * (2.0 * np.asarray(chamber.radius) - e)",
    "e * 2.0 * np.asarray(chamber.radius)",
)
@kills(
    f"{H}:wall_volumes", "(radius - inner - e) * (radius + inner + e)", "(radius - inner) * (radius + inner)"
)
@kills(f"{H}:_inside_both", "2.0 * e <= free", "e <= free")
def test_cylinders_clear_of_the_walls_are_those_of_the_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without gravity along the axis closed forms answer where no wall is met, the kernel elsewhere."""
    count = 400
    rng = np.random.default_rng(5)
    radius, height = rng.uniform(0.05, 0.3, count), rng.uniform(0.01, 0.2, count)
    chamber = Chambers(radius, height, radius * rng.choice([0.0, 0.3, 0.8], count))
    volume = chamber.capacity * rng.uniform(0.01, 0.99, count)
    e = radius * 10.0 ** rng.uniform(-6.0, -0.1, count)
    speed, gravity = rng.uniform(1.0, 500.0, count), np.where(rng.random(count) < 0.1, GRAVITY, 0.0)

    def answers() -> list[np.ndarray]:
        state = equilibrium(chamber, volume, e, speed, gravity)
        assert state.converged.all()
        walls = wall_volumes(chamber, e, speed, gravity)
        height_ratio = state.wetted_height / np.maximum(state.steepness, 1.0)
        return [height_ratio, state.volume, state.first_moment(), *state.unbalance(), *walls]

    clear = equilibrium(chamber, volume, e, speed, gravity).clear
    assert 0.3 * count < np.count_nonzero(clear) < 0.8 * count
    found = answers()
    nowhere = lambda *_: np.zeros(count, dtype=bool)  # noqa: E731
    for name in ("_clear_of_walls", "_inside_both"):
        monkeypatch.setattr(hydrostatics, name, nowhere)
    for one, other in zip(found, answers(), strict=True):
        # The kernel finds the volume to some roundings, its integrals to fourteen digits; what is small in
        # the chamber's own size keeps fewer.
        np.testing.assert_allclose(one, other, rtol=1e-11)
