"""The kernel: the engine's loop in C, for the kind of world that needs it most.

A team of discs among walls spends most of its time between the solver's steps: which robots are
near something, how long the next substep may be, what touches. `mars2d.engine` says how that is
done, and does it for every world; ``kernel.c`` does the same for this kind of world, with the same
bits, and much faster. It is compiled when the package is installed. Where it is missing, or where
the processor's sines are not those of numpy, the plain engine does the work.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.contact import CONTACT

__all__ = ["CONTACTS", "EFFORT", "PLACED", "Kernel", "reason_without"]

Float = NDArray[np.float64]

FUNCTIONS = {
    "step": "cpSpaceStep",
    "set_time_step": "cpSpaceSetCurrentTimeStep",
    "each_arbiter": "cpSpaceEachCachedArbiter",
    "add_constraint": "cpSpaceAddConstraint",
    "remove_constraint": "cpSpaceRemoveConstraint",
    "set_position": "cpBodySetPosition",
    "get_position": "cpBodyGetPosition",
    "get_angle": "cpBodyGetAngle",
    "set_velocity": "cpBodySetVelocity",
    "get_velocity": "cpBodyGetVelocity",
    "set_spin": "cpBodySetAngularVelocity",
    "get_spin": "cpBodyGetAngularVelocity",
    "init_pivot": "cpPivotJointInit",
    "init_gear": "cpGearJointInit",
    "set_max_force": "cpConstraintSetMaxForce",
    "set_max_bias": "cpConstraintSetMaxBias",
    "get_impulse": "cpConstraintGetImpulse",
    "bodies_of": "cpArbiterGetBodies",
    "impulse_of": "cpArbiterTotalImpulse",
    "normal_of": "cpArbiterGetNormal",
    "count_of": "cpArbiterGetCount",
    "point_a": "cpArbiterGetPointA",
    "point_b": "cpArbiterGetPointB",
}
"""The engine's functions, by what the kernel calls them."""

PLACED, CONTACTS, EFFORT = 1, 2, 4
"""What the kernel may have left; see ``kernel.h``."""

SAMPLE = np.concatenate([np.linspace(-60.0, 60.0, 997), np.geomspace(1e-9, 3.0, 200)])
"""Angles at which the kernel's sines are compared with numpy's."""


@cache
def _compiled() -> tuple[Any, str]:
    """Return the compiled module, and why it can't be used; one of both is None or empty."""
    try:
        from mars2d.kernel import _kernel  # type: ignore[attr-defined]
    except ImportError:
        return None, "it was not compiled when mars2d was installed: is there a C compiler?"
    ffi, lib = _kernel.ffi, _kernel.lib
    sine, cosine, far = (np.empty_like(SAMPLE) for _ in range(3))
    arrays = [ffi.from_buffer("double *", array) for array in (SAMPLE, sine, cosine, far)]
    lib.mars2d_kernel_sines(arrays[0], len(SAMPLE), *arrays[1:])
    same = (sine == np.sin(SAMPLE)) & (cosine == np.cos(SAMPLE)) & (far == np.hypot(SAMPLE, sine))
    if not same.all():
        return None, "numpy's sines differ from the C library's in the last bit on this processor"
    return _kernel, ""


def reason_without() -> str:
    """Return why worlds do without the kernel, or nothing if they use it."""
    if os.environ.get("MARS2D_PLAIN") == "1":
        return "the environment variable MARS2D_PLAIN is 1"
    return _compiled()[1]


class Kernel:
    """Moves one world's team of discs; it shares all state with the plain engine's parts."""

    def __init__(self, arrays: Mapping[str, NDArray[Any]], numbers: Mapping[str, float]) -> None:
        """Take what `Team` in ``kernel.h`` asks for, by its names there."""
        from pymunk._chipmunk_cffi import ffi as engine_ffi
        from pymunk._chipmunk_cffi import lib as engine_lib

        module, why = _compiled()
        assert module is not None, why
        self._ffi, self._lib = module.ffi, module.lib
        self._arrays = dict(arrays)  # kept alive, since the kernel knows their addresses only
        functions = {
            ours: int(engine_ffi.cast("uintptr_t", engine_ffi.addressof(engine_lib, theirs)))
            for ours, theirs in FUNCTIONS.items()
        }
        team = self._ffi.new("Team *", {**numbers, **_offsets(engine_ffi)})
        for key, array in self._arrays.items():
            setattr(team, key, self._pointer(team, key, array))
        made = self._lib.mars2d_kernel_new(team, self._ffi.new("Functions *", functions))
        if made == self._ffi.NULL:
            raise MemoryError("no memory for the kernel")
        self._kernel = self._ffi.gc(made, self._lib.mars2d_kernel_free)
        self._team = self._lib.mars2d_kernel_team(made)

    def _pointer(self, team: Any, key: str, array: NDArray[Any]) -> Any:
        """Return the array's memory as what the field is, which it must be in truth."""
        kind = self._ffi.typeof(team[0]).fields
        pointer = next(field.type for name, field in kind if name == key)
        size = self._ffi.sizeof(pointer.item)
        if array.dtype.itemsize != size or not array.flags.c_contiguous:
            raise TypeError(f"{key}: an array of {array.dtype}, expected items of {size} bytes")
        return self._ffi.cast(pointer, array.ctypes.data)

    def drive(self, twist: Float, duration: float, time: float) -> int:
        """Move the team for `duration` seconds under twists (3, n); see `Engine.drive`.

        Returns the sum of `PLACED`, if robots were put somewhere between steps, and of `CONTACTS`
        and `EFFORT`, if there are some.
        """
        pointer = self._ffi.from_buffer("double *", twist)
        result = self._lib.mars2d_kernel_drive(self._kernel, pointer, duration, time)
        return self._check(result)

    def take(self) -> NDArray[np.void]:
        """Return the contacts since the last call; see `ContactLog.take`."""
        count = self._check(self._lib.mars2d_kernel_contacts(self._kernel))
        contacts = np.empty(count, dtype=CONTACT)
        rows = self._ffi.from_buffer("void *", contacts) if count else self._ffi.NULL
        self._check(self._lib.mars2d_kernel_take(self._kernel, rows))
        return contacts

    def _check(self, result: int) -> int:
        if result < 0:
            raise MemoryError("no memory for the contacts of one control step")
        return result


def _offsets(ffi: Any) -> dict[str, int]:
    """Return where in the engine's structs the impulses of contacts are, bytes."""
    arbiter, contact = "struct cpArbiter", "struct cpContact"
    return {
        "arbiter_count": ffi.offsetof(arbiter, "count"),
        "arbiter_contacts": ffi.offsetof(arbiter, "contacts"),
        "arbiter_state": ffi.offsetof(arbiter, "state"),
        "contact_size": ffi.sizeof(contact),
        "contact_normal": ffi.offsetof(contact, "jnAcc"),
        "contact_tangent": ffi.offsetof(contact, "jtAcc"),
    }
