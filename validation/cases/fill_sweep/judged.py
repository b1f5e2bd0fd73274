"""What the machine fitted to two fills says of the other five, beside what was measured."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from meshes.arrays import Array, Index
from validation.case import Case, Claims, Effect, shape_verdict
from validation.cases.fill_sweep.fitted import NEAREST, SCATTER, Answers, bands, kept, measured, ratios
from validation.page import Figure, page
from validation.study import data, launch, shown

CLAIMS = Claims("fill_sweep")

# Below a clearance the tub shakes its cabinet through the soft suspension, beyond it through the contact. The
# run-ups know no contact: their passage stands for the deflection that the tub would have.
CLEARANCES = 200  # that are tried with each draw
FALLS = 0.999  # a passage of the last fill over the first above which no clearance lies between them


@dataclass(frozen=True)
class Contact:
    """Shaking at the resonance over the first fill, fitted to the last: n pairs of a draw and a clearance."""

    shaking: Array  #: shape (n, f)
    draw: Index  #: number of the draw, shape (n,)
    clearance: Array  #: over the deflection with the first fill, shape (n,)

    def within(self, seen: Array, factor: float) -> float:
        """Share of pairs that meet all fills between the fitted ones, (f,), within a factor above 1."""
        off = np.abs(np.log(self.shaking / seen))[:, 1:-1]
        return float(np.mean((off <= np.log(factor)).all(axis=1)))

    def steps(self, seen: Array) -> Array:
        """Share of the pairs below the geometric mean of both ends with each measured fill, shape (f,)."""
        first = np.argmax(self.shaking < np.sqrt(seen[0] * seen[-1]), axis=1)
        return np.asarray(np.bincount(first, minlength=seen.size) / first.size)

    def bands(self) -> Array:
        """A twentieth, the half and nineteen twentieths of the pairs are below, shape (3, f)."""
        return np.asarray(np.quantile(self.shaking, (0.05, 0.5, 0.95), axis=0))

    def closest(self, seen: Array) -> int:
        """Number of the pair that comes closest to all measured fills, shape (f,)."""
        return int(np.argmin(np.square(np.log(self.shaking / seen)).sum(axis=1)))


def touching(passage: Array, clearance: Array, last: float) -> Array:
    """Shaking over that of the first fill, its contact so stiff that the last fill is met, shape (n, f).

    `passage` is the deflection over that of the first fill, (n, f); the clearance lies between the last and
    the first of them, (n,); `last` is measured.
    """
    stiff = (passage[:, -1] / last - 1.0) / (1.0 - clearance)
    shaking = passage + stiff[:, None] * np.maximum(passage - clearance[:, None], 0.0)
    return np.asarray(shaking / shaking[:, :1])


def allowed(answers: Answers, last: float) -> Contact:
    """Draws whose deflection falls from the first to the last fill, with clearances between the two."""
    passage = ratios(answers)[0]
    falls = np.flatnonzero((passage[:, -1] < FALLS) & (passage[:, -1] > last))
    part = (np.arange(CLEARANCES) + 0.5) / CLEARANCES
    draw = np.repeat(falls, CLEARANCES)
    least = passage[draw, -1]
    clearance = least + (1.0 - least) * np.tile(part, falls.size)
    return Contact(touching(passage[draw], clearance, last), draw, clearance)


@cache
def of_kept() -> Contact:
    """What the kept draws allow."""
    return allowed(kept()[0], float(measured()[1][-1]))


_FLAT = 0.02  # relative; a curve that changes by less says nothing of a best volume


def cases() -> Iterator[Case]:
    """The comparisons, without a run: the answers are kept."""
    added, *seen = measured()
    draws, fitted = kept()
    own = [ratio[0] for ratio in ratios(fitted.answers)]
    band = bands(draws, fitted.answers)
    # Both are fitted at both ends, and judged between.
    for k, (name, text) in enumerate(
        (
            ("resonance-peak", "largest shaking at the resonance"),
            ("cruise", "largest shaking near the highest speed"),
        )
    ):
        wide = band[k] * np.exp([[-SCATTER], [SCATTER]])
        words, effect, inside = _between(added, seen[k], own[k], wide)
        same = _least(added, seen[k]) == _least(added, own[k])
        verdict = "agrees" if inside == added.size - 2 else shape_verdict(same, effect)
        words |= {"key": name, "text": text, "volumes": ", ".join(f"{ml:g}" for ml in added[1:])}
        yield CLAIMS.case("curve", _words(own[k]), verdict=verdict, effect=effect, **words)
    # A tub that touches its cabinet with the first fill, and no longer with the last.
    found, passage = of_kept(), seen[0]
    low, middle, high = found.bands()
    step, at = int(np.argmax(passage < np.sqrt(passage[-1]))), found.steps(passage)
    words, effect, _ = _between(added, passage, middle, np.array([low, high]))
    words |= {"pairs": found.draw.size, "at": at, "added": added, "within": found.within(passage, 1.5)}
    words |= {"at_seen": at[step], "added_seen": added[step]}
    same = _least(added, passage) == _least(added, middle)
    yield CLAIMS.case("clearance", _words(middle), same, effect=effect, **words)
    # The way down through the resonance beside the way up.
    kept_data = data("fill_sweep.json")
    logs, down = kept_data["logs"], fitted.down
    rows = zip(kept_data["added_ml"], logs["passage_down_peak"], logs["passage_peak"], strict=True)
    ways = {ml: back / up for ml, back, up in rows if back is not None}
    effect = Effect("way down over way up, 0 ml", ways[0], down)
    agrees, alike = abs(np.log(down / ways[0])) <= SCATTER, bool((down > 1.0) == (ways[0] > 1.0))
    yield CLAIMS.case(
        "coast-down",
        down,
        printed=float(ways[0]),
        difference=float(ways[0] / down - 1.0),
        verdict="agrees" if agrees else shape_verdict(alike, effect),
        others=", ".join(f"{ratio:.2f} with {ml} ml" for ml, ratio in ways.items() if ml),
        effect=effect,
    )
    # Which quantity wants more liquid.
    best, wanted = ([_least(added, curve) for curve in pair] for pair in (seen, own))
    told, given = (", ".join("any" if ml is None else f"{ml:g}" for ml in each) for each in (wanted, best))
    yield CLAIMS.case("order", told, best == wanted, printed=given)
    # What the source calls the resonance peak is not always at the resonance.
    column, known = kept_data["resonance_peak"], logs["resonance_column_frequency_Hz"]
    yield CLAIMS.case(
        "columns",
        ", ".join(f"{value}" for value in logs["passage_peak"][:3]) + ": largest at the resonance",
        column[:3] == logs["passage_peak"][:3],
        column=", ".join(f"{value}" for value in column[:3]),
        hertz=", ".join(f"{hz:g}" for hz in known if hz is not None),
    )


def _between(added: Array, seen: Array, own: Array, band: Array) -> tuple[dict[str, Any], Effect, int]:
    """Words on the fills between the fitted ones, the effect of the worst, how many are in a band (2, f)."""
    factors = off(seen, own)
    worst = int(np.argmax(factors)) + 1
    effect = Effect(f"at {added[worst]:g} ml over that at 0 ml", float(seen[worst]), float(own[worst]))
    inside = int(np.count_nonzero(((seen >= band[0]) & (seen <= band[1]))[1:-1]))
    words = {"least": factors.min(), "most": factors.max(), "inside": inside, "printed": _words(seen)}
    return words, effect, inside


def off(measured: Array, computed: Array) -> Array:
    """Factor by which five fills between are off, at least 1, shape (f - 2,); both over the first fill."""
    return np.asarray(np.exp(np.abs(np.log(computed[1:-1] / measured[1:-1]))))


def _words(curve: Array) -> str:
    return ", ".join(f"{value:.2f}" for value in curve[1:])


def _least(added: Array, curve: Array) -> float | None:
    """Volume with which a curve is least; None where it hardly changes."""
    if np.ptp(curve) < _FLAT * curve.max():
        return None
    return float(added[int(np.argmin(curve))])


_LINE, _TOUCHES = "#0072B2", "#009E73"


def sweep_figure() -> Figure:
    """The measured fill sweep, and what one machine makes of it."""
    added, *seen = measured()
    draws, fitted = kept()
    own = [ratio[0] for ratio in ratios(fitted.answers)]
    titles = ("At the resonance", "Near the highest speed, 750 rpm")
    text = (
        "Measured: one run for each fill; those with 0 and 50 ml strike the cabinet at the resonance. "
        "Computed: one machine for all fills, its values fitted to the first and the last fill (large "
        f"marks); band: the {NEAREST} of {len(draws.values)} sets of assumed values that come closest to "
        "these two. Green: the tub touches the cabinet beyond a clearance; nine tenths of what the two "
        "fills allow, and their middle. Scene: validation/data/fill_sweep.toml, most of it assumed."
    )
    with page([2.0, 1.6], text, left=0.78, top=0.28, between=0.34) as (figure, rows):
        panels = [axes for [axes] in rows]
        for k, (title, band) in enumerate(zip(titles, bands(draws, fitted.answers), strict=True)):
            _draw(panels[k], added, seen[k], own[k], band)
            panels[k].set_title(title, loc="left")
            panels[k].set_ylabel("Shaking over that\nwith 0 ml added (\N{EN DASH})")
            panels[k].tick_params(labelbottom=k == 1)
        low, middle, high = of_kept().bands()
        shade: dict[str, Any] = {
            "color": _TOUCHES,
            "alpha": 0.15,
            "linewidth": 0.0,
            "label": "with a clearance",
        }
        panels[0].fill_between(added, low, high, **shade)
        panels[0].plot(added, middle, color=_TOUCHES, linewidth=1.3, label="with a clearance, middle")
        panels[0].set(yscale="log", ylim=(0.07, 3.0))
        panels[0].set_yticks([0.1, 0.2, 0.5, 1.0, 2.0], ["0.1", "0.2", "0.5", "1", "2"])
        panels[0].yaxis.set_minor_locator(panels[0].yaxis.get_minor_locator().__class__(subs=()))
        panels[1].set(ylim=(0.0, 1.4), xlabel="Water added to the ring (ml)")
        pairs = zip(added[1:], seen[0][1:], own[0][1:], strict=True)
        told = "; ".join(f"{ml:g} ml {a:.2f} measured, {b:.2f} computed" for ml, a, b in pairs)
        figure.alt = f"Shaking at the resonance over that with 0 ml added: {told}."
    return figure


def _draw(axes: Any, added: Array, seen: Array, own: Array, band: Array) -> None:
    """One quantity: band, computed line, measured points, those that were fitted large."""
    axes.fill_between(added, *band, color=_LINE, alpha=0.2, linewidth=0.0, label="closest assumed values")
    axes.plot(added, own, color=_LINE, linestyle=(0, (5, 1.5)), linewidth=1.3, label="computed, fitted")
    look: dict[str, Any] = {"color": "black", "linestyle": "none", "markerfacecolor": "white", "zorder": 4}
    axes.plot(added, seen, marker="s", markersize=4.5, label="measured", **look)
    ends = [0, -1]
    axes.plot(added[ends], seen[ends], marker="s", markersize=8.0, label="measured, fitted to", **look)


if __name__ == "__main__":
    launch(shown(fill_sweep=sweep_figure))
