"""Compiles the engine while the package is installed; without a compiler all works, more slowly."""

from __future__ import annotations

import importlib.util
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ISLANDS = Path("mars2d") / "physics" / "islands"


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the extension module into the wheel, or beside its source if that is what is used."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and tell the builder what has come of it. MARS2D_PLAIN=1 leaves it out."""
        if self.target_name != "wheel" or os.environ.get("MARS2D_PLAIN") == "1":
            return
        self._folder = tempfile.TemporaryDirectory()
        try:
            made = self._compiled(Path(self._folder.name), editable=version == "editable")
        except Exception as error:  # whatever a compiler may lack
            self.app.display_warning(
                f"The engine was not compiled ({type(error).__name__}: {error}). MARS2D works "
                "as it is, but contacts take many times longer."
            )
            return
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
        build_data["force_include"][str(made)] = str(ISLANDS / made.name)

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        """Clear away what the compiler has left."""
        if hasattr(self, "_folder"):
            self._folder.cleanup()

    def _compiled(self, folder: Path, *, editable: bool) -> Path:
        """Compile in `folder`, and return the extension module's file."""
        source = Path(self.root) / ISLANDS
        spec = importlib.util.spec_from_file_location("mars2d_islands_build", source / "build.py")
        assert spec is not None
        assert spec.loader is not None
        build = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(build)
        made: Path = build.compile_into(folder)
        if not editable:
            return made
        fresh = source / f"{made.name}.new"
        shutil.copyfile(made, fresh)
        return fresh.replace(source / made.name)  # a process that uses the old one goes on with it
