"""A scene is read as it stands, in SI units, whatever its spelling."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from fluid.liquid import KNOWN_LIQUIDS, Liquid
from leblanc.scene.scene import (
    Friction,
    JeffcottRotor,
    Runup,
    Scene,
    Speeds,
    jeffcott,
    load_scene,
    scene_from_table,
)
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott

TEXT = """
name = "Rig"
source = "a paper"
assumed = ["rotor.mass", "chambers.0.height"]
gravity = "9.8 m/s^2"

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
plane = "-5 mm"

[[chambers]]
radius = 0.05
height = 0.02
volume = 0
liquid = { density = 998, viscosity = "1.0 mm^2/s" }

[speeds]
start = "100 rpm"
stop = "2000 rpm"
count = 191

[model]
liquid = "long_wave"
friction = { linear = "0.5 1/s" }

[runup]
start = "5 rad/s"
stop = "100 rad/s"
rate = "8 rad/s^2"
duration = "14 s"
cells = 64
back = true
"""
RPM = math.pi / 30.0


def read(text: str = TEXT) -> Scene:
    return scene_from_table(tomllib.loads(text))


def changed(*pairs: tuple[str, str]) -> Scene:
    text = TEXT
    for right, other in pairs:
        assert text.count(right) == 1, right
        text = text.replace(right, other)
    return read(text)


def test_every_value_arrives_in_si() -> None:
    scene = read()
    assert (scene.name, scene.source, scene.gravity) == ("Rig", "a paper", 9.8)
    assert scene.assumed == ("rotor.mass", "chambers.0.height")
    assert scene.fills[0].chamber == Chamber(radius=0.065, height=0.02, inner_radius=0.01, plane=-0.005)
    assert scene.fills[0].liquid == KNOWN_LIQUIDS["water"]
    assert scene.fills[0].volume == 1e-5
    assert scene.fills[1].chamber == Chamber(radius=0.05, height=0.02)
    assert scene.fills[1].liquid == Liquid("liquid", 998.0, 1e-6)
    assert scene.fills[1].volume == 0.0
    assert scene.speeds == Speeds(start=100.0 * RPM, stop=2000.0 * RPM, count=191)
    assert scene.model.liquid == "long_wave"
    assert scene.model.friction == Friction("linear", 0.5)
    assert scene.runup == Runup(start=5.0, stop=100.0, rate=8.0, duration=14.0, cells=64, back=True)


def test_what_may_be_left_out_has_its_default() -> None:
    left_out = TEXT[: TEXT.index("[model]")].replace('gravity = "9.8 m/s^2"', "").replace("assumed =", "# ")
    scene = read(left_out.replace('source = "a paper"', ""))
    assert (scene.source, scene.assumed, scene.gravity, scene.runup) == ("", (), 9.81, None)
    assert (scene.model.liquid, scene.model.friction) == ("auto", Friction("wall"))


def test_stiffness_and_damping_may_be_given_themselves() -> None:
    scene = changed(
        ('critical_speed = "1000 rpm"', 'stiffness = "4.4e4 N/m"'),
        ("damping_ratio = 0.10", 'damping = "84 N*s/m"'),
    )
    assert isinstance(scene.rotor, JeffcottRotor)
    assert scene.rotor.machine() == Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
    assert scene.rotor.axis == "horizontal"


def test_a_damping_ratio_refers_to_a_given_stiffness_too() -> None:
    scene = changed(('critical_speed = "1000 rpm"', "stiffness = 4.4e4"))
    assert jeffcott(scene).damping == pytest.approx(0.2 * math.sqrt(4.4e4 * 4.0), rel=1e-15)


@pytest.mark.parametrize(("key", "unit"), [("damping_ratio", ""), ("damping", " N*s/m")])
def test_damping_may_be_zero(key: str, unit: str) -> None:
    assert jeffcott(changed(("damping_ratio = 0.10", f'{key} = "0{unit}"'))).damping == 0.0


@pytest.mark.parametrize(
    ("text", "friction"),
    [
        ('"none"', Friction("none", 0.0)),
        ('"stokes"', Friction("stokes", 0.0)),
        ("{ linear = 3 }", Friction("linear", 3.0)),
        ("{ quadratic = 0.01 }", Friction("quadratic", 0.01)),
        ('"wall"', Friction("wall")),
        ('{ wall = { roughness = "2 um" } }', Friction("wall", roughness=2e-6)),
    ],
)
def test_friction_laws(text: str, friction: Friction) -> None:
    assert changed(('{ linear = "0.5 1/s" }', text)).model.friction == friction


def test_a_chamber_may_be_full() -> None:
    full = math.pi * (0.065**2 - 0.01**2) * 0.02
    scene = changed(('volume = "10 ml"', f"volume = {full!r}"))
    assert scene.fills[0].volume == pytest.approx(full, rel=1e-15)
    # nine digits, rounded up: taken as full, and never above what the chamber holds
    scene = changed(('volume = "10 ml"', f"volume = {full * (1 + 5e-10)!r}"))
    assert scene.fills[0].volume == scene.fills[0].chamber.capacity


def test_speeds_are_evenly_spaced_from_end_to_end() -> None:
    speeds = read().speed_array()
    assert speeds.shape == (191,)
    assert (speeds[0], speeds[-1]) == (100.0 * RPM, 2000.0 * RPM)
    np.testing.assert_allclose(np.diff(speeds), 10.0 * RPM, rtol=1e-12)  # rounding of speeds 200 times a step


def test_one_speed() -> None:
    scene = changed(('stop = "2000 rpm"', 'stop = "100 rpm"'), ("count = 191", "count = 1"))
    assert scene.speed_array().tolist() == [100.0 * RPM]


def test_a_scene_cannot_be_changed() -> None:
    scene = read()
    for part, name in ((scene, "rotor"), (scene.rotor, "mass"), (scene.chambers[0], "volume")):
        with pytest.raises(ValidationError, match="frozen"):
            setattr(part, name, None)
    assert isinstance(scene.chambers, tuple)
    assert isinstance(hash(scene), int)


def test_bytes_that_editors_add_do_not_matter(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    assert load_scene(file) == load_scene(str(file)) == read()


# -- the digest ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("right", "same"),
    [
        ('mass = "4 kg"', "mass = 4"),
        ('mass = "4 kg"', 'mass = "4000 g" # in grams'),
        ('"1000 rpm"', f'"{1000 / 60!r} Hz"'),
        ('"1000 rpm"', repr(1000 * RPM)),
        ("damping_ratio = 0.10", f"damping = {0.2 * 4 * 1000 * RPM!r}"),
        ('"0.6 kg*mm"', '"600 g*mm"'),
        ('radius = "65 mm"', "radius   =   0.065"),
        ('"10 ml"', '"0.01 l"'),
        ('"1.0 mm^2/s"', '"1 cSt"'),
        ("gravity = ", "\n\n# here\ngravity  = "),
        ('source = "a paper"', 'source = " a  paper "'),
    ],
)
def test_the_digest_does_not_see_spelling(right: str, same: str) -> None:
    assert changed((right, same)).digest == read().digest


@pytest.mark.parametrize(
    ("right", "other"),
    [
        ("Rig", "Ring"),
        ("a paper", "a book"),
        ('"rotor.mass", ', ""),
        ("9.8 m", "9.81 m"),
        ("4 kg", "4.000001 kg"),
        ("1000 rpm", "1000.001 rpm"),
        ("0.10", "0.11"),
        ("0.6 kg", "0.7 kg"),
        ('"horizontal"', '"vertical"'),
        ('radius = "65', 'radius = "66'),
        ('"10 mm"', '"11 mm"'),
        ('"20 mm"', '"21 mm"'),
        ("10 ml", "11 ml"),
        ('"water"', '"brine"'),
        ("-5 mm", "5 mm"),
        ("density = 998", "density = 999"),
        ('"100 rpm"', '"101 rpm"'),
        ('"2000 rpm"', '"2001 rpm"'),
        ("191", "192"),
        ("long_wave", "linear"),
        ("{ linear =", "{ quadratic =  0.5 } #"),
        ("5 rad/s", "6 rad/s"),
        ("14 s", "15 s"),
        ("cells = 64", "cells = 128"),
        ("back = true", "back = false"),
    ],
)
def test_the_digest_sees_every_value(right: str, other: str) -> None:
    start = TEXT.index(right)
    assert read(TEXT[:start] + other + TEXT[start + len(right) :]).digest != read().digest


LENGTHS = {"m": 0, "cm": 2, "mm": 3, "µm": 6}


@settings(max_examples=50)
@given(st.integers(20_000, 9_999_999), st.sampled_from(list(LENGTHS)), st.sampled_from(list(LENGTHS)))
def test_the_digest_of_any_radius(microns: int, one: str, other: str) -> None:
    def digest(unit: str) -> str:
        text = f"{microns}e{LENGTHS[unit] - 6} {unit}"
        return changed(('radius = "65 mm"', f'radius = "{text}"')).digest

    assert digest(one) == digest(other)


def test_the_order_of_keys_and_tables_does_not_matter() -> None:
    table = tomllib.loads(TEXT)
    backwards = {
        key: dict(reversed(value.items())) if isinstance(value, dict) else value
        for key, value in reversed(table.items())
    }
    assert scene_from_table(backwards).digest == read().digest
