"""Which work is too heavy for a request: what takes over about a second on one core.

On one idle core an import reads some 0.5 MB of pairs in a second, and generation makes 4,000 commands.
``benchmarks/writes.py`` measures what pages and routes take in a world of about this size.
"""

MOST_BYTES = 400_000  # of an import, unpacked
MOST_COMMANDS = 3_000  # that templates make
MOST_PROMPTS = 500  # that a campaign draws
MOST_EXAMPLES = 2_500  # that a split copies
MOST_ROWS = 5_000  # that a deletion removes
