"""Faulty scenes of the other kinds of rotor, and of motors, are refused in the same plain words."""

from __future__ import annotations

from pathlib import Path

import pytest

from leblanc.scene.scene import load_scene
from leblanc.scene.schema.load import SceneError
from tests.leblanc.scene.test_faulty_scenes import Case, case, check, shell
from tests.leblanc.scene.test_rotors import EXCITER, HEAD, MAGNETIC, MOTOR, TUB, TWO_PLANE

SUPPORTS = TWO_PLANE[TWO_PLANE.index("[[rotor.supports]]") : TWO_PLANE.index("[[rotor.unbalances]]")]
SPRINGS = TUB[TUB.index("[[rotor.springs]]") : TUB.index("[[rotor.dampers]]")]

CASES: dict[str, tuple[Case, ...]] = {
    TWO_PLANE: (
        case('kind = "two_plane"', "", "rotor.kind", "jeffcott, two_plane, tub, exciter, magnetic"),
        case('mass = "20 kg"', "", "rotor.mass", "must be given", "a mass"),
        case('transverse_inertia = "0.5 kg*m^2"', "", "rotor.transverse_inertia", "a moment of inertia"),
        case('"0.5 kg*m^2"', "0", "rotor.transverse_inertia", "from 0.000 000 000 001 to"),
        case(
            '"2000 kg*cm^2"',
            '"1.1 kg*m^2"',
            "rotor.polar_inertia",
            "at most twice rotor.transverse_inertia, 1",
        ),
        case('"2000 kg*cm^2"', "-1", "rotor.polar_inertia", "= -1", "a moment of inertia"),
        case('axis = "vertical"', "", "rotor.axis", "horizontal, vertical"),
        case(
            'axis = "vertical"',
            'axis = "vertical"\nstiffness = 3',
            "rotor.stiffness",
            "kind, mass, transverse_inertia",
        ),
        case(SUPPORTS, "", "rotor.supports", "must be given", "1 to 1000 tables headed [[rotor.supports]]"),
        case('position = "-350 mm"\n', "", "rotor.supports.0.position", "must be given", "a length"),
        case('"40 N/mm"', '"40 kg"', "rotor.supports.0.stiffness", "a stiffness", "kg measures"),
        case("damping = 80", "damping = -80", "rotor.supports.0.damping", "a damping coefficient"),
        case("position = 0.3", "position = nan", "rotor.supports.1.position", "finite"),
        case(
            "position = 0.3",
            "place = 0.3\nposition = 0.3",
            "rotor.supports.1.place",
            "position, stiffness, damping",
        ),
        case('"-90 deg"', '"-90 mm"', "rotor.unbalances.1.angle", "an angle", "30 deg"),
        case('"1200 g*mm"', '"-1 g*mm"', "rotor.unbalances.1.size", "an unbalance"),
    ),
    TUB: (
        case("drum_mass = 12.5", "", "rotor.drum_mass", "must be given", "a mass"),
        case(
            '[1.3, "1.5 kg*m^2", 1.2]',
            "[1.3, 1.5]",
            "rotor.tub_inertia",
            "a list of 3 moments of inertia",
        ),
        case('"1.5 kg*m^2"', "-1", "rotor.tub_inertia.1", "= -1", "a moment of inertia"),
        case('"90 mm"', '"90 kg"', "rotor.drum_position.1", "a length"),
        case('["1 mm", "90 mm", 0]', "3", "rotor.drum_position", "a list of 3 lengths"),
        case(
            'unbalance_position = "60 mm"',
            "unbalance_position = true",
            "rotor.unbalance_position",
            "a length",
        ),
        case(SPRINGS, "", "rotor.springs", "must be given", "tables headed [[rotor.springs]]"),
        case("[1, 0, 2.5]", "[0, 0, 0]", "rotor.springs.0.direction", "not all 0"),
        case("[1, 0, 2.5]", "[1, 2.5]", "rotor.springs.0.direction", "pure numbers"),
        case("[1, 0, 2.5]", '[1, 0, "up"]', "rotor.springs.0.direction.2", "a pure number"),
        case("direction = [1, 0, 2.5]\n", "", "rotor.springs.0.stiffness", "a list of three", "no direction"),
        case(
            '"6 N/mm"', "[1, 2, 3]", "rotor.springs.0.stiffness", "a single value", "direction that is given"
        ),
        case('["1 N/mm", 2000, 0]', '["1 N/mm", 2000]', "rotor.springs.1.stiffness", "or a list of three"),
        case('["1 N/mm", 2000, 0]', '["1 N/mm", -1, 0]', "rotor.springs.1.stiffness", "a stiffness"),
        case('damping = "175 N*s/m"', "", "rotor.dampers.0.damping", "must be given"),
        case("damping = [1, 2, 3]", "damping = 1", "rotor.dampers.1.damping", "a list of three"),
        case('kind = "tub"', 'kind = "tub"\naxis = "tilted"', "rotor.axis", "horizontal, vertical"),
    ),
    EXCITER: (
        case('platform_mass = "90 kg"', "", "rotor.platform_mass", "a mass"),
        case("balls = ", "stones = ", "rotor.balls", "a table of count, mass, kind"),
        case("count = 2", "count = 0", "rotor.balls.count", "from 1 to 1000"),
        case('kind = "ball"', 'kind = "cube"', "rotor.balls.kind", "ball, roller"),
        case('kind = "ball", ', "", "rotor.balls.kind", "exactly one of kind and pendulum_inertia"),
        case(
            'kind = "ball"',
            'kind = "ball", pendulum_inertia = 1',
            "rotor.balls.pendulum_inertia",
            "given alone",
        ),
        case('track_radius = "73.5 mm", ', "", "rotor.balls.track_radius", "a length"),
    ),
    MAGNETIC: (
        case('eccentricity = "0.5 um"', "", "rotor.eccentricity", "a length"),
        case('"3e-7 kg*m^2"', "1", "rotor.polar_inertia", "at most twice rotor.transverse_inertia"),
        case("force_constant = 2e-5", 'force_constant = "2 N"', "rotor.magnets.force_constant", "0.00002"),
        case(
            'bias_current = "30 mA"',
            'bias_current = "30 mA", most_current = "31 mA"',
            "rotor.magnets.most_current",
            "at most rotor.magnets.bias_current, 30 mA",
        ),
        case('second = "9 mm"', 'second = "-9 mm"', "rotor.magnets.second", "above rotor.magnets.first"),
        case("pid = ", "controller = ", "rotor.controller", "left out or spelled"),
        case('cutoff = "5e4 rad/s"', "cutoff = 0", "rotor.pid.cutoff", "an angular speed"),
        case('frequency = "50 Hz"', "frequency = 0", "rotor.loads.0.frequency", "an angular speed"),
        case('force = [0, "1 N"]', "force = [0]", "rotor.loads.0.force", "a list of 2 forces"),
        case('["0.1 mm", "0 mm"]', '["0.2 mm", "0 mm"]', "rotor.trial.offset", "within rotor.magnets.gap"),
        case(
            'speed = "9000 rpm"', "speed = 9, pulsation = 10", "rotor.trial.pulsation", "at most rotor.trial"
        ),
    ),
    TUB + MOTOR: (
        case("duration", "rate = 8\nduration", "runup.rate", "left out where runup.motor is given"),
        case("duration", "back = true\nduration", "runup.back", "false where runup.motor is given"),
        case("samples = 500", "samples = 5", "runup.samples", "from 10 to 1000000"),
        case("dispersion = true", "dispersion = 1", "runup.dispersion", "true or false"),
        case("dispersion = true", 'bore = "roller"', "runup.bore", "none, enstrophy"),
        case("dispersion = true", 'capture = "late"', "runup.capture", "carried, drum, riding"),
        case('inertia = "0.5 kg*m^2", ', "", "runup.motor.inertia", "a moment of inertia"),
        case('[0, "1000 rpm", 200]', '[0, "1000 rpm", 100]', "runup.motor.speeds", "above the one before"),
        case('[0, "1000 rpm", 200]', "[0]", "runup.motor.speeds", "2 to 1000"),
        case('[0, "1000 rpm", 200]', "[-1, 2, 3]", "runup.motor.speeds.0", "an angular speed"),
        case('["20 N*m", 10, -1]', "[1, 2]", "runup.motor.torques", "a list of 3 torques"),
        case('"20 N*m"', '"20 N"', "runup.motor.torques.0", "a torque"),
    ),
}
ALL = [(text, one) for text, cases in CASES.items() for one in cases]


@pytest.mark.parametrize(("text", "one"), ALL, ids=[f"{c.field}-{c.wrong.strip()[:20]}" for _, c in ALL])
def test_a_wrong_value_is_named(
    text: str, one: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "scene.toml"
    assert text.count(one.right) >= 1
    path.write_text(HEAD + text.replace(one.right, one.wrong, 1), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    check(str(caught.value), path, one.field, one.said)
    assert one.field in [fault.field for fault in caught.value.faults]
    assert shell(path, capsys) == str(caught.value) + "\n"


def test_an_unknown_kind_is_one_fault(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Which keys such a rotor has is not known: they are no faults of their own."""
    text = (Path(__file__).parents[3] / "examples" / "tub.toml").read_text(encoding="utf-8")
    path = tmp_path / "scene.toml"
    path.write_text(text.replace('kind = "tub"', 'kind = "bathtub"'), encoding="utf-8")
    said = shell(path, capsys)
    assert said.count("\n") == 1 and 'rotor.kind = "bathtub"' in said and "tub, exciter" in said
