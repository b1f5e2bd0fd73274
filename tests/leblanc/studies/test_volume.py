"""`leblanc volume`: exact, by finite elements, as published; the extremes."""

from __future__ import annotations

import json
import math
from functools import cache, partial
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.terminal import show
from leblanc.core.units import VOLUME, with_unit
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.notes import RunCode, wall
from leblanc.studies.run.study import run_scene
from meshes.chamber import Chamber
from solvers.statics.hydrostatics import wall_volumes
from tests.mutants import kills

slow = partial(pytest.param, marks=pytest.mark.slow)
CHAMBER = ["volume", "--radius", "0.2", "--height", "0.05"]


def ask(capsys: pytest.CaptureFixture[str], *options: str) -> dict[str, float]:
    assert main([*CHAMBER, *options, "--json"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    answer: dict[str, float] = json.loads(out)
    return answer


def test_optimal_volume(capsys: pytest.CaptureFixture[str]) -> None:
    answer = ask(capsys, "--eccentricity", "0.001", "--speed", "90")
    assert set(answer) == {
        "optimal_volume", "optimal_volume_fem", "fem_error", "printed_eq18", "corrected_eq18",
        "wetting_volume", "lid_volume", "full_volume",
    }  # fmt: skip
    assert answer["wetting_volume"] == answer["optimal_volume"]
    # Eq. 22 of the theory; beta = 412.8/m.
    ring = 0.2**2 - 0.199**2 + 0.05 * 9.81 / 90.0**2
    assert answer["full_volume"] == pytest.approx(math.pi * 0.05 * ring, rel=1e-11)
    assert answer["lid_volume"] < answer["wetting_volume"]
    assert answer["optimal_volume"] == pytest.approx(54.43957239e-6, rel=2e-10)
    assert answer["optimal_volume_fem"] == pytest.approx(answer["optimal_volume"], rel=1e-6)
    assert answer["printed_eq18"] == pytest.approx(2.040, rel=1e-3)
    assert answer["corrected_eq18"] == pytest.approx(56.7e-6, rel=1e-3)


def test_what_was_understood_is_said_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*CHAMBER, "--inner-radius", "150 mm", "--eccentricity", "1 mm", "--speed", "9.549 rpm"]) == 0
    assert capsys.readouterr().out.startswith(
        "Chamber of radius 200 mm, inner radius 150 mm, height 50 mm; deflection 1 mm at 9.549 rpm\n"
    )


def test_units_are_read(capsys: pytest.CaptureFixture[str]) -> None:
    plain = ask(capsys, "--eccentricity", "0.003", "--speed", "90", "--volume", "1e-4")
    with_units = ask(
        capsys, "--eccentricity", "3 mm", "--speed", f"{90 * 30 / math.pi!r} rpm", "--volume", "100 ml"
    )
    assert with_units == pytest.approx(plain, rel=1e-12)


@pytest.mark.parametrize(("volume", "case"), [("1e-3", 1), ("54.43957239e-6", 2), ("1e-5", 3)])
def test_cases(capsys: pytest.CaptureFixture[str], volume: str, case: int) -> None:
    answer = ask(capsys, "--eccentricity", "0.001", "--speed", "90", "--volume", volume)
    assert answer["case"] == case
    full = math.pi * 0.2**2 * 0.05 * 0.001
    if case == 1:
        assert answer["unbalance_volume"] == pytest.approx(full, rel=1e-12)
    else:
        # A drop at the farthest point at most: V (R + e).
        assert answer["unbalance_volume"] < min(full, float(volume) * 0.201)
    assert answer["unbalance_volume_fem"] == pytest.approx(answer["unbalance_volume"], rel=1e-5)


@pytest.mark.parametrize("eccentricity", ["0", slow("1e-5"), "0.2", slow("0.3"), slow("2")])
@pytest.mark.parametrize("speed", ["0", slow("1e-4"), "1e5"])
@pytest.mark.parametrize("gravity", ["0", "9.81"])
@pytest.mark.parametrize("volume", ["0", "6.283185307179587e-3"])
def test_extremes(
    capsys: pytest.CaptureFixture[str], eccentricity: str, speed: str, gravity: str, volume: str
) -> None:
    answer = ask(
        capsys, "--eccentricity", eccentricity, "--speed", speed, "--gravity", gravity, "--volume", volume
    )
    capacity, e = math.pi * 0.2**2 * 0.05, float(eccentricity)
    assert 0.0 <= answer["optimal_volume"] <= capacity * (1 + 1e-12)
    assert answer["fem_error"] < 1e-5
    full = float(volume) > 0.0
    assert answer["unbalance_volume"] == pytest.approx(capacity * e if full else 0.0, rel=1e-12)
    assert answer["unbalance_volume_fem"] == pytest.approx(capacity * e if full else 0.0, rel=1e-5, abs=1e-18)


@kills(
    "leblanc.studies.volume.study:answer_volume", "np.fmin(met.lid, met.inner)", "np.fmax(met.lid, met.inner)"
)
@kills("leblanc.studies.volume.study:answer_volume", "np.fmin(met.lid, met.inner)", "met.lid")
def test_lid_or_inner_wall(capsys: pytest.CaptureFixture[str]) -> None:
    """The one that is met with less liquid; none on a horizontal axis without an inner wall."""
    at = ("--eccentricity", "0.001", "--speed", "90")
    bare, wide = ask(capsys, *at)["lid_volume"], ask(capsys, *at, "--inner-radius", "0.15")["lid_volume"]
    # A thin ring meets the lid before its inner wall: with the same liquid as without that wall.
    assert wide == pytest.approx(bare, rel=1e-12)
    flat = ask(capsys, *at, "--gravity", "0")
    assert flat["lid_volume"] is None and flat["full_volume"] == flat["wetting_volume"]
    ring = ask(capsys, *at, "--gravity", "0", "--inner-radius", "0.15")["lid_volume"]
    assert ring == pytest.approx(math.pi * 0.05 * (0.2**2 - 0.151**2), rel=1e-12)
    # Slow, the liquid meets the foot of the inner wall long before the lid.
    slow = ask(capsys, "--eccentricity", "0.001", "--speed", "3", "--inner-radius", "0.15")
    assert slow["lid_volume"] < 0.1 * slow["full_volume"]


UPRIGHT: dict[str, Any] = {
    "name": "upright",
    "rotor": {
        "kind": "jeffcott", "mass": 30.0, "critical_speed": "150 rpm", "damping_ratio": 0.05,
        "unbalance": "3 kg*mm", "axis": "vertical",
    },
    "chambers": [{"radius": 0.2, "height": 0.05, "volume": "1 ml", "liquid": "water"}],
    "speeds": {"start": "60 rpm", "stop": "300 rpm", "count": 5},
}  # fmt: skip


def upright(volume: float, **chamber: object) -> Scene:
    chambers = [UPRIGHT["chambers"][0] | {"volume": volume} | chamber]
    return scene_from_table(UPRIGHT | {"chambers": chambers})


@cache
def ran(volume: float) -> RunAnswer:
    answer = run_scene(upright(volume))
    assert isinstance(answer, RunAnswer)
    return answer


def wall_note(answer: RunAnswer) -> str:
    (note,) = (note for note in answer.notes if note.code == RunCode.WALL)
    return note.text


@kills("leblanc.studies.run.study:_moved", "np.abs(answer.deflection)", "0.5 * np.abs(answer.deflection)")
def test_run_gives_them_at_its_own_deflection() -> None:
    """At each speed those of `volume` at the amplitude that it has there; in JSON [chamber][speed]."""
    answer, chamber = run_scene(upright(2e-4)), Chamber(0.2, 0.05)
    told = answer.to_json()
    for k, (speed, e) in enumerate(zip(answer.speed.tolist(), answer.amplitude.tolist(), strict=True)):
        met = wall_volumes(chamber, e, speed)
        assert told["wetting_volume"][0][k] == pytest.approx(float(met.wetting), rel=1e-12)
        assert told["lid_volume"][0][k] == pytest.approx(float(met.lid), rel=1e-12)
        assert told["full_volume"][0][k] == pytest.approx(float(met.full), rel=1e-12)
    assert answer.to_dataset()["full_volume"].dims == ("chamber", "speed")


def test_explain_gives_them_without_liquid(capsys: pytest.CaptureFixture[str]) -> None:
    """At the deflection of the dry rotor, U Omega^2/|K - M Omega^2 + i C Omega|."""
    answer = lb.explain(upright(2e-4))
    speed, natural = np.linspace(60.0, 300.0, 5) * math.pi / 30.0, 150.0 * math.pi / 30.0
    stiffness = 30.0 * (natural**2 - speed**2 + 2j * 0.05 * natural * speed)
    met = wall_volumes(Chamber(0.2, 0.05), 3e-3 * speed**2 / np.abs(stiffness), speed)
    told = answer.to_json()
    np.testing.assert_allclose(told["wetting_volume"], [met.wetting], rtol=1e-10)
    np.testing.assert_allclose(told["lid_volume"], [met.lid], rtol=1e-10)
    np.testing.assert_allclose(told["full_volume"], [met.full], rtol=1e-10)
    show(answer.blocks())
    text = " ".join(capsys.readouterr().out.split())
    assert "wets the wall all round at the floor" in text and "up to the lid; more adds nothing" in text


def test_more_than_wets_the_wall_does_something_upright() -> None:
    """At twice the resonance 1 ml wets the wall, 50 ml do more, 200 ml most, 400 ml no more."""
    sizes = [float(ran(volume).amplitude[-1]) for volume in (1e-6, 5e-5, 2e-4, 4e-4)]
    assert sizes[0] > 1.15 * sizes[1] > 1.15 * 1.04 * sizes[2]
    assert sizes[3] == pytest.approx(sizes[2], rel=1e-9)
    few, many = wall_note(ran(1e-6)), wall_note(ran(2e-4))
    assert "at the floor, not up to the lid" in few and "more adds to its unbalance up to" in few
    assert "wet all round up to the lid" in many and many.endswith("more does nothing.")
    dry = wall_note(ran(1e-8))
    assert "dry in part" in dry and "up to the lid; then more does nothing" in dry


def test_lying_one_volume_wets_it() -> None:
    """Gravity across: wetting and full volume are one, no lid volume; the note knows no lid."""
    answer = run_scene(lb.example("horizontal_rig"))
    told = answer.to_json()
    assert told["wetting_volume"] == told["full_volume"]
    assert np.shape(told["lid_volume"]) == np.shape(told["full_volume"]) == (2, 201)
    assert told["lid_volume"][0][0] is None
    notes = [note.text for note in answer.notes if note.code == RunCode.WALL]
    assert all("lid" not in note and "more does nothing" in note for note in notes)


def test_where_there_are_none() -> None:
    """Lists without a chamber, None of a chamber that its baffles cut."""
    bare = run_scene(scene_from_table({key: UPRIGHT[key] for key in ("name", "rotor", "speeds")})).to_json()
    assert bare["wetting_volume"] == bare["lid_volume"] == bare["full_volume"] == []
    parted = run_scene(upright(2e-4, baffles={"count": 4, "tip_radius": "150 mm"})).to_json()
    assert parted["full_volume"] == [[None] * 5]


def test_each_chamber_at_its_own_deflection() -> None:
    """A rotor that tilts moves one chamber more than another."""
    answer = run_scene(lb.example("two_plane_rig"))
    assert isinstance(answer, RunAnswer) and answer.motion is not None
    moved = np.abs(answer.motion.chamber_forward)
    assert np.any(moved[:, 0] != moved[:, -1])
    for k, fill in enumerate(lb.example("two_plane_rig").fills):
        met = wall_volumes(fill.chamber, moved[:, k], answer.speed, answer.axial_gravity)
        np.testing.assert_allclose(answer.full_volume[k], met.full, rtol=1e-12)


def test_what_an_inner_wall_changes() -> None:
    """Beyond the volume that meets its foot more liquid is not said to do nothing."""
    chamber = Chamber(0.2, 0.05, 0.18)
    met = wall_volumes(chamber, 1e-3, 90.0)
    between = wall(0, 90.0, float(0.5 * (met.full + met.inner)), 1e-3, met).text
    assert between.endswith(
        f"more does nothing up to {with_unit(float(met.inner), VOLUME)}, at the inner wall."
    )
    beyond = wall(0, 90.0, float(1.05 * met.inner), 1e-3, met).text
    assert "does nothing" not in beyond and "on, at the inner wall, more changes its unbalance" in beyond


@pytest.mark.parametrize(
    "options",
    [
        ["--eccentricity", "-1", "--speed", "90"],
        ["--eccentricity", "0.001", "--speed", "nan"],
        ["--eccentricity", "0.001", "--speed", "90", "--volume", "7e-3"],
        ["--eccentricity", "0.001", "--speed", "90", "--volume", "-1 ml"],
        ["--eccentricity", "1 kg", "--speed", "90"],
        ["--eccentricity", "0.001", "--speed", "90", "--gravity", "-9.81"],
        ["--eccentricity", "0.001", "--speed", "90", "--inner-radius", "0.3"],
        ["--eccentricity", "0.001"],
        ["--eccentricity", "0.001", "--speed", "90", "--colour", "red"],
    ],
)
def test_bad_input(capsys: pytest.CaptureFixture[str], options: list[str]) -> None:
    assert main([*CHAMBER, *options, "--json"]) == 2
    out, err = capsys.readouterr()
    assert out == "" and len(err.strip().splitlines()) == 1 and "Traceback" not in err
