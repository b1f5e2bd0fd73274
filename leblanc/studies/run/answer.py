"""The response of a machine to its unbalance over speed: what `run` answers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, fields
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer, input_lines
from leblanc.core.blocks import Block, Checks, Columns, Headline, Notes, Picture, Section, Table, Words
from leblanc.core.netcdf import NamedArrays
from leblanc.core.notes import Note
from leblanc.core.units import amplitude_sentence
from leblanc.liquid.choice import HELD_MODELS, ModelSpan
from leblanc.liquid.filled import FilledChamber
from leblanc.liquid.notes import BaffleCode
from leblanc.studies.closed_forms.answer import ClosedForms
from leblanc.studies.held.answer import MOTIONS, Held
from leblanc.studies.loads.answer import MachineLoads, bearing_tables, load_table
from leblanc.studies.run import words
from leblanc.studies.run.motion import Motion, SelfExcited
from leblanc.studies.run.notes import OF_MODELS, RunCode
from leblanc.studies.volume.answer import WallVolumes
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from meshes.quantity import Q
from solvers.synchronous.peaks import Peak, Resonance, highest, maxima
from solvers.synchronous.response import LAG, Response, by_speed

_CIRCLE = 1e-9  # of the deflection, that the part against the spin may have in a circle
STABILITY = ("not_known", "unstable", "stable")
# What there is none of without a chamber: an empty list for scripts, no variable in the data file.
OF_LIQUID = (
    *("liquid_offset", "liquid_angle", "dry_patch", "model", "error_estimate", "critical_speeds_wet"),
    *("chamber_deflection", "chamber_real", "chamber_imag", "critical_speed_wet", "capture_speed"),
    *("carried_from", "wetting_volume", "lid_volume", "full_volume"),
)
_OVER, _RATE, _FIGURES = ("speed",), "rad s-1", "leblanc.studies.run.figure"
_QUALITY = "unbalance over the rotor's mass, times the speed"
_CURVE = ("speed", "amplitude", "amplitude_dry")


def phase(deflection: NDArray[np.complex128]) -> Array:
    """Angle from the unbalance to the deflection, rad in (-pi, pi], negative for a lag; 0 for none."""
    angle = np.angle(deflection)
    angle = np.where(angle <= -math.pi, math.pi, angle)
    return np.where(deflection == 0.0, 0.0, angle)


def peak(deflection: NDArray[np.complex128] | Array) -> int | None:
    """Index of the largest deflection, the first of equals; None if there is no finite one."""
    size = np.abs(deflection)
    known = np.asarray(np.isfinite(size))
    return int(np.argmax(np.where(known, size, -1.0))) if known.any() else None


@dataclass(frozen=True)
class RunAnswer(Answer):
    """Response to the unbalance at each speed, the machine it belongs to, and what a reader must know.

    Raises
    ------
    InputError : no speed at all, an axis of another name, arrays of the response that do not fit together

    Examples
    --------
    >>> import leblanc as lb
    >>> result = lb.run(lb.example("horizontal_rig"))
    >>> result.models_used, result.to_dataset()["amplitude"].attrs["units"]
    (('linear',), 'm')
    """

    command, title = "run", "Response to the unbalance over speed"
    data, page = "response.nc", "summary.html"
    figure = f"{_FIGURES}:amplitude_figure"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: Annotated[tuple[str, ...], Q(text="paths of the values that no source gives")]
    inputs: tuple[tuple[str, str, str], ...]  #: label, value with its unit, field path
    digest: Annotated[str, Q(text="of the scene")]
    response: Annotated[Response, Q(part=True)]  #: the answer at each speed
    liquid_mass: Annotated[float, Q("kg", "liquid mass", "of all chambers")]
    notes: Annotated[tuple[Note, ...], Q(text="limits of validity and findings")]
    axis: str  #: "horizontal" or "vertical"
    chambers: tuple[FilledChamber, ...]  #: one for each chamber
    #: a ring of liquid can stand against gravity across the axis above it; None if at any
    capture_speed: Annotated[float | None, Q(_RATE, "centrifuging speed", "an annular layer exists above it")]
    #: of several the one at which the unbalance moves the axis most
    critical_speed_dry: Annotated[float, Q(_RATE, "critical speed without liquid", "undamped")]
    critical_speed_wet: Annotated[float, Q(_RATE, "critical speed with liquid", "undamped, wall wet")]
    motion: Annotated[Motion | None, Q(part=True)] = None  #: None for a planar rotor
    whirl: Annotated[SelfExcited | None, Q(part=True)] = None  #: None where it was not computed
    #: nan where there is none; None where nothing was estimated
    error_estimate: Annotated[
        Array | None,
        Q(
            *("1", "estimated error", "relative, of amplitude and liquid the larger one", _OVER),
            when="error_estimate",
        ),
    ] = None
    #: which liquid model answers at which speeds, how well, and why; empty where that is not known
    models: tuple[ModelSpan, ...] = ()
    tolerance: float | None = None  #: relative error that the scene allows; None where nothing was estimated
    #: where it takes that to find the largest amplitudes, by rising speed; None where nobody looked
    refined: Annotated[
        Response | None, Q(text="between the speeds asked for", prefix="refined", only=_CURVE, when="refined")
    ] = None
    #: [theory: balance_quality, eq. 1]; infinite where the motion is; None where no mass spins
    balance_quality: Annotated[
        Array | None,
        Q("m s-1", "balance quality", f"{_QUALITY}; rotor and liquid", _OVER, when="balance_quality"),
    ] = None
    balance_quality_dry: Annotated[
        Array | None,
        Q("m s-1", "balance quality", f"{_QUALITY}; without liquid", _OVER, when="balance_quality"),
    ] = None
    axial_gravity: float = 0.0  #: gravity along the axis, m/s^2
    #: of speeds at which the motion was integrated in time; None where it was at none
    held: Annotated[Held | None, Q(part=True)] = None
    #: forces and clearances at the speeds of `curve`; None where the scene asks for none
    loads: Annotated[MachineLoads | None, Q(part=True)] = None
    #: inf where nothing drags on the liquid; None where that is not asked or not known
    carried_from: Annotated[
        float | None, Q(_RATE, "speed of balance", "from rest the walls carry the liquid")
    ] = None
    #: at which the surface meets an edge of a chamber, for the deflection of this answer
    wall_volumes: Annotated[WallVolumes | None, Q(part=True)] = None
    #: analytical checks of the sources beside the answer; None where nobody asked
    closed_forms: Annotated[ClosedForms | None, Q(part=True)] = None

    def __post_init__(self) -> None:
        if self.axis not in ("horizontal", "vertical"):
            raise InputError("rotor.axis", self.axis, "horizontal or vertical")
        count = self.response.speed.size
        if self.response.speed.ndim != 1 or count == 0:
            raise InputError("speeds", self.response.speed.shape, "a list of at least one speed")
        branches = self.response.branch_deflection.shape
        for each in fields(self.response):
            if each.name in ("coordinates", "branch_coordinates", "position", "over_time"):
                continue
            shape = getattr(self.response, each.name).shape
            expected = (count, *branches[1:]) if each.name.startswith("branch_") else (count,)
            if shape != expected:
                raise InputError(f"response.{each.name}", shape, f"of shape {expected}")

    @property
    def chamberless(self) -> bool:
        """The machine has no chamber: it is the one without liquid."""
        return not self.chambers

    @property
    def curve(
        self,
    ) -> Annotated[
        Response,
        Q(
            text="whole curve with its peaks",
            prefix="curve",
            only=(*_CURVE, "in_range"),
            when="refined",
        ),
    ]:
        return self.response if self.refined is None else by_speed([self.response, self.refined])

    @property
    def chamber_curve(self) -> Complex:
        """Deflection at each chamber at the speeds of `curve`, m, shape (n, c)."""
        if self.motion is None:
            return np.repeat(self.curve.deflection[:, None], len(self.chambers), axis=1)
        if self.refined is None:
            return self.motion.chamber_forward
        order = np.argsort(np.concatenate((self.speed, self.refined.speed)), kind="stable")
        return np.concatenate((self.motion.chamber_forward, self.motion.refined_forward))[order]

    @property
    def peak(self) -> dict[str, float]:
        """Largest amplitude over the range of speeds and where it is, m and rad/s.

        Of the speeds at which the answer holds: found and in the range of its model; of all where it holds at
        none. The amplitude is infinite where it has no bound; both are nan where nothing was found.
        """
        return asdict(self.highest)

    @property
    def peak_dry(self) -> dict[str, float]:
        """The same of the rotor without liquid, which is known at every speed."""
        return asdict(self.highest_dry)

    @property
    def highest(
        self,
    ) -> Annotated[Peak, Q(text="of the speeds at which the answer holds", prefix="peak", key="peak")]:
        return self.curve.peak

    @property
    def highest_dry(
        self,
    ) -> Annotated[Peak, Q(text="without liquid, at any speed", prefix="peak_dry", key="peak_dry")]:
        return highest(self.curve.speed, self.curve.amplitude_dry)

    @property
    def resonances(
        self,
    ) -> Annotated[tuple[Resonance, ...], Q(text="maxima of the curve, by rising speed", rows="resonance")]:
        return maxima(self.curve.speed, self.curve.amplitude)

    @property
    def resonances_dry(
        self,
    ) -> Annotated[tuple[Resonance, ...], Q(text="the same without liquid", rows="resonance_dry")]:
        return maxima(self.curve.speed, self.curve.amplitude_dry)

    @property
    def phase(self) -> Annotated[Array, Q("rad", "phase of the deflection", LAG, _OVER)]:
        return phase(self.response.deflection)

    @property
    def phase_dry(self) -> Annotated[Array, Q("rad", "phase without liquid", LAG, _OVER, json=False)]:
        return phase(self.response.deflection_dry)

    @property
    def stability(
        self,
    ) -> Annotated[
        NDArray[np.str_],
        Q(
            *("", "stability of the branch reported", "against slow disturbances and whirls", _OVER),
            flags=" ".join(STABILITY),
        ),
    ]:
        # Not known where no branch was found or the modes of the whirls were not. A time-domain state has
        # shown its stability itself; one that has not converged in time has not.
        kept = self.response.branch_stable.any(axis=1)
        growth = np.zeros(self.speed.shape) if self.whirl is None else self.whirl.growth
        lost = ~np.isfinite(self.response.deflection) | (kept & np.isnan(growth))
        if self.held is not None:
            growth = np.where(self.held.at, 0.0, growth)
            lost = np.where(self.held.at, self.held.not_settled, lost)
        state = np.where(lost & ~(growth > 0.0), 0, np.where(self.response.stable, 2, 1))
        return np.asarray(np.array(STABILITY)[state])

    @property
    def models_used(self) -> tuple[str, ...]:
        """Names of the liquid models, in the order in which they appear over speed."""
        return tuple(dict.fromkeys(self.curve.model.tolist()))

    @property
    def amplitude_min(self) -> Annotated[Array, Q("m", "least amplitude", "over time", _OVER)]:
        least = np.abs(np.abs(self.response.deflection) - np.abs(self.response.backward))
        found = np.where(np.isfinite(self.response.deflection), least, self.response.amplitude)
        return found if self.held is None else np.where(self.held.at, self.held.least, found)

    @property
    def amplitude_max(self) -> Annotated[Array, Q("m", "largest amplitude", "over time", _OVER)]:
        found = self.response.amplitude
        return found if self.held is None else np.where(self.held.at, self.held.largest, found)

    @property
    def state(
        self,
    ) -> Annotated[
        NDArray[np.str_],
        Q("", "state of the motion", "once it is settled", _OVER, flags=" ".join(MOTIONS)),
    ]:
        # A circle with the spin is steady, an ellipse periodic; a limit cycle never repeats with the turn. To
        # a steady answer that is unstable the machine does not settle.
        r = self.response
        ellipse = np.abs(r.backward) > _CIRCLE * np.abs(r.deflection)
        left = ~r.converged | (self.stability == "unstable")
        found = np.where(left, "not_settled", np.where(ellipse, "periodic", "steady"))
        return found if self.held is None else np.where(self.held.at, self.held.state, found)

    @property
    def cycling(self) -> Flags:
        """Where the answer of `curve` is a limit cycle, shape (p,)."""
        curve = self.curve
        return np.asarray(np.isin(curve.model, list(HELD_MODELS)) & curve.converged & ~curve.stable)

    @property
    def unused(self) -> tuple[str, ...]:  # type: ignore[override]  # of a frozen class, not set
        return (*(("model",) if self.chamberless else ()), "runup", "optimise")

    @property
    def own(self) -> Mapping[str, Any]:
        model = {} if self.chamberless else {"model": ", ".join(self.models_used)}
        return {"inputs": input_lines(self.inputs), **model, "axis": self.axis}

    @property
    def faults(self) -> tuple[str, ...]:
        return () if self.response.converged.all() else tuple(words.unanswered(self))

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.response.speed.size} speeds done"

    def to_json(self) -> dict[str, Any]:
        """Its quantities by name; without a chamber lists of the liquid are empty."""
        found = super().to_json()
        if self.chamberless:
            of_liquid = found.keys() & OF_LIQUID
            found |= {name: [] if isinstance(found[name], list) else None for name in of_liquid}
        return found

    def named_arrays(self) -> NamedArrays:
        """Its quantities as arrays with named dimensions; without a chamber none of liquid."""
        found = super().named_arrays()
        if not self.chamberless:
            return found
        kept = {name: each for name, each in found.variables.items() if name not in OF_LIQUID}
        return NamedArrays(kept, found.coords, found.attrs)

    def blocks(self) -> tuple[Block, ...]:
        head, rows = words.comparison_table(self)
        aside: tuple[Block, ...] = (
            Table(rows, head, shown="page"),
            words.resonance_table(self),
            Table(words.facts(self), shown="page"),
            words.mode_table(self),
            Checks(words.checks(self)),
        )
        elsewhere = (*(OF_MODELS if self.models else ()), RunCode.HELD)
        said = [note.text for note in self.notes if note.code not in elsewhere]
        pictures, effect = tuple(self._pictures()), words.effect(self)
        return (
            Headline(effect or words.answer(self), words.machine(self), words.headline_error(self)),
            # On a terminal a line each.
            *(Words(one, shown="text") for one in effect.replace(". On", ".\nOn").splitlines()),
            *([Words(words.answer(self), shown="page")] if effect else []),
            *([Words(unseen)] if (unseen := words.unseen(self)) else []),
            Table(rows, head, right=True, shown="text"),
            Words(amplitude_sentence(words.amplitude_place(self)), shown="text"),
            *(Words(note.text, shown="text") for note in self.notes if note.code in _SAID),
            *([] if self.loads is None else [load_table(self.loads), *bearing_tables(self.loads)]),
            Columns(pictures[:2], (*aside, *pictures[2:3]), wide=True),
            *pictures[3:],
            Section("Time-domain states", words.held_motions(self), shown="page"),
            *words.models_section(self),
            Notes((*said, *words.remarks(self)), shown="page"),
        )

    def _pictures(self) -> Iterator[Picture]:
        """Its figures; of few the phase stands in a file of its own."""
        wet, tilts, loaded = not self.chamberless, self.motion is not None, self.loads is not None
        few = wet and not tilts and not loaded
        phase_of = Picture("phase", "Phase of the deflection over speed", f"{_FIGURES}:phase_figure", few)
        yield Picture("amplitude", "Amplitude over speed", self.figure)
        if wet:
            yield Picture("liquid", "Liquid's centre of mass over speed", f"{_FIGURES}:liquid_figure")
        if not few:
            yield phase_of
        if wet:
            chamber = "leblanc.plotting.chambers:chamber_figure"
            yield Picture("chamber", "Chamber seen along the axis", chamber)
        if few:
            yield phase_of
        if self.wall_volumes is not None and np.isfinite(self.wall_volumes.full_volume).any():
            of_volumes = f"{_FIGURES}:volumes_figure"
            yield Picture("volumes", "Volumes that wet the wall over speed", of_volumes, alone=True)
        if tilts:
            yield Picture("campbell", "Natural frequencies over speed", f"{_FIGURES}:campbell_figure")
        if loaded:
            yield Picture("machine", "Clearances and forces on the floor", f"{_FIGURES}:loads_figure")


_SAID = (RunCode.LEFT_OUT, BaffleCode.CLOSED_COMPARTMENTS)  # on a terminal as well
