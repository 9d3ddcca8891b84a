"""The wall around a law: what Linux refuses to its process, before its file is loaded.

Landlock limits the files that it can open, a seccomp filter the system calls, and both hold for
good. Numbers of system calls and flags are those of Linux's headers; see landlock(7), seccomp(2).
"""

from __future__ import annotations

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
from pathlib import Path

from mars2d.core.errors import InputError

REFUSED = """
# signals to others, and their memory
tkill 200 130, rt_sigqueueinfo 129 138, rt_tgsigqueueinfo 297 240, pidfd_send_signal 424 424
pidfd_open 434 434, pidfd_getfd 438 438, ptrace 101 117, process_vm_readv 310 270
process_vm_writev 311 271, kcmp 312 272, process_madvise 440 440, process_mrelease 448 448
move_pages 279 239, migrate_pages 256 238
# programs and processes
fork 57 -, vfork 58 -, execve 59 221, execveat 322 281, unshare 272 97, setns 308 268
personality 135 92
# the network, and what is shared by name
socket 41 198, connect 42 203, bind 49 200, listen 50 201, accept 43 202, accept4 288 242
sendmsg 46 211, sendmmsg 307 269, shmget 29 194, shmat 30 196, shmctl 31 195, semget 64 190
semctl 66 191, semop 65 193, msgget 68 186, msgctl 71 187, mq_open 240 180, mq_unlink 241 181
# memory that no limit counts, and ways around this filter
memfd_create 319 279, memfd_secret 447 447, io_uring_setup 425 425, io_uring_enter 426 426
io_uring_register 427 427, userfaultfd 323 282, bpf 321 280, perf_event_open 298 241
add_key 248 217, request_key 249 218, keyctl 250 219
# limits and priorities
setrlimit 160 164, setpriority 141 140, sched_setscheduler 144 119, sched_setparam 142 118
sched_setattr 314 274, ioprio_set 251 30
# properties of files, with which Landlock does not deal
chmod 90 -, fchmod 91 52, fchmodat 268 53, fchmodat2 452 452, chown 92 -, fchown 93 55
lchown 94 -, fchownat 260 54, utime 132 -, utimes 235 -, futimesat 261 -, utimensat 280 88
setxattr 188 5, lsetxattr 189 6, fsetxattr 190 7, setxattrat 463 463, removexattr 197 14
lremovexattr 198 15, fremovexattr 199 16, removexattrat 466 466, file_setattr 469 469
truncate 76 45, name_to_handle_at 303 264, open_by_handle_at 304 265, fanotify_init 300 262
# the machine
mount 165 40, umount2 166 39, pivot_root 155 41, chroot 161 51, open_tree 428 428
move_mount 429 429, fsopen 430 430, fsmount 432 432, fspick 433 433, mount_setattr 442 442
init_module 175 105, finit_module 313 273, delete_module 176 106, kexec_load 246 104
kexec_file_load 320 294, reboot 169 142, swapon 167 224, swapoff 168 225, acct 163 89
settimeofday 164 170, adjtimex 159 171, clock_settime 227 112, clock_adjtime 305 266
sethostname 170 161, setdomainname 171 162, iopl 172 -, ioperm 173 -, quotactl 179 60
syslog 103 116, vhangup 153 58
"""
"""System calls that are refused whatever their arguments: the name, the number on x86_64, and that
on aarch64."""

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
    for line in REFUSED.strip().splitlines():
        for entry in line.split(", ") if not line.startswith("#") else ():
            number = entry.split()[1 + column]
            if number != "-":
                yield from (_step(EQUAL, int(number), 0, 1), _step(ANSWER, REFUSE))
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
