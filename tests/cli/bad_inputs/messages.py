"""Messages that can't be sent, and channels that can't be."""

from __future__ import annotations

from tests.cli.bad_inputs.case import Case, experiment

SENDER = """def law(robot):
    {code}
    return 0, 0
robots = [Robot(controller=law), Robot(pose=(2, 0, 0))]
scenario = Scenario(robots=robots, addons=[{addons}])"""  # it sends in line 9

SENT = [
    ("a function for a message", "robot.send(print)", "content", "built-in"),
    ("an object for a message", "robot.send(object())", "content", "object"),
    ("a set for a message", "robot.send({1, 2})", "content = {1, 2}"),
    ("bytes for a message", "robot.send(b'hello')", "content = b'hello'"),
    ("a complex message", "robot.send(1j)", "content = 1j"),
    ("a robot for a message", "robot.send(robot)", "content"),
    ("a thing within a message", "robot.send({'to': [1, {2}]})", "content['to'][1]", "{2}"),
    ("a number as a key", "robot.send({1: 2})", "key", "1"),
    ("a message that holds itself", "a = []; a.append(a); robot.send(a)", "holds itself"),
    ("a deep message", "a = 1\n    for _ in range(999): a = [a]\n    robot.send(a)",
     "lists and dicts in each other"),
    ("a long message", "robot.send('x' * 70_000)", "bytes", "of at most"),
    ("a message of half a letter", "robot.send('\\ud800')", "content"),
    ("an array of objects for a message", "robot.send(np.array([print]))", "content"),
    ("an array of times for a message", "robot.send(np.array(['2026'], 'M8'))", "content"),
    ("a message to nobody", "robot.send(1, to='nobody')", "to='nobody'", "robot1"),
    ("a message to a misspelt robot", "robot.send(1, to='robt1')", "to='robt1'", "'robot1'"),
    ("a message to a robot too many", "robot.send(1, to=7)", "to=7", "0 to 1"),
    ("a message to a robot below 0", "robot.send(1, to=-1)", "to=-1", "0 to 1"),
    ("a message to oneself", "robot.send(1, to=0)", "to=0", "itself"),
    ("a message to half a robot", "robot.send(1, to=0.5)", "to=0.5"),
    ("a message to a truth", "robot.send(1, to=True)", "to=True"),
    ("a message to all but one", "robot.send(1, to=[1, 'nobody'])", "nobody"),
    ("a message without content", "robot.send()", "content"),
    ("a message with a misspelt word", "robot.send(1, two=1)", "two"),
    ("an inbox that is set", "robot.inbox = ()", "inbox"),
    ("an inbox too short", "robot.inbox[3]", "IndexError"),
]  # fmt: skip

CHANNELS = [
    ("a range below 0 of a channel", "range=-1", "Communication.range = -1"),
    ("a channel's range of NaN", "range=np.nan", "Communication.range = nan"),
    ("a loss of more than all", "loss=1.5", "Communication.loss = 1.5", "<= 1"),
    ("a loss of text", "loss='half'", "Communication.loss = 'half'", "a number"),
    ("a delay below 0", "delay=-0.1", "Communication.delay = -0.1", ">= 0"),
    ("a bandwidth below 0", "bandwidth=-1", "Communication.bandwidth = -1"),
    ("a burst that is a number", "burst=0.2", "Communication.burst = 0.2", "Burst"),
    ("a burst of too much", "burst=Burst(to_bad=2, to_good=0.1)", "Burst.to_bad = 2", "<= 1"),
    ("a burst that never ends", "burst=Burst(to_bad=0.1, to_good=0)", "Burst.to_good = 0"),
    ("a misspelt channel's field", "los=0.5", "'los'", "'loss'"),
    ("a sight that is a word", "line_of_sight='yes'", "line_of_sight = 'yes'", "True or False"),
]


def _sent(name: str, code: str, *words: str, addons: str = "Communication()") -> Case:
    return experiment(name, SENDER.format(code=code, addons=addons), "line", *words)


CASES = [
    *(_sent(*row) for row in SENT),
    _sent("a message without a channel", "robot.send('hello')", "Communication", addons=""),
    _sent("an inbox without a channel", "robot.inbox", "Communication", addons=""),
    *(experiment(name, f"scenario = Scenario(addons=[Communication({code})])", "line 8", *words)
      for name, code, *words in CHANNELS),
]  # fmt: skip
