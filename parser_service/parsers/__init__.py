"""Parsers as the rest of the code sees them, and those that need no torch."""
