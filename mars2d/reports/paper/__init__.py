"""The figures of the MARS paper, regenerated, each beside the paper's report and theory."""
