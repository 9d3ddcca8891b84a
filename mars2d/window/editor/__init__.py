"""The editor: scenarios drawn with the mouse."""

from mars2d.window.editor.editor import Editor, Outcome
from mars2d.window.editor.window import EditorWindow

__all__ = ["Editor", "EditorWindow", "Outcome"]
