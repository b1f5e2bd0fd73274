"""Where the camera of a three-dimensional picture stands, and where words lie round the machine."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from leblanc.view.parts import Label, Picture
from meshes.arrays import Array

# Shares of the room between the texts that the machine fills.
HIGH, WIDE = 0.96, 0.94
LETTER = 1.0 / 52.0  # size of the letters over the height of the picture
LINE, TOP, BOTTOM = 1.4, 0.985, 0.012  # height of a line over its letters; first and last line in the picture
INSET = 0.2  # height of a film's curve over that of the picture, from the top
FONT = "DejaVuSans.ttf"  # matplotlib's, which knows more characters than VTK's own
GAP, PAD = 0.9, 0.25  # between a name and the machine; round a name's letters: over the size of the letters
EDGE = 10.0  # least distance of names from the picture's edge, pixels
FARTHER, TRIES = 1.04, 24  # of the camera's view, until all names fit in it

# Directions from which the camera looks, and what is up: standing, lying, lying and long; and other views.
FRONT = {
    "standing": ((0.35, -1.0, 0.75), (0.0, 0.0, 1.0)),
    "above": ((0.35, -1.0, 1.6), (0.0, 0.0, 1.0)),
    "lying": ((1.0, -0.45, 0.3), (0.0, 0.0, 1.0)),
    "long": ((1.0, -1.15, 0.55), (0.0, 0.0, 1.0)),
}
VIEWS = ("oblique", "along the axis", "from the side")


@dataclass(frozen=True)
class Sight:
    """A camera with parallel projection."""

    focus: Array  #: what it points at, mm, shape (3,)
    right: Array  #: unit vectors to the right, upwards and towards the eye, shape (3,)
    over: Array
    back: Array
    half: float  #: half the height of what it sees, mm
    size: tuple[int, int]  #: of the picture, pixels

    @property
    def scale(self) -> float:
        """Scale of the picture, pixels per mm."""
        return 0.5 * self.size[1] / self.half

    def project(self, points: Array) -> Array:
        """Where points of mm, (n, 3), lie in the picture, pixels from its lower left corner, shape (n, 2)."""
        away = (points - self.focus) @ np.stack([self.right, self.over], axis=-1)
        return np.asarray(0.5 * np.array(self.size) + self.scale * away)

    def lift(self, pixel: Array, beside: Array) -> Array:
        """The point behind a place in the picture, as far away as the point `beside`, mm, shape (3,).

        `pixel` from the lower left corner.
        """
        x, y = (pixel - self.project(beside[None])[0]) / self.scale
        return np.asarray(beside + x * self.right + y * self.over)


@dataclass(frozen=True)
class Placed:
    """A name in a picture."""

    text: str  #: the name
    #: left, lower, right and upper edge, pixels from the lower left corner
    box: tuple[float, float, float, float]

    @property
    def middle(self) -> Array:
        """Middle of its box, pixels, shape (2,)."""
        left, low, right, high = self.box
        return np.array([0.5 * (left + right), 0.5 * (low + high)])


@dataclass(frozen=True)
class Layout:
    """Camera and names of a picture, or of all pictures of a film."""

    sight: Sight  #: the camera
    names: tuple[Placed, ...]  #: one for each label of the picture, in their order


def letters(size: tuple[int, int]) -> int:
    """Size of the letters in a picture, pixels."""
    return round(LETTER * size[1])


def words_of(picture: Picture, size: tuple[int, int]) -> tuple[list[str], list[str]]:
    """Lines of text above and below the machine in a picture of so many pixels."""
    most = int(size[0] / (0.58 * letters(size))) - 3
    above = [textwrap.shorten(picture.title, int(most / 1.3), placeholder="..."), *picture.state.split("\n")]
    return above, textwrap.wrap(picture.caption, most)


def layout(picture: Picture, size: tuple[int, int], view: str = VIEWS[0]) -> Layout:
    """Camera and names so that the machine fills the room between the texts and no name covers another or it.

    `size` in pixels; `view` is one of `VIEWS`.
    """
    sight, room = _camera(picture, size, view)
    points = np.concatenate([picture.frame, *(piece.points for piece in picture.pieces)])
    # A camera that only sees more has the same outline.
    outline = points[ConvexHull(sight.project(points)).vertices]
    for _ in range(TRIES):
        names = _names(picture.labels, sight, sight.project(outline), room)
        if all(name.box[0] >= EDGE and name.box[2] <= size[0] - EDGE for name in names):
            break
        # The camera that sees more, the middle of the room where it was.
        shift = (sight.size[1] - sum(room)) / sight.size[1] * sight.half * (FARTHER - 1.0)
        sight = replace(sight, half=FARTHER * sight.half, focus=sight.focus + shift * sight.over)
    return Layout(sight, names)


def _room(picture: Picture, size: tuple[int, int]) -> tuple[float, float]:
    """Lower and upper edge of the room between the texts, pixels."""
    above, below = words_of(picture, size)
    line = LINE * letters(size)
    high = TOP * size[1] - (len(above) + 0.9) * line
    if picture.inset is not None:
        high = min(high, (1.0 - INSET) * size[1])
    return BOTTOM * size[1] + (len(below) + 0.4) * line, high


def _camera(picture: Picture, size: tuple[int, int], view: str) -> tuple[Sight, tuple[float, float]]:
    """Camera whose picture has the machine in the middle of the room between the texts; that room."""
    towards, up = _direction(picture, view)
    back = np.array(towards) / np.linalg.norm(towards)
    right = np.cross(np.array(up), back)
    right /= np.linalg.norm(right)
    over = np.cross(back, right)
    low, high = _room(picture, size)
    middle = picture.frame.mean(axis=0)
    spread = [(picture.frame - middle) @ axis for axis in (right, over)]
    half = (
        0.5 * size[1] * max(np.ptp(spread[1]) / (HIGH * (high - low)), np.ptp(spread[0]) / (WIDE * size[0]))
    )
    away = [0.5 * (values.max() + values.min()) for values in spread]
    # The middle of the room lies below or above that of the picture.
    shift = (size[1] - low - high) * half / size[1]
    focus = middle + away[0] * right + (away[1] + shift) * over
    return Sight(focus, right, over, back, float(half), size), (low, high)


def _direction(picture: Picture, view: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if view == VIEWS[1]:
        return ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)) if picture.lying else ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
    if view == VIEWS[2]:
        return (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)
    if not picture.lying:
        return FRONT["above" if picture.above else "standing"]
    return FRONT["long" if picture.long else "lying"]


def _names(
    labels: tuple[Label, ...], sight: Sight, edge: Array, room: tuple[float, float]
) -> tuple[Placed, ...]:
    """Names on both sides of the machine, as high as what they name, pushed apart.

    `edge`: the machine's convex outline, pixels, shape (n, 2).
    """
    if not labels:
        return ()
    size = letters(sight.size)
    anchors = sight.project(np.array([label.place for label in labels]))
    middle = 0.5 * (edge[:, 0].max() + edge[:, 0].min())
    high = 1.35 * size + 2.0 * PAD * size
    boxes: dict[int, Placed] = {}
    for left in (True, False):
        side = [k for k in range(len(labels)) if (anchors[k, 0] < middle) == left]
        side.sort(key=lambda k: (anchors[k, 1], k))
        heights = _apart(anchors[side, 1], high, room)
        for k, height in zip(side, heights.tolist(), strict=True):
            wide = width(labels[k].text, size) + 2.0 * PAD * size
            ends = _extent(edge, height - 0.5 * high - 0.3 * size, height + 0.5 * high + 0.3 * size)
            near, far = (anchors[k, 0], anchors[k, 0]) if ends is None else ends
            start = near - GAP * size - wide if left else far + GAP * size
            box = (start, height - 0.5 * high, start + wide, height + 0.5 * high)
            boxes[k] = Placed(labels[k].text, box)
    return tuple(boxes[k] for k in range(len(labels)))


def _apart(wanted: Array, high: float, room: tuple[float, float]) -> Array:
    """Heights nearest to those wanted, in rising order, at least so far apart and inside the room."""
    count = wanted.size
    if count == 0:
        return wanted
    # With the least distance taken from each, rising order is all that is asked: means of those that collide.
    steps = high * np.arange(count)
    blocks: list[tuple[float, int]] = []
    for value in (wanted - steps).tolist():
        blocks.append((value, 1))
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            (last, many), (before, more) = blocks.pop(), blocks.pop()
            blocks.append(((last * many + before * more) / (many + more), many + more))
    level = np.concatenate([np.full(many, value) for value, many in blocks])
    low, top = room[0] + 0.5 * high, room[1] - 0.5 * high - steps[-1]
    return np.asarray(np.clip(level, low, max(low, top)) + steps)


def _extent(edge: Array, low: float, high: float) -> tuple[float, float] | None:
    """Left and right end of a convex outline between two heights; None where it has nothing there."""
    after = np.roll(edge, -1, axis=0)
    inside = edge[(edge[:, 1] >= low) & (edge[:, 1] <= high), 0].tolist()
    for level in (low, high):
        cut = (edge[:, 1] - level) * (after[:, 1] - level) < 0.0
        start, end = edge[cut], after[cut]
        share = (level - start[:, 1]) / (end[:, 1] - start[:, 1])
        inside += (start[:, 0] + share * (end[:, 0] - start[:, 0])).tolist()
    return (min(inside), max(inside)) if inside else None


def font_file() -> Path | None:
    """File of the font of all texts; None where it is missing."""
    spec = find_spec("matplotlib")
    path = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf" / FONT if spec and spec.origin else None
    return path if path is not None and path.exists() else None


@lru_cache(maxsize=256)
def width(text: str, size: int) -> float:
    """Width of a line of text in letters of a size, pixels."""
    from PIL import ImageFont

    path = font_file()
    if path is None:
        return 0.65 * size * len(text)
    return float(ImageFont.truetype(str(path), size).getlength(text))
