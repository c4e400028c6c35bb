"""Command line, as ``python -m frictionlab``."""

import sys

from frictionlab.cli import main

if __name__ == "__main__":
    sys.exit(main())
