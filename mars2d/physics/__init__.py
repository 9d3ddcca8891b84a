"""Motion: the only room that knows the engine library."""
