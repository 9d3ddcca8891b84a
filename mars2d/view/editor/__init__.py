"""The editor: scenarios drawn with the mouse."""

from mars2d.view.editor.editor import Editor, Outcome
from mars2d.view.editor.window import EditorWindow

__all__ = ["Editor", "EditorWindow", "Outcome"]
