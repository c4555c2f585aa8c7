"""Say a logical form as one English sentence, with the patterns of its predicates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TypeGuard

from annotations.language.english import NUMBERS, plural
from annotations.language.forms import (
    CONJUNCTION,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Unknown,
    Variable,
    to_reading,
)
from annotations.language.predicates.gloss_patterns import (
    GlossAlternative,
    PatternSlot,
    read_pattern,
)
from annotations.language.predicates.signatures import ArgumentKind, argument_kind
from annotations.language.symbols import EntityClasses, Wildcard

NOT_UNDERSTOOD = "a command that the robot does not understand"


@dataclass(frozen=True, slots=True)
class _Scope:
    """How to say predicates and classes, the conjuncts that hold here, the variables that are being described."""

    patterns: Mapping[str, str]
    actions: frozenset[str]
    classes: EntityClasses
    conjuncts: tuple[Application, ...] = ()
    said: frozenset[int] = frozenset()

    def about(self, variable: int) -> tuple[Application, ...]:
        """Return the conjuncts that describe a variable, except by things already being described."""
        if variable in self.said:
            return ()
        described = {Variable(index) for index in self.said}
        return tuple(
            each
            for each in self.conjuncts
            if each.arguments[:1] == (Variable(variable),)
            and described.isdisjoint(each.arguments[1:])
        )

    def describes(self, form: Form) -> TypeGuard[Application]:
        """Return whether a form describes a variable, rather than says what to do with it."""
        return (
            isinstance(form, Application)
            and str(form.predicate) not in self.actions
            and isinstance(next(iter(form.arguments), None), Variable)
        )


@dataclass(slots=True)
class _NounPhrase:
    """The adjectives, the noun and what follows it, while they are collected."""

    noun: str = ""
    before: list[str] = field(default_factory=list)
    after: list[str] = field(default_factory=list)
    is_plural: bool = False
    is_person: bool = False

    def words(self, is_plural: bool) -> str:
        is_plural = is_plural or self.is_plural
        noun = self.noun or ("one" if self.is_person else "object")
        is_person = noun.endswith("person") or (not self.noun and self.is_person)
        noun = plural(noun) if is_plural else noun
        # Fit clauses like ``that is at …`` to people and to plurals; join a second one with "and".
        verb = "are" if is_plural else "is"
        pronoun = "who" if is_person else "that"
        joined: list[str] = []
        has_clause = False
        for clause in self.after:
            if clause.startswith("that is "):
                rest = clause.removeprefix("that is ")
                clause = f"and {rest}" if has_clause else f"{pronoun} {verb} {rest}"
                has_clause = True
            joined.append(clause)
        return " ".join([*self.before, noun, *joined])


def sentence(
    form: Form, patterns: Mapping[str, str], actions: frozenset[str], classes: EntityClasses
) -> str:
    """Return the gloss of a form, from the pattern of each predicate (see ``gloss_patterns``).

    ``actions`` names the predicates that are actions; the others describe. ``classes`` say how class
    tokens are called.
    """
    if isinstance(form, Unknown):
        return NOT_UNDERSTOOD
    scope = _Scope(patterns, actions, classes)
    if isinstance(form, Lambda):
        bodies, scope = _open(form, scope)
        to_do = [body for body in bodies if not scope.describes(body)]
        if to_do:
            return ", then ".join(_action(body, scope, False) for body in to_do)
        return _describe(form.variable, scope)
    return _action(form, scope, False) if isinstance(form, Application) else _phrase(form, scope)


def _open(form: Lambda, scope: _Scope) -> tuple[tuple[Form, ...], _Scope]:
    """Return the bodies below a chain of λs, with explicit conjunctions split, and their scope."""
    bodies: list[Form] = []
    waiting = list(form.bodies)
    while waiting:
        body = waiting.pop(0)
        if isinstance(body, Lambda):
            waiting = [*body.bodies, *waiting]
        elif isinstance(body, Application) and body.predicate == CONJUNCTION:
            waiting = [*body.arguments, *waiting]
        else:
            bodies.append(body)
    conjuncts = tuple(body for body in bodies if isinstance(body, Application))
    return tuple(bodies), replace(scope, conjuncts=scope.conjuncts + conjuncts)


def _action(form: Form, scope: _Scope, is_nested: bool) -> str:
    if not isinstance(form, Application):
        return _phrase(form, scope)
    if about := tuple(each for each in form.arguments if scope.describes(each)):
        # ``(follow (person $1) (at $1 …))`` becomes ``(follow $1)``; the descriptions go into the scope.
        others = tuple(each for each in form.arguments if each not in about)
        form = replace(form, arguments=(about[0].arguments[0], *others))
        scope = replace(scope, conjuncts=about)
    chosen = _choose(form, scope.patterns, is_nested)
    return _fill(chosen, form.arguments, scope)


def _choose(form: Application, patterns: Mapping[str, str], is_nested: bool) -> GlossAlternative:
    """Return the alternative that fits the arguments best."""
    pattern = patterns.get(str(form.predicate)) or str(form.predicate).replace("_", " ")
    alternatives = read_pattern(pattern)
    fitting = [
        each for each in alternatives if all(_fits(slot, form.arguments) for slot in each.slots)
    ]

    def merit(alternative: GlossAlternative) -> tuple[bool, int, int]:
        slots = alternative.slots
        specific = sum(bool(slot.value or slot.kind not in ("", "plural")) for slot in slots)
        return alternative.is_nested == is_nested, len(slots), specific

    return max(fitting or alternatives[:1], key=merit)


def _fits(slot: PatternSlot, arguments: tuple[Form, ...]) -> bool:
    if slot.place is None:
        return True
    if slot.place >= len(arguments):
        return False
    argument = arguments[slot.place]
    if slot.value:
        is_unknown = isinstance(argument, Unknown) and slot.value == "UNKNOWN"
        return is_unknown or argument == Constant(slot.value)
    return slot.kind in ("", "plural", argument_kind(argument))


def _fill(alternative: GlossAlternative, arguments: tuple[Form, ...], scope: _Scope) -> str:
    """Return the text of an alternative with its slots filled."""
    texts = (
        piece if isinstance(piece, str) else _slot(piece, arguments, scope)
        for piece in alternative.pieces
    )
    return " ".join("".join(texts).split())


def _slot(slot: PatternSlot, arguments: tuple[Form, ...], scope: _Scope) -> str:
    if slot.place is None:
        return ", then ".join(_phrase(each, scope) for each in arguments)
    if slot.value or slot.place >= len(arguments):
        return ""
    argument = arguments[slot.place]
    if slot.kind in (ArgumentKind.TEXT, "name"):
        return _bare(argument, scope)
    return _phrase(argument, scope, slot.kind == "plural")


def _phrase(form: Form, scope: _Scope, is_plural: bool = False) -> str:
    """Say an argument: ``the object that is at the location``, ``three``, ``something``."""
    if isinstance(form, Lambda):
        _, inner = _open(form, replace(scope, conjuncts=()))
        return _describe(form.variable, inner, is_plural)
    if isinstance(form, Application):
        return _action(form, scope, True)
    if isinstance(form, Variable):
        return _describe(form.index, scope) if scope.about(form.index) else "them"
    if isinstance(form, Unknown):
        return "something"
    if isinstance(form, Reference):
        return form.word
    said = _bare(form, scope)
    return said if argument_kind(form) == ArgumentKind.NUMBER else f"the {said}"


def _bare(form: Form, scope: _Scope) -> str:
    """Say a constant or a slot without an article."""
    if isinstance(form, Constant) and isinstance(form.value, int):
        return NUMBERS[form.value] if 0 <= form.value < len(NUMBERS) else str(form.value)
    kind = argument_kind(form)
    if kind == ArgumentKind.TEXT and isinstance(form, Constant):
        return str(form.value)
    if isinstance(form, Constant | Wildcard):
        return scope.classes.noun(kind)
    return to_reading(form)


def _describe(variable: int, scope: _Scope, is_plural: bool = False) -> str:
    """Return the noun phrase for what a λ describes."""
    about = scope.about(variable)
    if not about:
        # Say ``(name $2 $1)`` from the side of ``$1``: the name of what ``$2`` stands for.
        for conjunct in scope.conjuncts:
            if Variable(variable) in conjunct.arguments[1:] and isinstance(
                conjunct.arguments[0], Variable
            ):
                inner = replace(scope, said=scope.said | {variable})
                owner = _describe(conjunct.arguments[0].index, inner)
                return f"the {str(conjunct.predicate).replace('_', ' ')} of {owner}"
        return "something"
    inner = replace(scope, said=scope.said | {variable})
    phrase = _NounPhrase()
    for each in about:
        _add(phrase, each, inner)
    return ("" if is_plural else "the ") + phrase.words(is_plural)


def _add(phrase: _NounPhrase, conjunct: Application, scope: _Scope) -> None:
    """Put one description before the noun, after it or in its place."""
    kinds = [argument_kind(each) for each in conjunct.arguments]
    phrase.is_person |= "gesture" in kinds or "name" in kinds
    phrase.is_plural |= any(
        isinstance(each, Constant) and isinstance(each.value, int) and each.value != 1
        for each in conjunct.arguments
    )
    chosen = _choose(conjunct, scope.patterns, False)
    if chosen.pieces == (PatternSlot(1),) and len(conjunct.arguments) > 1:
        phrase.noun = _bare(conjunct.arguments[1], scope)
        return
    before, underscore, after = _fill(chosen, conjunct.arguments, scope).partition("_")
    if not underscore:
        phrase.noun = before
        return
    phrase.before += [before.strip()] * bool(before.strip())
    phrase.after += [after.strip()] * bool(after.strip())
