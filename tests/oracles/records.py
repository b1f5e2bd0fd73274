"""Records of made-up but physically sensible machines, for what is written from them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.liquid.filled import FilledChamber
from leblanc.studies.held.answer import Held
from leblanc.studies.run import notes as run_notes
from leblanc.studies.run.answer import RunAnswer
from meshes.arrays import Array
from solvers.synchronous.response import Response

MASS, STIFFNESS, DAMPING, UNBALANCE = 4.0, 43864.9, 83.78, 6e-4  # critical speed 1000 rpm, damping ratio 0.1
RPM = 2.0 * math.pi / 60.0
LIQUID_MASS = 998.2e-5  # 10 ml of water
ADDED = 998.2 * math.pi * 0.065**2 * 0.02  # the chamber full of water


def dry_deflection(speed: Array, mass: float, damping: float = DAMPING) -> NDArray[np.complex128]:
    return speed**2 * UNBALANCE / (STIFFNESS - mass * speed**2 + 1j * damping * speed)


def circles(w: NDArray[np.complex128], branches: NDArray[np.complex128]) -> dict[str, Any]:
    """What a response says besides the forward part, where every orbit is a circle."""
    return {
        "backward": 0.0 * w,
        "backward_dry": 0.0 * w,
        "branch_backward": 0.0 * branches,
        "branch_coordinates": np.stack((branches, -1j * branches), axis=2),
        "coordinates": np.stack((w, -1j * w), axis=1),
        "fold_speed": np.full(w.shape, np.nan),
        "residual": np.zeros(w.shape),
    }


def response_of(speed: Array, added: float = ADDED, depth: float = 1.24e-3) -> Response:
    """A layer whose wall is wet acts as an added mass, whatever its depth [theory: rotor]."""
    w = dry_deflection(speed, MASS + added)
    return Response(
        speed=speed,
        deflection=w,
        deflection_dry=dry_deflection(speed, MASS),
        liquid_offset=np.abs(w) * added / LIQUID_MASS,
        liquid_angle=np.angle(w),
        dry_patch=np.abs(w) > depth,
        stable=np.ones(speed.shape, dtype=np.bool_),
        model=np.full(speed.shape, "statics"),
        in_range=speed > 350.0 * RPM,
        converged=np.ones(speed.shape, dtype=np.bool_),
        branch_deflection=w[:, None],
        branch_stable=np.ones((speed.size, 1), dtype=np.bool_),
        **circles(w, w[:, None]),
    )


def record_of(response: Response, **changes: object) -> RunAnswer:
    record = RunAnswer(
        name="Horizontal rig",
        source="DR18, section 7.2",
        assumed=("rotor.mass", "rotor.damping_ratio", "chambers.0.height"),
        inputs=(
            ("Rotor", "jeffcott", "rotor.kind"),
            ("Mass without liquid", "4 kg", "rotor.mass"),
            ("Critical speed", "1000 rpm", "rotor.critical_speed"),
            ("Damping ratio", "0.1", "rotor.damping_ratio"),
            ("Unbalance", "0.6 kg mm", "rotor.unbalance"),
            ("Axis", "horizontal", "rotor.axis"),
            ("Chamber radius", "65 mm", "chambers.0.radius"),
            ("Chamber height", "20 mm", "chambers.0.height"),
            ("Liquid volume", "10 ml", "chambers.0.volume"),
            ("Liquid", "water", "chambers.0.liquid"),
            ("Speed from", "100 rpm", "speeds.start"),
            ("Speed to", "2000 rpm", "speeds.stop"),
            ("Number of speeds", "201", "speeds.count"),
            ("Liquid model", "auto", "model.liquid"),
            ("Friction in the liquid", "stokes", "model.friction"),
        ),
        digest="9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
        response=response,
        liquid_mass=LIQUID_MASS,
        notes=(run_notes.not_carried(350.0 * RPM),),
        axis="horizontal",
        chambers=(FilledChamber(0.065, 0.0, 0.02, 1e-5, "water", 0.06376),),
        capture_speed=350.0 * RPM,
        critical_speed_dry=1000.0 * RPM,
        critical_speed_wet=1000.0 * RPM * math.sqrt(MASS / (MASS + ADDED)),
    )
    return replace(record, **changes)  # type: ignore[arg-type]


def rig(count: int = 201, start: float = 100.0, stop: float = 2000.0) -> RunAnswer:
    """A horizontal rig whose liquid is captured from 350 rpm on."""
    return record_of(response_of(np.linspace(start, stop, count) * RPM))


def folded(count: int = 241, follow: str = "low") -> RunAnswer:
    """A lightly damped machine whose thin layer saturates: up to three branches at one speed.

    Reported is the lowest or, as in a run-up, the highest of them.

    The liquid's unbalance grows as m_f |w| while its wall is wet and bends over to m_f r_s; every |w| at
    which the moduli of the two sides of the balance agree is a branch.
    """
    speed = np.linspace(500.0, 1500.0, count) * RPM
    m_f, r_s, damping = 1.6, 1.2e-3, 12.0
    r = np.geomspace(1e-6, 0.05, 6001)
    liquid = m_f * r / (1.0 + (r / r_s) ** 4) ** 0.25
    rotor = STIFFNESS - MASS * speed**2 + 1j * damping * speed
    left = rotor[:, None] * r - speed[:, None] ** 2 * liquid
    balance = np.abs(left) - (speed**2 * UNBALANCE)[:, None]
    branches = np.full((count, 3), np.nan + 1j * np.nan)
    stable = np.zeros((count, 3), dtype=np.bool_)
    for i in range(count):
        at = np.flatnonzero(np.sign(balance[i, 1:]) != np.sign(balance[i, :-1]))[:3]
        turn = np.conj(left[i, at] / (speed[i] ** 2 * UNBALANCE))
        branches[i, : at.size] = r[at] * turn / np.abs(turn)
        stable[i, : at.size] = np.arange(at.size) != 1
    number = np.count_nonzero(~np.isnan(branches), axis=1)
    chosen = np.zeros(count, dtype=np.intp) if follow == "low" else number - 1
    w = branches[np.arange(count), chosen]
    response = Response(
        speed=speed,
        deflection=w,
        deflection_dry=dry_deflection(speed, MASS, damping),
        liquid_offset=0.03 * np.abs(w) / (np.abs(w) + r_s),
        liquid_angle=np.angle(w),
        dry_patch=np.abs(w) > r_s,
        stable=stable[np.arange(count), chosen],
        model=np.full(count, "statics"),
        in_range=np.ones(count, dtype=np.bool_),
        converged=np.ones(count, dtype=np.bool_),
        branch_deflection=branches,
        branch_stable=stable,
        **circles(w, branches),
    )
    return record_of(
        response,
        name="Lightly damped rig",
        capture_speed=None,
        notes=(),
        critical_speed_wet=1000.0 * RPM * math.sqrt(MASS / (MASS + m_f)),
    )


def held_rig(count: int = 21, at: slice = slice(None)) -> RunAnswer:
    """The rig held in time from 100 to 2000 rpm: calm, but for three speeds of limit cycles and one lost.

    With 21 speeds, 95 rpm apart: not settled at 195 rpm, limit cycles from 1145 to 1335 rpm and, on the way
    down, at 1430 rpm still; elsewhere the amplitude ripples by 2 per mille.
    """
    plain = rig(count)
    r, rpm = plain.response, plain.response.speed / RPM
    chosen = np.zeros(count, dtype=np.bool_)
    chosen[at] = True
    cycle, lost = (chosen & (low < rpm) & (rpm < high) for low, high in ((1100, 1400), (150, 200)))
    late = chosen & (rpm > 1400) & (rpm < 1440)
    state = np.where(
        cycle, "limit_cycle", np.where(lost, "not_settled", np.where(chosen, "periodic", "steady"))
    )
    size = np.abs(r.deflection)
    held = Held(
        at=chosen,
        state=state,
        least=np.where(chosen, size * np.where(cycle, 0.6, 0.999), np.nan),
        largest=np.where(chosen, size * np.where(cycle, 1.5, 1.001), np.nan),
        whirl_speed=np.where(cycle, 0.8 * r.speed, np.nan),
        liquid=np.where(chosen, 0.02 * r.deflection / size.max(), np.nan)[:, None],
        ripple=np.where(chosen, np.where(cycle, 2e-3, 1e-4), np.nan)[:, None],
        error=np.where(chosen & ~lost, 3e-3, np.nan),
        energy_error=np.where(chosen, 4e-4, np.nan),
        multiplier=np.where(chosen & ~cycle & ~lost, 0.95, np.nan),
        state_down=np.where(late, "limit_cycle", state),
        amplitude_down=np.where(late, 3.0 * size, np.nan),
        cells=128,
        reason=np.where(lost, "the motion still changes after 1024 turns", ""),
        wave_error=np.where(cycle, 2e-3, np.nan),
    )
    response = replace(
        r,
        model=np.where(chosen, "long_wave", r.model),
        stable=r.stable & ~cycle & ~lost,
        branch_stable=(r.stable & ~cycle & ~lost)[:, None],
        converged=~lost,
        over_time=np.where(chosen, size, np.nan),
    )
    error = np.where(chosen, held.error, 1e-4)
    return replace(plain, response=response, held=held, error_estimate=error, tolerance=1e-3)


def nothing_found() -> RunAnswer:
    r = rig(50).response
    empty = {
        name: np.full_like(getattr(r, name), np.nan)
        for name in ("deflection", "deflection_dry", "liquid_offset", "liquid_angle", "branch_deflection")
    }
    return record_of(replace(r, **empty, converged=~r.converged))


def not_converged_in_the_fold() -> RunAnswer:
    record = folded()
    r = record.response
    w, branches, converged = r.deflection.copy(), r.branch_deflection.copy(), r.converged.copy()
    w[100:110], branches[100:110], converged[100:110] = np.nan, np.nan, False
    return replace(record, response=replace(r, deflection=w, branch_deflection=branches, converged=converged))


def scaled(factor: float) -> RunAnswer:
    r = rig(50).response
    lengths = {
        name: getattr(r, name) * factor
        for name in ("deflection", "deflection_dry", "liquid_offset", "branch_deflection")
    }
    return record_of(replace(r, **lengths))


def everywhere() -> RunAnswer:
    r = rig(50).response
    always = np.ones(50, dtype=np.bool_)
    return record_of(replace(r, dry_patch=always, in_range=~always, stable=~always))


def awkward_texts() -> RunAnswer:
    name = "<b>$x_1^{$</b> \N{CJK UNIFIED IDEOGRAPH-6D17} \x07\n" + "W" * 300
    return replace(rig(20), name=name, assumed=tuple(f"chambers.{i}.height" for i in range(40)))


def many_chambers() -> RunAnswer:
    sizes = (0.1, 0.09, 0.08, 0.07, 0.06)
    return replace(
        rig(20), chambers=tuple(FilledChamber(R, 0.0, 0.04, 1e-4, "water", R - 0.01) for R in sizes)
    )


def out_of_range_with_many_chambers() -> RunAnswer:
    return replace(everywhere(), chambers=many_chambers().chambers)


def undamped() -> RunAnswer:
    """Infinite amplitude at one of the speeds."""
    r = rig(50).response
    w, branches = r.deflection.copy(), r.branch_deflection.copy()
    w[20] = branches[20] = complex(np.inf, 0.0)
    return record_of(replace(r, deflection=w, deflection_dry=w, branch_deflection=branches))


def full_annulus() -> RunAnswer:
    return replace(rig(20), chambers=(FilledChamber(0.065, 0.02, 0.02, 1e-4, "water", 0.02),))


def no_liquid() -> RunAnswer:
    r = rig(20).response
    return record_of(
        replace(r, liquid_offset=0.0 * r.speed), chambers=(FilledChamber(0.065, 0, 0.02, 0, "water", 0.065),)
    )


EXTREMES: dict[str, Callable[[], RunAnswer]] = {
    "rig": rig,
    "folded": folded,
    "one speed": lambda: rig(1, 1200.0, 1200.0),
    "two speeds, falling": lambda: rig(2, 1200.0, 300.0),
    "zero amplitude": lambda: scaled(0.0),
    "tiny amplitude": lambda: scaled(1e-12),
    "deflection beyond the wall": lambda: scaled(1e3),
    "nothing found": nothing_found,
    "not converged in the fold": not_converged_in_the_fold,
    "dry, unstable, out of range everywhere": everywhere,
    "awkward texts": awkward_texts,
    "many chambers": many_chambers,
    "full annulus": full_annulus,
    "many chambers out of range": out_of_range_with_many_chambers,
    "undamped at its critical speed": undamped,
    "no chamber": lambda: replace(rig(20), chambers=()),
    "no liquid": no_liquid,
    "held in time": held_rig,
    "held in time at some speeds": lambda: held_rig(at=slice(8, 16)),
}
