"""The studies of run-ups: their figures against those given, limits, and the order of the lag."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest

from fluid.fill import Fill
from tests.mutants import kills
from validation.cases.rotors import rig_lag, runup
from validation.cases.rotors.rigs import horizontal_rig

RPM = math.pi / 30.0


def given_figures(row: tuple[float, ...], cells: int, tolerance: float) -> None:
    volume, rate, peak, speed, end = row
    found = runup.run(volume, rate, cells)
    assert found.converged
    # The figures given have three or four digits; the friction laws differ by 1.6 % in their rate.
    assert found.peak * 1e3 == pytest.approx(peak, rel=tolerance)
    assert found.peak_speed == pytest.approx(speed, rel=tolerance)
    assert found.last * 1e3 == pytest.approx(end, rel=tolerance)
    assert found.closure < 1e-3


def test_the_run_up_without_liquid() -> None:
    given_figures(runup.GIVEN[0], 64, 1e-3 + 0.05 / 22.4)  # three digits


def test_the_run_up_with_strong_friction() -> None:
    given_figures(runup.GIVEN[2], 64, 0.01)


@pytest.mark.slow
def test_the_run_up_with_weak_friction() -> None:
    given_figures(runup.GIVEN[1], 128, 0.01)


@kills(
    "validation.cases.rotors.runup:best_volume",
    "optimal_volume(CHAMBER, deflection, RAMP.stop, _GRAVITY)",
    "optimal_volume(CHAMBER, deflection, RAMP.start, _GRAVITY)",
)
def test_best_volume() -> None:
    """The fast-spin limit pi h_c (R^2 - (R - e)^2), less at most what the paraboloid leans back."""
    e, radius, height = 2.78e-3, 0.25, 0.04
    limit = math.pi * height * (radius**2 - (radius - e) ** 2)
    # Its radius squared grows by 2 g z/Omega^2; where it meets the wall no air comes with it.
    lean = math.pi * height * 9.81 * height / 100.0**2
    assert limit - lean < runup.best_volume(e) < limit - 0.5 * lean


@kills(
    "validation.cases.rotors.runup:steady_end",
    "fills, [RAMP.stop], _GRAVITY",
    "fills[:0], [RAMP.stop], _GRAVITY",
)
def test_steady_end() -> None:
    """Beyond the volume that covers the wall the liquid is the added mass m_f; below, it does less."""
    wall = runup.CHAMBER
    full = Fill(wall, runup.known_liquid("water"), 1e-3).full_mass
    impedance = 30.0 * 25.0**2 - (30.0 + full) * 1e4 + 1j * 2.0 * 0.06 * 30.0 * 25.0 * 100.0
    wet = 0.1 * 1e4 / abs(impedance)
    thin, thick, thicker = runup.steady_end([0.05e-3, 0.5e-3, 1e-3])
    assert thick == pytest.approx(wet, rel=1e-9)
    assert thicker == pytest.approx(wet, rel=1e-9)
    assert thin > 1.1 * wet


@kills(
    "validation.cases.rotors.rig_lag:orders",
    "/ math.log(point.rate / other.rate)",
    "/ math.log(other.rate / point.rate)",
)
def test_orders() -> None:
    """Errors in proportion to a power of the rate give that power."""
    one = rig_lag.Lag(
        rate=8.0,
        speed=np.zeros(1),
        angle=np.zeros(1),
        error=0.4,
        beyond=0.1,
        angle_error=0.1,
        angles=np.zeros(6),
        closure=0.0,
        converged=True,
    )
    lags = [one, replace(one, rate=4.0, error=0.1), replace(one, rate=1.0, error=0.05)]
    assert rig_lag.orders(lags) == pytest.approx([2.0, 0.5])


@kills(
    "validation.cases.rotors.rig_lag:lag",
    "np.exp(-1j * exact_angle) / turn_mean(h.liquid_position",
    "np.exp(1j * exact_angle) / turn_mean(h.liquid_position",
)
@kills(
    "validation.cases.rotors.rig_lag:lag",
    "h.deflection[:, 0] * np.exp(-1j * h.angle)",
    "h.deflection[:, 0] * np.exp(1j * h.angle)",
)
def test_the_lag_of_a_known_run() -> None:
    """A run that shows the steady response, but for a tenth of the peak from half-way on."""
    time = np.linspace(0.0, 10.0, 12001)
    speed = np.linspace(rig_lag.FROM, rig_lag.TO, time.size)
    angle = rig_lag.FROM * time + 0.05 * (rig_lag.TO - rig_lag.FROM) * time**2
    exact, liquid = rig_lag.steady(speed, 0.1)
    added = 0.1j * np.abs(exact).max() * (speed > 1000.0 * RPM)
    turn = np.exp(1j * angle)
    history = SimpleNamespace(
        speed=speed,
        angle=angle,
        deflection=((exact + added) * turn)[:, None],
        liquid_position=0.02 * np.exp(-1j * (liquid + 0.3)),
        audit=SimpleNamespace(closure=0.0),
        converged=True,
    )
    with mock.patch.object(rig_lag, "run_up", lambda *_: history):
        found = rig_lag.lag(10.0, 0.1)
    # Means over turns smooth the steady curves: in a turn of 0.06 s the speed changes by 0.7 rad/s, of the
    # resonance's half width of 10 rad/s, by the square of which they differ.
    slack = (0.7 / 10.0) ** 2
    assert found.error == pytest.approx(0.1, abs=0.1 * slack)
    assert found.beyond == pytest.approx(0.1, abs=0.1 * slack)
    assert found.angle_error == pytest.approx(0.3, abs=slack)
    wanted = np.interp(np.array([600.0, 900.0, 1000.0, 1100.0, 1200.0, 1300.0]) * RPM, speed, liquid) + 0.3
    assert found.angles == pytest.approx(wanted, abs=slack)


@pytest.mark.slow
def test_the_lag_is_in_proportion_to_the_rate() -> None:
    """Next to the steady response a run-up differs by terms of the first order in its rate."""
    lags = [rig_lag.lag(rate, 0.1) for rate in (10.0, 5.0, 2.5)]
    assert all(one.converged for one in lags)
    # The second order is to the first as the first to the peak, a tenth at 10 rad/s^2; it bends the exponent
    # by as much.
    assert rig_lag.orders(lags) == pytest.approx([1.0, 1.0], abs=0.2)
    # The slowest is off by 2 % of the peak, hence by 3 deg or so where the amplitude is half of it: at 900 to
    # 1200 rpm. Below the liquid still swings from the start, above it whirls by itself.
    speed = np.array([900.0, 1000.0, 1100.0, 1200.0]) * RPM
    apart = np.degrees(lags[2].angles[1:5] - rig_lag.steady(speed, 0.1)[1])
    assert np.abs(apart).max() < 4.0


@pytest.mark.slow
def test_the_trends_over_volume() -> None:
    """An interior best volume for the peak; at the end nothing more once the wall is covered."""
    volumes = (0.1e-3, 0.25e-3, 0.5e-3, 1e-3, 2e-3)
    points = runup.sweep(volumes, (1.0,), cells=64, workers=1)
    assert all(one.converged for one in points)
    peaks = [one.peak for one in points]
    assert int(np.argmin(peaks)) == 2
    ends = np.array([one.end for one in points])
    steady = runup.steady_end(volumes)
    # What beats are left at k = 1/s after the hold of two seconds: exp(-2) of a few per cent.
    assert np.allclose(ends, steady, rtol=0.02)
    assert ends[0] > 1.04 * ends[1]
    # The peaks of the thick layers lie where whirl grows by itself, or above: it decays no faster than
    # friction lets it, at k, while the speed rises by 8 rad/s.
    low, high = runup.band(volumes, 1.0)
    for one, first, last in zip(points[3:], low[3:], high[3:], strict=True):
        assert first < one.peak_speed < last + runup.RAMP.rate / one.friction


def test_tables_and_figures() -> None:
    points = [runup.run(volume, 3.0, 8) for volume in (0.2e-3, 0.5e-3)]
    assert "| water, l | k = 3 |" in str(runup.table(points))
    peaks = runup.trend_figure(points, runup.run(0.0, 0.0, 8)).axes[0].lines[0].get_ydata()
    assert list(peaks) == [1e3 * point.peak for point in points]
    lags = [rig_lag.lag(rate, 0.1, cells=8) for rate in (80.0, 40.0)]
    assert "| steady response | " in str(rig_lag.tables(lags, 0.1)[1])
    assert list(rig_lag.lag_figure(lags, 0.1).axes[1].lines[0].get_xdata()) == [80.0, 40.0]


@kills(
    "validation.cases.rotors.rig_lag:steady",
    "answer.deflection, -answer.liquid_angle",
    "answer.deflection_dry, -answer.liquid_angle",
)
def test_steady_response_of_the_rig() -> None:
    """At 1000 rpm, the resonance, the liquid is 90 deg behind and w = U0/(2 zeta m)."""
    deflection, angle = rig_lag.steady(np.array([1000.0]) * RPM, 0.1)
    assert angle[0] == pytest.approx(0.5 * math.pi, rel=1e-9)
    mass = 4.0 + sum(fill.full_mass for fill in horizontal_rig())
    assert deflection[0] == pytest.approx(-1j * 6e-4 / (2.0 * 0.1 * mass), rel=1e-9)
