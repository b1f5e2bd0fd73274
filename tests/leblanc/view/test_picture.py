"""The composed picture: what the printed factor promises, where the liquid lies, that it can be rendered."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fluid.waves import free_wave_frequencies
from leblanc.plotting.bodies import LiquidShape, Scale
from leblanc.scene.scene import Speeds, load_scene
from leblanc.studies.run.motion import SelfExcited
from leblanc.studies.run.study import run_scene
from leblanc.studies.shapes.machine import machine_motion, mode_view, table_view
from leblanc.studies.shapes.scale import scale_of
from leblanc.view.camera import VIEWS, layout
from leblanc.view.exciter import table_picture
from leblanc.view.files import write_picture
from leblanc.view.film import Film, mode_film, mode_picture, shape_of, write_film
from leblanc.view.parts import Picture
from leblanc.view.picture import SIZE, fill, pixels, plotter, point_camera, prepare_off_screen
from leblanc.view.scene import describe_state
from meshes.errors import InputError
from tests.leblanc.view.test_surfaces import CHORD, centroid
from tests.leblanc.view.views import EXAMPLES, Shown, film_over, picture_at, scene, show, working
from tests.mutants import kills

MACHINES = sorted(
    path.stem
    for path in EXAMPLES.glob("*.toml")
    if path.stem
    not in (
        "vibratory_table",
        "blood_pump",
        "spindle",
        "balls",
        "balls_and_liquid",
        "balls_design",
        "long_rotor",
        "measured_balls",
    )
)


def across(picture: Picture, name: str) -> np.ndarray:
    """Points of all pieces of that name across the axis, complex, mm."""
    points = np.concatenate([one.points for one in picture.pieces if one.name == name])
    first = 1 if picture.lying else 0
    return np.asarray(points[:, first] + 1j * points[:, first + 1])


def middle_of_circle(points: np.ndarray) -> complex:
    """Centre of a closed circle of points, the last one the first."""
    return complex(np.mean(points.reshape(-1, 181)[0, :-1]))


def test_can_draw() -> None:
    """Skip where there is nothing to draw with."""
    try:
        prepare_off_screen()
    except InputError as error:
        pytest.skip(str(error))


# -- geometry ------------------------------------------------------------------------------------------------


def test_factor() -> None:
    # The rim's centre stands off the axis of rotation by the deflection times the factor that is printed.
    for name in MACHINES:
        view = working(name)
        for k in range(len(view.motion.fills)):
            centre = middle_of_circle(across(view.picture, f"rim {k + 1}"))
            true = complex(view.motion.deflection[-1, k]) * 1e3
            # Means over 180 points are exact for a circle, to rounding of the radius.
            assert abs(centre - view.scale.deflection * true) < 1e-9, name
        if view.scale.deflection != 1.0:
            assert f"{view.scale.deflection:g} times" in view.picture.caption
        assert abs(across(view.picture, "axis at rest")).max() == 0.0


def test_direction() -> None:
    # Drawn liquid lies where the answer says: same angle about the axis of rotation, at a centrifugal field
    # far above gravity. All chambers move alike, so the mean over them does too.
    for name in ("horizontal_rig", "vertical_rig", "washing_machine", "runup", "centrifuge"):
        view = working(name)
        answer = view.motion.response.response
        drawn = sum(centroid(one) for one in view.liquid.bodies if isinstance(one, LiquidShape))
        turned = drawn * np.exp(-1j * float(answer.liquid_angle[-1]))
        assert abs(np.angle(turned)) < 1e-3, name


def test_liquid_fills_its_walls() -> None:
    # What is wet all round touches the drawn wall everywhere, and the free surface is a circle about the axis
    # of rotation: the body belongs to the deflection that is drawn.
    for name in ("horizontal_rig", "two_plane_rig", "washing_machine"):
        view = working(name)
        for k, fill_ in enumerate(view.motion.fills):
            centre = middle_of_circle(across(view.picture, f"rim {k + 1}"))
            away = np.abs(across(view.picture, f"liquid {k + 1}") - centre)
            assert away.max() == pytest.approx(fill_.chamber.radius * 1e3, rel=1e-9)
            assert np.ptp(np.abs(across(view.picture, f"surface {k + 1}"))) < 1e-9


def test_table() -> None:
    table = table_view(load_scene(EXAMPLES / "vibratory_table.toml"))
    picture = table_picture(table)
    slow, fast, factor = table.slow, table.fast, table.factor
    arrow = picture.piece("vibration").points
    assert np.linalg.norm(arrow[1] - arrow[0]) == pytest.approx(1e3 * factor * (slow + fast), rel=1e-12)
    # Far above resonance the unbalance shakes the table by m e/M; corrections are of the order of the square
    # of natural over shaft frequency, (382/6000)^2 = 0.4 %.
    assert fast == pytest.approx(10.5e-3 / (90.1 + 2 * 0.325), rel=1e-2)
    balls = picture.piece("balls").points
    assert np.allclose(np.hypot(balls[:, 1], balls[:, 2]), 73.5)
    assert f"{factor:g} times" in picture.caption


def test_spin_and_unbalance() -> None:
    for name in ("runup", "horizontal_rig"):
        picture = working(name).picture
        centre = middle_of_circle(across(picture, "rim 1"))
        turned = np.unwrap(np.angle(across(picture, "spin") - centre))
        assert np.all(np.diff(turned) > 0.0)
        mark = complex(across(picture, "unbalance")[0]) - centre
        # On the wall, along the real axis.
        assert mark.imag == pytest.approx(0.0, abs=1e-9)
        assert mark.real == pytest.approx(max(f.chamber.radius for f in scene(name).fills) * 1e3)


@kills(
    "leblanc.studies.shapes.machine:_lean",
    "(high - low) / np.ptp(planes)",
    "(low - high) / np.ptp(planes)",
)
def test_axis_of_the_drum() -> None:
    # It runs through the middles of the chambers as they are drawn, in both planes of the rotor.
    view = show(scene("two_plane_rig"))
    line = next(one for one in view.picture.pieces if one.name == "axis of the drum").points
    for k, place in enumerate(view.motion.places):
        share = (place * 1e3 - line[0, 0]) / (line[1, 0] - line[0, 0])
        point = line[0] + share * (line[1] - line[0])
        centre = middle_of_circle(across(view.picture, f"rim {k + 1}"))
        assert complex(point[1], point[2]) == pytest.approx(centre, abs=1e-9)


@kills("leblanc.studies.shapes.machine:_lean", "for place in (-0.5, 0.5)", "for place in (0.5, -0.5)")
def test_lean_of_one_chamber() -> None:
    # With one chamber the slope comes from the rotor's coordinates: the same as between two chambers, the
    # second one empty, at another plane.
    tub = scene("tub")
    one = machine_motion(tub, 40.0)
    ring = tub.chambers[0]
    far = ring.altered(plane=ring.plane - 0.2, volume=0.0)
    two = machine_motion(tub.altered(chambers=(ring, far)), 40.0)
    assert abs(one.lean[0]) > 0.0
    assert complex(one.lean[0]) == pytest.approx(complex(two.lean[0]), rel=1e-6)


def test_same_answer_as_run() -> None:
    machine = scene("washing_machine")
    sight, record = machine_motion(machine), run_scene(machine)
    assert np.array_equal(sight.deflection[:, 0], record.response.deflection)


@kills("leblanc.studies.shapes.machine:places_of", "behind -= height", "behind -= 0.0 * height - behind")
def test_chambers_apart() -> None:
    # Chambers of a planar rotor that do not nest are drawn one behind the other; rings that nest stay.
    apart = show(scene("horizontal_rig"))
    assert apart.motion.moved
    assert abs(apart.motion.places[0] - apart.motion.places[1]) > 0.02
    assert "one behind the other" in apart.picture.caption
    nested = show(scene("vertical_rig"))
    assert not nested.motion.moved
    assert len(set(nested.motion.places)) == 1


def test_gravity_points_down() -> None:
    for name in ("runup", "horizontal_rig"):
        arrow = working(name).picture.piece("gravity").points
        down = arrow[1] - arrow[0]
        assert down[2] < 0.0
        assert np.abs(down[:2]).max() < 1e-9


def test_scale_bar() -> None:
    for name in ("runup", "horizontal_rig"):
        picture = working(name).picture
        bar = picture.piece("scale bar").points
        said = next(float(one.text[:-3]) for one in picture.labels if one.text.endswith(" mm"))
        assert np.linalg.norm(bar[1] - bar[0]) == pytest.approx(said, rel=1e-12)


def test_mode() -> None:
    machine = scene("centrifuge")
    fill_ = machine.fills[0]
    log = math.log(fill_.chamber.radius / fill_.surface_radius)
    for number in (1, 2, 3):
        mode = mode_view(machine, number)
        both = free_wave_frequencies(mode.crests, log, mode.speed)
        exact = float(both[0 if mode.frequency > 0.0 else 1])
        # 120 x 4 curved elements: about 1e-6 for the first modes.
        assert mode.frequency == pytest.approx(exact, rel=1e-5)
        # A crest of the drawn wave runs as sigma/n says: with the spin if sigma is above 0. It is the place
        # where the phase of n theta - sigma t is that of the lowest radius.
        lift, rest = mode.lift, fill_.chamber.radius - mode.drawn_depth
        # The layer is deepened to a quarter of the radius, or to half the room, for its wave to be seen.
        assert 0.9 * min(0.25, 0.5 * (1.0 - fill_.chamber.inner_radius / fill_.chamber.radius)) <= (
            mode.drawn_depth / fill_.chamber.radius
        )
        # Where the surface is displaced outwards, its radius is larger.
        outwards = shape_of(mode, 0.0, lift).radius[:, 0] - rest
        assert np.all(outwards * mode.displacement.real >= -1e-15)
        for phase in (0.0, 0.4):
            shape = shape_of(mode, math.copysign(phase, mode.frequency), lift)
            # The area per angle swings by a sine: no change over the whole circle.
            area = fill_.chamber.radius**2 - rest**2
            assert shape.volume() == pytest.approx(math.pi * area * fill_.chamber.height, rel=4.0 * CHORD)
        first, later = (
            np.sum(
                shape_of(mode, math.copysign(p, mode.frequency), lift).radius[:, 0]
                * np.exp(1j * mode.crests * mode.angle)
            )
            for p in (0.0, 0.4)
        )
        assert np.angle(later / first) == pytest.approx(math.copysign(0.4, mode.frequency), abs=0.02)


def test_a_dry_wall_is_said_and_drawn() -> None:
    view = show(scene("runup"), 24.0)
    assert "dry in part" in view.picture.state
    assert view.picture.caption.startswith("Everything to scale.")
    assert "wet all round" in show(scene("runup"), 90.0).picture.state


def test_a_view_tells_unstable_from_not_known() -> None:
    motion = show(scene("runup"), 90.0).motion
    assert "stab" not in " ".join(describe_state(motion, 0, (False,)))
    held = replace(motion.response.response, stable=np.array([False]))
    for growth, said in ((0.3, "not stable: this motion would not last"), (math.nan, "stability not known")):
        whirl = SelfExcited(np.array([growth]), np.array([70.0]), (), "Stokes")
        view = replace(motion, response=replace(motion.response, response=held, whirl=whirl))
        assert describe_state(view, 0, (False,))[-1] == said


def test_a_factor_that_dries_the_wall_says_so() -> None:
    machine = scene("runup")
    view = show(machine, 90.0, factor=8.0)
    assert "dry in part in the picture alone" in view.picture.caption


# -- rendering -----------------------------------------------------------------------------------------------


def shot(view: Shown) -> np.ndarray:
    plot = plotter(view.picture)
    try:
        return pixels(plot)
    finally:
        plot.close()


def test_the_picture_is_not_empty_and_always_the_same() -> None:
    view = working("horizontal_rig")
    one, other = shot(view), shot(view)
    assert one.shape == (SIZE[1], SIZE[0], 3)
    # The machine fills a good part of the middle; blue is the liquid.
    middle = one[200:760].astype(int)
    assert np.mean(np.any(middle < 250, axis=2)) > 0.1
    assert np.mean(middle[..., 2] > middle[..., 0] + 40) > 0.02
    assert np.array_equal(one, other)


def test_every_view_shows_the_whole_machine() -> None:
    small = (SIZE[0] // 2, SIZE[1] // 2)
    for name in ("two_plane_rig", "runup"):
        view = working(name)
        plot = plotter(view.picture, small)
        try:
            for way in VIEWS:
                placed = layout(view.picture, small, way)
                fill(plot, view.picture, placed)
                point_camera(plot, view.picture, placed)
                seen = pixels(plot).astype(int)
                # Nothing but white at the left and right edges: nothing is cut off.
                assert seen[:, [0, -1]].min() == 255, (name, way)
                assert np.mean(np.any(seen[100:380] < 250, axis=2)) > 0.02
        finally:
            plot.close()


def test_a_plotter_shows_what_was_put_in_last() -> None:
    motion = machine_motion(scene("runup"))
    scale = scale_of(motion)
    plot = plotter(picture_at(motion, 0, scale))
    try:
        first = pixels(plot)
        fill(plot, picture_at(motion, 75, scale))
        assert np.mean(np.any(pixels(plot) != first, axis=2)) > 0.01
    finally:
        plot.close()


def short_film() -> Film:
    machine = scene("runup").altered(speeds=Speeds(start=15.0, stop=30.0, count=3))
    return film_over(machine_motion(machine), Scale(), 3)


def test_films(tmp_path: Path) -> None:
    from PIL import Image

    assert write_film(short_film(), tmp_path / "film.gif") == 3
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames == 3
        shown = []
        for k in range(3):
            film.seek(k)
            shown.append(np.asarray(film.convert("RGB")))
    assert not np.array_equal(shown[0], shown[1])
    first = (tmp_path / "film.gif").read_bytes()
    write_film(short_film(), tmp_path / "film.gif")
    assert (tmp_path / "film.gif").read_bytes() == first
    assert write_film(short_film(), tmp_path / "frames") == 3
    assert sorted(p.name for p in (tmp_path / "frames").iterdir())[0] == "frame_0001.png"


def test_a_period_of_a_mode_closes() -> None:
    film = mode_film(mode_view(scene("runup"), 1), 4)
    assert film.count == 4
    assert "sloshing mode 1" in mode_picture(mode_view(scene("runup"), 1)).title


def test_a_page_needs_nothing_from_elsewhere(tmp_path: Path) -> None:
    pytest.importorskip("trame_pyvista")
    path = tmp_path / "page.html"
    write_picture(show(scene("runup"), 24.0).picture, path)
    text = path.read_text(encoding="utf-8")
    for foreign in ('src="http', "src='http", 'href="http', "@import", "unpkg.com", "cdn.", "/icon/"):
        assert foreign not in text, foreign
    assert "dry in part" in text
    assert "<title>Run-up: 229.2 rpm" in text
    assert "Content-Security-Policy" in text
