"""What a liquid model is: asked with whirls, it answers with force, centre of mass, range and error.

Every solver that needs the liquid asks such an object in the same way, with many whirls at once. A model that
also knows the wave of one whirl has `wave`, from which its `answer` follows. Complex numbers of an answer are
seen along the deflection: the real part lies along it, the imaginary part 90 deg ahead of it in the sense of
the spin.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import ClassVar, Protocol

import numpy as np

from fluid import waves
from fluid.fill import Fill, Fills
from fluid.numbers import whirl_numbers
from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.wave_error import largest_whirl

# What is left between an exact answer and the same from another order of sums.
ROUNDING = 1e-12

Range = tuple[float, float]
# Ranges that models share. The flow between the wall layers is free of vorticity only while they are thin.
CAPTURED: Range = (1.0, math.inf)
THIN_LAYERS: Range = (0.0, 0.2)
LONG: Range = (0.0, 0.3)
SMOOTH: Range = (0.0, 1.0)  # whirl over the largest that a smooth wave follows
_ACROSS = 1e-9  # of the pull, that may be rounding
_MOST_CRESTS = 64  # of a free wave


@dataclass(frozen=True)
class Whirl:
    """A circular whirl of the drum's axis."""

    spin: float  #: Omega, rad/s, > 0
    speed: float  #: omega_w in space, rad/s
    amplitude: float  #: m
    ramp: float = 0.0  #: time over which the amplitude grows from nothing, s
    gravity: float = 0.0  #: across the axis, m/s^2

    def __post_init__(self) -> None:
        require_positive("speed", self.spin)
        require_not_negative("whirl_amplitude", self.amplitude)
        require_not_negative("ramp", self.ramp)
        require_not_negative("gravity", self.gravity)
        if not math.isfinite(self.speed) or self.speed == 0.0:
            raise InputError("whirl_speed", self.speed, "a finite number other than 0")

    @property
    def slip(self) -> float:
        """Whirl speed seen from the drum, s = omega_w - Omega, rad/s."""
        return self.speed - self.spin

    @property
    def detuning(self) -> float:
        """p^2 = (1 - Omega/omega_w)^2: what nonlinear waves take of the speeds [theory: potential, eq. 9]."""
        return (self.slip / self.speed) ** 2

    @property
    def period(self) -> float:
        """Time of one whirl seen from the drum, or of one turn of a synchronous one, s."""
        return 2.0 * math.pi / (abs(self.slip) or self.spin)


def drag_frequency(fill: Fill, whirl: Whirl) -> float:
    """Frequency in the drum of what moves the liquid, for laminar friction, rad/s, 0 or above.

    The slip of a whirl, or the spin under gravity across the axis. Under both, that at which the drag takes
    as much as from the two small waves apart: the roots of the frequencies weighted with their energies
    [theory: friction, eq. 11].
    """
    if whirl.gravity == 0.0:
        return abs(whirl.slip)
    if whirl.amplitude == 0.0 or whirl.slip == 0.0 or not 0.0 < fill.surface_radius < fill.chamber.radius:
        return whirl.spin
    kappa = (fill.chamber.radius / fill.surface_radius) ** 2
    wave = abs(float(waves.displacement_ratio(kappa, whirl.speed / whirl.spin))) * whirl.amplitude
    if not math.isfinite(wave):
        return abs(whirl.slip)
    own = (whirl.slip * wave) ** 2
    other = (whirl.spin * float(waves.gravity_displacement(kappa, whirl.spin, whirl.gravity))) ** 2
    root = (own * math.sqrt(abs(whirl.slip)) + other * math.sqrt(whirl.spin)) / (own + other)
    return root**2


def grown(time: Array | float, ramp: float) -> Array:
    """Share to which a whirl has grown, tau - sin(2 pi tau)/(2 pi), tau = time/ramp up to 1; 1 at ramp 0."""
    if ramp == 0.0:
        return np.ones_like(time, dtype=float)
    part = np.minimum(np.asarray(time) / ramp, 1.0)
    return np.asarray(part - np.sin(2.0 * math.pi * part) / (2.0 * math.pi))


@dataclass(frozen=True)
class Whirls:
    """n circular whirls, one for each of the fills that are asked about; all shapes (n,).

    Attributes
    ----------
    spin : spin speed of the drum Omega, rad/s, above 0
    speed : whirl speed omega in space, rad/s, positive with the spin, other than 0
    deflection : of the chamber's axis, m, complex or real; 0 asks for the limit of a small one
    axial_gravity : gravity along the axis, m/s^2
    gravity : gravity across the axis, m/s^2
    """

    spin: Array
    speed: Array
    deflection: Array | Complex
    axial_gravity: Array
    gravity: Array

    @classmethod
    def synchronous(cls, spin: Array, deflection: Array | Complex, axial_gravity: Array) -> Whirls:
        """Whirls with the spin, without gravity across the axis."""
        return cls(spin, spin, deflection, axial_gravity, np.zeros(spin.shape))

    @classmethod
    def of(cls, whirl: Whirl) -> Whirls:
        """One whirl as arrays, without gravity along the axis."""
        values = (whirl.spin, whirl.speed, whirl.amplitude, 0.0, whirl.gravity)
        return cls(*(np.array([value]) for value in values))

    @property
    def slip(self) -> Array:
        """Whirl speeds seen from the drum, s = omega - Omega, rad/s."""
        return self.speed - self.spin

    @property
    def amplitude(self) -> Array:
        """Sizes of the deflections, m."""
        return np.asarray(np.abs(self.deflection))

    def at(self, which: Index) -> Whirls:
        """Those at some indices, shape (m,)."""
        return Whirls(*(getattr(self, name)[which] for name in self.__dataclass_fields__))

    def whirl(self, k: int) -> Whirl:
        """A single one of them."""
        spin, speed, size, gravity = self.spin[k], self.speed[k], abs(self.deflection[k]), self.gravity[k]
        return Whirl(float(spin), float(speed), float(size), gravity=float(gravity))


@dataclass(frozen=True)
class LiquidAnswer:
    """The liquid's answer to n whirls; all shapes (n,), complex numbers along the deflection.

    Attributes
    ----------
    unbalance : U, the force over the whirl speed squared, kg m: where the liquid stands still in the whirl's
        frame its first moment about the rotation axis; 0 without a deflection
    slope : derivative of U with respect to the deflection at fixed volume, kg; nan where it is not known
    offset : liquid's centre of mass from the chamber's axis, m; told of a prescribed whirl, while the
        response takes the centre of mass from U over the liquid's mass
    dry_patch : whether the wall is dry over its whole height somewhere
    converged : whether the answer was found; elsewhere its numbers do not count
    limits : by its name each limit of the model, and where it is kept
    error : estimated error of U, at rest relative, of waves over the larger of U and a full chamber's; nan
        where the model has no estimate

    Examples
    --------
    >>> from leblanc import Chamber, Liquid
    >>> fills = Fills.of([Fill(Chamber(radius=0.2, height=0.05), Liquid("water", 1000.0, 1e-6), 1e-3)])
    >>> whirls = Whirls.synchronous(np.array([50.0]), np.array([1e-3]), np.zeros(1))
    >>> LiquidAnswer.at_rest(fills, whirls, fills.mass * whirls.amplitude, fills.mass).unbalance
    array([0.001+0.j])
    """

    unbalance: Complex
    slope: Array | Complex
    offset: Complex
    dry_patch: Flags
    converged: Flags
    limits: Mapping[str, Flags]
    error: Array

    @classmethod
    def at_rest(
        cls,
        fills: Fills,
        whirls: Whirls,
        unbalance: Array,
        slope: Array,
        dry_patch: Flags | None = None,
        converged: Flags | None = None,
        limits: Mapping[str, Flags] | None = None,
        error: Array | float = math.nan,
    ) -> LiquidAnswer:
        """Answer of liquid at rest in the drum, which only a synchronous whirl leaves it in.

        Arguments as of the class, the unbalance real; None: the wall is wet, every answer is found, no other
        limit holds.
        """
        yes = np.ones(unbalance.shape, dtype=bool)
        mass = fills.mass
        centre = np.divide(unbalance, mass, out=np.zeros_like(unbalance), where=mass > 0.0)
        still = (whirls.slip == 0.0) & (whirls.gravity == 0.0)
        return cls(
            unbalance=unbalance.astype(complex),
            slope=slope,
            offset=(centre - whirls.amplitude).astype(complex),
            dry_patch=~yes if dry_patch is None else dry_patch,
            converged=yes if converged is None else converged,
            limits={"synchronous": still, **(limits or {})},
            error=np.broadcast_to(error, unbalance.shape),
        )

    @classmethod
    def joined(cls, parts: Sequence[LiquidAnswer]) -> LiquidAnswer:
        """Answers one behind the other; a limit that a part does not have is kept there."""
        found = {
            item.name: np.concatenate([getattr(part, item.name) for part in parts])
            for item in fields(cls)
            if item.name != "limits"
        }
        limits = {
            name: np.concatenate([part.limits.get(name, np.ones_like(part.converged)) for part in parts])
            for name in dict.fromkeys(name for part in parts for name in part.limits)
        }
        return cls(**found, limits=limits)

    def at(self, which: Index) -> LiquidAnswer:
        """Those at some indices, shape (m,)."""
        found = {item.name: getattr(self, item.name)[which] for item in fields(self) if item.name != "limits"}
        return LiquidAnswer(**found, limits={name: kept[which] for name, kept in self.limits.items()})

    @property
    def in_range(self) -> Flags:
        """Whether every limit of the model is kept."""
        kept = np.ones(self.converged.shape, dtype=bool)
        for limit in self.limits.values():
            kept &= limit
        return kept

    def real_unbalance(self) -> Array:
        """Unbalance of liquid that pulls along the deflection alone, kg m.

        An `InputError` where some pulls across it, as liquid does that does not stand still in the drum.
        """
        across = np.abs(self.unbalance.imag) > _ACROSS * np.abs(self.unbalance)
        if across.any():
            allowed = "real: liquid at rest in the drum, on which the synchronous response rests"
            raise InputError("unbalance", complex(self.unbalance[across][0]), allowed)
        return np.asarray(self.unbalance.real)

    def force(self, whirls: Whirls) -> Complex:
        """Force on the chamber in the standing frame at the instant of the deflections, N."""
        towards = np.exp(1j * np.angle(whirls.deflection))
        return np.asarray(np.square(whirls.speed) * self.unbalance * towards)


class LiquidModel(Protocol):
    """Model of the liquid in chambers that spin and whirl.

    Solvers take it as an object. A class that inherits from it needs a name and `answer`; any object that has
    them is a model of one's own for `lb.run(scene, model=...)` and `lb.map_whirl`. Its forces may be complex:
    what pulls across the deflection drives or brakes the whirl. Its answers to small whirls of many
    frequencies, as seen from the drum, are the transfer function from which growth rates come.

    The synchronous response finds every branch only of a built-in model, which is at rest in a synchronous
    whirl: its unbalance is then real, and less the liquid's mass times the deflection it never falls as that
    grows. Of a model of one's own branches are followed from speed to speed.

    Examples
    --------
    >>> class Frozen(LiquidModel):
    ...     name = "frozen"  # the liquid moves with the drum like a solid ring
    ...
    ...     def answer(self, fills, whirls):
    ...         yes = np.ones(len(fills), dtype=bool)
    ...         return LiquidAnswer(
    ...             unbalance=fills.mass * whirls.amplitude + 0j,
    ...             slope=fills.mass,
    ...             offset=0j * fills.mass,
    ...             dry_patch=~yes,
    ...             converged=yes,
    ...             limits={},
    ...             error=np.full(len(fills), np.nan),
    ...         )
    >>> import leblanc as lb
    >>> answer = lb.run(lb.example("horizontal_rig"), model=Frozen())
    >>> set(answer.model.tolist())
    {'frozen'}
    """

    #: Its liquid may pull across the deflection in a synchronous whirl, its law bend as it likes: branches
    #: are then followed from speed to speed. Of a model of one's own it is always taken for true.
    across: ClassVar[bool] = False

    @property
    def name(self) -> str:
        """Name in results, with the resolution if it has one."""
        ...

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """Answers of n fills to n whirls.

        Parameters
        ----------
        fills : one for each whirl, none of them empty
        whirls : of their axes; out of its range the model answers all the same, and says so
        """
        ...

    def pull(self, fills: Fills, whirls: Whirls) -> Array:
        """Unbalance of liquid that pulls along the deflection alone, kg m, shape (n,).

        A model that need not find the whole answer for it saves time; arguments and errors as of `answer` and
        `LiquidAnswer.real_unbalance`.
        """
        return self.answer(fills, whirls).real_unbalance()

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Deflection up to which the unbalance is exactly the full mass times the deflection, m, shape (n,).

        0, as here, is right for every model; a larger one saves time.

        Parameters
        ----------
        fills : shape (n,)
        speed : spin speed Omega, rad/s, shape (n,)
        gravity : along the axis, m/s^2, shape (n,)
        """
        return np.zeros(speed.shape)

    def added_mass(self, fills: Fills) -> Array:
        """Mass that the liquid adds in a small whirl with the spin, kg, shape (n,).

        That of the closed form [theory: sections, eq. 8], unless the model finds its own.

        Parameters
        ----------
        fills : shape (n,)
        """
        return fills.added_mass

    def steepest(self, fills: Fills) -> Array:
        """No smaller than the slope of the unbalance at any deflection, kg, shape (n,).

        The mass added in a small whirl, as here, where the law bends over and never up.

        Parameters
        ----------
        fills : shape (n,)
        """
        return self.added_mass(fills)


def added_mass_answer(
    fills: Fills, whirls: Whirls, error: Array | float = math.nan, added_mass: Array | None = None
) -> LiquidAnswer:
    """Answer of small synchronous whirls, to which a layer adds a mass [theory: waves, eq. 8].

    It holds while the deflection is below the mean depth, or the least where a section is no circle.
    """
    size = whirls.amplitude
    added = fills.added_mass if added_mass is None else added_mass
    wet = size < fills.depth
    return LiquidAnswer.at_rest(
        fills,
        whirls,
        unbalance=added * size,
        slope=added,
        dry_patch=~wet & (size > 0.0),
        limits={"wave_amplitude": wet},
        error=error,
    )


@dataclass(frozen=True)
class LiquidWave:
    """Answer to one whirl with the wave that makes it."""

    answer: LiquidAnswer  #: of the whirl, shape (1,)
    theta: Array  #: angle from the deflection, rad, ascending, and depth of the layer there, m, shape (k,)
    depth: Array
    numbers: Mapping[str, float]  #: dimensionless numbers of the whirl and of the wave, by name
    ranges: Mapping[str, Range]  #: those that bound the model here, by name
    mass_error: float  #: of the surface drawn, relative
    mean_rotation: float = 0.0  #: of the liquid relative to the drum, rad/s
    counter: float = 0.0  #: size of the answer that goes round against the whirl over that with it
    reason: str = ""  #: why there is no answer, or empty


@dataclass(frozen=True)
class FreeWave:
    """A wave that runs round the drum by itself, in two senses with one shape."""

    #: at which its crests go round in space, behind the drum and ahead of it, rad/s
    whirl_speed: tuple[float, float]
    theta: Array  #: angle from a crest, rad, ascending, and depth of the layer there, m, shape (k,)
    depth: Array
    crest: float  #: greatest and least depth over that of the layer at rest
    trough: float
    crest_number: float  #: speed of the liquid at the crest over that of the crest
    numbers: Mapping[str, float]  #: as of `LiquidWave`
    ranges: Mapping[str, Range]
    converged: bool  #: the wave was found
    mass_error: float  #: of the surface drawn, relative
    #: estimated relative error of the speed along the wall; nan where there is no estimate
    error: float = math.nan
    branch: str = ""  #: kind of wave, where the model tells
    reason: str = ""  #: why there is no answer, or empty


class WaveModel(LiquidModel, Protocol):
    """Liquid model that knows the wave of a prescribed whirl; a class needs a name, `ranges` and `wave`."""

    # Chambers with baffles in the liquid, or a section of their own, are served as well.
    takes_baffles: ClassVar[bool] = False

    @property
    def solver(self) -> str:
        """Name in py-pde of what solves it; empty where that is not py-pde."""
        return ""

    @property
    def ranges(self) -> Mapping[str, Range]:
        """Dimensionless numbers that bound the model, each with its range."""
        ...

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """Answer of one chamber, in the plane, with the wave.

        Parameters
        ----------
        fill : chamber and liquid
        whirl : of its axis; its ramp does not matter to an answer that stands

        Raises
        ------
        InputError : what the model's equations do not have, as friction, gravity or no free surface may be
        """
        ...

    def at_rest(self, fills: Fills, whirls: Whirls) -> LiquidAnswer | None:
        """Answers of synchronous whirls without gravity across the axis, where a closed form is known.

        None, as here, sends them to `wave` like any others.
        """
        return None

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `LiquidModel`: analytically where the liquid is at rest in the drum, else whirl by whirl."""
        still = (whirls.slip == 0.0) & (whirls.gravity == 0.0)
        if still.all() and (known := self.at_rest(fills, whirls)) is not None:
            return known
        if still.any() and not still.all():
            apart = np.flatnonzero(still), np.flatnonzero(~still)
            parts = [self.answer(fills.at(rows), whirls.at(rows)) for rows in apart]
            return LiquidAnswer.joined(parts).at(np.argsort(np.concatenate(apart)))
        return LiquidAnswer.joined(
            [self.wave(fills.fill(k), whirls.whirl(k)).answer for k in range(len(fills))]
        )


def whirl_answer(
    fill: Fill,
    whirl: Whirl,
    force_ratio: complex,
    offset: complex,
    limits: Mapping[str, bool],
    dry_patch: bool = False,
    converged: bool = True,
    small: bool = False,
    error: float = math.nan,
) -> LiquidAnswer:
    """Answer to one whirl from the ratio that wave theories give.

    `force_ratio`: force over that of a full drum, m_f omega^2 w; without a deflection the limit of a small
    one. `offset` of the liquid's centre of mass from the chamber's axis, m; `small`: the theory is linear,
    the force goes with the deflection. Others as of `LiquidAnswer`.
    """
    # The parts one by one: a product of complex numbers makes nan of an infinite one.
    full = fill.full_mass
    moved = full * whirl.amplitude
    unbalance = complex(moved * force_ratio.real, moved * force_ratio.imag)
    if whirl.amplitude == 0.0 and not math.isnan(force_ratio.real):
        unbalance = 0j
    return LiquidAnswer(
        unbalance=np.array([unbalance]),
        slope=np.array([full * force_ratio.real if small else math.nan]),
        offset=np.array([complex(offset)]),
        dry_patch=np.array([dry_patch]),
        converged=np.array([converged]),
        limits={name: np.array([kept]) for name, kept in limits.items()},
        error=np.array([error]),
    )


def require_crest(fill: Fill, crest: float, crests: int) -> None:
    """Raise `InputError` unless a natural wave may have such crests, of a depth over the mean depth."""
    most = fill.chamber.radius / fill.depth
    if not 1.0 < crest < most:
        raise InputError("free", crest, f"above 1 and below {most:g}, where the crest reaches the axis")
    if not 1 <= crests <= _MOST_CRESTS:
        raise InputError("mode", crests, f"from 1 to {_MOST_CRESTS}")


def no_free_wave(fill: Fill, ranges: Mapping[str, Range], reason: str) -> FreeWave:
    """A natural sloshing wave that was not found, and why."""
    theta = angles()
    return FreeWave(
        whirl_speed=(math.nan, math.nan),
        theta=theta,
        depth=np.full(theta.shape, math.nan),
        crest=math.nan,
        trough=math.nan,
        crest_number=math.nan,
        numbers={"relative_depth": fill.depth / fill.chamber.radius},
        ranges=ranges,
        converged=False,
        mass_error=math.nan,
        reason=reason,
    )


def numbers_of(fill: Fill, whirl: Whirl, found: Mapping[str, float]) -> dict[str, float]:
    """Dimensionless numbers of a whirl, and those that a model found."""
    given = whirl_numbers(fill, whirl.spin, whirl.speed, whirl.amplitude, whirl.gravity)
    return asdict(given) | dict(found)


def smooth_whirl(fill: Fill, whirl: Whirl) -> dict[str, float]:
    """Size of a whirl over the largest that a smooth steady wave follows [theory: model_error, eq. 32-33].

    By its name among the numbers of a wave; 0 between the resonances of one and of two crests, where no limit
    is known; none in a synchronous whirl, under gravity and with baffles.
    """
    if whirl.slip == 0.0 or whirl.gravity != 0.0 or fill.chamber.baffles is not None:
        return {}
    if whirl.amplitude == 0.0:
        return {"smooth_whirl": 0.0}
    largest = float(largest_whirl(fill.depth / fill.chamber.radius, whirl.detuning))
    return {"smooth_whirl": whirl.amplitude / fill.depth / largest if largest > 0.0 else math.inf}


def kept_limits(numbers: Mapping[str, float], ranges: Mapping[str, Range]) -> dict[str, bool]:
    """By name each range that bounds a number, and whether the number is within."""
    return {name: low <= numbers[name] <= high for name, (low, high) in ranges.items() if name in numbers}


def wave_amplitude(depth: Array, mean: float) -> float:
    """Largest change of the depth over the mean depth; nan without a profile."""
    return float(np.max(np.abs(depth - mean))) / mean if depth.size else math.nan


def angles() -> Array:
    """Angles from the deflection all round at which analytical waves are drawn, rad."""
    return np.linspace(-math.pi, math.pi, 360, endpoint=False)
