"""Verb: report a run, or several runs beside each other, as one HTML file that opens offline.

A report is written as a stream: nothing of it is held for longer than its section. Its figures come from
the functions that the pages take theirs from. See ``docs/guides/reviewers.md``.
"""
