"""The window and the pictures, drawn with pygame."""

import os

# pygame greets on stdout, where --json promises one line.
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
