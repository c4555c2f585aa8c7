"""The forms and commands of an annotated grammar."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from annotations.language.templates import TaskCategory, generate
from parser_service.parsers.candidates.pool import SURE, Made

NAME = "grammar"


def grammar_forms(categories: Sequence[TaskCategory]) -> list[Made]:
    """Return each form that the templates make, with its commands. Raises LanguageError as generation does."""
    commands: defaultdict[str, list[str]] = defaultdict(list)
    first: dict[str, str] = {}
    for each in generate(categories).expansions:
        commands[each.form_text].append(each.command)
        first.setdefault(
            each.form_text, f"template {each.template_index + 1} of {each.task_category}"
        )
    return [
        Made(form, NAME, change=first[form], commands=tuple(said), weight=SURE)
        for form, said in commands.items()
    ]
