"""Say a logical form as one English sentence, with the patterns of its predicates."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeGuard

from annotations.language.forms import (
    CONJUNCTION,
    NAMING,
    PERSON_CLASS,
    PERSONAL_CLASSES,
    Application,
    Constant,
    EntityClasses,
    Form,
    Lambda,
    Reference,
    Unknown,
    Variable,
    Wildcard,
    to_reading,
    walk,
)
from annotations.language.texts import NUMBERS, RELATIONS, article, definite, looks_plural, plural
from annotations.language.world.gloss_patterns import (
    SUPERLATIVES,
    GlossAlternative,
    PatternSlot,
    read_pattern,
)
from annotations.language.world.signatures import ArgumentKind, argument_kind

_RELATIVE = re.compile(rf"_ that is (?=(?:{'|'.join(sorted(RELATIONS))})\b)")
_A = " a "  # of a pattern, before what may begin with a vowel
NOT_UNDERSTOOD = "a command that the robot does not understand"


@dataclass(frozen=True, slots=True)
class Scope:
    """How to say predicates and classes, the conjuncts that hold here, the variables that are being described.

    ``patterns`` say predicates, ``actions`` names those that are actions, and ``classes`` say class tokens.
    ``named`` gives texts that name entities, with their classes. What is spoken is brief: it leaves out what is
    open, calls people by their names, and says "the tea in the kitchen" for "the tea that is in the kitchen".
    """

    patterns: Mapping[str, str]
    actions: frozenset[str]
    classes: EntityClasses
    conjuncts: tuple[Application, ...] = ()
    said: frozenset[int] = frozenset()
    is_spoken: bool = False
    named: Mapping[str, str] = field(default_factory=dict)

    def kind_of(self, argument: Form) -> str:
        """Return the kind of an argument: the class of the entity that it names, if that is known."""
        named = (
            self.named.get(argument.value)
            if isinstance(argument, Constant) and isinstance(argument.value, str)
            else None
        )
        return named or argument_kind(argument)

    def about(self, variable: int) -> tuple[Application, ...]:
        """Return the conjuncts that describe a variable, except by things already being described."""
        if variable in self.said:
            return ()
        described = {Variable(index) for index in self.said}
        return tuple(
            each
            for each in self.conjuncts
            if each.arguments[:1] == (Variable(variable),)
            and str(each.predicate) not in self.actions
            and described.isdisjoint(each.arguments[1:])
            and not (self.is_spoken and self._leaves_open(each))
        )

    def _leaves_open(self, conjunct: Application) -> bool:
        """Return whether a conjunct has a slot, or a variable that nothing known describes."""
        described = {each.arguments[:1] for each in self.conjuncts if not is_open(each)}
        others = (each for each in conjunct.arguments[1:] if isinstance(each, Variable))
        return is_open(conjunct) or any((each,) not in described for each in others)

    def describes(self, form: Form) -> TypeGuard[Application]:
        """Return whether a form describes a variable, rather than says what to do with it."""
        return (
            isinstance(form, Application)
            and str(form.predicate) not in self.actions
            and isinstance(next(iter(form.arguments), None), Variable)
        )


@dataclass(slots=True)
class NounPhrase:
    """The adjectives, the noun and what follows it, while they are collected. A name comes in place of the noun."""

    noun: str = ""
    before: list[str] = field(default_factory=list)
    after: list[str] = field(default_factory=list)
    is_plural: bool = False
    is_person: bool = False
    name: str = ""
    has_superlative: bool = False

    @property
    def is_bare(self) -> bool:
        """Whether it says no more than a noun."""
        return not (self.before or self.after or self.name)

    def with_article(self, is_plural: bool = False) -> str:
        """Return ``the cups in the kitchen``; "the" only before one, and before no name."""
        return ("" if is_plural or self.name else "the ") + self.words(is_plural)

    def shorten(self) -> None:
        """Leave out what nobody would say in a question: a name or the noun of a thing is enough, else one clause."""
        is_thing = bool(self.noun) and not self.noun.endswith("person")
        self.after = [] if self.name or is_thing else self.after[:1]

    def words(self, is_plural: bool = False) -> str:
        is_plural = is_plural or self.is_plural
        noun = self.name or self.noun or ("one" if self.is_person else "object")
        is_person = bool(self.name) or noun.endswith("person") or (not self.noun and self.is_person)
        if self.has_superlative and not is_plural and looks_plural(noun):
            noun = f"of the {noun}"  # the biggest of the drinks
        noun = plural(noun) if is_plural and not self.name else noun
        # Fit clauses like ``that is at …`` to people and to plurals; join a second one with "and".
        verb = "are" if is_plural or (looks_plural(noun) and not is_person) else "is"
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


def is_open(form: Form) -> bool:
    """Return whether a form has a slot for an entity, or an argument that is UNKNOWN."""
    return any(
        isinstance(each, Unknown) or (isinstance(each, Constant) and bool(each.token_class))
        for each in walk(form)
    )


def sentence(form: Form, scope: Scope) -> str:
    """Return the gloss of a form, from the pattern of each predicate (see ``gloss_patterns``)."""
    if isinstance(form, Unknown):
        return NOT_UNDERSTOOD
    if isinstance(form, Lambda):
        bodies, scope = open_lambda(form, scope)
        to_do = [body for body in bodies if not scope.describes(body)]
        if to_do:
            return ", then ".join(_action(body, scope, False) for body in to_do)
        return _describe(form.variable, scope)
    return _action(form, scope, False) if isinstance(form, Application) else _phrase(form, scope)


def open_lambda(form: Lambda, scope: Scope) -> tuple[tuple[Form, ...], Scope]:
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


def _action(form: Form, scope: Scope, is_nested: bool) -> str:
    if not isinstance(form, Application):
        return _phrase(form, scope)
    form, about = gather(form, scope)
    if about:
        scope = replace(scope, conjuncts=about)
    chosen = choose(form, scope, is_nested)
    return _fill(chosen, form.arguments, scope)


def gather(form: Application, scope: Scope) -> tuple[Application, tuple[Application, ...]]:
    """Return ``(follow $1)`` for ``(follow (person $1) (at $1 …))``, and the descriptions."""
    about = tuple(each for each in form.arguments if scope.describes(each))
    if not about:
        return form, ()
    others = tuple(each for each in form.arguments if each not in about)
    return replace(form, arguments=(about[0].arguments[0], *others)), about


def choose(
    form: Application,
    scope: Scope,
    is_nested: bool = False,
    takes: Callable[[GlossAlternative], bool] = lambda _: True,
    pattern: str = "",
) -> GlossAlternative:
    """Return the alternative that fits the arguments best, of those that ``takes`` accepts if there are any.

    ``pattern`` comes in place of the one of the predicate.
    """
    name = str(form.predicate)
    alternatives = read_pattern(pattern or scope.patterns.get(name) or name.replace("_", " "))
    # "object of the {2:category}" is for a class; an entity says by itself what something is.
    if any(each.pieces == (PatternSlot(1),) for each in alternatives):
        scope = replace(scope, named={})
    alternatives = tuple(filter(takes, alternatives)) or alternatives
    fitting = [
        each
        for each in alternatives
        if all(_fits(slot, form.arguments, scope) for slot in each.slots)
    ]

    def merit(alternative: GlossAlternative) -> tuple[bool, int, int]:
        slots = alternative.slots
        specific = sum(bool(slot.value or slot.kind not in ("", "plural")) for slot in slots)
        return alternative.is_nested == is_nested, len(slots), specific

    return max(fitting or alternatives[:1], key=merit)


def _fits(slot: PatternSlot, arguments: tuple[Form, ...], scope: Scope) -> bool:
    if slot.place is None:
        return True
    if slot.place >= len(arguments):
        return False
    argument = arguments[slot.place]
    if slot.value:
        is_unknown = isinstance(argument, Unknown) and slot.value == "UNKNOWN"
        return is_unknown or argument == Constant(slot.value)
    return slot.kind in ("", "plural", argument_kind(argument), scope.kind_of(argument))


def _fill(alternative: GlossAlternative, arguments: tuple[Form, ...], scope: Scope) -> str:
    """Return the text of an alternative with its slots filled."""
    said = ""
    for piece in alternative.pieces:
        text = piece if isinstance(piece, str) else say_slot(piece, arguments, scope)
        if said.endswith(_A) and text.strip() and not isinstance(piece, str):
            said = f"{said.removesuffix(_A)} {article(text)} "
        said += text
    return " ".join(said.split())


def say_slot(slot: PatternSlot, arguments: tuple[Form, ...], scope: Scope) -> str:
    if slot.place is None:
        return ", then ".join(_phrase(each, scope) for each in arguments)
    if slot.value or slot.place >= len(arguments):
        return ""
    argument = arguments[slot.place]
    if slot.kind in (ArgumentKind.TEXT, PERSON_CLASS):
        return _bare(argument, scope)
    return _phrase(argument, scope, slot.kind == "plural")


def _phrase(form: Form, scope: Scope, is_plural: bool = False) -> str:
    """Say an argument: ``the object that is at the location``, ``three``, ``something``."""
    if isinstance(form, Lambda):
        _, inner = open_lambda(form, replace(scope, conjuncts=()))
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
    is_named = argument_kind(form) == ArgumentKind.TEXT and said[:1].isupper()
    return said if is_named or argument_kind(form) == ArgumentKind.NUMBER else definite(said)


def _bare(form: Form, scope: Scope) -> str:
    """Say a constant or a slot without an article."""
    if isinstance(form, Constant) and isinstance(form.value, int):
        return NUMBERS[form.value] if 0 <= form.value < len(NUMBERS) else str(form.value)
    kind = argument_kind(form)
    if kind == ArgumentKind.TEXT and isinstance(form, Constant):
        return str(form.value)
    if isinstance(form, Constant | Wildcard):
        return scope.classes.noun(kind)
    return to_reading(form)


def _describe(variable: int, scope: Scope, is_plural: bool = False) -> str:
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
    return noun_phrase(about, replace(scope, said=scope.said | {variable})).with_article(is_plural)


def noun_phrase(about: Iterable[Application], scope: Scope) -> NounPhrase:
    """Return what descriptions of one variable say."""
    phrase = NounPhrase()
    for each in about:
        _add(phrase, each, scope)
    if scope.is_spoken:
        phrase.shorten()
    return phrase


def _add(phrase: NounPhrase, conjunct: Application, scope: Scope) -> None:
    """Put one description before the noun, after it or in its place."""
    kinds = [argument_kind(each) for each in conjunct.arguments]
    phrase.has_superlative |= str(conjunct.predicate).endswith(SUPERLATIVES)
    phrase.is_person |= not PERSONAL_CLASSES.isdisjoint(map(scope.kind_of, conjunct.arguments))
    phrase.is_plural |= any(
        isinstance(each, Constant) and isinstance(each.value, int) and each.value != 1
        for each in conjunct.arguments
    )
    chosen = choose(conjunct, scope)
    if chosen.pieces == (PatternSlot(1),) and len(conjunct.arguments) > 1:
        phrase.noun = _bare(conjunct.arguments[1], scope)
        return
    if scope.is_spoken and conjunct.predicate == NAMING and kinds[1:] == [ArgumentKind.TEXT]:
        phrase.name = _bare(conjunct.arguments[1], scope)
        return
    if scope.is_spoken:
        chosen = _without_relative_pronoun(chosen)
    before, underscore, after = _fill(chosen, conjunct.arguments, scope).partition("_")
    if not underscore:
        phrase.noun = before
        return
    phrase.before += [before.strip()] * bool(before.strip())
    phrase.after += [after.strip()] * bool(after.strip())


def _without_relative_pronoun(alternative: GlossAlternative) -> GlossAlternative:
    """Return ``_ in {2}`` for ``_ that is in {2}``."""
    pieces = tuple(
        _RELATIVE.sub("_ ", each) if isinstance(each, str) else each for each in alternative.pieces
    )
    return replace(alternative, pieces=pieces)
