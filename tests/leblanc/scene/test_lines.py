"""Every key of a file is found at its line.

The oracle is the file itself: every value written into it is the number of its own line, so that what
`tomllib` reads at a path is the line that must be told for it.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from leblanc.scene.examples import example_names, example_path
from leblanc.scene.schema.load import field_path, line_of, places

KEYS = st.one_of(
    st.text("abcxyz_-09", min_size=1, max_size=4),
    st.sampled_from(["a b", 'quo"te', "dot.ted", "#no", "[x]", "=", "ä", "'"]),
)
NOISE = st.sampled_from(
    [
        "",
        "# [comment]\n# key = 1\n",
        "\n\n",
        'noise{} = """\n[not]\nkey = 1 # no\n\\""" \\\\"""\n',
        "noise{} = '''\n[[not]]\n'a' = 2'''\n",
        'noise{} = "one = 1 # ] } \\" "\n',
        "noise{} = '}] #'\n",
        "noise{} = 1979-05-27 07:32:00 # date\n",
    ]
)
VALUES = st.recursive(
    st.none(),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(KEYS, inner, max_size=3).map(lambda it: ("inline", it))
    ),
    max_leaves=5,
)
TABLES = st.lists(
    st.tuples(st.booleans(), KEYS, st.dictionaries(KEYS, VALUES, max_size=3), NOISE, st.booleans()),
    max_size=6,
)


class Writer:
    """Writes TOML in which each value is the number of its line."""

    def __init__(self) -> None:
        self.text, self.count = "", 0

    @property
    def line(self) -> int:
        return self.text.count("\n") + 1

    def key(self, name: str) -> str:
        bare = name and all(letter in "abcxyz_-09" for letter in name)
        return name if bare else json.dumps(name, ensure_ascii=False)

    def noise(self, text: str) -> None:
        self.count += 1
        self.text += text.replace("noise{}", f"noise{self.count}")

    def value(self, value: Any) -> None:
        if value is None:
            self.text += str(self.line)
        elif isinstance(value, list):
            self.text += "["
            for entry in value:
                self.text += "\n  # ], here\n  "
                self.value(entry)
                self.text += " ,"
            self.text += "]"
        else:
            self.text += "{ "
            for k, (name, entry) in enumerate(value[1].items()):
                self.text += (", " if k else "") + f"{self.key(name)} = "
                self.value(entry)
            self.text += " }"

    def pairs(self, table: dict[str, Any], dotted: bool) -> None:
        for k, (name, value) in enumerate(table.items()):
            self.text += f"{f'dots . {k} . ' if dotted else ''}{self.key(name)} = "
            self.value(value)
            self.text += "  # end\n"


def leaves(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    if isinstance(value, dict):
        for key, entry in value.items():
            yield from leaves(entry, (*path, key))
    elif isinstance(value, list):
        for k, entry in enumerate(value):
            yield from leaves(entry, (*path, k))
    else:
        yield path, value


@given(TABLES)
def test_every_value_is_found_at_its_line(
    tables: list[tuple[bool, str, dict[str, Any], str, bool]],
) -> None:
    writer = Writer()
    for several, name, table, noise, dotted in tables:
        head = f"t{writer.key(name)}" if writer.key(name) == name else writer.key(name)
        many = f"many.{head}" if several else f"only{len(writer.text)}.{head}"
        writer.noise("# head\n")
        writer.text += f"[[ {many} ]]\n" if several else f"[{many}]\n"
        writer.noise(noise)
        writer.pairs(table, dotted)
        if several:
            writer.text += f"[{many}.below]\n"
            writer.pairs({"deep": None}, dotted)
    root, read = places(writer.text), tomllib.loads(writer.text)
    for path, value in leaves(read):
        if isinstance(value, int):
            assert line_of(root, field_path(path)) == value, (path, writer.text)


@pytest.mark.parametrize("name", example_names())
def test_the_examples_have_each_key_at_its_line(name: str) -> None:
    """The last key of a path stands in the line that is reported for it."""
    text = example_path(name).read_text(encoding="utf-8")
    root, lines = places(text), text.splitlines()
    for path, _ in leaves(tomllib.loads(text)):
        line = line_of(root, field_path(path))
        names = [key for key in path if isinstance(key, str)]
        assert line is not None
        assert names[-1] in lines[line - 1] or isinstance(path[-1], int), (path, line)


def test_what_is_missing_is_told_at_the_table_it_is_missing_from() -> None:
    root = places("a = 1\n\n[b]\nc = 2\n[[d]]\n[[d]]\nx.y = 3\n")
    assert line_of(root, "b.none") == 3
    assert line_of(root, "d.1.z") == 6 and line_of(root, "d.1.x.z") == 7 and line_of(root, "d.0") == 5
    assert line_of(root, "none") is None


def test_long_dotted_keys_take_linear_room() -> None:
    """40 000 keys in one path: a place each, not a path each."""
    text = ".".join("a" * 40_000) + " = 1"
    place, count = places(text), 0
    while place.below:
        (place,) = place.below.values()
        count += 1
    assert count == 40_000
