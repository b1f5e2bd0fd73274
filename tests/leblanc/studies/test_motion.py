"""`leblanc run` and `explain` for rotors that tilt: JSON, files, figures, words."""

from __future__ import annotations

import json
import math
import re
import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import eigh

from fluid.fill import Fill
from fluid.liquid import known_liquid
from leblanc.cli import main
from leblanc.liquid.choose import prepare
from leblanc.plotting.chambers import chamber_figure, side_by_side
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene, dry_rotor, load_scene, scene_from_table
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.figure import amplitude_figure, campbell_figure
from leblanc.studies.run.study import rest_modes, run_scene
from leblanc.studies.run.words import comparisons, facts
from meshes.chamber import Chamber
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import critical_speeds, orbit, unbalance_response
from solvers.synchronous.response import main_critical_speeds, wet_critical_speeds
from tests.leblanc.studies.test_run import KEYS
from tests.mutants import kills

MORE = ("vertical_rig", "washing_machine")
SAME = """
name = "Two views of one rotor"
[rotor]
{rotor}
[[chambers]]
radius = 0.065
height = 0.02
volume = 1e-5
liquid = "water"
[speeds]
start = 40
stop = 250
count = 40
"""
JEFFCOTT = 'kind = "jeffcott"\nmass = 4\nstiffness = 4e4\ndamping = 16\nunbalance = 3e-3\naxis = "horizontal"'
AS_TWO_PLANE = """
kind = "two_plane"
mass = 4
transverse_inertia = 0.05
polar_inertia = 0.04
axis = "horizontal"
supports = [
  { position = -0.2, stiffness = 2e4, damping = 8 },
  { position = 0.2, stiffness = 2e4, damping = 8 },
]
unbalances = [{ position = 0, size = 3e-3 }]
"""


@cache
def answered(name: str) -> RunAnswer:
    """What `run` says of an example."""
    return run_scene(load_scene(f"examples/{name}.toml"))


def read(rotor: str) -> Scene:
    return scene_from_table(tomllib.loads(SAME.format(rotor=rotor)))


def test_one_rotor_two_ways() -> None:
    """All in the middle plane: the record of the planar rotor, dry patches and branches included."""
    one, other = run_scene(read(JEFFCOTT)), run_scene(read(AS_TWO_PLANE))
    np.testing.assert_allclose(other.amplitude, one.amplitude, rtol=1e-8)
    np.testing.assert_allclose(other.amplitude_dry, one.amplitude_dry, rtol=1e-8)
    np.testing.assert_allclose(other.response.branch_amplitude, one.response.branch_amplitude, rtol=1e-8)
    np.testing.assert_allclose(other.response.liquid_offset, one.response.liquid_offset, rtol=1e-8)
    np.testing.assert_array_equal(other.response.dry_patch, one.response.dry_patch)
    assert one.response.dry_patch.any()
    assert other.critical_speed_dry == pytest.approx(one.critical_speed_dry, rel=1e-9)
    assert other.critical_speed_wet == pytest.approx(one.critical_speed_wet, rel=1e-9)
    told = explain_scene(read(JEFFCOTT)), explain_scene(read(AS_TWO_PLANE))
    assert told[1].critical_speed_dry == pytest.approx(told[0].critical_speed_dry, rel=1e-9)
    assert told[1].damping_ratio == pytest.approx(told[0].damping_ratio, rel=1e-2)  # at speed, not at rest
    layers = [one.layers[0] for one in told]
    assert layers[0] is not None and layers[1] is not None
    assert layers[1].added_mass_ratio == pytest.approx(layers[0].added_mass_ratio, rel=1e-12)
    assert layers[1].optimal_volume == pytest.approx(layers[0].optimal_volume, rel=1e-6)


@pytest.mark.parametrize(
    "name",
    ["horizontal_rig", "two_plane_rig", "tub", *(pytest.param(n, marks=pytest.mark.slow) for n in MORE)],
)
def test_critical_speeds_are_the_machine_s(name: str) -> None:
    """The same number for other speeds, as many or as few, for chambers in any order, and in `explain`."""
    scene = load_scene(f"examples/{name}.toml").altered(runup=None)
    stop = scene.speeds.stop
    asked = [
        (0.1 * stop, stop, 7),
        (0.5 * stop, 0.55 * stop, 3),
        (3.0 * stop, 4.0 * stop, 5),
        (stop, stop, 1),
    ]
    found = []
    for start, last, count in asked:
        other = scene.altered(speeds=scene.speeds.altered(start=start, stop=last, count=count))
        found += [run_scene(other), explain_scene(other)]
    swapped = scene.altered(chambers=scene.chambers[::-1])
    found.append(explain_scene(swapped))
    for answer in found:
        assert answer.critical_speed_dry == pytest.approx(found[0].critical_speed_dry, rel=1e-12)
        assert answer.critical_speed_wet == pytest.approx(found[0].critical_speed_wet, rel=1e-12)


@kills("solvers.synchronous.response:main_critical_speeds", "np.argmax(size >=", "np.argmin(size >=")
@kills(
    "solvers.synchronous.response:main_critical_speeds",
    "np.where(push > _FREE**2, np.inf, 0.0), size",
    "0.0, size",
)
@kills("solvers.synchronous.response:main_critical_speeds", "push > _FREE**2", "push >= 0.0 * _FREE**2")
def test_which_critical_speed() -> None:
    """Most motion wins; undamped modes that are driven win over all, the lowest of equal ones."""
    supports = [Support(-0.3, 4e4, 40.0), Support(0.3, 4e4, 40.0)]

    def chosen(
        unbalances: list[PlaneUnbalance], supports: list[Support] = supports
    ) -> tuple[float, np.ndarray]:
        system = TwoPlane(10.0, 0.5, 0.1, tuple(supports), tuple(unbalances)).system()
        speeds = critical_speeds(system)
        fills = [Fill(Chamber(0.05, 0.02, plane=z), known_liquid("water"), 1e-12) for z in (-0.2, 0.2)]
        dry, wet = main_critical_speeds(system, fills, speeds, speeds)
        assert wet == pytest.approx(dry, rel=1e-9)  # each mode is its own partner
        return dry, speeds[0]

    # Symmetric: a static unbalance shifts, a couple tilts; of both the larger amplitude at the chambers.
    shift, every = chosen([PlaneUnbalance(0.0, 1e-3)])
    tilt, _ = chosen([PlaneUnbalance(-0.2, 1e-3), PlaneUnbalance(0.2, 1e-3, math.pi)])
    low = math.sqrt(8e4 / 10.0)
    assert shift == pytest.approx(low, rel=1e-9) and tilt == pytest.approx(
        math.sqrt(8e4 * 0.09 / (0.5 - 0.1)), rel=1e-9
    )
    assert {round(shift, 6), round(tilt, 6)} < set(np.round(every, 6).tolist())
    undamped = [Support(-0.3, 4e4, 0.0), Support(0.3, 4e4, 0.0)]
    assert chosen([PlaneUnbalance(-0.2, 1e-3), PlaneUnbalance(0.2, 1e-3, math.pi)], undamped)[0] == tilt
    assert chosen([PlaneUnbalance(0.2, 1e-3)], undamped)[0] == min(shift, tilt)


@kills("solvers.synchronous.response:_with_liquid", "maximize=True", "maximize=False")
@pytest.mark.parametrize("name", ["front_loader", "tub", "two_plane_rig"])
def test_the_same_mode_with_liquid(name: str) -> None:
    """As the liquid grows from nothing to all of its density the mode is followed without a leap.

    What 40 steps lead to is what is paired in one. A step adds a fortieth of the liquid's full mass, so that
    two steps in a row change a speed alike but for some per cent; a leap to another mode is no such step.
    """
    scene = load_scene(f"examples/{name}.toml")
    rotor = dry_rotor(scene)
    system = rotor.system()
    dry = critical_speeds(system)

    def paired(share: float) -> tuple[float, float]:
        liquids = [replace(fill.liquid, density=share * fill.liquid.density) for fill in scene.fills]
        fills = [replace(fill, liquid=own) for fill, own in zip(scene.fills, liquids, strict=True)]
        return main_critical_speeds(system, fills, dry, wet_critical_speeds(rotor, fills, 0.0))

    found = np.array([paired(float(share)) for share in np.linspace(0.025, 1.0, 40)])
    assert np.ptp(found[:, 0]) == 0.0
    steps = np.diff(np.concatenate([found[:1, 0], found[:, 1]]))
    assert np.all(steps < 0.0)
    assert np.all(np.abs(steps[1:] / steps[:-1] - 1.0) <= 0.1)


@kills("leblanc.studies.explain.study:explain_scene", "fill.added_mass / bare.mass", "fill.mass / bare.mass")
def test_explained_mass() -> None:
    """A full chamber of liquid over the rotor's mass; of a tub, over that of tub and drum."""
    for name, mass, density in (("two_plane_rig", 20.0, 998.2), ("tub", 60.7, 1197.0)):
        layer = explain_scene(load_scene(f"examples/{name}.toml")).layers[0]
        radius, height = (0.095, 0.025) if mass == 20.0 else (0.18, 0.04)
        assert layer is not None
        assert layer.added_mass_ratio == pytest.approx(
            density * math.pi * radius**2 * height / mass, rel=1e-12
        )


@kills(
    "solvers.synchronous.response:Response.amplitude",
    "np.abs(self.parts).sum(axis=1)",
    "np.abs(self.parts.sum(axis=1))",
)
@kills(
    "solvers.synchronous.response:Response.amplitude_dry",
    "np.abs(self.parts_dry).sum(axis=1)",
    "np.abs(self.parts_dry) @ [1.0, 0.5]",
)
def test_amplitude_of_an_ellipse() -> None:
    """The amplitude reported is the largest radius of the path that the axis runs through."""
    scene = load_scene("examples/tub.toml")
    record = run_scene(scene.altered(chambers=()))
    system = dry_rotor(scene).system()
    answer = unbalance_response(system, scene.speed_array())
    phase = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 2001))
    for k in (5, 20, 100, 280):
        first, second = np.real((system.at(0.0) @ answer[k])[:, None] * phase)
        # A maximum missed by half a step of 3e-3 rad.
        assert record.amplitude[k] == pytest.approx(np.hypot(first, second).max(), rel=2e-6)
    np.testing.assert_allclose(record.amplitude, record.amplitude_dry, rtol=1e-12)
    np.testing.assert_allclose(record.amplitude, orbit(system, answer, 0.0).amplitude, rtol=1e-12)


@pytest.mark.parametrize("name", ["two_plane_rig", "tub"])
def test_examples(name: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["run", f"examples/{name}.toml", "--json", "--out", str(tmp_path)]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer.keys() >= KEYS
    speeds = len(answer["speed"])
    assert all(len(answer[key]) == speeds for key in (*KEYS, "backward", "chamber_deflection"))
    record = answered(name)
    motion = record.motion
    assert motion is not None
    forward, backward = (np.array(answer[key]) @ [1.0, 1j] for key in ("deflection", "backward"))
    np.testing.assert_allclose(answer["amplitude"], np.abs(forward) + np.abs(backward), rtol=1e-12)
    np.testing.assert_allclose(answer["phase"], np.angle(forward), rtol=1e-12)
    assert len(answer["natural_frequency"]) == len(motion.modes)
    with xr.open_dataset(tmp_path / "response.nc") as data:
        assert data["campbell_frequency"].shape == motion.campbell.frequency.shape
        np.testing.assert_allclose(data["amplitude"], answer["amplitude"])
        np.testing.assert_allclose(data["natural_frequency"], answer["natural_frequency"])
    for figure in ("amplitude", "liquid", "phase", "chamber", "campbell"):
        assert (tmp_path / f"{figure}.svg").stat().st_size > 10_000
    summary = (tmp_path / "summary.html").read_text(encoding="utf-8")
    assert "Natural frequencies at rest" in summary and "whirl against the spin" in summary
    compared = comparisons(record)[0]
    # Printed with four digits.
    assert float(compared.wet) == pytest.approx(1e3 * record.peak["amplitude"], rel=1e-3)
    listed = dict(facts(record))["Natural frequencies at rest (damping ratios)"]
    assert float(listed.split()[0]) == pytest.approx(motion.modes[0].frequency / (2 * math.pi), rel=1e-2)


@kills("leblanc.studies.run.study:rest_modes", "system.mass @ shape", "shape")
def test_modes_are_named_by_their_kinetic_energy() -> None:
    system = prepare(example("tub")).system
    names = [mode.moves for mode in rest_modes(system, "horizontal")]
    # Undamped modes by another solver have nearly the same shares.
    _, shape = eigh(system.stiffness, system.mass)
    share = 100.0 * shape[:, 0] * (system.mass @ shape[:, 0])
    most = [float(part) for part in re.findall(r"([\d.]+) %", names[0])]
    assert most == pytest.approx(sorted(share.tolist(), reverse=True)[: len(most)], abs=3.0)
    # Stiffer springs below it raise the bounce; the drum of a tub turns about y, z is upwards.
    ups = [k for k, name in enumerate(names) if name.startswith("bounce")]
    assert len(ups) == 1
    stiff = replace(system, stiffness=system.stiffness + np.diag([0.0, 0.0, 5e4, 0.0, 0.0, 0.0]))
    raised = rest_modes(stiff, "horizontal")
    assert (
        raised[-1].moves.startswith("bounce")
        and raised[-1].frequency > 2.0 * rest_modes(system, "horizontal")[ups[0]].frequency
    )
    for name in names:
        shares = [float(part) for part in re.findall(r"([\d.]+) %", name)]
        assert not shares or (shares[0] >= shares[-1] and 60.0 < sum(shares) <= 101.0)
    upright = rest_modes(prepare(example("top_loader")).system, "vertical")
    assert any("bounce" in mode.moves for mode in upright)


def test_explain(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "examples/tub.toml", "--full"]) == 0
    words = capsys.readouterr().out
    assert "natural frequencies at rest" in words and "surge along the drum" in words
    assert main(["explain", "examples/two_plane_rig.toml", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert len(answer["modes"]) == 4 and len(answer["layers"]) == 2


def test_chambers_in_different_planes_are_drawn_apart() -> None:
    record = answered("two_plane_rig")
    assert len(side_by_side(record.chambers)) == 2
    texts = [text.get_text() for axes in chamber_figure(record).axes for text in (axes.title,)]
    assert len(set(texts)) == 2


def test_the_campbell_diagram_marks_every_crossing() -> None:
    record = answered("two_plane_rig")
    assert record.motion is not None
    axes = campbell_figure(record).axes[0]
    marks = [line for line in axes.lines if line.get_marker() not in ("None", None, "")]
    drawn = np.sort(np.concatenate([line.get_xdata() for line in marks]))
    np.testing.assert_allclose(drawn, record.motion.campbell.crossing * 30.0 / math.pi, rtol=1e-12)
    names = {line.get_label() for line in axes.lines}
    assert {"whirl with the spin", "whirl against the spin", "once a turn"} <= names


def test_amplitude_figure_says_where() -> None:
    record = answered("tub")
    assert "115 mm" in amplitude_figure(record).caption.shown


def test_an_empty_tub_and_one_without_dampers(tmp_path: Path) -> None:
    text = Path("examples/tub.toml").read_text(encoding="utf-8")
    dry = text[: text.index("[[chambers]]")] + text[text.index("# From below the lowest") :]
    scene = tmp_path / "scene.toml"
    scene.write_text(dry.replace('"chambers.0", ', ""), encoding="utf-8")
    assert main(["run", str(scene), "--out", str(tmp_path / "out")]) == 0
    free = text[: text.index("# Two dampers")] + text[text.index("[[chambers]]") :]
    free = free.replace('"chambers.0", "rotor.bearings", "cabinet", "points",', '"chambers.0",')
    free = free.replace(
        '  "rotor.dampers.0.position", "rotor.dampers.1.position", "rotor.dampers.2", "rotor.dampers.3",\n',
        "",
    )
    scene.write_text(free, encoding="utf-8")
    assert main(["run", str(scene), "--out", str(tmp_path / "free")]) == 0
