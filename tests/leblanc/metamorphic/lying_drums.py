"""Lying drums with baffles, drawn at random and run from rest: each comes to its end, or says why not.

`python -m tests.leblanc.metamorphic.lying_drums --count 300` counts how they end; `--seed 17` runs one.
"""

from __future__ import annotations

import argparse
from collections import Counter

from leblanc.scene.scene import scene_from_table
from leblanc.studies.runup.answer import RunupAnswer
from leblanc.studies.runup.study import runup_scene
from solvers.layer.records import Outcome
from tests.oracles.random_machines import lying_drum

# A motor that stands and a rotor beyond its wall are machines that do so.
PHYSICAL = (Outcome.DONE, Outcome.STOPPED)


def run(seed: int, off: float = 0.0) -> RunupAnswer:
    """The run of a seed's drum, without its estimate of the error; mass and volume off by a share."""
    table = lying_drum(seed)
    table["rotor"]["mass"] *= 1.0 + off
    table["chambers"][0]["volume"] *= 1.0 + off
    return runup_scene(scene_from_table(table, f"seed {seed}"), check=False)


def outcome(result: RunupAnswer) -> str:
    """How a run ended: "sound", "beyond its wall", or what is wrong with it."""
    if result.outcome not in PHYSICAL:
        return f"broke off: {result.outcome.name}"
    if result.energy.faults:
        return "energy: " + "; ".join(result.energy.faults)
    if result.outcome is Outcome.STOPPED:
        return "the drum stands"
    return "beyond its wall" if result.violations else "sound"


PHYSICAL_REASONS = ("sound", "beyond its wall", "the drum stands")


def main() -> int:
    """Count how the drums of some seeds end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int)
    asked = parser.parse_args()
    seeds = [asked.seed] if asked.seed is not None else range(asked.first, asked.first + asked.count)
    counts: Counter[str] = Counter()
    for seed in seeds:
        result = run(seed)
        found = outcome(result)
        counts[found if found in PHYSICAL_REASONS else "not physical"] += 1
        crest = float(result.history.largest.max()) / result.chambers[0].radius
        print(
            f"{seed} {found} [{result.energy_error:.1e}, {crest:.3f} R, {result.steps}] {result.reason}",
            flush=True,
        )
    print(dict(counts))
    return int(counts["not physical"] > 0)


if __name__ == "__main__":
    raise SystemExit(main())
