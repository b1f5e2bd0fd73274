"""Other names of what a script may hold: old ones warn and lead to the new ones, for one version."""

from __future__ import annotations

from functools import reduce
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any
from warnings import warn

if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec

_GONE = "0.3"  # version in which these are no longer read
# "module:name" of a class as it was, and as it is. The modules are gone.
NAMES = {
    "leblanc.results.exciter:ExciterResult": "leblanc.wings.exciter.answer:ExciterAnswer",
    "leblanc.results.explanation:Explanation": "leblanc.studies.explain.answer:ExplainAnswer",
    "leblanc.results.fit:FitResult": "leblanc.studies.fit.answer:FitAnswer",
    "leblanc.results.layer:FreeWaveResult": "leblanc.studies.layer.answer:FreeWaveAnswer",
    "leblanc.results.layer:LayerPeriodsResult": "leblanc.studies.layer.answer:PeriodsAnswer",
    "leblanc.results.layer:LayerResult": "leblanc.studies.layer.answer:LayerAnswer",
    "leblanc.results.liquid:ModesResult": "leblanc.studies.modes.answer:ModesAnswer",
    "leblanc.results.liquid:VolumeResult": "leblanc.studies.volume.answer:VolumeAnswer",
    "leblanc.results.machine.layout:LayoutResult": "leblanc.studies.optimise.layout.answer:LayoutAnswer",
    "leblanc.results.magnetic.control:MagneticResult": "leblanc.wings.magnetic.answer:MagneticAnswer",
    "leblanc.results.magnetic.explanation:MagneticExplanation": (
        "leblanc.wings.magnetic.answer:MagneticExplanation"
    ),
    "leblanc.results.optimum:OptimumResult": "leblanc.studies.optimise.answer:OptimumAnswer",
    "leblanc.results.races.chart:BallChart": "leblanc.studies.map.balls.answer:BallChart",
    "leblanc.results.races.design:BallDesignResult": "leblanc.studies.optimise.balls.answer:BallDesignAnswer",
    "leblanc.results.models.comparison:Comparison": "leblanc.studies.compare.answer:CompareAnswer",
    "leblanc.results.races.numbers:BallExplanation": (
        "leblanc.studies.explain.balls.answer:BallExplainAnswer"
    ),
    "leblanc.results.races.states:BallsResult": "leblanc.studies.balls.answer:BallsAnswer",
    "leblanc.results.response:RunResult": "leblanc.studies.run.answer:RunAnswer",
    "leblanc.results.runup:RunupResult": "leblanc.studies.runup.answer:RunupAnswer",
    "leblanc.results.spindles.bearing:BearingResult": "leblanc.studies.bearing.answer:BearingAnswer",
    "leblanc.results.spindles.unit:SpindleResult": "leblanc.wings.spindle.answer:SpindleAnswer",
    "leblanc.results.sweep:SweepResult": "leblanc.studies.sweep.answer:SweepAnswer",
    "leblanc.results.whirl_map:WhirlMap": "leblanc.studies.map.answer:WhirlMap",
}
# Attributes of answers as they were, by class, and their paths as they are.
ATTRIBUTES = {
    "ExciterAnswer": {
        "critical": "critical_speed",
        "fast": "amplitude_fast",
        "numbers": "dimensionless",
        "printed_critical": "critical_speed_printed",
        "slow": "amplitude_slow",
        "stuck": "stuck_speeds",
    },
    "LayoutAnswer": {"mass_couplings": "mass_coupling"},
    "RunAnswer": {"branch_amplitude": "response.branch_amplitude"},
    "RunupAnswer": {"liquid_position": "history.liquid_position"},
    "SweepAnswer": {"sensitivities": "sensitivity", "single": "outputs"},
    "WhirlMap": {"branches": "large.branches"},
}
# The field's terms for names of answers that scripts know.
ALIASES = {"annulus_speed": "carried_from", "time_domain_at": "held_at"}
_MODULES = {name.partition(":")[0] for name in NAMES}


def attribute(answer: Any, name: str) -> Any:
    """What an answer has under another name.

    Raises
    ------
    AttributeError : it never had that name
    """
    if name in ALIASES:
        return getattr(answer, ALIASES[name])
    path = ATTRIBUTES.get(type(answer).__name__, {}).get(name)
    if path is None:
        raise AttributeError(f"{type(answer).__name__!r} object has no attribute {name!r}")
    _warn(name, path, 4)
    return reduce(
        lambda record, part: None if record is None else getattr(record, part), path.split("."), answer
    )


def _warn(old: str, new: str, level: int) -> None:
    warn(f"{old} is {new} now; the old name goes with {_GONE}", DeprecationWarning, stacklevel=level)


class Finder:
    """Finds modules that are gone; asked for what nobody else finds."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        """Spec of a module that is gone, or of a package above one."""
        if not any(f"{gone}.".startswith(f"{name}.") for gone in _MODULES):
            return None
        from importlib.machinery import ModuleSpec

        return ModuleSpec(name, Finder(), is_package=name not in _MODULES)  # type: ignore[arg-type]

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """As Python makes it."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """Lead its names on when they are asked for."""

        def found(name: str) -> Any:
            old = f"{module.__name__}:{name}"
            if old not in NAMES:
                raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
            place, _, there = NAMES[old].partition(":")
            _warn(old.replace(":", "."), f"{place}.{there}", 3)
            return getattr(import_module(place), there)

        module.__getattr__ = found  # type: ignore[method-assign]
