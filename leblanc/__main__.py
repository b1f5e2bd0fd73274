"""`python -m leblanc` and the command `leblanc`: hears Ctrl-C before anything heavy is imported."""

import signal
import sys

from leblanc.interrupts import Terminated, heard, leave, said


def main() -> int:
    """Run one command.

    Returns
    -------
    exit code, see `leblanc.cli.main`
    """
    try:
        with heard():
            from leblanc.cli import main as command
        return command()
    except (KeyboardInterrupt, Terminated) as error:  # as libraries were imported
        number = signal.SIGINT if isinstance(error, KeyboardInterrupt) else signal.SIGTERM
        print(said(number), file=sys.stderr)
        leave(128 + number)
        raise


if __name__ == "__main__":
    sys.exit(main())
