"""A surface that remembers which words were drawn on it, and where."""

from itertools import combinations

import pygame

from mars2d.output.raster.fonts import Fonts
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import DARK, LIGHT
from tests.cases import each_case

THEMES = each_case("theme", [LIGHT, DARK])


class Written(pygame.Surface):
    """Remembers the texts of a painter that were blitted on it: pairs of a text and its place."""

    def __init__(self, size):
        super().__init__(size, 0, 32)
        self.words = []

    def blit(self, source, place, *rest, **options):
        if isinstance(source, Text):
            corner = place[:2] if not isinstance(place, pygame.Rect) else place.topleft
            self.words.append((source.text, pygame.Rect(corner, source.get_size())))
        return super().blit(source, place, *rest, **options)

    @property
    def texts(self):
        return [text for text, _ in self.words]

    def place(self, text):
        return next(place for found, place in self.words if found == text)

    def crowded(self):
        """Return pairs of words that lie on each other."""
        # Letters have room round them: their lower and upper rims may meet.
        tight = [(text, place.inflate(-2, -place.height // 3)) for text, place in self.words]
        return [(a, b) for (a, one), (b, two) in combinations(tight, 2) if one.colliderect(two)]

    def cut(self):
        """Return words that are not all on the surface."""
        return [text for text, place in self.words if not self.get_rect().contains(place)]


class Text(pygame.Surface):
    """A rendered text that knows what it says."""


class Pens(Fonts):
    """Fonts whose texts know what they say."""

    def render(self, text, size, color, bold=False, mono=False):
        image = super().render(text, size, color, bold, mono)
        known = Text(image.get_size(), pygame.SRCALPHA, 32)
        pygame.Surface.blit(known, image, (0, 0))
        known.text = text
        return known


def painter(layout, theme):
    made = Painter(Pens(), theme=theme)
    made.ui = layout.ui
    return made


def pixels(surface):
    """Return (height, width, 3)."""
    return pygame.surfarray.array3d(surface).swapaxes(0, 1).astype(int)
