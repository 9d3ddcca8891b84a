"""The windows that people sit at: the run window and the editor."""
