"""Figures of a wave show its values: signs of angles, units, areas and moments, frames of a film."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure
from matplotlib.markers import MarkerStyle

from leblanc.studies.layer import figure as wave
from leblanc.studies.layer import figure as wave_time
from leblanc.studies.layer.wave import Wave, WaveFrames

R, SURFACE, SPIN = 0.15, 0.135, 40.0


def eccentric(amplitude: float = 0.005, count: int = 720, turned: float = 0.0) -> Wave:
    """Synchronous whirl: the surface is a circle about the rotation axis, at -amplitude from the drum's.

    With `turned` the layer is drawn for a deflection at that angle of the frame, in which it is not at rest.
    """
    theta = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    surface = np.sqrt(SURFACE**2 - np.square(amplitude * np.sin(theta))) - amplitude * np.cos(theta)
    offset = SURFACE**2 * amplitude / (R**2 - SURFACE**2) * np.exp(1j * turned)
    return Wave(
        title="Layer of water",
        model="statics",
        radius=R,
        inner_radius=0.0,
        mean_depth=R - SURFACE,
        whirl_amplitude=amplitude,
        spin=SPIN,
        whirl_speed=SPIN,
        theta=theta + turned,
        depth=R - surface,
        force_ratio=complex(1.0),
        offset=complex(offset),
    )


def bore(whirl_speed: float = 30.0, count: int = 256) -> Wave:
    """A sawtooth that falls steeply at 60 degrees."""
    theta = np.linspace(-math.pi, math.pi, count, endpoint=False)
    share = np.mod(theta - math.pi / 3.0, 2.0 * math.pi) / (2.0 * math.pi) - 0.5
    return replace(
        eccentric(),
        model="long_wave",
        whirl_speed=whirl_speed,
        theta=theta,
        depth=0.015 + 0.016 * share,
        force_ratio=0.49 + 3.12j,
        offset=0.02 - 0.01j,
        notes=("mean rotation not converged in time",),
    )


def running(record: Wave, count: int = 50, duration: float = 0.5) -> WaveFrames:
    """The wave of a record, running round the drum with the deflection, which starts at 30 degrees."""
    time = np.linspace(0.0, duration, count)
    theta = np.linspace(0.0, 2.0 * math.pi, 360, endpoint=False)
    place = math.pi / 6.0 + record.seen_from_the_drum * time
    angle, depth = wave.unrolled(record.theta, record.depth)
    from_deflection = np.mod(theta - place[:, None] + math.pi, 2.0 * math.pi) - math.pi
    return WaveFrames(
        time=time,
        theta=theta,
        depth=np.interp(from_deflection, angle, depth),
        deflection=record.whirl_amplitude * np.exp(1j * place),
    )


def area_and_moment(x: np.ndarray, y: np.ndarray) -> tuple[float, complex]:
    """Of a polygon, by Green's theorem."""
    z = x + 1j * y
    following = np.roll(z, -1)
    cross = (np.conj(z) * following).imag
    return 0.5 * float(np.sum(cross)), complex(np.sum((z + following) * cross) / 6.0)


def marked(axes, gid: str):
    (found,) = [line for line in axes.lines if line.get_gid() == gid]
    return found


def labelled(axes, label: str):
    (found,) = [line for line in axes.lines if line.get_label() == label]
    return found


def ends(line) -> complex:
    """From the first point of a line to its last."""
    x, y = (np.asarray(values) for values in line.get_data())
    return complex(x[-1] - x[0], y[-1] - y[0])


def test_drawn_liquid_has_its_area_and_moment() -> None:
    """At exaggeration 1 the drawing is the layer: exact area, moment and centre of mass of two circles."""
    for turned in (0.0, 2.0):
        record = eccentric(turned=turned)
        angle, surface = wave.free_surface(R, record.theta, record.depth, 1.0)
        area, moment = area_and_moment(*wave.outline(R, angle, surface))
        exact = math.pi * (R**2 - SURFACE**2)
        # Chords half a degree long cut (step)^2/6 off each circle; off the moment no larger a share.
        cut = (math.pi / 360.0) ** 2 / 6.0 * math.pi * (R**2 + SURFACE**2)
        assert abs(area - exact) < cut
        assert abs(moment - record.offset * exact) < cut * record.whirl_amplitude


def test_profile_closes() -> None:
    """Linear across the back of the frame, so the value there is known, whatever the angles."""
    theta = np.array([0.4, 1.9, 2.8, 3.9, 5.0, 6.1])
    angle, depth = wave.unrolled(theta + 4.0 * math.pi, 1.0 + 0.1 * theta)
    assert angle[0] == -math.pi and angle[-1] == math.pi
    # Rounding of angles below 20.
    np.testing.assert_allclose(depth[[0, -1]], 1.0 + 0.1 * math.pi, rtol=1e-13)
    assert np.all(np.diff(angle) > 0.0)
    assert np.all(np.abs(np.exp(1j * angle[1:-1]) - np.exp(1j * np.roll(theta, 3))) < 1e-13)


def test_exaggeration_keeps_the_layer_between_the_walls() -> None:
    for inner, depth in ((0.0, 0.001), (0.1, 0.02), (0.12, 0.001), (0.0, 0.14)):
        record = replace(bore(), inner_radius=inner, mean_depth=0.5 * depth)
        factor = wave.depth_factor(record, depth)
        room = wave.FILLED * (R - inner)
        assert factor == 1.0 if depth > room else 1.0 < factor <= room / depth * (1.0 + 1e-9)
        drawn = wave.free_surface(R, record.theta, np.full(record.theta.shape, depth), factor)[1]
        np.testing.assert_allclose(drawn, R - factor * depth, rtol=1e-12)


def test_arrows_and_marks_have_their_directions() -> None:
    """Deflection to the right, force and centre of mass at their angles, which run with the spin."""
    for force in (2.0j, -1.0 - 1.0j, 0.3 + 0.0j):
        record = replace(bore(), force_ratio=force, offset=0.001 + 0.004j)
        axes = wave.wave_figure(record).axes[0]
        assert abs(np.angle(ends(marked(axes, "deflection")))) < 1e-12
        arrow = marked(axes, "force on the drum")
        assert abs(np.angle(ends(arrow) / force)) < 1e-12
        marker = MarkerStyle(arrow.get_marker())
        tips = marker.get_path().transformed(marker.get_transform()).vertices[:3] @ np.array([1.0, 1.0j])
        assert np.min(np.abs(np.angle(tips / force))) < 1e-9
        (x,), (y,) = labelled(axes, "liquid's centre of mass").get_data()
        assert math.isclose(x, 1.0) and math.isclose(y, 4.0)


def test_senses_of_rotation() -> None:
    """Counter-clockwise is the spin; a whirl against it is drawn clockwise."""
    for whirl, sense in ((30.0, 1.0), (-30.0, -1.0)):
        axes = wave.wave_figure(bore(whirl)).axes[0]
        for name, expected in (("spin", 1.0), ("whirl", sense)):
            x, y = marked(axes, name).get_data()
            assert np.all(expected * (x[:-1] * y[1:] - x[1:] * y[:-1]) > 0.0)


def test_profile_is_in_mm_over_degrees() -> None:
    record = bore()
    curve = labelled(wave.wave_figure(record).axes[1], "depth of the layer")
    angle, depth = curve.get_data()
    # The first angle is -180 degrees, which the closed curve has at its other end as well.
    np.testing.assert_allclose(angle[:-1], np.degrees(record.theta), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(depth, np.append(record.depth, record.depth[0]) * 1e3, rtol=1e-12)


def test_dry_places_are_those_without_liquid() -> None:
    depth = np.array([0.0, 0.0, 1e-7, 0.01, 0.0, 0.01, 0.02, 0.0])
    assert wave.is_dry(depth, 0.01).tolist() == [True, True, True, False, False, False, False, False]
    assert wave.is_dry(np.zeros(4), 0.0).all()


def test_film_is_in_the_frame_of_the_drum() -> None:
    """The crest keeps its 60 degrees from the deflection, which runs at the whirl less the spin."""
    for whirl in (30.0, -30.0, 55.0):
        record = bore(whirl)
        history = running(record)
        figure = Figure()
        left, right = figure.subplots(1, 2)
        show = wave_time.film(left, right, record, history)
        for index in (0, 7, 49):
            show(index)
            direction = np.exp(1j * (math.pi / 6.0 + (whirl - SPIN) * history.time[index]))
            assert abs(np.angle(ends(marked(left, "deflection")) / direction)) < 1e-9
            there = labelled(right, "angle of the deflection").get_xdata()[0]
            assert abs(np.angle(np.exp(1j * math.radians(there)) / direction)) < 1e-9
            angle, depth = labelled(right, "depth of the layer").get_data()
            crest = np.exp(1j * np.radians(angle[np.argmax(depth)]))
            # The crest lies on a point of the profile, a degree apart, and of the record, 1.4 degrees apart.
            assert abs(np.angle(crest / direction) - math.pi / 3.0) < math.radians(2.5)
            assert abs(depth.max() - record.depth.max() * 1e3) < 0.1
            x, y = left.patches[0].get_xy().T
            inner = np.hypot(x, y)[len(x) // 2 :]
            deepest = complex(x[len(x) // 2 + np.argmin(inner)], y[len(x) // 2 + np.argmin(inner)])
            assert abs(np.angle(deepest / crest)) < math.radians(1.0)


def test_frames_can_be_followed() -> None:
    """The deflection never turns so far from frame to frame that it seems to run backwards."""
    for whirl, duration in ((30.0, 1.0), (30.0, 100.0), (-60.0, 20.0)):
        record = bore(whirl)
        time = np.linspace(0.0, duration, 20001)
        still = WaveFrames(time, np.arange(3.0), np.zeros((time.size, 3)), np.zeros(time.size, dtype=complex))
        chosen = wave.frames(record, still)
        assert chosen.size <= 120 and chosen[-1] == 20000
        turn = abs(whirl - SPIN) * np.max(np.diff(time[chosen]))
        # A frame lies within half a recorded step of its place, at either end.
        assert turn < math.pi / 4.0 + abs(whirl - SPIN) * time[1]
        shown = time[-1] - time[chosen[0]]
        assert shown == duration or shown > 0.9 * 119.0 * math.pi / 4.0 / abs(whirl - SPIN)


def test_caption_converts() -> None:
    """40 rad/s are 381.97 rpm, 30 rad/s 286.48 rpm."""
    text = caption(wave.wave_figure(bore()))
    for part in ("spin 40 rad/s (382 rpm)", "whirl 30 rad/s (286.5 rpm)", "mean depth 15 mm"):
        assert part in text
    assert "\N{MINUS SIGN}10 rad/s seen from the drum" in text


def caption(figure) -> str:
    return str(figure.caption).replace("\N{NO-BREAK SPACE}", " ")


def test_a_layer_deeper_than_its_room_is_cut_at_the_inner_wall_and_said_to_be() -> None:
    record = bore()
    deepest = float(record.depth.max())
    for inner in (R - 0.5 * (record.mean_depth + deepest), 0.5 * R):
        figure = wave.wave_figure(replace(record, inner_radius=inner))
        axes = figure.axes[0]
        (liquid,) = [patch for patch in axes.patches if patch.get_label() == "liquid"]
        away = np.hypot(*liquid.get_path().vertices.T) * 1e-3
        assert inner * (1.0 - 1e-9) <= away.min() and away.max() <= R * (1.0 + 1e-9)
        assert ("cut at the inner wall" in figure.caption.shown) == (deepest > R - inner)
