# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 11. Balls, two planes and damping
#
# Whether damping in the supports has a part in the balancing of a long rotor by balls in two planes. [FF20]
# says no. The roots of rotor and balls about the balanced state say yes, and so does the motion in time.
# Derivations: `docs/theory/balls.md`, sections 4 and 5.

# %% [markdown]
# ## Who measured or printed what
#
# * Nothing here was measured. [FF20] prints conditions and conclusions, no numbers.
# * The reference machine is a dimensionless one of the literature; its charts are computed here alone.
#
# ## Assumed
#
# * The rotor is made up; two races with two balls of 15 g each, drag of the races 0.3 N s/m.
# * Balls are points that roll; a race keeps them in its plane; no gravity.

# %%
from validation.cases.two_plane import damping as two_plane_damping
from validation.figures.rotors.ball_charts import damping_figure
from validation.notebook_page import case_table, drawn, verdicts

# %% [markdown]
# ## The region over speed and damping
#
# Hatched: all roots have negative real parts. Crosses and circles are motions in time, 2 % below and above
# the edge. Weak supports let a whirl grow that the drag of the races feeds; strong ones hold the rotor so
# fast that the balls hardly feel it.

# %%
drawn(damping_figure)

# %% [markdown]
# ## Number by number

# %%
damped = two_plane_damping.cases()
case_table(damped)

# %% [markdown]
# ## What does not agree
#
# * The second conclusion of [FF20] at weak damping: with 0.5 N s/m balls balance from 79.2 rad/s on, not from
#   49.5.
# * With 8000 N s/m the state is stable, and balls that begin far from it creep round for more than 6000 s.
#
# ## Asserted

# %%
found = verdicts(damped)
assert found["erratum"] == {"damping-0.5", "damping-5", "long-run-0.5-60"}
assert found["differs"] == {"long-run-8000-120"}
assert len(found["agrees"]) == 4 and len(damped) == 8
