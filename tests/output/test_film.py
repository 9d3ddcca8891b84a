"""Films: read back what was written."""

import sys

import numpy as np
import pygame
import pytest
from PIL import Image
from pygame.surfarray import array3d

import mars2d
from mars2d import Robot, Scenario
from mars2d.core.errors import InputError, MissingExtraError
from mars2d.core.extras import pip_line
from mars2d.core.scene import Scene
from mars2d.output.films.film import (
    cut_of,
    film_record,
    save_film,
    save_pictures,
)
from mars2d.output.films.footage import Drawings, shots
from mars2d.output.raster.picture import Artist
from mars2d.scenario.experiment import Experiment
from mars2d.world.loop import simulate
from tests.cases import each_case
from tests.window.circling import Circling

SIZE = (320, 240)


def frames(rows=20, last=20):
    source = Circling(rows=last)
    for row in range(rows + 1):
        source.row = row
        yield source.frame


def read_gif(path):
    with Image.open(path) as film:
        pictures, durations = [], []
        for k in range(film.n_frames):
            film.seek(k)
            durations.append(film.info["duration"])
            pictures.append(np.asarray(film.convert("RGB")).astype(int))
        return pictures, durations, film.info


def test_a_gif_holds_every_frame_for_its_time_and_repeats(tmp_path):
    save_film(frames(), tmp_path / "film.gif", fps=25, size=SIZE)
    pictures, durations, info = read_gif(tmp_path / "film.gif")
    assert len(pictures) == 21
    assert durations == [40] * 21
    assert info["loop"] == 0
    assert {p.shape for p in pictures} == {(240, 320, 3)}


def painted():
    """Return the pictures of the frames, (height, width, 3)."""
    artist = Artist(SIZE)
    return [array3d(artist.paint(frame)).swapaxes(0, 1).astype(int) for frame in frames()]


def test_a_gif_shows_what_the_picture_shows(tmp_path):
    save_film(frames(), tmp_path / "film.gif", size=SIZE, sensors=False)
    for picture, wanted in zip(read_gif(tmp_path / "film.gif")[0], painted(), strict=True):
        assert np.abs(picture - wanted).mean() < 0.5
        white = (wanted == 255).all(axis=2)
        assert (picture[white] == 255).all()


def test_frames_that_do_not_differ_prolong_the_one_before(tmp_path):
    still = [next(iter(frames()))] * 10
    save_film([*still, *frames()], tmp_path / "film.gif", size=SIZE, fps=20)
    durations = read_gif(tmp_path / "film.gif")[1]
    assert durations[0] == 11 * 50
    assert sum(durations) == 31 * 50


def test_the_frames_of_an_mp4_are_the_pictures_in_their_order(tmp_path):
    pytest.importorskip("av")
    save_film(frames(), tmp_path / "film.mp4", size=SIZE, sensors=False)
    with av_open(tmp_path / "film.mp4") as film:
        shown = [f.to_ndarray(format="rgb24").astype(int) for f in film.decode(video=0)]
    drawn = painted()
    apart = np.array([[np.abs(picture - wanted).mean() for wanted in drawn] for picture in shown])
    assert apart.argmin(axis=1).tolist() == list(range(21))
    assert apart.min(axis=1).max() < 2.0


def test_mp4_without_pyav_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(MissingExtraError) as told:
        save_film(frames(), tmp_path / "film.mp4")
    assert pip_line("video") in str(told.value)
    assert list(tmp_path.iterdir()) == []


@each_case("suffix", ["gif", "mp4"])
def test_a_film_that_fails_leaves_the_old_one_alone(tmp_path, suffix):
    if suffix == "mp4":
        pytest.importorskip("av")
    target = tmp_path / f"film.{suffix}"
    target.write_bytes(b"the old film")

    def torn():
        yield from frames(3)
        raise RuntimeError("torn")

    with pytest.raises(RuntimeError, match="torn"):
        save_film(torn(), target, size=SIZE)
    assert target.read_bytes() == b"the old film"
    assert list(tmp_path.iterdir()) == [target]


# -- films of records -----------------------------------------------------------------------------


def turning(world):
    return np.array([[0.5], [0.8]])


SCENARIO = Scenario(robots=[Robot(pose=(0, 0, 0))], sampling_time=0.5, stop_time=4.0)


@pytest.fixture(scope="module")
def record():
    return mars2d.run(SCENARIO, control=turning)


def seen(record, **part):
    """Return the frames of a film of a record."""
    cut = cut_of(record, **part)
    return list(shots(cut, 0.5, len(record) - 1, record.frame))


def test_slow_motion_shows_what_lies_between_the_sampling_times(record):
    frames = seen(record, speed=0.1, fps=25, start=1.0, end=1.5)
    assert len(frames) == 127  # 5 s of film, and the end once more
    times = np.array([frame.time for frame in frames])
    assert times[:-1] == pytest.approx(1.0 + 0.004 * np.arange(126))
    x = np.array([frame.pose[0, 0] for frame in frames])
    assert (np.diff(x[:-1]) > 0).all()
    assert np.ptp(np.diff(x[:-1])) < 1e-12
    assert x[0] == record.pose[2, 0, 0]
    assert x[-1] == record.pose[3, 0, 0]


def test_a_film_shows_the_part_that_is_asked_for_and_the_last_frame_is_its_end(record):
    frames = seen(record, speed=2.0, fps=10, start=0.7, end=2.9)
    assert frames[0].time == pytest.approx(0.7)
    assert frames[-1].time == pytest.approx(2.9)
    assert seen(record)[-1].over_message == record.over_message
    assert seen(record, end=2.0)[-1].over_message == ""


def test_a_film_has_what_add_ons_draw_while_the_run_goes_on():
    class Count(mars2d.addons.Addon):
        def on_draw(self, world, scene):
            scene.text((0, 0), str(world.iteration))

    drawings = Drawings()
    scenario = SCENARIO.replace(addons=[Count()])
    record = simulate(Experiment(scenario, turning), watchers=[drawings]).record
    for frame in map(drawings.on, map(record.frame, range(len(record)))):
        scene = Scene()
        frame.draw_addons(scene)
        assert [shape.text for shape in scene.shapes] == [str(frame.iteration)]


@each_case("suffix", ["gif", "mp4"])
def test_a_record_films_itself(record, tmp_path, suffix):
    if suffix == "mp4":
        pytest.importorskip("av")
    path = record.film(tmp_path / f"a.{suffix}", speed=4.0, size=(128, 96), start=1, end=3)
    with Image.open(path) if suffix == "gif" else av_open(path) as film:
        told = film.size if suffix == "gif" else film.streams.video[0].frames
    assert told == ((128, 96) if suffix == "gif" else 14)
    assert list(tmp_path.iterdir()) == [path]


def av_open(path):
    import av

    return av.open(str(path))


@each_case(
    "name, options, told",
    [
        ("a.gif", {"start": -1}, "a film from -1 s on: the record goes from 0 to 4 s"),
        ("a.gif", {"start": 1, "end": 9}, "a film from 1 to 9 s: the record goes from 0 to 4 s"),
        ("a.gif", {"start": 3, "end": 3}, "a film from 3 to 3 s: expected an end after its start"),
        ("a.gif", {"end": float("nan")}, "end = nan: expected seconds, and finite"),
        ("a.gif", {"speed": "max"}, "speed = 'max': expected a number > 0"),
        ("a.gif", {"speed": 1e-9}, "at most 100,000"),
        ("a.gif", {"fps": 60}, "fps = 60: expected 0.1 to 50 frames per second in a .gif"),
        ("a.gif", {"size": (63, 64)}, "size = (63, 64): expected (width, height) in pixels, 64 x"),
        ("a.mp4", {"size": (641, 360)}, "expected even numbers of pixels for .mp4, such as 642"),
        ("a.avi", {}, "a.avi: expected a film's name to end in .gif or .mp4"),
    ],
)
def test_what_can_not_be_filmed_is_said_and_leaves_nothing(record, tmp_path, name, options, told):
    if name.endswith("mp4"):
        pytest.importorskip("av")
    with pytest.raises(InputError) as error:
        film_record(record, tmp_path / name, **options)
    assert told in str(error.value)
    assert list(tmp_path.iterdir()) == []


def test_the_colours_of_an_mp4_are_those_of_the_picture(tmp_path):
    pytest.importorskip("av")

    colors = ["#0072b2", "#d55e00", "#009e73", "#e69f00", "#ffffff", "#000000"]

    def striped():
        picture = pygame.Surface(SIZE, 0, 32)
        for k, color in enumerate(colors):
            picture.fill(color, (50 * k, 0, 50, 240))
        yield picture

    save_pictures(striped(), tmp_path / "film.mp4")
    with av_open(tmp_path / "film.mp4") as film:
        shown = next(film.decode(video=0)).to_ndarray(format="rgb24").astype(int)
    for k, color in enumerate(colors):
        assert np.abs(shown[120, 50 * k + 25] - np.array(pygame.Color(color)[:3])).max() <= 3
