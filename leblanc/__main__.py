"""`python -m leblanc`: the same as the command `leblanc`."""

import sys

from leblanc.cli import main

if __name__ == "__main__":
    sys.exit(main())
