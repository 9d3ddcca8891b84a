"""Pictures of a scenario: those of its floors, put into a record, which opens no other file."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from mars2d.addons.floor import Floor
from mars2d.core.errors import InputError, one_line
from mars2d.core.picture import holds_pixels, picture_name, with_pixels, without_pixels
from mars2d.scenario.scenario import Scenario


def enclosed(value: Any) -> Any:
    """Return a scenario whose pictures are in it; any other value as it is.

    A picture that can't be read any more stays a name.
    """
    if not isinstance(value, Scenario):
        return value
    addons = [*value.addons]
    for k, addon in enumerate(addons):
        if isinstance(addon, Floor) and addon.image is not None:
            with suppress(InputError):
                addons[k] = addon.replace(image=with_pixels(addon.image, addon.picture))
    return value.replace(addons=addons)


def of_record(plain: dict[str, Any], missing: list[str]) -> dict[str, Any]:
    """Return a scenario of a record, as plain data, without the names of files.

    A picture that the record does not hold is named in `missing`, and nothing is opened for it.
    """
    addons = [*plain["addons"]]
    for k, addon in enumerate(addons):
        image = addon.get("image")
        if isinstance(image, str) and not holds_pixels(image):
            missing.append(f"picture {one_line(picture_name(image))} of {addon['type']}")
            addons[k] = addon | {"image": without_pixels(image)}
    return plain | {"addons": addons}
