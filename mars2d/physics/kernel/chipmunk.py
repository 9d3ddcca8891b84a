"""Chipmunk, pymunk's engine, as the kernel calls it: functions by address, structs by offsets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pymunk._chipmunk_cffi import ffi, lib

__all__ = ["changes", "functions", "offsets"]

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
    "set_force": "cpBodySetForce",
    "set_torque": "cpBodySetTorque",
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
    "new_space": "cpSpaceNew",
    "set_iterations": "cpSpaceSetIterations",
    "set_slop": "cpSpaceSetCollisionSlop",
    "new_body": "cpBodyNew",
    "new_kinematic": "cpBodyNewKinematic",
    "new_static": "cpBodyNewStatic",
    "set_angle": "cpBodySetAngle",
    "set_data": "cpBodySetUserData",
    "data_of": "cpBodyGetUserData",
    "new_circle": "cpCircleShapeNew",
    "new_segment": "cpSegmentShapeNew",
    "set_friction": "cpShapeSetFriction",
    "set_elasticity": "cpShapeSetElasticity",
    "alloc_pivot": "cpPivotJointAlloc",
    "alloc_gear": "cpGearJointAlloc",
    "add_body": "cpSpaceAddBody",
    "add_shape": "cpSpaceAddShape",
    "remove_body": "cpSpaceRemoveBody",
    "remove_shape": "cpSpaceRemoveShape",
    "free_space": "cpSpaceFree",
    "free_body": "cpBodyFree",
    "free_shape": "cpShapeFree",
    "free_joint": "cpConstraintFree",
}
"""The engine's functions, by their names in `Engine` of ``team.h``."""

FIELDS = {
    "arbiter_count": ("struct cpArbiter", "count", "int"),
    "arbiter_contacts": ("struct cpArbiter", "contacts", "struct cpContact *"),
    "arbiter_state": ("struct cpArbiter", "state", "enum cpArbiterState"),
    "contact_normal": ("struct cpContact", "jnAcc", "double"),
    "contact_tangent": ("struct cpContact", "jtAcc", "double"),
}
"""Fields of its structs and their types, by their names in `Team` of ``team.h``."""


def functions(ours: Any) -> Any:
    """Return the engine's functions as an `Engine` of the kernel, whose ffi is `ours`."""
    made = ours.new("Engine *")
    for name, field in ours.typeof("Engine").fields:
        address = int(ffi.cast("uintptr_t", ffi.addressof(lib, FUNCTIONS[name])))
        setattr(made, name, ours.cast(field.type, address))
    return made


def offsets() -> dict[str, int]:
    """Return where in the engine's structs things are, bytes, by the names of ``team.h``."""
    found = {name: ffi.offsetof(struct, field) for name, (struct, field, _) in FIELDS.items()}
    return {**found, "contact_size": ffi.sizeof("struct cpContact")}


def changes(ours: Any, engine: Any = ffi, library: Any = lib) -> Iterator[str]:
    """Yield the differences between the engine and the one that the kernel expects.

    ours, engine: the ffi of the kernel and of the engine; library: the latter's functions.
    """
    wanted = {name: field.type for name, field in ours.typeof("Engine").fields}
    for name, theirs in FUNCTIONS.items():
        try:
            found = engine.typeof(engine.addressof(library, theirs))
        except AttributeError:
            yield f"it has no function {theirs}"
            continue
        if not alike(wanted[name], found):
            yield f"its function {theirs} is a {found.cname}"
    for struct, field, kind in FIELDS.values():
        try:
            fields = dict(engine.typeof(struct).fields or ())
        except engine.error:
            fields = {}
        if field not in fields:
            yield f"its {struct} has no field {field}"
        elif fields[field].type.cname != kind:
            yield f"the field {field} of its {struct} is a {fields[field].type.cname}"


def alike(ours: Any, theirs: Any) -> bool:
    """Return whether our type and one of the engine are the same but for pointers' targets."""
    if ours.kind != theirs.kind:
        return False
    if ours.kind == "function":
        pairs = [(ours.result, theirs.result), *zip(ours.args, theirs.args, strict=False)]
        return len(ours.args) == len(theirs.args) and all(alike(*pair) for pair in pairs)
    if ours.kind == "struct":
        mine, other = ([field.type for _, field in kind.fields] for kind in (ours, theirs))
        return len(mine) == len(other) and all(map(alike, mine, other))
    return bool(ours.kind == "pointer" or ours.cname == theirs.cname)
