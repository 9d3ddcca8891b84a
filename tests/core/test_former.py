"""Former names of modules warn, and give what stands there now."""

from __future__ import annotations

import importlib
import sys

import pytest

import mars2d
from mars2d.core.former import NOW


def forget() -> None:
    """Let the former names be as if nobody had imported them."""
    for name in NOW:
        sys.modules.pop(f"mars2d.{name}", None)
        vars(mars2d).pop(name, None)


@pytest.fixture
def afresh():
    """Forget the former names that another test has imported, and those of this one."""
    kept = {name: value for name, value in vars(mars2d).items() if name in NOW}
    forget()
    yield
    forget()
    vars(mars2d).update(kept)


@pytest.mark.parametrize("former", NOW)
@pytest.mark.usefixtures("afresh")
@pytest.mark.filterwarnings("ignore:.*:FutureWarning")  # that of the package around a module
def test_an_import_by_a_former_name_warns_and_works(former):
    now = importlib.import_module(f"mars2d.{NOW[former]}")
    with pytest.warns(FutureWarning, match=rf"^mars2d\.{former} is mars2d\.{NOW[former]} now$"):
        module = importlib.import_module(f"mars2d.{former}")
    public = getattr(now, "__all__", [name for name in vars(now) if name[0] != "_"])
    assert all(getattr(module, name) is getattr(now, name) for name in public)
