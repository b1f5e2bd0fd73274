# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 4. Self-excited whirl
#
# A rotor partly filled with liquid can whirl by itself, without any unbalance: the rotor and a wave that
# runs round the drum feed each other. Where, and how fast does it grow? The package solves the
# characteristic equation of rotor and plane layer (`docs/theory/rotors.md`); it is held against known
# figures and against the coupled nonlinear model in time, which shares only the rotor with it.

# %% [markdown]
# ## Who measured or printed what
#
# * The printed bands and growth rates are computed figures of the frictionless problem that is known by
#   Wolf's name: a scan of the characteristic equation in steps of 0.0005 of the natural frequency. An edge
#   is known to one step, a rate to its last digit.
# * Nothing here was measured. Of experiments it is reported, without data at hand, that a chamber
#   completely full shows no whirl of its own, which is one of the limits below, and that the whirl has
#   hysteresis between running up and down, which limit cycles have too (`docs/howto/stability.md`).
#
# ## Assumed
#
# * A rotor on supports that are alike in all directions, plane layers, no gravity. Bands and rates are those
#   of infinitesimal motion of a planar rotor with one layer; those named limit-cycle,
#   run-up and run-down are whirls of finite size.
# * Friction of the liquid is a law that must be chosen. Each line below says which one it has: none, a
#   linear one, or that of a laminar layer on the wall.

# %%
import leblanc as lb
from validation.cases.rotors import whirl
from validation.cases.rotors.whirl import growth_figure, in_time
from validation.page import case_table, picture, verdicts

# %%
cases = whirl.cases()
picture(growth_figure(in_time(cases)))

# %% [markdown]
# Damping of the support alone makes the rotor weakly unstable at every speed: the wave that runs against
# the spin carries negative energy, and what takes energy from it makes it grow. Dissipation in the liquid
# is needed for a stable answer.
#
# ## Number by number
#
# In the cases named *in-time* the whirl is let go from a ten-millionth of the depth and its growth is
# measured in the computed motion; *printed* is then the root of the characteristic equation. In those named
# *limit-cycle* the growth has come to its end: *printed* is the balance of a whirl of finite size, computed
# the rotor with its layers, kicked and followed in time until the whirl is steady. Those named *run-up* and
# *run-down* pass the band on a slow ramp: their amplitude tends to the branch's in proportion to the rate.

# %%
case_table(cases)

# %% [markdown]
# ## On a machine
#
# The map of the horizontal rig of notebook 3, whose sizes are partly assumed: hatched where some whirl
# grows.

# %%
picture(lb.map_whirl(lb.example("horizontal_rig"), volumes=61, speeds=151).plot())

# %% [markdown]
# ## What does not agree
#
# * Nothing of the table does. The differences are within the step of the scan and the digits of the printed
#   figures; in time they are those of 256 cells.
# * What is left open is the comparison with a measured whirl. The sources measured none, and the friction
#   of a real chamber's liquid, on which the width of the bands depends, is not known.
# * Floor and lid are outside of this theory, and a dry wall is outside of the bands and rates.
#
# ## Asserted

# %%
assert verdicts(cases) == {
    "agrees": {
        *("mu-0.1-lower-edge", "mu-0.1-upper-edge", "mu-0.5-lower-edge", "mu-0.5-upper-edge"),
        *("peak-zeta-0", "peak-zeta-0.05", "damping-alone", "empty", "full", "rigid"),
        *("in-time-1.15", "in-time-1.3", "in-time-1.45", "in-time-1", "in-time-1.7"),
        *("limit-cycle-planar-1.3", "limit-cycle-two-planes-1.25"),
        *("run-up-1.6", "run-up-lag-1.6", "run-down-1.3", "run-down-lag-1.3", "run-up-growth"),
    }
}
