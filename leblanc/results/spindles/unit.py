"""What `run` answers of a spindle unit: dynamic compliances over frequency, natural frequencies, shapes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays
from leblanc.core.netcdf import variable as var
from leblanc.results.motion.closed_forms import Cage
from meshes.arrays import Array, Complex

RECIPROCITY, WAYS = 1e-9, 1e-6  # relative differences up to which two ways to one answer agree


@dataclass(frozen=True)
class NaturalMode:
    """A natural motion without damping, and the damped answer to the force at its frequency."""

    frequency: float  #: rad/s
    #: of each beam places from its first station, m, and deflections, the largest of all being 1
    along: tuple[tuple[Array, Array], ...]
    stations: Array  #: deflection at each station, in the order of the result's names
    measured: complex  #: compliances at that frequency, m/N
    wanted: complex


@dataclass(frozen=True)
class SpindleResult(Result):
    """Answer to a unit harmonic force over its frequency; n frequencies, k natural ones, s stations.

    Examples
    --------
    >>> import leblanc as lb
    >>> result = lb.run(lb.example("spindle").replace({"speeds.count": 3}))
    >>> result.transmissibility.shape
    (3,)
    """

    figure: ClassVar[str] = "leblanc.figures.spindles.unit:compliance_figure"
    summary: ClassVar[str] = "leblanc.text.spindles.unit:facts"

    name: str  #: of the scene
    assumed: tuple[str, ...]  #: values that it assumes
    theory: str  #: of the beams
    driven_at: str  #: stations of the force, of the measurement, of what is asked for
    measured_at: str
    wanted_at: str
    beams: tuple[str, ...]  #: names of the beams
    stations: tuple[str, ...]  #: names of all stations, shape (s,)
    places: tuple[float, ...]  #: of the first station of each beam along the machine, m
    frequency: Array  #: of the force, rad/s, shape (n,)
    driven: Complex  #: displacement over the force at the three stations, m/N, shape (n,)
    measured: Complex
    wanted: Complex
    modes: tuple[NaturalMode, ...]  #: natural motions between the first and the last frequency
    #: largest relative difference of a compliance from that with force and motion exchanged
    reciprocity: float
    #: largest relative difference of the way by reactions in the joints from the exact assembly; nan where no
    #: joint is between two beams
    ways_apart: float
    #: smallest -Im of the compliance at the force over its size; not below 0 where joints only take energy
    least_dissipation: float
    source: str = ""  #: of the scene
    digest: str = ""
    rotation: float | None = None  #: of the spindle, rad/s; None where the scene does not say it
    cages: tuple[Cage, ...] = ()  #: of the joints whose balls are given, at that speed

    @property
    def cage_speed(self) -> dict[str, float]:
        """Speed of each cage without slip, rad/s, by its joint."""
        return {cage.name: float(cage.speed[0]) for cage in self.cages}

    @property
    def transmissibility(self) -> Complex:
        """W = q2/q1, of what is asked for over what is measured, shape (n,)."""
        return np.asarray(self.wanted / self.measured)

    @property
    def natural_frequency(self) -> Array:
        """All natural frequencies of the band without damping, rad/s, shape (k,)."""
        return np.array([mode.frequency for mode in self.modes])

    @property
    def compliance(self) -> dict[str, Complex]:
        """Displacement over the force by station: `driven`, `measured`, `wanted`, m/N, shape (n,)."""
        return {"driven": self.driven, "measured": self.measured, "wanted": self.wanted}

    @property
    def checks(self) -> dict[str, float | None]:
        """Whether two ways to one answer agree, by name."""
        ways = self.ways_apart if math.isfinite(self.ways_apart) else None
        return {
            "reciprocity": self.reciprocity,
            "ways_apart": ways,
            "least_dissipation": self.least_dissipation,
        }

    def to_json(self) -> dict[str, Any]:
        """What `run` prints for scripts: SI units, complex numbers as [re, im]."""
        return {
            "frequency": self.frequency.tolist(),
            "driven_at": self.driven_at,
            "measured_at": self.measured_at,
            "wanted_at": self.wanted_at,
            "compliance": {name: pairs(values) for name, values in self.compliance.items()},
            "transmissibility": pairs(self.transmissibility),
            "natural_frequency": self.natural_frequency.tolist(),
            "modes": [
                {
                    "frequency": mode.frequency,
                    "stations": dict(zip(self.stations, mode.stations.tolist(), strict=True)),
                    "measured": [mode.measured.real, mode.measured.imag],
                    "wanted": [mode.wanted.real, mode.wanted.imag],
                }
                for mode in self.modes
            ],
            "checks": self.checks,
            **({"rotation": self.rotation, "cage_speed": self.cage_speed} if self.cages else {}),
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over `frequency`, `mode` and `station`; complex ones as real and imaginary part."""
        over, found = ("frequency",), {}
        names = {"driven": self.driven_at, "measured": self.measured_at, "wanted": self.wanted_at}
        for name, values in self.compliance.items():
            for part in ("real", "imag"):
                text = f"{part} part of the displacement of {names[name]} over the force at {self.driven_at}"
                found[f"{name}_{part}"] = var(over, getattr(values, part), "m N-1", "compliance", text)
        for part in ("real", "imag"):
            values = getattr(self.transmissibility, part)
            found[f"transmissibility_{part}"] = var(
                over, values, "1", "W", f"{part} part of wanted over measured"
            )
        shapes = np.array([mode.stations for mode in self.modes]).reshape(len(self.modes), len(self.stations))
        both = ("mode", "station")
        found["natural_frequency"] = var(("mode",), self.natural_frequency, "rad s-1", "natural frequency")
        found["mode_shape"] = var(both, shapes, "1", "deflection", "over the largest along all beams")
        return NamedArrays(
            found,
            coords={
                "frequency": var(over, self.frequency, "rad s-1", "frequency of the force"),
                "station": var(("station",), np.array(self.stations, dtype=object), "1", "station"),
            },
            attrs=attributes(self, "run", {"theory": self.theory}, ()),
        )


def pairs(values: Complex) -> list[list[float]]:
    """Complex numbers as JSON holds them.

    Parameters
    ----------
    values : shape (n,)
    """
    return np.stack([values.real, values.imag], axis=-1).tolist()  # type: ignore[no-any-return]
