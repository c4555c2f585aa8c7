"""A grounded prompt → the generated command behind it, and its form with class tokens."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from annotations.language.forms import Application, Constant, Form, Lambda, canonical_text
from annotations.language.grounding import Anonymizer
from annotations.language.ontology import Ontology
from annotations.models import Command, World
from annotations.rows.from_rows import ontology_of

# What ``{category?}`` says; it is the name of no entity, so no anonymizer finds it.
ANY_CATEGORY, CATEGORY_TOKEN = "objects", "<category>"
_ANY_CATEGORY = re.compile(rf"\b{ANY_CATEGORY}\b")


@dataclass(frozen=True, slots=True)
class Source:
    """Where a paraphrase comes from. ``command`` is None where no generated command is known."""

    command: Command | None
    anonymized_text: str
    logical_form: str

    @property
    def task_category(self) -> str:
        return self.command.task_category if self.command else ""


class SourceFinder:
    """Finds the sources of prompts in one world, or in none. Two queries, however many prompts."""

    def __init__(self, world: World | None) -> None:
        self._anonymizer = Anonymizer(ontology_of(world) if world else Ontology(()))
        commands = world.commands.all() if world else ()
        self._commands = {row.anonymized_text: row for row in commands}

    def command(self, anonymized_text: str) -> Command | None:
        """Return the generated command of this very text."""
        return self._commands.get(anonymized_text)

    def source(self, prompt: str, grounded_form: Form) -> Source:
        """Return the source of a prompt with its grounded form.

        The form is what the record says with class tokens for the values of the prompt, whatever
        the generated command's own form: labels are shown, not repaired, on import.
        """
        anonymized = self._anonymizer.anonymize(prompt)
        tokens = {span.value: span.token for span in anonymized.spans}
        text = anonymized.command
        if text not in self._commands:
            obfuscated = _ANY_CATEGORY.sub(CATEGORY_TOKEN, text)
            text = obfuscated if obfuscated in self._commands else text
        form = _with_tokens(grounded_form, {ANY_CATEGORY: CATEGORY_TOKEN, **tokens})
        return Source(self._commands.get(text), text, canonical_text(form))


def _with_tokens(form: Form, tokens: Mapping[str, str]) -> Form:
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(_with_tokens(each, tokens) for each in form.bodies))
    if isinstance(form, Application):
        arguments = tuple(_with_tokens(each, tokens) for each in form.arguments)
        return replace(form, arguments=arguments)
    if isinstance(form, Constant) and isinstance(form.value, str):
        return Constant(tokens.get(form.value, form.value))
    return form
