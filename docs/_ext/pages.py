"""What the pages take from the code: commands, ranges of the models, kept errors; the style of references."""

from __future__ import annotations

import inspect
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from docutils import nodes
from pybtex.plugin import register_plugin
from pybtex.style.formatting.plain import Style
from pybtex.style.labels import BaseLabelStyle
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


class KeyLabels(BaseLabelStyle):
    """A reference is called by its key, as in the docstrings."""

    def format_labels(self, sorted_entries: Sequence[Any]) -> list[str]:
        """Labels of the entries."""
        return [entry.key for entry in sorted_entries]


class Keyed(Style):
    """Plain references with their keys."""

    default_label_style = KeyLabels

    def format_entry(self, label: str, entry: Any, bib_data: Any = None) -> Any:
        """An entry; what shows no year is called undated."""
        entry.fields.setdefault("year", "undated")
        return super().format_entry(label, entry, bib_data)


class Commands(SphinxDirective):
    """A section for each command of `leblanc`: what its `--help` says."""

    def run(self) -> list[nodes.Node]:
        """The sections, in the order of the command line."""
        return [_command_section(name, command) for name, command in _commands().items()]


def command_names() -> list[str]:
    """Commands of `leblanc`."""
    return list(_commands())


def _command_section(name: str, command: Any) -> nodes.section:
    """Usage, what a command does, and each argument and option with its meaning, at whatever width."""
    context = command.make_context(name, [], resilient_parsing=True)
    title = f"leblanc {name}"
    usage = " ".join((title, *command.collect_usage_pieces(context)))
    said = [nodes.paragraph("", text) for text in inspect.cleandoc(command.help).split("\n\n")]
    records = [param.get_help_record(context) for param in command.get_params(context)]
    items = [
        nodes.definition_list_item(
            "", nodes.term("", "", nodes.literal(term, term)), nodes.definition("", nodes.paragraph("", text))
        )
        for term, text in filter(None, records)
    ]
    return nodes.section(
        "",
        nodes.title(title, title),
        nodes.literal_block(usage, usage, language="text"),
        *said,
        nodes.definition_list("", *items, classes=["options"]),
        ids=[f"leblanc-{name}"],
        names=[title],
    )


def _commands() -> dict[str, Any]:
    """The commands themselves, by name."""
    import typer.main

    from leblanc.cli import application

    commands: dict[str, Any] = vars(typer.main.get_command(application()))["commands"]
    return commands


class Ranges(SphinxDirective):
    """The numbers that bound a model, as the model itself has them."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """A table, or a sentence where there is no bound."""
        from leblanc.liquid.models import wave_model
        from leblanc.liquid.validity import MEANING

        bounds = wave_model(self.arguments[0]).ranges
        if not bounds:
            return [nodes.paragraph("", "No number bounds this model.")]
        rows = [(name, MEANING[name], _interval(*bounds[name])) for name in bounds]
        return [table(("number", "meaning", "range"), rows, code=(0,))]


def _interval(least: float, most: float) -> str:
    return f"at least {least:g}" if math.isinf(most) else f"{least:g} to {most:g}"


class KnownLiquids(SphinxDirective):
    """The liquids that a scene names, and from where to where they are known over temperature."""

    def run(self) -> list[nodes.Node]:
        """A table with one row for each."""
        from fluid.liquid import KNOWN_LIQUIDS, law_of
        from fluid.temperature import CELSIUS

        rows = []
        for name, liquid in KNOWN_LIQUIDS.items():
            law = law_of(liquid)
            span = "" if law is None else f"{law.lowest - CELSIUS:.4g} to {law.highest - CELSIUS:.4g}"
            source = "" if law is None else law.source
            rows.append((name, f"{liquid.density:.5g}", f"{liquid.viscosity * 1e6:.4g}", span, source))
        head = ("name", "density at 20 degC (kg/m^3)", "viscosity (mm^2/s)", "law (degC)", "its source")
        return [table(head, rows, code=(0,))]


class KeptErrors(SphinxDirective):
    """Errors and times of a model in the kept comparison of all shipped scenes."""

    required_arguments = 2

    def run(self) -> list[nodes.Node]:
        """A table with the best row of the model for each scene."""
        model, question = self.arguments
        rows = list(_kept_rows(model, question))
        head = ("scene", "resolution", "error", "CPU time")
        if not any(size for _, size, *_ in rows):
            return [table(("scene", *head[2:]), [(row[0], *row[2:]) for row in rows], code=(0,))]
        return [table(head, rows, code=(0,))]


def _kept_rows(model: str, question: str) -> list[tuple[str, str, str, str]]:
    from validation.trade import kept, names

    found = []
    for name in names():
        rows = [r for r in kept(name)["rows"] if r["question"] == question and r["model"] == model]
        rows = [r for r in rows if r["error"] is not None and not r["variant"]]
        # The finest is often the reference itself: one step below it says what a user gets.
        rows = sorted(rows, key=lambda r: r["resolution"] or 0)
        for row in rows[:1] if len(rows) < 3 else (rows[0], rows[len(rows) // 2], rows[-2]):
            error = f"{row['error']:.1e}" if row["resolved"] else "below the best answer's own"
            size = "" if row["resolution"] is None else f"{row['resolution']} cells"
            found.append((name, size, error, _time(row["time"])))
    return found


def _time(seconds: float) -> str:
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


class ColdStarts(SphinxDirective):
    """Where the time of commands goes from a cold start, as measured and kept."""

    def run(self) -> list[nodes.Node]:
        """A table with one row for each command."""
        from tests.cold_start.start import kept

        found = kept()
        head = ("command", "CPU time", "its libraries alone", "ratio", "without physics", *found[0].parts())
        rows = [
            (
                " ".join(("leblanc", *(Path(word).name for word in start.arguments))),
                *(f"{seconds:.2f} s" for seconds in (start.total, start.libraries)),
                *(f"{ratio:.2f}" for ratio in (start.ratio, (start.total - start.physics) / start.libraries)),
                *(f"{seconds:.2f} s" for seconds in start.parts().values()),
            )
            for start in found
        ]
        return [table(head, rows, code=(0,))]


class ModelsTable(SphinxDirective):
    """Every liquid model on two example scenes, its error and its time, as measured and kept."""

    def run(self) -> list[nodes.Node]:
        """A table with one row for each model."""
        from tests.models import kept, words

        head = ["model"]
        for found in kept():
            head += [f"{found.scene}: error", "time of a speed"]
        return [table(head, words(), code=(0,))]


def table(head: Sequence[str], rows: Sequence[Sequence[str]], code: Sequence[int] = ()) -> nodes.table:
    """A table of text; the columns `code` are names in the code."""
    group = nodes.tgroup(cols=len(head))
    group += [nodes.colspec(colwidth=1) for _ in head]
    group += nodes.thead("", _row(head, ()))
    group += nodes.tbody("", *(_row(row, code) for row in rows))
    return nodes.table("", group)


def _row(cells: Sequence[str], code: Sequence[int]) -> nodes.row:
    row = nodes.row()
    for k, cell in enumerate(cells):
        inner = nodes.literal(cell, cell) if k in code else nodes.Text(cell)
        row += nodes.entry("", nodes.paragraph("", "", inner))
    return row


def setup(app: Sphinx) -> dict[str, Any]:
    """Register with Sphinx."""
    register_plugin("pybtex.style.formatting", "keyed", Keyed)
    app.add_directive("all-commands", Commands)
    app.add_directive("model-ranges", Ranges)
    app.add_directive("kept-errors", KeptErrors)
    app.add_directive("known-liquids", KnownLiquids)
    app.add_directive("cold-starts", ColdStarts)
    app.add_directive("models-table", ModelsTable)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
