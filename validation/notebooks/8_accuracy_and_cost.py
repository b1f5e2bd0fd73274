# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 8. Accuracy against cost
#
# Every liquid model and every resolution on every shipped scene: how wrong is it, and what does it cost?
# `leblanc trade` measures that, and `docs/accuracy.md` says how. The question of this page is whether the
# default choice is a good one.

# %% [markdown]
# ## Who measured or printed what
#
# * Errors and times were measured by this package on one machine of two cores, shared with other work, and
#   are kept in `validation/trade/`. All scenes take some twenty minutes, too long for this page: what
#   follows draws the kept results.
# * Errors belong to the scene and not to the machine. Those of the cheap models are computed again below
#   and compared with the kept ones. Times are not compared: they would be those of another day.
#
# ## Assumed
#
# * The best answer stands for the truth: exact equilibrium for the response, the finest mesh for a run-up.
#   Its own error is told beside it, and no error below that can be told.
# * Most values of the scenes are assumed; each scene's file says which. Costs on other machines will
#   differ; ratios less so.

# %%
from validation.page import case_table, picture, verdicts
from validation.trade import names, recompute
from validation.trade.__main__ import overview
from validation.trade.figure import trade_figure

# %% [markdown]
# ## All scenes
#
# In milliseconds of CPU time; *0* is an error that cannot be told from the best answer's own.

# %%
overview()

# %% [markdown]
# ## An upright machine and a horizontal rig
#
# On the front is what nothing beats in both error and time.

# %%
picture(trade_figure(recompute.record("runup")))

# %%
picture(trade_figure(recompute.record("horizontal_rig")))

# %% [markdown]
# ## Number by number
#
# Errors kept and computed again, then for every scene and question what beats the default in both error and
# time.

# %%
cases = recompute.cases()
case_table(cases)

# %% [markdown]
# ## What does not agree
#
# * The default of a run-up takes the cells that the scene gives. On some scenes its error is above the
#   tolerance of one in a thousand that the scene asks for, and more cells are recommended; the next cell
#   names them. It is still the cheapest way to that error.
# * Linear layers in time are cheap and far off on every shipped scene, since all of them pass a resonance
#   with waves as high as the layer is deep.
# * The comparison is among the package's own models. Whether the best of them is right is the subject of
#   notebooks 1 to 4.

# %%
over = [
    f"{name}, {comparison.question}: {comparison.default.error:.1e} of {found.tolerance:g}"
    for name in names()
    for found in (recompute.record(name),)
    for comparison in found.comparisons
    if comparison.default.error > found.tolerance
]
print("\n".join(over))

# %% [markdown]
# ## Asserted

# %%
assert set(verdicts(cases)) == {"agrees"}
defaults = {name for name in verdicts(cases)["agrees"] if name.endswith("-default")}
assert len(defaults) == sum(len(recompute.record(name).comparisons) for name in names()) == 17
# Where the default misses the tolerance it is a run-up with the scene's own cells, or the exciter's formulas.
assert all(", runup" in question or question.startswith("vibratory_table") for question in over)
