"""The window and the pictures, drawn with pygame."""
