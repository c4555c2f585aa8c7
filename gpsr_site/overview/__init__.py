"""What the overview of a world and the frame of every page say: counts, steps, work, workers."""
