"""Many scenes at once: each answer is what `run` gives for the scene alone."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from fluid.friction.laws import Friction
from leblanc.scene.scene import Scene, load_scene
from leblanc.studies.run.answer import RunAnswer, phase
from leblanc.studies.run.study import run_scene
from leblanc.studies.sweep.batch import Answers, answer_scenes
from meshes.errors import InputError
from tests.mutants import kills

EXAMPLES = Path(__file__).parents[3] / "examples"
COUNT = 7
# Baffles that cut the liquid into compartments, which have waves of their own.
CUT = {"model.liquid": "kdv", "chambers.0.baffles": {"count": 4}}


def scene(name: str, share: float = 1.0) -> Scene:
    """An example at a few speeds, with a share of its liquid."""
    found = load_scene(EXAMPLES / f"{name}.toml")
    chambers = tuple(one.holding(share * one.volume) for one in found.chambers)
    return found.altered(chambers=chambers, speeds=found.speeds.altered(count=COUNT))


def outputs(record: RunAnswer) -> dict[str, np.ndarray]:
    """What `run` says, under the names of the answers."""
    one, whirl = record.response, record.whirl
    assert whirl is not None
    shared = (
        "speed",
        "liquid_offset",
        "liquid_angle",
        "dry_patch",
        "stable",
        "in_range",
        "converged",
        "model",
    )
    return {name: getattr(one, name) for name in shared} | {
        "amplitude": record.amplitude,
        "amplitude_dry": record.amplitude_dry,
        "phase": phase(one.deflection),
        "growth": whirl.growth,
        "whirl_speed": whirl.whirl_speed,
        "error_estimate": record.error_estimate,
        "peak_amplitude": np.array(record.peak["amplitude"]),
        "peak_amplitude_dry": np.array(record.peak_dry["amplitude"]),
    }


def mixed() -> list[Scene]:
    """Planar and other rotors, upright and lying, several models, frictions and numbers of chambers."""
    asked = scene("centrifuge")
    rig = scene("horizontal_rig", 0.3)
    return [
        scene("tub"),
        scene("horizontal_rig"),
        rig.altered(model=rig.model.altered(liquid="statics", friction=Friction("linear", 3.0))),
        scene("vertical_rig", 0.4),
        asked.altered(model=asked.model.altered(liquid="linear")),
        scene("washing_machine", 0.0),
        scene("runup"),
    ]


@pytest.fixture(scope="module")
def alone() -> list[dict[str, np.ndarray]]:
    """What `run` says of each of them, asked before a mutant is in place."""
    return [outputs(run_scene(one)) for one in mixed()]


@kills(
    "leblanc.studies.sweep.batch:_planar",
    "gravity = np.array([machine.axial_gravity for machine in prepared])",
    "gravity = np.zeros(len(prepared))",
)
@kills("leblanc.studies.sweep.batch:_planar", "(growth <= 0.0)", "(growth == growth)")
@kills("leblanc.studies.sweep.batch:_planar", "phase(answer.deflection)", "-phase(answer.deflection)")
@kills(
    "leblanc.studies.sweep.batch:_peaks",
    "zip(answers, between, strict=True)",
    "zip(answers, answers, strict=True)",
)
@kills("leblanc.studies.sweep.outputs:together", "np.concatenate(each)[order]", "np.concatenate(each)")
def test_each_is_what_run_gives(alone: list[dict[str, np.ndarray]]) -> None:
    """Field by field, to the rounding of sums whose terms are added in another order."""
    answers = answer_scenes(mixed())
    for k, told in enumerate(alone):
        for name, value in told.items():
            mine = getattr(answers, name)[k]
            if value.dtype.kind == "f":
                # Growth is a small difference of large frequencies.
                scale = 1e-9 * float(np.max(answers.speed[k])) if name == "growth" else 1e-18
                np.testing.assert_allclose(mine, value, rtol=1e-9, atol=scale)
            else:
                np.testing.assert_array_equal(mine, value)
    assert any(set(row) == {"linear", "statics"} for row in answers.model.tolist())
    assert answers.dry_patch.any() and not answers.stable.all() and not answers.in_range.all()


@pytest.fixture(scope="module")
def together() -> Answers:
    return answer_scenes(mixed())


def test_same_scenes_same_bits(together: Answers) -> None:
    first, again = together, answer_scenes(mixed())
    for field in fields(Answers):
        one, other = getattr(first, field.name), getattr(again, field.name)
        assert (one is None and other is None) or one.tobytes() == other.tobytes()


def test_order_is_kept(together: Answers) -> None:
    forward, backward = together, answer_scenes(mixed()[::-1])
    np.testing.assert_array_equal(forward.speed, backward.speed[::-1])
    np.testing.assert_allclose(forward.amplitude, backward.amplitude[::-1], rtol=1e-12)


@pytest.mark.parametrize(
    ("scenes", "field"),
    [
        ([], "scenes"),
        ([scene("runup"), load_scene(EXAMPLES / "runup.toml")], "scenes"),
        ([scene("vibratory_table")], "rotor.kind"),
        ([scene("runup").replace(CUT)], "model.liquid"),
    ],
)
def test_what_cannot_be_answered_is_said(scenes: list[Scene], field: str) -> None:
    with pytest.raises(InputError) as caught:
        answer_scenes(scenes)
    assert caught.value.field == field
