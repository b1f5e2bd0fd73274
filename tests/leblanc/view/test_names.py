"""Names in pictures: none covers another, the machine or the texts; in films they stay where they are."""

from __future__ import annotations

from itertools import combinations, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import ImageFont

import leblanc.view.film as film_module
from leblanc.scene.scene import load_scene
from leblanc.studies.shapes.machine import mode_view, table_view
from leblanc.view.exciter import table_picture
from leblanc.view.film import Film, mode_film, mode_picture, runup_film, write_film
from leblanc.view.parts import Picture
from leblanc.view.picture import fill, plotter, point_camera
from tests.leblanc.view.test_picture import MACHINES
from tests.leblanc.view.views import EXAMPLES, scene, short_runup, show, working

Box = tuple[float, float, float, float]


def drawn_names(plot: Any) -> dict[str, Box]:
    """Names that a plotter holds with their boxes, pixels from the lower left corner."""
    import pyvista
    from matplotlib import font_manager

    font = font_manager.findfont("DejaVu Sans")
    height = plot.window_size[1]
    found = {}
    for actor in plot.actors.values():
        if isinstance(actor, pyvista.Label):
            plot.renderer.SetWorldPoint(*actor.position, 1.0)
            plot.renderer.WorldToDisplay()
            x, y, _ = plot.renderer.GetDisplayPoint()
            size = actor.prop.font_size
            wide, high = ImageFont.truetype(font, size).getlength(actor.input), 1.3 * size
            assert 0.0 < y < height
            found[actor.input] = (x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high)
    return found


def overlap(one: Box, other: Box) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def projected(plot: Any, points: np.ndarray) -> np.ndarray:
    """Where points of the picture stand, pixels, shape (n, 2)."""
    wide, high = plot.window_size
    matrix = plot.camera.GetCompositeProjectionTransformMatrix(wide / high, -1.0, 1.0)
    whole = np.array([[matrix.GetElement(j, k) for k in range(4)] for j in range(4)])
    x, y, _, w = whole @ np.column_stack([points, np.ones(len(points))]).T
    return np.column_stack([0.5 * wide * (x / w + 1.0), 0.5 * high * (y / w + 1.0)])


def texts(plot: Any) -> tuple[float, float]:
    """Upper edge of the texts at the foot of a picture and lower edge of those at its head, pixels."""
    import pyvista

    high = plot.window_size[1]
    props = plot.renderer.GetViewProps()
    found = [props.GetItemAsObject(k) for k in range(props.GetNumberOfItems())]
    lines = [prop for prop in found if isinstance(prop, pyvista.Text) and not isinstance(prop, pyvista.Label)]
    at = [(prop.position[1] * high, prop.prop.font_size) for prop in lines]
    foot = max(y + size for y, size in at if y < 0.5 * high)
    return foot, min(y for y, _ in at if y > 0.5 * high)


def pictures() -> list[Picture]:
    found = [working(name).picture for name in MACHINES]
    # Machines of other shapes: a standing tub, a tall drum, one without chambers, supports far away.
    feet = [[x, -0.43, z] for x, z in ((0.26, 0.25), (-0.26, 0.25), (-0.26, -0.25), (0.26, -0.25))]
    for name, more in (("tub", {"cabinet.feet": feet}), ("two_plane_rig", {})):
        found.append(show(scene(name).replace({"rotor.axis": "vertical"} | more)).picture)
    found.append(show(scene("tub").replace({"chambers": []})).picture)
    far = {"stiffness": 4e4, "damping": 80.0}
    supports = [far | {"position": -3.0}, far | {"position": 2.0}]
    found.append(show(scene("two_plane_rig").replace({"rotor.supports": supports}), 60.0).picture)
    found.append(table_picture(table_view(load_scene(EXAMPLES / "vibratory_table.toml"))))
    return [*found, mode_picture(mode_view(scene("centrifuge"), 3))]


def check_names(plot: Any, picture: Picture) -> None:
    boxes = drawn_names(plot)
    assert len(boxes) == len(picture.labels) > 0
    for one, other in combinations(boxes, 2):
        assert not overlap(boxes[one], boxes[other]), (picture.title, one, other)
    wide = plot.window_size[0]
    for name, box in boxes.items():
        assert box[0] >= 0.0 and box[2] <= wide, (picture.title, name)
    foot, head = texts(plot)
    for piece in picture.pieces:
        height = projected(plot, piece.points[:: max(1, len(piece.points) // 100)])[:, 1]
        assert height.min() > foot and height.max() < head, (picture.title, piece.name)
    # Faces of the liquid and of what carries it, by their corners.
    for piece in picture.pieces:
        if piece.cells.shape[1] < 3 or piece.look == "hole":
            continue
        at = projected(plot, piece.points[:: max(1, len(piece.points) // 400)])
        for name, box in boxes.items():
            inside = (at[:, 0] > box[0]) & (at[:, 0] < box[2]) & (at[:, 1] > box[1]) & (at[:, 1] < box[3])
            assert not inside.any(), (picture.title, piece.name, name)


def test_names_cover_nothing() -> None:
    for picture in pictures():
        plot = plotter(picture)
        try:
            check_names(plot, picture)
        finally:
            plot.close()


@pytest.mark.parametrize("size", [(640, 900), pytest.param((800, 600), marks=pytest.mark.slow)])
def test_names_cover_nothing_in_other_views(size: tuple[int, int]) -> None:
    from leblanc.view.camera import VIEWS, layout

    for name in ("tub", "centrifuge", "two_plane_rig"):
        picture = working(name).picture
        plot = plotter(picture, size)
        try:
            for view in VIEWS:
                placed = layout(picture, size, view)
                fill(plot, picture, placed)
                point_camera(plot, picture, placed)
                check_names(plot, picture)
        finally:
            plot.close()


def names_of_film(film: Film, monkeypatch: pytest.MonkeyPatch, folder: Path) -> list[dict[str, Box]]:
    """Names of every frame as they are drawn, without drawing them."""
    seen: list[dict[str, Box]] = []

    def look(plot: Any) -> np.ndarray:
        seen.append(drawn_names(plot))
        return np.zeros((600, 800, 3), dtype=np.uint8)

    monkeypatch.setattr(film_module, "pixels", look)
    write_film(film, folder / "frames")
    return seen


@pytest.mark.parametrize("name", ["washing_machine", pytest.param("runup", marks=pytest.mark.slow)])
def test_names_stay_in_a_film(name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    frames = names_of_film(runup_film(short_runup(name)), monkeypatch, tmp_path)
    check_film(frames)


def test_names_stay_in_a_film_of_a_mode(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    check_film(names_of_film(mode_film(mode_view(scene("centrifuge"), 3), 8), monkeypatch, tmp_path))


def check_film(frames: list[dict[str, Box]]) -> None:
    assert len(frames) > 2
    for before, after in pairwise(frames):
        assert before.keys() == after.keys()
        # Within two pixels of each other: the eye sees no jump.
        for name in before:
            assert np.abs(np.subtract(before[name], after[name])).max() < 2.0, name
