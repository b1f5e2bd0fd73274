"""What would end a self-excited whirl: each change made in the machine file and looked at anew."""

from __future__ import annotations

import math

import numpy as np
import pytest

import leblanc as lb
from leblanc.liquid.choose import prepare
from leblanc.scene.scene import Scene
from leblanc.studies.explain.answer import Cure
from leblanc.studies.explain.cures import cures
from leblanc.studies.explain.study import explain_scene
from solvers.whirl.edges import Bands, unstable_bands
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills

CURES = "leblanc.studies.explain.cures"


def bands(scene: Scene) -> Bands:
    """Bands of self-excited whirl of a scene over its speeds."""
    machine = prepare(scene, free=True)
    return unstable_bands(machine.rotor, [scene.fills], machine.speed[[0, -1]], machine.waves)[0]


def damped(scene: Scene, times: float) -> Scene:
    """With so many times the damping of the support."""
    path = "rotor.damping" if scene.rotor.damping_ratio is None else "rotor.damping_ratio"
    return scene.replace({path: times * getattr(scene.rotor, path.rpartition(".")[2])})


def found(name: str) -> dict[str, Cure]:
    """Cures of an example by their kind."""
    scene = lb.example(name)
    return {cure.kind: cure for cure in cures(prepare(scene, free=True), lambda: bands(scene))}


@kills(f"{CURES}:_by_damping", "2.0 * rotor.damping_ratio, twice", "2.0 * rotor.damping_ratio, own")
@kills(f"{CURES}:_by_damping", "if change > 0.0", "if change < 0.0")
@kills(
    f"{CURES}:_by_damping",
    "if not any_growth(damped(ratio / rotor.damping_ratio), [fills], ends, law)[0]",
    "if True",
)
@pytest.mark.parametrize(("name", "how"), [("centrifuge", "wider"), ("washing_machine", "narrower")])
def test_damping_of_the_support(name: str, how: str) -> None:
    """A first dose may widen the band; the ratio that ends it does, seven tenths of it do not."""
    scene, cure = lb.example(name), found(name)
    ratio = prepare(scene, free=True).rotor.damping_ratio
    twice = bands(damped(scene, 2.0))
    assert cure["twice the damping"].bands == twice and cure["twice the damping"].text.endswith(how)
    own = bands(scene)
    assert (sum(b - a for a, b in twice) > sum(b - a for a, b in own)) is (how == "wider")
    ends = cure["damping"].value
    assert not bands(damped(scene, ends / ratio)) and bands(damped(scene, ends / ratio / math.sqrt(2.0)))


@kills(f"{CURES}:_by_viscosity", "~any_growth(rotor, rows", "any_growth(rotor, rows")
@kills(f"{CURES}:_by_viscosity", "_THICKER[calm[0]]", "_THICKER[calm[-1]]")
def test_viscosity() -> None:
    """The least of those tried: without a band, the one before with one."""
    scene = lb.example("washing_machine")
    cure = found("washing_machine")["viscosity"]
    own = scene.fills[0].liquid.viscosity

    def thicker(times: float) -> Scene:
        liquid = {"density": scene.fills[0].liquid.density, "viscosity": own * times}
        return scene.replace({f"chambers.{k}.liquid": liquid for k in range(len(scene.fills))})

    assert not bands(thicker(cure.value / own)) and bands(thicker(cure.value / own / 10.0**0.25))
    assert f"{cure.value / own:.3f} times" in cure.text


@kills(f"{CURES}:_by_volume", "max(side) if less else min(side)", "min(side) if less else max(side)")
@kills(f"{CURES}:_by_volume", "[v for v in free if v < own]", "[v for v in free if v > own]")
def test_volume() -> None:
    """The next volumes without a band: less than the scene's, and a full chamber."""
    scene, cure = lb.example("washing_machine"), found("washing_machine")
    less, own = cure["less liquid"].value, sum(fill.volume for fill in scene.fills)
    shares = [fill.volume / own for fill in scene.fills]
    step = sum(fill.chamber.capacity for fill in scene.fills) / 24.0

    def with_volume(volume: float) -> Scene:
        return scene.replace({f"chambers.{k}.volume": volume * share for k, share in enumerate(shares)})

    assert 0.0 < less < own and not bands(with_volume(less)) and bands(with_volume(less + step))
    assert "full" in cure["more liquid"].text and cure["more liquid"].value > own


@kills(f"{CURES}:_by_volume", "own * _LESS", "own * _LESS[:0]")
def test_a_little_liquid_is_looked_at_too() -> None:
    """Of less than a step of the fills, some of it may still be too much."""
    scene = lb.example("washing_machine")
    step = scene.fills[0].chamber.capacity / 24.0
    scene = damped(scene.replace({"chambers.0.volume": 0.9 * step}), 0.3)
    assert bands(scene)
    (less,) = [
        cure for cure in cures(prepare(scene, free=True), lambda: bands(scene)) if cure.kind == "less liquid"
    ]
    assert 0.0 < less.value < 0.9 * step and not bands(scene.replace({"chambers.0.volume": less.value}))


@kills(
    f"{CURES}:_by_walls",
    "sector_frequencies(count, log)[0] >= 1.0",
    "sector_frequencies(count, log)[0] >= 0.8",
)
def test_walls_through_the_surface() -> None:
    """No band with so many, by elements in every sector; one with two fewer: the rule holds at any speed."""
    scene = damped(lb.example("washing_machine").replace({"model.friction": "none"}), 0.0)
    cure = found("washing_machine")["walls"]
    tip = scene.fills[0].chamber.inner_radius

    def growth(count: int) -> float:
        walls = scene.replace({"chambers.0.baffles": {"count": count, "tip_radius": tip}})
        machine = prepare(walls, free=True)
        speed = np.linspace(*machine.speed[[0, -1]], 60)
        return float(np.nanmax(asynchronous_growth(machine.rotor, walls.fills, speed, machine.waves)[0]))

    assert growth(int(cure.value)) < 1e-3 < growth(int(cure.value) - 2)


def test_where_nothing_is_looked_for() -> None:
    """No cures of a calm machine, nor of one that tilts; in JSON and text where there are some."""
    calm = damped(lb.example("washing_machine"), 4.0)
    assert not bands(calm) and not explain_scene(calm).cures
    tilting = lb.example("two_plane_rig")
    assert not cures(prepare(tilting, free=True), lambda: bands(tilting))
    told = explain_scene(lb.example("washing_machine"))
    assert [each["kind"] for each in told.to_json()["cures"]] == list(found("washing_machine"))
    assert "cures" not in explain_scene(calm).to_json()
