"""Which work is too heavy for a request: what takes over about a second on one core.

On one idle core an import reads some 0.5 MB of pairs in a second, and generation makes 4,000 commands.
"""

MOST_BYTES = 400_000  # of an import, unpacked
MOST_COMMANDS = 3_000  # that templates make
MOST_ROWS = 5_000  # that a deletion removes
