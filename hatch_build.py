"""Compiles the engine while the package is installed, and prepares the README for package indexes.

Without a compiler all works, more slowly.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

ISLANDS = Path("mars2d") / "physics" / "islands"

LONGEST = 900
"""How long the compiler may take, seconds; it takes 20 on a laptop. One that hangs is ended."""


class AddressesHook(MetadataHookInterface):
    """Gives the links of the README their addresses, so that a package index can follow them."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Set the description of the package."""
        home = metadata["urls"]["Homepage"]
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        text = re.sub(r"(!\[[^]]*\]\()(?!https?:|#)", rf"\1{home}/raw/main/", text)
        text = re.sub(r"(?<!!)(\[[^]]*\]\()(?!https?:|#)", rf"\1{home}/blob/main/", text)
        metadata["readme"] = {"content-type": "text/markdown", "text": text}


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
        build = subprocess.Popen(
            [sys.executable, "-P", source / "build.py", folder],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        )  # fmt: skip
        try:
            out, errors = build.communicate(timeout=LONGEST)
        except BaseException:
            if hasattr(os, "killpg"):
                os.killpg(build.pid, signal.SIGKILL)  # the compiler as well
            build.kill()
            raise
        if build.returncode:
            raise RuntimeError(
                errors.strip().rpartition("\n")[2] or f"exit code {build.returncode}"
            )
        made = Path(out.strip().rpartition("\n")[2])
        if not editable:
            return made
        fresh = source / f"{made.name}.new"
        shutil.copyfile(made, fresh)
        return fresh.replace(source / made.name)  # a process that uses the old one goes on with it
