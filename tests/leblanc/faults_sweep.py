"""Seeded faults of sweeps: distributions, designs, shares of the variance, rows of the store."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.faults import Fault
from tests.leblanc.test_sampling import (
    check_designs_are_even,
    check_distributions,
    check_grid,
    check_saltelli_members,
)
from tests.leblanc.test_sensitivity import (
    check_choice_given_data,
    check_ishigami_given_data,
    check_ishigami_saltelli,
    check_linear_grid,
)
from tests.leblanc.test_sweep import (
    check_answers_stand_at_their_samples,
    check_sampled_scenes,
    check_statistics,
)


def check_rows() -> None:
    """Each row of a store is the answer of its own scene."""
    with tempfile.TemporaryDirectory() as folder:
        check_answers_stand_at_their_samples(Path(folder))


FAULTS: tuple[Fault, ...] = (
    Fault(
        "leblanc.studies.sweep.distributions",
        "(self.high - self.low) * u",
        "self.high * u",
        check_distributions,
    ),
    Fault(
        "leblanc.studies.sweep.distributions",
        "self.mean + self.deviation",
        "self.mean - self.deviation",
        check_distributions,
    ),
    Fault(
        "leblanc.studies.sweep.distributions",
        "math.log(self.factor)",
        "math.log10(self.factor)",
        check_distributions,
    ),
    Fault("leblanc.studies.sweep.distributions", "self.median * np.exp(", "np.exp(", check_distributions),
    Fault(
        "leblanc.studies.sweep.distributions",
        "np.floor(u * len(self.options))",
        "np.rint(u * len(self.options))",
        check_distributions,
    ),
    Fault(
        "leblanc.studies.sweep.sampling",
        "np.unravel_index(np.arange(start, stop), tuple(one.size for one in levels))",
        'np.unravel_index(np.arange(start, stop), tuple(one.size for one in levels), order="F")',
        check_grid,
    ),
    Fault("leblanc.studies.sweep.sampling", "taken[-1] = True", "taken[-1] = False", check_saltelli_members),
    Fault(
        "leblanc.studies.sweep.sampling",
        "np.eye(width, dtype=bool)",
        "~np.eye(width, dtype=bool)",
        check_saltelli_members,
    ),
    Fault(
        "leblanc.studies.sweep.sampling",
        "engine.random(stop - start - 1)",
        "engine.random(stop - start - 1) ** 2",
        check_designs_are_even,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "/ count) / np.sum(centred**2)",
        ") / np.sum(centred**2)",
        check_linear_grid,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "centred = output - output.mean()",
        "centred = output",
        check_linear_grid,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "np.unique(column, return_inverse=True)",
        "np.unique(np.sign(column), return_inverse=True)",
        check_linear_grid,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "place + rng.random(output.size)",
        "rng.random(output.size)",
        check_choice_given_data,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "output / np.std(output)",
        "np.sort(output) / np.std(output)",
        check_ishigami_given_data,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "np.array([first_order(a, one, b) for one in swapped])",
        "np.array([first_order(b, one, a) for one in swapped])",
        check_ishigami_saltelli,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "np.array([total_order(a, one, b) for one in swapped])",
        "np.array([total_order(b, one, a) for one in swapped])",
        check_ishigami_saltelli,
    ),
    Fault(
        "leblanc.studies.sweep.sensitivity",
        "swapped = whole[:, 1:-1].T",
        "swapped = whole[:, -2:0:-1].T",
        check_ishigami_saltelli,
    ),
    Fault("leblanc.studies.sweep.summary", "known.std(ddof=1)", "known.std()", check_statistics),
    Fault(
        "leblanc.studies.sweep.summary",
        "column[np.isfinite(column)]",
        "column[~np.isnan(column)]",
        check_statistics,
    ),
    Fault("leblanc.studies.sweep.scenes", "parts[k] = Chamber", "parts[0] = Chamber", check_sampled_scenes),
    Fault(
        "leblanc.studies.sweep.scenes", 'if ("rotor",) in touched:', "if not touched:", check_sampled_scenes
    ),
    Fault(
        "leblanc.studies.sweep.block",
        "values[name][places] = value",
        "values[name][places] = value[::-1]",
        check_rows,
    ),
    Fault(
        "leblanc.studies.sweep.outputs",
        "np.fmax.reduce(values[name], axis=1)",
        "np.fmin.reduce(values[name], axis=1)",
        check_rows,
    ),
    Fault("leblanc.studies.sweep.outputs", "values[name][:, -1]", "values[name][:, 0]", check_rows),
    Fault(
        "leblanc.studies.sweep.sweep",
        "field_values(field, drawn[:, j])",
        "field_values(field, drawn[::-1, j])",
        check_rows,
    ),
)
