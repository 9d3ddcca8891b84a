"""What is kept of a window: never over another file, and films that show what was shown."""

import sys

import numpy as np
import pygame
import pytest
from PIL import Image

from mars2d import InputError
from mars2d.output.films.filming import FPS, Filming, film_suffix
from mars2d.window.screen.saving import free_name, saved
from tests.cases import each_case

SIZE = (160, 120)


def painted(color, size=SIZE):
    surface = pygame.Surface(size, 0, 32)
    surface.fill(color)
    return surface


class Clock:
    """A clock that goes when it is told to."""

    now = 100.0

    def __call__(self):
        return self.now


def frames_of(path):
    """Return the frames of a film with when each begins: (seconds, (height, width, 3))."""
    if path.suffix == ".mp4":
        import av

        with av.open(str(path)) as film:
            return [
                (f.time, f.to_ndarray(format="rgb24").astype(int)) for f in film.decode(video=0)
            ]
    found, time = [], 0.0
    with Image.open(path) as film:
        for k in range(film.n_frames):
            film.seek(k)
            found.append((time, np.asarray(film.convert("RGB")).astype(int)))
            time += film.info["duration"] / 1000
    return found


# -- names, pictures, listings --------------------------------------------------------------------


def test_names_are_numbered_and_made_at_once(tmp_path):
    names = [free_name(tmp_path, "Random walk: 2 robots!", ".png").name for _ in range(3)]
    assert names == [f"random_walk_2_robots_{k}.png" for k in (1, 2, 3)]
    assert free_name(tmp_path, "../..", ".py").parent == tmp_path
    assert free_name(tmp_path, "x" * 500, ".py").name == f"{'x' * 60}_1.py"


def test_a_file_that_cannot_be_written_leaves_nothing_behind(tmp_path):
    with pytest.raises(InputError, match="full"):
        saved(tmp_path, "walk", ".csv", lambda path: (_ for _ in ()).throw(InputError("full")))
    assert not list(tmp_path.iterdir())


# -- films ----------------------------------------------------------------------------------------


@each_case("suffix", [".mp4", ".gif"])
def test_a_film_goes_by_the_clock(suffix, tmp_path):
    clock = Clock()
    film = Filming(tmp_path / f"film{suffix}", clock)
    for k in range(60):  # more often than there are frames
        film.take(painted("red" if k < 30 else "blue"))
        clock.now += 1 / 60
    clock.now = 102.0  # a second for which nothing is drawn
    film.take(painted("green"))
    assert film.seconds == pytest.approx(2.0, abs=2 / FPS)
    found = frames_of(film.stop())
    for at, color in {0.0: "red", 0.4: "red", 0.6: "blue", 1.9: "blue", 2.0: "green"}.items():
        frame = [picture for begin, picture in found if begin <= at + 0.001][-1]
        assert np.abs(frame[60, 80] - pygame.Color(color)[:3]).max() < 30, at


@each_case("suffix", [".mp4", ".gif"])
def test_another_size_is_fitted_into_the_first(suffix, tmp_path):
    clock = Clock()
    film = Filming(tmp_path / f"film{suffix}", clock)
    for size in (SIZE, (320, 120), (1, 400), SIZE):
        film.take(painted("red", size))
        clock.now += 1 / FPS
    found = [picture for _, picture in frames_of(film.stop())]
    assert {picture.shape for picture in found} == {(120, 160, 3)}


def test_films_are_mp4_where_that_is_installed_and_gif_elsewhere(tmp_path, monkeypatch):
    for suffix in (".mp4", ".gif"):
        film = Filming(free_name(tmp_path, "walk", film_suffix()))
        assert film.path.name == f"walk_1{suffix}"
        film.take(painted("red"))
        assert frames_of(film.stop())
        monkeypatch.setitem(sys.modules, "av", None)
