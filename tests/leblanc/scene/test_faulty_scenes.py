"""Every faulty scene is refused in plain words: file, field, value, what is allowed."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest

from leblanc.cli import exit_code, main
from leblanc.scene.scene import load_scene
from leblanc.scene.schema.load import SceneError

# A command that reads a scene; without one, the shell around what all such commands do first.
COMMAND: str | None = "run"

GOOD = """
name = "Rig"
assumed = ["rotor.mass"]

[rotor]
kind = "jeffcott"
mass = "4 kg"
critical_speed = "1000 rpm"
damping_ratio = 0.10
unbalance = "0.6 kg*mm"
axis = "horizontal"

[[chambers]]
radius = "65 mm"
inner_radius = "10 mm"
height = "20 mm"
volume = "10 ml"
liquid = "water"

[speeds]
start = "100 rpm"
stop = "2000 rpm"
count = 20

[model]
liquid = "auto"
friction = "stokes"

[runup]
start = "5 rad/s"
stop = "100 rad/s"
rate = "8 rad/s^2"
duration = "14 s"
"""

CHAMBER = GOOD[GOOD.index("[[chambers]]") : GOOD.index("[speeds]")]
BITS = "0x" + "f" * 5000  # a whole number that Python reads but will not print


@dataclass(frozen=True)
class Case:
    """A good scene with one thing changed.

    right, wrong : what is changed in the text; field : that must be named; said : that the line must hold
    """

    right: str
    wrong: str
    field: str
    said: tuple[str, ...]


def case(right: str, wrong: str, field: str, *said: str) -> Case:
    return Case(right, wrong, field, said)


CASES = (
    # a key is missing
    case('name = "Rig"', "", "name", "must be given", "text"),
    case("[rotor]", "[rotors]", "rotor", "must be given", "a table of kind, mass"),
    case('kind = "jeffcott"', "", "rotor.kind", "must be given", "jeffcott"),
    case('mass = "4 kg"', "", "rotor.mass", "must be given", "a mass"),
    case('critical_speed = "1000 rpm"', "", "rotor.critical_speed", "exactly one", "stiffness"),
    case("damping_ratio = 0.10", "", "rotor.damping_ratio", "exactly one of damping_ratio and damping"),
    case('unbalance = "0.6 kg*mm"', "", "rotor.unbalance", "must be given", "kg*m"),
    case('axis = "horizontal"', "", "rotor.axis", "horizontal, vertical"),
    case('radius = "65 mm"\n', "", "chambers.0.radius", "must be given", "a length"),
    case('height = "20 mm"', "", "chambers.0.height", "must be given", "a length"),
    case('volume = "10 ml"', "", "chambers.0.volume", "must be given", "a volume"),
    case('liquid = "water"', "", "chambers.0.liquid", "must be given", "glycerol", "density"),
    case(GOOD[GOOD.index("[speeds]") : GOOD.index("[model]")], "", "speeds", "start, stop, count"),
    case("count = 20", "", "speeds.count", "must be given", "a whole number from 1 to 100000"),
    case('rate = "8 rad/s^2"', "", "runup.rate", "must be given", "an angular acceleration"),
    # a key is not known
    case('name = "Rig"', 'nam = "Rig"', "nam", '"Rig"', "left out or spelled as one of: name, source"),
    case("mass =", "masse =", "rotor.masse", "spelled as one of: kind, mass"),
    case("count = 20", "count = 20\nstep = 3", "speeds.step", "3", "start, stop, count"),
    case("[model]", "[modell]", "modell", "model"),
    case("[model]", '[model]\n"odd key" = 1', 'model."odd key"', "liquid, friction"),
    case('volume = "10 ml"', 'volume = "10 ml"\nfill = 0.1', "chambers.0.fill", "volume"),
    # a number out of range
    case('"4 kg"', '"-4 kg"', "rotor.mass", '"-4 kg"', "from 0.000 000 001 to 1 000 000 000 kg"),
    case('"4 kg"', "0", "rotor.mass", "= 0", "from 0.000 000 001 to"),
    case('"4 kg"', "nan", "rotor.mass", "= nan", "finite"),
    case('"4 kg"', "-inf", "rotor.mass", "= -inf", "finite"),
    case('"4 kg"', "1e400", "rotor.mass", "= inf", "finite"),
    case('"4 kg"', '"1e400 kg"', "rotor.mass", "1e400 kg", "finite"),
    case('"4 kg"', "1e30", "rotor.mass", "1e+30", "to 1 000 000 000 kg"),
    case('"4 kg"', BITS, "rotor.mass", "20000 bits", "a mass"),
    case("0.10", "-0.1", "rotor.damping_ratio", "-0.1", "from 0 to 1000"),
    case("damping_ratio = 0.10", "damping = -1", "rotor.damping", "= -1", "a damping coefficient"),
    case('"0.6 kg*mm"', '"-0.6 kg*mm"', "rotor.unbalance", "from 0"),
    case('"1000 rpm"', '"0 rpm"', "rotor.critical_speed", "from 0.000 009 549 3 to 9549297 rpm"),
    case('radius = "65 mm"\n', "radius = 0\n", "chambers.0.radius", "= 0", "from 0.000001 to 1000 m"),
    case('"20 mm"', '"-20 mm"', "chambers.0.height", "-20 mm", "a length"),
    case('"10 ml"', '"-10 ml"', "chambers.0.volume", "a volume", "from 0"),
    case('"100 rpm"', "0", "speeds.start", "= 0", "an angular speed"),
    case("count = 20", "count = 0", "speeds.count", "= 0", "from 1 to 100000"),
    case("count = 20", "count = -5", "speeds.count", "= -5", "a whole number"),
    case("count = 20", "count = 1000000000000", "speeds.count", "to 100000"),
    case("count = 20", f"count = {BITS}", "speeds.count", "bits", "a whole number"),
    case('"14 s"', '"0 s"', "runup.duration", "a time"),
    case('"14 s"', '"14 s"\ncells = 4', "runup.cells", "= 4", "from 8 to 65536"),
    case("assumed", "gravity = -9.81\nassumed", "gravity", "= -9.81", ", 0, or from"),
    # values that do not go together
    case('"10 ml"', '"2 l"', "chambers.0.volume", '"2 l"', "at most what the chamber holds, 0.259181 l"),
    case(
        'inner_radius = "10 mm"',
        'inner_radius = "70 mm"',
        "chambers.0.inner_radius",
        "below the radius of the chamber, 65 mm",
    ),
    case('inner_radius = "10 mm"', "inner_radius = 0.065", "chambers.0.inner_radius", "below the radius"),
    case('"2000 rpm"', '"50 rpm"', "speeds.stop", "at least speeds.start, 100 rpm"),
    case("count = 20", "count = 1", "speeds.count", "at least 2"),
    case('"100 rad/s"', '"5 rad/s"', "runup.stop", "above runup.start"),
    case(
        "damping_ratio", "stiffness = 4e4\ndamping_ratio", "rotor.stiffness", "exactly one of critical_speed"
    ),
    case("damping_ratio", "damping = 84\ndamping_ratio", "rotor.damping", "exactly one of damping_ratio"),
    case('["rotor.mass"]', '["rotor.mas"]', "assumed.0", '"rotor.mas"', "stands in this file"),
    case('["rotor.mass"]', '["chambers.1.height"]', "assumed.0", "stands in this file"),
    case('["rotor.mass"]', '["rotor.stiffness"]', "assumed.0", "stands in this file"),
    # bounds stand in the unit that was typed
    case('radius = "65 mm"\n', 'radius = "3e6 mm"\n', "chambers.0.radius", "from 0.001 to 1000000 mm"),
    case('"10 ml"', "0.002", "chambers.0.volume", "at most what the chamber holds, 0.000259181 m^3"),
    case('"10 ml"', "1.2", "chambers.0.volume", 'a plain number is in m^3; litres are typed "1.2 l"'),
    case('"100 rad/s"', '"10 rpm"', "runup.stop", "above runup.start, 47.7465 rpm"),
    case(
        "[model]",
        '[optimise]\ntemperature = ["20 degC", "2000 degC"]\n[model]',
        "optimise.temperature",
        "from -123.15 to 726.85 degC",
    ),
    # a wrong unit
    case('"4 kg"', '"4 mm"', "rotor.mass", "a mass", "mm measures something else"),
    case('"4 kg"', '"4 kgg"', "rotor.mass", "there is no unit kgg"),
    case('"4 kg"', '"4"', "rotor.mass", "no unit", '"4 kg"'),
    case('"1000 rpm"', '"1000 rmp"', "rotor.critical_speed", "there is no unit rmp", "1000 rpm"),
    case('"1000 rpm"', '"100 m/s"', "rotor.critical_speed", "m/s measures something else"),
    case('"10 ml"', '"10 mm"', "chambers.0.volume", "a volume", "mm measures something else"),
    case('"0.6 kg*mm"', '"0.6 kg"', "rotor.unbalance", "an unbalance", "kg measures something else"),
    case('"8 rad/s^2"', '"8 rad/s"', "runup.rate", "an angular acceleration"),
    case('"stokes"', '{ linear = "0.5 Hz" }', "model.friction.linear", "a rate", "0.5 1/s"),
    case('"4 kg"', '"heavy"', "rotor.mass", '"heavy"', "a mass"),
    case('"4 kg"', '"9**9**9 kg"', "rotor.mass", "a mass"),
    # a wrong type
    case('"4 kg"', "true", "rotor.mass", "= true", "a mass"),
    case('"4 kg"', "[4]", "rotor.mass", "[...]", "a mass"),
    case('"4 kg"', "{ value = 4 }", "rotor.mass", "{...}", "a mass"),
    case('"4 kg"', "1979-05-27", "rotor.mass", "1979-05-27", "a mass"),
    case("count = 20", "count = 20.0", "speeds.count", "20.0", "a whole number"),
    case("count = 20", 'count = "20"', "speeds.count", '"20"', "a whole number"),
    case("count = 20", "count = true", "speeds.count", "true", "a whole number"),
    case('"14 s"', '"14 s"\nback = 1', "runup.back", "true or false"),
    case('name = "Rig"', "name = 5", "name", "= 5", "text"),
    case('name = "Rig"', 'name = " "', "name", "not empty"),
    case('name = "Rig"', f'name = "{"x" * 300}"', "name", "xxx...", "200"),
    case('name = "Rig"', 'name = "\\u0007"', "name", "printable"),
    case('["rotor.mass"]', '"rotor.mass"', "assumed", "a list", "field paths"),
    case('["rotor.mass"]', "[3]", "assumed.0", "= 3", "text"),
    case("[[chambers]]", "[chambers]", "chambers", "{...}", "a list of 0 to 1000", "[[chambers]]"),
    case(CHAMBER, CHAMBER * 1001, "chambers", "[...]", "0 to 1000"),
    case(GOOD[GOOD.index("[speeds]") : GOOD.index("[model]")], "[[speeds]]\n", "speeds", "a table of start"),
    # a word that is not known
    case('"jeffcott"', '"top"', "rotor.kind", '"top"', "one of: jeffcott, two_plane, tub, exciter, magnetic"),
    case('"horizontal"', '"diagonal"', "rotor.axis", '"diagonal"', "horizontal, vertical"),
    case('"water"', '"beer"', "chambers.0.liquid", '"beer"', "water, sea_water", "density"),
    case('"water"', "7", "chambers.0.liquid", "= 7", "water"),
    case('"water"', "{ density = -998, viscosity = 1e-6 }", "chambers.0.liquid.density", "-998", "a density"),
    case('"water"', "{ density = 998, viscosity = nan }", "chambers.0.liquid.viscosity", "nan", "finite"),
    case(
        '"water"',
        "{ density = 998 }",
        "chambers.0.liquid.viscosity",
        "must be given",
        "a kinematic viscosity",
    ),
    case(
        '"water"', '{ density = 998, viscosity = "1 mPa*s" }', "chambers.0.liquid.viscosity", "mPa*s measures"
    ),
    case(
        '"water"',
        "{ density = 998, viscosity = 0, colour = 1 }",
        "chambers.0.liquid.colour",
        "density, viscosity",
    ),
    case(
        '"auto"', '"best"', "model.liquid", '"best"', "auto, statics, linear, long_wave, potential, kdv, fem"
    ),
    case('"stokes"', '"sticky"', "model.friction", '"sticky"', "none, stokes", "linear"),
    case('"stokes"', "0.5", "model.friction", "= 0.5", "none, stokes"),
    case('"stokes"', "{}", "model.friction", "{}", "quadratic"),
    case('"stokes"', "{ linear = 1, quadratic = 1 }", "model.friction", "{...}", "one of"),
    case('"stokes"', "{ linear = -1 }", "model.friction.linear", "= -1", "a rate"),
    case('"stokes"', "{ quadratic = true }", "model.friction.quadratic", "true", "a pure number"),
    case('"stokes"', "{ cubic = 1 }", "model.friction.cubic", "linear, quadratic"),
    case('"stokes"', '{ wall = { roughness = "-1 um" } }', "model.friction.wall.roughness", "a length"),
    case('"stokes"', "{ wall = 1 }", "model.friction.wall", "= 1", "table"),
)


def check(text: str, path: Path, field: str, said: tuple[str, ...]) -> None:
    """The one line of a fault says all that a user needs, in words that need no programmer."""
    lines = text.strip().split("\n")
    begin = re.compile(rf"{re.escape(str(path))}(:\d+)?: ")
    about = [line for line in lines if re.match(rf"{begin.pattern}{re.escape(field)}( = |: )", line)]
    assert len(about) == 1, text
    assert all(words in about[0] for words in said), about[0]
    assert all(begin.match(line) and " must be " in line for line in lines), text
    for jargon in ("Traceback", "pydantic", "pint", "http", "Input should", "float", "dict", "NoneType"):
        assert jargon not in text


@pytest.mark.parametrize("case", CASES, ids=lambda it: f"{it.field}-{it.wrong.strip()[:30]}")
def test_a_wrong_value_is_named(case: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "scene.toml"
    assert GOOD.count(case.right) >= 1
    path.write_text(GOOD.replace(case.right, case.wrong, 1), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    check(str(caught.value), path, case.field, case.said)
    assert case.field in [fault.field for fault in caught.value.faults]
    assert shell(path, capsys) == str(caught.value) + "\n"


def shell(path: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """What the command line says on stderr; it prints nothing else and exits with 2."""
    code = exit_code(lambda: load_scene(path)) if COMMAND is None else main([COMMAND, str(path)])
    printed = capsys.readouterr()
    assert code == 2
    assert printed.out == ""
    return printed.err
