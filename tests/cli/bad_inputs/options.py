"""Commands and options of every verb, mistyped or that can't be followed."""

from __future__ import annotations

from tests.cli.bad_inputs.case import Case, typed
from tests.cli.bad_inputs.records import saved

RUN = "mars2d run random_walk --headless --stop-time 2"

ANYWHERE = [
    ("a misspelt verb", "mars2d rnu random_walk", "'rnu'", "did you mean 'run'?"),
    ("no verb at all", "mars2d nosuch", "'nosuch'", "known: check, compare"),
    ("an example for a verb", "mars2d random_walk", "write mars2d run random_walk"),
    ("a misspelt example for a verb", "mars2d random_wal", "did you mean 'run random_walk'?"),
    ("an option of another verb", "mars2d replay run.npz --seed 3", "--seed 3 (see mars2d replay"),
    ("a shell without a script", "mars2d doctor --completion nushell", "nushell", "powershell"),
    ("an unknown option", "mars2d --verbose", "--verbose", "mars2d --help"),
]

OF_RUN = [
    ("no experiment", "mars2d run", "EXPERIMENT", "mars2d run --help"),
    ("two experiments", "mars2d run random_walk crowd --headless", "crowd", "mars2d run --help"),
    ("a name of 300 letters", f"mars2d run {'a' * 300}.py --headless", "aaa", "too long"),
    ("a record of 300 letters", f"mars2d replay {'a' * 300}.npz", "aaa", "too long"),
    ("a saved record of 300 letters", f"{RUN} --record {'a' * 300}.npz", "aaa", "too long"),
    ("a misspelt option", f"{RUN} --headles", "did you mean '--headless'?"),
    ("a broken seed", f"{RUN} --seed 1.5", "--seed", "'1.5'"),
    ("a stop time that is a word", "mars2d run random_walk --stop-time soon", "'soon'"),
    ("a stop time without a value", "mars2d run random_walk --stop-time", "--stop-time"),
    ("a step a key without a window", f"{RUN} --speed 0", "--speed 0", "window"),
    ("a setting without a name", f"{RUN} --set =5", "NAME=VALUE"),
    ("a robot that is not there", f"{RUN} --set robots.7.mass=1", "robots.7", "0 to 1"),
    ("a setting with an empty name in it", f"{RUN} --set robots..mass=1", "'robots.'", "0 to 1"),
    ("a set mass that is a formula", f"{RUN} --set 'robots.*.mass=1+1/2'", "'1+1/2'", "a number"),
    ("an unknown parameter", "mars2d run follow_the_leader --headless --set folowers=2",
     "'folowers'", "'followers'"),
    ("a record in no folder", f"{RUN} --record no/where/a.npz", "--record", "no folder"),
    ("a figure of no format", f"{RUN} --figure a.bmp", "--figure a.bmp", ".png"),
    ("times without a figure", f"{RUN} --at 1,2", "--at", "--figure"),
    ("times of NaN", f"{RUN} --figure a.png --at nan", "--at nan", "0 to 2 s"),
    ("a size of nothing", f"{RUN} --video a.gif --size 0x0", "(0, 0)", "64 x 64"),
    ("a film from before the start", f"{RUN} --video a.gif --from -5", "-5"),
]  # fmt: skip

OF_OTHERS = [
    ("a game that is not there", "mars2d play corner_gam", "did you mean 'corner_game'?"),
    ("three people", "mars2d play sumo --role red,blue,red", "two people at most"),
    (
        "a law for a role that is not there",
        "mars2d check pursuers/ahead.py --for corner_game --role pursuers",
        "did you mean 'pursuer'?",
    ),
    (
        "a law for a game that is none",
        "mars2d check a.py --for random_walk --role red",
        "random_walk",
        "who has won",
    ),
    ("an edit without a display", "mars2d edit random_walk", "no display"),
    (
        "a comparison of physics by hand",
        "mars2d compare head_on --set physics=stop",
        "--set physics",
    ),
    ("a comparison of nothing", "mars2d compare", "EXPERIMENT"),
    ("a replay of an experiment", "mars2d replay random_walk", "random_walk"),
    ("a check of a CAD file", "mars2d check plan.dwg", "plan.dwg", ".py", ".dxf"),
    ("a paper without a folder", "mars2d paper", "OUT"),
    ("a paper over a file", "mars2d paper /dev/null --only 2", "/dev/null", "folder"),
]

OF_SWEEP = [
    ("a sweep of nothing", "", "EXPERIMENT"),
    ("a sweep of no seeds", "random_walk --seeds 0", "seeds = 0"),
    ("a sweep from a seed below 0", "random_walk --first-seed -1", "seed = -1"),
    ("an empty value", "random_walk --set sampling_time=1,,2", "nothing between two commas"),
    ("a range of one", "random_walk --set sampling_time=1:2:1", "a count of 2"),
    ("a range without end", "random_walk --set sampling_time=1:1e999:3", "inf"),
    ("a swept misspelt setting", "random_walk --set samplng_time=1,2", "'sampling_time'"),
    ("a table of no format", "random_walk --out a.xlsx", "--out a.xlsx", ".csv"),
    ("a comparison of one value", "random_walk --set sampling_time=1 --compare sampling_time",
     "--compare sampling_time", "one value"),
    ("no workers", "random_walk --workers 0", "workers=0"),
    ("a study that is not there", "a.csv", "a.csv", "No such file"),
]  # fmt: skip

OF_TOURNAMENT = [
    ("a tournament of nothing", "", "SCENARIO"),
    ("a tournament of nobody", "sumo", "--players"),
    ("a role that is none", "sumo --role green=players", "green", "red"),
    ("a tournament of no workers", "sumo --players players --workers 0", "workers=0"),
    ("a tick of no time", "sumo --players players --tick-limit 0", "tick", "0"),
    ("a match of NaN seconds", "sumo --players players --match-limit nan", "match", "nan"),
]

OF_PLOT = [
    ("a plot of nothing", "", "RECORD"),
    ("a plot of an experiment", "random_walk", "random_walk", "run it first"),
    ("snapshots after the end", "run.npz snapshots --at 99", "99"),
    ("a column that is none", "run.npz signals --columns sped", "sped", "speed"),
    ("signals of nobody", "run.npz signals --robots robt0", "robt0", "holonomic"),
    ("signals from after their end", "run.npz signals --from 1 --to 0.5", "1", "0.5"),
    ("a plot as a film", "run.npz --figure a.gif", "a.gif", ".png"),
]


def _of(verb: str, rows: list[tuple[str, ...]], **files) -> list[Case]:
    """Return commands of one verb from what follows it."""
    return [typed(name, f"mars2d {verb} {rest}", *words, **files) for name, rest, *words in rows]


CASES = [
    *(typed(*row) for row in (*ANYWHERE, *OF_RUN, *OF_OTHERS)),
    *_of("sweep", OF_SWEEP),
    *_of("tournament", OF_TOURNAMENT),
    *_of("plot", OF_PLOT, run__npz=lambda: saved("run.npz")),
]
