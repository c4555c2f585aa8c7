"""What a language model is told and asked: the task, what the protocol allows it to know, and examples."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from annotations.language.predicates import Predicate, gloss, print_signatures
from parser_service.parsers.llm.protocol import Message
from parser_service.parsers.written_forms import read_or_none

UNKNOWN = "UNKNOWN"
FORM = "form"  # the name under which a listed form is answered
MOST_PREDICATES = 200  # declared ones that are told; those of the forms at hand come first
MOST_TEXT = 2000  # characters of an answer that is no form
NAME = re.compile(r"[A-Za-z_][\w-]*")
FENCE = "```"

TASK = (
    "You translate what a person says to a service robot into its logical form. A logical form is written "
    "with spaces between all signs, as the examples show; variables are $1, $2 and so on. Words in angle "
    f"brackets such as <object> stand for a thing of that class. Answer {UNKNOWN} where no form fits."
)
LISTED = (
    f'Answer with a JSON object such as {{"{FORM}": "…"}} and nothing else. The form has to be one of these, '
    "character by character:"
)
WRITTEN = "Answer with the logical form and nothing else."


def schema_of(forms: Sequence[str]) -> dict[str, Any]:
    """Return the JSON schema of an answer that is one of ``forms`` or UNKNOWN."""
    choices = list(dict.fromkeys([*forms, UNKNOWN]))
    return {
        "type": "object",
        "properties": {FORM: {"type": "string", "enum": choices}},
        "required": [FORM],
        "additionalProperties": False,
    }


def messages_for(
    utterance: str,
    examples: Sequence[tuple[str, str]],
    forms: Sequence[str] | None,
    predicates: Mapping[str, Predicate] | None,
) -> tuple[Message, ...]:
    """Return the conversation: the task, the ``examples`` (utterance, form) as turns, and the utterance.

    Args:
        forms: those to choose from; None where the model writes one.
        predicates: what the protocol lets it know of them; None under *strict*.
    """
    shown = forms if forms is not None else [form for _, form in examples]
    told = [TASK, *_declarations(predicates, shown)]
    told += [LISTED, *_choices(forms, predicates)] if forms is not None else [WRITTEN]
    turns = [{"role": "system", "content": "\n".join(told)}]
    for said, form in examples:
        turns.append({"role": "user", "content": said})
        answer = form if forms is None else json.dumps({FORM: form}, ensure_ascii=False)
        turns.append({"role": "assistant", "content": answer})
    return (*turns, {"role": "user", "content": utterance})


def form_in(text: str) -> str:
    """Return what a model means by ``text``: the form in its JSON object, or the text without a fence."""
    bare = text.strip()
    opening, line_break, inside = bare.partition("\n")
    if opening.startswith(FENCE) and line_break and inside.endswith(FENCE):
        bare = inside.removesuffix(FENCE).strip()
    try:
        value = json.loads(bare)
    except (ValueError, RecursionError):
        return bare[:MOST_TEXT]
    form = value.get(FORM) if isinstance(value, dict) else value
    return (form if isinstance(form, str) else bare).strip()[:MOST_TEXT]


def _declarations(
    predicates: Mapping[str, Predicate] | None, forms: Iterable[str]
) -> Iterator[str]:
    """Yield what the declared predicates take and mean, those of ``forms`` first."""
    if not predicates:
        return
    used = {name for form in forms for name in NAME.findall(form)}
    ordered = sorted(predicates.values(), key=lambda each: (each.name not in used, each.name))
    yield "Predicates, what they take, and what they say:"
    for predicate in ordered[:MOST_PREDICATES]:
        takes = " or ".join(print_signatures(predicate.signatures).split("\n"))
        yield f"{predicate.name} {takes}{predicate.gloss and f': {predicate.gloss}'}"


def _choices(forms: Sequence[str], predicates: Mapping[str, Predicate] | None) -> Iterator[str]:
    """Yield the forms, each with its English sentence where predicates are known."""
    for text in forms:
        form = read_or_none(text)
        meaning = "" if predicates is None or form is None else gloss(form, predicates)
        yield f"{text}{meaning and f'  means: {meaning}'}"
    yield UNKNOWN
