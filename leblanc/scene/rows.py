"""What a scene says, as a reader sees it: rows and tables of values in the units that engineers use."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from leblanc.core.units import LENGTH, UNBALANCE, in_rpm, number, with_unit
from meshes.baffles import Baffles

_UNIT = re.compile(r"(.*?)(?: \((.*)\))?")


@dataclass(frozen=True)
class Value:
    """One value in words."""

    text: str  #: the value, with its unit unless a table's head has it
    #: its own in the scene, then those of values that it is worked out from; none for a label
    paths: tuple[str, ...] = ()
    assumed: bool = False  #: no source gives it

    @property
    def path(self) -> str:
        """Path of the value itself; empty for a label."""
        return self.paths[0] if self.paths else ""

    def marked(self, assumed: Sequence[str]) -> Value:
        """The value with its mark: assumed where it, what it is part of or what it is worked out from is.

        `assumed`: paths in the scene, of values or of whole tables.
        """
        doubtful = any(
            own == path or own.startswith(f"{path}.") or path.startswith(f"{own}.")
            for own in self.paths
            for path in assumed
        )
        return replace(self, assumed=doubtful)


@dataclass(frozen=True)
class Row:
    """One value under one label, or a few that belong together."""

    label: str
    values: tuple[Value, ...]

    @property
    def path(self) -> str:
        """Path of the first value."""
        return self.values[0].path


@dataclass(frozen=True)
class RowTable:
    """Values of parts that there may be several of."""

    head: tuple[str, ...]  #: what a part is called, then a name for each column with its unit in brackets
    rows: tuple[tuple[Value, ...], ...]  #: the number of each part, then its values

    def single(self) -> Iterator[Row]:
        """Each value as a row of its own, with its unit."""
        for part, *values in self.rows:
            for name, value in zip(self.head[1:], values, strict=True):
                found = _UNIT.fullmatch(name)
                assert found is not None
                text = f"{value.text} {found[2]}" if found[2] else value.text
                if value.paths:
                    yield Row(f"{self.head[0]} {part.text}: {found[1]}", (replace(value, text=text),))


def row(label: str, text: str, *paths: str) -> Row:
    """Row of one value."""
    return Row(label, (Value(text, paths),))


_MOST = 6  # points of a motor's curve that are listed one by one


def curve_words(speeds: Sequence[float], torques: Sequence[float]) -> str:
    """A motor's curve, rad/s and N m, for readers; of many points both ends."""
    pairs = zip(speeds, torques, strict=True)
    points = [f"{number(torque)} N m at {in_rpm(speed)}" for speed, torque in pairs]
    if len(points) <= _MOST:
        return ", ".join(points)
    return f"{points[0]}, ..., {points[-1]} ({len(points)} points)"


def rpm(speed: float) -> str:
    """Speed of rad/s in both units."""
    return f"{in_rpm(speed)} ({number(speed)} rad/s)"


def mm(length: float) -> str:
    """Length of m in mm, for readers."""
    return with_unit(length, LENGTH)


def unbalance(size: float) -> str:
    """Unbalance of kg m, for readers."""
    return with_unit(size, UNBALANCE)


def three(values: Sequence[float], unit: float = 1.0) -> str:
    """Three SI values along x, y, z, times `unit`, for readers."""
    return ", ".join(number(float(f"{value * unit:.10g}")) for value in values)


def degrees(angle: float) -> str:
    """Angle of rad in degrees, for readers."""
    return number(math.degrees(angle))


def baffle_words(baffles: Baffles) -> str:
    """How many baffles, and from where to where, for readers."""
    inner = f"{mm(baffles.tip_radius)} from the axis" if baffles.tip_radius > 0.0 else "the axis"
    outer = f"{mm(baffles.wall_gap)} off the wall" if baffles.wall_gap > 0.0 else "the wall"
    return f"{baffles.count}, from {outer} to {inner}"
