"""A liquid model of one's own answers as the built-in one with its formulas; what is none is refused."""

from __future__ import annotations

import math
from contextlib import suppress
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, ClassVar

import h5py
import numpy as np
import pytest

import leblanc as lb
from fluid.fill import Fills
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.whirl import layer_rate, offset_with_friction, plane_layer
from leblanc.core.answer import as_typed
from leblanc.liquid.models import asked_with
from leblanc.studies.explain.answer import described_blocks
from meshes.errors import InputError
from solvers.checked_model import CheckedModel
from solvers.liquid_model import LiquidAnswer, Whirls
from solvers.whirl.growth import growth_map
from tests.mutants import kills

SAME = 1e-12


class Ring:
    """The linear layer with friction [theory: whirl, eq. 4], as anybody would write it; not hashable."""

    name = "my ring"
    __hash__: ClassVar[None] = None  # type: ignore[assignment]

    def __init__(self, friction: Friction = NO_FRICTION, spoilt: dict[str, Any] | None = None) -> None:
        self.friction, self.spoilt = friction, spoilt or {}

    def answer(self, fills: Fills, whirls: Whirls) -> Any:
        added, yes = np.empty(len(fills), dtype=complex), np.ones(len(fills), dtype=bool)
        for k in np.unique(fills.which).tolist():
            fill, at = fills.origin[k], fills.which == k
            layer = plane_layer(fill, self.friction)
            assert layer is not None
            spin, speed = whirls.spin[at], whirls.speed[at]
            rate = layer_rate(layer, spin, speed - spin)
            added[at] = fill.mass * (1.0 + offset_with_friction(layer.layer_tanh, spin, speed, rate))
        found = LiquidAnswer(
            unbalance=added * whirls.amplitude,
            slope=added,
            offset=(added / fills.mass - 1.0) * whirls.amplitude,
            dry_patch=~yes,
            converged=yes,
            limits={"wave_amplitude": yes},
            error=np.full(len(fills), math.nan),
        )
        return replace(found, **self.spoilt) if isinstance(self.spoilt, dict) else self.spoilt


def scene(name: str, **changes: Any) -> lb.Scene:
    """An example whose friction is none and whose model is linear."""
    table = {"model.friction": "none", "model.liquid": "linear", "speeds.count": 13} | changes
    return lb.example(name).replace(table)


@kills(
    "solvers.whirl.transfer:_solved",
    "root = np.where(endless, np.nan, _SHIFT + ",
    "root = np.where(endless, np.nan, 1e-6 + _SHIFT + ",
)
@pytest.mark.parametrize("name", ["horizontal_rig", "vertical_rig", "two_plane_rig", "tub"])
def test_a_copy_of_the_ring_answers_as_the_ring(name: str) -> None:
    own, ours = lb.run(scene(name), model=Ring()), lb.run(scene(name))
    assert set(own.model.tolist()) == {"my ring"}
    for key in ("amplitude", "deflection", "liquid_offset", "liquid_angle", "stable"):
        assert np.allclose(getattr(own, key), getattr(ours, key), rtol=SAME, atol=0.0), key
    assert np.abs(own.growth - ours.growth).max() <= SAME * own.speed.max()
    assert np.allclose(own.whirl_speed, ours.whirl_speed, rtol=SAME)
    assert own.critical_speed_wet == pytest.approx(ours.critical_speed_wet, rel=SAME)
    assert np.allclose(own.whirl.bands, ours.whirl.bands, rtol=1e-9)


@pytest.mark.parametrize(("name", "volumes"), [("horizontal_rig", 4), ("tub", 2)])
def test_its_map_is_that_of_the_ring(name: str, volumes: int) -> None:
    friction = Friction(FrictionLaw.LINEAR, 2.0)
    ours = lb.map_whirl(scene(name), volumes=volumes, speeds=7, friction=friction)
    own = lb.map_whirl(scene(name), volumes=volumes, speeds=7, model=Ring(friction))
    assert np.abs(own.growth - ours.growth).max() <= SAME * own.speed.max()
    assert np.allclose(own.whirl_speed, ours.whirl_speed, rtol=SAME)
    assert own.friction == "as the model my ring has it"


def test_growth_with_laminar_layers_which_no_rational_function_is() -> None:
    """To the accuracy of the fit, of the mode that grows; a cut of the function makes no mode."""
    rig = scene("horizontal_rig")
    friction, speed = Friction(FrictionLaw.STOKES), np.linspace(120.0, 200.0, 4)
    rotor, rows = rig.rotor.machine(), [rig.fills]
    ours, own = (growth_map(rotor, rows, speed, law) for law in (friction, CheckedModel(Ring(friction))))
    assert ours[0].max() > 0.0
    for here, there in zip(own, ours, strict=True):
        assert np.abs(here - there).max() <= 3e-5 * speed.max()


@kills("solvers.synchronous.response:_fixed_speed", "rotor.mass + (float", "2.0 * rotor.mass + (float")
@kills("solvers.checked_model:CheckedModel._slope", "/ (2.0 * base * share)", "/ (base * share)")
def test_a_force_across_the_deflection_is_that_of_the_complex_mass() -> None:
    """K - Omega^2 (M + m) + i C Omega with a complex m, which brakes or drives."""

    class Lagging(Ring):
        name = "lagging"

        def answer(self, fills: Fills, whirls: Whirls) -> Any:
            found, turn = super().answer(fills, whirls), 1.0 - 0.3j
            return replace(found, unbalance=turn * found.unbalance, slope=np.full(len(fills), math.nan))

    rig = scene("horizontal_rig")
    own, rotor = lb.run(rig, model=Lagging()), rig.rotor.machine()
    mass = rotor.mass + (1.0 - 0.3j) * sum(fill.full_mass for fill in rig.fills)
    speed = math.sqrt(rotor.stiffness / mass.real)
    assert own.critical_speed_wet == pytest.approx(speed, rel=SAME)
    stiffness = rotor.stiffness - mass * own.speed**2 + 1j * rotor.damping * own.speed
    assert np.allclose(own.deflection, rotor.unbalance * own.speed**2 / stiffness, rtol=1e-9)


YES = np.ones(2, dtype=bool)
BROKEN: list[tuple[Any, str, str]] = [
    ({"unbalance": np.full(2, math.nan)}, "model.answer.unbalance", "finite where converged"),
    ({"unbalance": np.zeros((2, 1))}, "model.answer.unbalance", "shape (2,)"),
    ({"unbalance": [1.0, 1.0]}, "model.answer.unbalance", "an array of numbers"),
    ({"slope": np.array(["a", "b"])}, "model.answer.slope", "an array of numbers"),
    ({"offset": np.full(2, math.inf)}, "model.answer.offset", "finite where converged"),
    ({"converged": np.ones(2)}, "model.answer.converged", "truth values"),
    ({"error": np.full(2, -0.1)}, "model.answer.error", "0 or above"),
    ({"error": np.full(2, 1j)}, "model.answer.error", "real numbers"),
    ({"limits": [YES]}, "model.answer.limits", "flags by the names"),
    ({"limits": {"depth": 1}}, "model.answer.limits.depth", "truth values"),
    (None, "model.answer", "LiquidAnswer"),
]


@pytest.mark.parametrize(("spoilt", "field", "allowed"), BROKEN)
def test_an_answer_that_is_none_is_refused(spoilt: Any, field: str, allowed: str) -> None:
    ring, spin = Ring(), np.array([100.0, 200.0])
    ring.spoilt = spoilt
    fills = Fills.of(scene("horizontal_rig").fills[:1]).at(np.zeros(2, dtype=np.intp))
    with pytest.raises(InputError) as refused:
        CheckedModel(ring).answer(fills, Whirls.synchronous(spin, 1e-6 * spin, 0.0 * spin))
    assert refused.value.field == field
    assert allowed in refused.value.allowed


def test_a_force_of_the_wrong_sign_is_refused() -> None:
    class Inwards(Ring):
        name = "inwards"

        def answer(self, fills: Fills, whirls: Whirls) -> Any:
            found = super().answer(fills, whirls)
            return replace(found, unbalance=-found.unbalance)

    with pytest.raises(InputError, match=r"model\.answer\.unbalance = .* throws liquid outwards"):
        lb.run(scene("horizontal_rig"), model=Inwards())


@kills("solvers.checked_model:require_outwards", "_STILL * fills.mass", "1e9 * fills.mass")
@kills("solvers.checked_model:require_outwards", "still.converged & ", "True & ")
def test_a_force_without_a_deflection_is_refused() -> None:
    class Offset(Ring):
        name = "offset"
        share = 1e-3

        def answer(self, fills: Fills, whirls: Whirls) -> Any:
            found = super().answer(fills, whirls)
            return replace(
                found,
                unbalance=found.unbalance + self.share * fills.mass * fills.depth,
                converged=whirls.amplitude >= self.least,
            )

    model = Offset()
    model.least = 1e-12
    lb.run(scene("horizontal_rig"), speeds=[100.0, 200.0], model=model)
    model.least = 0.0
    refused = None
    with suppress(InputError):
        refused = lb.run(scene("horizontal_rig"), speeds=[100.0, 200.0], model=model)
    assert refused is None


class Fails(Ring):
    """It raises."""

    def answer(self, fills: Fills, whirls: Whirls) -> Any:
        raise ZeroDivisionError("by nothing")


def named(name: Any) -> Ring:
    ring = Ring()
    ring.name = name
    return ring


NO_MODELS: list[tuple[Any, dict[str, Any], str]] = [
    (Fails(), {}, "model.answer"),
    (object(), {}, "model.name"),
    (named(""), {}, "model.name"),
    (named(7), {}, "model.name"),
    (named("linear"), {}, "model.name"),
    (type("Named", (), {"name": "nothing"})(), {}, "model"),
    (Ring(), {"friction": "stokes"}, "friction"),
    (Ring(), {"cycles": True}, "cycles"),
]


@pytest.mark.parametrize(("model", "options", "field"), NO_MODELS)
def test_what_is_no_model_or_goes_with_none(model: Any, options: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as refused:
        lb.map_whirl(scene("horizontal_rig"), volumes=2, speeds=3, model=model, **options)
    assert refused.value.field == field


def test_a_machine_without_liquid_has_no_model() -> None:
    with pytest.raises(InputError, match="no chamber holds liquid"):
        lb.run(lb.example("spindle"), model=Ring())


def announce(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A package that announces a model, and two that cannot be loaded."""
    (tmp_path / "my_liquids.py").write_text(
        "from tests.leblanc.liquid.test_own import Ring\nring = Ring()\nbroken = None\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    names = {"thin ring": "my_liquids:ring", "broken": "my_liquids:broken", "gone": "no_such_module:it"}
    entries = [EntryPoint(name, place, "leblanc.liquids") for name, place in names.items()]
    package = type("Package", (), {"entry_points": entries})
    monkeypatch.setattr("leblanc.registry.distributions", lambda: [package])


def test_an_announced_model_is_named_in_a_machine_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    announce(tmp_path, monkeypatch)
    rig = scene("horizontal_rig", **{"model.liquid": "thin ring"})
    own, ours = lb.run(rig), lb.run(scene("horizontal_rig"))
    assert set(own.model.tolist()) == {"thin ring"}
    assert np.allclose(own.amplitude, ours.amplitude, rtol=SAME)
    assert np.array_equal(lb.run(scene("horizontal_rig"), model="thin ring").amplitude, own.amplitude)

    for name in ("broken", "gone"):
        with pytest.raises(InputError, match="cannot be loaded"):
            lb.run(scene("horizontal_rig", **{"model.liquid": name}))
    with pytest.raises(lb.SceneError, match=r"model\.liquid"):
        scene("horizontal_rig", **{"model.liquid": "thick ring"})
    with pytest.raises(InputError, match="long_wave or linear"):
        lb.run_up(lb.example("runup").replace({"model.liquid": "thin ring"}))


def test_it_is_known_only_while_it_is_asked_with() -> None:
    with asked_with(scene("horizontal_rig"), Ring()) as other:
        assert other.model.liquid == "my ring"
    with pytest.raises(InputError, match=r"model\.liquid = 'my ring'"):
        lb.run(other)


class Failing(Ring):
    """It finds no answer above a spin speed, as a solver that does not converge."""

    name = "failing"

    def __init__(self, above: float) -> None:
        super().__init__()
        self.above = above

    def answer(self, fills: Fills, whirls: Whirls) -> Any:
        return replace(super().answer(fills, whirls), converged=whirls.spin < self.above)


@cache
def by_ring(name: str) -> Any:
    """The answer of the ring, which finds one at every speed."""
    return lb.run(scene(name, **{"speeds.count": 3}), model=Ring())


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ["horizontal_rig", "tub"])
@pytest.mark.parametrize("known", [3, 1, 0])
def test_where_it_finds_no_answer_the_growth_is_not_known(name: str, known: int) -> None:
    rig = scene(name, **{"speeds.count": 3})
    speed = rig.speed_array()
    above = 0.0 if known == 0 else 1.01 * speed[known - 1]
    found, whole = lb.run(rig, model=Failing(above)), by_ring(name)
    assert np.array_equal(np.isnan(found.growth), speed > above)
    assert np.array_equal(found.growth[:known], whole.growth[:known])
    assert set(found.stability[known:].tolist()) <= {"not_known"}
    assert bool(found.faults) == (known < 3)


@kills("solvers.whirl.transfer:transfer_modes", "known[:, :, part].mean", "known[:, :, ::2].mean")
@kills("solvers.whirl.transfer:transfer_modes", ">= _ENOUGH", ">= 0.1")
def test_half_of_the_frequencies_must_be_found_in_each_half() -> None:
    """What is left of a function is no function, however well one goes through it."""

    class Some(Ring):
        def answer(self, fills: Fills, whirls: Whirls) -> Any:
            found = super().answer(fills, whirls)
            return replace(found, converged=np.isin(np.arange(len(fills)) % 10, self.found))

    rig, spin = scene("horizontal_rig"), np.array([150.0])
    for some in ([0, 2, 4, 6, 8], [0, 1, 2, 3]):
        model = Some()
        model.found = some
        growth, _ = growth_map(rig.rotor.machine(), [rig.fills], spin, CheckedModel(model))
        assert np.isnan(growth).all()


@kills("leblanc.studies.map.study:_own_volume", "np.isnan(growth).all()", "False")
@kills("leblanc.studies.map.study:_own_volume", "elif lost:", "elif not lost:")
@kills("leblanc.studies.map.study:_own_volume", "'the other' if lost", "'the other' if bands")
def test_a_map_does_not_call_stable_what_it_does_not_know() -> None:
    said = {
        0.0: ("it is not known at any of these speeds whether whirl is self-excited.", ((80.0, 200.0),)),
        150.0: (
            "no whirl is self-excited at the other speeds. Not known within 1146 to 1910 rpm: do not take it "
            "for stable.",
            ((120.0, 200.0),),
        ),
        1e4: ("no whirl is self-excited at these speeds.", ()),
    }
    for above, (text, not_known) in said.items():
        model = Failing(above)
        model.friction = Friction(FrictionLaw.LINEAR, 200.0)
        rig = scene("horizontal_rig")
        found = lb.map_whirl(rig, model=model, speeds=[80.0, 120.0, 200.0], volumes=["5 ml", "9 ml"])
        (own,) = (note for note in found.notes if note.code == "own_volume")
        assert own.text == f"With the scene's 20 ml {text}"
        assert own.data["not_known"] == not_known


@kills("solvers.checked_model:_kept", "value.flags.writeable = False", "value.flags.writeable = True")
@kills("solvers.checked_model:_kept", "value = _kept(value)", "pass")
def test_it_cannot_change_what_it_is_asked_with() -> None:
    """The solvers' own arrays, which others see as well."""

    class Writes(Ring):
        def answer(self, fills: Fills, whirls: Whirls) -> Any:
            written(fills, whirls)[:] *= 2.0
            return super().answer(fills, whirls)

    fills = Fills.of(scene("horizontal_rig").fills)
    whirls = Whirls.synchronous(np.array([100.0, 200.0]), np.full(2, 1e-6), np.zeros(2))
    ways = [
        lambda _, whirls: whirls.spin,
        lambda _, whirls: whirls.deflection,
        lambda fills, _: fills.density,
        lambda fills, _: fills.chamber.radius,
    ]
    for written in ways:
        before = written(fills, whirls).copy()
        with suppress(InputError):
            CheckedModel(Writes()).answer(fills, whirls)
        assert np.array_equal(written(fills, whirls), before)
        assert written(fills, whirls).flags.writeable
    with pytest.raises(InputError, match="read-only"):
        lb.run(scene("horizontal_rig"), model=Writes())


@kills("leblanc.studies.explain.study:_whirl", " or isinstance(machine.waves, CheckedModel)", "")
@kills("leblanc.liquid.choose:_choice", "own is not None and bool(own.called)", "False")
@kills(
    "leblanc.studies.explain.answer:described_blocks",
    "layer_rows(layer, own_model_of(answer))",
    "layer_rows(layer)",
)
def test_explain_says_nothing_of_an_even_layer_where_the_scene_names_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    announce(tmp_path, monkeypatch)
    linear = scene("horizontal_rig", **{"rotor.damping_ratio": 0.01, "model.friction": "wall"})
    rig = scene(
        "horizontal_rig",
        **{"rotor.damping_ratio": 0.01, "model.friction": "wall", "model.liquid": "thin ring"},
    )
    ours, own = lb.explain(linear), lb.explain(rig)
    assert ours.whirl is not None
    assert own.whirl is None
    assert {span.reason for span in own.models if span.in_range} == {
        "a model of one's own, which the scene asks for"
    }
    told, plain = (repr(described_blocks(each)) for each in (own, ours))
    assert "not of thin ring; `run` and `map` ask it" in told
    assert "added mass" in told and "as thin ring has it" in told
    assert "even layer" not in plain


@kills("leblanc.core.answer:as_typed", " {own} {", " {")
@kills("leblanc.core.answer:as_typed", "{' '.join(_code_of(type(one)) for one in objects)}", "")
@kills("leblanc.core.answer:_code_of", "{[*map(_code_of, code.co_consts)]}", "")
@kills("leblanc.core.answer:_made_of", "={_made_of(value, within)}", "={value!r}")
def test_digests_tell_models_of_one_name_apart() -> None:
    """By their attributes, arrays element by element, those of objects in them, and by their code."""

    def made(share: str) -> Any:
        """Class with a method that differs in a number."""
        space: dict[str, Any] = {"Ring": Ring, "replace": replace}
        body = f"found, slope = super().answer(fills, whirls), {share}"
        text = f"class Sloped(Ring):\n def answer(self, fills, whirls):\n  {body}\n  return found"
        exec(text, space)
        return space["Sloped"]()

    @dataclass
    class Tabled(Ring):
        table: Any
        friction: Friction = NO_FRICTION
        spoilt: Any = field(default_factory=dict)

    class Held:
        def __init__(self, value: float) -> None:
            self.value, self.itself = value, self

    peaks = [np.eye(1, 2000, k)[0] for k in (700, 800)]
    rates = [Ring(Friction(FrictionLaw.LINEAR, rate)) for rate in (2.0, 200.0)]
    models = [
        *rates,
        *map(Tabled, peaks),
        *(Tabled(Held(value)) for value in (1.0, 2.0)),
        made("1"),
        made("2"),
    ]
    asked, speeds = scene("horizontal_rig"), [100.0, 200.0]
    answer = lb.run(asked, speeds=speeds, model=rates[0])

    def digest(model: Any) -> str:
        found = copy(answer)
        del vars(found)["typed"]
        vars(found)["digest"] = asked.digest
        as_typed(found, asked, model=model)
        return found.digest

    digests = [*map(digest, models)]
    assert len({*digests}) == len(models)
    assert [digest(Tabled(peaks[0].copy())), digest(Tabled(Held(1.0)))] == [digests[2], digests[4]]
    assert answer.digest != lb.run(asked, speeds=speeds, model=rates[1]).digest
    own = lb.run(asked.replace({"model.liquid": "statics", "speeds": speeds})).digest
    assert lb.run(asked, speeds=speeds, model="statics").digest == own


@kills(
    "leblanc.core.answer:_made_of",
    "{', '.join(f'{key}={_made_of(value, within)}' for key, value in told.items())}",
    "",
)
@kills("leblanc.core.answer:_made_of", "is not object.__repr__", "is object.__repr__")
@kills("leblanc.core.answer:as_typed", ", liquid_model=own", "")
def test_an_answer_and_its_file_tell_models_apart(tmp_path: Path) -> None:
    """Which have the same name, as does the scene."""

    @dataclass
    class Given(Ring):
        friction: Friction
        spoilt: Any = field(default_factory=dict)

    light, heavy = (Friction(FrictionLaw.LINEAR, rate) for rate in (2.0, 200.0))
    asked = scene("horizontal_rig"), [100.0]
    said = []
    for model in (Ring(light), Ring(heavy), Given(light), "statics", None):
        answer = lb.run(asked[0], speeds=asked[1], model=model)
        answer.save(tmp_path / "it.nc")
        said.append(answer.typed.liquid_model)
        assert lb.open(tmp_path / "it.nc").typed.liquid_model == said[-1]
        with h5py.File(tmp_path / "it.nc") as data:
            assert data.attrs.get("liquid_model", "") == said[-1]
    assert len(set(said)) == len(said)
    assert said[0].startswith("tests.leblanc.liquid.test_own.Ring(friction=Friction(")
    assert "Given(friction=" in said[2] and "spoilt={}" in said[2]
    assert said[3:] == ["statics", ""]
