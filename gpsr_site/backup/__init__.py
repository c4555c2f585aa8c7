"""A whole installation as one file, and back: all rows in a form that suits every database, and all files."""
