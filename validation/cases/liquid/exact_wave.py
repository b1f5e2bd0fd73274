"""The nonlinear wave against two other codes of its equations, analysis and computed two-phase flow."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from fluid import waves
from fluid.waves import force_ratio
from meshes.arrays import Array
from solvers.liquid_model import Whirl
from solvers.potential.histories import simulate
from solvers.potential.in_time import Steps, advance
from solvers.potential.model import Potential
from solvers.potential.steady import (
    SteadyWave,
    follow,
    forced,
    free,
    linear_detuning,
    on_more_nodes,
    on_nodes,
)
from solvers.potential.strip import nodes
from solvers.potential.unsteady import Surface, force, invariants, started
from validation.breaking import kept
from validation.case import COMPUTED_FLOW, Case, Origin, Value, Verdict
from validation.cases.liquid.layer import bore_reference, plane_layer
from validation.exact import SMOOTH, detuning, whirl_speeds
from validation.exact.long_wave import steady_long_wave
from validation.page import Figure, page
from validation.study import data

_SOURCE = "two other codes, exact_wave.json"
_FLOW = "interFoam, openfoam_layer.json"
_CLOSED = "closed form"
_ORIGINS = {
    _SOURCE: Origin(
        "second code", "two codes in numpy of the same equations, with even nodes and by a Moebius map"
    ),
    _FLOW: COMPUTED_FLOW,
}
_EXACT = Origin("closed form", "circles, twins and what is conserved")
# Newton's method, on matrices of some hundred rows, and the last of twelve digits, which is not sure.
_ROUNDING = 3e-12
# By its file the flow is right to this; the absolute part is the gas.
_FLOW_ERROR, _GAS, _BORE_ERROR = 0.006, 0.002, 0.03
# A wave and its twin, circles and what they pull with.
_TWIN, _CIRCLE = 1e-10, 1e-13
# Volume, energy and angular momentum, which are of the order of 0.1 to 1.
_KEPT = 1e-12
_TWINS = ((0.1, 0.7, 0.05), (0.1, 0.85, 0.1), (0.3, 1.3, 0.1), (0.5, 0.9, 0.1), (0.7, 0.9, 0.05))
_HELD = 5.0
_CIRCLES = (0.5, 0.8, 0.9, 0.99)
# Share of the resonance's whirl periods by which ends may be earlier than the other code's, whose steps are
# others.
_EARLIER = 0.02


def cases() -> list[Case]:
    """Steady waves, natural sloshing waves, ends of branches, twins and circles, computed flow, breaking."""
    table = data("exact_wave.json")
    of_table = (_forced, _models, _free, _ends_of_free, _folds)
    found = [case for part in of_table for case in part(table)]
    return [*found, *_twins(), *_circles(), *_in_time(), *_flow(), *_breaking(table)]


def last_place(text: str) -> float:
    """Unit of the last digit of a number in print."""
    return float(f"1e-{len(text.partition('.')[2])}")


def held(row: dict[str, Any]) -> SteadyWave:
    """Wave of a row's whirl, with the row's depth and whirl speed."""
    return forced(row["depth"], (1.0 - 1.0 / row["whirl_speed"]) ** 2, row["whirl"] * row["depth"])


def fold_whirl(layer: float, apart: float) -> float:
    """Largest w_0/h_0 of the branch out of phase with the whirl, by wave height; apart = p/p_1 above 1."""
    from scipy.optimize import minimize_scalar

    square = apart**2 * linear_detuning(layer)
    wave = forced(layer, square, 1e-3 * layer)
    if not wave.converged:
        return math.nan
    # The whirl over the height: up, until it falls.
    passed = [wave]
    while len(passed) < 2 or abs(passed[-1].whirl) > abs(passed[-2].whirl):
        goal = {"detuning": square, "height": 1.1 * (passed[-1].crest - passed[-1].trough)}
        passed.append(follow(passed[-1], goal, 1))
        if not passed[-1].converged:
            return math.nan
    near = passed[-2]

    def whirl(height: float) -> float:
        return -abs(follow(near, {"detuning": square, "height": height}, 1).whirl)

    first, last = (each.crest - each.trough for each in (passed[max(len(passed) - 3, 0)], passed[-1]))
    found = minimize_scalar(whirl, bounds=(first, last), method="bounded", options={"xatol": 1e-7})
    return float(-found.fun) / layer


def _case(
    name: str, source: str, quantity: str, values: tuple[Value, Value, Value], agrees: bool, note: str = ""
) -> Case:
    """A case of this group; its values are what is printed, what is computed and the difference."""
    verdict: Verdict = "agrees" if agrees else "differs"
    origin = _ORIGINS.get(source, _EXACT)
    return Case(f"exact_wave/{name}", source, quantity, *values, verdict, note, origin=origin)


def _digits(
    name: str, quantity: str, printed: str, computed: float, note: str = "", near: float = 1.0
) -> Case:
    """A number to the digits that are printed: half a unit of rounding, half of doubt, and our own."""
    value = float(printed)
    off = abs(computed - value)
    agrees = off <= near * last_place(printed) + _ROUNDING
    return _case(name, _SOURCE, quantity, (value, computed, computed - value), agrees, note)


def _named(row: dict[str, Any]) -> str:
    whirl = f"-{row['whirl']:g}" if "whirl" in row else ""
    return f"{row['depth']:g}-{row['whirl_speed']:g}{whirl}"


def _forced(table: dict[str, Any]) -> Iterator[Case]:
    for row in table["forced"]:
        wave, name = held(row), f"forced-{_named(row)}"
        yield _digits(f"{name}-force", "force ratio", row["force"], wave.force_ratio)
        yield _digits(f"{name}-crest", "crest over the depth", row["crest"], wave.crest)
        yield _digits(f"{name}-trough", "trough over the depth", row["trough"], wave.trough)


def _models(table: dict[str, Any]) -> Iterator[Case]:
    """The models that the fully nonlinear wave measures, where it is smooth and next to the resonance."""
    for row in table["linear"]:
        found = float(waves.force_ratio(1.0 / (1.0 - row["depth"]) ** 2, row["whirl_speed"]))
        yield _digits(f"linear-{_named(row)}", "force ratio, small waves", row["force"], found)
    for row in table["models"]:
        yield _digits(f"models-{_named(row)}-exact", "force ratio", row["force"], held(row).force_ratio)
        square = (1.0 - 1.0 / row["whirl_speed"]) ** 2
        for key, dispersion in (("long_wave", False), ("dispersion", True)):
            if key in row:
                wave = steady_long_wave(row["depth"], square, row["whirl"] * row["depth"], dispersion)
                # Those are of waves through time on cells, which are in the third digit after the point.
                allowed = 3e-3 * max(1.0, abs(wave.force_ratio)) / last_place(row[key])
                words = "force ratio, long waves" + (" with dispersion" if dispersion else "")
                note = "printed of waves on cells, computed without them; agrees within 0.3 %"
                yield _digits(
                    f"models-{_named(row)}-{key}", words, row[key], wave.force_ratio, note, near=allowed
                )
    for row in table["near_resonance"]:
        found = held(row).force_ratio
        # What the whirl speed, printed with four digits, leaves open.
        pair = [held(row | {"whirl_speed": row["whirl_speed"] + off}).force_ratio for off in (-5e-5, 5e-5)]
        near = 1.0 + (max(pair) - min(pair)) / last_place(row["force"])
        note = f"the whirl speed's last digit leaves {min(pair):.5g} to {max(pair):.5g} open"
        yield _digits(f"near-{_named(row)}", "force ratio", row["force"], found, note, near)


def _free(table: dict[str, Any]) -> Iterator[Case]:
    for depth, column in table["free"].items():
        for crest, speed in column.items():
            layer, name = float(depth), f"free-{depth}-{crest}"
            if float(crest) == 1.0:
                p = math.sqrt(linear_detuning(layer))
                found = -p / (1.0 + p)
            else:
                wave = free(layer, float(crest))
                wave = on_more_nodes(wave, {"whirl": 0.0, "crest": float(crest)}) if wave.converged else wave
                found = wave.slip_speeds()[1] if wave.converged and wave.single else math.nan
            near = 2.0 if crest == "1.60" and depth == "0.05" else 1.0  # as it is printed: (2 units)
            yield _digits(name, "speed of the backward free wave over the spin", speed, found, near=near)


def _ends_of_free(table: dict[str, Any]) -> Iterator[Case]:
    from scipy.optimize import minimize_scalar

    for row in table["greatest"]:
        layer, near = row["depth"], float(row["crest"])
        wave = free(layer, near - 0.01)

        def slip(crest: float, begin: SteadyWave = wave) -> float:
            return follow(begin, {"whirl": 0.0, "crest": crest}, 1).slip_speeds()[1]

        found = minimize_scalar(
            slip, bounds=(near - 0.01, near + 0.008), method="bounded", options={"xatol": 1e-4}
        )
        case = _digits(f"greatest-{layer}", "greatest backward speed", row["speed"], float(-found.fun))
        note = f"at a crest of {found.x:.4g} depths, printed {row['crest']}"
        if case.verdict == "differs" and -found.fun > float(row["speed"]):
            # A greater one is found: what is printed is the greatest of the waves that were computed.
            case = replace(case, verdict="erratum", note=f"{note}; a faster wave than the printed one")
        yield replace(case, note=case.note or note)
    highest = {round(row.depth, 6): row.crest for row in kept().highest}
    for row in table["limiting"]:
        found_crest, value = highest[row["depth"]], float(row["crest"])
        off = found_crest - value
        yield _case(
            *(f"limiting-{row['depth']}", _SOURCE, "limiting crest over the depth"),
            (value, found_crest, off),
            abs(off) <= row["within"],
            f"printed to {row['within']:g}; computed: kept by validation.breaking",
        )


def _folds(table: dict[str, Any]) -> Iterator[Case]:
    for depth, column in table["folds"].items():
        for apart, whirl in column.items():
            found = fold_whirl(float(depth), float(apart))
            name = f"fold-{depth}-{apart}"
            yield _digits(name, "largest whirl over the depth of the out-of-phase branch", whirl, found)


def _twins() -> Iterator[Case]:
    """One wave, put into two drums: the equations in time know whirl speeds with their signs."""
    for layer, speed, share in _TWINS:
        wave, twin = (held({"depth": layer, "whirl_speed": speed, "whirl": share}), 1.0 / (2.0 - 1.0 / speed))
        pair = [_after(wave, each) for each in (speed, twin)]
        off = abs(pair[1] - pair[0])
        yield _case(
            *(f"twins-{layer}-{speed}", "theory: potential, eq. 9"),
            f"force ratio a time of {_HELD:g} after, at {speed:g} of the spin and at its twin {twin:.5g}",
            (pair[0].real, pair[1].real, off),
            off <= _TWIN and abs(pair[0] - wave.force_ratio) <= _TWIN,
        )


def _after(wave: SteadyWave, speed: float) -> complex:
    """Force coefficient, by the pressure on the wall, of a wave that a whirl has held for a while."""
    slip, size = speed - 1.0, abs(wave.whirl) * speed**2
    begin, steps = started(wave, slip, 256), Steps(256, 256)
    end = advance(begin, _HELD, lambda time: size * cmath.exp(1j * slip * time), steps).surface
    return force(end.state, size * cmath.exp(1j * slip * _HELD)) / (
        math.pi * size * cmath.exp(1j * slip * _HELD)
    )


def _circles() -> Iterator[Case]:
    for share in _CIRCLES:
        wave = forced(0.1, 0.0, 0.1 * share)
        # The surface is a circle of radius a about the axis of spin, which lies w_0 from the drum's.
        radius = np.exp(-wave.surface)
        place = radius * np.exp(1j * wave.angle) + abs(wave.whirl) * math.copysign(1.0, wave.whirl)
        off = float(np.abs(np.abs(place) - 0.9).max())
        pull, words = wave.force_ratio - 1.0, f"a whirl of {share:g} depths that turns with the drum"
        yield _case(
            *(f"circle-{share}-force", _CLOSED, f"force ratio of {words}"),
            (1.0, wave.force_ratio, pull),
            wave.converged and abs(pull) <= _CIRCLE,
        )
        yield _case(
            *(f"circle-{share}", _CLOSED, f"how far the surface of {words} leaves the circle, over R"),
            (0.0, off, off),
            off <= _CIRCLE,
        )


def _in_time() -> Iterator[Case]:
    """Waves that come back to where they were, and what no force leaves unchanged."""
    row = data("exact_wave.json")["forced"][0]
    wave, slip, steps = held(row), row["whirl_speed"] - 1.0, Steps(256, 256)
    begin, size = started(wave, slip, 256), wave.whirl * row["whirl_speed"] ** 2
    turn = 2.0 * math.pi / slip
    end = advance(begin, turn, lambda time: size * cmath.exp(1j * slip * time), steps).surface
    yield _back("forced", "a forced wave after a turn", end, begin, 1e-12)
    wave, steps = free(0.3, 1.2), Steps(512, 512)
    slip = wave.slip_speeds()[1]
    begin = started(wave, slip, 512)
    end = advance(begin, 10.0 * math.pi / abs(slip), steps=steps).surface
    yield _back("free", "a free wave after five turns", end, begin, 1e-10)
    end = advance(begin, 20.0, steps=steps).surface
    first, last = invariants(begin.state), invariants(end.state)
    for key in ("volume", "energy", "angular_momentum"):
        off = getattr(last, key) - getattr(first, key)
        words = f"{key.replace('_', ' ')} without a force, change in a time of 20"
        yield _case(f"kept-{key}", _CLOSED, words, (0.0, off, off), abs(off) <= _KEPT)


def _back(name: str, words: str, end: Surface, begin: Surface, most: float) -> Case:
    away = float(np.abs(end.height - begin.height).max())
    return _case(
        f"back-{name}", _CLOSED, f"{words} less that before, over R", (0.0, away, away), away <= most
    )


def _flow() -> Iterator[Case]:
    """The smooth cases of the computed flow, and two whirl periods of the resonance from rest."""
    for run in data("openfoam_layer.json")["cases"]:
        if "time" in run:
            continue
        whirl = Whirl(run["speed"], run["whirl_speed"], run["whirl_amplitude"])
        fill, printed = plane_layer(run), complex(*run["force_ratio"]).real
        wave = Potential().wave(fill, whirl)
        found = complex(wave.answer.unbalance[0]).real / (fill.full_mass * whirl.amplitude)
        off = printed - found
        yield _case(
            *(run["name"], _FLOW, f"force ratio at whirl ratio {whirl.speed / whirl.spin:g}"),
            (printed, found, off),
            abs(off) <= _FLOW_ERROR * abs(found) + _GAS,
            "agrees within 0.6 % and 0.002",
        )
    run = bore_reference()
    whirl = Whirl(run["speed"], run["whirl_speed"], run["whirl_amplitude"], run["ramp"])
    history = simulate(plane_layer(run), whirl, 2.0 * whirl.period, Steps(128, 512)).periods.force_ratio
    for k, pull in enumerate(history[:2].tolist()):
        flow = complex(*run["force_ratio"][k])
        away = abs(pull - flow) / abs(pull)
        yield _case(
            *(f"{run['name']}-{k + 1}", _FLOW, f"force ratio at resonance, whirl period {k + 1}"),
            (f"{flow:.4f}".replace("j", "i"), f"{pull:.4f}".replace("j", "i"), f"{100 * away:.2g} %"),
            away <= _BORE_ERROR,
            "agrees within 3 %; the flow's wall does not slip",
        )


def _breaking(table: dict[str, Any]) -> Iterator[Case]:
    """How long a wave at its resonance is smooth: never less than the other code's lower bound."""
    found = {(round(row.depth, 6), round(row.whirl, 6)): row for row in kept().endings}
    for depth in ("0.1", "0.3", "0.5", "0.7"):
        for whirl, printed in zip(table["ends"]["whirls"], table["ends"][depth], strict=True):
            ours = found[float(depth), whirl]
            smooth = ours.state != "broken"
            same = smooth if printed is None else smooth or ours.periods >= (1.0 - _EARLIER) * printed
            yield _case(
                *(f"ends-{depth}-{whirl:g}", _SOURCE, "whirl periods until the smooth wave ends"),
                (
                    "none" if printed is None else printed,
                    "none" if smooth else ours.periods,
                    None if smooth or printed is None else ours.periods - printed,
                ),
                same,
                "printed a lower bound; computed: kept by validation.breaking",
            )


LAYER, SHARE = 0.1, 0.05  # h_0/R and w_0/h_0 of the force
# p/p_1 of the whirls, nearest to each other where waves end.
_RATIOS = np.concatenate(
    (
        np.arange(0.1, 0.7, 0.1),
        np.arange(0.66, 0.82, 0.02),
        np.arange(1.16, 1.4, 0.02),
        np.arange(1.4, 2.1, 0.1),
    )
)
_HIGH, _LEAST = 4.5, 1e-6  # of the force that is drawn, and of the differences
# Depths of natural sloshing waves, and the last crest of the one whose highest is not known.
_DEPTHS, _THINNEST = (0.05, 0.1, 0.2, 0.3, 0.5), 1.70
_COLOURS = ("0.45", "#0072B2", "#E69F00", "#D55E00", "#009E73")
NEAR = 0.99  # of the highest crest, how far free waves are followed
# Shares of the height on the way, closer where the speed turns.
_WAY = (0.04, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.86, 0.91, 0.95, 0.98, 1.0)
SHARP = 0.3  # h_0/R of the wave that is drawn with its nodes
_NEAR_CREST, _EVERY = 0.12, 8  # what is drawn of its crest, rad, and of its nodes


def force_figure() -> Figure:
    """Force coefficient of a whirl over its speed: exact, linear and by long waves."""
    exact, plain, dispersive = _forces()
    curves = (
        ("exact", exact, {"color": "black", "linewidth": 1.6}),
        ("long waves", plain, {"color": "#0072B2", "linestyle": (0, (5, 1.5))}),
        ("long waves, dispersion", dispersive, {"color": "#D55E00", "linestyle": (0, (1, 1.2))}),
    )
    text = (
        f"Force on the drum over that of a full one, h0/R = {LAYER:g}, w0 = {SHARE:g} h0; below, how "
        "far it is off over the larger of |G| and 1. Lines end where no smooth steady wave follows the "
        "whirl. Each p belongs to two whirl speeds with one force."
    )
    with page([2.2, 1.4], text, between=0.15) as (figure, [[axes], [below]]):
        speed = np.linspace(0.62, 1.9, 1001)
        linear = np.asarray(force_ratio(1.0 / (1.0 - LAYER) ** 2, speed))
        shown = np.where(np.abs(linear) < _HIGH, linear, np.nan)
        axes.plot(speed, shown, color="0.6", linewidth=1.0, label="linear")
        pairs = np.array([whirl_speeds(LAYER, ratio) for ratio in _RATIOS])
        for column in pairs.T:
            small = np.asarray(force_ratio(1.0 / (1.0 - LAYER) ** 2, column))
            for side in (_RATIOS < 1.0, _RATIOS > 1.0):
                _draw_off(below, column[side], small[side], exact[side], {"color": "0.6"})
                for name, force, look in curves:
                    axes.plot(column[side], force[side], **look, label=name)
                    if force is not exact:
                        _draw_off(below, column[side], force[side], exact[side], look)
        axes.set(ylim=(-_HIGH, _HIGH), ylabel="Force ratio G")
        axes.tick_params(labelbottom=False)
        below.set(yscale="log", ylim=(_LEAST, 0.5))
        below.set_yticks([1e-5, 1e-4, 1e-3, 1e-2, 1e-1], ["0.001 %", "0.01 %", "0.1 %", "1 %", "10 %"])
        below.minorticks_off()
        below.set(ylabel="Off the exact G", xlabel="Whirl speed over spin speed")
        for each in (axes, below):
            each.set_xlim(speed[0], speed[-1])
        ends = [_RATIOS[np.isfinite(exact) & side] for side in (_RATIOS < 1.0, _RATIOS > 1.0)]
        figure.alt = (
            f"Force ratio over whirl speed; smooth exact waves up to p/p1 = {ends[0].max():.2f} and from "
            f"{ends[1].min():.2f} on."
        )
    return figure


def _draw_off(axes: Any, speed: Array, force: Array, exact: Array, look: dict[str, Any]) -> None:
    """How far a model is off, over the larger of |G| and 1."""
    off = np.abs(force - exact) / np.maximum(1.0, np.abs(exact))
    axes.plot(speed, np.maximum(off, _LEAST), **look)


def _forces() -> tuple[Array, Array, Array]:
    """G at each p/p_1: exact, long waves, long waves with dispersion; nan where no smooth wave is."""
    rows = []
    for ratio in _RATIOS:
        square = detuning(LAYER, float(ratio))
        wave = forced(LAYER, square, SHARE * LAYER, most=128)
        found = [wave.force_ratio if wave.converged and wave.tail < SMOOTH else math.nan]
        for dispersion in (False, True):
            long = steady_long_wave(LAYER, square, SHARE * LAYER, dispersion)
            found.append(long.force_ratio if long.smooth else math.nan)
        rows.append(found)
    exact, plain, dispersive = np.array(rows).T
    return exact, plain, dispersive


def last_crests() -> dict[float, float]:
    """Crest over h_0, by h_0/R, of the last natural sloshing wave that is drawn."""
    highest = {round(row.depth, 6): row.crest for row in kept().highest}
    return {depth: NEAR * highest[depth] if depth in highest else _THINNEST for depth in _DEPTHS}


def climbed(layer: float, crest: float) -> list[SteadyWave]:
    """Natural waves of one crest up to one over h_0, as far as nodes resolve them."""
    found = [free(layer, 1.0 + _WAY[0] * (crest - 1.0))]
    for share in _WAY[1:]:
        ahead = follow(found[-1], {"whirl": 0.0, "crest": 1.0 + share * (crest - 1.0)}, 1)
        if not ahead.converged:
            break
        found.append(ahead)
    return found


def free_figure(climbs: dict[float, list[SteadyWave]]) -> Figure:
    """Speed of natural waves of rising crests over their crest, by h_0/R."""
    highest = {round(row.depth, 6): row for row in kept().highest}
    text = (
        "Speed of free waves of one crest along the wall, against the spin (above) and with it "
        f"(below), up to {100 * NEAR:.0f} % of the highest crest; dots: the highest wave, where the "
        "liquid at the crest stands still in the wave's frame. Each backward wave has the shape of the "
        "forward one."
    )
    with page([1.6, 1.6], text, between=0.15) as (figure, rows):
        for (layer, waves), colour in zip(climbs.items(), _COLOURS, strict=False):
            p, crest = math.sqrt(linear_detuning(layer)), [1.0, *(wave.crest for wave in waves)]
            for [axes], way in zip(rows, (1, 0), strict=True):
                small = (p / (1.0 - p), -p / (1.0 + p))[way]
                speed = [small, *(wave.slip_speeds()[way] for wave in waves)]
                axes.plot(crest, speed, color=colour, label=f"h0/R = {layer:g}")
                if layer in highest:
                    last = highest[layer]
                    ends = (-1.0 / (2.0 + 1.0 / last.slip), last.slip)[way]
                    axes.plot(last.crest, ends, "o", color=colour, markersize=4.5)
        for [axes] in rows:
            axes.set_xlim(1.0, 1.75)
        rows[0][0].set_ylabel("s/Omega, backward")
        rows[1][0].set(ylabel="s/Omega, forward", xlabel="Crest over h0")
        rows[0][0].tick_params(labelbottom=False)
        figure.alt = "; ".join(
            f"h0/R = {layer:g}: s = {waves[0].slip_speeds()[1]:.4f} at a crest of {waves[0].crest:.3f}, "
            f"{waves[-1].slip_speeds()[1]:.4f} at {waves[-1].crest:.3f}"
            for layer, waves in climbs.items()
        )
    return figure


def sharp_figure(wave: SteadyWave, lower: SteadyWave) -> Figure:
    """Wave near the highest with its nodes, and the spectra of it and of a lower one with a round crest."""
    angle, depth = wave.angle, wave.depth / wave.layer
    within = np.abs(angle) < _NEAR_CREST
    text = (
        f"Above: a free wave near the highest, h0/R = {wave.layer:g}, and a lower one (grey); right: "
        f"its crest, where {np.count_nonzero(within)} of {wave.surface.size} nodes from crest to trough "
        f"stand in {_NEAR_CREST:g} rad. Below: coefficients of the surface; nodes are added until the "
        "last tenth is rounding."
    )
    with page([1.7, 1.6], text, (2, 1), between=0.55) as (figure, [[whole, near], [spectra]]):
        for found, look in ((lower, {"color": "0.55", "linewidth": 1.0}), (wave, {"color": "#0072B2"})):
            half, over = found.angle, found.depth / found.layer
            both = np.concatenate((-half[:0:-1], half)), np.concatenate((over[:0:-1], over))
            whole.plot(*both, **look)
            near.plot(*both, **look)
        dots = {"color": "#D55E00", "markersize": 4.0, "markerfacecolor": "white"}
        near.plot(angle[::_EVERY], depth[::_EVERY], "o", **dots, label=f"each {_EVERY}th node")
        near.set_xlim(-_NEAR_CREST, _NEAR_CREST)
        near.set_ylim(float(depth[within].min()), 1.005 * float(depth.max()))
        near.set_xticks([-0.1, -0.05, 0.0, 0.05, 0.1])
        whole.set(xlim=(-math.pi, math.pi), xticks=[-3, -2, -1, 0, 1, 2, 3], ylabel="Depth over h0")
        for axes in (whole, near):
            axes.set_xlabel("Angle from the crest (rad)")
        to = nodes(wave.surface.size - 1, wave.at.crests, 1.0)
        even = on_nodes(wave, to)
        lines: tuple[tuple[SteadyWave, str, dict[str, Any]], ...] = (
            (lower, f"crest {lower.crest:.3f}", {"color": "0.55"}),
            (wave, f"crest {wave.crest:.3f}", {"color": "#0072B2"}),
            (even, "the same on even nodes", {"color": "#D55E00", "linestyle": (0, (5, 1.5))}),
        )
        for found, name, look in lines:
            size = np.arange(found.surface.size) * np.abs(found.at.spectrum(found.surface))
            spectra.semilogy(np.arange(1, size.size), size[1:] / size.max(), **look, label=name)
        spectra.set_ylim(1e-14, 3.0)
        spectra.set_yticks([1e-12, 1e-8, 1e-4, 1.0], ["1e-12", "1e-8", "1e-4", "1"])
        spectra.set_xlim(0, wave.surface.size)
        spectra.minorticks_off()
        spectra.set(xlabel="Number k of the cosine", ylabel="k |Yk| over largest")
        figure.alt = (
            f"A free wave with a crest of {wave.crest:.4f} depths, nearly a corner; its nodes crowd there. "
            f"Tail of its spectrum {wave.tail:.1e} with crowded nodes, {even.tail:.1e} on as many even ones."
        )
    box = near.get_position()
    near.set_position((box.x0 + 0.09, box.y0, box.width - 0.09, box.height))
    return figure
