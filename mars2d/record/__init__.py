"""What happened in a run, as data."""

from mars2d.record.contact import CONTACT, episodes
from mars2d.record.message import MESSAGE, STATUS
from mars2d.record.rows import Rows

__all__ = ["CONTACT", "MESSAGE", "STATUS", "Rows", "episodes"]
