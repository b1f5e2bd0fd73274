# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # A liquid model of one's own
#
# **Question.** The ring of a centrifuge holds water. A film of a heavy liquid that does not mix with it
# settles on the wall. No built-in model has two liquids: how much does the film gain at full speed, and
# how thick must it be?
#
# The machine is `centrifuge`, which comes with the package, here with water in its ring. The heavy liquid
# is assumed: 1900 kg/m^3, as perfluorinated oils have.

# %%
import matplotlib.pyplot as plt
import numpy as np

import leblanc as lb

plt.rcParams |= {"figure.dpi": 110, "figure.figsize": (7.0, 3.8), "figure.constrained_layout.use": True}
RPM, MM, ML = 2.0 * np.pi / 60.0, 1e-3, 1e-6  # of a unit in SI units

machine = lb.example("centrifuge").replace({"chambers.0.liquid": "water"})
ring = machine.chambers[0]
HEAVY = 1900.0  # kg/m^3

# %% [markdown]
# ## The model
#
# In a steady whirl with the spin all liquid is at rest in the drum, and both surfaces are round about the
# *rotation axis*. Their first moments about it vanish, so that of the liquid is that of the chamber
# filled with what touches the wall. With the wall wet all round by the heavy liquid
#
#     U = rho_heavy pi R^2 h r
#
# for the deflection r: the water above it does not count at all. The film has the depth d at rest, and is
# thinner by r on one side; the law holds up to r = d.
#
# A model is a class with a name and `answer`, called with many chambers and whirls at once.
# `LiquidAnswer.at_rest` builds the answer of liquid that is at rest in the drum, from U and its
# derivative; each limit says where it is kept. A whirl at another speed than the spin moves waves on both
# surfaces, which this model does not have: it says `converged` false there, so growth rates are not
# known.


# %%
class TwoLiquids(lb.LiquidModel):
    """A film of a heavy liquid on the wall, a lighter one above it."""

    name = "two liquids"

    def __init__(self, heavy, film):
        self.heavy = heavy  # density of the film, kg/m^3; None: that of the liquid above it
        self.film = film  # depth of the film at rest, m

    def answer(self, fills, whirls):
        """See `lb.LiquidModel`."""
        density = fills.density if self.heavy is None else self.heavy
        full = density * np.pi * fills.chamber.radius**2 * fills.chamber.height
        closed = whirls.amplitude < self.film
        return lb.LiquidAnswer.at_rest(
            fills,
            whirls,
            unbalance=full * whirls.amplitude,
            slope=full * np.ones(len(fills)),
            converged=whirls.slip == 0.0,
            limits={"film closed": closed},
            error=np.where(closed, 0.0, np.inf),
        )


# %% [markdown]
# ## Two exact limits
#
# **Equal densities.** Two layers of one liquid are one: the answer is that of the built-in `linear`.
# **Any density.** U in proportion to the deflection is a mass that turns with the rotor: a rotor without
# liquid, heavier by rho pi R^2 h on the same springs, gives the same amplitude.

# %%
same = lb.run(machine, model=TwoLiquids(None, 10.0 * MM))
water = lb.run(machine, model="linear")
equal = np.abs(same.amplitude - water.amplitude).max() / water.amplitude.max()

model = TwoLiquids(HEAVY, 10.0 * MM)
own = lb.run(machine, model=model)
added = HEAVY * np.pi * ring.radius**2 * ring.height
rotor = machine.rotor.machine()
heavier = machine.rotor.mass + added
body = machine.replace(
    {
        "chambers.0.volume": 0.0,
        "rotor.mass": heavier,
        "rotor.critical_speed": np.sqrt(rotor.stiffness / heavier),
        "rotor.damping_ratio": rotor.damping / (2.0 * np.sqrt(rotor.stiffness * heavier)),
    }
)
rigid = lb.run(body)
exact = np.abs(own.amplitude - rigid.amplitude).max() / rigid.amplitude.max()
met = max(equal, exact) < 1e-12  # of the largest amplitude: rounding
print("Equal densities, as the built-in model:", equal < 1e-12)
print("As a heavier rotor without liquid:     ", exact < 1e-12)

# %% [markdown]
# ## Beside the built-in models
#
# `compare` takes names and objects in one list; the last one that answers is the reference. Differences
# from the two models of water are what the film does.

# %%
compared = lb.compare(machine, [model, "linear", "statics"])
for each in compared.answers:
    print(
        f"{each.model:12} largest amplitude {each.peak_amplitude / MM:.3f} mm, at full speed "
        f"{each.amplitude[-1] / MM:.3f} mm"
    )
apart = compared.largest_difference("linear")
print(
    f"linear is {apart:.1e} of the largest amplitude from statics: at the lowest speeds the wall is dry "
    "in part"
)

# %% [markdown]
# Figure: Left, amplitude over spin speed without liquid, with water, and with a heavy film below the
# water. Right, the same from the working range on.

# %%
figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.6))
curves = (
    ("without liquid", compared.amplitude_dry),
    ("water", compared.results["statics"].amplitude),
    ("heavy film", compared.results["two liquids"].amplitude),
)
for part, fast in zip(axes, (0.0, 600.0 * RPM), strict=True):
    shown = compared.speed >= fast
    for label, amplitude in curves:
        part.plot(compared.speed[shown] / RPM, amplitude[shown] / MM, label=label)
    part.set(xlabel="spin speed (rpm)", ylabel="amplitude (mm, 0-peak)")
axes[0].legend()
plt.show()

# %% [markdown]
# ## How thick?
#
# The film must be deeper than the deflection, or the water reaches the wall and the law ends: `in_range`
# is then false. The passage of the resonance needs more than full speed does.

# %%
depths = np.linspace(0.25, 10.0, 40) * MM
ranges = np.array([lb.run(machine, model=TwoLiquids(HEAVY, each)).in_range for each in depths.tolist()])
at_full_speed, everywhere = depths[np.argmax(ranges[:, -1])], depths[np.argmax(ranges.all(axis=1))]
volume = np.pi * ring.height * (ring.radius**2 - (ring.radius - np.array([at_full_speed, everywhere])) ** 2)

# %% [markdown]
# Figure: Share of the speeds at which the film stays closed, over its depth; dashed, the least depth that
# serves at full speed.

# %%
figure, axes = plt.subplots(figsize=(7.0, 3.0))
axes.plot(depths / MM, 100.0 * ranges.mean(axis=1), drawstyle="steps-post")
axes.axvline(at_full_speed / MM, color="k", ls="--", lw=0.8)
axes.set(xlabel="depth of the film (mm)", ylabel="speeds in range (%)", ylim=(0.0, 105.0))
plt.show()

# %% [markdown]
# ## For good
#
# A model in an installed package is announced by an entry point in the group `leblanc.liquids`; then
# `[model] liquid = "two liquids"` in a machine file, and its name in every command, mean it.
#
# ## What this does not say
#
# The liquids must separate before the resonance is passed, and the surface between them has waves of its
# own: this model has no growth of whirl. The density of the film is assumed.
#
# ## Decision

# %%
dry, plain, film = (amplitude[-1] for _, amplitude in curves)
print(
    f"At {machine.speeds.stop / RPM:.0f} rpm water takes {100.0 * (1.0 - plain / dry):.1f} % off the "
    f"amplitude, a heavy film {100.0 * (1.0 - film / dry):.1f} %: "
    f"from {dry / MM:.2f} to {film / MM:.2f} mm.\n"
    f"It must be {at_full_speed / MM:.2f} mm deep for that, {volume[0] / ML:.0f} ml, and "
    f"{everywhere / MM:.1f} mm or {volume[1] / ML:.0f} ml to stay closed in the resonance as well.\n"
    f"The model {'meets' if met else 'misses'} both exact limits to rounding.\n"
    "Growth of whirl is not answered: ask a built-in model with the heavy liquid before anything is bought."
)
