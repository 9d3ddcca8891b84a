"""Pictures of a scenario: those in its files, put into a record, which opens no other file."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from mars2d.addons.base import Addon
from mars2d.core.description import Description
from mars2d.core.errors import InputError, one_line
from mars2d.core.picture import Picture, holds_pixels, image_file, picture_name, without_pixels
from mars2d.scenario import serialize
from mars2d.scenario.scenario import Scenario


def enclosed(value: Any) -> Any:
    """Return a scenario whose pictures are in it; any other value as it is.

    A picture that can't be read any more stays a name.
    """
    if not isinstance(value, Scenario):
        return value
    return value.replace(addons=[_enclosed(addon) for addon in value.addons])


def _enclosed(addon: Addon) -> Addon:
    named = [name for name in _images(type(addon)) if getattr(addon, name) is not None]
    try:
        picture: Picture | None = getattr(addon, "picture", None) if named else None
    except InputError:
        return addon
    changes = {} if picture is None else {n: picture.as_text(getattr(addon, n)) for n in named}
    return addon.replace(**changes) if changes else addon


def of_record(plain: Any, missing: list[str]) -> Any:
    """Return a scenario of a record, as plain data, without the names of files.

    A picture that the record does not hold is named in `missing`, and nothing is opened for it.
    """
    if isinstance(plain, list):
        return [of_record(item, missing) for item in plain]
    if not isinstance(plain, dict):
        return plain
    inside = {name: of_record(item, missing) for name, item in plain.items()}
    for name in _images(serialize.kind_of(plain)):
        image = inside.get(name)
        if isinstance(image, str) and not holds_pixels(image):
            missing.append(f"picture {one_line(picture_name(image))} of {plain['type']}")
            inside[name] = without_pixels(image)
    return inside


def _images(kind: type[Description] | None) -> list[str]:
    """Return the fields of a class that are files of pictures."""
    return [
        field.name for field in (fields(kind) if kind else ())
        if field.metadata.get("check") is image_file
    ]  # fmt: skip
