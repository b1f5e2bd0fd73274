"""Where a result comes from: the versions that computed it and the attributes that all datasets share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import metadata
from typing import Protocol

from leblanc.results.notes import Note


def one_line(text: str) -> str:
    """Text without line breaks and control characters, which files and figures cannot carry."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def versions(packages: Iterable[str] = ("leblanc", "numpy", "scipy")) -> dict[str, str]:
    """Versions of packages, by default of this one and of the libraries that all numbers come from."""
    found = {}
    for package in packages:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:  # run from a source tree that was never installed
            found[package] = "not installed"
    return found


class OfScene(Protocol):
    """A result that says which scene it belongs to."""

    @property
    def name(self) -> str:
        """Name of the scene."""

    @property
    def source(self) -> str:
        """Where its values come from."""

    @property
    def assumed(self) -> tuple[str, ...]:
        """Paths of the values that no source gives."""

    @property
    def digest(self) -> str:
        """Fingerprint of the scene."""


def attributes(
    result: OfScene, command: str, own: Mapping[str, str], notes: Iterable[Note | str]
) -> dict[str, str]:
    """Attributes of the dataset of a result: scene, what is its own, notes, versions.

    Parameters
    ----------
    result : names its scene
    command : that writes the dataset
    own : attributes that only this kind of result has
    notes : of the result
    """
    said = [one_line(note if isinstance(note, str) else note.text) for note in notes]
    return {
        "title": one_line(result.name),
        "source": one_line(result.source) or "not stated",
        "digest": result.digest,
        "assumed": "; ".join(map(one_line, result.assumed)) or "nothing",
        **own,
        "notes": "\n".join(said) or "none",
        "history": f"written by leblanc {command}",
        **{f"version_{package}": version for package, version in versions().items()},
    }
