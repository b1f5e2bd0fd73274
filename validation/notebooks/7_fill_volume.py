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
# # 7. How much liquid
#
# `leblanc optimise` searches the volume of liquid that does best for an objective. Three comparisons: the
# search against closed forms, a run-up in time against the figures of another code, and the objectives
# against the sweep of a real machine. The search is described in `docs/theory/optimum.md`.

# %% [markdown]
# ## Who measured or printed what
#
# * **The fill sweep was measured** by the author of the public repository
#   `aluiziotomazelli/washing-machine` (`docs/balance_ring_analysis.md` there): the acceleration of the
#   cabinet of a top-loading washing machine while water was added to its balance ring, one run for each
#   volume. Kept in `validation/data/fill_sweep.json`.
# * The run-up figures are those of another code for the same made-up machine.
# * The closed forms are the volume that wets the whole wall at a deflection, and the amplitude of a rotor
#   with the mass of a full chamber added: both known without a search.
#
# ## Assumed
#
# * Of the real machine neither the size of the ring, the speeds, the load nor the place of the unbalance is
#   known. The machine that is computed in its place is **assumed in every value**; acceleration and
#   amplitude are not the same quantity either. Only which volume is best for which objective, and the shape
#   of the curves, can be compared.
# * The other two machines are made up, `runup`, or partly so, `washing_machine`, both of the examples.

# %%
import leblanc as lb
from leblanc.figures.optimise import objective_figure
from leblanc.studies.optimise.optimise import optimise_scene
from validation.cases import fill_optimum, fill_sweep
from validation.cases import runup as runup_given
from validation.figures.fill_sweep import sweep_figure
from validation.notebook_page import case_table, picture, verdicts

# %% [markdown]
# ## The search
#
# The amplitude at the working speed falls until the wall is wet, and stays.

# %%
scene = lb.example("runup")
picture(objective_figure(optimise_scene(scene, "working_speed", front=False)))

# %%
optimum = fill_optimum.cases()
case_table(optimum)

# %% [markdown]
# ## A run-up in time
#
# The peak on the way through the resonance depends on the friction that brings the liquid up to speed, the
# end does not. `docs/runup.md` varies volume and friction: there the peak has a best volume of its own.

# %%
runup = runup_given.cases()
case_table(runup)

# %% [markdown]
# ## The measured sweep

# %%
picture(sweep_figure())

# %%
sweep = fill_sweep.cases()
case_table(sweep)

# %% [markdown]
# ## What does not agree
#
# * **Cruise.** In the real machine every volume makes the cruise worse than none; in the model liquid helps
#   until the wall is wet and then changes nothing. The model is steady there and has neither the pumping of
#   liquid by the cabinet's own motion nor a whirl that grows by itself. With the ring, speed and load
#   unknown it cannot be told which of these it was.
# * **Peak of the run.** Measured it is least between, computed it falls all the way: in the real sweep the
#   last volume is a little worse than the one before. With one run for each volume nobody can say whether
#   that is more than chance.
# * **Resonance peak.** It falls all the way in both, but in the real machine to 0.11 of that without liquid,
#   in the assumed one to 0.94. Size and friction of the ring would have to be known.
# * **Best volumes.** In both the resonance wants the most liquid, the peak of the run no more, the cruise
#   the least: the objective decides the volume. But the cruise of the real machine wants none at all, that
#   of the model 150 ml.
# * A shape that is the same is called a trend only where its effect is as large within a factor of two.
#   **Here no effect is**, so nothing of the measured sweep is met.
#
# ## Asserted

# %%
assert set(verdicts(optimum)) == {"agrees"} and len(optimum) == 4
assert set(verdicts(runup)) == {"agrees"} and len(runup) == 9
assert verdicts(sweep) == {"differs": {"resonance-peak", "order", "peak", "cruise"}}
