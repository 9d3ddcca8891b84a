"""The layers of a picture of an instant, the same for all painters."""
