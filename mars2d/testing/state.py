"""Fingerprints of values, and the places in which code can keep state."""

from __future__ import annotations

import functools
import hashlib
import inspect
import random
import types
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from mars2d.core.description import Description
from mars2d.core.usercode import name_of

GENERATORS = (np.random.Generator, np.random.RandomState, random.Random)

MAX_DEPTH = 12
"""The depth to which nested objects are compared."""


def fingerprint(value: Any) -> str:
    """Return a text that is equal for equal contents, independent of addresses in memory.

    It covers numbers, text, arrays, collections, random generators and plain objects. Of MARS2D's
    own objects and of modules, functions and classes, only the type counts.
    """
    sha = hashlib.sha1(usedforsecurity=False)
    for piece in _pieces(value, MAX_DEPTH, ()):
        sha.update(piece)
    return sha.hexdigest()


def _pieces(value: Any, depth: int, above: tuple[int, ...]) -> Iterator[bytes]:
    yield f"{type(value).__name__}(".encode()
    if value is None or isinstance(value, (bool, int, float, complex, str, bytes, np.generic)):
        yield repr(value).encode()
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype.str}{value.shape}".encode()
        if value.dtype.hasobject:
            yield from _pieces(value.tolist(), depth - 1, (*above, id(value)))
        else:
            yield np.ascontiguousarray(value).tobytes()
    elif depth > 0 and id(value) not in above:
        inside = (*above, id(value))
        if isinstance(value, GENERATORS):
            yield from _pieces(_state(value), depth - 1, inside)
        elif isinstance(value, Mapping):
            items = [(fingerprint(key), fingerprint(value[key])) for key in value]
            yield repr(sorted(items)).encode()
        elif isinstance(value, (set, frozenset)):
            yield repr(sorted(map(fingerprint, value))).encode()
        elif isinstance(value, (list, tuple)) or type(value).__name__ == "deque":
            for item in value:
                yield from _pieces(item, depth - 1, inside)
        elif _is_plain(value):
            for name, item in sorted(vars(value).items()):
                yield name.encode()
                yield from _pieces(item, depth - 1, inside)
    yield b")"


def _state(generator: Any) -> Any:
    if isinstance(generator, random.Random):
        return generator.getstate()
    if isinstance(generator, np.random.RandomState):
        return generator.get_state(legacy=False)
    state = generator.bit_generator.state
    return repr(state) if state["bit_generator"] == "PCG64" else state  # only integers


def _is_plain(value: Any) -> bool:
    """Return whether an object is the user's own, or a description."""
    if isinstance(value, (type, types.ModuleType, types.FunctionType, types.MethodType)):
        return False
    of_ours = type(value).__module__.partition(".")[0] == "mars2d"
    if of_ours and not isinstance(value, Description):
        return False
    return hasattr(value, "__dict__")


class Places:
    """The places outside of self and the world in which a class or a function can keep state.

    These are attributes of the class, variables of its module and of an enclosing function, default
    arguments and attributes of functions, and attributes of a callable object.
    """

    def __init__(self, code: Any) -> None:
        """Take the class or the law."""
        self._found: dict[str, Callable[[], Any]] = {}
        self._seen: set[int] = set()
        if isinstance(code, type):
            self._class(code)
        else:
            self._callable(code)
        self._before = self._look()

    def changed(self) -> list[str]:
        """Return the places whose contents have changed since this object was created."""
        now = self._look()
        return [place for place, print_ in now.items() if self._before[place] != print_]

    def of_classes(self) -> list[str]:
        """Return the mutable attributes of classes that have not changed."""
        kinds = (list, dict, set, np.ndarray, np.random.Generator)
        changed = self.changed()
        return [
            place
            for place, get in self._found.items()
            if "of the class" in place and place not in changed and isinstance(get(), kinds)
        ]

    def _look(self) -> dict[str, str]:
        return {place: fingerprint(get()) for place, get in self._found.items()}

    def _class(self, kind: type) -> None:
        for base in kind.__mro__:
            if base is object or base.__module__.partition(".")[0] == "mars2d":
                break
            for name, value in list(vars(base).items()):
                function = inspect.unwrap(_function_of(value)) if _function_of(value) else None
                if isinstance(function, types.FunctionType):
                    if function.__module__ == base.__module__:
                        self._function(function)
                elif not (name.startswith("__") or callable(value) or hasattr(value, "__get__")):
                    self._add(f"{base.__name__}.{name}, an attribute of the class", base, name)

    def _callable(self, law: Any) -> None:
        while isinstance(law, functools.partial):
            self._values(f"the arguments of the partial {name_of(law.func)}", law.args)
            law = law.func
        if isinstance(law, types.MethodType):
            self._object(law.__self__)
            law = law.__func__
        if isinstance(law, types.FunctionType):
            self._function(inspect.unwrap(law))
        elif not isinstance(law, type) and hasattr(law, "__dict__"):
            self._object(law)
            self._class(type(law))

    def _object(self, owner: Any) -> None:
        kind = type(owner).__name__
        self._found[f"the attributes of the {kind} object"] = lambda: dict(vars(owner))

    def _function(self, function: Any) -> None:
        if id(function) in self._seen:
            return
        self._seen.add(id(function))
        name = function.__name__
        defaults = (*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values())
        self._values(f"a default of {name}'s arguments", defaults)
        self._found[f"an attribute of the function {name}"] = lambda: dict(vars(function))
        for variable, cell in zip(
            function.__code__.co_freevars, function.__closure__ or (), strict=False
        ):
            if variable != "__class__":
                self._variable(f"{variable}, a variable of the function round {name}", cell)
        for variable in sorted(_names(function.__code__)):
            self._global(function.__globals__, variable)

    def _variable(self, place: str, cell: Any) -> None:
        try:
            value = cell.cell_contents
        except ValueError:  # still empty
            return
        if isinstance(value, types.FunctionType):
            self._function(value)
        elif _holds(value):
            self._found[place] = lambda: getattr(cell, "cell_contents", None)

    def _global(self, variables: dict[str, Any], name: str) -> None:
        value = variables.get(name)
        if isinstance(value, types.FunctionType):
            if value.__globals__ is variables:
                self._function(value)
        elif name in variables and _holds(value):
            what = "random generator" if isinstance(value, GENERATORS) else "variable"
            self._found[f"{name}, a {what} of the file"] = lambda: variables.get(name)

    def _values(self, place: str, values: Any) -> None:
        if any(map(_holds, values)):
            self._found[place] = lambda: values

    def _add(self, place: str, owner: Any, name: str) -> None:
        self._found[place] = lambda: vars(owner).get(name)


def _holds(value: Any) -> bool:
    """Return whether a value is data, and no module, class, function or description."""
    return not isinstance(value, (type, types.ModuleType, Description)) and not callable(value)


def _function_of(value: Any) -> Any:
    """Return the function behind a method or property, or None if there is none."""
    for attribute in ("__func__", "fget", "func"):
        value = getattr(value, attribute, value)
    return value if isinstance(value, types.FunctionType) else None


def _names(code: types.CodeType) -> set[str]:
    """Return the names that code uses, including the functions inside it."""
    inner = (c for c in code.co_consts if isinstance(c, types.CodeType))
    return set(code.co_names).union(*map(_names, inner))
