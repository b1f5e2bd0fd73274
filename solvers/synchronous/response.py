"""Steady answer of any rotor with liquid to its unbalance, and its critical speeds.

`response` gives one result for every kind of rotor. A Jeffcott rotor is solved by its one circle, with the
stability of every branch, and thousands at once by `machine_responses`; any other by harmonic balance.
Critical speeds hold at small deflections, dampers left out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Annotated, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill, Fills
from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError
from meshes.quantity import Q
from solvers.liquid_model import ROUNDING, LiquidModel, Whirls
from solvers.roots import bracketed_root
from solvers.rotor.jeffcott import Jeffcott, PlanarMachine
from solvers.rotor.system import Rotor, RotorSystem
from solvers.rotor.vibration import critical_speeds, orbit, unbalance_response
from solvers.synchronous.balance import Balance, Liquid, backward_mass, directions, harmonic_balance
from solvers.synchronous.coupled import Near, newton, solutions, stable_solutions
from solvers.synchronous.models import LINEAR, STATICS
from solvers.synchronous.pairs import Pairs, pair_machines
from solvers.synchronous.peaks import Peak
from solvers.synchronous.planar import all_deflections, divide, is_stable, liquid_offset, over, with_phase


def critical_speed(
    rotor: Jeffcott, fills: Sequence[Fill], gravity: float = 9.81, model: LiquidModel = STATICS
) -> float:
    """Speed at which a small deflection meets no stiffness: (M + dU/de) Omega^2 = K [theory: rotor, eq. 4].

    rad/s, between sqrt(K/(M + m_f)) and sqrt(K/M).
    """
    wet, along = [fill for fill in fills if fill.volume > 0.0], np.array([gravity])
    if model.across:
        return _fixed_speed(rotor, wet, gravity, model)

    def stiffness(speed: Array, _: Index) -> Array:
        pairs = pair_machines([(rotor, wet)], np.zeros(speed.size, dtype=np.intp), speed, along, model)
        slope = pairs.liquid(np.zeros_like(speed), np.arange(speed.size)).slope
        return np.asarray(rotor.stiffness - (rotor.mass + slope) * np.square(speed))

    # The slope of the unbalance never exceeds the reference mass; a little more holds the rounding.
    heaviest = rotor.mass + float(model.added_mass(Fills.of(wet)).sum())
    ends = np.sqrt(rotor.stiffness / np.array([heaviest, rotor.mass])) * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    root, _ = bracketed_root(stiffness, ends[:1], ends[1:])
    return float(root[0])


def _fixed_speed(rotor: Jeffcott, wet: Sequence[Fill], gravity: float, model: LiquidModel) -> float:
    """`critical_speed` with a model of one's own, whose slope may be anything; nan where none is found."""
    speed = math.sqrt(rotor.stiffness / rotor.mass)
    for _ in range(_ROUNDS):
        before, still = speed, np.zeros(len(wet))
        whirls = Whirls.synchronous(still + speed, still, still + gravity)
        mass = rotor.mass + (float(model.answer(Fills.of(wet), whirls).slope.real.sum()) if wet else 0.0)
        if not mass > 0.0:
            return math.nan
        speed = math.sqrt(rotor.stiffness / mass)
        if abs(speed - before) <= ROUNDING * speed:
            return speed
    return math.nan


def wet_critical_speeds(
    rotor: Rotor, fills: Sequence[Fill], gravity: float = 9.81, model: LiquidModel = STATICS
) -> tuple[Array, Complex]:
    """All critical speeds of a rotor of any kind, and its shapes there [theory: rotor, eq. 31].

    Rising, rad/s, shape (k,), and complex shapes (k, n).
    """
    system = rotor.system()
    wet = [fill for fill in fills if fill.volume > 0.0]
    speed, shape = critical_speeds(system, _added_mass(system, wet, None, gravity, model))
    if (gravity == 0.0 and not model.across) or not wet:
        return speed, shape
    # Upright, or by a model of one's own, the liquid's share in the mass depends on the speed itself.
    for k in range(speed.size):
        for _ in range(30):
            again, shapes = critical_speeds(system, _added_mass(system, wet, float(speed[k]), gravity, model))
            if k >= again.size or abs(again[k] - speed[k]) <= 1e-12 * speed[k]:
                break
            speed[k], shape[k] = again[k], shapes[k]
    return speed, shape


_ROUNDS = 60  # in which a critical speed settles
_ALIKE = 1e-6  # relative; amplitudes nearer than that are equally large
_TRACE = 1e-6  # of the added mass, which parts equal modes and moves no other
_FREE = 1e-9  # loss factor below which a mode counts as undamped, share below which it counts as not driven


def main_critical_speeds(
    system: RotorSystem,
    fills: Sequence[Fill],
    dry: tuple[Array, Complex],
    wet: tuple[Array, Complex],
) -> tuple[float, float]:
    """Critical speed where the unbalance moves the rotor without liquid most, and that of this mode with it.

    rad/s; nan where there is none. By the largest amplitude at any chamber, or at position 0 without
    chambers, in linear theory with dampers; without bound where the unbalance drives an undamped mode; the
    lowest of equals [theory: rotor, eq. 31]. `dry` and `wet` as from `critical_speeds` and
    `wet_critical_speeds`.
    """
    speed, shape = dry
    if speed.size == 0:
        return float("nan"), float("nan")
    shape = _parted(system, fills, shape)
    planes = sorted({fill.chamber.plane for fill in fills}) or [0.0]
    answer = unbalance_response(system, speed)
    size = np.max([orbit(system, answer, plane).amplitude for plane in planes], axis=0)
    lossless, push = _undamped(system, speed, shape)
    size = np.where(lossless, np.where(push > _FREE**2, np.inf, 0.0), size)
    first = int(np.argmax(size >= size.max() * (1.0 - _ALIKE)))
    # Of modes at one and the same speed the one that the unbalance drives.
    same = np.flatnonzero(np.abs(speed - speed[first]) <= _ALIKE * speed[first])
    main = int(same[np.argmax(push[same])])
    return float(speed[main]), float(_with_liquid(system, shape, wet)[main])


def _parted(system: RotorSystem, fills: Sequence[Fill], shape: Complex) -> Complex:
    """Shapes of the dry modes, those at one and the same speed parted as a trace of the liquid parts them."""
    wet = [fill for fill in fills if fill.volume > 0.0]
    if not wet:
        return shape
    trace = critical_speeds(system, _TRACE * _added_mass(system, wet, None, 0.0, LINEAR))[1]
    return trace if trace.shape == shape.shape else shape


def _with_liquid(system: RotorSystem, dry: Complex, wet: tuple[Array, Complex]) -> Array:
    """Critical speed with liquid of each mode without, rad/s, nan where it has none, shape (k,).

    Modes are alike by the squared cosine between their shapes in the metric of the rotor's mass, paired one
    to one with the largest sum [theory: rotor, eq. 39].
    """
    from scipy.optimize import linear_sum_assignment

    speed, shape = wet
    unit = [
        x / np.sqrt(np.einsum("ki,ij,kj->k", x.conj(), system.mass, x).real)[:, None] for x in (dry, shape)
    ]
    alike = np.square(np.abs(unit[0].conj() @ system.mass @ unit[1].T))
    row, column = linear_sum_assignment(alike, maximize=True)
    found = np.full(len(dry), np.nan)
    found[row] = speed[column]
    return found


def _undamped(system: RotorSystem, speed: Array, shape: Complex) -> tuple[Flags, Array]:
    """Which modes have no damping, and the share of the unbalance's push that drives each, shape (k,)."""

    def form(matrix: Array) -> Array:
        return np.asarray(np.einsum("ki,ij,kj->k", shape.conj(), matrix, shape).real)

    energy = form(system.mass)
    push = np.square(np.abs(shape.conj() @ system.unbalance))
    most = float((system.unbalance.conj() @ np.linalg.solve(system.mass, system.unbalance)).real)
    lossless = form(system.damping) <= _FREE * speed * energy
    share = np.divide(push, energy * most, out=np.zeros(push.shape), where=energy * most > 0.0)
    return np.asarray(lossless), np.asarray(share)


def _added_mass(
    system: RotorSystem, wet: list[Fill], speed: float | None, gravity: float, model: LiquidModel
) -> Complex:
    """Mass matrix of the liquid in synchronous motion, at a speed or far above every other one."""
    n = len(system.coordinates)
    total = np.zeros((n, n), dtype=complex)
    for fill, p in zip(wet, directions(system, wet), strict=True):
        full = float(model.added_mass(Fills.of([fill]))[0])
        if speed is not None:
            whirl = Whirls.synchronous(np.array([speed]), np.zeros(1), np.array([gravity]))
            full = float(model.answer(Fills.of([fill]), whirl).slope[0].real)
        total += 0.5 * full * np.outer(p, np.conj(p)) + 0.5 * backward_mass(fill) * np.outer(np.conj(p), p)
    return total


_Value = TypeVar("_Value", bound=np.generic)
_ASIDE = "position", "over_time"  # fields that are not one value a speed
_NONE = complex(np.nan, np.nan)  # in tables of branches, where there are fewer
_OVER, _EACH, _YES, _SLOW = ("speed",), ("speed", "branch"), "no yes", "against slow disturbances"
_AXES = ("along the unbalance", "90 deg ahead of it")
LAG = "from the unbalance, positive with the spin, a lag is negative"


@dataclass(frozen=True)
class Response:
    """Unbalance response over speed; n speeds, b branches, m coordinates of the rotor.

    The axis goes round as forward e^{i Omega t} + backward e^{-i Omega t}; deflections without further word
    are the forward part. Angles are measured from the unbalance, or from angle 0 of several unbalances,
    positive with the spin; a lag is negative.
    """

    speed: Annotated[Array, Q("rad s-1", "spin speed", "of the rotor about its axis", _OVER)]
    #: w; of the stable branches the largest, which is where a slow run-up of this hardening system arrives
    #: and the one to design for
    deflection: Annotated[Complex, Q("m", "deflection of the branch reported", over=_OVER, axes=_AXES)]
    deflection_dry: Annotated[
        Complex, Q("m", "deflection without liquid", over=_OVER, axes=_AXES, json=False)
    ]
    liquid_offset: Annotated[
        Array, Q("m", "liquid offset", "rotation axis to centre of mass", _OVER, error="error_estimate")
    ]
    liquid_angle: Annotated[Array, Q("rad", "angle of the liquid's centre of mass", LAG, _OVER)]
    dry_patch: Annotated[Flags, Q(name="dry patch", text="the wall is dry somewhere", over=_OVER, flags=_YES)]
    #: against slow disturbances [theory: rotor, eq. 8 and 35]; an answer counts whirls as well
    stable: Annotated[
        Flags, Q(name="the branch reported is stable", text=f"{_SLOW} and whirls", over=_OVER, flags=_YES)
    ]
    model: Annotated[NDArray[np.str_], Q("1", "liquid model", "used at this speed", _OVER)]
    in_range: Annotated[
        Flags, Q(name="in range", text="the liquid model holds there", over=_OVER, flags=_YES)
    ]
    #: with chambers in several planes one branch was
    converged: Annotated[Flags, Q(name="converged", text="every branch was found", over=_OVER, flags=_YES)]
    #: by rising amplitude, nan where there are fewer
    branch_deflection: Annotated[
        Complex,
        Q(
            *("m", "deflection of every branch", "", _EACH, _AXES),
            key="branches",
            variable="branch",
            sparse="branch_deflection",
        ),
    ]
    branch_stable: Annotated[
        Flags, Q(name="stability of every branch", over=_EACH, sparse="branch_deflection", data=False)
    ]
    backward: Complex  #: backward part of the branch reported, and without liquid, m, shape (n,)
    backward_dry: Complex
    branch_backward: Complex  #: of all branches, m, shape (n, b)
    #: as coordinates, of all branches, nan where there are fewer, shape (n, b, m)
    branch_coordinates: Complex
    #: complex amplitudes of the branch reported, q = Re(coordinates e^{i Omega t}), shape (n, m)
    coordinates: Complex
    #: speed at which a branch ends between this speed and the next one, as far as that was found on the way,
    #: else nan, rad/s, shape (n,); of chambers in several planes only
    fold_speed: Array
    residual: Array  #: what is left of the balance of forces over the largest of them, shape (n,)
    position: float = 0.0  #: along the axis of the plane whose motion is reported, m
    #: mean over time of the distance of the axis from where it rests, of motions integrated in time, m, else
    #: nan, shape (n,); empty where none was
    over_time: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def parts(self) -> Complex:
        """Forward and backward part of the branch reported, m, shape (n, 2)."""
        return np.stack((self.deflection, self.backward), axis=1)

    @property
    def parts_dry(self) -> Complex:
        """Forward and backward part of the rotor without liquid, m, shape (n, 2)."""
        return np.stack((self.deflection_dry, self.backward_dry), axis=1)

    @property
    def branch(
        self,
    ) -> Annotated[Index, Q("1", "branch", "rank by rising amplitude", ("branch",), json=False)]:
        return np.arange(self.branch_deflection.shape[1], dtype=np.int32)

    @property
    def branch_state(
        self,
    ) -> Annotated[
        Index,
        Q(
            *("", "stability of every branch", _SLOW, _EACH),
            flags="absent unstable stable",
            variable="branch_stable",
            json=False,
        ),
    ]:
        return np.where(np.isnan(self.branch_deflection), -1, self.branch_stable)

    @property
    def amplitude(
        self,
    ) -> Annotated[
        Array,
        Q(
            *("m", "amplitude", "of the axis about where it rests; its mean if integrated in time", _OVER),
            error="error_estimate",
        ),
    ]:
        size = np.abs(self.parts).sum(axis=1)
        if self.over_time.size == 0:
            return np.asarray(size)
        return np.where(np.isnan(self.over_time), size, self.over_time)

    @property
    def amplitude_dry(self) -> Annotated[Array, Q("m", "amplitude", "without liquid", _OVER)]:
        return np.asarray(np.abs(self.parts_dry).sum(axis=1))

    @property
    def holds(self) -> Flags:
        """Validity of the answer: found, in the range of its model, or known to have no bound, shape (n,)."""
        return (self.converged & self.in_range) | np.isinf(self.amplitude)

    @property
    def top(self) -> int | None:
        """Index of the largest amplitude of the speeds at which the answer holds, the first of equals.

        Of all speeds where it holds at none; None where nothing was found.
        """
        known = ~np.isnan(self.amplitude)
        if not known.any():
            return None
        counts = known & self.holds
        return int(np.argmax(np.where(counts if counts.any() else known, self.amplitude, -1.0)))

    @property
    def peak(self) -> Peak:
        """Amplitude at `top` and its speed."""
        if self.top is None:
            return Peak(math.nan, math.nan)
        return Peak(float(self.speed[self.top]), float(self.amplitude[self.top]))

    @property
    def branch_amplitude(self) -> Array:
        """Amplitude of every branch, nan where there is none, m, shape (n, b)."""
        return np.asarray(np.abs(self.branch_deflection) + np.abs(self.branch_backward))

    def at(self, which: Index) -> Response:
        """The response at some of its speeds, by their index."""
        own = {each.name: getattr(self, each.name) for each in fields(self) if each.name not in _ASIDE}
        over_time = self.over_time[which] if self.over_time.size else self.over_time
        found = {name: values[which] for name, values in own.items()}
        return Response(**found, position=self.position, over_time=over_time)


def response(
    rotor: Rotor,
    fills: Sequence[Fill],
    speed: ArrayLike,
    gravity: float = 9.81,
    model: LiquidModel | Sequence[LiquidModel] = STATICS,
    position: float | None = None,
    near: Near | None = None,
) -> Response:
    """Steady motion of a rotor with liquid in its chambers under its unbalance [theory: rotor, eq. 2, 28-30].

    Parameters
    ----------
    rotor : the dry rotor, of any kind
    fills : its chambers with their liquid, any number
    speed : spin speeds Omega, rad/s, shape (n,), > 0
    gravity : along the axis, m/s^2; 0 for a horizontal axis
    model : of the liquid, for the forward part; one for all speeds or one for each
    position : of the plane that is reported, m; that of the first chamber if None, 0 without chambers. All
        planes of a Jeffcott rotor move alike
    near : answers at the next speeds below and above, from which a search with chambers in several planes
        starts

    Returns
    -------
    Response; `converged` is False where the deflection is unbounded (no damping at resonance)

    Raises
    ------
    InputError : a speed that is not positive and finite

    Examples
    --------
    >>> rotor = Jeffcott(mass=4.0, stiffness=4.4e4, damping=84.0, unbalance=6e-4)
    >>> answer = response(rotor, [], [105.0, 200.0])
    >>> print(np.round(1e3 * np.abs(answer.deflection), 4))
    [0.75   0.2048]
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    if isinstance(model, Sequence) and len(model) != spin.size:
        raise InputError("model", len(model), f"one for each of {spin.size} speeds")
    alone = np.zeros(spin.size, dtype=np.intp)
    return fill_responses(rotor, [fills], alone, spin, gravity, model, position, near)


def fill_responses(
    rotor: Rotor,
    sets: Sequence[Sequence[Fill]],
    owner: Index,
    speed: Array,
    gravity: float = 9.81,
    model: LiquidModel | Sequence[LiquidModel] = STATICS,
    position: float | None = None,
    near: Near | None = None,
) -> Response:
    """`response` of one rotor with other volumes in its chambers: at n pairs of volumes and a speed.

    Parameters
    ----------
    rotor : the dry rotor, of any kind
    sets : its chambers, the same in each set
    owner : which set each pair has, shape (n,)
    speed : spin speeds Omega, rad/s, shape (n,), > 0
    gravity, position, near : as for `response`; all near answers of a pair belong to its set
    model : of the liquid; one for all pairs or one for each

    Returns
    -------
    Response over the pairs, each the same whichever others are asked for beside those of its set

    Raises
    ------
    InputError : a speed that is not positive and finite
    """
    _require_speeds(speed)
    place = position if position is not None else (sets[0][0].chamber.plane if sets and sets[0] else 0.0)

    def solve(law: LiquidModel, at: Index) -> Response:
        if isinstance(rotor, Jeffcott) and not law.across:
            machines = [(rotor, fills) for fills in sets]
            return machine_responses(machines, owner[at], speed[at], np.full(len(sets), gravity), law)
        present, own = np.unique(owner[at], return_inverse=True)
        filled = [sets[k] for k in present.tolist()]
        terms = harmonic_balance(rotor.system(), filled, own.reshape(-1), speed[at], gravity, law)
        return _of_balance(rotor.system(), terms, place, None if near is None else near.at(at))

    # The balance has an equation for each chamber with liquid.
    wet = [tuple(fill.volume > 0.0 for fill in fills) for fills in sets]
    laws = model if isinstance(model, Sequence) else [model] * speed.size
    kinds: dict[tuple[LiquidModel, tuple[bool, ...]], list[int]] = {}
    for k in np.argsort(owner, kind="stable").tolist():
        kinds.setdefault((laws[k], wet[owner[k]]), []).append(k)
    parts = [(np.array(at, dtype=np.intp), solve(law, np.array(at))) for (law, _), at in kinds.items()]
    return _merged(parts)


def machine_responses(
    machines: Sequence[PlanarMachine],
    owner: Index,
    speed: Array,
    gravity: Array,
    model: LiquidModel = STATICS,
) -> Response:
    """`response` of many planar machines at once: of n pairs of a machine and a speed.

    Parameters
    ----------
    machines : rotors, each with its chambers and their liquid
    owner : which machine each pair has, shape (n,)
    speed : spin speeds Omega, rad/s, shape (n,), > 0
    gravity : along the axis of each machine, m/s^2, shape (machines,)
    model : of the liquid

    Returns
    -------
    Response over the pairs

    Raises
    ------
    InputError : a speed that is not positive and finite
    """
    _require_speeds(speed)
    if model.across:
        rows = [np.flatnonzero(owner == k) for k in range(len(machines))]
        parts = [
            (at, response(rotor, fills, speed[at], along, model))
            for at, (rotor, fills), along in zip(rows, machines, gravity.tolist(), strict=True)
            if at.size
        ]
        return _merged(parts)
    pairs = pair_machines(machines, owner, speed, gravity, model)
    size, which, converged = all_deflections(pairs)
    bounded = np.isfinite(size)
    deflection = np.where(bounded, size, 0.0)
    state = pairs.liquid(deflection, which)
    stable = bounded & is_stable(pairs, which, deflection, state)
    phased = np.where(bounded, with_phase(pairs, which, deflection, state), complex(np.inf, 0.0))
    table = _Table.arrange(speed.size, which, deflection, stable)
    chosen = table.reported
    farthest = np.array([max((f.chamber.radius for f in fills), default=0.0) for _, fills in machines])
    w, found = phased[chosen], bounded[chosen, None]
    still = np.where(bounded[chosen], w, 0.0)
    np.logical_and.at(converged, which, state.converged)
    none = np.zeros(speed.size, dtype=complex)
    circle, endless = np.array([1.0, -1j]), complex(np.inf, 0.0)
    return Response(
        speed=speed,
        deflection=w,
        deflection_dry=divide(pairs.unbalance * np.square(speed), pairs.dynamic_stiffness),
        liquid_offset=liquid_offset(pairs, farthest[owner], deflection[chosen], state.unbalance[chosen]),
        liquid_angle=np.angle(w),
        dry_patch=state.dry_patch[chosen],
        stable=stable[chosen],
        model=np.full(speed.shape, model.name),
        in_range=state.in_range[chosen],
        converged=converged,
        branch_deflection=table.spread(phased, _NONE),
        branch_stable=table.spread(stable, False),
        backward=none,
        backward_dry=none,
        branch_backward=table.spread(np.zeros(which.size, dtype=complex), _NONE),
        branch_coordinates=table.spread(
            np.where(bounded[:, None], np.where(bounded, phased, 0.0)[:, None] * circle, endless), _NONE
        ),
        coordinates=np.where(found, still[:, None] * circle, endless),
        fold_speed=np.full(speed.shape, np.nan),
        residual=_left(pairs, still, state.unbalance[chosen]),
    )


def answered_by(
    rotor: Rotor, fills: Sequence[Fill], known: Response, model: LiquidModel, gravity: float = 9.81
) -> Response:
    """The branches that one liquid model reports, as another has them: Newton's method from each.

    For models too dear to look for branches by. `residual` is that of the model's own balance; branches that
    are not reported stay as they were.
    """
    system, found = rotor.system(), np.flatnonzero(np.isfinite(known.coordinates).all(axis=1))
    owner = np.zeros(found.size, dtype=np.intp)
    terms = harmonic_balance(system, [fills], owner, known.speed[found], gravity, model)
    answer, met = newton(terms, known.coordinates[found], np.arange(found.size))
    motion, forward = orbit(system, answer, known.position), terms.forward(answer)
    law = terms.told(np.arange(found.size), answer)
    offset, angle = _centre_of_mass(terms, forward, law)

    def placed(values: NDArray[_Value], name: str) -> NDArray[_Value]:
        whole: NDArray[_Value] = getattr(known, name).copy()
        whole[found] = values
        return whole

    return replace(
        known,
        deflection=placed(motion.forward, "deflection"),
        backward=placed(motion.backward, "backward"),
        coordinates=placed(answer, "coordinates"),
        liquid_offset=placed(offset, "liquid_offset"),
        liquid_angle=placed(angle if terms.fills else np.angle(motion.forward), "liquid_angle"),
        dry_patch=placed(np.asarray(law.dry_patch.any(axis=1)), "dry_patch"),
        in_range=placed(np.asarray(law.in_range.all(axis=1)), "in_range"),
        converged=known.converged & placed(np.asarray(met & law.converged.all(axis=1)), "converged"),
        residual=placed(_residual(terms, answer, forward, law), "residual"),
        model=np.full(known.speed.shape, model.name.split()[0]),
    )


def distance(found: Response, exact: Response) -> Array:
    """How far an answer is from another one, relative: the larger of amplitude and liquid's offset."""
    gaps = []
    for name in ("amplitude", "liquid_offset"):
        here, there = getattr(found, name), getattr(exact, name)
        gaps.append(np.where(here == there, 0.0, over(np.abs(here - there), there)))
    return np.asarray(np.maximum(*gaps) + ROUNDING)


def _require_speeds(speed: Array) -> None:
    if not np.all(np.isfinite(speed) & (speed > 0.0)):
        raise InputError("speed", speed.tolist(), "finite numbers above 0")


def _left(pairs: Pairs, deflection: Complex, unbalance: Array) -> Array:
    """What is left of the planar balance over its largest force."""
    squared, size = np.square(pairs.speed), np.abs(deflection)
    unit = np.divide(deflection, size, out=np.zeros_like(deflection), where=size > 0.0)
    held, force = pairs.dynamic_stiffness * deflection, squared * pairs.unbalance
    scale = np.maximum(np.abs(held), force)
    left = np.abs(held - force - squared * unbalance * unit)
    return np.asarray(np.divide(left, scale, out=np.zeros(scale.shape), where=scale > 0.0))


def _of_balance(system: RotorSystem, terms: Balance, position: float, near: Near | None) -> Response:
    """The solutions of a harmonic balance as tables over speed and branch, and the largest of each speed."""
    found = solutions(terms, near)
    answer, which = found.answer, found.which
    lost = np.setdiff1d(np.arange(terms.speed.size), which)
    nothing = np.full((lost.size, answer.shape[1]), complex(np.inf, 0.0))
    answer, which = np.concatenate((answer, nothing)), np.concatenate((which, lost))
    motion = orbit(system, answer, position)
    size = np.abs(motion.forward)
    found_at, stable = np.flatnonzero(np.isfinite(size)), np.zeros(which.size, dtype=bool)
    stable[found_at] = stable_solutions(terms, answer[found_at], which[found_at])
    table = _Table.arrange(terms.speed.size, which, size, stable)
    chosen = table.reported
    bounded = np.isfinite(size[chosen])
    q = np.where(bounded[:, None], answer[chosen], 0.0)
    forward = terms.forward(q)
    law = terms.told(which[chosen], q)
    offset, angle = _centre_of_mass(terms, forward, law)
    dry = orbit(system, unbalance_response(system, terms.speed), position)
    deflection = motion.forward[chosen]
    return Response(
        speed=terms.speed,
        deflection=deflection,
        deflection_dry=dry.forward,
        liquid_offset=offset,
        liquid_angle=angle if terms.fills else np.angle(np.where(bounded, deflection, 0.0)),
        dry_patch=np.asarray(law.dry_patch.any(axis=1)),
        stable=stable[chosen],
        model=np.full(terms.speed.shape, terms.model.name),
        in_range=np.asarray(law.in_range.all(axis=1)),
        converged=found.converged & bounded & law.converged.all(axis=1),
        branch_deflection=table.spread(motion.forward, _NONE),
        branch_stable=table.spread(stable, False),
        backward=motion.backward[chosen],
        backward_dry=dry.backward,
        branch_backward=table.spread(motion.backward, _NONE),
        branch_coordinates=table.spread(answer, _NONE),
        coordinates=answer[chosen],
        fold_speed=found.end,
        residual=_residual(terms, q, forward, law),
        position=position,
    )


def _centre_of_mass(terms: Balance, forward: Complex, law: Liquid) -> tuple[Array, Array]:
    """Distance of all the liquid's centre of mass from the rotation axis, and its angle."""
    size = np.abs(forward)
    unit = np.divide(forward, size, out=np.zeros_like(forward), where=size > 0.0)
    moment = np.sum(law.unbalance * unit, axis=1)
    offset = np.divide(np.abs(moment), terms.mass, out=np.zeros(len(forward)), where=terms.mass > 0.0)
    return offset, np.angle(moment)


def _residual(terms: Balance, q: Complex, forward: Complex, law: Liquid) -> Array:
    """What is left of the balance of forces over the largest of them."""
    size = np.abs(forward)
    unit = np.divide(forward, size, out=np.zeros_like(forward), where=size > 0.0)
    held = np.einsum("kij,kj->ki", terms.stiffness, q)
    pull = np.square(terms.speed)[:, None] * ((law.unbalance * unit) @ terms.plane)
    scale = np.maximum(np.linalg.norm(held, axis=1), np.linalg.norm(terms.force, axis=1))
    left = np.linalg.norm(held - terms.force - pull, axis=1)
    return np.asarray(np.divide(left, scale, out=np.zeros(scale.shape), where=scale > 0.0))


@dataclass(frozen=True)
class _Table:
    """Where each solution stands in the table of branches: its row is the speed, its column the rank."""

    rows: Index
    columns: Index
    shape: tuple[int, int]
    reported: Index

    @classmethod
    def arrange(cls, speeds: int, which: Index, size: Array, stable: Flags) -> _Table:
        """Rank the solutions of each speed by amplitude; report the largest stable one, or the largest."""
        order = np.lexsort((size, which))
        counts = np.bincount(which, minlength=speeds)
        starts = np.concatenate(([0], np.cumsum(counts)[:-1]))
        columns = np.empty(which.size, dtype=np.intp)
        columns[order] = np.arange(which.size) - np.repeat(starts, counts)
        best = np.lexsort((size, stable, which))
        return cls(which, columns, (speeds, int(counts.max())), best[np.cumsum(counts) - 1])

    def spread(self, values: NDArray[_Value], missing: complex | bool) -> NDArray[_Value]:
        """Values of the solutions as a table (speed, branch, ...), `missing` where there is none."""
        table = np.full((*self.shape, *values.shape[1:]), missing, dtype=values.dtype)
        table[self.rows, self.columns] = values
        return table


def _merged(parts: list[tuple[Index, Response]]) -> Response:
    """Responses of several models, each at its own speeds, in the order of the speeds."""
    order = np.argsort(np.concatenate([at for at, _ in parts]))
    return joined([part for _, part in parts]).at(order)


def joined(parts: Sequence[Response]) -> Response:
    """Responses at several sets of speeds as one, one set after the other."""
    found: dict[str, Any] = {"position": parts[0].position, "over_time": _times(parts)}
    for each in fields(Response):
        values = [getattr(part, each.name) for part in parts]
        if each.name not in found:
            wide = _padded(values) if each.name.startswith("branch_") else values
            found[each.name] = np.concatenate(wide)
    return Response(**found)


def _times(parts: Sequence[Response]) -> Array:
    """Means over time of several responses; empty where none has any."""
    if not any(part.over_time.size for part in parts):
        return np.zeros(0)
    whole = [part.over_time if part.over_time.size else np.full(part.speed.shape, np.nan) for part in parts]
    return np.concatenate(whole)


def by_speed(parts: Sequence[Response]) -> Response:
    """Responses at several sets of speeds as one, by rising speed."""
    every = joined(parts)
    return every.at(np.argsort(every.speed, kind="stable"))


def _padded(tables: list[NDArray[Any]]) -> list[NDArray[Any]]:
    """The same number of branches in each, nan or False where there is none."""
    most = max(table.shape[1] for table in tables)
    wide = []
    for table in tables:
        shape, missing = (table.shape[0], most, *table.shape[2:]), False if table.dtype == bool else _NONE
        out = np.full(shape, missing, dtype=table.dtype)
        out[:, : table.shape[1]] = table
        wide.append(out)
    return wide
