"""Laws that cheat: each loses its own match, and nobody else loses anything."""

from __future__ import annotations

import platform

import numpy as np
import pytest

from mars2d import Robot, Scenario, load_law
from mars2d.scenario.experiment import Experiment
from mars2d.tournaments.isolation import Limits, run_isolated
from mars2d.tournaments.isolation.jail import is_protected
from mars2d.world.loop import simulate
from tests.cases import each_case

LIMITS = Limits(tick=2.0, memory=200, output=0.1)

HONEST = """
def control(robot):
    x, y = robot.neighbours[0].position - robot.position
    return 0.3, x * y + robot.rng.normal()
"""

BEGINNING = """
import ctypes, fcntl, gc, json, mmap, os, resource, signal, socket, subprocess, sys, threading
import time
from pathlib import Path
rival = Path(__file__).parent.parent / "rivals" / "honest.py"
parent, others = os.getppid(), [os.getpid() + k for k in (-1, 1, 2, -2)]
libc = ctypes.CDLL(None, use_errno=True)

def call(*arguments):
    if libc.syscall(*arguments) < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))

def control(robot):
    if robot.time > 0.45:
        cheat()
    return 0, 0

def cheat():
"""

NOT_PERMITTED = "raised PermissionError: [Errno 1] Operation not permitted"
DENIED = "raised PermissionError: [Errno 13] Permission denied"

CHEATS = {
    "kills the opponent": ("error", NOT_PERMITTED, "for each in others: os.kill(each, 9)"),
    "stops the opponent": ("error", NOT_PERMITTED, "os.kill(others[1], signal.SIGSTOP)"),
    "crashes the opponent": ("error", NOT_PERMITTED, "os.kill(others[0], signal.SIGSEGV)"),
    "stops the match": ("error", NOT_PERMITTED, "os.kill(parent, signal.SIGSTOP)"),
    "signals by a thread's number": ("error", NOT_PERMITTED, "call(200, parent, 9)"),
    "signals by a file of processes": ("error", NOT_PERMITTED, "os.pidfd_open(parent)"),
    "signals by a pipe's owner": ("error", NOT_PERMITTED, """
        fcntl.fcntl(os.pipe()[0], fcntl.F_SETOWN, parent)"""),
    "writes the match's memory as a file": ("error", DENIED, """
        open(f"/proc/{parent}/mem", "r+b")"""),
    "writes the match's memory": ("error", NOT_PERMITTED, "call(311, parent, 0, 0, 0, 0, 0)"),
    "reads the match's memory": ("error", NOT_PERMITTED, "call(310, parent, 0, 0, 0, 0, 0)"),
    "traces the opponent": ("error", NOT_PERMITTED, "call(101, 16, others[0], 0, 0)"),
    "swaps the opponent's file": ("error", DENIED, 'rival.write_text("")'),
    "removes the opponent's file": ("error", DENIED, "rival.unlink()"),
    "locks the opponent's file": ("error", NOT_PERMITTED, "rival.chmod(0)"),
    "reads the opponent's file": ("error", DENIED, "rival.read_text()"),
    "lists the opponent's folder": ("error", DENIED, "os.listdir(rival.parent)"),
    "changes its own file": ("error", DENIED, 'Path(__file__).write_text("")'),
    "writes a file": ("error", DENIED, 'Path("/tmp/mars2d-cheat").write_text("")'),
    "kills itself": ("exit", "ended by the signal SIGKILL", "os.kill(os.getpid(), 9)"),
    "stops itself": ("slow", "no command after 2 s", "os.kill(os.getpid(), signal.SIGSTOP)"),
    "a fork bomb": ("error", NOT_PERMITTED, "while True: os.fork()"),
    "forks in C": ("error", NOT_PERMITTED, "call(57)"),
    "starts a program": ("error", NOT_PERMITTED, 'subprocess.run(["true"])'),
    "becomes a program": ("error", NOT_PERMITTED, 'os.execv("/bin/true", ["true"])'),
    "a memory bomb": ("memory", "took too much memory; it may take 200 MB", """
        kept = []
        while True: kept.append("x" * 10_000_000 + str(len(kept)))"""),
    "shares memory": ("error", NOT_PERMITTED, "mmap.mmap(-1, 10**10)"),
    "keeps memory in a file": ("error", NOT_PERMITTED, 'os.memfd_create("x")'),
    "lifts its limits": ("error", "not allowed to raise maximum limit", """
        resource.setrlimit(resource.RLIMIT_DATA, (-1, -1))"""),
    "a flood of prints": ("output", "printed more than 100000 bytes", """
        while True: print("Hello, world! " * 10)"""),
    "a flood in C": ("output", "printed more than 100000 bytes", """
        try:
            while True: os.write(1, b"x" * 1000)
        except OSError: pass"""),
    "an endless loop": ("slow", "no command after 2 s", "while True: pass"),
    "a loop with all exceptions caught": ("slow", "no command after 2 s", """
        while True:
            try: time.sleep(0.01)
            except BaseException: pass"""),
    "sleeps": ("slow", "no command after 2 s", "time.sleep(1000)"),
    "says rubbish": ("exit", "what it says to the match is no answer", """
        for each in range(3, 99):
            try: os.write(each, b"rubbish" * 100 + bytes([10]))
            except OSError: pass"""),
    "says too much": ("exit", "what it says to the match is no answer", """
        for each in range(3, 99):
            try:
                while True: os.write(each, b"[" * 10_000)
            except OSError: pass"""),
    "forges an answer": ("exit", "what it says to the match is no answer", """
        json.dumps = lambda told: '{"commands": [[NaN, 1e999]], "letters": []}'"""),
    "forges a message": ("exit", "what it says to the match is no answer", """
        json.dumps = lambda told: '{"commands": [[0.0, 0.0]], "letters": [[0, "1", [9]]]}'"""),
    "nests an answer": ("exit", "what it says to the match is no answer", """
        json.dumps = lambda told: "[" * 100_000"""),
    "blames by a kind of fault": ("exit", "what it says to the match is no answer", """
        json.dumps = lambda told: '{"kind": "fine", "where": null, "text": ""}'"""),
    "closes all files": ("exit", "has closed the connection to the match", """
        os.closerange(0, 1000)"""),
    "leaves": ("error", "SystemExit", "sys.exit()"),
    "is interrupted": ("error", "KeyboardInterrupt", "raise KeyboardInterrupt"),
    "exits": ("exit", "has ended itself, with code 0", "os._exit(0)"),
    "a null pointer": ("exit", "by the signal SIGSEGV, a segmentation fault", """
        ctypes.string_at(0)"""),
    "the network": ("error", NOT_PERMITTED, 'socket.create_connection(("127.0.0.1", 80))'),
    "gives itself a priority": ("error", "raised PermissionError", """
        os.setpriority(os.PRIO_PROCESS, 0, -20)"""),
    "slows the opponent": ("error", "raised PermissionError", """
        os.sched_setaffinity(others[0], {0})"""),
    "calls of another kind": ("error", NOT_PERMITTED, "call(0x40000000 + 62, parent, 9)"),
    "bad pickles": ("exit", "no answer", """
        json.dumps = lambda told: "cos" + chr(10) + "system" + chr(10)"""),
    "threads that go on": (None, "", """
        if threading.active_count() < 3:
            threading.Thread(target=lambda: sum(0 for _ in iter(int, 1)), daemon=True).start()"""),
    "doctors what it sees": (None, "", """
        for each in gc.get_objects():
            if type(each).__name__ == "MirrorWorld": each.iteration, each.pose = 99, None
        sys.modules.pop("json", None)"""),
    "another clock and other limits": (None, "", """
        time.perf_counter = time.monotonic = lambda: 0.0
        signal.signal(signal.SIGABRT, signal.SIG_IGN)"""),
}  # fmt: skip
"""What each does in a control step: the verdict on it, or None if it harms nobody, and the text."""

needs_wall = pytest.mark.skipif(
    not is_protected() or platform.machine() != "x86_64",
    reason="this system protects nobody, or has other numbers of system calls",
)


@pytest.fixture
def match(tmp_path):
    """Return what plays a cheat against an honest law, each in a folder of its own."""

    def play(text: str):
        lines = [line.removeprefix("        ") for line in text.strip("\n").splitlines()]
        body = "".join(f"    {line.strip() if len(lines) == 1 else line}\n" for line in lines)
        files = {"cheats": BEGINNING + body, "rivals": HONEST}
        for folder, content in files.items():
            (tmp_path / folder).mkdir(exist_ok=True)
            name = "cheat.py" if folder == "cheats" else "honest.py"
            (tmp_path / folder / name).write_text(content, encoding="utf-8")
        cheat, honest = tmp_path / "cheats/cheat.py", tmp_path / "rivals/honest.py"
        robot = Robot(sees="positions")
        scenario = Scenario(robots=[robot.at(-2, 0), robot.at(2, 0)], stop_time=1.5)
        roles = {"cheat": (cheat, [0]), "honest": (honest, [1])}
        record, verdicts, _ = run_isolated(Experiment(scenario, seed=1), roles, LIMITS)
        laws = [lambda robot: (0.0, 0.0), load_law(honest)]
        robots = [r.replace(controller=c) for r, c in zip(scenario.robots, laws, strict=True)]
        alone = simulate(Experiment(scenario.replace(robots=robots), seed=1)).record
        assert honest.read_text() == HONEST
        return verdicts, record, alone

    return play


@pytest.mark.slow
@needs_wall
@each_case("name", CHEATS)
def test_a_cheat_loses_its_own_match_and_harms_nobody(name, match) -> None:
    kind, words, text = CHEATS[name]
    verdicts, record, alone = match(text)
    if kind is None:
        assert verdicts == {}
        assert record.digest == alone.digest
        return
    assert [*verdicts] == ["cheat"], verdicts
    assert (verdicts["cheat"].kind, verdicts["cheat"].time) == (kind, 0.5), verdicts
    assert verdicts["cheat"].text.startswith("cheat.py")
    assert words in verdicts["cheat"].text
    assert len(record) >= 5
    assert np.array_equal(record.pose, alone.pose[: len(record)])
