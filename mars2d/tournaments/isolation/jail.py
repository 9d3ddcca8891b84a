"""The wall around a law: what Linux refuses to its process, before its file is loaded.

Landlock limits the files that it can open, a seccomp filter the system calls, and both hold for
good. `refused.csv` has the calls that are refused whatever their arguments. Numbers of system calls
and flags are those of Linux's headers; see landlock(7), seccomp(2).
"""

from __future__ import annotations

import csv
import ctypes
import errno
import os
import platform
import site
import struct
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path

from mars2d.core.errors import InputError

# The numbers of system calls of which some uses are refused, on x86_64 and aarch64.
CLONE, KILL, TGKILL, SCHED_SETAFFINITY = (56, 220), (62, 129), (234, 131), (203, 122)
PRCTL, PRLIMIT64, FCNTL, IOCTL, MMAP = (157, 167), (302, 261), (72, 25), (16, 29), (9, 222)
CLONE3 = 435

ARCHITECTURES = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
X32 = 0x40000000
"""The bit of system calls of another kind that x86_64 has."""

ALLOW, KILL_PROCESS = 0x7FFF0000, 0x80000000
REFUSE, UNKNOWN = 0x50000 | errno.EPERM, 0x50000 | errno.ENOSYS
"""The answers of a filter: for unknown system calls, C libraries have another way."""

LOAD, AND, OR_X, TO_X = 0x20, 0x54, 0x4C, 0x07
EQUAL, AT_LEAST, ANSWER = 0x15, 0x35, 0x06
"""The instructions of filters."""

PR_SET_NAME, PR_SET_SECCOMP, PR_GET_SECCOMP, PR_SET_NO_NEW_PRIVS = 15, 22, 21, 38
PR_SET_PDEATHSIG = 1
SIGKILL = 9
CLONE_THREAD = 0x10000
SHARED_WITHOUT_FILE = 0x21
SIGNALLING = (8, 10, 15, 1024)  # F_SETOWN, F_SETSIG, F_SETOWN_EX, F_SETLEASE
OWNING = (0x8901, 0x8902, 0x5412)  # FIOSETOWN, SIOCSPGRP, TIOCSTI

CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
READ_FILE, READ_DIR = 1 << 2, 1 << 3
FILE_RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}
"""How many rights on files each version of Landlock knows; later ones know as many as the last."""

SYSTEM = (
    "/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/share/zoneinfo", "/etc/localtime",
    "/etc/ld.so.cache", "/dev/null", "/dev/urandom", "/proc/cpuinfo", "/sys/devices/system/cpu",
)  # fmt: skip
"""Files of the system that libraries read."""


@cache
def is_protected() -> bool:
    """Return whether this system can refuse a law what could harm others."""
    return (
        sys.platform == "linux"
        and platform.machine() in ARCHITECTURES
        and _landlock_version() > 0
        and _libc().prctl(PR_GET_SECCOMP, *[ctypes.c_ulong(0)] * 4) >= 0
    )


def close_in(readable: Iterable[Path], listed: Iterable[Path] = ()) -> None:
    """Refuse this process everything that could harm others, for good.

    It has one thread by now. readable: files and folders that it may read, besides those of Python
    and its libraries. listed: folders of which it may know what is in them. Raises
    InputError where the system does not build the wall.
    """
    _prctl(PR_SET_PDEATHSIG, SIGKILL)
    _prctl(PR_SET_NO_NEW_PRIVS, 1)
    wholly = dict.fromkeys([*_libraries(), *readable], READ_FILE | READ_DIR)
    _limit_files({**dict.fromkeys(listed, READ_DIR), **wholly})
    text = b"".join(_filter())
    code = ctypes.create_string_buffer(text, len(text))
    program = struct.pack("@HP", len(text) // 8, ctypes.addressof(code))
    whole = ctypes.create_string_buffer(program, len(program))
    _prctl(PR_SET_SECCOMP, 2, ctypes.addressof(whole))


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def _done(result: int) -> int:
    if result < 0:
        raise InputError(f"the law can't be isolated: {os.strerror(ctypes.get_errno())}")
    return result


def _prctl(option: int, value: int, address: int = 0) -> None:
    _done(_libc().prctl(option, *map(ctypes.c_ulong, (value, address, 0, 0))))


# -- files -----------------------------------------------------------------------------------------


def _landlock_version() -> int:
    return int(_libc().syscall(CREATE_RULESET, None, ctypes.c_size_t(0), 1))


def _libraries() -> set[Path]:
    """Return the folders of Python, its libraries, and the packages that are imported by now."""
    paths = sysconfig.get_paths()
    folders = {Path(paths[name]) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    folders |= {folder.parent for folder in folders if folder.name.startswith("python")}
    folders |= {Path(name) for name in (*site.getsitepackages(), site.getusersitepackages())}
    packages = (module for name, module in sys.modules.items() if "." not in name)
    files = [each.__file__ for each in packages if hasattr(each, "__path__") and each.__file__]
    return {*folders, *(Path(file).parent for file in files), *map(Path, SYSTEM)}


def _limit_files(rights: Mapping[Path, int]) -> None:
    """Let this process open no files except these, and those in them, by their rights."""
    version = _landlock_version()
    every = (1 << FILE_RIGHTS[min(version, 5)]) - 1
    network, scopes = 3, 3  # no binding or connecting; no sockets or signals outside
    size = 8 if version < 4 else 16 if version < 6 else 24
    rules = struct.pack("<QQQ", every, network, scopes)[:size]
    syscall = _libc().syscall
    ruleset = _done(syscall(CREATE_RULESET, rules, ctypes.c_size_t(size), 0))
    for path, right in rights.items():
        try:
            file = os.open(path, os.O_PATH | os.O_CLOEXEC)
        except OSError:  # there is no such file on this system
            continue
        allowed = right if path.is_dir() else READ_FILE
        _done(syscall(ADD_RULE, ruleset, 1, struct.pack("<Qi", allowed, file), 0))
        os.close(file)
    _done(syscall(RESTRICT_SELF, ruleset, 0))
    os.close(ruleset)


# -- system calls ----------------------------------------------------------------------------------


def _filter() -> Iterator[bytes]:
    """Yield the instructions of the filter of system calls."""
    machine = platform.machine()
    column = [*ARCHITECTURES].index(machine)
    yield _step(LOAD, 4)
    yield _step(EQUAL, ARCHITECTURES[machine], 1, 0)
    yield _step(ANSWER, KILL_PROCESS)
    yield _step(LOAD, 0)
    yield _step(AT_LEAST, X32, 0, 1)
    yield _step(ANSWER, REFUSE)
    refused = (files(__package__) / "refused.csv").read_text(encoding="ascii")
    for row in csv.DictReader(refused.splitlines()):
        if row[machine] != "-":
            yield from (_step(EQUAL, int(row[machine]), 0, 1), _step(ANSWER, REFUSE))
    yield from (_step(EQUAL, CLONE3, 0, 1), _step(ANSWER, UNKNOWN))
    mine = (0, os.getpid())
    for call, argument, mask, values, listed, others in (
        (CLONE, 0, CLONE_THREAD, (CLONE_THREAD,), ALLOW, REFUSE),
        (KILL, 0, -1, mine, ALLOW, REFUSE),
        (TGKILL, 0, -1, mine, ALLOW, REFUSE),
        (SCHED_SETAFFINITY, 0, -1, mine, ALLOW, REFUSE),
        (PRCTL, 0, -1, (PR_SET_NAME,), ALLOW, REFUSE),
        (FCNTL, 1, -1, SIGNALLING, REFUSE, ALLOW),
        (IOCTL, 1, -1, OWNING, REFUSE, ALLOW),
        (MMAP, 3, SHARED_WITHOUT_FILE, (SHARED_WITHOUT_FILE,), REFUSE, ALLOW),
    ):
        tests = [_step(LOAD, 16 + 8 * argument), _step(AND, mask)]
        for value in values:
            tests += [_step(EQUAL, value, 0, 1), _step(ANSWER, listed)]
        tests.append(_step(ANSWER, others))
        yield from (_step(EQUAL, call[column], 0, len(tests)), *tests)
    # A limit may be looked at, but no new one set: the pointer, both halves of it, must be null.
    yield _step(EQUAL, PRLIMIT64[column], 0, 6)
    yield from (_step(LOAD, 32), _step(TO_X, 0), _step(LOAD, 36))
    yield _step(OR_X, 0)
    yield from (_step(EQUAL, 0, 1, 0), _step(ANSWER, REFUSE))
    yield _step(ANSWER, ALLOW)


def _step(instruction: int, value: int, yes: int = 0, no: int = 0) -> bytes:
    """Return an instruction of a filter.

    value: for LOAD, where in the call's data (number, system, arguments) 4 bytes are taken; of a
    test, an operation or an answer, its number. yes, no: how many instructions a test skips.
    """
    return struct.pack("<HBBI", instruction, yes, no, value & 0xFFFFFFFF)
