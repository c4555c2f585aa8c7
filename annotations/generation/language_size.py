"""How many commands the templates of a world make, without making them, and those of a sample."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence

from annotations import models
from annotations.background.job_weight import MOST_COMMANDS
from annotations.language.templates import (
    BoundedCache,
    Generated,
    Language,
    SampleNote,
    SampleRequest,
    TaskCategory,
    generate,
)
from annotations.language.texts import LanguageError
from annotations.rows.from_rows import task_categories

# The content of task categories → the number of derivations.
_SIZES: BoundedCache[Hashable, int] = BoundedCache(100)


def language_size(world: models.World) -> int:
    """Return the number of derivations of the templates of ``world``, an upper bound on its distinct commands.

    Raises:
        LanguageError: a row cannot be read, or a grammar has a cycle.
    """
    categories = task_categories(world)
    content = tuple(
        (
            each.name,
            each.grammar.productions,
            tuple((template.pattern_text, template.form_text) for template in each.templates),
        )
        for each in categories
    )
    return _SIZES.get(content, lambda: Language(categories).size)


def is_large(world: models.World) -> bool:
    """Return whether the templates of ``world`` make too many commands for a request. A sample of them costs as much as
    all of few: what is drawn from is counted first, and what is drawn is compared with what is stored."""
    try:
        return language_size(world) > MOST_COMMANDS
    except LanguageError:
        return False


def make_commands(
    categories: Sequence[TaskCategory],
    request: SampleRequest,
    limit: int | None,
    report: Callable[[float], None] = lambda share: None,
) -> tuple[Generated, SampleNote | None]:
    """Return the commands of a request, and what to remember of them where they are a sample.

    Raises:
        LanguageError: as ``generate``, or ``Language.sample``.
    """
    if not request.size:
        return generate(categories, limit), None
    sample = Language(categories).sample(request, report)
    return sample.generated, sample.note
