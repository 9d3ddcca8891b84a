"""The editor: scenarios drawn with the mouse."""

from mars2d.window.editor.dialogs import Outcome
from mars2d.window.editor.editor import Editor
from mars2d.window.editor.window import EditorWindow

__all__ = ["Editor", "EditorWindow", "Outcome"]
