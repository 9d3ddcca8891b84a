"""Materials are found by their names, and their figures make pairs as handbooks have them."""

from __future__ import annotations

import pytest

from mars2d.bodies.props import Box
from mars2d.core.errors import InputError
from mars2d.core.materials import MATERIALS, surface_friction, surface_restitution
from tests.cases import each_case

CHECKS = [(surface_friction, "friction", 1000), (surface_restitution, "restitution", 1)]


@each_case("name", MATERIALS)
def test_a_material_is_one_that_can_be(name):
    density, friction, restitution = MATERIALS[name]
    assert 10 < density < 20_000
    assert 0 < friction < 1.5
    assert 0 < restitution < 1


@each_case(
    ("a", "b", "low", "high"),
    [
        # Sliding friction of dry pairs, in the ranges of the tables that materials.py names.
        ("steel", "steel", 0.42, 0.8),
        ("wood", "wood", 0.2, 0.5),
        ("steel", "wood", 0.2, 0.6),
        ("steel", "aluminium", 0.47, 0.61),
        ("steel", "plastic", 0.18, 0.45),
        ("rubber", "concrete", 0.6, 1.0),
        ("rubber", "rubber", 1.1, 1.2),
        ("teflon", "teflon", 0.03, 0.05),
        ("ice", "ice", 0.02, 0.1),
        ("glass", "glass", 0.39, 0.41),
    ],
)
def test_the_product_of_two_surfaces_is_the_friction_of_the_pair(a, b, low, high):
    assert low <= MATERIALS[a].friction * MATERIALS[b].friction <= high


@each_case(("check", "quantity", "high"), CHECKS)
def test_a_surface_takes_a_number_or_a_materials_name(check, quantity, high):
    for value in (0, 0.5, high):
        assert check("Robot.x", value) == value
        assert type(check("Robot.x", value)) is float
    for name, found in MATERIALS.items():
        assert check("Robot.x", name) == getattr(found, quantity)


@each_case(
    "check", [surface_friction, surface_restitution, lambda _name, value: Box(material=value)]
)
@each_case(
    ("value", "hint"),
    [
        ("woood", "did you mean 'wood'"),
        ("Steel", "did you mean 'steel'"),
        ("aluminum", "did you mean 'aluminium'"),
        ("RUBBER", "did you mean 'rubber'"),
        ("xyz", "aluminium.*, .*cardboard.*, .*concrete"),
        ("", "aluminium.*, .*cardboard.*, .*concrete"),
    ],
)
def test_an_unknown_material_gets_the_nearest_name_or_all(check, value, hint):
    with pytest.raises(InputError, match=hint) as error:
        check("Box.material", value)
    assert str(error.value).startswith("Box.material = ")
