"""The hyperparameters of the parsers that need torch, and how any are declared; nothing here imports torch."""
