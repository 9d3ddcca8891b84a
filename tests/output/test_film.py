"""Films: read back what was written."""

import builtins
import itertools
import subprocess
import sys

import numpy as np
import pygame
import pytest
from PIL import Image

from mars2d.errors import InputError, MissingExtraError
from mars2d.output.film import film_rows, save_film, save_pictures
from tests.view.circling import Circling

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


def test_a_gif_shows_what_the_picture_shows(tmp_path):
    from pygame.surfarray import array3d

    from mars2d.view.picture import Artist

    save_film(frames(), tmp_path / "film.gif", size=SIZE, sensors=False)
    artist = Artist(SIZE)
    for picture, frame in zip(read_gif(tmp_path / "film.gif")[0], frames(), strict=True):
        wanted = array3d(artist.paint(frame)).swapaxes(0, 1).astype(int)
        error = np.abs(picture - wanted)
        assert error.mean() < 0.5
        white = (wanted == 255).all(axis=2)
        assert (picture[white] == 255).all()


def test_robots_move_in_a_gif(tmp_path):
    save_film(frames(), tmp_path / "film.gif", size=SIZE)
    pictures = read_gif(tmp_path / "film.gif")[0]
    assert all((a != b).any() for a, b in itertools.pairwise(pictures))


def test_frames_that_do_not_differ_prolong_the_one_before(tmp_path):
    still = [next(iter(frames()))] * 10
    save_film([*still, *frames()], tmp_path / "film.gif", size=SIZE, fps=20)
    durations = read_gif(tmp_path / "film.gif")[1]
    assert durations[0] == 11 * 50
    assert sum(durations) == 31 * 50


def test_odd_rates_keep_the_length(tmp_path):
    save_film(frames(), tmp_path / "film.gif", size=SIZE, fps=30)
    assert sum(read_gif(tmp_path / "film.gif")[1]) == pytest.approx(1000 * 21 / 30, abs=5)


def test_an_mp4_holds_every_frame_at_an_even_size(tmp_path):
    av = pytest.importorskip("av")
    save_film(frames(), tmp_path / "film.mp4", fps=25, size=(321, 239))
    with av.open(str(tmp_path / "film.mp4")) as film:
        stream = film.streams.video[0]
        assert stream.codec_context.pix_fmt == "yuv420p"
        assert float(stream.average_rate) == 25
        pictures = [f.to_ndarray(format="rgb24").astype(int) for f in film.decode(stream)]
    assert len(pictures) == 21
    assert pictures[0].shape == (240, 322, 3)
    assert np.abs(pictures[0] - pictures[-1]).max() > 100


def test_the_frames_of_an_mp4_are_the_pictures_in_their_order(tmp_path):
    av = pytest.importorskip("av")
    from pygame.surfarray import array3d

    from mars2d.view.picture import Artist

    save_film(frames(), tmp_path / "film.mp4", size=SIZE, sensors=False)
    artist = Artist(SIZE)
    drawn = [array3d(artist.paint(frame)).swapaxes(0, 1).astype(int) for frame in frames()]
    with av.open(str(tmp_path / "film.mp4")) as film:
        shown = [f.to_ndarray(format="rgb24").astype(int) for f in film.decode(video=0)]
    apart = np.array([[np.abs(picture - wanted).mean() for wanted in drawn] for picture in shown])
    assert apart.argmin(axis=1).tolist() == list(range(21))
    assert apart.min(axis=1).max() < 2.0


def test_colours_that_come_later_are_matched_with_the_nearest_of_the_palette(tmp_path):
    def painted(color):
        picture = pygame.Surface(SIZE, 0, 32)
        picture.fill("white")
        picture.fill("#0072b2", (20, 20, 60, 60))
        picture.fill(color, (100, 20, 60, 60))
        return picture

    colors = ["#ffffff", "#13a877", "#7f0203", "#fefdfc", "#808181"]
    save_pictures(map(painted, colors), tmp_path / "film.gif")
    with Image.open(tmp_path / "film.gif") as film:
        palette = np.array(film.getpalette()).reshape(-1, 3)[:-1].astype(int)
    for picture, color in zip(read_gif(tmp_path / "film.gif")[0], colors, strict=True):
        wanted = np.array(pygame.Color(color)[:3])
        nearest = np.linalg.norm(palette - wanted, axis=1).min()
        assert np.linalg.norm(picture[50, 130] - wanted) <= nearest + 6  # of 6 bits a channel
        assert (picture[50, 50] == (0x00, 0x72, 0xB2)).all()
        assert (picture[200, 200] == 255).all()


def test_progress_is_told_frame_by_frame(tmp_path):
    counts = []
    save_film(frames(4), tmp_path / "film.gif", size=SIZE, progress=counts.append)
    assert counts == [1, 2, 3, 4, 5]


def test_mp4_without_pyav_says_what_to_install(tmp_path, monkeypatch):
    usual = builtins.__import__

    def without_av(name, *args, **kwargs):
        if name == "av":
            raise ImportError(name)
        return usual(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without_av)
    with pytest.raises(MissingExtraError) as told:
        save_film(frames(), tmp_path / "film.mp4")
    assert 'pip install "mars2d[video]"' in str(told.value)
    assert list(tmp_path.iterdir()) == []


def test_wrong_names_and_places_are_told(tmp_path):
    with pytest.raises(InputError, match=r"film\.avi.*\.gif or \.mp4"):
        save_film(frames(), tmp_path / "film.avi")
    with pytest.raises(InputError, match=r"no/film\.gif.*can't be written"):
        save_film(frames(), tmp_path / "no" / "film.gif")
    with pytest.raises(InputError, match="at least one frame"):
        save_film([], tmp_path / "film.gif")
    with pytest.raises(InputError, match="fps = 0"):
        save_film(frames(), tmp_path / "film.gif", fps=0)
    with pytest.raises(InputError, match=r"fps = 100.*at most 50"):
        save_film(frames(), tmp_path / "film.gif", fps=100)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
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


@pytest.mark.parametrize("speed", [0.5, 1, 10])
@pytest.mark.parametrize("sampling_time", [0.01, 0.1, 1.0])
def test_a_film_lasts_its_time_over_its_speed(speed, sampling_time):
    times = np.arange(101) * sampling_time
    rows = film_rows(times, speed, fps=25)
    assert len(rows) / 25 == pytest.approx(times[-1] / speed, abs=0.04)
    assert rows[0] == 0 or len(rows) == 1
    assert rows[-1] == 100
    assert (np.diff(rows) >= 0).all()
    shown = np.linspace(0, times[-1], len(rows)) if len(rows) > 1 else times[-1:]
    assert (np.abs(times[rows] - shown) < sampling_time * (1 + 1e-9)).all()


def test_a_film_of_one_row_is_one_frame():
    assert film_rows([0.0]).tolist() == [0]


@pytest.mark.parametrize(("speed", "fps"), [(0, 25), ("max", 25), (-1, 25), (1, 0)])
def test_rates_must_be_positive_numbers(speed, fps):
    with pytest.raises(InputError, match="expected a number > 0"):
        film_rows([0, 1], speed, fps)


def test_the_film_module_is_imported_without_pygame():
    code = "import sys, mars2d.output.film; assert not {'pygame', 'av', 'PIL'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
