"""Films: a machine swept through its speeds or run up in time, the liquid's own modes; GIF, MP4 or PNG."""

from __future__ import annotations

import math
import shutil
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from leblanc.core.files import writing
from leblanc.core.notes import one_line
from leblanc.core.units import DEGREE, LENGTH, RPM, in_rpm, unit_for, with_unit
from leblanc.plotting.bodies import (
    BallView,
    DrawnLiquid,
    LiquidBodies,
    LiquidShape,
    MachineMotion,
    ModeView,
    RunupView,
    Scale,
)
from leblanc.view.balls import ball_still, with_balls
from leblanc.view.camera import INSET, font_file, layout, letters
from leblanc.view.parts import Inset, Instant, Picture, Stage
from leblanc.view.picture import Pixels, fill, pixels, plotter, write_png
from leblanc.view.scene import compose, stage_of, still
from meshes.arrays import Array, Complex
from meshes.bodies.body import columns
from meshes.errors import InputError

FRAMES, MOST_FRAMES, RATE = 60, 600, 15  # frames a second; a GIF counts in hundredths of a second
FILM_SIZE = (800, 600)  # pixels; video codecs want even numbers
COLOURS = 128  # of a GIF

TURN = math.radians(18.0)  # of the drum from frame to frame at the highest speed

ROUND = 48  # frames of a period


@dataclass(frozen=True)
class Film:
    """Pictures one after the other, all seen by the camera of the first."""

    count: int  #: how many
    picture: Callable[[int], Picture]  #: draws one of them


def sweep_film(
    motion: MachineMotion, scale: Scale, liquid: Callable[[int], DrawnLiquid], frames: int = FRAMES
) -> Film:
    """Steady states over the speeds of a machine, evenly chosen, in at most so many frames.

    `liquid` gives it as drawn at the speed of an index; `scale` is common to all frames.
    """
    require_frames(frames)
    last = motion.speed.size - 1
    chosen = np.unique(np.linspace(0, last, min(frames, last + 1)).round().astype(int)).tolist()
    stage = stage_of(motion, scale)
    # The drum turns in proportion to its speed, by no more from frame to frame than the eye can follow.
    turn = TURN * np.cumsum(motion.speed[chosen]) / motion.speed[chosen].max()
    said = (
        f"From frame to frame spin and whirl turn by {math.degrees(TURN):.0f}{DEGREE} at the highest speed."
    )
    known = np.isfinite(motion.response.amplitude)
    across, found = motion.speed[known], motion.response.amplitude[known]
    name = f"amplitude, up to {with_unit(float(found.max(initial=0.0)), LENGTH)}"

    def picture(k: int) -> Picture:
        index = chosen[k]
        shown = still(motion, index, liquid(index), stage, float(turn[k] - turn[0]), said)
        if across.size < 2:
            return shown
        return replace(shown, inset=Inset(across, ((name, found),), float(motion.speed[index]), "speed"))

    return Film(len(chosen), picture)


def ball_film(view: BallView, frames: int = FRAMES) -> Film:
    """Steady states over the speeds of a machine with balls, evenly chosen, in at most so many frames."""
    require_frames(frames)
    speed, amplitude = view.result.speed, view.result.amplitude
    chosen = np.unique(np.linspace(0, speed.size - 1, min(frames, speed.size)).round().astype(int)).tolist()
    turn = TURN * np.cumsum(speed[chosen]) / speed[chosen].max()
    said = (
        f"From frame to frame spin and whirl turn by {math.degrees(TURN):.0f}{DEGREE} at the highest speed."
    )
    known = np.isfinite(amplitude)
    name = f"amplitude, up to {with_unit(float(amplitude[known].max(initial=0.0)), LENGTH)}"

    def picture(k: int) -> Picture:
        index = chosen[k]
        shown = ball_still(view, index, float(turn[k] - turn[0]), said)
        if known.sum() < 2:
            return shown
        inset = Inset(speed[known], ((name, amplitude[known]),), float(speed[index]), "speed")
        return replace(shown, inset=inset)

    return Film(len(chosen), picture)


def require_frames(frames: int) -> None:
    """Raise an `InputError` for a number of frames that no film can have."""
    if not 2 <= frames <= MOST_FRAMES:
        raise InputError("--frames", frames, f"from 2 to {MOST_FRAMES}")


def runup_film(view: RunupView) -> Film:
    """A run-up in time, with the layers as they are at each moment."""
    stage = Stage(
        fills=view.fills,
        places=view.places,
        lying=view.result.axis == "horizontal",
        scale=view.scale,
        swing=view.scale.deflection * float(abs(view.frames.deflection).max()),
        zero="unbalance" if view.result.kind == "jeffcott" else "angle 0",
        parts=view.parts,
    )
    result = view.result
    time, speed, amplitude = result.whole_curve()
    most, top = with_unit(float(amplitude.max()), LENGTH), in_rpm(float(speed.max()))
    curves = ((f"amplitude, up to {most}", amplitude), (f"speed, up to {top}", speed))

    def picture(k: int) -> Picture:
        inset = Inset(time, curves, float(view.frames.time[k]), "time")
        instant = _instant(stage, view, k)
        shown = compose(stage, instant)
        if view.races:
            shown = with_balls(shown, stage, instant, view.races, view.balls[k])
        return replace(shown, inset=inset)

    return Film(view.frames.time.size, picture)


def _instant(stage: Stage, view: RunupView, k: int) -> Instant:
    """One frame of a run-up."""
    frames, planes = view.frames, view.result.planes
    found = tuple(map(complex, frames.deflection[k]))
    spread = [j for j in range(len(found)) if planes[j] != planes[0]]
    lean = (found[spread[0]] - found[0]) / (planes[spread[0]] - planes[0]) if spread else 0j
    rings = [view.fills[race.ring].chamber.plane for race in view.races]
    if rings:
        liquids = found[: len(view.fills) - len(rings)]
        found = (*liquids, *(found[0] + lean * (plane - planes[0]) for plane in rings))
    speed, name = float(frames.speed[k]), one_line(view.result.name)
    unit = unit_for(LENGTH, float(frames.amplitude.max()))  # one for all frames
    wet = any(fill.volume > 0.0 for fill in view.fills)
    state = [f"t = {frames.time[k]:.2f} s, amplitude {unit.text(frames.amplitude[k])}"]
    state += [f"liquid model {view.result.model}"] if wet or not view.races else []
    caption = [
        stage.scale.in_words(),
        f"Spin, and whirl that goes with it, are {view.slower:g} times slower than they are.",
        *(["The surface stands upright along the axis."] if wet or not view.races else []),
        view.parts.sketched,
    ]
    if rings:
        caption.append("Races are rings as wide as their balls; balls at one place lie side by side.")
    if rings and view.result.kind != "jeffcott" and not spread:
        caption.append("How the axis leans is not kept in a run-up with chambers in fewer than two planes.")
    if stage.lying:
        caption.append("Liquid that gravity holds at the bottom is drawn as a pool.")
    return Instant(
        deflection=found,
        lean=lean,
        bodies=view.bodies[k],
        title=f"{name}: run-up, {speed * RPM:.0f} rpm ({speed:.1f} rad/s)",
        state="\n".join(state),
        caption=" ".join(caption),
        turn=float(view.turn[k]),
    )


def write_film(film: Film, path: Path, drawn: Callable[[int, int], None] | None = None) -> int:
    """Write a film whole or not at all, the same each time; the number of its frames.

    `path`: a .gif, an .mp4 if there is an ffmpeg, or a folder for one PNG each. `drawn` is called after each
    frame with the number of frames drawn and of all.
    """
    kind = require_film(path)
    shown: list[Pixels] = []
    first = film.picture(0)
    placed = layout(first, FILM_SIZE)  # names stay where they are in the first frame
    plot = plotter(first, FILM_SIZE)
    try:
        for k in range(film.count):
            picture = first if k == 0 else film.picture(k)
            if k > 0:
                fill(plot, picture, placed)
            inset = picture.inset
            shown.append(pixels(plot))
            if inset is not None:
                shown[-1] = with_inset(shown[-1], inset)
            if drawn is not None:
                drawn(k + 1, film.count)
    finally:
        plot.close()
    if kind == ".gif":
        _write_gif(shown, path)
    elif kind == ".mp4":
        _write_mp4(shown, path)
    else:
        for k, image in enumerate(shown, start=1):
            write_png(image, path / f"frame_{k:04d}.png")
    return film.count


def require_film(path: Path) -> str:
    """Ending of a film's path, empty for a folder; an `InputError` for an .mp4 without an ffmpeg."""
    kind = path.suffix.lower()
    if kind not in (".gif", ".mp4", ""):
        raise InputError(
            "--animate", str(path), "a file that ends in .gif or .mp4, or a folder for PNG files"
        )
    if kind == ".mp4" and shutil.which("ffmpeg") is None:
        raise InputError("--animate", str(path), "a .gif, since no ffmpeg was found to write an .mp4")
    if kind == "" and path.exists() and not path.is_dir():
        raise InputError("--animate", str(path), "a folder, or a new name; this is a file")
    return kind


def _write_gif(shown: Sequence[Pixels], path: Path) -> None:
    """All frames in the colours of the middle one, so that what is fixed is stored once."""
    from PIL import Image

    spread = Image.Quantize.MAXCOVERAGE  # small things keep their colour
    palette = Image.fromarray(shown[len(shown) // 2]).quantize(
        COLOURS, method=spread, dither=Image.Dither.NONE
    )
    frames = [Image.fromarray(image).quantize(palette=palette, dither=Image.Dither.NONE) for image in shown]
    with writing(path) as part:
        frames[0].save(
            part,
            format="gif",
            save_all=True,
            append_images=frames[1:],
            duration=round(100 / RATE) * 10,
            loop=0,
            optimize=False,
        )


def _write_mp4(shown: Sequence[Pixels], path: Path) -> None:
    high, wide = shown[0].shape[:2]
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{wide}x{high}", "-r", str(RATE), "-i", "-"]
    coded = ["-pix_fmt", "yuv420p", "-fflags", "+bitexact", "-flags:v", "+bitexact"]
    with writing(path) as part, TemporaryDirectory() as folder:
        whole = Path(folder) / "film.mp4"
        command = ["ffmpeg", "-y", "-loglevel", "error", *raw, *coded, str(whole)]
        done = subprocess.run(
            command, input=b"".join(image.tobytes() for image in shown), capture_output=True, check=False
        )
        if done.returncode != 0:
            said = done.stderr.decode(errors="replace").strip().splitlines()
            reason = said[-1] if said else "ffmpeg failed"
            raise InputError("--animate", str(path), f"a .gif, since ffmpeg cannot write this: {reason}")
        shutil.copyfile(whole, part)


def _moment(displacement: Complex, phase: float, lift: float) -> Array:
    """Displacement at a phase, m."""
    return np.asarray(lift * (displacement * np.exp(-1j * phase)).real)


def _body_of(mode: ModeView, phase: float, lift: float) -> LiquidBodies:
    """Liquid of a mode between walls of any shape."""
    section, displacement = mode.section, mode.section_displacement
    assert section is not None and displacement is not None
    moved = _moment(displacement, phase, lift)
    away = np.hypot(*section.points.T)
    # As on the surface of a ring: the area per angle swings.
    points = section.points * np.sqrt(1.0 + 2.0 * moved / away)[:, None]
    surface = np.zeros(len(points), dtype=bool)
    surface[section.surface] = True
    height = mode.fill.chamber.height
    full, none = np.full(len(points), height), np.zeros(len(points), dtype=bool)
    body = columns(points, section.cells, full, height, none, surface, layers=1, order=2)
    return LiquidBodies(0j, (body,))


def shape_of(mode: ModeView, phase: float, lift: float) -> LiquidShape | LiquidBodies:
    """Liquid of a mode at a phase sigma t of its oscillation, rad, with the largest displacement `lift`, m.

    The area per angle swings, so that the volume stays.
    """
    if mode.section is not None:
        return _body_of(mode, phase, lift)
    chamber, size = mode.fill.chamber, mode.fill.chamber.radius - mode.drawn_depth
    moved = _moment(mode.displacement, phase, lift)
    free = np.sqrt(np.maximum(size**2 + 2.0 * size * moved, chamber.inner_radius**2))
    free = np.minimum(free, chamber.radius)[:, None]
    count = mode.angle.size
    outer, inner = np.full(count, chamber.radius), np.full(count, chamber.inner_radius)
    height = np.repeat(np.array([[0.0, chamber.height]]), count, axis=0)
    return LiquidShape(0j, mode.angle, inner, outer, np.repeat(free, 2, axis=1), height)


def mode_picture(mode: ModeView, phase: float = 0.0) -> Picture:
    """Picture of a mode at a phase sigma t of its oscillation, rad."""
    scale = Scale(depth=mode.depth_factor)
    stage = Stage((mode.fill,), (0.0,), mode.lying, scale, 0.0, zero="", gravity=not mode.lying)
    sense = "with the spin" if mode.frequency > 0.0 else "against the spin"
    crests = f"{mode.crests} crest{'s' if mode.crests > 1 else ''}"
    if mode.fill.chamber.section is not None:
        crests = f"between walls of its own shape; of its harmonics the strongest has {crests}"
    if mode.fill.chamber.baffles is not None:
        crests = f"between baffles; of its harmonics the strongest has {crests}"
    caption = [
        "The height of the wave is arbitrary, as linear theory has it; it is drawn "
        f"{100.0 * mode.lift / mode.drawn_depth:.0f} % of the layer's depth high.",
        "Seen from the drum.",
    ]
    if mode.depth_factor > 1.0:
        caption.insert(1, f"The layer is drawn {mode.depth_factor:g} times as deep as it is, walls to scale.")
    if mode.gravity > 0.0:
        caption.append("Gravity across the axis is left out.")
    instant = Instant(
        deflection=(0j,),
        lean=0j,
        bodies=(shape_of(mode, phase, mode.lift),),
        title=f"{one_line(mode.name)}: sloshing mode {mode.number} at {in_rpm(mode.speed)}",
        state=f"{crests} around, {sense}\n{abs(mode.frequency):.4g} rad/s seen from the drum",
        caption=" ".join(caption),
    )
    return replace(compose(stage, instant), above=True)


def mode_film(mode: ModeView, frames: int = ROUND) -> Film:
    """One period of a mode in so many frames."""
    sense = 1.0 if mode.frequency > 0.0 else -1.0
    # The phase sigma t runs backwards for a wave against the spin.
    return Film(frames, lambda k: mode_picture(mode, sense * 2.0 * math.pi * k / frames))


WIDE, FINER = 0.4, 3  # width over that of the frame; drawn so much finer, for smooth edges
_CURVES = ("#D55E00", "#8A8F94")  # of the curves
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
        colour = _CURVES[k % len(_CURVES)]
        draw.line([tuple(point) for point in points.tolist()], fill=colour, width=2 * FINER, joint="curve")
        draw.text((left, (0.4 + 1.3 * k) * step), name, fill=colour, font=_fonts(step))
        x, y = point_at(inset, values, fine, step)
        radius = POINT * step
        draw.ellipse([x - radius, y - radius, x + radius, y + radius], fill=colour, outline="white")
    return image.resize(size, Image.Resampling.LANCZOS)
