"""Scenes of the other kinds of rotor arrive in SI units; run-ups with a motor as well."""

from __future__ import annotations

import math
import tomllib
from typing import Any

import pytest

from leblanc.scene.rotors import Balls
from leblanc.scene.scene import (
    Exciter,
    MagneticRotor,
    Runup,
    Scene,
    TubRotor,
    TwoPlaneRotor,
    dry_rotor,
    jeffcott,
    scene_from_table,
)
from leblanc.scene.schema.load import SceneError
from leblanc.scene.tasks import Motor
from meshes.errors import InputError
from solvers.rotor.exciter.machine import Exciter as Machine
from solvers.rotor.magnetic.control import Pid
from solvers.rotor.magnetic.machine import Magnets
from solvers.rotor.magnetic.motion import Load, SpeedLaw
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from tests.leblanc.scene.test_scene import TEXT

HEAD = 'name = "x"\nspeeds = { start = 1, stop = 20, count = 5 }\n'

TWO_PLANE = """
[rotor]
kind = "two_plane"
mass = "20 kg"
transverse_inertia = "0.5 kg*m^2"
polar_inertia = "2000 kg*cm^2"
axis = "vertical"
[[rotor.supports]]
position = "-350 mm"
stiffness = "40 N/mm"
damping = 80
[[rotor.supports]]
position = 0.3
stiffness = 0
damping = 0
[[rotor.unbalances]]
position = "-200 mm"
size = "1.5 kg*mm"
[[rotor.unbalances]]
position = "25 cm"
size = "1200 g*mm"
angle = "-90 deg"
"""

TUB = """
[rotor]
kind = "tub"
tub_mass = "48.2 kg"
drum_mass = 12.5
tub_inertia = [1.3, "1.5 kg*m^2", 1.2]
drum_polar_inertia = 0.32
drum_transverse_inertia = "0.2 kg*m^2"
drum_position = ["1 mm", "90 mm", 0]
unbalance = "0.185 kg*m"
unbalance_position = "60 mm"
[[rotor.springs]]
position = ["200 mm", 0, "20 cm"]
direction = [1, 0, 2.5]
stiffness = "6 N/mm"
[[rotor.springs]]
position = [0, 0, 0]
stiffness = ["1 N/mm", 2000, 0]
[[rotor.dampers]]
position = [0, 0, "-0.2 m"]
direction = [0, 0, 1]
damping = "175 N*s/m"
[[rotor.dampers]]
position = [0, 0, 0]
damping = [1, 2, 3]
"""

EXCITER = """
[rotor]
kind = "exciter"
platform_mass = "90 kg"
stiffness = "145083 N/m"
damping = 150
unbalance = "10.5 kg*mm"
balls = { count = 2, mass = "0.325 kg", kind = "ball", track_radius = "73.5 mm", damping = "0.03 N*s/m" }
"""

MAGNETIC = """
[rotor]
kind = "magnetic"
mass = "12 g"
transverse_inertia = "7e-7 kg*m^2"
polar_inertia = "3e-7 kg*m^2"
eccentricity = "0.5 um"
axis = "horizontal"
magnets = { gap = "0.2 mm", force_constant = 2e-5, bias_current = "30 mA", first = "-8 mm", second = "9 mm" }
motor = { stiffness = "6 N/mm", length = "14 mm" }
drag = { coefficient = 0.9, viscosity = "50 mPa*s", radius = "7 mm", length = "2 cm" }
pid = { proportional = "150 N/mm", integral = 7e6, derivative = 41, cutoff = "5e4 rad/s" }
loads = [{ force = [0, "1 N"], frequency = "50 Hz" }, { moment = ["1 mN*m", 0], start = "20 ms" }]
trial = { duration = "50 ms", speed = "9000 rpm", offset = ["0.1 mm", "0 mm"] }
"""

MOTOR = """
[runup]
start = "5 rad/s"
stop = "100 rad/s"
duration = "14 s"
dispersion = true
samples = 500
motor = { inertia = "0.5 kg*m^2", speeds = [0, "1000 rpm", 200], torques = ["20 N*m", 10, -1] }
"""


def read(text: str) -> Scene:
    return scene_from_table(tomllib.loads(HEAD + text))


def test_two_plane() -> None:
    rotor = read(TWO_PLANE).rotor
    expected = TwoPlane(
        20.0,
        0.5,
        0.2,
        (Support(-0.35, 4e4, 80.0), Support(0.3, 0.0, 0.0)),
        (PlaneUnbalance(-0.2, 1.5e-3), PlaneUnbalance(0.25, 1.2e-3, -math.pi / 2)),
    )
    assert isinstance(rotor, TwoPlaneRotor) and rotor.machine() == expected and rotor.axis == "vertical"
    assert dry_rotor(read(TWO_PLANE)) == expected and read(TWO_PLANE).chambers == ()


def test_supports_unlike_in_two_directions() -> None:
    """Two values, each with its unit; one of them is a field of its own; three are refused."""
    unlike = TWO_PLANE.replace('"40 N/mm"', '["40 N/mm", 3e4]').replace("damping = 80", "damping = [80, 70]")
    rotor = read(unlike).rotor
    assert isinstance(rotor, TwoPlaneRotor)
    assert rotor.machine().supports[0] == Support(-0.35, (4e4, 3e4), (80.0, 70.0))
    softer = read(unlike).replace({"rotor.supports.0.stiffness.1": "20 N/mm"}).rotor
    assert isinstance(softer, TwoPlaneRotor) and softer.supports[0].stiffness == (4e4, 2e4)
    with pytest.raises(SceneError, match=r"supports\.0\.stiffness.*a list of two"):
        read(TWO_PLANE.replace('"40 N/mm"', "[1e4, 1e4, 1e4]"))


def test_tub() -> None:
    expected = Tub(
        tub_mass=48.2,
        drum_mass=12.5,
        tub_inertia=(1.3, 1.5, 1.2),
        drum_polar_inertia=0.32,
        drum_transverse_inertia=0.2,
        springs=(
            Mount((0.2, 0.0, 0.2), 6000.0, (1.0, 0.0, 2.5)),
            Mount((0.0, 0.0, 0.0), along_axes=(1e3, 2e3, 0.0)),
        ),
        dampers=(
            Mount((0.0, 0.0, -0.2), 175.0, (0.0, 0.0, 1.0)),
            Mount((0.0, 0.0, 0.0), along_axes=(1.0, 2.0, 3.0)),
        ),
        unbalance=0.185,
        drum_position=(0.001, 0.09, 0.0),
        unbalance_position=0.06,
    )
    rotor = read(TUB).rotor
    assert isinstance(rotor, TubRotor) and rotor.machine() == expected and rotor.axis == "horizontal"
    plain = TUB.replace('unbalance_position = "60 mm"\n', "").replace(
        'drum_position = ["1 mm", "90 mm", 0]\n', ""
    )
    machine = dry_rotor(read(plain))
    assert isinstance(machine, Tub)
    assert machine.drum_position == (0.0, 0.0, 0.0) and machine.unbalance_position is None


def test_exciter() -> None:
    balls = Balls(count=2, mass=0.325, kind="ball", track_radius=0.0735, damping=0.03)
    rotor = read(EXCITER).rotor
    assert isinstance(rotor, Exciter)
    assert rotor == Exciter(
        kind="exciter", platform_mass=90.0, stiffness=145083.0, damping=150.0, unbalance=0.0105, balls=balls
    )
    assert rotor.machine() == Machine(90.0, 145083.0, 150.0, 0.0105, 2, 0.325, 7.0 / 5.0, 0.0735, 0.03)
    assert rotor.axis == "horizontal"
    pendulum = read(EXCITER.replace('kind = "ball"', 'pendulum_inertia = "1e-4 kg*m^2"')).rotor
    assert isinstance(pendulum, Exciter)
    assert (pendulum.balls.name, pendulum.balls.pendulum_inertia) == ("pendulum", 1e-4)
    with pytest.raises(InputError, match=r"rotor\.kind"):
        dry_rotor(read(EXCITER))


def test_magnetic() -> None:
    rotor = read(MAGNETIC).rotor
    assert isinstance(rotor, MagneticRotor) and rotor.axis == "horizontal"
    machine = rotor.machine()
    assert machine.magnets == Magnets(2e-4, 2e-5, 0.03) and (machine.first, machine.second) == (-8e-3, 9e-3)
    assert (machine.motor_stiffness, machine.motor_length) == (6000.0, 0.014)
    assert machine.drag == pytest.approx(0.9 * 0.05 * math.pi * 0.007**2 * 0.02, rel=1e-14)
    assert rotor.unbalance == pytest.approx(6e-9) and machine.unbalance[0] == pytest.approx(6e-9)
    assert rotor.controllers() == (Pid(machine, 150e3, 7e6, 41.0, 5e4),)
    swinging, constant = (load.load() for load in rotor.loads)
    assert swinging == Load((0.0, 1.0), frequency=100.0 * math.pi)
    assert constant == Load((0.0, 0.0), (1e-3, 0.0), start=0.02)
    assert rotor.trial is not None and rotor.trial.law() == SpeedLaw(300.0 * math.pi)
    with pytest.raises(InputError, match=r"rotor\.kind"):
        dry_rotor(read(MAGNETIC))


def test_the_planar_rotor_alone_is_a_jeffcott() -> None:
    assert jeffcott(read(TEXT[TEXT.index("[rotor]") : TEXT.index("[speeds]")])).mass == 4.0
    with pytest.raises(InputError, match=r"rotor\.kind"):
        jeffcott(read(TUB))


def test_motor() -> None:
    motor = Motor(inertia=0.5, speeds=(0.0, 1000.0 * math.pi / 30.0, 200.0), torques=(20.0, 10.0, -1.0))
    assert read(TUB + MOTOR).runup == Runup(
        start=5.0, stop=100.0, duration=14.0, dispersion=True, samples=500, motor=motor
    )


@pytest.mark.parametrize("text", [TWO_PLANE, TUB, EXCITER, MAGNETIC, TUB + MOTOR])
def test_scenes_are_frozen_and_have_a_digest(text: str) -> None:
    scene = read(text)
    assert isinstance(hash(scene), int)
    assert scene.digest == read(text).digest
    # Every number of the text counts.
    table: dict[str, Any] = tomllib.loads(HEAD + text)
    digests = {scene.digest}
    for place in _numbers(table["rotor"]):
        changed: dict[str, Any] = tomllib.loads(HEAD + text)
        holder = changed["rotor"]
        for key in place[:-1]:
            holder = holder[key]
        holder[place[-1]] = holder[place[-1]] * 1.01 + 0.003
        digests.add(scene_from_table(changed).digest)
    assert len(digests) == len(list(_numbers(table["rotor"]))) + 1


def _numbers(table: Any, place: tuple[Any, ...] = ()) -> Any:
    """Paths of the plain numbers that are no counts."""
    items = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in items:
        if isinstance(value, dict | list):
            yield from _numbers(value, (*place, key))
        elif isinstance(value, int | float) and key != "count":
            yield (*place, key)
