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
    ("bytes for a message", "robot.send(b'hello')", "content = b'hello'"),
    ("a thing within a message", "robot.send({'to': [1, {2}]})", "content['to'][1]", "{2}"),
    ("a deep message", "a = 1\n    for _ in range(999): a = [a]\n    robot.send(a)",
     "lists and dicts in each other"),
    ("an array of objects for a message", "robot.send(np.array([print]))", "content"),
    ("a message to a misspelt robot", "robot.send(1, to='robt1')", "to='robt1'", "'robot1'"),
    ("a message to oneself", "robot.send(1, to=0)", "to=0", "itself"),
    ("a message to all but one", "robot.send(1, to=[1, 'nobody'])", "nobody"),
    ("an inbox that is set", "robot.inbox = ()", "inbox"),
]  # fmt: skip

CHANNELS = [
    ("a range below 0 of a channel", "range=-1", "Communication.range = -1"),
    ("a loss of text", "loss='half'", "Communication.loss = 'half'", "a number"),
    ("a burst that is a number", "burst=0.2", "Communication.burst = 0.2", "Burst"),
    ("a misspelt channel's field", "los=0.5", "'los'", "'loss'"),
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
