"""The panels beside the arena: what is known of a body, plots, sliders, predictions."""
