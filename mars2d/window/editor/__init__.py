"""The editor: scenarios drawn with the mouse."""

from mars2d.window.editor.dialogs import Outcome
from mars2d.window.editor.editor import Editor

__all__ = ["Editor", "Outcome"]
