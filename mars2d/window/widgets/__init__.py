"""Parts of windows that know nothing of robots: they draw with a painter, and take events."""
