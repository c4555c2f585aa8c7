"""A grounded prompt → the generated command behind it, and its form with class tokens."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from annotations.language.forms import Application, Constant, Form, Lambda, canonical_text
from annotations.language.grounding import Anonymizer
from annotations.language.texts import ANY_OBJECT
from annotations.language.world import Ontology
from annotations.models import Command, World
from annotations.rows.from_rows import ontology_of

CATEGORY_TOKEN = "<category>"
_ANY_OBJECT = re.compile(rf"\b{ANY_OBJECT}\b")


@dataclass(frozen=True, slots=True)
class PromptSource:
    """Where a paraphrase comes from. ``command`` is None where no generated command is known."""

    command: Command | None
    anonymized_text: str
    logical_form: str

    @property
    def task_category(self) -> str:
        return self.command.task_category if self.command else ""


class SourceFinder:
    """Finds the sources of prompts in one world, or in none. Two queries, however many prompts.

    ``further`` are generated commands that the world may lack.
    """

    def __init__(self, world: World | None, further: Iterable[str] = ()) -> None:
        self._anonymizer = Anonymizer(ontology_of(world) if world else Ontology(()))
        commands = world.commands.all() if world else ()
        self._commands = {row.anonymized_text: row for row in commands}
        self._texts = {*self._commands, *further}

    def command(self, anonymized_text: str) -> Command | None:
        """Return the generated command of this very text."""
        return self._commands.get(anonymized_text)

    def is_command(self, text: str) -> bool:
        """Return whether ``text`` is a generated command."""
        return text in self._texts

    def text(self, prompt: str) -> str:
        """Return the text of the generated command that ``prompt`` grounds, or else the prompt with class
        tokens, which then is no generated command."""
        return self._text(prompt, self._anonymizer.anonymize(prompt).command)

    def _text(self, prompt: str, anonymized: str) -> str:
        # Some generated commands name entities: these are their own prompts.
        obfuscated = _ANY_OBJECT.sub(CATEGORY_TOKEN, anonymized)
        readings = (anonymized, obfuscated, prompt)
        return next((text for text in readings if text in self._texts), anonymized)

    def source(self, prompt: str, grounded_form: Form) -> PromptSource:
        """Return the source of a prompt with its grounded form.

        The form is what the record says with class tokens for the values of the prompt, whatever
        the generated command's own form: labels are shown, not repaired, on import.
        """
        anonymized = self._anonymizer.anonymize(prompt)
        tokens = {span.value: span.token for span in anonymized.spans}
        text = self._text(prompt, anonymized.command)
        form = _with_tokens(grounded_form, {ANY_OBJECT: CATEGORY_TOKEN, **tokens})
        return PromptSource(self._commands.get(text), text, canonical_text(form))


def _with_tokens(form: Form, tokens: Mapping[str, str]) -> Form:
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(_with_tokens(each, tokens) for each in form.bodies))
    if isinstance(form, Application):
        arguments = tuple(_with_tokens(each, tokens) for each in form.arguments)
        return replace(form, arguments=arguments)
    if isinstance(form, Constant) and isinstance(form.value, str):
        return Constant(tokens.get(form.value, form.value))
    return form
