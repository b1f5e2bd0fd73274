"""The page of `leblanc app`: a machine as fields and sliders beside its answer.

`fields` makes the form from the scene's models, `machine` is the file while it is changed, `live` answers
it, `jobs` start what takes its time, `state` is all that a page shows; trame is known by `page` alone.
"""

from __future__ import annotations

from importlib.util import find_spec

from meshes.errors import InputError


def require_app() -> None:
    """Raise an `InputError` where libraries of the page are not installed."""
    for name in ("trame", "trame_vuetify", "tomlkit"):
        if find_spec(name) is None:
            raise InputError(
                "app", f"no {name}", "asked for once the extra is installed: pip install leblanc[app]"
            )
