"""The wheel alone: what it holds, and the steps of the README from it, away from the sources."""

from __future__ import annotations

import json
import lzma
import os
import re
import subprocess
import sys
import zipfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from validation.run_notebooks import FOR_USERS, texts

ROOT = Path(__file__).parent.parent
PACKAGES = ("meshes", "fluid", "solvers", "leblanc", "validation")
_BLOCK = re.compile(r"^ *```(?P<kind>\w*)\n(?P<body>.*?)^ *```$", re.MULTILINE | re.DOTALL)
_COMMAND = "import sys\nfrom leblanc.cli import main\n\nif __name__ == '__main__':\n    sys.exit(main())\n"

Run = Callable[[str], subprocess.CompletedProcess[str]]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel as its build makes it."""
    builders = pytest.importorskip("hatchling.builders.wheel")
    folder = tmp_path_factory.mktemp("dist")
    built = builders.WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"])
    return Path(next(built))


@pytest.fixture(scope="module")
def environment(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Of a shell with the wheel's packages and not those of the sources."""
    unpacked, bin_ = (tmp_path_factory.mktemp(name) for name in ("wheel", "bin"))
    with zipfile.ZipFile(wheel) as content:
        content.extractall(unpacked)
    script = bin_ / "leblanc"
    script.write_text(f"#!{sys.executable}\n{_COMMAND}", encoding="utf-8")
    script.chmod(0o755)
    path = os.pathsep.join([str(bin_), str(Path(sys.executable).parent), os.environ["PATH"]])
    return os.environ | {"PATH": path, "PYTHONPATH": str(unpacked)}


@pytest.fixture
def run(environment: dict[str, str], tmp_path: Path) -> Run:
    """Run a line of a shell in a folder that was empty when the test began."""

    def done(line: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            line, shell=True, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )

    return done


def files(folder: Path) -> set[str]:
    """What the sources of a folder are, without what Python and numba compiled."""
    found = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {path.relative_to(folder).as_posix() for path in found}


def test_holds_the_packages_and_the_examples_and_nothing_else(wheel: Path) -> None:
    """Modules, templates, data of the validation, notebooks; the examples inside `leblanc`."""
    with zipfile.ZipFile(wheel) as content:
        held = {name for name in content.namelist() if ".dist-info/" not in name}
    wanted = {f"{package}/{name}" for package in PACKAGES for name in files(ROOT / package)}
    assert held == wanted | {f"leblanc/examples/{name}" for name in files(ROOT / "examples")}
    assert {f"validation/notebooks/{path.name}" for path in texts()} <= held
    assert {f"validation/notebooks/users/{name}.py" for name in FOR_USERS} <= held
    assert {"validation/data/openfoam_layer.json", "leblanc/examples/studies/fill_grid.toml"} <= held


def test_its_commands_run_away_from_the_sources(run: Run) -> None:
    lines = (
        *("new --list", "validate vector_model", "trade --help", "new --example studies/fill_grid"),
        *("new --example spindle", "run spindle.toml"),
    )
    done = run(
        "python -P - <<'END'\nimport leblanc, validation\nfrom leblanc.cli import main\n"
        "print(leblanc.__file__, validation.__file__)\n"
        f"for line in {lines}:\n    print(line, '->', main(line.split()))\nEND"
    )
    assert done.returncode == 0 and str(ROOT) not in done.stdout, done.stderr
    assert all(f"{line} -> 0\n" in done.stdout for line in lines), done.stdout
    done = run("leblanc notebooks nothing")
    assert done.returncode == 2 and "1_paraboloid" in done.stderr


def steps() -> list[str]:
    """Commands of the README in their order; the block of Python as one of them."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    found = []
    for block in _BLOCK.finditer(text):
        body = block["body"].replace("\\\n", " ")
        if block["kind"] == "python":
            found.append(f"python - <<'END'\n{body}END")
        elif not block["kind"]:
            found += [line.strip() for line in body.splitlines()]
    return found


def test_the_readme_is_short_and_names_each_command() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 90 and max(map(len, text.splitlines())) <= 130
    named = set(re.findall(r"leblanc ([\w-]+)", text))
    alone = {"compare", "map", "runup", "optimise", "sweep", "fit", "layer", "modes", "volume", "view"}
    assert named >= {"new", "run", "explain", "validate", *alone}


def test_the_tally_of_the_readme_is_that_of_validate() -> None:
    """As the kept answers of its groups have it."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    verdicts: Counter[str] = Counter()
    for path in (ROOT / "tests/net/kept").glob("validate-*.json.xz"):
        kept = json.loads(lzma.decompress(path.read_bytes()))
        verdicts.update(case["verdict"] for case in kept["stdout"]["cases"])
    said = re.search(
        r"lays (\d+) claims.* (\d+) agree, (\d+) .* (\d+) are trends, (\d+) differ", text, re.DOTALL
    )
    assert said is not None
    each = [verdicts[name] for name in ("agrees", "erratum", "trend", "differs")]
    assert [int(number) for number in said.groups()] == [verdicts.total(), *each]
    assert f"{verdicts.total()} published numbers and statements, of which {each[-1]} differ" in text
    front, evidence = (
        (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8") for name in ("index", "evidence")
    )
    said = re.search(
        r"(\d+) published numbers.* (\d+) agree, (\d+) .* (\d+) are trends that\nhold, and (\d+) differ",
        front,
        re.DOTALL,
    )
    assert said is not None
    assert [int(number) for number in said.groups()] == [verdicts.total(), *each]
    assert all(str(number) in evidence for number in (verdicts.total(), *each))


@pytest.mark.slow
@pytest.mark.notebook
def test_steps_of_the_readme(run: Run) -> None:
    """Word for word, but for what is installed: that is here already."""
    for name in ("jupytext", "nbclient", "nbconvert", "ipykernel"):
        pytest.importorskip(name)
    for line in steps():
        if line.startswith("pip install"):
            continue
        if example := re.search(r"examples/(\w+)\.toml", line):
            run(f"mkdir examples; leblanc new --example {example[1]} {example[0]}")
        done = run(line)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
