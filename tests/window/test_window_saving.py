"""What is kept of the window: pictures and films."""

import signal
import sys
import time

import numpy as np
import pytest
from PIL import Image

from tests.window.person import differing


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "kept"
    path.mkdir()
    return path


def test_p_saves_what_is_seen_and_never_over_another_picture(open_window, folder):
    window = open_window(0, folder=folder)
    before = window.still()
    window.press("p")
    window.says(f"picture: {folder / 'circling_1.png'}")
    saved = np.asarray(Image.open(folder / "circling_1.png").convert("RGB")).astype(int)
    left, top, width, height = window.state["plot"]
    arena = before[top : top + height, left:]
    # Without buttons, time bar and the note that tells of it.
    assert saved.shape[1] == width
    assert differing(arena, saved[top : top + height], rows=np.s_[:]) == 0
    window.press("Right", "p")
    window.says("circling_2.png")
    again = np.asarray(Image.open(folder / "circling_2.png").convert("RGB")).astype(int)
    assert differing(saved, again) > 20
    assert (folder / "circling_1.png").read_bytes() != (folder / "circling_2.png").read_bytes()
    window.do("keydown", "p", "sleep", "1", "keyup", "p")  # held, it is one picture
    window.says("circling_3.png")
    window.settle()
    assert len(list(folder.iterdir())) == 3


def test_v_films_until_it_is_pressed_again(open_window, folder):
    av = pytest.importorskip("av")
    window = open_window(5, folder=folder, rows=1000)
    begun = time.monotonic()
    window.press("v")
    window.until(lambda s: s["filming"])
    red = (0xD6, 0x27, 0x28)
    assert window.shows(lambda seen: (seen[60:110, 40:110] == red).all(axis=2).sum() > 50)
    start = window.state["time"]
    window.until(lambda s: s["time"] > start + 5)
    window.press("v")
    window.until(lambda s: not s["filming"])
    lasted = time.monotonic() - begun
    window.says(f"film: {folder / 'circling_1.mp4'}")
    with av.open(folder / "circling_1.mp4") as film:
        frames = [frame.to_ndarray(format="rgb24").astype(int) for frame in film.decode(video=0)]
    assert 2 < len(frames) < 25 * lasted + 10  # however many pictures there were
    assert frames[0].shape[1] == window.state["plot"][2]
    assert differing(frames[0], frames[-1], by=60) > 200
    assert not any((frame[60:110, :110] == red).all(axis=2).sum() > 20 for frame in frames)
    window.press("v")
    window.until(lambda s: s["filming"])
    window.press("space")
    window.shown.notes.clear()
    assert window.shown._moves, "a film goes on while time stands still"
    window.do("sleep", 3)
    window.press("ctrl+q")  # closing the window ends the film
    window.until(lambda s: s.get("left"))
    with av.open(folder / "circling_2.mp4") as film:
        assert sum(1 for _ in film.decode(video=0)) > 0


@pytest.mark.parametrize("place", ["locked", "gone"])
def test_where_no_file_can_be_made_words_say_so(open_window, folder, place):
    if place == "locked" and not sys.platform.startswith("linux"):
        pytest.skip("there is no folder where nobody may write")
    window = open_window(0, folder="/proc" if place == "locked" else folder)
    if place == "gone":
        folder.rmdir()
    words = "no file can be made"
    for key in ("p", "v"):
        window.press(key)
        window.says(words)
        assert not window.settle()["filming"]
    window.press("Right")
    window.until(lambda s: s["row"] == 1)


@pytest.mark.skipif(sys.platform != "linux", reason="limits the size of files as Linux does")
def test_a_film_that_no_disk_takes_is_removed_and_said(open_window, folder):
    import resource

    pytest.importorskip("av")
    window = open_window(5, folder=folder, rows=1000)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        window.press("v")
        resource.setrlimit(resource.RLIMIT_FSIZE, (20, before[1]))
        window.until(lambda s: not s["filming"])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    window.says("circling_1.mp4")
    assert not list(folder.glob("*.mp4"))
