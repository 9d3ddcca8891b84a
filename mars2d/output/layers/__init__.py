"""The layers of a picture: what is drawn of an instant, the same for all painters."""
