"""A horizontal drum from rest and down again, beside computed two-phase flow and drying cylinders."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from fluid.pool import centrifuging_speed
from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Handover
from validation.case import Case, Claims
from validation.page import Figure, page
from validation.study import data, launch, shown

CLAIMS = Claims("lying_drum")
G = 9.81
# A rotor that does not move, a kilogram of liquid on ten thousand.
STILL = Jeffcott(1e6, 1e12, 0.0, 0.0)
_SAMPLE = 0.02  # s
# What a case may be off: rotation over the drum's, torque, centre of mass in m, share above the axis.
ROTATION, TORQUE, PLACE, LIFTED = 0.1, 0.35, 0.04, 0.12


@dataclass(frozen=True)
class Turned:
    """Liquid in a drum whose speed is given, every 20 ms; k times."""

    time: Array  #: s, shape (k,)
    speed: Array  #: of the drum, rad/s
    rotation: Array  #: of the liquid as a whole, rad/s
    torque: Array  #: of the drum on the liquid since the time before, N m per metre
    place: Array  #: of its centre of mass, with the spin and upwards, m, shape (k, 2)
    lifted: Array  #: share above the axis
    mass_error: float
    energy_error: float  #: what the balance leaves, over the drum's work


def turned(
    fill: Fill, friction: Friction, corners: tuple[tuple[float, float], ...], ring: bool = False
) -> Turned:
    """Take a drum through speeds, straight between corners of time and speed; from rest or from a ring."""
    times, speeds = np.array(corners).T
    start = float(speeds[0])
    given = 128, False, False, Handover.CARRIED
    machine = couple(STILL.system(), [fill], start, friction, G, *given)
    if ring and not machine.active[0]:
        # A drum that is slowed from where its ring stands.
        machine = couple(STILL.system(), [fill], 200.0, friction, G, *given)
        machine.shaft.spin = start
        machine.momentum[0] = machine.state.momentum[0] = -start * np.square(machine.area[0])
    begin, drive = machine.energy(), 0.0
    rows: list[list[float]] = []
    for now in np.arange(1, round((times[-1] - times[0]) / _SAMPLE) + 1) * _SAMPLE:
        rate = (np.interp(now, times, speeds) - machine.spin) / (now - machine.time)
        if not ring or len(rows):
            machine.switch()
        outcome = machine.advance(float(now), float(rate), 0.8, 10**6)
        if outcome is not Outcome.DONE:
            break
        work = float(machine.sums.drive) - drive
        drive += work
        rows.append(_row(machine, float(work / (_SAMPLE * machine.spin) / fill.chamber.height)))
    found = np.array(rows)
    sums = machine.sums
    gained = sums.drive + sums.gravity - sums.friction - sums.baffles - sums.lost
    brought = sum(each.energy[1] - each.energy[0] for each in machine.transfers)
    left = machine.energy() - begin - gained - brought
    time, speed, rotation, torque, first, second, lifted = found.T
    lost = abs(float(left)) / max(abs(float(sums.drive)), 1e-300)
    place = np.stack([first, second], axis=1)
    return Turned(time, speed, rotation, torque, place, lifted, machine.mass_error(), lost)


def _row(machine: Coupled, torque: float) -> list[float]:
    """A moment as `Turned` has it."""
    now = machine.read()
    place, own = complex(now.offset[0]), float(machine._turning()[1][0])
    return [now.time, now.speed, own, torque, -place.imag, place.real, float(now.lifted_share[0])]


def computed_drum(height: float | None) -> Fill:
    """Drum of the computed flow with baffles of a height, m, a metre wide."""
    run = reference("L6")
    plates = None if height is None else Baffles(run["N"], run["R"] - height)
    chamber = Chamber(run["R"], 1.0, run["inner"], baffles=plates)
    return Fill(chamber, Liquid("water", 1000.0, 1e-6), run["area"])


@cache
def reference(name: str) -> dict[str, Any]:
    """Computed run: `L6` from rest, `L6d` down from a ring; its series as arrays."""
    run = dict(data("lying_drum.json")[name])
    meta: dict[str, Any] = run.pop("meta")
    return meta | {key: np.array(value) for key, value in run.items()}


@cache
def own(name: str) -> Turned:
    """The package's answer to a computed run."""
    if name == "L6d":
        return turned(
            computed_drum(0.006),
            Friction(FrictionLaw.WALL),
            ((0.0, 20.0), (0.3, 20.0), (4.3, 0.02)),
            ring=True,
        )
    height, rate, top = _RUNS[name]
    up = (0.0, 0.01), (top / rate, top), (top / rate + (1.05 if top == 25.0 else 0.0), top)
    return turned(computed_drum(height), Friction(FrictionLaw.WALL), up)


# Height of the baffles, m, spin rate, rad/s^2 (not printed of the slow ramp), and last speed, rad/s.
_RUNS = {
    "L6": (0.006, 7.5, 25.0),
    "L9": (0.009, 7.5, 25.0),
    "L0": (None, 7.5, 25.0),
    "fast_6": (0.006, 7.5, 36.0),
    "fast_9": (0.009, 7.5, 36.0),
    "slow": (0.006, 3.75, 25.0),
}


def running(values: Array, width: float) -> Array:
    """Means over a time, shape of `values`; nan next to the ends."""
    count = round(width / _SAMPLE)
    found = np.full(values.shape, np.nan)
    inner = np.convolve(values, np.full(count, 1.0 / count), "valid")
    found[count // 2 : count // 2 + inner.size] = inner
    return found


@dataclass(frozen=True)
class Agreement:
    """Share of the times at which an answer is within bounds of the computed flow."""

    rotation: float
    torque: float
    place: float
    lifted: float


def agreement(name: str) -> Agreement:
    """The given bounds, for drum speeds from 4 to 25 rad/s."""
    seen, mine = reference(name), own(name)
    count = min(seen["t"].size, mine.time.size)
    speed = seen["omega"][:count]
    drum = (seen["torque_baffle_pressure"] + seen["torque_baffle_friction"] + seen["torque_wall_friction"])[
        :count
    ]
    between = (speed >= 4.0) & (speed <= 25.0)

    def share(off: Array) -> float:
        known = between & ~np.isnan(off)
        return float(np.mean(off[known] <= 1.0))

    turning = np.abs(running(mine.rotation[:count] - seen["w"][:count], 0.2)) / speed / ROTATION
    first, mean = running(mine.torque[:count], 0.6), running(drum, 0.6)
    moved = [running(mine.place[:count, k] - seen[axis][:count], 0.2) for k, axis in enumerate("xy")]
    up = np.abs(running(mine.lifted[:count] - seen["lifted"][:count], 0.2)) / LIFTED
    return Agreement(
        share(turning),
        share(np.abs(first - mean) / (TORQUE * np.abs(mean))),
        share(np.hypot(*moved) / PLACE),
        share(up),
    )


# Of the computed run with baffles of 9 mm: drum speed and rotation, rad/s, and torque, N m per metre.
NINE = ((3.7, 0.52, 4.5), (6.8, 0.93, 10.9), (9.8, 2.3, 12.7), (12.7, 4.4, 13.0), (15.8, 6.7, 12.5))
NINE_HELD = 14.4  # rad/s, at 25 rad/s held


def stream_law(speed: ArrayLike, height: float) -> Array:
    """Rotation over the drum's speed by the law drawn through the computed runs, 1.3 (b R/A) sqrt(F)."""
    fill = computed_drum(height)
    radius = fill.chamber.radius
    froude = np.square(speed) * radius / G
    return np.asarray(1.3 * height * radius / (fill.volume / fill.chamber.height) * np.sqrt(froude))


def _carried_on() -> list[Case]:
    """On to 36 rad/s, and up half as fast: beside what is said of the computed runs."""
    found, run = [], own("fast_6")
    share = running(run.rotation / run.speed, 0.2)
    for speed in (27.0, 30.0, 33.0, 35.0):
        mine = float(np.interp(speed, run.speed, share))
        law = float(stream_law(speed, 0.006))
        off = abs(mine - law)
        found.append(CLAIMS.case("faster", mine, off <= ROTATION, printed=law, speed=speed, off=off))
    slow = own("slow")
    share = running(slow.rotation / slow.speed, 0.2) - 1.15 * stream_law(slow.speed, 0.006)
    off = float(np.nanmax(np.abs(share[(slow.speed >= 10.0) & (slow.speed < 24.0)])))
    found.append(CLAIMS.case("slower", f"within {off:.3f} of 1.15 times it", off <= ROTATION))
    for name, height, printed in (("fast_6", 6, 33.0), ("fast_9", 9, 25.0)):
        one = own(name)
        lifted = np.nan_to_num(running(one.lifted, 0.2))
        speed = float(one.speed[np.flatnonzero(lifted >= 0.48)[0]])
        found.append(CLAIMS.case("half", speed, printed=printed, height=height))
    past = run.speed > 25.0
    pulls = G * computed_drum(0.006).mass * running(run.place[:, 0], 0.6)[past]
    least, most = float(np.nanmin(pulls)), float(np.nanmax(pulls))
    within = least >= 5.0 and most <= 13.0 * (1.0 + TORQUE)
    found.append(CLAIMS.case("gravity", f"{least:.0f} to {most:.0f} N m per metre", within))
    return found


def fall_speed(run: Turned) -> float:
    """Drum speed at which a ring's own rotation falls below sqrt(g/a), rad/s."""
    stands = math.sqrt(G / computed_drum(0.006).surface_radius)
    return float(run.speed[np.flatnonzero(run.rotation > stands)[-1]])


def cylinder(
    radius: float, depth: float, roughness: float = 0.0, bars: bool = False
) -> tuple[Fill, Friction]:
    """A drying cylinder with hot water, a metre wide."""
    plates = Baffles(24, radius - 0.5 * depth) if bars else None
    volume = math.pi * depth * (2.0 * radius - depth)
    water = Liquid("water at 150 C", 917.0, 2.0e-7)
    return Fill(Chamber(radius, 1.0, baffles=plates), water, volume), Friction(
        FrictionLaw.WALL, roughness=roughness
    )


@cache
def rimming(radius: float, depth: float, roughness: float, bars: bool = False) -> tuple[float, float, float]:
    """Speed of rimming over that at which a ring can stand; torque before and after, N m per metre.

    In a slow start, to seven times g: the torque is the largest on the way, and the mean after.
    """
    fill, friction = cylinder(radius, depth, roughness, bars)
    unit = math.sqrt(G / radius)
    run = turned(fill, friction, ((0.0, 0.7 * unit), (30.0, math.sqrt(7.0) * unit)))
    rides = run.rotation > 0.7 * run.speed
    if not rides[-1]:
        return math.inf, float(running(run.torque, 1.0)[25:-26].max()), math.nan
    k = int(np.flatnonzero(~rides)[-1]) + 1
    stands = math.sqrt(G / fill.surface_radius)
    after = float(run.torque[min(k + 100, run.torque.size - 50) :].mean())
    return float(run.speed[k] / stands), float(np.nanmax(running(run.torque, 1.0)[:k])), after


def cases() -> list[Case]:
    """Computed flow up and down; the makers' rule and statements about drying cylinders."""
    found, nine = [], own("L9")
    for name in ("L6", "L6d"):
        shares = agreement(name)
        for quantity, bound in (("rotation", 0.75), ("torque", 0.75), ("place", 0.75), ("lifted", 0.75)):
            share = float(getattr(shares, quantity))
            found.append(
                CLAIMS.case(
                    f"{quantity}", f"{share:.0%} of the times", share >= bound, run=name, way=_WAYS[name]
                )
            )
    for speed, rotation, torque in NINE:
        k = int(np.argmin(np.abs(nine.speed - speed)))
        near = slice(k - 5, k + 5)
        turning = float(nine.rotation[near].mean())
        off = abs(turning - rotation) / speed
        found.append(CLAIMS.case("nine", turning, off <= ROTATION, printed=rotation, speed=speed, off=off))
        found.append(
            CLAIMS.case(
                "nine_torque", float(nine.torque[k - 15 : k + 15].mean()), printed=torque, speed=speed
            )
        )
    held = float(nine.rotation[-10:].mean())
    found.append(
        CLAIMS.case(
            "nine_held",
            held,
            abs(held - NINE_HELD) <= 2.5,
            printed=NINE_HELD,
            off=abs(held - NINE_HELD) / 25.0,
        )
    )
    found.append(CLAIMS.case("fall", fall_speed(own("L6d")), printed=3.3))
    smooth = own("L0")
    early = smooth.time < 1.6
    most = float(smooth.rotation[early].max())
    found.append(CLAIMS.case("smooth", f"{most:.2f} rad/s", most < 0.3 + ROTATION * 12.0, most=most))
    return found + _carried_on() + _cylinders()


_WAYS = {"L6": "spun up from rest to 25 rad/s", "L6d": "from a ring at 20 rad/s down"}


def _cylinders() -> list[Case]:
    """Drying cylinders of 1.524 and 1.83 m."""
    found = []
    for radius in (0.762, 0.915):
        stands = math.sqrt(G * radius)
        low, high = 2.54, 3.56
        found.append(CLAIMS.case("stands", stands, low < stands < high, size=2.0 * radius, speed=stands))
        ratios = [rimming(radius, depth, 5e-5)[0] for depth in (1.5e-3, 3e-3)]
        within = all(1.7 / 1.3 <= ratio <= 1.9 * 1.3 for ratio in ratios)
        shown = " and ".join(f"{ratio:.2f}" for ratio in ratios)
        found.append(CLAIMS.case("rims", shown, within, size=2.0 * radius))
        found.append(CLAIMS.case("less", shown, ratios[0] < ratios[1], size=2.0 * radius))
    _, before, after = rimming(0.762, 1.5e-3, 5e-5)
    found.append(
        CLAIMS.case("torque_falls", f"{before:.0f} and {after:.0f} N m per metre", after < 0.2 * before)
    )
    fill, friction = cylinder(0.762, 3e-3, 5e-5)
    plain, barred = centrifuging_speed(fill, friction, G), centrifuging_speed(*_barred(), G)
    found.append(CLAIMS.case("bars", f"{barred / plain:.2f} times", barred < plain))
    return found


def _barred() -> tuple[Fill, Friction]:
    """The cylinder with bars of half the depth of its liquid."""
    return cylinder(0.762, 3e-3, 5e-5, bars=True)


def drum_figure() -> Figure:
    """Rotation, torque and centre of mass over time, up and down."""
    text = (
        "Liquid of 13.7 mm on a horizontal drum of 240 mm radius with eight baffles of 6 mm, from rest to "
        "25 rad/s (left) and from a ring at 20 rad/s down (right): rotation of the liquid, torque of the "
        "drum on it per metre (means over 0.6 s), height of its centre of mass. Lines: two layers and long "
        "waves; points: computed two-phase flow, plane and laminar. Thin line: the drum."
    )
    with page([1.6, 1.6, 1.6], text, columns=(2, 2, 2), between=0.35, apart=0.5) as (figure, rows):
        for column, name in enumerate(("L6", "L6d")):
            seen, mine = reference(name), own(name)
            drum = (
                seen["torque_baffle_pressure"] + seen["torque_baffle_friction"] + seen["torque_wall_friction"]
            )
            some = slice(5, None, 8)
            points = {
                "marker": "s",
                "markersize": 2.6,
                "linestyle": "none",
                "markerfacecolor": "white",
                "color": "#0072B2",
            }
            for axes, line, values in (
                (rows[0][column], mine.rotation, seen["w"]),
                (rows[1][column], running(mine.torque, 0.6), running(drum, 0.6)),
                (rows[2][column], 1e3 * mine.place[:, 1], 1e3 * seen["y"]),
            ):
                axes.plot(mine.time, line, color="#D55E00", linewidth=1.3)
                axes.plot(seen["t"][some], values[some], **points)
            rows[0][column].plot(mine.time, mine.speed, color="0.5", linewidth=0.7)
            rows[2][column].set_xlabel("Time (s)")
        for axes, label in zip(
            (row[0] for row in rows), ("Rotation (rad/s)", "Torque (N m/m)", "Height (mm)"), strict=True
        ):
            axes.set_ylabel(label)
        for axes, title in zip(rows[0], ("from rest", "a ring that falls"), strict=True):
            axes.set_title(title, fontsize=8)
    return figure


if __name__ == "__main__":
    launch(shown(lying_drum=drum_figure))
