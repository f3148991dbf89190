"""`python -m footfall`: the `footfall` command."""

import sys

from footfall.cli.app import main

if __name__ == "__main__":
    sys.exit(main())
