"""Texts that people try on runs: one asks, a worker answers."""
