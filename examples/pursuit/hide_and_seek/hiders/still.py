"""Still: stays where it is, as small children do, and hopes."""


def control(_):
    return 0.0, 0.0
