"""Asking for runs: those of a request, of a learning curve and of a new installation; the same is trained once."""
