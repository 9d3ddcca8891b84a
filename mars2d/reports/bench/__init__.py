"""How fast is it? The suite of ``mars2d bench``: the same four scenes that peers are given."""
