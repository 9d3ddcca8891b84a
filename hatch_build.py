"""Compiles the kernel while the package is installed; without a compiler all works, more slowly."""

from __future__ import annotations

import importlib.util
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

KERNEL = Path("mars2d") / "kernel"


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the extension module beside its source, or into the wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Compile, and tell the builder what has come of it. MARS2D_PLAIN=1 leaves it out."""
        if self.target_name != "wheel" or os.environ.get("MARS2D_PLAIN") == "1":
            return
        root = Path(self.root)
        with tempfile.TemporaryDirectory() as folder:
            try:
                made = self._module(root / KERNEL / "build.py").compile_into(Path(folder))
            except Exception as error:  # whatever a compiler may lack
                self.app.display_warning(
                    f"The kernel was not compiled ({type(error).__name__}: {error}). MARS2D works "
                    "without it, with the same results, but large teams are several times slower."
                )
                return
            place = root / KERNEL / made.name
            shutil.copyfile(made, place)
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
        build_data["artifacts"].append(str(KERNEL / made.name))

    @staticmethod
    def _module(path: Path) -> Any:
        spec = importlib.util.spec_from_file_location("mars2d_kernel_build", path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module
