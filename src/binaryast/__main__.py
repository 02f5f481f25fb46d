"""``python -m binaryast`` is the command ``binaryast``."""

import sys

from binaryast.cli import main

if __name__ == "__main__":
    sys.exit(main())
