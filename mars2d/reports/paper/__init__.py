"""The figures of the MARS paper, regenerated, each beside what paper and theory say."""
