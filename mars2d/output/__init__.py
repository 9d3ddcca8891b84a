"""All that leaves a run: files, figures, films, pages and pictures."""
