"""Where pretrained weights are, and whether all that a configuration needs is there. Torch is not loaded."""
