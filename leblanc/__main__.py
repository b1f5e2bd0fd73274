"""`python -m leblanc` and the command `leblanc`: hears Ctrl-C before anything heavy is imported."""

import os
import sys

# Python has put the current folder first, from which nothing is taken unless this package itself is. Of
# modules only those are named before that Python itself has loaded by then, which pathlib is not.
_FIRST, _HOME = os.getcwd(), os.path.dirname(os.path.dirname(__file__))  # noqa: PTH109, PTH120
if __name__ == "__main__" and not sys.flags.safe_path and sys.path[:1] == [_FIRST] != [_HOME]:
    del sys.path[0]

import signal  # noqa: E402

from leblanc.core.interrupts import Terminated, heard, leave, said  # noqa: E402


def main(arguments: list[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments : those of the process if None

    Returns
    -------
    exit code, see `leblanc.cli.main`
    """
    try:
        with heard():
            from leblanc.cli import main as command
        return command(arguments)
    except (KeyboardInterrupt, Terminated) as error:  # as libraries were imported
        number = signal.SIGINT if isinstance(error, KeyboardInterrupt) else signal.SIGTERM
        print(said(number), file=sys.stderr)
        leave(128 + number)
        raise


if __name__ == "__main__":
    sys.exit(main())
