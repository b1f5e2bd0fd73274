"""The command line: `leblanc COMMAND ...`.

Commands parse and print, nothing else. Their modules import what is heavy inside the function, so that
`leblanc --help` answers at once.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from importlib import import_module
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup
from typer.main import get_command

from leblanc.cli import app, diff, mcp, new, report_bug, schema, view
from leblanc.core.answer import NotConverged
from leblanc.core.contents import recording
from leblanc.core.interrupts import INTERRUPTED, TERMINATED, Terminated, behind, heard, leave, said
from leblanc.core.terminal import drop, ready_streams, say
from leblanc.registry import COMMANDS as ANNOUNCED
from leblanc.registry import announced, sound
from leblanc.scene.schema.load import SceneError, escaped
from meshes.errors import InputError
from solvers.compiling import SPENT, with_room

DONE, UNREAD, WRONG_INPUT, NOT_CONVERGED = 0, 1, 2, 3

# Commands in the order of the help, by what they are for: of some the module, a function of its name in it;
# those of the others are made from the signature of their call. Those of the last groups other packages have.
GROUPS = {
    "Begin": ("new", "app", "mcp", "explain", "schema", "diff"),
    "What the machine does": ("run", "runup", "map", "compare", "export", "view"),
    "Choose and measure": ("optimise", "sweep", "fit"),
    "The liquid alone, and parts": ("layer", "modes", "volume", "bearing"),
    "Results, and how far they are right": ("outputs", "validate", "trade", "notebooks", "report-bug"),
}
_ELSEWHERE = ("validate", "trade", "notebooks")
NAMES = tuple(name for names in GROUPS.values() for name in names if name not in _ELSEWHERE)
MODULES = {
    each.__name__.rpartition(".")[2].replace("_", "-"): each
    for each in (app, diff, mcp, new, report_bug, schema, view)
}
ALIASES = {"run_up": "runup", "run-up": "runup"}  # names that are read as well

# The current folder may hold a stranger's files: a pickle.py is not for the processes that are started from
# here, nor is the .numba_config.yaml to say where compiled code is kept, which numba would unpickle.
SAFE = {"PYTHONSAFEPATH": "1", "NUMBA_CACHE_DIR": "", "NUMBA_CACHE_LOCATOR_CLASSES": ""}

# What typer raises for a wrong command line; its home moved between versions.
_UsageError: type[Exception] = typer.BadParameter.__mro__[1]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments : what stands behind `leblanc`; those of this process if None

    Returns
    -------
    exit code: 0 done, 1 the reader of the output is gone, 2 wrong input, 3 a solver did not converge,
    130 interrupted by Ctrl-C, 143 ended by SIGTERM
    """
    for name, value in SAFE.items():
        os.environ.setdefault(name, value)
    given = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    given[0] = ALIASES.get(given[0], given[0])
    if arguments is None:
        ready_streams()
        # By default a fifth of a short command is a search for cyclic garbage, of which imports leave none.
        gc.set_threshold(50_000)
        # Nor has a command any use of plugins of pydantic, for which it looks in every installed package.
        os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")

    SPENT.clear()

    def command() -> object:
        commands = get_command(application(given[0]))
        try:
            return _recorded(given[0], lambda: _run(commands, given))
        finally:
            _tell_of_compiling()

    if arguments is not None:
        return exit_code(command)
    with heard():
        code: int = with_room(exit_code, command)
    drop(sys.stderr)
    gc.freeze()  # nor is there any to look for as the process ends
    leave(code)
    return code


def _run(commands: Any, given: Sequence[str]) -> object:
    return commands.main(given, prog_name="leblanc", standalone_mode=False)


def _recorded(command: str, action: Callable[[], object]) -> object:
    """Do it, and take down in the folder of its results which files it wrote."""
    with recording(command) as record:
        try:
            code = action()
        except NotConverged:  # what did converge is written
            _tell(record.close())
            raise
        _tell(record.close())
    return code


def _tell_of_compiling() -> None:
    """Say how long it took to compile, or that it could be kept nowhere, where anything was compiled."""
    loaded = sys.modules.get("solvers.machine_code")
    if loaded is None:
        return
    if loaded.cache_folder() is None:
        say("Note: compiled for this run alone, no cache can be written; NUMBA_CACHE_DIR may name a folder.")
    elif (spent := sum(SPENT)) >= _LONG:
        say(f"Note: {spent:.0f} s of it to compile, once for this computer; later runs take it from a cache.")


_LONG = 1.0  # s of compiling that are worth a word


def _tell(lines: Sequence[str]) -> None:
    for line in lines:
        say(escaped(line))


def exit_code(action: Callable[[], object]) -> int:
    """Do it, say on stderr what went wrong, one line each, and return the exit code."""
    try:
        code = action()
        sys.stdout.flush()
    except (SceneError, NotConverged) as error:
        say(str(error))
        return NOT_CONVERGED if isinstance(error, NotConverged) else WRONG_INPUT
    except InputError as error:
        say(escaped(f"leblanc: {error}"))
        return WRONG_INPUT
    except _UsageError as error:
        say(_usage(error))
        return WRONG_INPUT
    except BrokenPipeError:  # whoever read the output has enough of it
        drop(sys.stdout)
        return UNREAD
    except OSError as error:
        say(escaped(f"{error.filename or 'leblanc'}: {error.strerror or error}"))
        drop(sys.stdout)
        return WRONG_INPUT
    except KeyboardInterrupt:
        code = INTERRUPTED
    except Terminated:
        code = TERMINATED
    except Exception as error:
        interrupt = behind(error)
        if interrupt is None:
            raise
        code = TERMINATED if isinstance(interrupt, Terminated) else INTERRUPTED
    if code in (INTERRUPTED, TERMINATED):
        say(said(int(code) - 128))
    return code if isinstance(code, int) else DONE


def _usage(error: BaseException) -> str:
    """One line for a wrong command line."""
    context = getattr(error, "ctx", None)
    message = " ".join(str(getattr(error, "format_message", error.__str__)()).split())
    message += "" if message.endswith((".", "?")) else "."
    return escaped(f"leblanc: {message} See: {context.command_path if context else 'leblanc'} --help")


def _version(wanted: bool) -> None:
    if wanted:
        own, *others = report_bug.versions().items()
        print(f"leblanc {own[1]} ({', '.join(' '.join(one) for one in others)})")
        raise typer.Exit


class _Grouped(TyperGroup):
    """Commands by what they are for, each with its whole sentence."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write them into the help."""
        every = self.list_commands(ctx)
        known = {name for names in GROUPS.values() for name in names}
        groups = GROUPS | {"Of other packages": tuple(name for name in every if name not in known)}
        for title, names in groups.items():
            there = [(name, self.get_command(ctx, name)) for name in names if name in every]
            rows = [(name, command.get_short_help_str(_SENTENCE)) for name, command in there if command]
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)


_SENTENCE = 200  # characters that a command may say of itself
_WIDE = 100  # columns of a help


def application(wanted: str = "") -> typer.Typer:
    """All commands, those of installed packages too; only the wanted one of this package if it is named."""
    found = typer.Typer(
        name="leblanc",
        cls=_Grouped,
        add_completion=False,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"max_content_width": _WIDE},
    )

    @found.callback()
    def leblanc(
        version: Annotated[
            bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
        ] = False,
    ) -> None:
        """Passive liquid balancers: from the free surface to the machine."""

    for name in [wanted] if wanted in NAMES else NAMES:
        own = getattr(MODULES[name], name.replace("-", "_")) if name in MODULES else _asked(name)
        found.command(name)(_as_typed(own))
    if wanted not in NAMES:
        others = announced(ANNOUNCED, NAMES, _unread)
        for name in [wanted] if wanted in others else sorted(others):
            _add_announced(found, others[name])
    return found


def _asked(name: str) -> Callable[..., object]:
    """The command of a question."""
    from leblanc.cli.command import command

    return command(getattr(import_module(f"leblanc.studies.{name}"), name))


def _as_typed(command: Callable[..., object]) -> Callable[..., object]:
    """The command, telling what it refuses as a user has typed it: in the scene's file or as an option."""

    @wraps(command)
    def asked(**options: Any) -> object:
        try:
            return command(**options)
        except InputError as error:
            scene, fault = options.get("scene"), None
            changed = [text.partition("=")[0].strip() for text in options.get("set") or ()]
            if isinstance(scene, Path) and error.field not in changed:
                from leblanc.scene.scene import fault_in

                fault = fault_in(scene, error)
            if fault is not None:
                raise fault from error
            raise _option_as_typed(error, options) from error

    return asked


def _option_as_typed(error: InputError, given: Mapping[str, Any]) -> InputError:
    """What is refused of an option, with the value as it was typed and its bounds in the unit typed."""
    name = error.field.removeprefix("--").replace("-", "_")
    typed = given.get(name)
    if not isinstance(typed, str):
        return error
    if not error.field.startswith("--") and not typed.lstrip("+-. ")[:1].isdigit():
        return error  # no quantity: a name, which may be an argument and no option
    option = f"--{name.replace('_', '-')}"
    try:
        return InputError(option, float(typed), error.allowed)  # in SI, as the bounds are
    except ValueError:
        from leblanc.core.units import allowed_as_typed

        return InputError(option, typed, allowed_as_typed(error.allowed, typed))


def _unread(why: str) -> None:
    say(escaped(f"leblanc: the entry points of a package cannot be read: {why}"))


def _words(error: BaseException) -> str:
    """What an error says, or what it is."""
    return str(error) or type(error).__name__


def _of_another(name: str, command: Callable[..., object]) -> Callable[..., object]:
    """The command of another package; what fails in it is one sentence."""
    passed = (OSError, SystemExit, typer.Exit, typer.Abort, _UsageError)

    @wraps(command)
    def asked(**options: Any) -> object:
        with sound(name, "its answer", "command", passed):
            return command(**options)

    return asked


def _add_announced(application: typer.Typer, entry: EntryPoint) -> None:
    """Add a command of another package; one that does not load says so when it is called."""
    try:
        function = _of_another(entry.name, _as_typed(entry.load()))
        alone = typer.Typer()
        alone.command(entry.name)(function)
        get_command(alone)  # whatever is wrong with it shows here, not in the help of all commands
    except Terminated:
        raise
    except (Exception, SystemExit) as error:
        reason = f"{entry.value} cannot be loaded: {_words(error)}"
        anything = {"allow_extra_args": True, "ignore_unknown_options": True}

        @application.command(entry.name, help="Not available.", context_settings=anything)
        def unavailable() -> None:
            raise InputError("command", entry.name, f"one that is installed; {reason}")
    else:
        application.command(entry.name)(function)
