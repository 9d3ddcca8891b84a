"""What to do where the engine is not compiled: the command line that mends it on this machine."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import sys
import sysconfig
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

AGAIN = "pip install --force-reinstall --no-deps"
NOWHERE = f"{AGAIN} FOLDER, that of its sources"


def remedy() -> str:
    """Return the remedy where the engine does not run compiled."""
    if os.environ.get("MARS2D_PLAIN") == "1":
        return "set MARS2D_PLAIN=" if sys.platform == "win32" else "unset MARS2D_PLAIN"
    return " && ".join(filter(None, [_tools(), _again()]))


def _tools() -> str:
    """Return the command that installs the missing ones of a C compiler and Python's headers."""
    headers = Path(sysconfig.get_path("include"), "Python.h").exists()
    compiler = (os.environ.get("CC") or sysconfig.get_config_var("CC") or "cl").split()[0]
    if shutil.which(compiler) is None and sys.platform == "win32":
        return "winget install Microsoft.VisualStudio.2022.BuildTools"
    if shutil.which(compiler) is None and sys.platform == "darwin":
        return "xcode-select --install"
    packages = [] if shutil.which(compiler) else ["gcc"]
    major, minor = sys.version_info[:2]
    if shutil.which("apt-get"):
        packages += [] if headers else [f"python{major}.{minor}-dev"]
        return f"apt-get install {' '.join(packages)}" if packages else ""
    packages += [] if headers else [f"python{major}-devel"]
    return f"dnf install {' '.join(packages)}" if packages else ""


def _again() -> str:
    """Return the command that installs MARS2D again as it was installed, from its sources."""
    import mars2d

    package = Path(mars2d.__file__).parent
    if (package.parent / "pyproject.toml").exists():
        return f"pip install --no-deps -e {shlex.quote(str(package.parent))}"
    try:
        told = json.loads(distribution("mars2d").read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        return NOWHERE
    url = told.get("url", "")
    if "vcs_info" in told:
        url = f"{told['vcs_info']['vcs']}+{url}@{told['vcs_info']['commit_id']}"
    if url.endswith(".whl"):
        return NOWHERE
    # A wheel that was built without a compiler may be kept by pip.
    of = shlex.quote(url) if url else f"--no-binary mars2d mars2d=={mars2d.__version__}"
    return f"{AGAIN} --no-cache-dir {of}"
