"""All that a scene says stands in its report, in the units that it names, assumed values marked."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from leblanc.core.page import About
from leblanc.scene.chambers import Chamber, DensityLaw, ViscosityLaw
from leblanc.scene.inputs import about, optimise_rows
from leblanc.scene.rows import row
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.paths import tables_of
from leblanc.scene.tasks import Optimisation
from meshes.chamber_section import chamber_section
from meshes.section import Section
from tests.oracles.pages import printed

CHAMBER = {
    "radius": "65 mm", "inner_radius": "5 mm", "height": "20 mm", "plane": "3 mm", "volume": "10 ml",
    "liquid": {"density": 900.0, "viscosity": "2 mm^2/s"},
    "baffles": {"count": 6, "tip_radius": "40 mm", "wall_gap": "2 mm", "first_angle": "30 deg", "loss": 2.5},
}  # fmt: skip
REST = {
    "name": "full", "source": "nowhere", "gravity": 3.7, "chambers": [CHAMBER],
    "speeds": {"start": "60 rpm", "stop": "1200 rpm", "count": 20},
    "model": {"liquid": "linear", "friction": {"linear": "0.5 1/s"}, "tolerance": 0.02, "held": "auto",
        "cells": 64,
    },
    "runup": {
        "start": "30 rpm", "stop": "900 rpm", "rate": "2 rad/s^2", "duration": "9 s", "cells": 32,
        "back": True, "dispersion": True, "bore": "enstrophy", "samples": 77,
        "capture": "drum",
    },
    "optimise": {
        "layout": {
            "measure": "separation", "reach": [0.01, 0.02, 0.03], "turn": "14 deg",
            "band": ["310 rpm", "420 rpm"], "sag": "71 mm",
        },
        "balls": {
            "count": [2, 7], "mass": ["3 g", "31 g"], "drag": ["0.01 N*s/m", "2.3 N*s/m"],
            "radius": ["61 mm", "83 mm"],
        },
        "objective": "robust", "working_speed": "600 rpm", "steady": True,
        "duty": [{"speed": "300 rpm", "weight": 2}], "vibration_limit": "1.5 mm", "limit_at": "operating",
        "deflection": "0.7 mm", "unbalance": ["1 kg*mm", "2 kg*mm"], "temperature": ["5 degC", "35 degC"],
        "quantile": 0.9, "samples": 12, "seed": 4, "dry_patch": False, "stability_margin": "0.25 1/s",
        "whirl_limit": "3 mm",
        "stable": False, "least_film": "20 um", "spill": True,
        "operating": ["500 rpm", "800 rpm"], "clearance": "4 mm", "volumes": [["1 ml", "20 ml"]],
        "balance_quality": "G 6.3", "floor_force": "700 N", "walking_margin": 0.3, "point_clearance": "2 mm",
        "slip_margin": 0.4, "motor_torque": "7 N*m", "loads_over": "both",
    },
}  # fmt: skip
PROGRAMME = {
    "start": "20 rpm",
    "steps": ["to 900 rpm in 7 s", "hold 3 s", "coast to 100 rpm"],
    "inertia": "0.6 kg*m^2",
    "drag_torque": "1.7 N*m",
    "drag_rate": "0.03 1/s",
    "coast_limit": "80 s",
    "cells": 48,
    "dispersion": True,
    "bore": "enstrophy",
    "capture": "drum",
    "samples": 123,
    "motor": {"speeds": [0.0, "1300 rpm"], "torques": ["7 N*m", "1 N*m"]},
}  # fmt: skip
SHEDS = {"share": 0.35, "time_constant": "13 s", "above": "340 rpm", "mass": "0.45 kg"}
AROUND = {
    "cabinet": {
        "mass": "9 kg", "centre_of_mass": [0, 0.01, 0], "friction": 0.4,
        "feet": [[-0.3, 0.1, 0.2], [-0.3, -0.1, 0.2], [-0.3, 0, -0.2]],
    },
    "points": [{"name": "a", "on": "drum", "position": [0.1, 0, 0], "gap": "7 mm", "direction": [1, 0, 0]}],
}  # fmt: skip
MOTOR = {"inertia": "0.3 kg*m^2", "speeds": [0.0, "1200 rpm"], "torques": ["2 N*m", 0.0]}
ROTORS: dict[str, dict[str, Any]] = {
    "jeffcott": {
        "kind": "jeffcott", "mass": "4 kg", "critical_speed": "1000 rpm", "damping_ratio": 0.1,
        "unbalance": "0.6 kg*mm", "axis": "vertical", "sheds": SHEDS,
    },
    "two_plane": {
        "kind": "two_plane", "mass": "20 kg", "transverse_inertia": 0.7, "polar_inertia": 0.2,
        "supports": [
            {
                "position": "-30 cm", "stiffness": 4e4, "damping": 80, "ball_diameter": "8 mm",
                "pitch_diameter": "40 mm", "contact_angle": "15 deg",
            },
        ],
        "unbalances": [{"position": "10 cm", "size": "1.5 kg*mm", "angle": "120 deg", "sheds": SHEDS}],
        "axis": "vertical", "pivot": "-45 mm",
    },
    "tub": {
        "kind": "tub", "tub_mass": 48, "drum_mass": 12.5, "tub_inertia": [1.3, 1.5, 1.4],
        "drum_polar_inertia": 0.32, "drum_transverse_inertia": 0.2, "drum_position": [0, "90 mm", 0],
        "unbalance": "185 kg*mm", "unbalance_position": "80 mm", "sheds": SHEDS,
        "loads": [{"position": "-40 mm", "size": "70 kg*mm", "angle": "20 deg", "sheds": SHEDS}],
        "springs": [
            {"position": ["200 mm", 0, "200 mm"], "direction": [0.26, 0, 0.97], "stiffness": 4800},
            {"position": [0, 0.1, 0], "stiffness": [1200, 1300, 1400]},
        ],
        "dampers": [{"position": [0.1, 0, -0.2], "direction": [0.3, 0, -0.9], "damping": 155}],
        "bearings": [
            {"position": "-60 mm"},
            {
                "position": -0.15, "ball_diameter": "7 mm", "pitch_diameter": "31 mm",
                "contact_angle": "12 deg", "dynamic_rating": "9.56 kN", "wear_coefficient": 2e-17,
            },
        ],
        "axis": "horizontal",
    },
    "exciter": {
        "kind": "exciter", "platform_mass": 90.1, "stiffness": 1.4e5, "damping": 150, "unbalance": "10 kg*mm",
        "balls": {"count": 2, "mass": "325 g", "kind": "ball", "track_radius": "90 mm", "damping": 0.03},
    },
    "magnetic": {
        "kind": "magnetic", "mass": "12 g", "transverse_inertia": 7e-7, "polar_inertia": 3e-7,
        "eccentricity": "0.4 um", "inertia_tilt": 2e-5, "axis": "horizontal",
        "magnets": {
            "gap": "0.2 mm", "force_constant": 2e-5, "bias_current": "30 mA", "most_current": "20 mA",
            "bandwidth": "2 kHz", "first": "-8 mm", "second": "9 mm",
        },
        "motor": {"stiffness": 6000, "length": "14 mm"},
        "drag": {"coefficient": 0.9, "viscosity": "0.05 Pa*s", "radius": "7 mm", "length": "22 mm"},
        "synergetic": {
            "manifold_time": "50 ms", "goal_time": "40 ms", "weight": 8e-3, "rate": 6e7, "tilt_rate": 4e8,
        },
        "pid": {"proportional": 1.5e5, "integral": 7e6, "derivative": 41, "cutoff": "8 kHz"},
        "loads": [{"force": [1.2, 0], "moment": [0, 1e-5], "frequency": "50 Hz", "start": "0.4 s"}],
        "trial": {
            "duration": "1.5 s", "speed": "9000 rpm", "pulsation": "700 rpm", "pulsation_frequency": "1 Hz",
            "offset": ["0.1 mm", 0], "samples": 300,
        },
    },
}  # fmt: skip
BARE = ("exciter", "magnetic")  # neither a cabinet nor points
# One of two keys: the report shows both ways of saying the same.
OTHER_WAY = {
    "speeds.values": "speeds.start",
    "rotor.stiffness": "rotor.critical_speed",
    "rotor.damping": "rotor.damping_ratio",
    "rotor.balls.pendulum_inertia": "rotor.balls.kind",
    "optimise.balls.diameter": "optimise.balls.mass",
    "runup.ramp_time": "runup.rate",
    "chambers.*.baffles.height": "chambers.*.baffles.tip_radius",
}
LAWS = {"density": DensityLaw, "viscosity": ViscosityLaw}
# Checked in a test of their own.
OTHERS = {
    "assumed", "model.friction.quadratic", "model.friction.wall.roughness",
    "chambers.*.kind", "chambers.*.section", "chambers.*.section_unit", "chambers.*.section_size",
    *(f"chambers.*.liquid.{key}" for key in ("temperature", "salt", "mass_fraction", "name")),
    *(f"chambers.*.liquid.{part}.{key}" for part, law in LAWS.items() for key in law.model_fields),
}  # fmt: skip
# What stands above the inputs, is their mark, or is reported by the cell of another path.
ELSEWHERE = {"name", "source", "assumed"}
TOLD_BY = {
    "rotor.kind": "rotor.axis",
    "runup.motor.speeds": "runup.motor.torques",
    "programme.motor.speeds": "programme.motor.torques",
    "programme.steps": "programme.steps.2",
}
WAYS = ["ramp", "motor", "programme"]


def full(kind: str, way: str = "ramp") -> dict[str, Any]:
    """A scene with every key that such a file may have, driven in one of the ways."""
    table = copy.deepcopy(REST | ({} if kind in BARE else AROUND) | {"rotor": ROTORS[kind]})
    if way == "programme":
        del table["runup"]
        table["programme"] = copy.deepcopy(PROGRAMME)
    if way == "motor":
        del table["runup"]["rate"], table["runup"]["back"]
        table["runup"]["motor"] = MOTOR
    return table


def leaves(value: Any, path: str = "") -> Iterator[str]:
    """Paths of all values."""
    if isinstance(value, dict):
        for key, entry in value.items():
            yield from leaves(entry, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for k, entry in enumerate(value):
            yield from leaves(entry, f"{path}.{k}")
    else:
        yield path


def shown(what: About) -> set[str]:
    return {value.path for value in what.values if value.path}


def covered(path: str, paths: set[str]) -> bool:
    """The path itself or a table that holds it has a cell."""
    path = path if path in paths else TOLD_BY.get(path, path)
    return any(path == one or path.startswith(f"{one}.") for one in paths)


@pytest.mark.parametrize("kind", list(ROTORS))
@pytest.mark.parametrize("way", WAYS)
def test_every_value_has_its_cell(kind: str, way: str) -> None:
    table = full(kind, way)
    paths = shown(about(scene_from_table(table)))
    lost = [path for path in leaves(table) if path not in ELSEWHERE and not covered(path, paths)]
    assert not lost


@pytest.mark.parametrize("kind", list(ROTORS))
def test_the_full_scene_has_every_key_there_is(kind: str) -> None:
    """So that a key that comes new is not forgotten in the report."""
    given = {leaf for way in WAYS for leaf in leaves(full(kind, way))}
    pattern = {".".join("*" if part.isdecimal() else part for part in path.split(".")) for path in given}
    for place, model in tables_of(Scene, kind).items():
        if "*balls" in place:
            continue  # tests/leblanc/scene/test_races.py
        if "friction" in place or place[-2:] == ("optimise", "duty"):
            continue
        if kind in BARE and place[:1] in (("cabinet",), ("points",)):
            continue
        for key in model.model_fields:
            path = ".".join((*place, key))
            known = any(one == path or one.startswith(f"{path}.") for one in pattern)
            other = OTHER_WAY.get(path, "")
            left_out = kind in BARE and path in AROUND
            assert known or other in pattern or path in OTHERS or left_out, path


@pytest.mark.parametrize("kind", list(ROTORS))
@pytest.mark.parametrize("way", ["ramp", "programme"])
def test_each_assumed_value_marks_its_cell_and_no_other(kind: str, way: str) -> None:
    table = full(kind, way)
    bare = about(scene_from_table(table))
    assert not bare.assumed
    derived = {
        "rotor.critical_speed": {"rotor.stiffness"},
        "rotor.damping_ratio": {"rotor.damping"},
        "rotor.kind": {"rotor.axis"},
        "runup.motor.speeds": {"runup.motor.torques"},
        "programme.motor.speeds": {"programme.motor.torques"},
        "programme.steps": {f"programme.steps.{k}" for k in range(3)},
    }
    for path in leaves(table):
        if path in ELSEWHERE:
            continue
        scene = scene_from_table(table | {"assumed": [path]})
        marked = {cell.path for cell in about(scene).values if cell.assumed}
        own = {one for one in shown(bare) if path == one or path.startswith(f"{one}.")}
        assert marked == own | (derived.get(path, set()) & shown(bare)), path


def test_an_assumed_table_marks_all_that_is_in_it() -> None:
    scene = scene_from_table(full("two_plane") | {"assumed": ["runup", "rotor.supports.0", "chambers"]})
    for cell in about(scene).values:
        inside = cell.path.startswith(("runup.", "rotor.supports.0.", "chambers."))
        assert cell.assumed == inside, cell


def test_a_section_of_its_own_is_named_and_measured() -> None:
    """A square of 8 cm, its corners 4 cm from the axis each way."""
    points = np.array([[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]]) * 1e-2
    mesh = Section(points, np.array([[0, 1, 2], [0, 2, 3]]))
    scene = scene_from_table(full("jeffcott") | {"assumed": ["chambers.0.height"]})
    shape = chamber_section("square <1>.msh", mesh)
    round_one = scene.chambers[0]
    chambers = (Chamber(section=shape, height=0.02, liquid=round_one.liquid, volume=round_one.volume),)
    for name, marked in (("section", 2), ("section_unit", 2), ("section_size", 1), ("height", 0)):
        path = f"chambers.0.{name}"
        inputs = about(scene.altered(chambers=chambers, assumed=(path,)))
        (row,) = [row for one in inputs.tables if "section" in one.head for row in one.rows]
        far = printed(math.sqrt(32.0) * 10.0)
        assert [cell.text for cell in row] == ["1", "square <1>.msh", "64", far, "as in the file"]
        assert sum(cell.assumed for cell in row) >= marked and inputs.assumed


@pytest.mark.parametrize(
    ("liquid", "said"),
    [
        (
            {"salt": "sodium_chloride", "mass_fraction": 0.2},
            "20 % sodium chloride brine, 1148 kg/m³, 1.36 mm²/s",
        ),
        (
            {
                "name": "oil",
                "temperature": "40 degC",
                "density": {"value": 870, "temperature": "15 degC", "expansion": 7e-4, "range": [280, 350]},
                "viscosity": {
                    "law": "walther",
                    "temperatures": ["40 degC", "100 degC"],
                    "values": ["46 mm^2/s", "6.8 mm^2/s"],
                    "range": [270, 350],
                },
            },
            "oil, 855 kg/m³, 46 mm²/s at 40 degC; density 870 kg/m³ at 15 degC, expansion 0.0007 1/K; "
            "viscosity 46 mm²/s at 40 degC and 6.8 mm²/s at 100 degC by Walther; "
            "from 6.85 degC to 76.85 degC",
        ),
        (
            {
                "density": {"temperatures": [280, 300, 320], "values": [1000, 998, 990]},
                "viscosity": {"law": "vogel", "a": "0.05 mm^2/s", "b": 900, "c": 150, "range": [270, 370]},
            },
            "liquid, 999 kg/m³, 26.88 mm²/s at 20 degC; density from a table of 3; viscosity a = 0.05 mm²/s, "
            "b = 900 K, c = 150 K by Vogel; from 6.85 degC to 46.85 degC",
        ),
    ],
)
def test_a_law_of_temperature_is_told(liquid: dict[str, Any], said: str) -> None:
    table = full("jeffcott")
    table["chambers"][0]["liquid"] = liquid
    found = told(about(scene_from_table(table)))["chambers.0.liquid"]
    assert found == said


def told(what: About) -> dict[str, str]:
    return {value.path: value.text for value in what.values if value.path}


def number(text: str) -> float:
    return float(text.split()[0].strip("(,").replace("\N{MINUS SIGN}", "-"))


def test_units() -> None:
    """Every text gives the value of the file back in the unit that stands beside it."""
    found = told(about(scene_from_table(full("jeffcott"))))
    stiffness = 4.0 * (1000.0 * 2.0 * math.pi / 60.0) ** 2
    expected = {
        "rotor.mass": 4.0, "rotor.critical_speed": 1000.0, "rotor.stiffness": stiffness,
        "rotor.damping_ratio": 0.1, "rotor.damping": 0.2 * math.sqrt(4.0 * stiffness),
        "rotor.unbalance": 600.0, "gravity": 3.7, "chambers.0.radius": 65.0, "chambers.0.inner_radius": 5.0,
        "chambers.0.height": 20.0, "chambers.0.plane": 3.0, "chambers.0.volume": 10.0,
        "chambers.0.baffles.count": 6.0, "chambers.0.baffles.tip_radius": 40.0,
        "chambers.0.baffles.wall_gap": 2.0, "chambers.0.baffles.first_angle": 30.0,
        "chambers.0.baffles.loss": 2.5,
        "speeds.start": 60.0, "model.tolerance": 2.0, "model.cells": 64.0,
        "runup.start": 30.0, "runup.stop": 900.0,
        "runup.rate": 2.0, "runup.duration": 9.0, "runup.cells": 32.0, "runup.samples": 77.0,
        "optimise.working_speed": 600.0, "optimise.vibration_limit": 1.5, "optimise.deflection": 0.7,
        "optimise.unbalance": 1.0, "optimise.temperature": 5.0, "optimise.quantile": 0.9,
        "optimise.least_film": 20.0,
        "optimise.operating": 500.0, "optimise.clearance": 4.0, "optimise.duty": 300.0,
    }  # fmt: skip
    for path, value in expected.items():
        # Four digits are printed.
        assert math.isclose(number(found[path]), value, rel_tol=6e-4), (path, found[path])
    assert found["optimise.unbalance"].endswith(" kg mm")
    assert found["optimise.temperature"].endswith(" degC")
    assert found["speeds.stop"] == "to 1200 rpm" and found["speeds.count"] == "at 20 speeds"
    assert found["model.friction"] == "linear, 0.5 1/s"
    assert found["chambers.0.liquid"] == "liquid, 900 kg/m³, 2 mm²/s"
    assert found["optimise.volumes"] == "chamber 1 1 to 20 ml"
    assert found["optimise.stability_margin"] == "at least 0.25 1/s"
    assert found["optimise.whirl_limit"] == "3 mm"


def test_units_of_other_rotors() -> None:
    planes = told(about(scene_from_table(full("two_plane", "motor"))))
    for path, value in {
        "rotor.transverse_inertia": 0.7, "rotor.polar_inertia": 0.2, "rotor.supports.0.position": -300.0,
        "rotor.supports.0.stiffness": 4e4, "rotor.supports.0.damping": 80.0,
        "rotor.unbalances.0.position": 100.0, "rotor.unbalances.0.size": 1.5,
        "rotor.unbalances.0.angle": 120.0, "runup.motor.inertia": 0.3,
    }.items():  # fmt: skip
        assert math.isclose(number(planes[path]), value, rel_tol=6e-4), path
    assert planes["runup.motor.torques"] == "2 N m at 0 rpm, 0 N m at 1200 rpm"
    tub = told(about(scene_from_table(full("tub"))))
    assert tub["rotor.springs.0.position"] == "(200, 0, 200)"
    assert tub["rotor.springs.1.stiffness"] == "(1200, 1300, 1400)"
    assert tub["rotor.dampers.0.damping"] == "155"
    assert tub["rotor.drum_position"] == "(0, 90, 0) mm" and tub["rotor.unbalance_position"] == "80 mm"
    assert tub["rotor.unbalance"] == "185 kg mm"
    table = told(about(scene_from_table(full("exciter"))))
    for path, value in {
        "rotor.platform_mass": 90.1, "rotor.stiffness": 1.4e5, "rotor.damping": 150.0,
        "rotor.unbalance": 10.0, "rotor.balls.count": 2.0, "rotor.balls.mass": 325.0,
        "rotor.balls.track_radius": 90.0, "rotor.balls.damping": 0.03,
    }.items():  # fmt: skip
        assert math.isclose(number(table[path]), value, rel_tol=6e-4), path


def test_units_of_magnetic_bearings() -> None:
    table = told(about(scene_from_table(full("magnetic"))))
    for path, value in {
        "rotor.mass": 12.0, "rotor.eccentricity": 0.4, "rotor.magnets.gap": 0.2,
        "rotor.magnets.bias_current": 30.0, "rotor.magnets.bandwidth": 2000.0, "rotor.magnets.first": -8.0,
        "rotor.drag.viscosity": 0.05, "rotor.synergetic.goal_time": 40.0, "rotor.pid.derivative": 41.0,
        "rotor.pid.cutoff": 8000.0, "rotor.trial.speed": 9000.0, "rotor.trial.pulsation_frequency": 1.0,
    }.items():  # fmt: skip
        assert math.isclose(number(table[path]), value, rel_tol=6e-4), path
    assert table["rotor.loads.0.force"] == "(1.2, 0)" and table["rotor.loads.0.frequency"] == "50 Hz"


def test_values_that_the_report_does_not_need_stand_apart() -> None:
    inputs = about(scene_from_table(full("jeffcott")), unused=("runup", "optimise"))
    assert {row.values[0].path.partition(".")[0] for row in inputs.unused} == {"runup", "optimise"}
    assert not any(row.values[0].path.startswith(("runup", "optimise")) for row in inputs.rows)


def test_an_aim_from_the_command_line_is_not_marked_as_the_scene_s() -> None:
    table = full("jeffcott")
    table["assumed"] = ["optimise.deflection", "optimise.clearance"]
    scene = scene_from_table(table)
    assert scene.optimise is not None
    other = scene.optimise.altered(deflection=2e-3)
    marked = {cell.path: cell for cell in about(scene, task=other).values if "optimise" in cell.path}
    assert marked["optimise.deflection"].text == "2 mm" and not marked["optimise.deflection"].assumed
    assert marked["optimise.clearance"].assumed


def test_an_aim_says_what_is_not_its_default() -> None:
    assert optimise_rows(Optimisation()) == [row("Objective", "working_speed", "optimise.objective")]
    duty = [{"speed": float(k), "weight": 1.0} for k in range(1, 9)]
    (text,) = [
        one.values[0].text for one in optimise_rows(Optimisation(duty=duty)) if one.path == "optimise.duty"
    ]
    assert "8 speeds from" in text
