"""A whole installation as one file, and back: all rows in a form that no database owns, and all files."""
