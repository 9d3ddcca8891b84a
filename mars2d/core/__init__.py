"""The lowest room: everything that knows no robot."""
