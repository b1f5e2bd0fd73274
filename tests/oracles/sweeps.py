"""Small studies on a rig, and what tests ask of their stores."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import astuple
from pathlib import Path

import numpy as np
import pytest

from leblanc.scene.scene import Scene, jeffcott
from leblanc.studies.sweep.batch import Answers
from leblanc.studies.sweep.plan import Sweep, load_sweep

ROOT = Path(__file__).parents[2]

SCENE = """
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
height = "20 mm"
volume = "10 ml"
liquid = "water"

[[chambers]]
radius = "50 mm"
height = "20 mm"
volume = "10 ml"
liquid = { density = 900, viscosity = "1 mm^2/s" }

[speeds]
start = "1200 rpm"
stop = "1500 rpm"
count = 2

[model]
liquid = "statics"
friction = "stokes"
"""

STUDY = """
scene = "scene.toml"
method = "sobol"
samples = 256
seed = 11

[vary]
"rotor.mass" = { uniform = ["3 kg", "12 kg"] }
"chambers.0.volume" = { uniform = ["10 ml", "250 ml"] }
"chambers.1.liquid" = { choice = ["water", "brine", { density = 900, viscosity = 0 }] }
"""

# Both fills from where the wall is dry in part to where it is wet, in the other order than the scene's.
SMOOTH_FILLS = """
scene = "scene.toml"
method = "sobol"
samples = 48
seed = 5

[vary]
"chambers.1.volume" = { uniform = ["0.9 ml", "30 ml"] }
"chambers.0.volume" = { uniform = ["0.9 ml", "30 ml"] }
"""


def write_study(folder: Path, study: str = STUDY, scene: str = SCENE) -> Path:
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    path = folder / "study.toml"
    path.write_text(study, encoding="utf-8")
    return path


def study_in(folder: Path, study: str = STUDY, scene: str = SCENE) -> Sweep:
    return load_sweep(write_study(folder, study, scene))


def tree(folder: Path) -> dict[str, bytes]:
    """Every file below a folder, byte for byte."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def added_mass_answers(scenes: Sequence[Scene]) -> Answers:
    """What the scenes would answer were all walls wet: as fast as it is simple."""
    speed = np.array([scene.speed_array() for scene in scenes])
    mass, stiffness, damping, unbalance, added = (
        np.array(values)[:, None]
        for values in zip(
            *(
                (
                    *astuple(jeffcott(scene)),
                    sum(fill.full_mass for fill in scene.fills),
                )
                for scene in scenes
            ),
            strict=True,
        )
    )
    wet, dry = (
        speed**2 * unbalance / (stiffness - m * speed**2 + 1j * damping * speed) for m in (mass + added, mass)
    )
    yes = np.ones(speed.shape, dtype=bool)
    return Answers(
        speed=speed,
        amplitude=np.abs(wet),
        amplitude_dry=np.abs(dry),
        phase=np.angle(wet),
        liquid_offset=np.abs(wet),
        liquid_angle=np.angle(wet),
        growth=-1e-3 * speed,
        whirl_speed=0.5 * speed,
        dry_patch=~yes,
        stable=yes,
        in_range=yes,
        converged=yes,
        model=np.full(speed.shape, "statics"),
        error_estimate=np.full(speed.shape, 1e-3),
        peak_amplitude=np.abs(wet).max(axis=1),
        peak_amplitude_dry=np.abs(dry).max(axis=1),
    )


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Answers in a closed form in place of the real ones."""
    monkeypatch.setattr("leblanc.studies.sweep.batch.answer_scenes", added_mass_answers)


def leblanc(*arguments: str, cwd: Path, **options: object) -> subprocess.Popen[str]:
    """The command in a process of its own."""
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from leblanc.cli import main; sys.exit(main())"
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONWARNINGS"}
    given = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
    return subprocess.Popen(  # type: ignore[call-overload, no-any-return]
        [sys.executable, "-W", "error::UserWarning", "-c", code, "sweep", *arguments],
        cwd=cwd,
        env=environment,
        text=True,
        **given,
    )
