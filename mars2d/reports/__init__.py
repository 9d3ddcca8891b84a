"""Reports: the figures of the MARS paper, the speed bench, the doctor."""
