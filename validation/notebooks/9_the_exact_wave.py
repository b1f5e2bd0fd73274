# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 9. The exact wave
#
# The layer on the wall of a drum without friction, at any depth and any height of its wave. The theory is in
# `docs/theory/nonlinear.md`, the liquid model "potential" in `docs/models/potential.md`.
#
# * The liquid has no friction and was once at rest in the spinning drum. Seen from the drum its flow has a
#   potential for ever, and its circulation round the wall is nought.
# * The angle along the wall and the logarithm of the radius unroll the ring onto a strip: the wall is a flat
#   bed, and angles stay as they are.
# * A second map, found with the wave, makes the wavy strip one of even depth. There harmonic functions are
#   sums of sines and cosines, and all that is unknown stands on the surface.
# * Steady waves: the surface at some nodes from crest to trough, by Newton's method with an analytic
#   Jacobian. Bernoulli's equation holds at each node, the volume is that of the layer.
# * In time: surface and potential at even nodes all round, by fast Fourier transforms and Runge and Kutta's
#   steps of eighth order.
# * The force comes out twice, from the pressure on the wall and from the momentum of the liquid.
# * Not in it: friction of the wall, surface tension, gravity along the axis, and what comes after a breaking
#   crest.

# %% [markdown]
# ## Who measured or printed what
#
# * Numbers with twelve digits are those of two other codes of the same equations, kept in
#   `validation/data/exact_wave.json`; they share no line with this package. `leblanc validate exact_wave`
#   compares all of them, and so does the table below, in which none is left out.
# * Computed two-phase flow is that of notebook 2, `validation/data/openfoam_layer.json`.
# * Maps of errors and the ends of waves at resonance take from minutes to a quarter of an hour. They are kept
#   in `validation/exact/` and `validation/breaking/`, and drawn here.
#
# ## Assumed
#
# * Plane flow in a clear circular drum. Lengths are over the drum's radius R, times in the inverse of its
#   spin Omega; h0 is the depth of the layer at rest, w0 the whirl's radius.
# * The force ratio G is the force over that of a full drum.

# %%
from collections import Counter
from math import tau
from time import process_time

from solvers.potential.in_time import Steps, advance
from solvers.potential.steady import at_rest, follow, free, solve
from solvers.potential.strip import nodes
from solvers.potential.unsteady import invariants, rates, started
from validation.breaking import crests
from validation.breaking.figure import breaking_figure, crest_figure
from validation.cases.liquid import exact_wave
from validation.cases.liquid.exact_wave import (
    LAYER,
    SHARE,
    SHARP,
    climbed,
    force_figure,
    free_figure,
    last_crests,
    sharp_figure,
)
from validation.exact import kept
from validation.exact.figure import ends_figure, maps_figure
from validation.page import Table, case_table, picture, verdicts

# %% [markdown]
# ## The force of a whirl
#
# Linear theory has no bound at the two free waves. The exact wave bends the resonance, and its smooth steady
# waves end before it: they choke on the one side and turn back on the other. Long waves are off by up to 2 %
# there, with dispersion by up to 0.04 %.

# %%
picture(force_figure())

# %% [markdown]
# ## Number by number
#
# First the whirls whose force, crest and trough the other codes have with twelve digits.

# %%
cases = exact_wave.cases()
held = [case for case in cases if case.name.startswith("exact_wave/forced-")]
case_table(held)

# %% [markdown]
# All numbers, by what they are about.

# %%
about = {
    "forced": "force, crest and trough of a whirl",
    "linear": "force of small waves",
    "models": "force of whirls: exact, by long waves, with dispersion",
    "near": "force next to the resonance",
    "free": "speeds of free waves",
    "greatest": "greatest speeds of free waves",
    "limiting": "highest crests of free waves",
    "fold": "folds: largest whirls that are out of phase",
    "twins": "twins",
    "circle": "whirls that turn with the drum, whose surface is a circle",
    "back": "waves in time that come back to where they were",
    "kept": "what no force leaves unchanged",
    "ends": "whirl periods to the end of the smooth wave at resonance",
}
kinds = Counter(
    (about.get(case.name.split("/")[1].split("-")[0], "computed two-phase flow"), case.verdict)
    for case in cases
)
Table(
    ("About", "Verdict", "Numbers"),
    tuple((kind, verdict, str(count)) for (kind, verdict), count in kinds.items()),
    f"Of {len(cases)} numbers.",
)

# %% [markdown]
# ## Twins
#
# A steady wave knows of the whirl speed only the square of p, which is 1 less spin over whirl speed. So whirl
# speeds come in pairs, whose inverses add up to twice that of the spin, and both have one force. Newton's
# method is given nothing but that square; the equations in time know whirl speeds with their signs. Each wave
# is put into the drum, held by each of its two whirls for a time of 5, and its force taken from the pressure
# on the wall.

# %%
twins = [case for case in cases if case.name.startswith("exact_wave/twins-")]
case_table(twins)

# %% [markdown]
# Free waves pair up as well: one runs with the spin and one against it, with one shape. Each is put into the
# drum and followed through time as it runs once round. It must come back unchanged.

# %%
wave = free(0.3, 1.2)
free_rows, came_back = [], []
for name, slip in zip(("with the spin", "against it"), wave.slip_speeds(), strict=True):
    begin = started(wave, slip, 512)
    last = advance(begin, tau / abs(slip), steps=Steps(512, 512))
    came_back.append(float(abs(last.surface.height - begin.height).max()))
    free_rows.append((name, f"{slip:.9f}", f"{1.0 / slip:.9f}", f"{came_back[-1]:.1e}"))
ahead, behind = wave.slip_speeds()
pair = 1.0 / ahead + 1.0 / behind + 2.0
Table(
    ("A free wave, h0/R = 0.3, crest 1.2 h0, runs", "s over Omega", "Omega over s", "off after a turn"),
    tuple(free_rows),
    f"Sum of both Omega over s, less -2: {pair:.1e}.",
)

# %% [markdown]
# ## Free waves, and the highest of them
#
# A free wave is the faster the higher it is, until just below the highest one. There the speed has a greatest
# value, and beyond it the crest becomes a corner.

# %%
climbs = {layer: climbed(layer, crest) for layer, crest in last_crests().items()}
picture(free_figure(climbs))

# %% [markdown]
# Nodes crowd at a sharp crest by a map of the strip onto itself, a Moebius map of its edge, which leaves
# harmonic functions harmonic. The spectrum decides how many there are and how much they crowd: on as many
# even nodes the same surface has no end of its spectrum.

# %%
picture(sharp_figure(climbs[SHARP][-1], climbs[SHARP][4]))

# %% [markdown]
# ## How wrong the other models are
#
# Each of the cheaper models beside the exact wave, at two whirls. `docs/accuracy.md` says how an error is
# told from these maps before anything is solved.

# %%
picture(maps_figure(kept().maps))

# %%
picture(ends_figure(kept().ends))

# %% [markdown]
# ## In time, until it breaks
#
# A whirl as fast as the small backward free wave grows from nothing. Here it is run again, with up to 1024
# nodes and a damping of the shortest waves. *Resolved* is a wave whose spectrum has an end; one with *short
# waves* has ripples that its nodes do not carry, which is no breaking; *broken* is a wave whose crest is
# about to be overtaken by its own liquid, and there the run ends, for no force is owed beyond. B is the speed
# of the liquid at the crest over that of the crest.

# %%
times = (10.0, 20.0, 30.0, 40.0, 50.0, 56.0, 58.0, 60.0, 62.0, 63.0, 64.0, 65.0, 66.0, 67.0)
run = crests.followed(1024, times)
Table(
    ("Omega t", "State", "Nodes", "Crest over h0", "B", "Slope, deg", "Tail of the spectrum"),
    tuple(
        (
            f"{row.time:.2f}",
            row.state,
            str(row.nodes),
            f"{row.crest:.3f}",
            f"{row.crest_number:.2f}",
            f"{row.slope:.1f}",
            f"{row.tail:.0e}",
        )
        for row in run
    ),
    f"Its end: {run[-1].reason}.",
)

# %% [markdown]
# The same wave with 8192 nodes, followed a little beyond that end for its shape; `docs/accuracy.md` has the
# numbers.

# %%
picture(crest_figure())

# %% [markdown]
# How long it takes at other depths and whirls, and long waves beside the exact one until then: with
# dispersion they hold to the last tenth of the time, without they make a flat bore in place of the crest.

# %%
picture(breaking_figure())

# %% [markdown]
# ## What is kept
#
# Without a force volume, energy and angular momentum stay. Nothing in the steps imposes it. Changes since the
# beginning, of a free wave with h0/R = 0.3 and a crest of 1.2 h0:

# %%
surface = started(wave, behind, 512)
first = invariants(surface.state)
kept_rows, drifts = [], []
for time in (5, 10, 15, 20):
    surface = advance(surface, 5.0, steps=Steps(512, 512)).surface
    now = invariants(surface.state)
    off = [getattr(now, key) - getattr(first, key) for key in ("volume", "energy", "angular_momentum")]
    drifts += off
    kept_rows.append((f"{time}", *(f"{each:+.1e}" for each in off)))
Table(("Omega t", "Volume", "Energy", "Angular momentum"), tuple(kept_rows))

# %% [markdown]
# ## What it costs
#
# Milliseconds of CPU time on the machine that made this page, shared with other work or not; nothing depends
# on them. Of the other code on a quiet core: 0.08, 0.09, 0.11 and 0.15 for the rates, 10, 20, 200 and 800 for
# a steady wave.

# %%
costs = []
for count in (128, 256, 512, 1024):
    state, turns = started(wave, behind, count).state, 300
    rates(state, 0j)
    clock = process_time()
    for again in [state] * turns:
        rates(again, 0j)
    costs.append((f"rates, {count} nodes all round", f"{1e3 * (process_time() - clock) / turns:.3f}"))
square = (1.0 - 1.0 / 1.3) ** 2
for count in (64, 128, 256, 512):
    rest = at_rest(LAYER, nodes(count))
    clock = process_time()
    unmoved = solve(rest, {"detuning": square, "whirl": 0.0})
    whole = follow(unmoved, {"detuning": square, "whirl": 0.4 * SHARE * LAYER}, most=0)
    costs.append(
        (f"steady wave, {count} steps from crest to trough", f"{1e3 * (process_time() - clock):.0f}")
    )
Table(("What", "ms"), tuple(costs))

# %% [markdown]
# ## What does not agree
#
# * Two of the greatest speeds of free waves are printed too small: the other code looked at too few waves.
#   Faster ones are found here, and both cases are called errata.
# * The other code's times to the end of the smooth wave at resonance are lower bounds, which end where the
#   spectrum fills. Here waves are followed until they break, which is later.
# * Long waves of the tables went through time on cells, which are in their third digit. Computed here are
#   their steady equations, and 0.3 % is called agreement.
# * A real layer rubs on its wall, and a crest that breaks loses energy. Neither is here: beyond breaking the
#   exact wave is silent, while long waves go on with a bore.
#
# ## Asserted

# %%
assert set(verdicts(held)) == set(verdicts(twins)) == {"agrees"}
found = verdicts(cases)
assert set(found) == {"agrees", "erratum"} and found["erratum"] == {"greatest-0.3", "greatest-0.5"}
assert abs(pair) < 1e-12 and max(came_back) < 1e-10
assert all(climbs[layer][-1].crest > 0.999 * crest for layer, crest in last_crests().items())
assert {row.state for row in run} == {"resolved", "short_waves", "broken"} and run[-1].crest_number > 0.5
assert len(costs) == 8 and whole.converged
assert max(map(abs, drifts)) < 1e-12
