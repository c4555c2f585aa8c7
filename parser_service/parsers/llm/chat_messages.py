"""What a language model is told and asked: the task, what the protocol allows it to know, and examples."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from json import JSONDecoder
from typing import Any, Self

from annotations.language.forms import Form, actions_of, canonical_text, read_or_none
from annotations.language.world import Predicate, gloss, print_signatures
from parser_service.parsers.model_server.protocol import Message
from parser_service.parsers.written_forms import written_actions

UNKNOWN = "UNKNOWN"
# The names under which a listed form is answered, and the listed actions of a composed one.
FORM, ACTIONS = "form", "actions"
MOST_PREDICATES = 200  # declared ones that are told; those of the forms at hand before others
MOST_ACTIONS = 50  # that are read of an answer
MOST_TEXT = 2000  # characters of an answer that is no form
NAME = re.compile(r"[A-Za-z_][\w-]*")
FENCE = "```"

TASK = (
    "You translate what a person says to a service robot into its logical form. A logical form is written "
    "with spaces between all signs, as the examples show; variables are $1, $2 and so on. Words in angle "
    f"brackets such as <object> stand for a thing of that class. Answer {UNKNOWN} where no form fits."
)
COMPOSED = (
    "A command may ask for several actions. They are done in order: ( sequence … … ). In a later action, it "
    "stands for the thing and them for the person or the things that came last before, which are not described again."
)
LISTED = (
    f'Answer with a JSON object such as {{"{FORM}": "…"}} and nothing else. The form has to be one of these, '
    "character by character:"
)
LISTED_ACTIONS = (
    f'Answer with a JSON object such as {{"{ACTIONS}": ["…", "…"]}} and nothing else: the actions in their order. '
    "Each of them has to be one of these, character by character:"
)
WRITTEN = "Answer with the logical form and nothing else."


@dataclass(frozen=True, slots=True)
class Choices:
    """What a model chooses from: whole ``forms`` or, where a command may ask for several actions, ``actions``, of
    which it may name ``most`` in one answer."""

    texts: tuple[str, ...]
    most: int = 1

    @classmethod
    def among(cls, forms: Iterable[str], most: int) -> Self:
        """Return the choices that ``forms`` leave; ``most`` is the largest number of actions of any form."""
        if most == 1:
            return cls(tuple(dict.fromkeys(forms)))
        return cls(
            tuple(dict.fromkeys(each for form in forms for each in written_actions(form))), most
        )

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON schema of an answer."""
        choice: dict[str, Any] = {
            "type": "string",
            "enum": [*dict.fromkeys([*self.texts, UNKNOWN])],
        }
        name = FORM
        if self.most > 1:
            name = ACTIONS
            choice = {"type": "array", "items": choice, "minItems": 1, "maxItems": self.most}
        return {
            "type": "object",
            "properties": {name: choice},
            "required": [name],
            "additionalProperties": False,
        }

    def answer(self, form: str) -> str:
        """Return the answer that is ``form``, as an example shows it."""
        value = {FORM: form} if self.most == 1 else {ACTIONS: written_actions(form)}
        return json.dumps(value, ensure_ascii=False)


def messages_for(
    utterance: str,
    examples: Sequence[tuple[str, str]],
    choices: Choices | None,
    predicates: Mapping[str, Predicate] | None,
    is_composed: bool = False,
) -> tuple[Message, ...]:
    """Return the conversation: the task, the ``examples`` (utterance, form) as turns, and the utterance.

    Args:
        choices: what to choose from; None where the model writes a form.
        predicates: what the protocol lets it know of them; None under *strict*.
        is_composed: whether a command may ask for several actions.
    """
    shown = choices.texts if choices is not None else [form for _, form in examples]
    told = [TASK, *[COMPOSED] * is_composed, *_declarations(predicates, shown)]
    if choices is None:
        told.append(WRITTEN)
    else:
        told += [LISTED if choices.most == 1 else LISTED_ACTIONS, *_listed(choices, predicates)]
    turns = [{"role": "system", "content": "\n".join(told)}]
    for said, form in examples:
        turns.append({"role": "user", "content": said})
        answer = form if choices is None else choices.answer(form)
        turns.append({"role": "assistant", "content": answer})
    return (*turns, {"role": "user", "content": utterance})


def texts_in(text: str) -> tuple[str, ...]:
    """Return the forms that a model means by ``text``: its actions in order, or the one form."""
    value = _json_in(text)
    actions = value.get(ACTIONS) if isinstance(value, dict) else None
    if isinstance(actions, list) and all(isinstance(each, str) for each in actions):
        return tuple(each.strip()[:MOST_TEXT] for each in actions[:MOST_ACTIONS])
    written = form_in(text)
    form = first_form(written)
    if form is not None:
        return tuple(map(canonical_text, actions_of(form)))
    return (written,) if written else ()


def listed_in(schema: Mapping[str, Any]) -> list[str]:
    """Return the texts that an answer of this schema (``Choices.schema``) is made of."""
    properties = schema["properties"]
    choice = properties[FORM] if FORM in properties else properties[ACTIONS]["items"]
    listed: list[str] = choice["enum"]
    return listed


def first_form(text: str) -> Form | None:
    """Return the form that ``text`` is or, of a model that goes on after its answer, begins with; None where there
    is none."""
    form = read_or_none(text)
    begin, depth = text.find("("), 0
    if form is not None or begin < 0:
        return form
    for place in range(begin, len(text)):
        depth += (text[place] == "(") - (text[place] == ")")
        if not depth:
            return read_or_none(text[begin : place + 1])
    return None


def form_in(text: str) -> str:
    """Return what a model means by ``text``: the form in its JSON object, or the text without a fence."""
    value = _json_in(text)
    form = value.get(FORM) if isinstance(value, dict) else value
    return (form if isinstance(form, str) else _bare(text)).strip()[:MOST_TEXT]


def _json_in(text: str) -> Any:
    """Return the JSON value that ``text`` begins with, also of a model that goes on after its answer; None where it
    begins with none."""
    try:
        return JSONDecoder().raw_decode(_bare(text))[0]
    except (ValueError, RecursionError):
        return None


def _bare(text: str) -> str:
    """Return a text without the fence around it."""
    bare = text.strip()
    opening, line_break, inside = bare.partition("\n")
    if opening.startswith(FENCE) and line_break and inside.endswith(FENCE):
        return inside.removesuffix(FENCE).strip()
    return bare


def _declarations(
    predicates: Mapping[str, Predicate] | None, forms: Iterable[str]
) -> Iterator[str]:
    """Yield what the declared predicates take and mean, those of ``forms`` where there are too many.

    Their order is that of their names: servers need not read again what all questions begin with.
    """
    if not predicates:
        return
    used = {name for form in forms for name in NAME.findall(form)}
    ordered = sorted(predicates.values(), key=lambda each: (each.name not in used, each.name))
    yield "Predicates, what they take, and what they say:"
    for predicate in sorted(ordered[:MOST_PREDICATES], key=lambda each: each.name):
        takes = " or ".join(print_signatures(predicate.signatures).split("\n"))
        yield f"{predicate.name} {takes}{predicate.gloss and f': {predicate.gloss}'}"


def _listed(choices: Choices, predicates: Mapping[str, Predicate] | None) -> Iterator[str]:
    """Yield the choices, each with its English sentence where predicates are known."""
    for text in choices.texts:
        form = read_or_none(text)
        meaning = "" if predicates is None or form is None else gloss(form, predicates)
        yield f"{text}{meaning and f'  means: {meaning}'}"
    yield UNKNOWN
