"""The small curve in the corner of a film's frames, with a point that moves along it."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from leblanc.view.camera import INSET, font_file, letters
from leblanc.view.parts import Inset
from meshes.arrays import Array

WIDE, FINER = 0.4, 3  # width over that of the frame; drawn so much finer, for smooth edges
COLOURS = ("#D55E00", "#8A8F94")  # of the curves
INK = "#262626"
POINT = 0.35  # radius of the moving point over the size of the letters


def with_inset(shown: Any, inset: Inset) -> Any:
    """A frame with its curve in the upper right corner; pixels, shape (height, width, 3)."""
    from PIL import Image

    high, wide = shown.shape[:2]
    size = (round(WIDE * wide), round(INSET * high))
    frame = Image.fromarray(shown)
    frame.paste(_curve(inset, size, letters((wide, high))), (wide - size[0], 0))
    return np.asarray(frame, dtype=np.uint8)


def points_of(inset: Inset, values: Array, size: tuple[int, int], letter: int) -> Array:
    """A curve's points in its picture, pixels from the upper left corner, shape (n, 2).

    `size` of the picture and of its letters, pixels.
    """
    left, right, top, bottom = _field(len(inset.curves), size, letter)
    span, most = max(float(np.ptp(inset.across)), 1e-300), max(float(values.max()), 1e-300)
    x = left + (right - left) * (inset.across - inset.across[0]) / span
    return np.stack([x, bottom - (bottom - top) * values / most], axis=-1)


def point_at(inset: Inset, values: Array, size: tuple[int, int], letter: int) -> tuple[float, float]:
    """Where the moving point stands on a curve, pixels from the upper left corner; as `points_of`."""
    x, y = points_of(inset, values, size, letter).T
    return float(np.interp(inset.at, inset.across, x)), float(np.interp(inset.at, inset.across, y))


def _field(curves: int, size: tuple[int, int], letter: int) -> tuple[float, float, float, float]:
    """Left, right, upper and lower edge of the curves in their picture."""
    return letter, size[0] - 1.5 * letter, (1.3 * curves + 1.0) * letter, size[1] - 1.9 * letter


@lru_cache(maxsize=2)
def _fonts(letter: int) -> Any:
    from PIL import ImageFont

    path = font_file()
    return ImageFont.load_default() if path is None else ImageFont.truetype(str(path), letter)


def _curve(inset: Inset, size: tuple[int, int], letter: int) -> Any:
    """Picture of the curves, their names and the point on each."""
    from PIL import Image, ImageDraw

    fine = (FINER * size[0], FINER * size[1])
    step = FINER * letter
    image = Image.new("RGB", fine, "white")
    draw = ImageDraw.Draw(image)
    left, right, _, bottom = _field(len(inset.curves), fine, step)
    draw.line([(left, bottom), (right, bottom)], fill=INK, width=FINER)
    draw.text((right, bottom + 0.3 * step), inset.name, fill=INK, font=_fonts(step), anchor="ra")
    for k, (name, values) in reversed(list(enumerate(inset.curves))):
        points = points_of(inset, values, fine, step)
        colour = COLOURS[k % len(COLOURS)]
        draw.line([tuple(point) for point in points.tolist()], fill=colour, width=2 * FINER, joint="curve")
        draw.text((left, (0.4 + 1.3 * k) * step), name, fill=colour, font=_fonts(step))
        x, y = point_at(inset, values, fine, step)
        radius = POINT * step
        draw.ellipse([x - radius, y - radius, x + radius, y + radius], fill=colour, outline="white")
    return image.resize(size, Image.Resampling.LANCZOS)
