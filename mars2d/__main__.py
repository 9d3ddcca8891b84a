"""Run the command line as ``python -m mars2d``."""

import sys

from mars2d.cli.command_line import main

sys.exit(main())
