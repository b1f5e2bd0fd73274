"""Kept results of `leblanc trade` on every shipped scene, and how to make them again."""

from __future__ import annotations

import hashlib
import json
import tomllib
from importlib import resources
from pathlib import Path
from typing import Any


def kept(name: str) -> dict[str, Any]:
    """Kept result of a scene, by the stem of its file."""
    text = resources.files("validation.trade").joinpath(f"{name}.json").read_text(encoding="utf-8")
    content: dict[str, Any] = json.loads(text)
    return content


def fingerprint(path: Path) -> str:
    """SHA-256 of what a scene's file says, whatever its layout and what the package makes of it."""
    content = json.dumps(tomllib.loads(path.read_text(encoding="utf-8")), sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()


def names() -> list[str]:
    """Stems of the scenes that there are results of, in alphabetical order."""
    found = [entry.name for entry in resources.files("validation.trade").iterdir()]
    return sorted(name.removesuffix(".json") for name in found if name.endswith(".json"))
