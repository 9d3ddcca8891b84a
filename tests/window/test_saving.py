"""What is kept of a window: never over another file, and films that show what was shown."""

import sys
import time
from math import pi

import numpy as np
import pygame
import pytest
from PIL import Image

from mars2d import InputError, Robot, Scenario
from mars2d.output.films.filming import FPS, Filming, film_suffix
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.window.run.director import Director
from mars2d.window.screen.player import Player
from mars2d.window.screen.saving import Saver, free_name, saved
from mars2d.window.widgets.notes import Notes
from mars2d.world.timeline import Timeline
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


def waited(film):
    """Wait until a film has written what it was given."""
    while film.busy:
        time.sleep(0.001)


# -- names, pictures, listings --------------------------------------------------------------------


def test_names_are_numbered_and_made_at_once(tmp_path):
    names = [free_name(tmp_path, "Random walk: 2 robots!", ".png").name for _ in range(3)]
    assert names == [f"random_walk_2_robots_{k}.png" for k in (1, 2, 3)]
    assert free_name(tmp_path, "../..", ".py").parent == tmp_path
    assert free_name(tmp_path, "x" * 500, ".py").name == f"{'x' * 60}_1.py"


def test_a_folder_that_cannot_be_written_is_told_in_words(tmp_path):
    with pytest.raises(InputError, match="nowhere: no file can be made here, No such file"):
        free_name(tmp_path / "nowhere", "walk", ".png")


def test_a_file_that_cannot_be_written_leaves_nothing_behind(tmp_path):
    with pytest.raises(InputError, match="full"):
        saved(tmp_path, "walk", ".csv", lambda path: (_ for _ in ()).throw(InputError("full")))
    assert not list(tmp_path.iterdir())


def test_pictures_and_scenarios_are_kept_beside_others(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walk_1.png").write_text("mine")
    notes = Notes()
    saver = Saver(notes, "walk")
    saver.picture(painted("red"))
    assert (tmp_path / "walk_1.png").read_text() == "mine"
    with Image.open(tmp_path / "walk_2.png") as picture:
        assert picture.size == SIZE
        assert picture.getpixel((5, 5)) == (255, 0, 0)
    scenario = Scenario(title="Kept", robots=[Robot(pose=(1, 2, 3))])
    saver.scenario(scenario, None)
    assert open_experiment(tmp_path / "walk_1.toml").scenario == scenario
    paths = tmp_path / "walk_2.png", tmp_path / "walk_1.toml"
    assert [note.text for note in notes._notes] == [
        f"picture: {paths[0]}", f"scenario: {paths[1]}"
    ], "there is no window, and no clipboard"  # fmt: skip


# -- films ----------------------------------------------------------------------------------------


@each_case("suffix", [".mp4", ".gif"])
def test_a_film_goes_by_the_clock(suffix, tmp_path):
    clock = Clock()
    film = Filming(tmp_path / f"film{suffix}", clock)
    for k in range(60):  # more often than there are frames
        film.take(painted("red" if k < 30 else "blue"))
        waited(film)
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
        waited(film)
        clock.now += 1 / FPS
    found = [picture for _, picture in frames_of(film.stop())]
    assert {picture.shape for picture in found} == {(120, 160, 3)}
    wide = found[1][:, 80, 0] > 128  # one column: black, red, black
    assert (wide[:25].any(), wide[40:80].all(), wide[95:].any()) == (False, True, False)


def test_films_are_mp4_where_that_is_installed_and_gif_elsewhere(tmp_path, monkeypatch):
    for suffix in (".mp4", ".gif"):
        film = Filming(free_name(tmp_path, "walk", film_suffix()))
        assert film.path.name == f"walk_1{suffix}"
        film.take(painted("red"))
        assert frames_of(film.stop())
        monkeypatch.setitem(sys.modules, "av", None)


def test_a_scenario_is_kept_with_short_numbers_which_are_those_of_the_file_for_what_stands():
    third = 1 / 3

    def turning(_robot):
        return 0.3, 0.7

    robots = [Robot(pose=(0, 0, 0), controller=turning), Robot(pose=(third, 3, pi))]
    timeline = Timeline(Experiment(Scenario(robots=robots)))
    for _ in range(17):
        timeline.advance()
    director = Director(Player(timeline, 1.0), Notes(), lambda *_: True)
    kept = director.scenario_to_save()
    assert kept.robots[1].pose == (third, 3, pi)
    (x, y, theta), exact = kept.robots[0].pose, timeline.frame.pose[:, 0]
    assert np.abs(np.array([x, y, theta]) - exact).max() <= 5e-7
    assert all(len(repr(value)) <= 9 for value in (x, y, theta))
    timeline.world.operator.place(0, (1e-9, -1e-9, 1.0))
    director._player.settle()
    assert str(director.scenario_to_save().robots[0].pose) == "(0.0, 0.0, 1.0)"
