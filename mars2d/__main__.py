"""Run the command line as ``python -m mars2d``."""

import sys

from mars2d.cli import main

sys.exit(main())
