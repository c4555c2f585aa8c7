"""What a worker does with a run that it has claimed: train its parser, evaluate it, and report meanwhile."""
