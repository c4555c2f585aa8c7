"""Which work is too heavy for a request: what takes over about a second on one core.

On one idle core an import reads some 0.5 MB of pairs in a second, and generation makes 4,000 commands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from annotations.importing.uploads import Upload, unpacked_size
from annotations.language.errors import LanguageError
from annotations.language.templates import generation_size, read_generator_files
from annotations.models import World
from annotations.rows.from_rows import task_categories
from annotations.worlds.world_deletion import count_below

MOST_BYTES = 400_000
MOST_COMMANDS = 3_000
MOST_ROWS = 5_000


def is_heavy_generator(files: Mapping[str, bytes]) -> bool:
    """Return whether importing these files takes long: they are large, or their templates make many commands."""
    if sum(map(len, files.values())) > MOST_BYTES:
        return True
    texts = read_generator_files(files)
    if texts.has_errors:
        return False
    try:
        return generation_size(texts.categories()) > MOST_COMMANDS
    except LanguageError:
        return False


def is_heavy_pairs(uploads: Sequence[Upload]) -> bool:
    return unpacked_size(uploads) > MOST_BYTES


def is_heavy_world(size: int) -> bool:
    """Return whether importing an archive of ``size`` bytes, unpacked, takes long."""
    return size > MOST_BYTES


def is_heavy_generation(world: World) -> bool:
    """Return whether the templates of ``world`` make many commands."""
    try:
        return generation_size(task_categories(world)) > MOST_COMMANDS
    except LanguageError:
        return False


def is_heavy_deletion(world: World) -> bool:
    return sum(count_below(world).values()) > MOST_ROWS
