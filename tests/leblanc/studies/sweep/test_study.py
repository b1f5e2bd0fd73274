"""Faulty studies are refused in plain words; good ones say the same however they are written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from leblanc.cli import main
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.scene.schema.paths import keys_of, rule_at, with_values
from leblanc.studies.sweep.plan import load_sweep
from tests.oracles.sweeps import SCENE, STUDY, study_in, write_study

FIELD = '"rotor.mass" = { uniform = ["3 kg", "12 kg"] }'
EXAMPLES = Path(__file__).parents[4] / "examples"


@dataclass(frozen=True)
class Case:
    """A good study with one piece changed, the field that must be named and what must be said."""

    right: str
    wrong: str
    field: str
    said: tuple[str, ...]


def vary(line: str, field: str, *said: str) -> Case:
    return Case(FIELD, line, f"vary.{field}", said)


def case(right: str, wrong: str, field: str, *said: str) -> Case:
    return Case(right, wrong, field, said)


CASES = (
    case('scene = "scene.toml"', "", "scene", "must be given"),
    case('scene = "scene.toml"', 'scene = "none.toml"', "none.toml", "can be read"),
    case('method = "sobol"', 'method = "sobel"', 'method = "sobel"', "one of: grid, latin_hypercube"),
    case('method = "sobol"', "", "method", "must be given"),
    case("samples = 256", "samples = 0", "samples = 0", "a whole number from 1 to"),
    case("samples = 256", "samples = 2.5", "samples = 2.5", "a whole number"),
    case("samples = 256", "samples = 10_000_001", "samples", "from 1 to 10000000"),
    case("samples = 256", "", "samples", "must be given"),
    case("seed = 11", "seed = -1", "seed = -1", "from 0 to"),
    case("seed = 11", "sed = 11", "sed = 11", "spelled as one of: scene, command"),
    case(STUDY[STUDY.index("[vary]") :], "[vary]", "vary = {}", "a table of 1 to"),
    case(STUDY[STUDY.index("[vary]") :], "vary = 3", "vary = 3", "a table of 1 to"),
    case('method = "sobol"', 'method = "grid"', "samples = 256", "left out where method is grid"),
    vary('"rotor.mas" = { uniform = [3, 12] }', '"rotor.mas"', "rotor has: kind, mass"),
    vary('"rotor.balls.mass" = { uniform = [3, 12] }', '"rotor.balls.mass"', "rotor has: kind"),
    vary('"nothing" = { uniform = [3, 12] }', "nothing", "under gravity, rotor"),
    vary('"speeds.count" = { choice = [2, 3] }', '"speeds.count"', "other than rotor.kind, speeds.count"),
    vary('"rotor.kind" = { choice = ["tub"] }', '"rotor.kind"', "other than rotor.kind"),
    vary('"name" = { choice = ["a", "b"] }', "name", "under gravity, rotor"),
    vary(
        '"chambers.2.volume" = { uniform = [0, 1e-5] }', '"chambers.2.volume"', "the scene has no chambers.2"
    ),
    vary('"chambers.x.volume" = { uniform = [0, 1e-5] }', '"chambers.x.volume"', "the path of a"),
    vary('"chambers" = { choice = [1, 2] }', "chambers", "the path of one value"),
    vary('"rotor" = { choice = [1, 2] }', "rotor", "a single value"),
    vary('"rotor.mass.0" = { uniform = [3, 12] }', '"rotor.mass.0"', "has no 0"),
    vary(
        '"rotor.stiffness" = { uniform = [3, 12] }', '"rotor.stiffness"', "rotor.critical_speed in its place"
    ),
    vary(
        '"chambers.0.liquid.density" = { uniform = [900, 999] }',
        '"chambers.0.liquid.density"',
        "chambers.0.liquid is no table",
    ),
    vary(
        '"chambers.1.liquid.density" = { uniform = [900, 999] }',
        '"chambers.1.liquid.density"',
        "left out where chambers.1.liquid varies",
    ),
    vary('"rotor.mass" = { uniform = [12, 3] }', '"rotor.mass".uniform', "a lowest value below the highest"),
    vary('"rotor.mass" = { uniform = [3, 3] }', '"rotor.mass".uniform', "below the highest"),
    vary(
        '"rotor.mass" = { uniform = ["3 m", 12] }',
        '"rotor.mass".uniform',
        "a mass",
        "measures something else",
    ),
    vary('"rotor.mass" = { uniform = [-3, 12] }', '"rotor.mass".uniform', "a mass", "from 0.000 000 001"),
    vary('"rotor.mass" = { uniform = [3] }', '"rotor.mass".uniform', "a list of 2 values"),
    vary('"rotor.mass" = { uniform = 3 }', '"rotor.mass".uniform = 3', "a list of 2 values"),
    vary('"rotor.mass" = { uniform = [nan, 3] }', '"rotor.mass".uniform', "finite"),
    vary('"rotor.mass" = { normal = [4, 0] }', '"rotor.mass".normal', "a standard deviation above 0"),
    vary('"rotor.mass" = { normal = [4, "1 m"] }', '"rotor.mass".normal', "a mass"),
    vary('"rotor.mass" = { lognormal = [4, 1] }', '"rotor.mass".lognormal', "a factor above 1"),
    vary('"rotor.mass" = { lognormal = [4, "2 kg"] }', '"rotor.mass".lognormal', "a pure number"),
    vary('"rotor.unbalance" = { lognormal = [0, 2] }', '"rotor.unbalance".lognormal', "a median above 0"),
    vary('"rotor.mass" = { choice = [] }', '"rotor.mass".choice', "a list of 1 to"),
    vary('"rotor.mass" = { choice = ["heavy"] }', '"rotor.mass".choice', "a mass"),
    vary(
        '"chambers.0.liquid" = { choice = ["water", { density = 2e7, viscosity = 1e-6 }] }',
        *('"chambers.0.liquid".choice.density = 20000000.0', "a density", "from 0.001 to"),
    ),
    vary('"model.friction" = { choice = [{ linear = -1.0 }] }', '"model.friction".choice.linear', "from 0"),
    vary('"model.friction" = { choice = [{ lineal = 1.0 }] }', '"model.friction".choice', "spelled as"),
    vary('"model.liquid" = { choice = ["statik"] }', '"model.liquid".choice', "one of: auto, statics"),
    vary('"model.liquid" = { uniform = [0, 1] }', '"model.liquid".uniform', "choice", "no uniform"),
    vary('"rotor.mass" = { linspace = [3, 12, 4] }', '"rotor.mass"', "exactly one of", "method is sobol"),
    vary('"rotor.mass" = { gauss = [3, 12] }', '"rotor.mass"', "exactly one of uniform, normal"),
    vary('"rotor.mass" = { uniform = [3, 4], choice = [3] }', '"rotor.mass"', "exactly one of"),
    vary('"rotor.mass" = {}', '"rotor.mass"', "exactly one of"),
    vary('"rotor.mass" = 3', '"rotor.mass" = 3', "exactly one of"),
)


@pytest.mark.parametrize("one", CASES, ids=lambda one: one.wrong[:60])
def test_a_faulty_study_is_one_clear_line(
    one: Case, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert STUDY.count(one.right) == 1
    path = write_study(tmp_path, STUDY.replace(one.right, one.wrong))
    assert main(["sweep", str(path), "--out", str(tmp_path / "out")]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert one.field in line
    assert "must be" in line
    for said in one.said:
        assert said in line
    assert not (tmp_path / "out").exists()


GRID = STUDY.replace('"sobol"', '"grid"').replace("samples = 256", "").replace("uniform", "linspace")
GRID = GRID.replace('"12 kg"]', '"12 kg", 4]').replace('"250 ml"]', '"250 ml", 5]')


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ('uniform = ["3 kg", "12 kg"]', "exactly one of choice, linspace where method is grid"),
        ('linspace = ["3 kg", "12 kg", 1]', "a whole number from 2"),
        ('linspace = ["3 kg", "12 kg", 2.0]', "a whole number from 2"),
        ('linspace = ["3 kg", "3 kg", 2]', "two different ends"),
        ('linspace = ["3 kg", "12 kg", 1_000_000]', "at most 10000000 scenes in all"),
    ],
)
def test_a_faulty_grid_is_refused(wrong: str, said: str, tmp_path: Path) -> None:
    study = GRID.replace('linspace = ["3 kg", "12 kg", 4]', wrong)
    assert study != GRID
    with pytest.raises(SceneError, match=said):
        study_in(tmp_path, study)


def test_a_grid_has_as_many_samples_as_combinations(tmp_path: Path) -> None:
    assert study_in(tmp_path, GRID).samples == 4 * 5 * 3


def test_a_saltelli_design_has_samples_for_each_point(tmp_path: Path) -> None:
    assert study_in(tmp_path, STUDY.replace('"sobol"', '"saltelli"')).samples == 256 * 5


def test_a_latin_hypercube_that_would_not_fit_the_memory_is_refused(tmp_path: Path) -> None:
    lines = "".join(f'"chambers.{k}.{name}" = {{ uniform = [1e-6, 2e-6] }}\n' for k in (0, 1) for name in
                    ("radius", "height", "inner_radius", "plane"))  # fmt: skip
    study = STUDY.replace('"sobol"', '"latin_hypercube"').replace("samples = 256", "samples = 9_000_000")
    with pytest.raises(SceneError, match="at most 4545454 with 11 varied fields"):
        study_in(tmp_path, study + lines)


def test_an_exciter_is_refused(tmp_path: Path) -> None:
    scene = (EXAMPLES / "vibratory_table.toml").read_text(encoding="utf-8")
    with pytest.raises(SceneError, match="this command takes no machine of this one"):
        study_in(tmp_path, STUDY, scene)


def test_all_faults_are_named_at_once(tmp_path: Path) -> None:
    study = STUDY.replace("uniform", "unform")
    with pytest.raises(SceneError) as caught:
        study_in(tmp_path, study)
    assert len(caught.value.faults) == 2


def test_units_and_order_of_keys_do_not_change_the_digest_and_values_do(tmp_path: Path) -> None:
    own = study_in(tmp_path).digest
    assert study_in(tmp_path, STUDY.replace('"3 kg"', "3.0"), SCENE.replace('"4 kg"', "4.0")).digest == own
    changes = (("3 kg", "3.1 kg"), ("seed = 11", "seed = 12"), ("256", "257"), ("brine", "water"))
    for right, wrong in (*changes, ("sobol", "random"), ("density = 900", "density = 901")):
        assert study_in(tmp_path, STUDY.replace(right, wrong)).digest != own
    assert study_in(tmp_path, STUDY, SCENE.replace('"4 kg"', '"5 kg"')).digest != own


def test_the_scene_is_found_from_the_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "below").mkdir()
    path = write_study(tmp_path / "below")
    monkeypatch.chdir(tmp_path)
    assert load_sweep(path.relative_to(tmp_path)).scene.name == "Rig"


@pytest.mark.parametrize("path", sorted((EXAMPLES / "studies").glob("*.toml")), ids=lambda path: path.stem)
def test_example_studies_are_without_faults(path: Path) -> None:
    assert load_sweep(path).samples > 1


@pytest.mark.parametrize("name", ["tub.toml", "two_plane_rig.toml", "washing_machine.toml"])
def test_every_number_of_an_example_can_vary(name: str) -> None:
    """Whatever stands under rotor, chambers or model has a rule that takes what stands there."""
    from leblanc.scene.schema.load import read_toml

    table = read_toml(EXAMPLES / name)
    found = list(_leaves({key: table[key] for key in ("rotor", "chambers", "model")}))
    assert len(found) > 10
    for path, value in found:
        if path != "rotor.kind":
            rule_at(Scene, table, path)(value)


def _leaves(value: object, path: str = "") -> list[tuple[str, object]]:
    pairs = (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    )
    if pairs is None:
        return [(path[1:], value)]
    return [leaf for key, below in pairs for leaf in _leaves(below, f"{path}.{key}")]


def test_other_values_leave_the_table_as_it_was(tmp_path: Path) -> None:
    table = study_in(tmp_path).table
    before = repr(table)
    changed = with_values(table, [(keys_of("chambers.1.volume"), 1e-5), (keys_of("model.liquid"), "auto")])
    assert repr(table) == before
    assert changed["chambers"][1]["volume"] == 1e-5
    assert changed["chambers"][0] is table["chambers"][0]
    assert scene_from_table(changed).model.liquid == "auto"
    assert np.isclose(scene_from_table(changed).chambers[1].volume, 1e-5, rtol=1e-15)


def test_a_single_speed_moves_as_one(tmp_path: Path) -> None:
    """Of one speed start and stop stay equal, whichever is varied; of several each is its own."""
    table = study_in(tmp_path).table
    for end in ("start", "stop"):
        one = table | {"speeds": {"start": 10.0, "stop": 10.0, "count": 1}}
        assert with_values(one, [(("speeds", end), 55.0)])["speeds"] == {
            "start": 55.0,
            "stop": 55.0,
            "count": 1,
        }
        many = table | {"speeds": {"start": 10.0, "stop": 90.0, "count": 3}}
        moved = with_values(many, [(("speeds", end), 55.0)])["speeds"]
        assert moved == many["speeds"] | {end: 55.0}


def test_a_support_is_varied_alike_in_all_directions(tmp_path: Path) -> None:
    """What may have a value for each direction takes any number between bounds as well."""
    text = (
        f'scene = "{(EXAMPLES / "two_plane_rig.toml").as_posix()}"\nmethod = "sobol"\nsamples = 4\nseed = 1\n'
        '[vary]\n"rotor.supports.0.damping" = { uniform = ["10 N*s/m", "20 N*s/m"] }\n'
    )
    file = tmp_path / "study.toml"
    file.write_text(text, encoding="utf-8")
    (varied,) = load_sweep(file).fields
    assert varied.path == "rotor.supports.0.damping" and varied.unit == "N*s/m"
