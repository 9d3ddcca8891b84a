"""Pages and drawings: the replay in a browser, SVG, notebooks."""
