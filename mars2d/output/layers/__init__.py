"""The layers of a picture: what is drawn of an instant, once for all painters."""
