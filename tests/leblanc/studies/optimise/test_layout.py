"""The layout of a tub's mounts: layouts known in closed form are found, within what the scene allows."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.blocks import Picture
from leblanc.core.page import write_page
from leblanc.scene.inputs import about
from leblanc.scene.schema.load import SceneError
from leblanc.studies.optimise.layout.answer import LayoutAnswer, pair_names
from leblanc.studies.optimise.layout.figure import places_figure
from leblanc.studies.optimise.layout.study import separation, suspension_of
from leblanc.studies.optimise.study import optimise_scene
from meshes.errors import InputError
from solvers.rotor.layout import Mounts, centre_of_mass, couplings, mass_matrix, natural_frequencies
from tests.mutants import kills
from tests.oracles.blocks import failed, labels, table
from tests.oracles.pages import read_page

ROOM = "leblanc.studies.optimise.layout.study"

FOUR = [
    {"position": [x, y, z], "stiffness": [4e3, 3e3, 5e3]}
    for x in (0.2, -0.2)
    for y, z in ((0.11, 0.04), (-0.06, 0.03))
]


def tub(**changes: Any) -> lb.Scene:
    """The example with its drum's centre in that of the tub and other mounts."""
    base: dict[str, Any] = {"rotor.drum_position": [0, 0, 0], "assumed": []}
    return lb.example("tub").replace(base | {name.replace("__", "."): v for name, v in changes.items()})


def best(scene: lb.Scene, **layout: Any) -> LayoutAnswer:
    found = lb.optimise(scene.replace({"optimise": {"objective": "layout", "layout": layout}}))
    assert isinstance(found, LayoutAnswer)
    return found


@kills(
    f"{ROOM}:_judge",
    "np.square(couplings(stiffness))",
    "0.0 * couplings(stiffness)",
)
def test_springs_go_into_the_plane_of_the_centre() -> None:
    """Alike springs along the axes couple nothing where they lie in z = 0, as far in front as behind."""
    found = best(tub(rotor__springs=FOUR, rotor__dampers=[]), reach=[0.0, 0.05, 0.05], turn=0.0)
    assert found.mirrored and found.feasible
    assert found.baseline > 1e-2 and found.value < 1e-12
    place = np.array([mount.position for mount in found.mounts])
    np.testing.assert_allclose(place[:, 2], 0.0, atol=1e-6)
    np.testing.assert_allclose(place[:2, 1].sum(), 0.0, atol=1e-6)
    # Moved by less than the springs reach; mirrored to the last figure, x untouched.
    np.testing.assert_array_equal(place[2:], place[:2] * [-1.0, 1.0, 1.0])
    np.testing.assert_array_equal(np.abs(place[:, 0]), 0.2)
    assert np.abs(found.couplings["stiffness"][1]).max() < 1e-6


@kills(f"{ROOM}:_variables", "sign * lean * _MIRRORED", "sign * lean")
def test_inclined_springs_turn_until_their_lines_meet_in_the_centre() -> None:
    """A pair above the centre does not couple x and beta where it points at it, at whatever height."""
    pair = [
        {"position": [s * 0.2, 0.0, 0.15], "direction": [s * 0.6, 0.0, 0.9], "stiffness": 6e3}
        for s in (1, -1)
    ]
    level = [
        {"position": [s * 0.3, y, 0.0], "stiffness": [1e3, 1e3, 2e3]} for s in (1, -1) for y in (0.1, -0.1)
    ]
    found = best(
        tub(rotor__springs=[*pair, *level], rotor__dampers=[]), reach=[0, 0, 0], turn="25 deg", sag="1 m"
    )
    assert found.value < 1e-12 < found.baseline
    way = found.mounts[0].direction
    assert way is not None and way[2] / way[0] == pytest.approx(0.15 / 0.2, rel=1e-5)
    other = found.mounts[1].direction
    assert other == pytest.approx((-way[0], way[1], way[2]), abs=1e-15)
    assert found.mounts[2].direction is None


def test_a_pair_whose_directions_are_opposite_stays_a_pair() -> None:
    pair = [
        {"position": [0.2, 0.0, 0.15], "direction": [0.6, 0.1, 0.9], "stiffness": 6e3},
        {"position": [-0.2, 0.0, 0.15], "direction": [0.6, -0.1, -0.9], "stiffness": 6e3},
    ]
    held = suspension_of(tub(rotor__springs=[*pair, *FOUR]), lb_layout(turn=0.3))
    assert held.mirrored
    change = np.random.default_rng(1).uniform(-0.05, 0.05, (7, len(held.variables)))
    for mounts in held.moved(change):
        matrix = mounts.matrix(np.zeros(3))
        # What a mirror forbids: odd in x, so between x, beta, gamma and y, z, alpha.
        odd, even = [0, 4, 5], [1, 2, 3]
        assert np.abs(matrix[:, odd][:, :, even]).max() <= 1e-11 * np.abs(matrix).max()
        np.testing.assert_allclose(np.linalg.norm(mounts.direction, axis=-1), 1.0, rtol=1e-14)


def lb_layout(**values: Any) -> Any:
    from leblanc.scene.tasks import Layout

    return Layout(**values)


def test_mounts_at_one_place_stay_together_and_within_their_bounds() -> None:
    scene = lb.example("tub")
    held = suspension_of(scene, lb_layout(reach=[0.03, 0.02, 0.01], turn=0.2))
    # Two pairs of places, three ways each; a pair of springs and one of dampers lean two ways each.
    assert [v.leans for v in held.variables] == [False] * 6 + [True] * 4
    ends = np.stack([np.array([v.most for v in held.variables]) * s for s in (-1.0, 1.0)])
    springs, dampers = held.moved(ends)
    for end in range(2):
        place = springs.position[end]
        np.testing.assert_array_equal(place[0], place[2])
        np.testing.assert_array_equal(place[4], dampers.position[end, 0])
        np.testing.assert_array_equal(place[1], place[0] * [-1.0, 1.0, 1.0])
        # The largest lean is that of both ways together.
        lean = np.arccos(np.clip((springs.direction[end, 0] * held.every.direction[0, 0]).sum(), -1, 1))
        assert lean == pytest.approx(math.atan(math.sqrt(2.0) * math.tan(0.2)), rel=1e-9)
    np.testing.assert_allclose(
        np.abs(springs.position[:, 0] - [0.2, 0.0, 0.2]), [[0.03, 0.02, 0.01]] * 2, rtol=1e-12
    )


def test_without_a_mirror_every_mount_is_its_own() -> None:
    uneven = [*FOUR[:3], FOUR[3] | {"stiffness": [4e3, 3e3, 6e3]}]
    held = suspension_of(tub(rotor__springs=uneven, rotor__dampers=[]), lb_layout(turn=0.0))
    assert not held.mirrored and len(held.variables) == 12


def test_the_answer_is_that_of_its_places() -> None:
    """Couplings and frequencies told are those of a scene with the mounts where they were put."""
    scene = lb.example("tub")
    found = best(scene, reach=["20 mm", "50 mm", "20 mm"], turn="10 deg")
    assert found.value < found.baseline
    machine = scene.rotor.machine()
    tables: dict[str, list[Any]] = {"springs": [], "dampers": []}
    for mount in found.mounts:
        kind, k = mount.name.split()
        part = getattr(scene.rotor, f"{kind}s")[int(k) - 1].table()
        part |= {"position": list(mount.position)}
        part |= {} if mount.direction is None else {"direction": list(mount.direction)}
        tables[f"{kind}s"].append(part)
    moved = scene.replace({f"rotor.{name}": parts for name, parts in tables.items()} | {"assumed": []})
    new, origin = moved.rotor.machine(), centre_of_mass(machine)
    stiffness, damping = (Mounts.of(mounts).matrix(origin) for mounts in (new.springs, new.dampers))
    np.testing.assert_allclose(couplings(stiffness)[0], found.couplings["stiffness"][1], atol=1e-12)
    np.testing.assert_allclose(couplings(damping)[0], found.couplings["damping"][1], atol=1e-12)
    total = np.square(couplings(stiffness)).sum() + np.square(couplings(damping)).sum()
    assert found.value == pytest.approx(total, rel=1e-10)
    rates = natural_frequencies(stiffness, mass_matrix(machine, origin))
    np.testing.assert_allclose(found.frequency[1], rates[0], rtol=1e-10)


@kills(f"{ROOM}:_penalised", "found.excess > 0.0", "found.excess > 1e9")
def test_springs_keep_the_static_load() -> None:
    """Springs that want to lie down to uncouple may only do so as far as the tub's sag allows."""
    pair = [
        {"position": [s * 0.2, 0.0, 0.05], "direction": [s * 0.3, 0.0, 0.95], "stiffness": 2e4}
        for s in (1, -1)
    ]
    level = [
        {"position": [s * 0.3, y, 0.0], "stiffness": [1e3, 1e3, 1e3]} for s in (1, -1) for y in (0.1, -0.1)
    ]
    scene = tub(rotor__springs=[*pair, *level], rotor__dampers=[])
    free = best(scene, reach=[0, 0, 0], turn="60 deg", sag="1 m")
    limit = 0.5 * (free.sag_before + free.constraints["sag"].value)
    held = best(scene, reach=[0, 0, 0], turn="60 deg", sag=limit)
    assert free.constraints["sag"].value > limit and held.feasible
    assert held.constraints["sag"].value <= limit * (1.0 + 1e-9)
    assert free.value < held.value < held.baseline
    lost = best(scene, reach=[0, 0, 0], turn="5 deg", sag="1 mm")
    assert not lost.feasible and "no layout within the bounds" in lost.sentence()


@kills(f"{ROOM}:separation", "(low - frequency) / low", "(frequency - low) / low")
def test_separation() -> None:
    assert separation(np.array([5.0, 30.0]), (10.0, 20.0)) == pytest.approx(0.5)
    assert separation(np.array([5.0, 21.0]), (10.0, 20.0)) == pytest.approx(0.05)
    assert separation(np.array([5.0, 12.0]), (10.0, 20.0)) < 0.0
    scene = lb.example("tub")
    found = best(scene, measure="separation", band=["120 rpm", "180 rpm"], reach=[0.03, 0.03, 0.03], turn=0.2)
    assert found.value < found.baseline and found.feasible
    assert separation(found.frequency[1], (4.0 * math.pi, 6.0 * math.pi)) == pytest.approx(
        -found.value, rel=1e-12
    )
    # Random layouts within the bounds do no better.
    held = suspension_of(scene, lb_layout(measure="separation", reach=(0.03, 0.03, 0.03), turn=0.2))
    most = np.array([v.most for v in held.variables])
    tried = np.random.default_rng(2).uniform(-most, most, (2000, most.size))
    rates = natural_frequencies(held.moved(tried)[0].matrix(held.origin), held.mass)
    assert separation(rates, (4.0 * math.pi, 6.0 * math.pi)).max() <= -found.value + 1e-9


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (Path(__file__).parents[4] / "examples/tub.toml").read_text(encoding="utf-8")
    scene = tmp_path / "tub.toml"
    scene.write_text(
        f'{text}\n[optimise]\nobjective = "layout"\n[optimise.layout]\nreach = [0, 0.05, 0]\nturn = 0\n'
    )
    assert main(["optimise", str(scene), "--json", "--out", str(tmp_path / "out")]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["objective"] == "layout" and found["value"] < found["baseline"] and found["feasible"]
    assert set(found["coupling_terms"]) == {"stiffness", "damping", "mass"}
    assert list(found["coupling_terms"]["mass"]) == list(pair_names())
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names >= {"layout.nc", "layout.html", "layout.svg", "places.svg"}
    # The report has the numbers of the JSON: places before and after, frequencies, couplings, the sag.
    page = read_page(tmp_path / "out" / "layout.html")
    for mount in found["mounts"]:
        row = next(row for row in page.rows if row[0] == mount["name"])
        for text, place in zip(row[1:3], (mount["position"], mount["position_before"]), strict=True):
            np.testing.assert_allclose(
                np.array(text.split(", "), dtype=float), np.array(place) * 1e3, atol=0.05
            )
    rates = next(table for table in page.tables if table[0][0] == "mode")[1:]
    for k, key in ((1, "after"), (2, "before")):
        hertz = [2.0 * math.pi * float(row[k]) for row in rates]
        np.testing.assert_allclose(hertz, found["natural_frequency"][key], rtol=1e-3)
    assert any("Sag under the weight" in row[0] for row in page.rows)
    assert page.captions == 2 and all(page.alts)
    assert main(["optimise", str(scene), "--out", str(tmp_path / "out")]) == 0
    assert "squared couplings" in capsys.readouterr().out


def test_words() -> None:
    found, again = (best(lb.example("tub"), reach=[0, 0.05, 0], turn=0) for _ in range(2))
    assert again.to_json() == found.to_json()
    assert len(table(found, "mount").rows) == 10
    assert {row[0] for row in table(found, "coupling").rows} <= set(pair_names())
    assert "none about the centre of mass" in labels(found)["Couplings of the mass"]
    figure = found.plot()
    assert len(figure.axes) == 3


def test_places_are_drawn_where_they_are() -> None:
    """Along the axis and from the side, in millimetres; what stays has no arrow."""
    found = best(lb.example("tub"), reach=[0, 0.05, 0], turn=0)
    front, side = places_figure(found).axes
    for axes, across in ((front, 0), (side, 1)):
        ends = [(line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines]
        drawn = {(round(float(x), 6), round(float(y), 6)) for x, y in ends}
        for mount in found.mounts:
            for place in (mount.position, mount.position_before):
                assert (round(1e3 * place[across], 6), round(1e3 * place[2], 6)) in drawn
    # Nothing moves across the axis or up: arrows are in the side view alone.
    assert not front.texts and side.texts


def test_a_layout_that_sags_too_much_is_doubtful(tmp_path: Path) -> None:
    found = best(lb.example("tub"), reach=[0, 0.05, 0], turn=0)
    limits = {"sag": replace(found.constraints["sag"], limit=1e-3, satisfied=False)}
    sunk, what, path = replace(found, constraints=limits), about(lb.example("tub")), tmp_path / "layout.html"
    assert list(failed(sunk)) == ["Sag under the weight"]
    blocks = [block for block in sunk.blocks() if not isinstance(block, Picture)]
    write_page(sunk.title, blocks, what, {}, path)
    text = path.read_text(encoding="utf-8")
    assert "Caution: sag under the weight" in text
    assert "exceeds it least" in text


def test_other_rotors_have_no_mounts() -> None:
    with pytest.raises(InputError, match="tub for the objective layout"):
        lb.optimise(lb.example("two_plane_rig"), objective="layout")
    with pytest.raises(InputError, match="one of working_speed"):
        optimise_scene(lb.example("horizontal_rig"), objective="layout")
    with pytest.raises(InputError, match="some mount may move"):
        best(lb.example("tub"), reach=[0, 0, 0], turn=0)
    lone = [{"position": [0.0, 0.0, 0.1], "stiffness": [1e3, 1e3, 1e3]}]
    with pytest.raises(InputError, match="hold the tub"):
        best(tub(rotor__springs=lone))
    with pytest.raises(SceneError, match="measure"):
        lb.example("tub").replace({"optimise": {"layout": {"measure": "beauty"}}})
