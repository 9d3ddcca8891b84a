"""The kernel: the engine's loop in C, for the kind of world that needs it most.

For a team of discs among walls, most of the time is spent between the solver's steps: which robots
are near something, how long may the next substep be, what touches? `physics.engine` answers that
for every world. The C files here do the same for this kind of world, with the same bits, and much
faster. They are compiled when the package is installed. If that failed, or if numpy or pymunk
differ from what the kernel was written for, the plain engine does the work.
"""

from __future__ import annotations

import importlib.metadata
import os
import threading
from collections.abc import Mapping
from functools import cache, partial
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.kernel import chipmunk
from mars2d.physics.kernel.build import fingerprint
from mars2d.record.contact import CONTACT

__all__ = ["CONTACTS", "EFFORT", "PLACED", "Kernel", "reason_without"]

Float = NDArray[np.float64]

PLACED, CONTACTS, EFFORT = 1, 2, 4
"""The kinds of results that the kernel may have left; see ``team.h``."""

ERRORS = {
    -1: (MemoryError, "no memory for what the kernel keeps of robots that are near each other"),
    -2: (FloatingPointError, "the robots' motion is lost: a number is not finite, or nearly so"),
}
"""The errors with which the kernel breaks off by itself; see ``team.h``."""

INTERRUPTED = -3
"""What the kernel returns when Python broke it off; see ``team.h``."""

_caught = threading.local()
"""Holds the exception that broke it off, as `error`: from Ctrl-C or another signal's handler."""

SAMPLE = np.concatenate([np.linspace(-60.0, 60.0, 997), np.geomspace(1e-9, 3.0, 200)])
"""Angles at which the kernel's sines are compared with numpy's."""


def reason_without() -> str:
    """Return why worlds do without the kernel; empty if they use it."""
    if os.environ.get("MARS2D_PLAIN") == "1":
        return "the environment variable MARS2D_PLAIN is 1"
    return _compiled()[1]


@cache
def _compiled() -> tuple[Any, str]:
    """Return the compiled module, or None and the reason why it can't be used."""
    try:
        _kernel: Any = import_module("mars2d.physics.kernel._kernel")
    except ModuleNotFoundError:
        return None, "it was not compiled when mars2d was installed; is there a C compiler?"
    except ImportError as error:
        return None, f"it can't be loaded ({error})"
    if _kernel.ffi.string(_kernel.lib.mars2d_kernel_fingerprint) != fingerprint().encode():
        return None, "its sources have changed since: install mars2d again"
    for what in chipmunk.changes(_kernel.ffi):
        version = importlib.metadata.version("pymunk")
        return None, f"pymunk {version} is not as the kernel was written for: {what}"
    if not as_numpy(*_sines(_kernel)):
        return None, "numpy's sines differ from the C library's in the last bit on this processor"
    _listen(_kernel.ffi)
    return _kernel, ""


def _listen(ffi: Any) -> None:
    """Let Ctrl-C end a long control step: the kernel calls Python now and then, which may raise."""

    def catch(_kind: object, error: BaseException, _trace: object) -> None:
        """Keep the exception: it is raised after the call."""
        _caught.error = error

    ffi.def_extern("mars2d_kernel_interrupted", error=1, onerror=catch)(lambda: 0)


def _sines(module: Any) -> tuple[Float, Float, Float]:
    """Return the sines and cosines of `SAMPLE`, and the lengths of (angle, sine), by the kernel."""
    sine, cosine, far = (np.empty_like(SAMPLE) for _ in range(3))
    given, *results = [
        module.ffi.from_buffer("double *", array) for array in (SAMPLE, sine, cosine, far)
    ]
    module.lib.mars2d_kernel_sines(given, len(SAMPLE), *results)
    return sine, cosine, far


def as_numpy(sine: Float, cosine: Float, far: Float) -> bool:
    """Return whether numpy computes the same bits as these for `SAMPLE`; see `_sines`."""
    same = (sine == np.sin(SAMPLE)) & (cosine == np.cos(SAMPLE)) & (far == np.hypot(SAMPLE, sine))
    return bool(same.all())


class Kernel:
    """Moves one world's team of discs; it shares all state with the plain engine's parts."""

    def __init__(self, arrays: Mapping[str, NDArray[Any]], numbers: Mapping[str, float]) -> None:
        """Take the fields of `Team` in ``team.h``, by their names there."""
        module, why = _compiled()
        assert module is not None, why
        self._ffi, self._lib = module.ffi, module.lib
        self._arrays = dict(arrays)  # kept alive, since the kernel knows their addresses only
        made = self._lib.mars2d_kernel_new(
            self._described(numbers),
            chipmunk.functions(self._ffi),
            self._lib.mars2d_kernel_interrupted,
        )
        if made == self._ffi.NULL:
            raise MemoryError("no memory for the kernel")
        # Its arrays are to be there still when it is freed.
        self._kernel = self._ffi.gc(made, partial(_free, self._lib, self._arrays))

    def _described(self, numbers: Mapping[str, float]) -> Any:
        """Return the team for the kernel: numbers, and where arrays and fields of structs are."""
        team = self._ffi.new("Team *", chipmunk.offsets())
        kinds = {name: field.type for name, field in self._ffi.typeof("Team").fields}
        for key, number in numbers.items():
            address = kinds[key].kind == "pointer"
            setattr(team, key, self._ffi.cast(kinds[key], number) if address else number)
        for key, array in self._arrays.items():
            size = len(array) * self._ffi.sizeof(kinds[key].item)
            if array.nbytes != size or not array.flags.c_contiguous:
                raise TypeError(f"{key}: {array.nbytes} bytes of {array.dtype}, expected {size}")
            setattr(team, key, self._ffi.cast(kinds[key], array.ctypes.data))
        return team

    def drive(self, twist: Float, duration: float, time: float) -> int:
        """Move the team for `duration` seconds under twists (3, n); see `Engine.drive`.

        Returns the sum of `PLACED`, if robots were put somewhere between steps, and of `CONTACTS`
        and `EFFORT`, if there are some. Raises MemoryError, what a signal raises as
        KeyboardInterrupt, and FloatingPointError where the plain engine would not end. It does not
        go on after that.
        """
        pointer = self._ffi.from_buffer("double *", twist)
        return self._check(self._lib.mars2d_kernel_drive(self._kernel, pointer, duration, time))

    def take(self) -> NDArray[np.void]:
        """Return the contacts since the last call; see `ContactLog.take`."""
        count = self._check(self._lib.mars2d_kernel_contacts(self._kernel))
        contacts = np.empty(count, dtype=CONTACT)
        rows = self._ffi.from_buffer("void *", contacts) if count else self._ffi.NULL
        self._check(self._lib.mars2d_kernel_take(self._kernel, rows))
        return contacts

    @staticmethod
    def _check(result: int) -> int:
        if result == INTERRUPTED:
            raise vars(_caught).pop("error", KeyboardInterrupt())
        if result < 0:
            kind, text = ERRORS[result]
            raise kind(text)
        return result


def _free(lib: Any, _arrays: Mapping[str, NDArray[Any]], kernel: Any) -> None:
    lib.mars2d_kernel_free(kernel)
