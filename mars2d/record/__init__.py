"""What happened in a run, as data."""

from mars2d.record.contact import CONTACT, episodes
from mars2d.record.message import MESSAGE, STATUS
from mars2d.record.record import Record, load

__all__ = ["CONTACT", "MESSAGE", "STATUS", "Record", "episodes", "load"]
