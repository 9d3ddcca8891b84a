"""Outlines from files: drawings, occupancy grids, images, shapes of the world."""
