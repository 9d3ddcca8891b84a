"""A run that is watched while it goes on: the messages of a log, by Foxglove's websocket."""

from __future__ import annotations

from typing import Any

from mars2d.core.errors import InputError
from mars2d.core.extras import extra
from mars2d.output.formats.mcap.log import newest_row
from mars2d.output.formats.mcap.row import nanoseconds

HOST = "127.0.0.1"
"""It serves this machine alone."""


class Live:
    """Serves the topics of a log to programs on this machine, such as Foxglove.

    >>> with Live(8765) as live:  # doctest: +SKIP
    ...     world = World(scenario, control, watch=live)
    ...     while not world.over:
    ...         world.step()

    It is a watcher: it sends each row when the next control step begins, the last one when it is
    closed. port: 0 takes a free one. Raises InputError if the port is in use, MissingExtraError
    without foxglove-sdk.
    """

    def __init__(self, port: int) -> None:
        with extra("live", "--foxglove needs foxglove-sdk"):
            import foxglove as library
        foxglove: Any = library
        self._library = foxglove
        self._context = foxglove.Context()
        self._channels: dict[str, Any] = {}
        self._stale = True  # the scene is sent again, for programs that have just come
        self._world: Any = None
        self._counts = 0, 0, 0, 0

        class Listener(foxglove.ServerListener):  # type: ignore[misc]
            """Notes that somebody has come; called from a thread of the server."""

            def on_subscribe(_, client: Any, channel: Any) -> None:  # noqa: ARG002, N805
                self._stale = True

        listener: Any = Listener()
        try:
            self._server: Any = foxglove.start_server(
                name="MARS2D", host=HOST, port=port, context=self._context, server_listener=listener
            )
        except (RuntimeError, OverflowError) as error:
            why = f"{error}; name another port, such as 8766"
            raise InputError(f"--foxglove {port}: {why}") from None

    @property
    def port(self) -> int:
        """The port at which it serves."""
        return int(self._server.port)

    @property
    def address(self) -> str:
        """The address to open in Foxglove."""
        return f"ws://{HOST}:{self.port}"

    def __call__(self, world: Any) -> None:
        """Send the row that a `World` has recorded last, if it is a new one."""
        recorder = world.recorder
        if world is not self._world:
            from mars2d.output.formats.mcap.foxglove import Topics

            self._world = world
            self._topics = Topics(recorder.scenario, recorder.sensor_robots)
            self._stale = True
            self._counts = 0, 0, 0, 0
        if recorder.rows == self._counts[0]:
            return
        row = newest_row(world, (recorder.rows - 1, *self._counts[1:]))
        self._counts = recorder.counts
        if self._stale:
            self._stale = False
            self._topics.draw_again()
        for topic, message in self._topics.messages(row, world.scenario):
            if topic not in self._channels:
                self._channels[topic] = self._library.Channel(
                    topic,
                    schema=message.get_schema(),
                    message_encoding="protobuf",
                    context=self._context,
                )
            self._channels[topic].log(message.encode(), log_time=nanoseconds(row.time))

    def close(self) -> None:
        """Send the last row, and end the server."""
        if self._world is not None:
            self(self._world)
            self._world = None
        self._server.stop()

    def __enter__(self) -> Live:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
