# ---
# jupyter:
#   jupytext: {text_representation: {extension: .py, format_name: percent}}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # A washing machine designed
#
# **Question.** A front loader is to have two balancer rings, one at each end of its drum. How much brine
# belongs into them, and what does it do to the spin cycle: vibration, gaps, hold on the floor, motor?
#
# The machine is `front_loader`, which comes with the package: a tub of six degrees of freedom on springs
# and dampers, uneven laundry in two places, a cabinet on four feet. All its values are assumed, of usual
# size. Put your own file in its place: `lb.load_scene("my_machine.toml")`.

# %%
import matplotlib.pyplot as plt
import numpy as np

import leblanc as lb

plt.rcParams |= {"figure.dpi": 110, "figure.figsize": (7.0, 3.6), "figure.constrained_layout.use": True}
RPM, MM, LITRE = 2.0 * np.pi / 60.0, 1e-3, 1e-3  # of a unit in SI units

machine = lb.example("front_loader")
rings = [f"chambers.{k}.volume" for k in range(len(machine.chambers))]
empty = machine.replace(dict.fromkeys(rings, 0.0))
full_speed = machine.speeds.stop

# %% [markdown]
# ## Before any solution
#
# `explain` needs a second. Two of its numbers frame the design: the natural frequencies, which the run-up
# must pass, and the centrifuging speed, from which the liquid forms an annular layer.

# %%
explained = lb.explain(machine)
natural = np.array([mode.frequency for mode in explained.modes]) / RPM
print("Natural frequencies without liquid:", ", ".join(f"{speed:.0f}" for speed in natural), "rpm")
for number, layer in enumerate(explained.layers, start=1):
    print(f"Ring {number}: annular layer from rest at about {layer.carried_from / RPM:.0f} rpm")

# %% [markdown]
# ## How much brine?
#
# First a scan with the same volume in both rings, at full speed only; then the search over both volumes.
# The search has a limit on its evaluations, so that this page takes seconds. Without the limit it takes
# longer and may spare some more brine.

# %%
volumes = np.linspace(0.0, 3.2 * LITRE, 33)
scanned = [
    lb.run(machine.replace(dict.fromkeys(rings, each)), speeds=[full_speed]) for each in volumes.tolist()
]
amplitude = np.array([answer.amplitude[-1] for answer in scanned])
known = np.array([np.isfinite(answer.error_estimate[-1]) for answer in scanned])
best = lb.optimise(machine, "working_speed", front=False, max_evaluations=120)
print(f"Best of {best.evaluations} pairs:", " and ".join(f"{v / LITRE:.2f} l" for v in best.volume))

# %% [markdown]
# Each ring has eight baffles. A shallow layer stands between them in compartments and cannot gather on
# one side. Once it covers the baffles, the amplitude falls by a step; beyond the step more brine adds
# nothing.
#
# Figure: Amplitude of the drum at full speed over the volume of brine in each ring. Open circles: the
# brine stands in compartments, and the error is not known.

# %%
figure, axes = plt.subplots()
axes.plot(volumes / LITRE, amplitude / MM, color="0.7", zorder=0)
axes.plot(volumes[known] / LITRE, amplitude[known] / MM, "o", label="error known")
axes.plot(volumes[~known] / LITRE, amplitude[~known] / MM, "o", mfc="white", label="error not known")
axes.plot(best.volume / LITRE, [best.value / MM] * best.volume.size, "k^", label="best pair, one mark a ring")
axes.set(xlabel="brine in each ring (l)", ylabel="amplitude (mm, 0-peak)", ylim=(0.0, 2.5))
axes.legend(loc="lower right")
plt.show()

# %% [markdown]
# ## The spin cycle
#
# A steady answer does not say how the machine gets there. The run-up solves tub, drum and liquid in time,
# from the tumbling speed to full speed, with the brine first as a pool at the bottom. Few cells round the
# wall keep it short; the check with half of them gives the error.

# %%
cycle = {
    "programme.start": "45 rpm",
    "programme.steps": ["to 90 rpm in 3 s", "hold 1 s", "to 1200 rpm at 80 rpm/s", "hold 3 s"],
}
filled = machine.replace(dict(zip(rings, best.volume.tolist(), strict=True)))
before = lb.run_up(empty.replace(cycle), cells=32, check=False)
after = lb.run_up(filled.replace(cycle), cells=32)

# %% [markdown]
# Figure: Above, amplitude of the drum during the spin cycle without and with brine; the run-up passes the
# natural frequencies in the first seconds, and the second rise with brine is where the pools become
# rings. Below, the margin against walking: at zero a foot slips or lifts off.

# %%
figure, (above, below) = plt.subplots(2, 1, figsize=(7.0, 5.4), sharex=True)
for run, label in ((before, "without brine"), (after, "with brine")):
    above.plot(run.time, run.amplitude / MM, lw=0.8, label=label)
    below.plot(run.time, 100.0 * run.walking_margin_over_time, lw=0.8, label=label)
above.set(ylabel="amplitude (mm, 0-peak)", ylim=(0.0, None))
below.set(xlabel="time (s)", ylabel="margin against walking (%)", ylim=(50.0, 100.0))
below.legend(loc="lower left")
speed = above.twinx()
speed.plot(after.time, after.speed / RPM, color="0.6", ls="--")
speed.set(ylabel="spin speed, dashed (rpm)", ylim=(0.0, None))
plt.show()

# %% [markdown]
# ## Before and after

# %%
rows = (
    ("amplitude at full speed, steady", "mm", best.baseline / MM, best.value / MM),
    ("largest amplitude of the cycle", "mm", before.peak["amplitude"] / MM, after.peak["amplitude"] / MM),
    *(
        (f"least gap, {name}", "mm", before.worst["clearance"][name].value / MM, gap.value / MM)
        for name, gap in after.worst["clearance"].items()
    ),
    ("least margin against walking", "%", 100.0 * before.walking_margin, 100.0 * after.walking_margin),
    (
        "largest force under a foot",
        "N",
        *(max(w.value for w in r.worst["floor_force"]) for r in (before, after)),
    ),
    (
        "largest force of a bearing",
        "N",
        *(max(w.value for w in r.worst["bearing_force"].values()) for r in (before, after)),
    ),
    ("largest torque of the motor", "N m", *(r.worst["motor_torque"].value for r in (before, after))),
)
print(f"{'':34}{'without':>10}{'with brine':>12}")
for what, unit, dry, wet in rows:
    print(f"{what:34}{dry:10.4g}{wet:12.4g} {unit}")
print("Error of the largest amplitude with brine:", end=" ")
print(
    f"{after.peak_error['cells'] / MM:.2g} mm by the cells, {after.peak_error['handover'] / MM:.2g} mm "
    "by how a pool becomes a ring"
)

# %% [markdown]
# ## What this does not say
#
# The feet do not slip or lift off in the computation: the margin says whether they would. The check
# compares two meshes; how exactly a pool becomes an annular layer is less certain than that. Small whirls
# may grow in the speeds that the run-up passes; the run-up itself has them. All values of the machine are
# assumed.
#
# ## Decision

# %%
gain = 1.0 - best.value / best.baseline
least = min(gap.value for gap in after.worst["clearance"].values())
torque = after.worst["motor_torque"].value - before.worst["motor_torque"].value
print(
    f"Fill the rings with {' and '.join(f'{v / LITRE:.2f} l' for v in best.volume)} of brine, "
    f"{best.mass:.2f} kg.\n"
    f"At full speed the amplitude falls by {100.0 * gain:.0f} %, from {best.baseline / MM:.2f} to "
    f"{best.value / MM:.2f} mm.\n"
    f"During the cycle the largest amplitude goes from {before.peak['amplitude'] / MM:.1f} to "
    f"{after.peak['amplitude'] / MM:.1f} mm, known to {after.peak_error['cells'] / MM:.1f} mm; the least gap "
    f"is {least / MM:.0f} mm.\n"
    f"The machine {'does not walk' if after.walking_margin > 0.0 else 'walks'}: "
    f"{100.0 * after.walking_margin:.0f} % of its hold is left at the worst moment.\n"
    f"The motor needs {torque:.1f} N m more. Do not fill less than {volumes[known][1] / LITRE:.1f} l: "
    "the baffles would keep the brine from gathering."
)
