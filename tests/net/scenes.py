"""The input files of the net: shipped scenes, smaller copies of them, and wrong ones."""

from __future__ import annotations

import re
import runpy
import shutil
from pathlib import Path

from tests.net.call import ROOT

# Smaller copies of shipped scenes and studies: source and changed fields.
SMALL: dict[str, tuple[str, dict[str, str]]] = {
    "horizontal_rig": ("examples/horizontal_rig.toml", {"speeds.count": "15"}),
    "centrifuge": ("examples/centrifuge.toml", {"speeds.count": "15"}),
    # Every fourth of their speeds: what is kept of all of them is large.
    "tub": ("examples/tub.toml", {"speeds.count": "71"}),
    "vertical_rig": ("examples/vertical_rig.toml", {"speeds.count": "173"}),
    "horizontal_rig_exact": (
        "examples/horizontal_rig.toml",
        {
            "speeds.start": '"1600 rpm"',
            "speeds.stop": '"1600 rpm"',
            "speeds.count": "1",
            "model.liquid": '"potential"\ncells = 32',
        },
    ),
    "runup": (
        "examples/runup.toml",
        {"speeds.count": "9", "runup.duration": '"2 s"', "runup.cells": "32"},
    ),
    "fill_grid": ("examples/studies/fill_grid.toml", {}),
    "uncertain_rig": ("examples/studies/uncertain_rig.toml", {"samples": "24"}),
    "uncertain_runup": ("examples/studies/uncertain_runup.toml", {"samples": "6"}),
    "balls": ("examples/balls.toml", {"speeds.count": "15"}),
    "balls_grid": ("examples/studies/balls_grid.toml", {}),
    "centrifuge_shares": ("examples/studies/centrifuge_shares.toml", {"samples": "4"}),
    # Run-ups in pieces: with gravity stronger than the spin, and with the liquid caught. The moment between
    # them, and bores later on, turn rounding into per cents.
    "horizontal_rig_fallen": (
        "examples/horizontal_rig.toml",
        {"runup.duration": '"0.1 s"', "runup.back": "false"},
    ),
    "horizontal_rig_caught": (
        "examples/horizontal_rig.toml",
        {"runup.start": '"800 rpm"', "runup.duration": '"1 s"', "runup.back": "false"},
    ),
    "tub_fallen": ("examples/tub.toml", {"runup.duration": '"1 s"'}),
    "tub_caught": ("examples/tub.toml", {"runup.start": '"120 rpm"', "runup.duration": '"3 s"'}),
    "washing_machine_fallen": ("examples/washing_machine.toml", {"runup.duration": '"0.5 s"'}),
    "washing_machine_caught": (
        "examples/washing_machine.toml",
        {"runup.start": '"150 rpm"', "runup.duration": '"1.5 s"'},
    ),
    "weak_motor_caught": ("examples/weak_motor.toml", {"runup.duration": '"6 s"'}),
    "weak_motor_above": (
        "examples/weak_motor.toml",
        {"runup.start": '"40 rad/s"', "runup.duration": '"3 s"'},
    ),
}

# A race on the tub's drum, and a linear layer beside balls: tables may stand in any order.
_RACE = '''15

[[chambers]]
kind = "balls"
radius = "168 mm"
count = 3
mass = "60 g"
drag = "2 N*s/m"
plane = "115 mm"'''
SMALL |= {
    "tub_balls": ("examples/tub.toml", {"speeds.count": _RACE, "runup.duration": '"2 s"'}),
    "linear_balls": (
        "examples/balls_and_liquid.toml",
        {"speeds.count": '9\n\n[model]\nliquid = "linear"', "runup.duration": '"4 s"'},
    ),
}

_SMALLEST = "docs/examples/smallest_scene.toml"
_RIG = "examples/horizontal_rig.toml"

# Wrong scenes: a shipped file, a text in it and what stands in its place.
WRONG: dict[str, tuple[str, str, str]] = {
    "unknown_key": (_SMALLEST, "mass =", "weight ="),
    "unknown_table": (_SMALLEST, "[speeds]", "[speed]"),
    "wrong_unit": (_SMALLEST, '"4 kg"', '"4 s"'),
    "no_unit_known": (_SMALLEST, '"4 kg"', '"4 quux"'),
    "negative_height": (_RIG, 'height = "20 mm"', 'height = "-20 mm"'),
    "not_a_number": (_SMALLEST, "0.1", "nan"),
    "two_stiffnesses": (_SMALLEST, "damping_ratio", 'stiffness = "4e4 N/m"\ndamping_ratio'),
    "no_chambers_list": (_SMALLEST, "[[chambers]]", "[chambers]"),
    "overfull": (_SMALLEST, '"10 ml"', '"10 l"'),
    "unknown_liquid": (_SMALLEST, '"water"', '"beer"'),
    "unknown_kind": (_SMALLEST, '"jeffcott"', '"laval"'),
    "unknown_axis": (_SMALLEST, '"vertical"', '"oblique"'),
    "one_speed_too_few": (_SMALLEST, "count = 61", "count = 0"),
    "speeds_backwards": (_SMALLEST, '"500 rpm"', '"5000 rpm"'),
    "unknown_model": (_RIG, 'liquid = "auto"', 'liquid = "best"'),
    "unknown_friction": (_RIG, 'friction = "wall"', 'friction = "sticky"'),
    "assumed_nowhere": (_RIG, '"rotor.mass", "rotor.critical', '"rotor.masses", "rotor.critical'),
    "no_supports": ("examples/two_plane_rig.toml", "[[rotor.supports]]", "[[rotor.bearings]]"),
    "baffles_beyond_wall": ("docs/examples/closed_baffles.toml", "count = 6", 'count = 6, wall_gap = "1 m"'),
    "no_section_file": ("docs/examples/lobes.toml", "lobes.msh", "nowhere.msh"),
    "motor_and_rate": ("examples/runup.toml", "[runup]", '[runup.motor]\ninertia = "1 kg*m^2"\n\n[runup]'),
    "wrong_balls": ("examples/vibratory_table.toml", "count = 2", "count = 0"),
    "not_toml": (_SMALLEST, "[rotor]", "[rotor"),
    "unknown_path": ("examples/studies/uncertain_rig.toml", '"rotor.mass"', '"rotor.masses"'),
    "unknown_method": ("examples/studies/uncertain_rig.toml", '"latin_hypercube"', '"dice"'),
    "unknown_spread": ("examples/studies/uncertain_rig.toml", "uniform", "uneven"),
    "no_samples": ("examples/studies/uncertain_rig.toml", "samples = 1024", ""),
}


def write_inputs(folder: Path, shaken: bool = False) -> None:
    """Write all input files.

    Parameters
    ----------
    folder : empty; gets examples/, docs/examples/, small/ and wrong/
    shaken : masses, stiffnesses, volumes and their like changed by rounding
    """
    for name in ("examples", "docs/examples"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__", "*.msh"))
    lobes = runpy.run_path(str(folder / "docs/examples/lobes.py"), run_name="lobes")
    lobes["write_section"](lobes["lobes"](), folder / "docs/examples/lobes.msh")
    for kind in ("small", "wrong"):
        (folder / kind).mkdir()
    for name, (source, old, new) in WRONG.items():
        text = (folder / source).read_text(encoding="utf-8")
        if old not in text:
            raise ValueError(f"{source} has no {old!r}, which the wrong input {name} replaces")
        _put(folder / "wrong" / f"{name}.toml", text.replace(old, new))
    _put(folder / "wrong" / "empty.toml", "")
    (folder / "wrong" / "not_text.toml").write_bytes(b'name = "\xff\xfe"\n')
    for name, (source, changes) in SMALL.items():
        text = (folder / source).read_text(encoding="utf-8")
        _put(folder / "small" / f"{name}.toml", changed(text, changes))
    if shaken:
        for path in (*folder.glob("**/examples/**/*.toml"), *folder.glob("small/*.toml")):
            path.write_text(shake(path.read_text("utf-8")), "utf-8")


def _put(path: Path, text: str) -> None:
    """Write a scene; what it names beside itself is looked for among the examples."""
    path.write_text(text.replace('"../', '"../small/').replace('"lobes', '"../docs/examples/lobes'), "utf-8")


_SHAKEN = "mass|unbalance|size|volume|stiffness|critical_speed|damping|tub_mass|drum_mass|platform_mass"
ROUNDING = 1e-15  # five units of the last digit


def shake(text: str) -> str:
    """The text of a scene with its dynamic quantities changed by rounding."""
    return re.sub(rf'^((?:{_SHAKEN}) *= *")([-\d.e]+)', _rounded, text, flags=re.MULTILINE)


def shake_options(argv: tuple[str, ...]) -> tuple[str, ...]:
    """What is typed with volumes and amplitudes changed by rounding."""
    options = r"(--(?:volume|whirl-amplitude|eccentricity) )([\d.]+(?:e-?\d+)?)(?![\w.-])"
    return tuple(re.sub(options, _rounded, " ".join(argv)).split(" "))


def _rounded(found: re.Match[str]) -> str:
    return f"{found[1]}{float(found[2]) * (1.0 + ROUNDING)!r}"


def changed(text: str, changes: dict[str, str]) -> str:
    """The text of a TOML file with other values.

    Parameters
    ----------
    text : of the file
    changes : values as TOML by the path of their key, such as {"speeds.count": "21"}

    Raises
    ------
    ValueError : the file has no such key
    """
    table, lines, done = "", [], set()
    for line in text.splitlines():
        header = re.match(r"\[+([^\]]+)\]", line)
        table = header[1] + "." if header else table
        key = re.match(r"([\w.]+) *=", line)
        path = table + key[1] if key else ""
        if path in changes:
            line = f"{path.removeprefix(table)} = {changes[path]}"
            done.add(path)
        lines.append(line)
    if lost := changes.keys() - done:
        raise ValueError(f"no {', '.join(sorted(lost))} in the file")
    return "\n".join(lines) + "\n"
