"""What two balls do beyond the critical speed [YF17, section 5.3], and how the stuck motion ends.

Both take minutes; they are kept in `validation/data/exciter_beyond.json`, which `python -m
validation.cases.exciter.beyond --anew` makes anew.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from meshes.arrays import Array
from solvers.rotor.exciter.machine import Dimensionless, characteristic_speeds, stuck_speeds
from solvers.rotor.exciter.motion import RANGES, Start, critical_speed, initial_state, placed_state
from solvers.rotor.exciter.regimes import Kind, Regime, decay_time, regime
from solvers.rotor.exciter.spectrum import Lines, combination, lines, spectrum
from solvers.rotor.exciter.stability import (
    capture_unbalance,
    parting_roots,
    resonance_speed,
    stuck_roots,
    third_speed,
)
from solvers.rotor.exciter.tangent import follow
from validation.case import Case
from validation.cases.exciter.speeds import CLAIMS, MACHINE, sample
from validation.page import Figure, logarithmic, page
from validation.study import data, launch, shown

DATA = Path(__file__).parents[2] / "data" / "exciter_beyond.json"
# Smallness and damping of a map; the first that of the typical experiment, the other the corner of the
# source's ranges where a ball at the third speed slips most.
MAPS = ((0.01, 0.03), (0.005, 0.07))
UNBALANCES = tuple(np.round(np.linspace(*RANGES["unbalance"], 7), 4).tolist())
DRAGS = tuple(np.round(np.linspace(*RANGES["drag"], 7), 4).tolist())
BEYOND = 1.25  # speed of the shaft over the critical one
DECAYS = 15.0  # length of a run of the map in decay times
STARTS = ("released", "resonance and third", "shaft and third", "both third")
# The typical experiment with a fifth of its unbalance, beyond its critical speed: three frequencies.
THREE = Dimensionless(smallness=0.01, drag=0.4, unbalance=0.05, damping=0.03)
THREE_SPEED = 8.15
# A machine in the source's ranges that stays chaotic long.
CHAOTIC = Dimensionless(smallness=0.00695, drag=0.1322, unbalance=0.8909, damping=0.04845)
CHAOTIC_SPEED = 34.0
SWEPT = (0.001, 0.005, 0.01, 0.02, 0.05)
SWEPT_UNBALANCES = (0.0, 0.25, 1.0)
_PRINTED_TIME = 315.0 * 2.0 * math.pi  # when figure 3 of the source begins, the balls' turns at about 1
_ORDER = 5  # of the combinations of frequencies looked for


def start_state(machine: Dimensionless, speed: float, start: str) -> Array:
    """State at the start of a run of the map at shaft speed n, one of `STARTS`.

    Released 0.3 rad apart as the critical speed is searched; or placed in steady motion: one ball at the
    resonance and one at the third stuck speed; one opposite to the unbalance and one at the third speed; both
    at the third speed of one, 2 rad apart.
    """
    if start == "released":
        return initial_state(machine, speed, 1.0, 2, Start())
    third = third_speed(machine, speed, 0.5)
    low = min(resonance_speed(machine, speed, 0.5), 1.0)
    speeds, angles = {
        "resonance and third": ((low, third), (0.0, 0.0)),
        "shaft and third": ((speed, third), (math.pi, 0.0)),
        "both third": ((third, third), (0.0, 2.0)),
    }[start]
    return placed_state(machine, speed, speeds, angles)


@dataclass(frozen=True)
class Three:
    """A motion with three frequencies and the lines of its platform."""

    regime: Regime  #: of the two balls
    lines: Lines  #: of the platform
    #: of each line the integers that make it of the two balls' speeds and the shaft's; None if none do
    made_of: tuple[tuple[int, ...] | None, ...]
    made_of_two: tuple[tuple[int, ...] | None, ...]  #: the same of the resonance's ball and the shaft


@cache
def three_frequencies() -> Three:
    """One ball at the resonance, one at the third stuck speed, an unbalance that catches neither."""
    state = start_state(THREE, THREE_SPEED, "resonance and third")
    found = regime(THREE, THREE_SPEED, state, samples=1 << 14)
    seen = lines(found.motion.samples, found.motion.sample_time, 0.005)
    slow, fast = np.sort(found.ball_speed)
    near = 4.0 * seen.resolution

    def made(basic: tuple[float, ...]) -> tuple[tuple[int, ...] | None, ...]:
        return tuple(combination(w, basic, _ORDER, near) for w in seen.frequency.tolist())

    return Three(found, seen, made((slow, fast, THREE_SPEED)), made((slow, THREE_SPEED)))


def cases() -> Iterator[Case]:
    """How the stuck motion ends, one ball at the third stuck speed, and what the runs of the maps end in."""
    kept = data(DATA.name)
    through, parting = characteristic_speeds(MACHINE).through_resonance, _slowest_parting()
    typical = next(s for s in kept["sweeps"] if s["smallness"] == 0.01 and s["unbalance"] == 0.25)
    known = {"difference": 7.0 / through - 1.0, "growing": _growing_roots(), "lost": typical["lost"]}
    yield CLAIMS.case("stuck-stable-up-to", through, abs(7.0 - through) <= 0.05, **known)
    yield CLAIMS.case("third-together", parting, parting <= 0.0)
    found = three_frequencies()
    third, all_told = found.regime.kind is Kind.THIRD, all(made is not None for made in found.made_of)
    beyond = sum(made is None for made in found.made_of_two)
    yield CLAIMS.case(
        "third-speed",
        float(found.regime.ball_speed.max()),
        printed=third_speed(THREE, THREE_SPEED, 0.5),
        note="eq. 9 with chi = h/(2 b), one ball of two" + ("" if third else "; it did not stay there"),
    )
    yield CLAIMS.case(
        "third-lines",
        ", ".join(f"{w:.3f}" for w in found.lines.frequency.tolist()),
        third and all_told and beyond,
        difference="none" if all_told else "other lines",
        note=f"all are sums of the three speeds; {beyond} of {len(found.made_of)} are not sums of two",
    )
    runs = kept["runs"]
    counts = Counter(row["kind"] for row in runs)
    seen = ", ".join(f"{kind.value} {counts[kind.value]}" for kind in Kind if counts[kind.value])
    longest = max(row["chaos"] for row in [*runs, *kept["chaos"]])
    # Chaos is kept in decay times.
    chaotic = [
        row for row in runs
        if row["chaos"] / min(row["smallness"] * row["drag"], row["damping"]) >= _PRINTED_TIME
    ]  # fmt: skip
    note = "kept runs over the source's ranges of b and delta, four starts each"
    for key, what, number, more in (
        ("balancing", "balanced in the end", counts[Kind.BALANCED.value], f"{note}: {seen}"),
        (
            *("third", "at least one ball at the third stuck speed in the end", counts[Kind.THIRD.value]),
            f"{note}; one ball there, the other at the resonance or with the shaft, or both swinging around "
            "opposite places",
        ),
        (
            *("chaos", "chaotic for as long as the source's figure 3 runs, 315 turns", len(chaotic)),
            f"{note}; {counts[Kind.CHAOTIC.value]} still chaotic after {DECAYS:g} decay times; the longest "
            f"chaos seen lasts {longest:.0f} of them; most runs followed longer ended in another motion",
        ),
    ):
        yield CLAIMS.case("beyond", float(number), number, key=key, runs=len(runs), what=what, note=more)


@cache
def _growing_roots() -> int:
    """Machines of the sample whose slowest stuck motion has a growing root below n2."""
    count = 0
    for machine in (Dimensionless(*row) for row in sample().tolist()):
        through = characteristic_speeds(machine).through_resonance
        speeds = 1.0 + (through - 1.0) * np.linspace(0.05, 0.999, 40)
        slowest = stuck_speeds(speeds, machine)[:, 0]
        count += any(stuck_roots(machine, float(q))[0].real > 0.0 for q in slowest)
    return count


@cache
def _slowest_parting() -> float:
    """Smallest growth of the parting of two balls at the third stuck speed, over the sample."""
    found = []
    for machine in (Dimensionless(*row) for row in sample().tolist()):
        first = characteristic_speeds(machine).second_pair
        if math.isfinite(first):
            found.append(float(parting_roots(machine, third_speed(machine, 1.25 * first))[0].real))
    return min(found)


def sweep(
    machine: Dimensionless, start: float, stop: float, step: float = 0.02, hold: float = 60.0
) -> dict[str, float]:
    """Raise the shaft's speed slowly from the stuck motion until a ball passes 1.3 natural frequencies.

    `lost`: speed at which a ball passed, nan if none did; `apart`: angle between the balls before that. Balls
    closer than a thousandth are set that far apart at each step, so that they can part.
    """
    speed, phase, apart = start, 0.0, 1e-3
    state = initial_state(machine, start, float(stuck_speeds(start, machine)[0]), 2, Start("regime", apart))
    while speed < stop:
        found = follow(machine, speed, state, hold, blocks=4, start=phase / speed)
        if found.ball_speed[-1].max() > 1.3:
            return {"lost": speed, "apart": apart}
        state, phase = found.state, speed * found.time
        apart = abs((state[2] - state[3] + math.pi) % (2.0 * math.pi) - math.pi)
        if apart < 1e-3:
            state[3] = state[2] + 1e-3
        speed += step
    return {"lost": math.nan, "apart": apart}


def run(machine: Dimensionless, speed: float, start: str) -> dict[str, Any]:
    """One run of a map as it is kept; chaos in decay times."""
    found = regime(machine, speed, start_state(machine, speed, start), DECAYS)
    return {
        "smallness": machine.smallness,
        "damping": machine.damping,
        "drag": machine.drag,
        "unbalance": machine.unbalance,
        "speed": round(speed, 3),
        "start": start,
        "kind": found.kind.value,
        "places": [place.value for place in found.places],
        "ball_speed": [round(float(value), 5) for value in found.ball_speed],
        "growth": round(found.growth, 5),
        "chaos": round(found.chaos / decay_time(machine), 2),
    }


def long_chaos(seed: int, decays: float = 60.0, steps: int = 24) -> dict[str, float]:
    """Run of the machine that stays chaotic over `decays` decay times, from scattered balls."""
    random = np.random.default_rng(seed)
    angles, speeds = random.uniform(0.0, 2.0 * math.pi, 2), random.uniform(0.5, 1.0, 2) * CHAOTIC_SPEED
    state = np.concatenate(([0.0, 0.0], angles, speeds))
    time = decays * decay_time(CHAOTIC)
    found = regime(CHAOTIC, CHAOTIC_SPEED, state, decays, steps)
    blocks = found.motion.growth.size
    until = max(1, round(found.chaos / time * blocks))
    return {
        "seed": seed,
        "chaos": round(found.chaos / decay_time(CHAOTIC), 2),
        "growth": round(float(found.motion.growth[:until].mean()), 4),
        "kind": found.kind.value,  # type: ignore[dict-item]
    }


def measure(workers: int = 1) -> dict[str, Any]:
    """Make the kept runs anew, in threads."""

    def cell(machine: Dimensionless) -> list[dict[str, Any]]:
        critical = critical_speed(machine, width=0.2, ratio=1.2).holds
        return [run(machine, BEYOND * critical, start) for start in STARTS]

    machines = [
        Dimensionless(small, *pair, damping) for small, damping in MAPS for pair in product(DRAGS, UNBALANCES)
    ]
    with ThreadPoolExecutor(max_workers=workers) as pool:
        runs = [row for found in pool.map(cell, machines) for row in found]
        chaos = list(pool.map(long_chaos, range(8)))
    sweeps = []
    for smallness, unbalance in product(SWEPT, SWEPT_UNBALANCES):
        found = sweep(Dimensionless(smallness, 0.4, unbalance, 0.03), 12.0, 22.3)
        rounded = {name: round(value, 4) for name, value in found.items()}
        sweeps.append({"smallness": smallness, "unbalance": unbalance} | rounded)
    return {"runs": runs, "chaos": chaos, "sweeps": sweeps}


def keep() -> None:
    """Measure, and keep one run a line."""
    kept = measure()
    about = "Beyond the critical speed of YF17: maps, chaos, run-ups; by validation.cases.exciter.beyond."
    rows = ",\n".join(
        f' "{name}": [\n' + ",\n".join("  " + json.dumps(row) for row in kept[name]) + "\n ]" for name in kept
    )
    DATA.write_text(f'{{\n "about": {json.dumps(about)},\n{rows}\n}}\n', encoding="utf-8")


def beyond_figure() -> Figure:
    """Spectra of three frequencies and of chaos, and two maps of what is reached over drag and unbalance."""
    text = (
        "Above: spectrum of the platform with one ball at the resonance and one at the third stuck "
        "speed (eps = 0.01, b = 0.4, delta = 0.05, h = 0.03, n = 8.15), and in chaos over two decay "
        "times (eps = 0.00695, b = 0.132, delta = 0.891, h = 0.0485, n = 34). Below: what four starts "
        "end in at 1.25 times the critical speed, marks of one machine side by side; line: the unbalance "
        "past which one ball of two can slip, the other at the resonance (theory: exciter, eq. 7)."
    )
    room = {"left": 0.6, "top": 0.25, "between": 0.75, "below": 0.45, "apart": 0.65}
    with page([1.7, 2.4], text, (2, 2), **room) as (figure, [[three, chaos], bottom]):
        found = three_frequencies().regime
        frequency, amplitude = spectrum(found.motion.samples, found.motion.sample_time)
        three.plot(frequency, amplitude, color="black", linewidth=0.8)
        places = (0.98, float(found.ball_speed.max()), THREE_SPEED)
        for name, at, side in zip(
            ("resonance", "third", "shaft"), places, ("left", "right", "left"), strict=True
        ):
            height = float(amplitude[np.abs(frequency - at) < 0.05].max())
            shift = -3 if side == "right" else 3
            three.annotate(name, (at, height), (shift, 2), textcoords="offset points", ha=side, fontsize=7)
        state, time = start_state(CHAOTIC, CHAOTIC_SPEED, "both third"), 2.0 * decay_time(CHAOTIC)
        run = follow(CHAOTIC, CHAOTIC_SPEED, state, time, samples=1 << 16, sampled=0.9)
        chaos.plot(*spectrum(run.samples, run.sample_time), color="C1", linewidth=0.5)
        for axes, end, title in (
            (three, 10.0, "Three frequencies"),
            (chaos, 60.0, f"Chaos, growth {run.growth.mean():.2f}"),
        ):
            logarithmic(axes, y=[1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0])
            axes.set(ylim=(1e-4, 30.0), xlim=(0.0, end), xlabel="Frequency (\N{EN DASH})", title=title)
        for axes, (smallness, damping) in zip(bottom, MAPS, strict=True):
            _map(axes, smallness, damping)
        three.set_ylabel("Amplitude (\N{EN DASH})")
        bottom[0].set_ylabel("Drag b (\N{EN DASH})")
    return figure


def _map(axes: Any, smallness: float, damping: float) -> None:
    """Marks of what is reached from any of the starts, and the bounds of the third speed."""
    rows = [
        row for row in data(DATA.name)["runs"] if (row["smallness"], row["damping"]) == (smallness, damping)
    ]
    balanced, third = (
        [row for row in rows if row["kind"] == kind.value] for kind in (Kind.BALANCED, Kind.THIRD)
    )
    square = {"marker": "s", "s": 16, "color": "black", "linewidths": 0.0}
    ring = {"marker": "o", "s": 36, "facecolors": "none", "edgecolors": "C0", "linewidths": 1.2}
    cross = {"marker": "x", "s": 28, "color": "C1", "linewidths": 1.2}
    for name, chosen, shift, look in (
        ("balanced", balanced, -0.045, square),
        ("third speed", third, 0.0, ring),
        ("chaotic for 5 decay times or longer", [row for row in rows if row["chaos"] >= 5.0], 0.045, cross),
    ):
        places = sorted({(row["unbalance"], row["drag"]) for row in chosen})
        if places:
            unbalance, drag = np.array(places).T
            axes.scatter(unbalance + shift, drag, label=name, zorder=3, **look)
    drags, bound = sorted({row["drag"] for row in rows}), []
    for drag in drags:  # past which one of two balls can slip, at the runs' mean speed
        speed = float(np.mean([row["speed"] for row in rows if row["drag"] == drag]))
        bound.append(capture_unbalance(Dimensionless(smallness, drag, 0.0, damping), speed, 0.5))
    axes.plot(bound, drags, color="0.45", linewidth=1.0, label="bound of the third speed")
    axes.set(xlim=(-0.1, 1.1), xticks=sorted({row["unbalance"] for row in rows}), ylim=(0.05, 0.65))
    axes.xaxis.set_major_formatter(lambda value, _place: f"{value:.2g}")
    axes.set_xlabel("Unbalance \N{GREEK SMALL LETTER DELTA} (\N{EN DASH})")
    axes.set_title(f"\N{GREEK SMALL LETTER EPSILON} = {smallness:g}, h = {damping:g}")


if __name__ == "__main__":
    launch(shown(anew=keep, exciter_beyond=beyond_figure))
