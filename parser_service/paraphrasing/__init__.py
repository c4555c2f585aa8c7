"""A language model as a contributor of campaigns."""
