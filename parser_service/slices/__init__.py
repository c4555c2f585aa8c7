"""Slices: which predictions a query of a URL chooses, and such queries saved under a name.

A slice is a query of ``PredictionFilters``, as a page's address has it; ``?slice=KEY`` applies a saved one to
every list and comparison of predictions.
"""
