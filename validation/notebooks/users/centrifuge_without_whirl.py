# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # A centrifuge without whirl
#
# **Question.** A basket centrifuge with a balancer ring is to be fed at 240 rpm. There it whirls by
# itself. Which change of fill, damping or speed ends that, and how large is the whirl if nothing is
# changed?
#
# The machine is `centrifuge`, which comes with the package: a planar rotor on a soft suspension, axis
# vertical, one ring with heavy brine. All its values are assumed.

# %%
import matplotlib.pyplot as plt
import numpy as np

import leblanc as lb

plt.rcParams |= {"figure.dpi": 110, "figure.figsize": (7.0, 3.8), "figure.constrained_layout.use": True}
RPM, MM, LITRE = 2.0 * np.pi / 60.0, 1e-3, 1e-3  # of a unit in SI units

machine = lb.example("centrifuge")
feeding = 240.0 * RPM
fill = machine.chambers[0].volume

# %% [markdown]
# ## Where small whirls grow
#
# The liquid's wave and the rotor feed each other: self-excited whirl. The map gives the growth rate of a
# small whirl over speed and volume; above zero it grows without any unbalance. Linear theory of the layer
# with the damping of the support and the friction of the liquid; the edges of the unstable band are
# solved for.

# %%
map_speeds = np.linspace(100.0, 500.0, 161) * RPM
chart = lb.map_whirl(machine, volumes=81, speeds=map_speeds)
own = lb.map_whirl(machine, volumes=[fill, 2.0 * fill], speeds=map_speeds)
bands = [(low, high) for low, high in zip(own.edge_low[0], own.edge_high[0], strict=True) if np.isfinite(low)]
for low, high in bands:
    print(f"With {fill / LITRE:.1f} l small whirls grow from {low / RPM:.1f} to {high / RPM:.1f} rpm.")

# %% [markdown]
# Figure: Growth rate of a small whirl over spin speed and volume of liquid. Red grows, blue decays, the
# black line is the stability boundary; dashed, the fill and the feeding speed.

# %%
figure, axes = plt.subplots()
limit = np.nanmax(chart.growth)
colours = axes.pcolormesh(
    chart.speed / RPM, chart.volume / LITRE, chart.growth, cmap="RdBu_r", vmin=-limit, vmax=limit
)
axes.contour(chart.speed / RPM, chart.volume / LITRE, chart.growth, levels=[0.0], colors="k", linewidths=1.0)
axes.axvline(feeding / RPM, color="k", ls="--", lw=0.8)
axes.axhline(fill / LITRE, color="k", ls="--", lw=0.8)
axes.set(xlabel="spin speed (rpm)", ylabel="volume of liquid (l)")
figure.colorbar(colours, label="growth rate (1/s)")
plt.show()

# %% [markdown]
# No fill but none and full is free of whirl at all speeds. At one speed a fill may be: the boundary says
# which.

# %%
at_feeding = np.array([np.interp(feeding, chart.speed, row) for row in chart.growth])
quiet = chart.volume[(at_feeding < 0.0) & (chart.volume > 0.0)]
thin = quiet[quiet < fill].max()
worst = chart.volume[np.argmax(at_feeding)]
print(f"At the feeding speed no small whirl grows up to {thin / LITRE:.2f} l, nor in a full ring.")
print(f"With the fill it grows by {np.interp(fill, chart.volume, at_feeding):.2f} 1/s,")
print(f"at most by {at_feeding.max():.2f} 1/s, with {worst / LITRE:.1f} l.")

# %% [markdown]
# ## What would end it
#
# `explain` tries each change alone. Then the damping of the support is varied in steps of 8 %, over all
# speeds of the machine: a little more damping **widens** the band, since the wave that feeds the whirl
# carries negative energy; only much more ends it.

# %%
explained = lb.explain(machine)
for cure in explained.cures:
    print(f"{cure.kind:18} {cure.text}")

# %%
all_speeds = np.linspace(100.0, machine.speeds.stop / RPM, 281) * RPM
damped = lb.map_whirl(machine, over="rotor.damping_ratio", start=0.01, stop=1.0, values=61, speeds=all_speeds)
strongest = np.nanmax(damped.growth, axis=1)
enough = damped.value[np.flatnonzero(strongest > 0.0)[-1] + 1]
print(
    f"No whirl grows from a damping ratio of {enough:.2f} on; the machine has "
    f"{machine.rotor.damping_ratio:.2f}."
)

# %% [markdown]
# Figure: Left, largest growth rate over all speeds against the damping ratio of the support. Right, the
# unstable band, with the feeding speed dashed.

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.4))
left.semilogx(damped.value, strongest)
left.axhline(0.0, color="0.6", lw=0.8)
left.axvline(machine.rotor.damping_ratio, color="k", ls=":", label="as it is")
left.set(xlabel="damping ratio of the support (1)", ylabel="largest growth rate (1/s)")
left.legend()
right.contourf(
    damped.value, damped.speed / RPM, damped.growth.T, levels=[0.0, np.inf], colors=["tab:red"], alpha=0.5
)
right.axhline(feeding / RPM, color="k", ls="--", lw=0.8)
right.axvline(machine.rotor.damping_ratio, color="k", ls=":")
right.set(
    xscale="log", xlabel="damping ratio of the support (1)", ylabel="spin speed (rpm)", ylim=(100.0, 500.0)
)
plt.show()

# %% [markdown]
# ## How large it grows
#
# Growth ends where the wave drags the liquid back. `cycles=True` solves for whirls of finite size along
# each branch. It also finds where a large whirl survives beyond the band of small ones.

# %%
grown = lb.map_whirl(machine, volumes=2, speeds=3, cycles=True)
cycle = [(one.speed, one.amplitude) for one in grown.cycles if one.stable]
cycle_speed, cycle_amplitude = np.array(cycle).T
rising = slice(0, int(np.argmax(cycle_amplitude)) + 1)  # the branch that begins at the lower edge
whirl = np.interp(feeding, cycle_speed[rising], cycle_amplitude[rising])
steady = lb.run(machine, speeds=[feeding, 1.01 * feeding])
response = steady.amplitude[0]
print(
    f"Limit cycle at the feeding speed: {whirl / MM:.2f} mm; response to the unbalance: "
    f"{response / MM:.2f} mm."
)

# %% [markdown]
# ## Check in time
#
# Rotor and liquid are integrated in time: up to the feeding speed, then held there. Whirl and response to
# the unbalance turn at different speeds, so the amplitude beats between their difference and their sum.
# The same with the damping ratio that ends the growth.

# %%
hold = {"runup.stop": f"{feeding / RPM} rpm", "runup.duration": "60 s"}
as_it_is = lb.run_up(machine.replace(hold), check=False)
cured = lb.run_up(machine.replace(hold | {"rotor.damping_ratio": float(enough)}), check=False)
late = as_it_is.time > 0.5 * as_it_is.time[-1]
beat = as_it_is.amplitude[late]

# %% [markdown]
# Figure: Left, stable limit cycles over the spin speed. Right, amplitude while the feeding speed is held,
# as it is and with enough damping; dashed, the sum and the difference of limit cycle and response.

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.4))
left.plot(cycle_speed / RPM, cycle_amplitude / MM, ".", ms=5)
left.axvline(feeding / RPM, color="k", ls="--", lw=0.8)
left.set(xlabel="spin speed (rpm)", ylabel="amplitude of the limit cycle (mm)", ylim=(0.0, None))
right.plot(as_it_is.time, as_it_is.amplitude / MM, lw=0.7, label="as it is")
right.plot(cured.time, cured.amplitude / MM, lw=1.2, label="enough damping")
for bound in (whirl + response, abs(whirl - response)):
    right.axhline(bound / MM, color="k", ls="--", lw=0.8)
right.set(xlabel="time (s)", ylabel="amplitude (mm, 0-peak)", ylim=(0.0, None))
right.legend(loc="lower right")
plt.show()

# %% [markdown]
# ## Passing the band
#
# The shipped run-up passes the band on its way to full speed.

# %%
passing = lb.run_up(machine)
print(
    f"Largest amplitude when passing: {passing.peak['amplitude'] / MM:.2f} mm, without liquid "
    f"{passing.peak_dry['amplitude'] / MM:.2f} mm."
)

# %% [markdown]
# ## What this does not say
#
# The growth rates are those of an even layer with a wet wall. The laminar friction of the map is the
# least; a turbulent wall moves the band little and makes the whirl larger.
#
# ## Decision

# %%
low, high = bands[0][0], max(bands[-1][1], cycle_speed.max())  # a large whirl may live beyond the band
cures = {cure.kind: cure.text for cure in explained.cures}
print(
    f"Do not feed at {feeding / RPM:.0f} rpm: a whirl of {whirl / MM:.1f} mm grows by itself, and with the "
    f"response to the unbalance the basket moves by {beat.max() / MM:.1f} mm.\n"
    f"The sum of limit cycle and response is {(whirl + response) / MM:.1f} mm: the run in time confirms it "
    f"within {100.0 * abs(beat.max() / (whirl + response) - 1.0):.0f} %.\n"
    f"The fill: at that speed up to {thin / LITRE:.2f} l stay quiet; at all speeds {cures['less liquid']}, "
    f"or {cures['more liquid']}.\n"
    f"A damping ratio of {enough:.2f} ends it, {enough / machine.rotor.damping_ratio:.0f} times what the "
    f"mounts have; then {cured.amplitude[-1] / MM:.1f} mm are left at the feeding speed.\n"
    f"The cheap cure is the speed: feed below {low / RPM:.0f} rpm or above {high / RPM:.0f} rpm, and pass "
    f"what lies between at the shipped rate, with {passing.peak['amplitude'] / MM:.1f} mm at most."
)
