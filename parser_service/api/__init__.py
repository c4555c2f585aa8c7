"""The REST routes of what machines learn."""
