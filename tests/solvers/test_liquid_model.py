"""Every liquid model answers the same question in the same way: force, centre of mass, range, error."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill, Fills
from fluid.friction.laws import Friction
from fluid.liquid import known_liquid
from leblanc.liquid.models import WAVE_MODELS, synchronous_model, wave_model
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.state import Numerics
from solvers.liquid_model import LiquidModel, Whirl, Whirls
from solvers.pypde.models import LongWave
from solvers.sloshing.model import SmallWaves
from solvers.synchronous.models import LINEAR, STATICS, CellsAtRest, ElementsAtRest
from tests.mutants import kills

R, H, SPIN = 0.15, 0.01, 40.0
SURFACE = 0.9 * R
FILL = Fill(Chamber(R, H), known_liquid("water"), math.pi * (R**2 - SURFACE**2) * H)
SMALL = 1e-3 * FILL.depth


def whirls(speed: float, deflection: complex) -> Whirls:
    return replace(Whirls.of(Whirl(SPIN, speed, abs(deflection))), deflection=np.array([deflection]))


AT_REST = [STATICS, LINEAR, SmallWaves(), CellsAtRest(256), ElementsAtRest(96, 2)]


@kills("solvers.liquid_model:LiquidAnswer.at_rest", "centre - whirls.amplitude", "centre + whirls.amplitude")
@kills("solvers.liquid_model:LiquidAnswer.force", "* towards", "* np.conj(towards)")
@kills("solvers.liquid_model:LiquidAnswer.force", "np.square(whirls.speed)", "np.square(whirls.slip)")
@pytest.mark.parametrize("model", AT_REST, ids=lambda model: model.name)
def test_a_synchronous_whirl_finds_the_mass_of_a_full_chamber(model: LiquidModel) -> None:
    """F = m_f Omega^2 w, and by Newton's law the centre of mass is at U over the liquid's mass.

    Quadratic elements with 96 edges leave 1e-6 of the unbalance, and that over the depth in the offset.
    """
    deflection = SMALL * np.exp(0.7j)
    asked = whirls(SPIN, deflection)
    found = model.answer(Fills.of([FILL]), asked)
    full = FILL.full_mass * SPIN**2 * deflection
    assert found.force(asked)[0] == pytest.approx(full, rel=2e-6)
    assert found.offset[0] == pytest.approx(SMALL * (FILL.full_mass / FILL.mass - 1.0), rel=2e-5)
    assert found.converged.all() and found.in_range.all() and not found.dry_patch.any()


def test_long_waves_settle_to_the_same() -> None:
    asked = whirls(SPIN, SMALL)
    found = LongWave(numerics=Numerics(64)).answer(Fills.of([FILL]), asked)
    assert found.force(asked)[0] == pytest.approx(FILL.full_mass * SPIN**2 * SMALL, rel=1e-9)
    assert found.offset[0] == pytest.approx(SMALL * (FILL.full_mass / FILL.mass - 1.0), rel=1e-9)
    assert found.converged.all() and found.in_range.all() and not found.dry_patch.any()


@kills("solvers.liquid_model:whirl_answer", "full * whirl.amplitude", "fill.mass * whirl.amplitude")
@kills("solvers.liquid_model:whirl_answer", "full * force_ratio.real if", "fill.mass * force_ratio.real if")
@pytest.mark.parametrize("speed", [33.0, 20.0, -10.0])
def test_force_and_centre_of_mass_of_any_whirl_are_newtons_law(speed: float) -> None:
    """F = m_l omega^2 (w + d); a linear theory's slope is U over the deflection."""
    for model in (
        LINEAR,
        SmallWaves(),
        wave_model("kdv", Friction("linear", 1.0)),
        LongWave(Friction("linear", 1.0)),
    ):
        asked = whirls(speed, SMALL)
        found = model.answer(Fills.of([FILL]), asked)
        newton = FILL.mass * speed**2 * (SMALL + found.offset[0])
        # A layer in time has settled to 1e-4.
        assert found.force(asked)[0] == pytest.approx(newton, rel=3e-4), model.name
        if not math.isnan(found.slope[0]):
            assert found.slope[0] * SMALL == pytest.approx(found.unbalance[0].real, rel=1e-12)


@kills("solvers.liquid_model:LiquidAnswer.at_rest", "(whirls.slip == 0.0) &", "(whirls.slip != 1e9) &")
@kills("solvers.liquid_model:LiquidAnswer.at_rest", "(whirls.gravity == 0.0)", "(whirls.slip == 0.0)")
def test_liquid_at_rest_says_that_another_whirl_is_out_of_range() -> None:
    fall = replace(whirls(SPIN, SMALL), gravity=np.array([9.81]))
    for model in (STATICS, CellsAtRest(64), ElementsAtRest(32)):
        for asked in (whirls(33.0, SMALL), fall):
            found = model.answer(Fills.of([FILL]), asked)
            assert not found.in_range.any() and not found.limits["synchronous"].any()


@kills("solvers.liquid_model:kept_limits", "low <= numbers[name] <= high", "numbers[name] <= high")
def test_limits_say_what_bounds_the_answer() -> None:
    """A wave too high, liquid that does not ride with the drum, a layer too deep; none of them elsewhere."""
    deep = Fill(FILL.chamber, FILL.liquid, 0.8 * FILL.chamber.capacity)
    slow = replace(whirls(4.0, SMALL), spin=np.array([5.0]), gravity=np.array([9.81]))
    family = wave_model("kdv", Friction("linear", 1.0))
    for model, fill, asked, name in (
        (LINEAR, FILL, whirls(33.0, FILL.depth), "wave_amplitude"),
        (LINEAR, FILL, slow, "centrifuge"),
        (family, deep, whirls(33.0, SMALL), "relative_depth"),
    ):
        found = model.answer(Fills.of([fill]), asked)
        assert name in {limit for limit, kept in found.limits.items() if not kept.all()}


@kills("solvers.liquid_model:WaveModel.answer", "np.argsort(np.concatenate(apart))", "np.concatenate(apart)")
def test_many_are_answered_as_one_by_one() -> None:
    """Fills and whirls of any kind together, in the order asked."""
    other = Fill(Chamber(0.2, 0.02), known_liquid("glycerol"), 2e-4)
    fills = Fills.of([FILL, other]).at(np.array([1, 0, 0, 0]))
    speed, deflection = np.array([33.0, -20.0, SPIN, 25.0]), SMALL * np.array([1.0, 2.0, 3.0, 4.0])
    asked = Whirls(np.full(4, SPIN), speed, deflection, np.zeros(4), np.zeros(4))
    for model in (LINEAR, SmallWaves(64), wave_model("kdv")):
        whole = model.answer(fills, asked)
        for k, fill in enumerate((other, FILL, FILL, FILL)):
            alone = model.answer(Fills.of([fill]), asked.at(np.array([k])))
            assert whole.unbalance[k] == pytest.approx(alone.unbalance[0], rel=1e-12)
            assert {name: bool(kept[k]) for name, kept in whole.limits.items()}.items() >= {
                name: bool(kept[0]) for name, kept in alone.limits.items() if name in whole.limits
            }.items()


@kills("solvers.synchronous.models:Linear.at_rest", "missing, line", "0.5 * missing, line")
def test_the_estimated_error_of_the_linear_law_is_a_bound() -> None:
    """Never below the true one, with dry walls and with bowls; next to it where the wall is just dry."""
    for gravity in (0.0, 9.81):
        size = FILL.depth * np.linspace(0.05, 6.0, 41)
        asked = Whirls.synchronous(np.full(41, 15.0), size, np.full(41, gravity))
        line, exact = (model.answer(Fills.of([FILL] * 41), asked) for model in (LINEAR, STATICS))
        true = np.abs(exact.unbalance.real / line.unbalance.real - 1.0)
        assert np.all(line.error + 1e-12 >= true) and true.max() > 0.01
        large = true > 0.01
        assert np.all(line.error[large] < 2.5 * true[large])


def test_waves_estimate_their_errors() -> None:
    """Beside the exact linear theory, where it holds: the estimate is of the size of the true error."""
    asked = whirls(31.0, 1e-3 * SMALL)
    exact = LINEAR.answer(Fills.of([FILL]), asked).unbalance[0]
    for model in (wave_model("kdv"), LongWave(Friction("linear", 0.5), Numerics(256))):
        found = model.answer(Fills.of([FILL]), asked)
        assert 0.0 < found.error[0] < 0.2 and abs(found.unbalance[0] / exact - 1.0) < 0.5


@kills("solvers.liquid_model:LiquidAnswer.real_unbalance", "self.unbalance.imag", "self.unbalance.real")
def test_the_synchronous_response_refuses_a_pull_across_the_deflection() -> None:
    """Friction drags the liquid of a slow whirl behind; such an answer has no place in a planar balance."""
    model = wave_model("kdv", Friction("linear", 5.0))
    dragged = model.answer(Fills.of([FILL]), whirls(31.0, SMALL))
    with pytest.raises(InputError, match="unbalance"):
        dragged.real_unbalance()
    found = STATICS.answer(Fills.of([FILL]), whirls(SPIN, SMALL))
    assert found.real_unbalance() == pytest.approx(FILL.full_mass * SMALL, rel=1e-9)


def test_names_become_models_in_one_place() -> None:
    for name in WAVE_MODELS:
        assert wave_model(name).name == name
    assert synchronous_model("auto") is STATICS and synchronous_model("linear") is LINEAR
    assert synchronous_model("fem") == wave_model("fem")
