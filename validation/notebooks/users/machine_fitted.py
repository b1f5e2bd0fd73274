# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # A machine fitted to a measurement
#
# **Question.** Neither the damping nor the critical speed of a rig is known. Six photographs show where
# its liquid stood. What do they say about both values, how surely, and what follows for another fill?
#
# The machine is `horizontal_rig` [DR18, section 7.2], which comes with the package: a disc on a
# horizontal shaft with two chambers, 10 ml of water in each. The angles are those of [DR18, Fig. 24]:
# from the unbalance to the liquid, below zero where the liquid is behind. They are multiples of 30
# degrees, so each was read to half of that.

# %%
import matplotlib.pyplot as plt
import numpy as np

import leblanc as lb

plt.rcParams |= {"figure.dpi": 110, "figure.figsize": (7.0, 3.8), "figure.constrained_layout.use": True}
RPM, MM, DEG = 2.0 * np.pi / 60.0, 1e-3, np.pi / 180.0  # of a unit in SI units

rig = lb.example("horizontal_rig")
measured = [(600, 0), (900, -30), (1000, -90), (1100, -120), (1200, -150), (1300, -180)]
np.savetxt("angles.csv", measured, "%g", ", ", header="speed [rpm], liquid_angle [deg]", comments="")

# %% [markdown]
# ## The fit
#
# `fit` varies the unknowns of the machine file until the computed angles lie nearest to the measured
# ones. A reading to 30 degrees is an error that is even over 30 degrees: its standard deviation is 30
# over the root of 12. It is stated as the noise, so that the standard errors do not hang on six
# residuals.

# %%
reading = 30.0 / np.sqrt(12.0)
unknown = ["rotor.damping_ratio", "rotor.critical_speed"]
fitted = lb.fit(rig, "angles.csv", unknown, noise=f"{reading} deg")
print(f"{'':22}{'first guess':>12}{'found':>10}{'std error':>11}   interval of 95 %")
scales = dict(zip(unknown, (1.0, RPM), strict=True))
for k, (name, scale) in enumerate(scales.items()):
    one, (low, high) = fitted.parameters[name], fitted.interval[k] / scale
    print(
        f"{name:22}{fitted.first[k] / scale:12.4g}{one['value'] / scale:10.4g}{one['std'] / scale:11.2g}"
        f"   {low:.4g} to {high:.4g}"
    )

# %% [markdown]
# The shape of the residuals matters more than their size. A run of residuals of one sign would say that
# the model lacks something that the machine has; `accepted` tests that.

# %%
(angles,) = fitted.measured
residual = (angles.value - angles.fitted) / DEG
for speed, left in zip(fitted.at, residual, strict=True):
    print(f"{speed / RPM:6.0f} rpm {left:+7.1f} deg")
print("accepted:", fitted.accepted)

# %% [markdown]
# Figure: Left, measured angles with the interval of their reading, and the fitted curve. Right, what is
# left over the speed; grey, the interval of the reading.

# %%
values = {name: one["value"] for name, one in fitted.parameters.items()}
known = rig.replace(values)
speeds = np.linspace(500.0, 1400.0, 181) * RPM
angle = np.unwrap(lb.run(known, speeds=speeds).liquid_angle)
figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.4))
left.errorbar(fitted.at / RPM, angles.value / DEG, yerr=15.0, fmt="o", capsize=3, label="measured")
left.plot(speeds / RPM, angle / DEG, label="fitted")
left.set(xlabel="spin speed (rpm)", ylabel="angle of the liquid (deg)", yticks=np.arange(-180, 31, 30))
left.legend()
right.axhspan(-15.0, 15.0, color="0.9")
right.axhline(0.0, color="0.6", lw=0.8)
right.plot(fitted.at / RPM, residual, "o")
right.set(
    xlabel="spin speed (rpm)", ylabel="measured less fitted (deg)", xlim=(550.0, 1350.0), ylim=(-30.0, 30.0)
)
plt.show()

# %% [markdown]
# ## Another fill, with its uncertainty
#
# The two values are not exact, so a prediction is not either. Pairs are drawn from their standard errors
# and correlation, in logarithms, as both are above zero; the machine of each pair answers with the other
# fill. What is predicted: amplitude with 1 ml and with 10 ml in each chamber.

# %%
names = list(fitted.parameters)
centre = np.log([fitted.parameters[name]["value"] for name in names])
spread = np.array([fitted.parameters[name]["std"] / fitted.parameters[name]["value"] for name in names])
covariance = fitted.correlation * np.outer(spread, spread)
draws = np.exp(np.random.default_rng(1).multivariate_normal(centre, covariance, size=60))
fills = {"1 ml": "1 ml", "10 ml, as measured": "10 ml"}
shown = np.linspace(800.0, 1600.0, 41) * RPM
drawn = {}
for label, volume in fills.items():
    filled = rig.replace({"chambers.0.volume": volume, "chambers.1.volume": volume})
    machines = [filled.replace(dict(zip(names, pair, strict=True))) for pair in draws.tolist()]
    drawn[label] = np.array([lb.run(one, speeds=shown).amplitude for one in machines])

# %% [markdown]
# Figure: Predicted amplitude over spin speed with two fills: median, and the interval that holds nine
# tenths of the draws.

# %%
figure, axes = plt.subplots()
for label, amplitude in drawn.items():
    low, middle, high = np.quantile(amplitude, [0.05, 0.5, 0.95], axis=0) / MM
    (line,) = axes.plot(shown / RPM, middle, label=label)
    axes.fill_between(shown / RPM, low, high, color=line.get_color(), alpha=0.2)
axes.set(xlabel="spin speed (rpm)", ylabel="amplitude (mm, 0-peak)", ylim=(0.0, None))
axes.legend(title="water in each chamber")
plt.show()

# %% [markdown]
# ## What this does not say
#
# Six angles tell two values. Mass, unbalance and the chambers' heights stay as assumed in the machine
# file: an error in them is not in the intervals, and the predicted amplitude is in proportion to the
# assumed unbalance. A gap in the speeds measured hides a sharp turn of the angle.
#
# ## Decision

# %%
damping, critical = (fitted.parameters[name] for name in unknown)
outside = np.count_nonzero(np.abs(residual) > 15.0)
at = int(np.argmin(np.abs(shown - 1600.0 * RPM)))
few, many = (np.quantile(each[:, at], [0.05, 0.5, 0.95]) / MM for each in drawn.values())
peak_few, peak_many = (np.quantile(each.max(axis=1), [0.05, 0.5, 0.95]) / MM for each in drawn.values())
print(
    f"Damping ratio {damping['value']:.3f} with a standard error of {damping['std']:.3f}; critical speed "
    f"without liquid {critical['value'] / RPM:.0f} rpm with {critical['std'] / RPM:.0f} rpm.\n"
    f"The fit is {'accepted' if fitted.accepted else 'not accepted'}: residuals of "
    f"{np.sqrt(np.mean(residual**2)):.0f} degrees "
    f"(rms) beside a reading of {reading:.0f}; {outside} of {residual.size} angles lie outside of their "
    "interval.\n"
    f"With {next(iter(fills.values()))} in place of {rig.chambers[0].volume * 1e6:.0f} ml in each "
    f"chamber the amplitude at {shown[at] / RPM:.0f} rpm is {few[1]:.3f} mm ({few[0]:.3f} to {few[2]:.3f}) "
    f"in place of {many[1]:.3f} mm.\n"
    f"Its largest value is {peak_few[1]:.2f} mm ({peak_few[0]:.2f} to {peak_few[2]:.2f}) in place of "
    f"{peak_many[1]:.2f} mm: it hangs on the damping, whose error is "
    f"{100.0 * damping['std'] / damping['value']:.0f} %.\n"
    f"Measure next: the amplitude at two speeds near {critical['value'] / RPM:.0f} rpm."
)
