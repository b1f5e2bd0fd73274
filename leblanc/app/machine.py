"""A machine file while it is changed: its text with comments and units, undo, redo, what was refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import tomlkit
from tomlkit import TOMLDocument

from leblanc.app.fields import form_of, given_at, unit_shown, value_of
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError, SceneFault, scene_table, shown
from leblanc.scene.schema.part import rule_of
from leblanc.scene.schema.paths import Keys, entry_rule, keys_of, require_field, with_values
from leblanc.scene.schema.rules import Quantity, Refused

STEPS = 1000  # of undo that are kept


class Machine:
    """A machine file and its changes.

    A value that is refused leaves everything as it was, and `faults` says what is allowed.
    """

    def __init__(self, text: str, file: str = "scene.toml") -> None:
        """Raises a `SceneError` with everything that is wrong with the text."""
        self.file = file
        self.faults: dict[str, str] = {}
        self._texts, self._at = [text], 0
        self._anchors: dict[str, float] = {}
        self._take(text)

    @property
    def text(self) -> str:
        """Of the file as it would be saved."""
        return self._texts[self._at]

    @property
    def can_undo(self) -> bool:
        """There is a step back."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """There is a step forward again."""
        return self._at + 1 < len(self._texts)

    def form(self) -> list[dict[str, Any]]:
        """Groups of fields."""
        return form_of(self.scene, self._table, self._anchors)

    def drag(self, path: str, typed: str) -> bool:
        """Take a value for the time being, as a slider goes by; `edit` or another drag follows.

        False, and a fault, where it is refused.
        """
        return self._tried(path, lambda: self._varied(path, typed))

    def edit(self, path: str, typed: str) -> bool:
        """Take a value as one step of undo; an empty text takes it out of the file. False if refused."""

        def changed() -> Scene:
            scene = self._varied(path, typed)
            document = tomlkit.parse(self.text)
            keys = keys_of(path)
            if typed.strip():
                _put(document, keys, self._value(path, typed))
            else:
                _take_out(document, keys)
            text = document.as_string()
            if text != self.text:
                self._keep(text)
            return scene

        return self._tried(path, changed)

    def put(self, values: dict[str, str]) -> bool:
        """Take several values as one step; False, and the faults, where they are refused together."""
        document = tomlkit.parse(self.text)
        for path, typed in values.items():
            _put(document, keys_of(path), typed)
        text = document.as_string()

        def changed() -> Scene:
            scene = self._read(text)
            self._keep(text)
            return scene

        return self._tried(next(iter(values)), changed)

    def undo(self) -> None:
        """One step back."""
        self._go(-1)

    def redo(self) -> None:
        """One step forward again."""
        self._go(+1)

    def _go(self, step: int) -> None:
        if 0 <= self._at + step < len(self._texts):
            self._at += step
        self._take(self.text)
        self.faults = {}

    def _keep(self, text: str) -> None:
        self._texts = [*self._texts[: self._at + 1], text][-STEPS:]
        self._at = len(self._texts) - 1

    def _take(self, text: str) -> None:
        self.scene = self._read(text)
        self._table = scene_table(text, self.file)

    def _read(self, text: str) -> Scene:
        return scene_from_table(scene_table(text, self.file), self.file, text)

    def _tried(self, path: str, change: Callable[[], Scene]) -> bool:
        """The scene after a change that goes well; else the fault at its path and all as before."""
        text = self.text
        try:
            self.scene = change()
        except SceneError as error:
            self.faults = {path: "; ".join(map(_said, error.faults))}
            self._take(self.text)
            return False
        if self.text != text:
            self._table = scene_table(self.text, self.file)
        self.faults = {}
        return True

    def _varied(self, path: str, typed: str) -> Scene:
        """The scene with another value, the text left as it is."""
        keys, table = keys_of(path), self._table
        if not typed.strip():
            document = tomlkit.parse(self.text)
            _take_out(document, keys)
            return self._read(document.as_string())
        before = self._number(keys)
        if before is not None:  # the ends of a slider stay as long as the value is between them
            self._anchors.setdefault(path, before)
        value = self._value(path, typed)
        return scene_from_table(with_values(table, [(keys, value)]), self.file)

    def _value(self, path: str, typed: str) -> Any:
        """What a typed text means at a path; a `SceneError` if that leads nowhere."""
        keys, table = keys_of(path), self._table
        try:
            field, depth = require_field(Scene, table, path)
        except Refused as refused:
            raise SceneError([SceneFault(self.file, path, shown(typed), refused.allowed)]) from refused
        rule = rule_of(field)
        if keys[depth + 1 :]:
            rule = getattr(rule, "each", None) or entry_rule(field.annotation)
        unit = ""
        if isinstance(rule, Quantity):
            unit = unit_shown(given_at(table, keys), self._number(keys), rule.dimension).name
        return value_of(typed, rule, unit)

    def _number(self, keys: Keys) -> float | None:
        """The number that the scene has at some keys; None where there is none."""
        value: Any = self.scene
        for key in keys:
            inside = isinstance(key, int) and isinstance(value, tuple) and key < len(value)
            value = value[int(key)] if inside else getattr(value, str(key), None)
        plain = isinstance(value, int | float) and not isinstance(value, bool)
        return float(value) if plain else None


def _said(fault: SceneFault) -> str:
    """A fault without the name of the file, which is one here."""
    given = "" if fault.value is None else f" = {fault.value}"
    return f"{fault.field}{given}: must be {fault.allowed}"


def _put(document: TOMLDocument, keys: Keys, value: Any) -> None:
    """Another value at some keys; comments stay."""
    node: Any = document
    for key in keys[:-1]:
        if not isinstance(key, int) and key not in node:
            node[key] = tomlkit.table()
        node = node[key]
    node[keys[-1]] = value


def _take_out(document: TOMLDocument, keys: Keys) -> None:
    """No value at some keys, nor a mark of it as assumed."""
    node: Any = document
    for key in keys[:-1]:
        node = node[key] if isinstance(key, int) or key in node else {}
    if isinstance(keys[-1], int):
        return
    if keys[-1] in node:
        del node[keys[-1]]
    path = ".".join(map(str, keys))
    marks = document.get("assumed")
    if marks is not None and path in marks:
        marks.remove(path)
