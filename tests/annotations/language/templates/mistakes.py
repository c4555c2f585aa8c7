"""Mistakes made on purpose in templates, of the kinds that people make."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from annotations.language.forms import canonical_text, read_form
from annotations.language.templates import (
    SemanticTemplate,
    Sides,
    TemplateChecker,
    generate,
    read_generator_folder,
    template_checker,
)
from annotations.language.world import infer_signatures

_HEAD = re.compile(r"\(([a-z_]{3,})")
_SLOT = re.compile(r"\$[A-Za-z_]\w*|\{[^{}]*\}")


def mistakes(template: SemanticTemplate) -> Iterator[tuple[str, Sides]]:
    """Yield each kind of mistake with the two sides that it makes of the template."""
    pattern, form = template.pattern_text, template.form_text
    for at in _indexes(form, ")"):
        yield "a ) left out", Sides(pattern, form[:at] + form[at + 1 :])
    for at in _indexes(form, ")"):
        yield "a ) too many", Sides(pattern, form[:at] + ")" + form[at:])
    for at in _indexes(form, "("):
        yield "a ( left out", Sides(pattern, form[:at] + form[at + 1 :])
    for match in _HEAD.finditer(form):
        name = match[1]
        middle = len(name) // 2
        swapped = name[: middle - 1] + name[middle] + name[middle - 1] + name[middle + 1 :]
        if swapped != name:
            yield "predicate misspelled", _in_form(pattern, form, match.span(1), swapped)
        yield "predicate misspelled", _in_form(pattern, form, match.span(1), name[:-1])
    yield from _of_slots(pattern, form)
    for match in re.finditer(r'"[^"]*"', form):
        yield "a quotation mark left out", _in_form(pattern, form, match.span(), match[0][:-1])
        yield "a quotation mark left out", _in_form(pattern, form, match.span(), match[0][1:])
    for match in re.finditer(r" \$1(?=[ )])", form):
        yield "variable not bound", _in_form(pattern, form, match.span(), " $9")


def _of_slots(pattern: str, form: str) -> Iterator[tuple[str, Sides]]:
    slots = list(dict.fromkeys(_SLOT.findall(form)))
    for match in _SLOT.finditer(form):
        letters = re.search("[a-z]{3,}", match[0])
        if letters:
            at = match.start() + letters.end() - 1
            yield "slot misspelled in the form", Sides(pattern, form[:at] + form[at + 1 :])
        if "$" in match[0]:
            yield "slot without its $", _in_form(pattern, form, match.span(), match[0][1:])
        if match[0].endswith("}"):
            yield "a brace left out", _in_form(pattern, form, match.span(), match[0][:-1])
    for match in _SLOT.finditer(pattern):
        letters = re.search("[a-z]{3,}", match[0])
        if letters:
            at = match.start() + letters.end() - 1
            yield "slot misspelled in the pattern", Sides(pattern[:at] + pattern[at + 1 :], form)
    for match in re.finditer(r" ?\(\w+ \$1 (\$[a-z]\w*|\{[^{}]*\})\)", form):
        rest = form[: match.start()] + form[match.end() :]
        if match[1] not in rest and match[1] in pattern and ":e)" not in rest:
            yield "slot left out of the form", Sides(pattern, rest)
    if len(slots) == 2:
        one, other = slots
        exchanged = _SLOT.sub(lambda m: {one: other, other: one}.get(m[0], m[0]), form)
        yield "slots exchanged", Sides(pattern, exchanged)
    for at in _indexes(pattern, ")"):
        yield "a ) left out of the pattern", Sides(pattern[:at] + pattern[at + 1 :], form)
    for match in re.finditer(r"\b[a-z]{4,}\b(?![^{]*\})(?<!\$)", pattern):
        if pattern[match.start() - 1 : match.start()] not in ("$", "_"):
            word = match[0][:-2] + match[0][-1]
            changed = pattern[: match.start()] + word + pattern[match.end() :]
            yield "word misspelled", Sides(changed, form)


def _in_form(pattern: str, form: str, span: tuple[int, int], text: str) -> Sides:
    return Sides(pattern, form[: span[0]] + text + form[span[1] :])


def _indexes(text: str, character: str) -> list[int]:
    return [index for index, each in enumerate(text) if each == character]


def value_of(template: SemanticTemplate) -> tuple[object, str]:
    return template.pattern, canonical_text(template.form)


def published_checkers(folder: Path) -> Iterator[tuple[TemplateChecker, SemanticTemplate]]:
    """Yield each of a generator's templates with the checker of its first task category.

    The predicates are those of all its forms.
    """
    categories = read_generator_folder(folder).categories()
    forms = [read_form(each.form_text) for each in generate(categories).expansions]
    predicates = infer_signatures(forms)
    seen: dict[SemanticTemplate, TemplateChecker] = {}
    for category in categories:
        checker = template_checker(category.grammar, predicates, category.name)
        for template in category.templates:
            seen.setdefault(template, checker)
    yield from ((checker, template) for template, checker in seen.items())
