# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # 2. The wave in the layer: exact theory and computed flow
#
# A layer of liquid lies on the wall of a drum that whirls. What force does it put on the drum? Three
# answers are compared: the exact linear theory of the plane inviscid layer (`docs/theory/liquid.md`), the
# nonlinear long-wave model of the package (`docs/theory/nonlinear.md`), and two-phase flow computed with
# OpenFOAM.

# %% [markdown]
# ## Who measured or printed what
#
# * Nothing here was measured in a laboratory. The reference is a computation: interFoam, volume of fluid,
#   plane flow with a gas of density 1 inside the layer, made for this comparison and kept in
#   `validation/data/openfoam_layer.json`. It solves the full equations, but has an error of its own, which
#   the file tells and the next cell prints.
# * Cases A and B: a whirl at the spin speed, and at whirl ratios (whirl over spin speed) of 0.5, 0.85 and
#   1.3; the wall is frictionless. Case C: a whirl at the retrograde free wave, where a bore goes round the
#   wall; the wall holds the liquid.
#
# ## Assumed
#
# * Plane flow, no gravity across the axis, no surface tension. The layer is a tenth of the radius.
# * The flow's wall friction in case C is not known as a law: taken is that of a laminar layer that
#   oscillates with the whirl (Stokes), on the wall alone, since a plane flow has neither floor nor lid.

# %%
import numpy as np
from scipy.integrate import quad

from fluid import kdv, long_wave
from validation.cases.liquid import layer
from validation.cases.liquid.layer import bore_figure, bore_summary, force_figure
from validation.page import Table, case_table, picture, verdicts
from validation.study import data

Table(("How sure the computed flow is, by its file",), ((data("openfoam_layer.json")["accuracy"],),))

# %% [markdown]
# ## Smooth layers
#
# The linear force has no bound at the two free waves with one crest. Between and beside them the long waves
# (crosses, here with few cells) and the computed flow (squares) lie on the exact line. At whirl ratio 1 the
# force is that of a full drum.

# %%
picture(force_figure())

# %% [markdown]
# ## A bore
#
# At the free wave the linear theory has no answer. The whirl drags the wave round, the bore loses energy,
# and its torque turns the whole layer backwards in the drum, which takes it out of resonance: the force
# turns from *90 degrees ahead* to *along*. The computed flow took about a quarter of an hour of a core;
# each line here takes about a second.

# %%
picture(bore_figure())

# %%
header = (
    "Long waves",
    "crest over the computed flow's, mm",
    "trough",
    "rotation at the last common time, rad/s",
)
Table(
    header, tuple((name, *(f"{value:+.2f}" for value in values)) for name, values in bore_summary().items())
)

# %% [markdown]
# ## Number by number
#
# For case C the deviation is the distance of the complex forces over the size of the reference's, whirl
# period by whirl period. Called agreement is 10 % in the first three periods. From the fourth on the computed
# flow depends on its mesh by more than that, and is no target: what is compared is a trend.

# %%
cases = layer.cases()
case_table(cases)

# %% [markdown]
# ## The pressure on the wall
#
# A long wave has the velocity `u R/r` along circles. What holds it there is the pressure, which grows
# outwards by `(Omega r + u R/r)^2/r` and by the acceleration of the drum. Summed up from the surface to the
# wall by quadrature it must be the closed form that the models take, at troughs and crests, with the spin and
# against it. Without a velocity the pressure also has a moment about the axis, over a section through the
# layer, which the models take in closed form as well. In units of R, Omega and the density.

# %%
pressures, moments = [], []
for depth, along, pull in ((0.05, -0.1, 0.02), (0.1, 0.0, 0.02), (0.15, 0.1, -0.02), (0.3, 0.2, 0.0)):
    surface = 1.0 - depth
    area = 0.5 * (1.0 - surface**2)
    summed, _ = quad(lambda r, u=along, f=pull: (r + u / r) ** 2 / r + f, surface, 1.0)
    closed = float(long_wave.wall_pressure(along, long_wave.layer_log(area), area, surface, 1.0, pull))
    pressures.append((depth, along, summed, closed))
    # Each ring adds its pressure to all that lies outside it, whose moment is (1 - r^2)/2.
    turned, _ = quad(lambda r, f=pull: (r + f) * 0.5 * (1.0 - r * r), surface, 1.0)
    moments.append((depth, pull, turned, float(long_wave.pressure_force(area, surface, 1.0, pull))))
Table(
    ("On", "Depth", "Velocity or pull", "Summed up", "Closed form"),
    tuple(
        (what, f"{depth:g}", f"{given:g}", f"{one:.12f}", f"{other:.12f}")
        for what, rows in (("the wall", pressures), ("a section", moments))
        for depth, given, one, other in rows
    ),
)

# %% [markdown]
# ## One family of waves
#
# Where waves of one family alone matter the package has the equation of Korteweg and de Vries
# (`docs/theory/nonlinear.md`). A wave of vanishing height with one crest lags behind the long waves by the
# coefficient of its dispersion, which is the first term of a series in the depth. So what the exact frequency
# gives for that coefficient must come to it as the square of the depth: within `L^2` of itself, and four
# times nearer at half the depth.

# %%
lags = {}
for family in (1, -1):
    for depth in (0.2, 0.1, 0.05):
        one = kdv.coefficients(1.0, np.exp(-depth), 1.0, family)
        exact = float(kdv.wave_frequency(1, one, whitham=True))
        lags[family, depth] = (one.linear_speed - exact) / one.dispersion - 1.0
Table(
    ("Waves run", *(f"L = {depth:g}" for depth in (0.2, 0.1, 0.05))),
    tuple(
        (name, *(f"{100.0 * lags[family, depth]:+.3f} %" for depth in (0.2, 0.1, 0.05)))
        for name, family in (("with the spin", 1), ("against it", -1))
    ),
    "Lag of the exact wave over that of the equation, less one.",
)

# %% [markdown]
# ## A rotor and its layer together
#
# In a machine the layer moves the rotor, and the rotor the layer. Run-ups have compiled steps for both. The
# same equations stand in the package as an equation of py-pde, whose state holds the layer and the
# coordinates of the rotor, with rates that are written by themselves. Here py-pde's own Runge-Kutta goes
# through one turn from rest with it, and beside it the steps of a run-up. Nobody's measurement stands behind
# it: two codes must come together as the square of a cell. Called agreement is a twentieth of that square.

# %%
together = layer.rotor_cases()
case_table(together)

# %% [markdown]
# ## What does not agree
#
# * At whirl ratio 0.5 the deviation is just above the 1 % asked for. The force is small there, and the gas
#   of the computed flow, which the models do not have, adds 0.001 to it by the file's own estimate: that is
#   the difference.
# * The fifth period of the bore is off by more than half in every variant: the computed force falls for one
#   period while all four models pass smoothly through. That dip is real within its run, for centre of mass,
#   force and torque agree, but it goes with the mesh: at twice the whirl the coarser of two meshes has it and
#   the finer has not, nor has a shock-capturing computation of the same flow that is not hydrostatic.
# * Neither dispersion nor friction changes much of the force. With friction the mean rotation of the liquid
#   stays near that of the computed flow; without, it runs ahead. With dispersion the crests stand far above
#   those of the computed flow, as the small table shows: dispersion helps smooth waves, and the undular
#   bore that it makes of this one is too high.
# * A layer under a real whirl has a floor, a lid and turbulence. None of that is compared here.
#
# ## Asserted

# %%
variants = {f"C_0.05_f1-{variant}" for variant in ("plain", "dispersion", "friction", "both")}
assert verdicts(cases) == {
    "agrees": {"A_f1", "A_f2", "B_0.85_f1", "B_1.3_f1", "B_1.3_f2", "C_0.05_f1-mean-rotation"} | variants,
    "trend": {f"{variant}-late" for variant in variants},
    "differs": {"B_0.5_f1"},
}
assert verdicts(together) == {"agrees": {*(f"rotor-{cells}-cells" for cells in layer.CELLS), "rotor-order"}}
# Quadrature and the closed form are one to rounding.
assert max(abs(one - other) for *_, one, other in [*pressures, *moments]) < 1e-12
# The first term that the equation leaves out, and the order of what is left.
assert all(abs(off) < depth**2 for (_, depth), off in lags.items())
assert all(3.5 < lags[family, 0.1] / lags[family, 0.05] < 4.5 for family in (1, -1))
half = next(case for case in cases if case.name == "layer/B_0.5_f1")
# The gas adds 0.001; without it the deviation is within the 0.6 % that the flow is said to be sure of.
assert isinstance(half.printed, float) and isinstance(half.computed, float)
assert abs(half.printed - 0.001 - half.computed) <= 0.006 * half.computed
