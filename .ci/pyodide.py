"""Assemble a folder of Pyodide with the packages that MARS2D needs, without Pyodide's own server.

    python .ci/pyodide.py FOLDER

Where that server can be reached, none of this is needed: Pyodide downloads its packages from it.
Here they come from package indexes and from Debian. Pyodide itself, numpy, scipy and micropip are
those that a web application has in its wheel; pymunk publishes a wheel for Pyodide; and cffi is
compiled here, with clang, for which these are needed:

    apt-get install clang-19 lld-19 libffi-dev

Shapely, which nobody else publishes, is left out.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

CARRIER = "open-webui==0.12.4"
"""A package with a copy of Pyodide in its wheel."""

CARRIED = re.compile(
    r".*/pyodide/(pyodide(\.asm)?\.m?js|pyodide\.asm\.wasm|python_stdlib\.zip|pyodide-lock\.json"
    r"|(numpy|scipy|micropip|packaging)-[^/]*\.whl)"
)
"""What is taken out of it."""

PYMUNK, CFFI, PYTHON = "pymunk==7.3.1", "cffi==2.0.0", "3.14"
TAG = "cp314-cp314-pyemscripten_2026_0_wasm32"

MACRO = re.compile(
    r"(_?(HAVE|SIZEOF|ALIGNOF|PY|Py|WITH|STDC|ENABLE|DOUBLE|POSIX|PTHREAD|SYS)_?\w*|_[A-Z]\w*)"
)
"""Which of Python's build variables were macros of its pyconfig.h."""

FFI_TARGET = """\
typedef unsigned long ffi_arg;
typedef signed long ffi_sarg;
typedef enum ffi_abi {
  FFI_FIRST_ABI, FFI_WASM32, FFI_WASM32_EMSCRIPTEN, FFI_LAST_ABI,
  FFI_DEFAULT_ABI = FFI_WASM32_EMSCRIPTEN
} ffi_abi;
#define FFI_CLOSURES 1
#define FFI_TRAMPOLINE_SIZE 4
#define FFI_TARGET_SPECIFIC_VARIADIC 1
#define FFI_EXTRA_CIF_FIELDS unsigned int nfixedargs
"""
"""How functions are called in WebAssembly, for libffi, which is part of Pyodide."""


def assemble(folder: Path) -> None:
    """Put everything into a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        with zipfile.ZipFile(download(work, CARRIER, "--python-version", "3.12")) as carrier:
            for each in carrier.namelist():
                if CARRIED.fullmatch(each):
                    (folder / Path(each).name).write_bytes(carrier.read(each))
        python, abi, platform = TAG.split("-")
        shutil.copy(
            download(
                work, PYMUNK, "--platform", platform, "--python-version", python[2:], "--abi", abi
            ),
            folder,
        )
        write_cffi(work, folder)
    write_lock(folder)


def write_lock(folder: Path) -> None:
    """Let Pyodide's list of packages name those that are here, and no others."""
    lock = json.loads((folder / "pyodide-lock.json").read_text())
    packages = lock["packages"]
    for package in (PYMUNK, CFFI):
        name, version = package.split("==")
        packages[name] = {
            **packages["numpy"], "name": name, "imports": [name], "version": version,
            "file_name": f"{name}-{version}-{TAG}.whl",
        }  # fmt: skip
    packages["pymunk"]["depends"] = ["cffi"]
    packages["numpy"]["depends"] = []
    here = {name: each for name, each in packages.items() if (folder / each["file_name"]).exists()}
    for each in here.values():
        each["sha256"] = hashlib.sha256((folder / each["file_name"]).read_bytes()).hexdigest()
    lock["packages"] = here
    (folder / "pyodide-lock.json").write_text(json.dumps(lock))


def download(work: Path, package: str, *more: str) -> Path:
    """Return a wheel from the index."""
    into = work / package.partition("=")[0]
    run(
        sys.executable, "-m", "pip", "download", "-q", "--no-deps", "--only-binary", ":all:",
        *more, "-d", into, package,
    )  # fmt: skip
    return next(into.glob("*.whl"))


def write_cffi(work: Path, folder: Path) -> None:
    """Compile cffi for Pyodide, and write its wheel."""
    run(
        sys.executable, "-m", "pip", "download", "-q", "--no-deps", "--no-build-isolation",
        "--no-binary", ":all:", "-d", work, CFFI,
    )  # fmt: skip
    with tarfile.open(next(work.glob("cffi-*.tar.gz"))) as sources:
        sources.extractall(work, filter="data")
    sources_of_cffi = next(work.glob("cffi-*/src"))
    include = headers(work, folder)
    made = work / "_cffi_backend.cpython-314-wasm32-emscripten.so"
    run(
        "clang-19", "--target=wasm32-unknown-emscripten", "-fPIC", "-O2", "-fvisibility=hidden",
        "-nostdlibinc", "-isystem", include / "musl", "-I", include, "-D__EMSCRIPTEN__=1",
        "-D_GNU_SOURCE", "-DNDEBUG", "-DFFI_BUILDING", "-w", "-c",
        sources_of_cffi / "c" / "_cffi_backend.c", "-o", work / "backend.o",
    )  # fmt: skip
    run(
        "wasm-ld-19", "-shared", "--experimental-pic", "--unresolved-symbols=import-dynamic",
        "--export=PyInit__cffi_backend", "-s", work / "backend.o", "-o", made,
    )  # fmt: skip
    name, version = CFFI.split("==")
    about = f"{name}-{version}.dist-info"
    with zipfile.ZipFile(folder / f"{name}-{version}-{TAG}.whl", "w") as wheel:
        wheel.write(made, made.name)
        for file in sorted((sources_of_cffi / name).rglob("*.[ph]*")):
            wheel.write(file, str(file.relative_to(sources_of_cffi)))
        wheel.writestr(
            f"{about}/METADATA", f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        )
        wheel.writestr(
            f"{about}/WHEEL", f"Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: {TAG}\n"
        )
        wheel.writestr(f"{about}/RECORD", "")


def headers(work: Path, folder: Path) -> Path:
    """Return the folder of Python's, libffi's and the C library's headers for WebAssembly."""
    debian(work, f"libpython{PYTHON}-dev", "musl-dev")
    include = work / "usr" / "include" / f"python{PYTHON}"
    with zipfile.ZipFile(folder / "python_stdlib.zip") as library:
        name = next(name for name in library.namelist() if "_sysconfigdata" in name)
        values: dict[str, dict[str, object]] = {}
        exec(library.read(name), values)  # Pyodide's own module
    (include / "pyconfig.h").write_text(
        "".join(
            f"#define {key} {value}\n"
            for key, value in values["build_time_vars"].items()
            if MACRO.fullmatch(key) and isinstance(value, int) and value
        )
    )
    (include / "ffitarget.h").write_text(FFI_TARGET)
    shutil.copy(next(Path("/usr/include").rglob("ffi.h")), include)
    shutil.copytree(work / "usr" / "include" / "x86_64-linux-musl", include / "musl")
    types = include / "musl" / "bits" / "alltypes.h"  # emscripten's library is musl, with 32 bits
    types.write_text(
        types.read_text()
        .replace("#define _Int64 long", "#define _Int64 long long")
        .replace("0x7fffffffffffffffL", "0x7fffffffL")
    )
    return include


def debian(work: Path, *packages: str) -> None:
    """Unpack packages of Debian's newest release, without installing them."""
    state = work / "apt"
    for place in ("lists/partial", "cache/archives/partial"):
        (state / place).mkdir(parents=True)
    keys = "/usr/share/keyrings/debian-archive-keyring.gpg"
    (state / "sources.list").write_text(
        f"deb [signed-by={keys}] http://deb.debian.org/debian sid main\n"
    )
    options = [
        f"-oDir::Etc::sourcelist={state}/sources.list", "-oDir::Etc::sourceparts=/dev/null",
        f"-oDir::State::lists={state}/lists", f"-oDir::Cache={state}/cache",
        "-oAPT::Sandbox::User=root", "-qq",
    ]  # fmt: skip
    run("apt-get", *options, "update")
    run("apt-get", *options, "download", *packages, cwd=state)
    for file in state.glob("*.deb"):
        run("dpkg-deb", "-x", file, work)


def run(*command: str | Path, cwd: Path | None = None) -> None:
    """Run a command, which has to succeed."""
    subprocess.run([str(part) for part in command], check=True, cwd=cwd)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    assemble(Path(sys.argv[1]))
