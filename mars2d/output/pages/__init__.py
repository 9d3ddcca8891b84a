"""Pages: the replay in a browser, and what notebooks show."""
