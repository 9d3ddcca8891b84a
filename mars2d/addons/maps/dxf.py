"""DXF drawings: their unit, their hidden layers, and what ezdxf draws of them."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING

from mars2d.addons.maps.drawing import ALWAYS, Drawing, Unit, broken, layer_name
from mars2d.addons.maps.regions import GRID
from mars2d.core.errors import InputError
from mars2d.core.extras import extra

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

UNITS = {
    1: ("in", 0.0254), 2: ("ft", 0.3048), 4: ("mm", 1e-3), 5: ("cm", 1e-2), 6: ("m", 1.0),
    3: ("mi", 1609.344), 7: ("km", 1e3), 10: ("yd", 0.9144), 14: ("dm", 0.1),
    21: ("ft of US surveys", 1200 / 3937),
}  # fmt: skip
"""The units of the header's $INSUNITS in which maps are drawn, and their lengths in metres."""


def read_dxf(path: Path, unit: Unit | None, within: float) -> Drawing:
    """Read the model space of a DXF drawing, version R12 or later, text or binary.

    unit: None takes the header's. Walls are lines and curves; areas are HATCH, SOLID, TRACE and
    polylines with a width; blocks are followed, and clipped. Heights are left out. Layers that are
    off, frozen or not plotted are hidden. Curves are polylines, no more than `within` metres off.
    What is damaged is repaired as far as possible. Raises InputError.
    """
    name = path.name
    with extra("maps", f"{name}: a DXF drawing needs ezdxf", ALWAYS):
        import ezdxf.recover

        from mars2d.addons.maps.recorder import recorded
    with broken(name, "a DXF drawing"):
        log = logging.getLogger("ezdxf")
        if not log.handlers:  # whoever wants to see it has one
            log.addHandler(logging.NullHandler())
        notes: tuple[tuple[str, str], ...] = ()
        try:
            document = ezdxf.filemanagement.readfile(path)
        except Exception as flaw:  # whatever it is, the reader of damaged files may know better
            try:
                document, _ = ezdxf.recover.readfile(path)
            except Exception as error:
                raise InputError(
                    f"can't be read as a DXF drawing: {error}; a CAD program may repair it"
                ) from error
            notes = (("damaged", f"read as far as possible: {' '.join(str(flaw).split())}"),)
        unit = unit or _unit(document, named=b"$INSUNITS" in path.read_bytes())
        pieces, skipped = recorded(document, name, unit.metres, within)
    hidden = {
        layer_name(layer.dxf.name)
        for layer in document.layers
        if layer.is_off() or layer.is_frozen() or not layer.dxf.get("plot", 1)
    }
    return Drawing(
        name, "a DXF drawing", unit, tuple(pieces), notes=notes,
        hidden=frozenset({*hidden, "Defpoints"}), skipped=skipped, within=within + GRID,
    )  # fmt: skip


def _unit(document: Document, *, named: bool) -> Unit:
    """Return the unit that the header names; metres if it names none.

    named: whether the file names one; if not, the library supposes metres.
    """
    code = int(document.header.get("$INSUNITS", 0)) if named else 0
    if code in UNITS:
        return Unit(*UNITS[code], f"as the header says ($INSUNITS = {code})")
    if code == 0:
        return Unit("m", 1.0, "supposed: the header names no unit")
    known = ", ".join(f"{number} ({unit})" for number, (unit, _) in UNITS.items())
    raise InputError(
        f"$INSUNITS = {code} in the header: expected one of {known}; unit=... overrides it"
    )
