"""The run window: watch an experiment, go back in it, intervene in it, play in it."""
