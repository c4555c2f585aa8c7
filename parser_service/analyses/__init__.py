"""The analyses of a run that are too slow for a page: a worker carries them out, pages read what it found."""
