"""Old names lead to the new ones, with a warning; our own code knows none of them."""

import re
import tomllib
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.core.quantities import names
from leblanc.moved import _GONE, ALIASES, ATTRIBUTES, NAMES


@pytest.mark.parametrize("old", NAMES)
def test_an_old_path_leads_to_the_new_class(old):
    module, _, name = old.partition(":")
    place, _, new = NAMES[old].partition(":")
    with pytest.warns(DeprecationWarning, match=re.escape(f"{place}.{new} now")) as told:
        found = getattr(import_module(module), name)
    assert found is getattr(import_module(place), new)
    assert [each.filename for each in told] == [__file__]


def test_what_never_was_is_not_found():
    with pytest.raises(AttributeError, match="Other"):
        _ = import_module("leblanc.results.runup").Other
    with pytest.raises(ModuleNotFoundError, match=r"leblanc\.results\.other"):
        import_module("leblanc.results.other")
    with pytest.raises(AttributeError, match="'RunAnswer' object has no attribute 'other'"):
        _ = lb.run(lb.example("horizontal_rig").replace({"speeds.count": 2})).other


def test_old_attributes_are_the_new_ones():
    answer = lb.run(lb.example("horizontal_rig").replace({"speeds.count": 2}))
    with pytest.warns(DeprecationWarning, match=r"response\.branch_amplitude") as told:
        found = answer.branch_amplitude
    np.testing.assert_array_equal(found, np.abs(answer.response.branch_deflection))
    assert [each.filename for each in told] == [__file__]
    assert answer.annulus_speed == answer.carried_from
    assert answer.time_domain_at is answer.held_at
    assert not set(ALIASES) & set(answer.to_json())
    chart = lb.map_whirl(lb.example("horizontal_rig"), volumes=2, speeds=2)
    with pytest.warns(DeprecationWarning):
        assert chart.branches is None


@pytest.mark.parametrize("kind", ATTRIBUTES)
def test_old_attributes_lead_to_attributes(kind):
    places = {new.partition(":")[2]: new.partition(":")[0] for new in NAMES.values()}
    answer = getattr(import_module(places[kind]), kind)
    known = {*dir(answer), *names(answer), *answer.__dataclass_fields__}
    assert not known & set(ATTRIBUTES[kind])
    assert {path.split(".")[0] for path in ATTRIBUTES[kind].values()} <= known


def test_our_own_code_and_pages_know_no_old_path():
    root = Path(lb.__file__).parents[1]
    old = re.compile("|".join(sorted({re.escape(name.partition(":")[0]) + r"\b" for name in NAMES})))
    places = [
        path
        for folder in ("leblanc", "solvers", "fluid", "meshes", "validation", "docs")
        for path in (root / folder).rglob("*")
        if path.suffix in (".py", ".md")
    ]
    known = {"leblanc/moved.py"}
    assert len(places) > 400
    assert {str(path.relative_to(root)) for path in places if old.search(path.read_text("utf-8"))} <= known


def test_one_version_everywhere():
    root = Path(lb.__file__).parents[1]
    version = tomllib.loads((root / "pyproject.toml").read_text())["project"]["version"]
    assert f"version: {version}\n" in (root / "CITATION.cff").read_text()
    assert f"leblanc-{version}-py3" in (root / "README.md").read_text()
    assert re.search(r"^## (\S+)", (root / "CHANGELOG.md").read_text(), re.M)[1] == version
    assert int(_GONE.split(".")[1]) > int(version.split(".")[1])
