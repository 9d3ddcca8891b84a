"""Between: pushes straight out of the corner, between the two."""


def control(_):
    return 100, 100
