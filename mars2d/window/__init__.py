"""The windows that people sit at: the run window and the editor."""

import mars2d.output.raster  # noqa: F401  # first, since it silences the greeting of pygame
