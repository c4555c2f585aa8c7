"""Training runs: how they are requested, claimed and carried out, and where their files are."""
