"""Straight: drives straight on."""


def control(robot):  # noqa: ARG001
    return 0, 0
