"""What comes out of a run: figures and films."""
