"""Reports about MARS2D: the figures of the MARS paper, the speed bench, the doctor."""
