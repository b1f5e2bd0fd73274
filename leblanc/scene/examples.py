"""The scenes that come with the package."""

from __future__ import annotations

import re
from pathlib import Path

from leblanc.scene.scene import Scene, load_scene
from leblanc.scene.schema.load import meant
from meshes.errors import InputError

_SENTENCE, _CITATION = re.compile(r"\.(?:\s|$)"), re.compile(r" \[[^]]*\]")


def _folder() -> Path:
    """In the package as it is installed, beside it in a checkout."""
    package = Path(__file__).parents[1]
    inside = package / "examples"
    return inside if inside.is_dir() else package.parent / "examples"


def example_names() -> tuple[str, ...]:
    """Names of the scenes, and of the studies as "studies/NAME"."""
    found = [*_folder().glob("*.toml"), *_folder().glob("studies/*.toml")]
    return tuple(sorted(path.relative_to(_folder()).with_suffix("").as_posix() for path in found))


def example_path(name: str) -> Path:
    """File of a scene or study that comes with the package.

    Parameters
    ----------
    name : of `example_names`

    Raises
    ------
    InputError : there is none of that name

    Examples
    --------
    >>> example_path("tub").name
    'tub.toml'
    """
    names = example_names()
    if not isinstance(name, str) or name not in names:
        name = str(name)
        raise InputError("example", name, f"one of: {', '.join(names)}{meant(name, names)}")
    return _folder() / f"{name}.toml"


def example(name: str) -> Scene:
    """Scene that comes with the package.

    Parameters
    ----------
    name : of `example_names`; not that of a study

    Raises
    ------
    InputError : there is none of that name
    SceneError : it is a study

    Examples
    --------
    >>> example("tub").rotor.kind
    'tub'
    """
    return load_scene(example_path(name))


def example_title(name: str) -> str:
    """What an example is, in the first sentence of its file."""
    said = []
    for line in example_path(name).read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        said.append(line.strip("# "))
    sentence = _SENTENCE.split(_CITATION.sub("", " ".join(said)))[0].removesuffix(".")
    return f"{sentence}."
