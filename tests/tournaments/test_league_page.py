"""The page of a tournament in a browser, driven by real clicks and keys: what is seen."""

import itertools

import numpy as np
import pytest

import mars2d
from mars2d import Robot, Scenario
from mars2d.addons import Game
from mars2d.output.pages.replay import page as replay_page
from mars2d.output.pages.replay import replay_data
from mars2d.tournaments.isolation import Verdict
from mars2d.tournaments.league import league_tables
from mars2d.tournaments.match import Match, Played
from mars2d.tournaments.page import league_page, save_page
from tests.browser import Tab
from tests.tournaments.leagues import tournament_of

EVIL = "</script><script>alert(1)</script>'\"&amp;<img src=x onerror=alert(1)>\u2028{{title}}"
SEEN = EVIL.replace("\u2028", r"\u2028")
HUNTERS, RUNNERS = ("lead", "straight", f"hunt {EVIL}"), ("zigzag", f"run {EVIL}")


def chase(mu):
    """Blue flees to the right, red follows mu times as quickly."""
    red = Robot(name="red", pose=(-1, 0, 0))
    scenario = Scenario(
        robots=[red, Robot(name="blue " + EVIL.split("\u2028", maxsplit=1)[0], pose=(1, 0, 0))],
        addons=[Game({"pursuer": [0], "evader": [1]})],
        title="Chase",
        stop_time=8,
    )
    return mars2d.run(scenario, control=lambda world: np.array([[0.4 * mu, 0.2], [0.0, 0.0]]))


@pytest.fixture(scope="module")
def records():
    return {mu: chase(mu) for mu in (1, 3)}


def played(number, mu, seed, hunter, runner, data):
    """The pursuer wins at mu = 3, but for a few matches; the first law of all fails in some."""
    match = Match(
        number, "/home/me/chase.py", {"mu": 1}, seed, {"pursuer": hunter, "evader": runner}
    )
    if hunter.startswith("hunt") and seed == 1:
        verdict = Verdict("error", f"law.py, line 3: NameError: {EVIL}", 0.3)
        begun = mu == 3
        return Played(
            match, "evader", {}, None, f"it forfeits: {verdict.text}", {"pursuer": verdict},
            {"pursuer": f"tick\n{EVIL}\n\x1b[31m\0\ud800 end", "evader": "not shown"},
            steps=3 if begun else 0, replay=data if begun else "",
        )  # fmt: skip
    if hunter == "straight" and seed == 0:
        return Played(match, None, {}, None, "the time is over", steps=80, replay=data)
    if mu == 3:
        time = 20.0 - number
        return Played(match, "pursuer", {}, time, f"caught after {time} s", steps=9, replay=data)
    return Played(match, "evader", {}, None, "blue was not caught", steps=80, replay=data)


@pytest.fixture(scope="module")
def tournament(records):
    data = {mu: replay_data(record) for mu, record in records.items()}
    points = itertools.product((1, 3), HUNTERS, RUNNERS, (0, 1))
    matches = [
        played(number, mu, seed, hunter, runner, data[mu])
        for number, (mu, hunter, runner, seed) in enumerate(points, 1)
    ]
    return tournament_of(matches, f"Cup {EVIL}", "/home/me/chase.py")


@pytest.fixture(scope="module")
def path(tournament, tmp_path_factory):
    path = tmp_path_factory.mktemp("league") / "league.html"
    save_page(league_page(tournament), path)
    return path


@pytest.fixture
def open_tab(browser):
    """Return what opens a page; at the end, none has asked for anything or complained."""
    tabs = []

    def open_page(path, size=(1366, 900), mark="", **how):
        tab = Tab(browser, size, **how)
        tabs.append((tab, path.as_uri()))
        tab.page.on("dialog", lambda dialog: tab.complaints.append(dialog.message))
        tab.page.goto(path.as_uri() + mark)
        return tab

    yield open_page
    for tab, address in tabs:
        tab.close()
        assert set(tab.asked) <= {address, "about:srcdoc"}
        assert tab.complaints == []


@pytest.fixture
def tab(open_tab, path):
    return open_tab(path)


def shown(tab):
    """Return the numbers of the matches that are shown, from above."""
    rows = tab.page.locator("table.matches tbody tr:not([hidden]) .head")
    return [int(number) for number in rows.all_inner_texts()]


def column(tab, table, number):
    """Return the words of a column of a table, from above."""
    return tab.page.locator(f"{table} tbody tr > :nth-child({number})").all_inner_texts()


def watch(tab, number):
    """Click a match, wait for its replay and return the frame."""
    tab.page.get_by_role("button", name=f"{number}", exact=True).click()
    return playing(tab, number)


def playing(tab, number):
    """Wait for the replay of a match, which then has the keys; return its frame."""
    place = f'iframe[title^="Replay of match {number}."]'
    tab.page.frame_locator(place).locator("#time", has_text="/").wait_for()
    frame = tab.page.locator(place).element_handle().content_frame()
    tab.until(lambda: frame.evaluate("document.hasFocus()"))
    return frame


def press_inside(tab, key, done):
    """Press a key until the replay has got it: keys follow the focus into a frame with a delay."""

    def pressed():
        tab.page.keyboard.press(key)
        tab.page.wait_for_timeout(100)
        return done()

    tab.until(pressed)


def leave(tab):
    """Close the replay by a key that it does not get itself."""
    tab.page.locator("#close").focus()
    tab.page.keyboard.press("Escape")
    tab.page.locator("#show").wait_for(state="hidden")


def title(tab):
    return tab.text("#showTitle")


# -- what it says ---------------------------------------------------------------------------------


def test_the_same_tournament_has_the_same_page_which_knows_no_folder(tournament, path):
    text = path.read_text(encoding="utf-8")
    assert text == league_page(tournament)
    assert "/home/me" not in text


def test_it_says_what_was_played(tab):
    facts = tab.text("#facts")
    for words in (
        "chase.py",
        "3 as pursuer, 2 as evader",
        "mu = 1",
        "0, 1",
        "24, 4 forfeited",
    ):
        assert words in facts


@pytest.mark.nightly
def test_the_league_tables_have_the_numbers_of_the_standings(tab, tournament):
    assert tab.page.locator("table.league").count() == 2
    assert tab.page.locator("table.league caption").all_inner_texts() == ["As pursuer", "As evader"]
    seen = [row.split("\t") for row in tab.page.locator("table.league tbody tr").all_inner_texts()]
    standings = [[*row.values()] for _, rows in league_tables(tournament) for row in rows]
    for line, (place, law, *texts) in zip(seen, standings, strict=True):
        assert (line[0], line[1].split()[0]) == (place, law.split()[0])
        assert [text.strip() for text in line[2:]] == texts


# -- sorting and choosing -------------------------------------------------------------------------


@pytest.mark.nightly
def test_the_grading_sheet_fits_also_a_telephone(open_tab, path, tournament):
    for width in (1280, 390):
        tab = open_tab(path, (width, 800))
        points = [f"{row['points']:g}" for row in tournament.table("grades")]
        assert column(tab, "table.grades", 3) == points
        wide = tab.page.locator(".wide:has(.grades)")
        assert wide.evaluate("wide => wide.scrollWidth <= wide.clientWidth")


def test_matches_are_chosen_by_law_rival_and_forfeit(tab, tournament):
    def fitting(fits):
        return [each.match.number for each in tournament.matches if fits(each)]

    assert tab.text("#count") == "24 matches"
    tab.page.select_option("#law", label="zigzag")
    assert shown(tab) == fitting(lambda each: each.match.laws["evader"] == "zigzag")
    tab.page.select_option("#against", label="lead")
    wanted = fitting(lambda e: [*e.match.laws.values()] == ["lead", "zigzag"])
    assert shown(tab) == wanted == [1, 2, 13, 14]
    assert tab.text("#count") == "4 of 24 matches"
    tab.page.get_by_role("button", name="Show all").click()
    tab.page.get_by_label("forfeits only").check()
    assert shown(tab) == fitting(lambda each: each.verdicts)


@pytest.mark.nightly
def test_a_cell_of_the_matrix_has_the_share_and_picks_its_matches(tab):
    cell = tab.page.get_by_role(
        "button", name="lead against zigzag: 50 % of the points in 4 matches"
    )
    assert (cell.inner_text(), "--strength: 0%" in cell.get_attribute("style")) == ("50", True)
    cell.click()
    assert shown(tab) == [1, 2, 13, 14]
    last = tab.page.locator("table.matrix button").last
    last.focus()
    tab.press("Enter")
    assert len(shown(tab)) == 4
    assert tab.page.locator("#law").input_value() == last.get_attribute("data-law")


# -- replays --------------------------------------------------------------------------------------


def test_a_replay_holds_what_a_page_of_its_own_does(records):
    assert f'type="text/plain">{replay_data(records[3])}</script>' in replay_page(records[3])


def test_a_click_on_a_match_plays_it(open_tab, path):
    tab = open_tab(path, (700, 500), reduced_motion="no-preference")
    frame = watch(tab, 13)
    assert title(tab) == "13. lead as pursuer against zigzag as evader"
    assert "caught after 7.0 s" in tab.text("#ending")
    picture = "document.getElementById('picture').toDataURL()"
    before = frame.evaluate(picture)
    tab.until(lambda: frame.evaluate(picture) != before)
    press_inside(tab, "Space", lambda: "Paused at" in frame.locator("#live").text_content())


@pytest.mark.nightly
def test_a_forfeit_shows_what_the_law_printed_and_one_before_the_start_no_replay(tab):
    watch(tab, 22)
    assert f"NameError: {EVIL}".split("\u2028")[0] in tab.text("#ending")
    printed = tab.page.locator("#printed pre").text_content()
    assert printed == "\n".join(["tick", SEEN, r"\x1b[31m\x00\ud800 end"])
    assert tab.page.locator("#printed pre").count() == 1
    leave(tab)
    tab.page.get_by_role("button", name="10", exact=True).click()
    tab.page.get_by_text("There is no replay: it was left out").wait_for()
    assert tab.page.locator("iframe").count() == 0
    tab.press("ArrowDown")
    assert title(tab).startswith("11.")


# -- everybody ------------------------------------------------------------------------------------


@pytest.mark.nightly
def test_names_messages_and_output_are_text(tab, tournament):
    assert tab.page.title() == tab.page.locator("h1").text_content() == f"Cup {SEEN}"
    law = tab.page.locator("table.league bdi").nth(1).text_content()
    assert law in [name.replace(EVIL, SEEN) for name in HUNTERS]
    assert tab.page.locator("img").count() == 0
    replays = sum(bool(each.replay) for each in tournament.matches)
    assert tab.page.locator("script").count() == replays + 2
    frame = watch(tab, 22)
    assert frame.locator("img").count() == 0
    assert frame.locator("script").count() == 2


@pytest.mark.nightly
def test_a_screen_reader_finds_tables_and_controls(tab):
    watch(tab, 13)
    tree = tab.page.locator("#show").aria_snapshot()
    for line in ('dialog "13. lead as pursuer', 'button "Next match"', 'button "Close"', "iframe"):
        assert line in tree, line
    leave(tab)
    tree = tab.page.locator("main").aria_snapshot()
    for line in (
        'table "As pursuer"', 'table "Who beat whom"', 'table "All matches"', 'combobox "Law"',
        'columnheader "place"',
        'rowheader "lead"', "status: 24 matches", 'checkbox "forfeits only"',
    ):  # fmt: skip
        assert line in tree, line
