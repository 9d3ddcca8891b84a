"""Bars and picture share a surface of any size, at any size of text, without overlapping."""

from itertools import combinations

import pytest

from mars2d.output.raster.layout import TEXT_SIZES, Layout
from tests.cases import each_case

SIZES = [(640, 480), (800, 600), (1280, 720), (1920, 1080), (2560, 1440), (700, 1200)]
every_size = each_case("size", SIZES)
every_text = each_case("text", TEXT_SIZES)


def parts(layout):
    return (
        *(layout.header, layout.tools, layout.plot),
        *(layout.transport, layout.timebar, layout.slider, layout.footer),
    )


@every_size
@every_text
def test_the_parts_cover_the_surface_and_do_not_overlap(size, text):
    layout = Layout.of(size, text=text, controls=True)
    assert not any(a.colliderect(b) for a, b in combinations(parts(layout), 2))
    assert sum(part.width * part.height for part in parts(layout)) == size[0] * size[1]
    assert layout.plot.height >= 0.5 * size[1]
    assert min(layout.timebar.height, layout.slider.height) >= 24
    assert layout.timebar.width > 1.5 * layout.slider.width > 200


@each_case("size", [(1280, 720), (1920, 1080), (960, 600)])
def test_pictures_have_no_time_bar_and_are_laid_out_as_they_were(size):
    layout = Layout.of(size)
    assert layout.timebar.size[1] == layout.slider.size[0] == layout.tools.size[0] == 0
    assert layout.ui == max(0.9, min(size[0] / 1280, size[1] / 720) ** 0.8)
    assert layout.plot.bottom == layout.footer.top == size[1] - round(44 * layout.ui)


@every_text
@each_case("scale", [1.25, 2.0, 3.0])
def test_on_a_sharp_screen_everything_is_as_large_as_on_another_one(scale, text):
    once = Layout.of((1280, 720), text=text, controls=True)
    sharp = Layout.of(
        (round(1280 * scale), round(720 * scale)), text=text, scale=scale, controls=True
    )
    assert sharp.ui == pytest.approx(scale * once.ui)
    for a, b in zip(parts(once), parts(sharp), strict=True):
        assert [round(scale * side) for side in a] == pytest.approx(list(b), abs=4)
