"""Films of runs, as GIF and MP4."""
