"""How well the estimated errors of the liquid models cover the true ones: random machines, both models.

`python -m tests.extremes.model_error` prints the table of docs/models/overview.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill, Fills
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import KNOWN_LIQUIDS
from meshes.arrays import Array, Flags
from meshes.chamber import Chamber
from solvers.held.integrate import hold, start
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl, Whirls
from solvers.pypde.settle import settle
from solvers.rotor.jeffcott import Jeffcott, PlanarMachine
from solvers.rotor.system import RotorSystem
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import orbit
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Ramp, RunupModel
from solvers.runup.runup import RunupHistory, RunupNumerics, linear_run_error, run_up
from solvers.synchronous.errors import (
    GravityError,
    LinearError,
    error_estimate,
    law_error,
    planar_enclosure,
)
from solvers.synchronous.models import LINEAR, STATICS
from solvers.synchronous.pairs import pair_machines
from solvers.synchronous.response import Response, machine_responses, response
from solvers.whirl.growth import asynchronous_growth

WATER = KNOWN_LIQUIDS["water"]
GRAVITY = 9.81
# Of the calibration; the tests take others.
SEEDS = {"linear": 1, "gravity": 2, "run_up": 2, "held": 11}
HELD = {"jeffcott": 500, "two_plane": 400, "tub": 400}  # machines drawn to be held in time, by kind of rotor


@dataclass(frozen=True)
class Coverage:
    """Errors and their estimates, shape (n,)."""

    true: Array  #: relative error against the better model
    estimate: Array  #: of it, infinite where there is none

    @property
    def covered(self) -> float:
        """Share of the errors that are not above their estimates."""
        return float(np.mean(self.true <= self.estimate))

    @property
    def unbounded(self) -> float:
        """Share of the estimates that are infinite."""
        return float(np.mean(np.isinf(self.estimate)))

    def ratio(self, least: float = 1e-9, most: float = 0.05) -> float:
        """Median of estimate over error, for finite estimates and errors between two bounds."""
        kept = np.isfinite(self.estimate) & (self.true > least) & (self.true < most)
        return float(np.median(self.estimate[kept] / self.true[kept])) if kept.any() else math.nan

    def refused(self, tolerance: float) -> float:
        """Of the errors within a tolerance the share whose estimates are not."""
        good = self.true <= tolerance
        return float(np.mean(self.estimate[good] > tolerance)) if good.any() else 0.0

    def within(self, tolerance: float) -> tuple[float, float]:
        """Shares of the errors and of the estimates within a tolerance."""
        return float(np.mean(self.true <= tolerance)), float(np.mean(self.estimate <= tolerance))


def between(rng: np.random.Generator, low: float, high: float) -> float:
    """A number whose logarithm is evenly spread."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def random_machines(seed: int, count: int) -> tuple[list[PlanarMachine], Array, Array]:
    """Machines with one to three chambers, a speed and gravity along the axis for each.

    Half of the axes lie. Speeds are 0.2 to 5 critical speeds, unbalances 1e-4 to 1 of M R, damping ratios
    0.01 to 0.5, fills 1e-3 to 0.95 of the capacity, two in five chambers have an inner wall.
    """
    rng = np.random.default_rng(seed)
    machines: list[PlanarMachine] = []
    table = np.zeros((2, count))
    for k in range(count):
        largest, mass, critical = between(rng, 0.03, 0.5), between(rng, 0.5, 100.0), between(rng, 5.0, 300.0)
        damping, chambers = between(rng, 0.01, 0.5), int(rng.integers(1, 4))
        fills = [_random_fill(rng, largest * between(rng, 0.3, 1.0)) for _ in range(chambers)]
        stiffness = mass * critical**2
        support = 2.0 * damping * math.sqrt(stiffness * mass)
        rotor = Jeffcott(mass, stiffness, support, between(rng, 1e-4, 1.0) * mass * largest)
        machines.append((rotor, fills))
        table[:, k] = critical * between(rng, 0.2, 5.0), 0.0 if rng.random() < 0.5 else GRAVITY
    return machines, table[0], table[1]


def _random_fill(rng: np.random.Generator, radius: float) -> Fill:
    inner = radius * rng.uniform(0.2, 0.9) if rng.random() < 0.4 else 0.0
    chamber = Chamber(radius, radius * between(rng, 0.05, 2.0), inner)
    return Fill(chamber, WATER, between(rng, 1e-3, 0.95) * chamber.capacity)


@dataclass(frozen=True)
class LinearSample:
    """Random machines answered by both models, shape (n,)."""

    linear: Response  #: responses by linear theory and by the exact equilibrium
    exact: Response
    error: LinearError  #: its estimate
    amplitude: Coverage  #: errors and estimates of the amplitude and of the liquid's offset
    liquid: Coverage


def linear_sample(seed: int, count: int) -> LinearSample:
    """Linear theory against the exact equilibrium."""
    machines, speed, gravity = random_machines(seed, count)
    everyone = np.arange(count)
    linear, exact = (
        machine_responses(machines, everyone, speed, gravity, model) for model in (LINEAR, STATICS)
    )
    pairs = pair_machines(machines, everyone, speed, gravity, LINEAR)
    error = planar_enclosure(pairs).error()
    sizes = [np.abs(response.deflection) for response in (linear, exact)]
    return LinearSample(
        linear=linear,
        exact=exact,
        error=error,
        amplitude=Coverage(np.abs(sizes[0] / sizes[1] - 1.0), error.amplitude),
        liquid=Coverage(np.abs(linear.liquid_offset / exact.liquid_offset - 1.0), error.liquid),
    )


def gravity_sample(seed: int, count: int, weakest: float = 4.0, cells: int = 64) -> Coverage:
    """What gravity across the axis changes in the force of a layer in synchronous whirl, settled in time.

    Layers of 0.01 to 0.3 of the radius, deflections of 0.03 to 3 depths, friction of 0.01 to 0.5 of the spin;
    centrifugal acceleration at the surface of `weakest` to 60 times gravity. Layers that do not settle are
    left out.
    """
    rng = np.random.default_rng(seed)
    rows = []
    for _ in range(count):
        depth = between(rng, 0.01, 0.3)
        radius, field = 0.1, between(rng, weakest, 60.0)
        speed = math.sqrt(field * GRAVITY / (radius * (1.0 - depth)))
        chamber = Chamber(radius, 0.02)
        fill = Fill(chamber, WATER, chamber.capacity * depth * (2.0 - depth))
        whirl = Whirl(speed, speed, between(rng, 0.03, 3.0) * depth * radius, gravity=GRAVITY)
        friction = Friction(FrictionLaw.LINEAR, between(rng, 0.01, 0.5) * speed)
        found = settle(fill, whirl, friction, Numerics(cells=cells, dispersion=True))
        if not found.converged:
            continue
        fills, spin = Fills.of([fill]), np.array([speed])
        law = STATICS.answer(fills, Whirls.synchronous(spin, np.array([whirl.amplitude]), np.zeros(1)))
        exact = law.unbalance[0] / (fill.full_mass * whirl.amplitude)
        true = abs(found.force_ratio[-1] - exact)
        rows.append((true, law_error(fills, spin, np.array([GRAVITY]))[0]))
    return Coverage(*np.array(rows).T)


@dataclass(frozen=True)
class HeldSample:
    """Lying machines held in time with and without gravity, each with its estimate."""

    amplitude: Coverage  #: means of the amplitude and of the liquid's offset
    liquid: Coverage
    ripple: Coverage  #: by which both go up and down about their means
    liquid_ripple: Coverage
    strength: Array  #: gravity over the centrifugal acceleration at the surface of each machine, shape (n,)
    thrown: Flags  #: gravity throws the machine into a limit cycle, shape (n,)


def held_sample(seed: int, count: int, cells: int = 48, kind: str = "jeffcott") -> HeldSample:
    """Effect of gravity across the axis on random lying machines that are stable without it.

    One or two chambers with layers of 0.01 to 0.3 of the radius, centrifugal acceleration of 2 to 100 times
    gravity, 0.2 to 5 times the critical speed, deflections of 0.02 to 1.5 depths; without machines whose
    liquid falls. Kind of rotor: "jeffcott", "two_plane" or "tub".
    """
    rng = np.random.default_rng(seed)
    rows, thrown = [], []
    for _ in range(count):
        rotor, fills, speed, friction = _LYING[kind](rng)
        spin = np.array([speed])
        growth = float(asynchronous_growth(rotor, fills, spin, friction)[0][0])
        steady = response(rotor, fills, spin, 0.0)
        if not (growth < -1e-4 * speed and steady.stable[0]):
            continue
        numerics, states = HoldNumerics(cells=cells, turns=400), []
        for gravity in (0.0, GRAVITY):
            machine = HeldMachine(rotor.system(), tuple(fills), friction, gravity)
            begin = start(machine, speed, numerics, steady.coordinates[0])
            states.append(hold(machine, begin, numerics, growth))
        if not (states[1].captured.all() and states[0].settled):
            continue
        estimate = error_estimate(rotor, fills, spin, 0.0, GRAVITY)[1]
        rows.append(_held_row(rotor.system(), fills, states[0], states[1], estimate))
        thrown.append(states[1].kind is HeldKind.LIMIT_CYCLE)
    table = np.array(rows).T
    mean, liquid, ripple, lean = (Coverage(table[2 * k], table[2 * k + 1]) for k in range(4))
    return HeldSample(mean, liquid, ripple, lean, strength=table[8], thrown=np.array(thrown))


def _held_row(
    system: RotorSystem, fills: list[Fill], still: HeldState, held: HeldState, estimate: GravityError
) -> tuple[float, ...]:
    """Errors by gravity and their estimates, and gravity's strength.

    Of a planar rotor the mean distance of the axis counts, of others that of each turn's largest: their orbit
    is an ellipse without gravity, and what it is wider than high is no ripple.
    """
    mass, planar = np.array([fill.mass for fill in fills]), len(system.coordinates) == 2
    before, after = (
        np.array([orbit(system, state.coordinates, fill.chamber.plane).forward for fill in fills])
        + state.liquid
        for state in (still, held)
    )
    shift, size = abs(mass @ (after - before)), abs(mass @ before)
    amplitude = [state.amplitude if planar else state.crest for state in (still, held)]
    wider = 0.0 if planar else still.largest - still.least
    lean = float(held.ripple @ mass / mass.sum())
    strength = max(GRAVITY / (held.spin**2 * fill.surface_radius) for fill in fills)
    return (
        abs(amplitude[1] / amplitude[0] - 1.0), float(estimate.amplitude[0]),
        float(shift / size), float(estimate.liquid[0]),
        max(0.5 * (held.largest - held.least - wider), 0.0) / amplitude[1], float(estimate.ripple[0]),
        lean, float(estimate.liquid_ripple[0]), strength,
    )  # fmt: skip


Lying = tuple[Jeffcott | TwoPlane | Tub, list[Fill], float, Friction]


def _random_layers(rng: np.random.Generator, reach: float = 0.0) -> tuple[float, list[Fill]]:
    """A size, and one or two layers in chambers of at most that radius, `reach` sizes along the axis."""
    largest, fills = between(rng, 0.05, 0.4), []
    for _ in range(int(rng.integers(1, 3))):
        radius = largest * between(rng, 0.4, 1.0)
        height, depth = radius * between(rng, 0.1, 0.6), between(rng, 0.01, 0.3)
        volume = math.pi * height * radius**2 * depth * (2.0 - depth)
        plane = largest * rng.uniform(-reach, reach) if reach else 0.0
        fills.append(Fill(Chamber(radius, height, plane=plane), WATER, volume))
    return largest, fills


def _random_planar(rng: np.random.Generator) -> Lying:
    """Rotor, fills, speed and friction of a lying machine that does not tilt."""
    _, fills = _random_layers(rng)
    mass = sum(fill.full_mass for fill in fills) / between(rng, 0.02, 0.6)
    speed, critical = _random_speed(rng, fills)
    damping, thin = between(rng, 0.02, 0.3), min(fill.depth for fill in fills)
    parts = mass, mass * critical**2, 2.0 * damping * mass * critical
    size = abs(response(Jeffcott(*parts, 1.0), fills, [speed], 0.0).deflection[0])
    rotor = Jeffcott(*parts, between(rng, 0.02, 1.5) * thin / size)
    return rotor, fills, speed, _random_friction(rng, speed)


def _random_friction(rng: np.random.Generator, speed: float) -> Friction:
    """Laminar, or of 0.01 to 0.5 of the spin."""
    if rng.random() >= 0.4:
        return Friction(FrictionLaw.LINEAR, between(rng, 0.01, 0.5) * speed)
    return Friction(FrictionLaw.STOKES)


def _random_speed(rng: np.random.Generator, fills: list[Fill]) -> tuple[float, float]:
    """A speed at which the liquid rides with the drum, and a critical speed about it."""
    surface = max(fill.surface_radius for fill in fills)
    speed = math.sqrt(between(rng, 2.0, 100.0) * GRAVITY / surface)
    return speed, speed / between(rng, 0.2, 5.0)


def _random_two_plane(rng: np.random.Generator) -> Lying:
    """The same of a rotor with two supports and two unbalances, 1 to 6 radii long."""
    largest, fills = _random_layers(rng, reach=2.0)
    mass = sum(fill.full_mass for fill in fills) / between(rng, 0.02, 0.6)
    speed, critical = _random_speed(rng, fills)
    half, damping = largest * between(rng, 0.5, 3.0), between(rng, 0.02, 0.3)
    transverse = mass * (half**2 / 3.0 + largest**2 / 4.0)
    polar = mass * largest**2 * rng.uniform(0.3, 0.6)
    share, places = rng.uniform(0.3, 0.7), half * rng.uniform(0.3, 1.0, 2) * (-1.0, 1.0)
    supports = tuple(
        Support(place, part * mass * critical**2, 2.0 * damping * part * mass * critical)
        for place, part in zip(places.tolist(), (share, 1.0 - share), strict=True)
    )
    unbalances = tuple(
        PlaneUnbalance(half * rng.uniform(-1.0, 1.0), rng.random(), rng.uniform(0.0, 2.0 * math.pi))
        for _ in range(2)
    )
    plain = TwoPlane(mass, transverse, polar, supports, unbalances)
    size = _weakened(rng, plain, fills, speed)
    lighter = tuple(replace(part, size=part.size * size) for part in unbalances)
    return replace(plain, unbalances=lighter), fills, speed, _random_friction(rng, speed)


def _random_tub(rng: np.random.Generator) -> Lying:
    """The same of a drum in a tub, on four springs and dampers of unlike stiffness along the axes."""
    largest, fills = _random_layers(rng, reach=1.0)
    mass = sum(fill.full_mass for fill in fills) / between(rng, 0.02, 0.6)
    speed, critical = _random_speed(rng, fills)
    drum, damping = mass * rng.uniform(0.1, 0.4), between(rng, 0.02, 0.3)
    springs, dampers = [], []
    for corner in ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)):
        sides = largest * rng.uniform(0.7, 1.5, 3) * (corner[0], corner[1], 1.0 if corner[0] > 0.0 else -1.0)
        place = tuple(sides.tolist())
        stiffness = 0.25 * mass * critical**2 * rng.uniform(0.5, 1.5, 3)
        rate = 2.0 * damping / critical * stiffness
        springs.append(Mount(place, along_axes=tuple(stiffness.tolist())))
        dampers.append(Mount(place, along_axes=tuple(rate.tolist())))
    plain = Tub(
        tub_mass=mass - drum, drum_mass=drum,
        tub_inertia=tuple(((mass - drum) * largest**2 * rng.uniform(0.6, 1.4, 3)).tolist()),
        drum_polar_inertia=drum * largest**2 * rng.uniform(0.3, 1.0),
        drum_transverse_inertia=drum * largest**2 * rng.uniform(0.3, 1.0),
        springs=tuple(springs), dampers=tuple(dampers), unbalance=1.0,
        drum_position=(0.0, largest * rng.uniform(0.0, 0.5), 0.0),
        unbalance_position=largest * rng.uniform(-0.7, 0.7),
    )  # fmt: skip
    size = _weakened(rng, plain, fills, speed)
    return replace(plain, unbalance=size), fills, speed, _random_friction(rng, speed)


def _weakened(rng: np.random.Generator, rotor: TwoPlane | Tub, fills: list[Fill], speed: float) -> float:
    """By how much the unbalance is to be scaled: the largest deflection of 0.02 to 1.5 of the least depth."""
    system = rotor.system()
    moved = response(rotor, fills, [speed], 0.0, LINEAR).coordinates[0]
    orbits = [orbit(system, moved, fill.chamber.plane) for fill in fills]
    size = max(abs(complex(part.forward)) + abs(complex(part.backward)) for part in orbits)
    return between(rng, 0.02, 1.5) * min(fill.depth for fill in fills) / size


_LYING = {"jeffcott": _random_planar, "two_plane": _random_two_plane, "tub": _random_tub}


def run_up_sample(seed: int, count: int, cells: int = 64) -> Coverage:
    """Run-ups of 60 to 300 turns with linear layers against long waves with dispersion.

    The error is the largest difference of the amplitudes over the largest amplitude.
    """
    rng = np.random.default_rng(seed)
    rows = []
    for _ in range(count):
        rotor, fills, drive, friction, gravity = random_run_up(rng)

        def run(
            model: RunupModel,
            rotor: Jeffcott = rotor,
            fills: list[Fill] = fills,
            drive: Ramp = drive,
            friction: Friction = friction,
            gravity: float = gravity,
        ) -> RunupHistory:
            numerics = RunupNumerics(cells, 1000, dispersion=True, companion=False)
            return run_up(rotor.system(), fills, drive, friction, gravity, numerics, None, model)

        linear, exact = run(couple_linear), run(couple)
        if not exact.converged:
            continue
        size = min(linear.time.size, exact.time.size)
        gap = np.abs(linear.amplitude[:size] - exact.amplitude[:size]).max()
        rows.append((gap / exact.amplitude.max(), linear_run_error(linear, fills).estimate))
    return Coverage(*np.array(rows).T)


def random_run_up(
    rng: np.random.Generator,
) -> tuple[Jeffcott, list[Fill], Ramp, Friction, float]:
    """Rotor, fills, ramp, friction and gravity across the axis of a short run-up."""
    largest, critical = between(rng, 0.05, 0.4), between(rng, 10.0, 150.0)
    damping, chambers = between(rng, 0.02, 0.3), int(rng.integers(1, 3))
    gravity = GRAVITY if rng.random() < 0.5 else 0.0
    fills = []
    for _ in range(chambers):
        radius = largest * between(rng, 0.4, 1.0)
        height, depth = radius * between(rng, 0.1, 0.6), between(rng, 0.01, 0.3)
        inner = radius * rng.uniform(0.1, 0.6) if rng.random() < 0.3 else 0.0
        volume = math.pi * height * radius**2 * depth * (2.0 - depth)
        fills.append(Fill(Chamber(radius, height, inner), WATER, volume))
    mass = sum(fill.full_mass for fill in fills) / between(rng, 0.02, 0.6)
    thin = min(fill.depth for fill in fills)
    unbalance = between(rng, 0.01, 2.0) * thin * 2.0 * damping * mass * between(rng, 0.3, 3.0)
    rotor = Jeffcott(mass, mass * critical**2, 2.0 * damping * mass * critical, unbalance)
    start = critical * between(rng, 0.2, 1.2)
    stop = start * between(rng, 1.5, 5.0)
    duration = between(rng, 60.0, 300.0) * 4.0 * math.pi / (start + stop)
    rate = (stop - start) / (duration * (1.0 - rng.uniform(0.0, 0.4)))
    drive = Ramp(start, stop, rate, duration, bool(rng.random() < 0.2))
    friction = Friction(FrictionLaw.STOKES)
    if rng.random() >= 0.4:
        friction = Friction(FrictionLaw.LINEAR, between(rng, 0.005, 0.5) * critical)
    return rotor, fills, drive, friction, gravity


def main() -> None:
    """Print the coverage of all estimates on the calibration's seeds."""
    linear = linear_sample(SEEDS["linear"], 3000)
    held = {kind: held_sample(SEEDS["held"], count, kind=kind) for kind, count in HELD.items()}
    samples = {
        f"{kind}, {name.replace('_', ' ')}": getattr(found, name)
        for kind, found in held.items()
        for name in ("amplitude", "liquid", "ripple", "liquid_ripple")
    } | {
        "linear, amplitude": linear.amplitude,
        "linear, liquid": linear.liquid,
        "gravity": gravity_sample(SEEDS["gravity"], 100),
        "run-up": run_up_sample(SEEDS["run_up"], 300),
    }
    print(
        f"{'estimate':26}{'n':>6}{'covered':>9}{'infinite':>10}{'ratio':>8}"
        f"{'true <1%':>10}{'taken':>8}{'refused':>9}"
    )
    for name, sample in samples.items():
        good, taken = sample.within(0.01)
        print(
            f"{name:26}{sample.true.size:6d}{sample.covered:9.3f}{sample.unbounded:10.3f}{sample.ratio():8.3g}"
            f"{good:10.3f}{taken:8.3f}{sample.refused(0.01):9.3f}"
        )


if __name__ == "__main__":
    main()
