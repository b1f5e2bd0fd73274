"""How near a number must come to the kept one: one table, each entry with its reason."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fnmatch import fnmatchcase


@dataclass(frozen=True)
class Tolerance:
    """Bound of a difference: the larger of the two.

    Parameters
    ----------
    relative : to the largest magnitude in the kept array
    absolute : in the unit of the value
    ordered : False if only the values of an array count, not their places
    skipped : values at the beginning of an array that are not held
    """

    relative: float = 0.0
    absolute: float = 0.0
    ordered: bool = True
    skipped: int = 0

    def times(self, share: float) -> Tolerance:
        """A share of it."""
        return replace(self, relative=share * self.relative, absolute=share * self.absolute)


DEFAULT = Tolerance(relative=1e-12)
EXACT = Tolerance()

# (commands, paths, tolerance, reason): the first that fits holds. The numbers in the reasons are the largest
# differences seen when inputs were shaken by 1e-15 (`python -m tests.net shake`) and when all ran with the
# arithmetic of another processor (no fused multiply-add, older BLAS kernels); the tolerances leave a factor
# of 10 or so.
TABLE: tuple[tuple[str, str, Tolerance, str], ...] = (
    ("*", "*#", EXACT, "lengths of lists"),
    ("*", "*mass_error", Tolerance(absolute=1e-12), "rounding itself: 1e-15 of the mass"),
    ("*", "*fem_error", Tolerance(absolute=1e-12), "difference of two nearly equal volumes: 2e-15"),
    (
        *("*", "*.deviation*", Tolerance(1e-12, 1e-15)),
        "of samples that are all alike it is rounding: 3e-19 m",
    ),
    ("compare-*", "*largest_difference*", Tolerance(absolute=2e-12), "difference of answers of two models"),
    # The exact wave
    ("*", "*force_gap", Tolerance(absolute=1e-9), "of two forces, rounding: 4e-14"),
    (
        *("layer-potential*", "*largest_whirl", Tolerance(relative=1e-2)),
        "the last step of a continuation; what the waves are near their end decides where it falls",
    ),
    (
        *("run-exact", "*ripple*", Tolerance(relative=1e-2)),
        "short waves that the jump of a guess leaves behind, 3 % of the offset: 7e-4",
    ),
    (
        *("run-exact", "*energy_error*", Tolerance(absolute=1e-3)),
        "what turns leave that have settled to 1e-3: 2.8e-4 on another processor",
    ),
    ("run-exact", "*error*", Tolerance(absolute=1e-5), "of two such runs; see the next"),
    ("run-exact", "*", Tolerance(relative=1e-3), "held until it has settled, not to rounding: 5e-5 shaken"),
    ("layer-*", "*error_estimate", Tolerance(absolute=1e-10), "rounding of two waves: 1e-12"),
    ("layer-potential*", "*", Tolerance(1e-9, 1e-12), "Newton's method: 8e-13; time steps of 1e-10"),
    ("layer-free*", "*", Tolerance(1e-10, 1e-13), "the same: 1e-13"),
    # Estimates of errors
    (
        *("modes-baffles", "*error_estimate*", Tolerance(relative=1e-4)),
        "6e-6; see the other values of this command",
    ),
    (
        *("modes-*", "*error_estimate*", Tolerance(absolute=1e-11)),
        "difference of the frequencies on two meshes: 7e-16",
    ),
    (
        *("*", "*error_estimate*", Tolerance(1e-7, 1e-11)),
        "difference of the answers of two models: 1.4e-9, and 1e-14 where the models agree",
    ),
    ("explain-*", "*error", Tolerance(1e-7, 1e-11), "the same"),
    ("trade-*", "*error", Tolerance(absolute=1e-11), "difference of the answers of two models: 1e-15"),
    # The layout of mounts
    ("optimise-layout", "*evaluations", Tolerance(relative=0.5), "a population is together, or not yet"),
    ("optimise-layout", "*", Tolerance(1e-5, 1e-12), "the end of a way downhill: 4e-7"),
    # Cases against sources
    (
        *("validate-two_plane", "*", Tolerance(1e-6, 1e-9)),
        "edges halved down to 6e-8 rad/s of signs of eigenvalues",
    ),
    (
        *("validate-exciter", "*", Tolerance(1e-6)),
        "traces after 600 turns, by steps and by a method with its own step control",
    ),
    # The machine at its speeds
    (
        *("explain-spinning_top", "*", Tolerance(1e-11, 1e-11)),
        "differences of moments, soft beside stiff supports: 7e-13",
    ),
    (
        *("run-two_plane_rig", "*backward*", Tolerance(absolute=1e-15)),
        "supports are equal all round, so nothing whirls backwards: 1e-19 m",
    ),
    ("run-top_loader", "*backward*", Tolerance(absolute=1e-15), "the same"),
    (
        *("run-top_loader", "*growth*", Tolerance(relative=1e-7)),
        "eigenvalues of matrices with soft rods and stiff coordinates beside one another: 5e-9 elsewhere",
    ),
    ("run-top_loader", "*whirl_speed*", Tolerance(relative=1e-7), "the same: 1.1e-9"),
    ("explain-*", "*held.seconds", Tolerance(relative=1e-6), "follows from a growth rate: 5.9e-9"),
    (
        *("run-two_plane_rig", "*.campbell_direction.*", Tolerance(1e-12, ordered=False, skipped=4)),
        "at rest two modes have one frequency: which is followed first, and how it turns, is rounding",
    ),
    ("run-two_plane_rig", "*.campbell_*", Tolerance(1e-12, ordered=False), "the same: modes change places"),
    (
        *("run-top_loader", "*.campbell_direction.*", Tolerance(1e-11, ordered=False, skipped=8)),
        "the same, of two pairs of modes",
    ),
    ("run-top_loader", "*.campbell_*", Tolerance(1e-11, ordered=False), "the same"),
    (
        *("run-vertical_rig", "*", Tolerance(relative=1e-11)),
        "a damping ratio of 0.01 multiplies rounding by 50 at the resonance: 2e-13",
    ),
    *(
        (
            *("run-blood_pump", path, Tolerance(1e-4, 1e-10)),
            "stiff steps that keep 1e-8 of each state; a current follows the rate: 1.1e-7",
        )
        for path in ("*trial*", "*displacement*", "*control_current*")
    ),
    (
        *("run-blood_pump", "*", Tolerance(relative=1e-8)),
        "eigenvalues 1e5 times apart, margins by roots of them",
    ),
    ("run-spindle", "*.checks.*", Tolerance(absolute=1e-9), "rounding itself: 4e-12"),
    (
        *("run-spindle", "*", Tolerance(relative=1e-8)),
        "weak damping at a natural frequency: real parts 3e-10, shapes 4e-11 shaken",
    ),
    ("run-vibratory_table", "*.checks[]*", Tolerance(relative=1e-9), "integrated in time: 2e-12"),
    ("map-closed_baffles", "*", Tolerance(relative=1e-6), "the matrices of baffled liquid: 9e-9; see below"),
    ("map-balls_light", "*edge*", Tolerance(relative=3e-8), "curves past a sharp turn: 1.1e-9 shaken"),
    ("map-balls*", "*growth*", Tolerance(relative=1e-10), "roots next to the axis: 1.5e-12 shaken"),
    ("map-balls*", "*edge*", Tolerance(relative=1e-10), "curves by Newton's method: 3e-13 shaken"),
    ("map-long_rotor", "*edge*", Tolerance(relative=1e-10), "the same: 7e-13"),
    ("run-tub_balls", "*growth*", Tolerance(relative=1e-10), "multipliers of half a turn: 1.3e-13 shaken"),
    ("explain-balls*", "*growth*", Tolerance(relative=1e-10), "as of the map"),
    # Searches
    (
        *("optimise-balls", "*tried*", Tolerance(relative=3e-9)),
        "designs next to where balls hold just enough: growth by 2.4e-11 shaken",
    ),
    (
        *("optimise-front", "*front*", Tolerance(relative=0.03)),
        "a front through sampled fills, thinned where they lie close: rounding takes a neighbour, 2e-3",
    ),
    ("optimise-front", "*pareto*", Tolerance(relative=0.03), "the same"),
    ("optimise-*", "*margin*", Tolerance(relative=1e-11), "eigenvalue: 2.4e-13"),
    ("optimise-*", "*evaluations", Tolerance(relative=0.02), "a search stops a step sooner or later: 1e-3"),
    ("volume-*", "*surface_constant", Tolerance(relative=1e-11), "root of an equation: 1.5e-13"),
    ("fit*", "*evaluations", Tolerance(relative=0.5), "a way downhill ends a few steps sooner: 10 %"),
    ("fit*", "*", Tolerance(relative=1e-8), "least squares with slopes by differences: 7e-10"),
    # Compiled finite volumes: the compiler fuses multiplications and additions as the code around them
    # allows, and what bores make of it grows in time.
    (
        *("runup-*", "*liquid_angle*", Tolerance(relative=3e-8, skipped=1)),
        "first comes the angle of an offset that is zero: rounding",
    ),
    (
        *("runup-balls_and_liquid", "*energy.bores", Tolerance(relative=3e-7)),
        "small losses of a layer driven by balls: 6e-9 shaken, 1.3e-8 after sums in another order",
    ),
    ("runup-*", "*energy.bores", Tolerance(relative=1e-9), "sum of small losses: 2.2e-11"),
    (
        *("runup-balls", "*phase*", Tolerance(absolute=1e-2)),
        "angle of a deflection that balls take away, in the end 3e-15 m: 6e-4 shaken",
    ),
    ("runup-balls", "*end.amplitude", Tolerance(absolute=1e-12), "that deflection, m"),
    ("runup-*", "*energy.remainder", Tolerance(absolute=1e-7), "difference of works of 100 J: 6e-12 J"),
    ("runup-*", "*energy.closure", Tolerance(absolute=1e-9), "the same over the work: 3e-14"),
    ("runup-*", "*energy_error", Tolerance(absolute=1e-9), "the same over the largest energy: 3e-14"),
    (
        *("runup-two_plane_rig", "*", Tolerance(relative=3e-8)),
        "bores run for 12 s: 2e-9 on the other processor, 3e-10 shaken",
    ),
    ("runup-*", "*", Tolerance(relative=2e-10), "1.2e-11 on the other processor, 5e-12 shaken"),
    ("layer-long_wave*", "*", Tolerance(relative=2e-10), "settled over many periods: 1.1e-11"),
    ("layer-auto-resonance", "*", Tolerance(relative=2e-10), "the same: long waves are taken"),
    ("layer-duration*", "*", Tolerance(relative=2e-11), "1.6e-12"),
    ("validate-layer", "*.cases[].*", Tolerance(relative=2e-8, absolute=1e-7), "long waves: 1.9e-9"),
    (
        *("validate-whirl", "*.difference", Tolerance(absolute=5e-5)),
        "the branch by Newton's method stands to 1e-5 of the amplitude, where its map is kinked",
    ),
    (
        *("validate-whirl", "*.cases[].*", Tolerance(relative=2e-7, absolute=1e-6)),
        "growth rates from long waves in time: 1.4e-8, against what is printed 7e-8",
    ),
    (
        *("map-cycles", "*fold*", Tolerance(relative=0.1)),
        "the outermost of the points that a branch was followed by: amplitudes 1.5e-2, speeds 2e-5",
    ),
    ("validate-baffles", "*.cases[].*", Tolerance(2e-9, 2e-9), "layers in time, less the print: 3e-11"),
    (
        *("validate-exact_wave", "*.cases[].*", Tolerance(1e-9, 1e-9)),
        "rounding of waves of some hundred nodes; the largest whirl and the fastest wave are searched for",
    ),
    ("validate-runup", "*.cases[].*", Tolerance(relative=2e-10, absolute=1e-12), "a run-up"),
    (
        *("validate-spindle", "*.cases[].*", Tolerance(1e-11, 1e-11)),
        "eigenvalues of long shafts beside what is printed: 6e-13 on another processor",
    ),
    # Finite elements
    (
        *("layer-fem-baffles", "*", Tolerance(relative=1e-6)),
        "cells shrink by a power towards the edges of the baffles, so matrices are badly conditioned: 7e-8",
    ),
    ("modes-baffles", "*", Tolerance(relative=1e-6), "the same: 3e-8"),
    ("layer-fem*", "*", Tolerance(relative=1e-11), "a resonance near by: 2.2e-13"),
)


def tolerance_of(case: str, path: str) -> Tolerance:
    """Tolerance of a value.

    Parameters
    ----------
    case : name of the command
    path : of the value, without indices: `stdout.layers[].numbers.fill`
    """
    for commands, paths, tolerance, _ in TABLE:
        if fnmatchcase(case, commands) and fnmatchcase(path, paths.replace("[]", "[[]]")):
            return tolerance
    return DEFAULT
