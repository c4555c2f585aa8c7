"""Ask for what a logical form leaves open, in a question that a person would say.

A question is made from the pattern in which the action is said: what is open leaves a gap, and a question word
comes first. ``bring me {1} from {2}`` gives "What shall I bring you from the kitchen?". Where a description is open,
it asks for that: "Where is the tea?". ``english/data/questions.toml`` holds the words, and whole questions where
that makes none that anybody would say.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from annotations.language.forms import (
    CONJUNCTION,
    PERSON,
    PERSON_PREDICATES,
    SEQUENCE,
    Application,
    Constant,
    Form,
    Lambda,
    Unknown,
    Variable,
    children,
    walk,
    with_part,
)
from annotations.language.texts import (
    ACTION_QUESTION_PATTERNS,
    AMONG_WHAT,
    ARGUMENT_NAMES,
    ARGUMENT_QUESTION_WORDS,
    ARTICLES,
    DESCRIPTION_QUESTIONS,
    KNOWN_PATTERNS,
    PREPOSITIONS_LEFT_OUT,
    PREPOSITIONS_OF_WHERE,
    QUESTION_NOUNS,
    QUESTION_WORDS,
    RELATIONS,
    WHOLE_QUESTIONS,
)
from annotations.language.world.gloss_patterns import (
    ALL_IN_ORDER,
    GlossAlternative,
    PatternSlot,
    read_pattern,
)
from annotations.language.world.glossing import (
    NAMING,
    Scope,
    choose,
    gather,
    is_open,
    noun_phrase,
    open_lambda,
    say_slot,
)
from annotations.language.world.signatures import ArgumentKind, argument_kind

QUESTION_WORD = "{}"  # in a whole question
WHAT, WHERE, WHO = "what", "where", "who"
# The classes of entities that a predicate takes at a place.
KindsOf: TypeAlias = "Callable[[str, int], Collection[str]]"
UNKNOWN_VALUE = "UNKNOWN"  # in patterns such as ``bring me something{1=UNKNOWN}``
WHAT_TO_DO = "What shall I do?"
_RELATIVE_CLAUSE = re.compile(
    rf".*_ (?:that is |(?=(?:{'|'.join(sorted(RELATIONS))})\b))(?P<before>.*)"
)
_POSSESSIVE_CLAUSE = re.compile(r"_ whose (?P<what>.*) is ")
_IS, _IT, _ME = (re.compile(rf"\b{word}\b") for word in ("is", "it", "me"))


@dataclass(frozen=True, slots=True)
class _Gap:
    """What is asked for: argument ``place`` of an action, or something that is said of that argument.

    ``descriptions`` are the applications about a variable on the way to it, each with the place of its argument.
    ``variable`` is the one that the argument describes, None where it is no description.
    """

    action: Application
    place: int
    scope: Scope
    descriptions: tuple[tuple[Application, int], ...] = ()
    variable: int | None = None

    @property
    def name(self) -> str:
        return str(self.action.predicate)


def question(
    form: Form, path: Sequence[int], entity_class: str, scope: Scope, kinds_of: KindsOf
) -> str:
    """Return the question for the part of a form at ``path``.

    Args:
        entity_class: that of the entity that is asked for; empty where none is known.
        scope: how to say predicates and classes.
        kinds_of: returns the classes of entities that a predicate takes at a place.
    """
    token = Constant(f"<{entity_class}>") if entity_class else Unknown()
    gap = _gap(with_part(form, path, token), path, replace(scope, is_spoken=True))
    if gap is None:
        return _which_one(entity_class, scope) if entity_class else WHAT_TO_DO
    if asked := _described(gap):
        return _ask_about(*asked, gap, entity_class)
    if not entity_class and len(kinds := kinds_of(gap.name, gap.place)) == 1:
        (entity_class,) = kinds
    return _ask_for_argument(gap, entity_class)


def _gap(form: Form, path: Sequence[int], scope: Scope) -> _Gap | None:
    """Return the gap at ``path``; None where no action takes it."""
    gap: _Gap | None = None
    descriptions: list[tuple[Application, int]] = []
    for place in path:
        if isinstance(form, Lambda):
            _, scope = open_lambda(form, scope)
            scope = replace(scope, conjuncts=tuple(dict.fromkeys(scope.conjuncts)))
            if gap and gap.variable is None and not descriptions:
                gap = replace(gap, variable=form.variable)
        elif isinstance(form, Application) and scope.describes(form):
            descriptions.append((form, place))
        elif isinstance(form, Application) and _is_action(form, scope):
            descriptions = []
            action, about = gather(form, scope)
            scope = replace(scope, conjuncts=scope.conjuncts + about)
            is_about = form.arguments[place] in about
            of_action = place
            if about:  # the variable comes first, and what is no description after it
                before = [each for each in form.arguments[:place] if each not in about]
                of_action = 0 if is_about else 1 + len(before)
            gap = _Gap(
                action, of_action, scope, variable=_variable_of(action) if is_about else None
            )
        form = children(form)[place]
    if gap is None and descriptions:
        gap = _gap_of_variable(_variable_of(descriptions[0][0]), scope)
    if gap is None:
        return None
    return replace(gap, scope=scope, descriptions=tuple(descriptions))


def _gap_of_variable(variable: int, scope: Scope) -> _Gap | None:
    """Return the gap where an action takes a variable that a λ around it describes."""
    for form in (each for conjunct in scope.conjuncts for each in walk(conjunct)):
        if isinstance(form, Application) and _is_action(form, scope):
            for place, argument in enumerate(form.arguments):
                if argument == Variable(variable):
                    return _Gap(form, place, scope, variable=variable)
    return None


def _is_action(form: Application, scope: Scope) -> bool:
    """Whether an application is an action, and no sequence of actions."""
    name = str(form.predicate)
    is_sequence = name in (SEQUENCE, CONJUNCTION) or scope.patterns.get(name) == ALL_IN_ORDER
    return name in scope.actions and not is_sequence


def _variable_of(form: Application) -> int:
    """Return the variable that an application is about."""
    variable = form.arguments[0]
    assert isinstance(variable, Variable)
    return variable.index


def _described(gap: _Gap) -> tuple[Application, int] | None:
    """Return the description to ask about, with the place; None where the argument itself is asked for.

    What something is, or is called, asks for the thing itself: "What shall I bring you?".
    """
    if not gap.descriptions:
        return None
    *outer, (description, place) = gap.descriptions
    if place != 1 or not _says_what_it_is(description, gap.scope):
        return description, place
    variable = _variable_of(description)
    if variable == gap.variable:
        return None
    if outer:
        return outer[-1]
    for other in gap.scope.conjuncts:
        if gap.scope.describes(other) and Variable(variable) in other.arguments[1:]:
            return other, other.arguments.index(Variable(variable))
    return None


def _says_what_it_is(description: Application, scope: Scope) -> bool:
    pattern = scope.patterns.get(str(description.predicate), "")
    is_noun = any(each.pieces == (PatternSlot(1),) for each in read_pattern(pattern))
    return is_noun or description.predicate == NAMING


def _ask_about(description: Application, place: int, gap: _Gap, entity_class: str) -> str:
    """Ask for what is said of something: "Where is the tea?"."""
    scope, name = gap.scope, str(description.predicate)
    variable = _variable_of(description)
    if variable == gap.variable:
        whole = WHOLE_QUESTIONS.get(gap.name, {}).get(f"{gap.place + 1} {name}")
        if whole is not None:
            return _capital(_fold(_say(read_pattern(whole)[0], gap.action, scope)))
    slots = _alternative(gap).slots
    is_plural = variable == gap.variable and any(
        (each.place, each.kind) == (gap.place, "plural") for each in slots
    )
    owner, is_plural = _owner(variable, scope, is_plural)
    is_or_are = "are" if is_plural else "is"
    if own := DESCRIPTION_QUESTIONS.get(name, {}).get(str(place + 1)):
        chosen = choose(description, scope, takes=_is_known(description), pattern=own)
        word = _word(entity_class, scope)
        asked = _fold(_say(chosen, description, scope, owner)).replace(QUESTION_WORD, word)
        return _capital(_IS.sub(is_or_are, asked, count=1) if is_plural else asked)
    chosen = choose(description, scope, takes=_has_slot(place))
    around = _around(chosen, description, place, scope)
    if around is None:
        return _which_one(entity_class, scope)
    before, after = around
    if possessive := _POSSESSIVE_CLAUSE.fullmatch(f"{before} "):
        return f"What is the {possessive['what']} of {owner}?"
    clause = _RELATIVE_CLAUSE.fullmatch(before)
    if clause is None:
        return _which_one(entity_class, scope)
    word, before = _word_before(_word(entity_class, scope), clause["before"], entity_class, scope)
    return _capital(_fold(f"{word} {is_or_are} {owner} {before} {after}")) + "?"


def _ask_for_argument(gap: _Gap, entity_class: str) -> str:
    """Ask for the argument of an action: "Which object in the kitchen shall I bring you?"."""
    whole = WHOLE_QUESTIONS.get(gap.name, {}).get(str(gap.place + 1))
    if whole is not None:
        return _capital(_fold(_say(read_pattern(whole)[0], gap.action, gap.scope)))
    chosen = _alternative(gap)
    around = _around(chosen, gap.action, gap.place, gap.scope)
    if around is None:
        return _which_one(entity_class, gap.scope)
    before, after = around
    word = _word_of_argument(gap, entity_class)
    if gap.variable is not None:
        known = noun_phrase(gap.scope.about(gap.variable), gap.scope)
        if known.has_superlative:
            known.noun, known.after = "one", []
            return AMONG_WHAT.format(known.with_article())
        if not known.is_bare:
            known.noun = known.noun or _noun(entity_class, gap.scope)
            word = f"which {known.words()}"
    word, before = _word_before(word, before, entity_class, gap.scope)
    return _capital(_fold(f"{word} shall I {before} {after}")) + "?"


def _alternative(gap: _Gap) -> GlossAlternative:
    """Return how the action is said with the argument of the gap, and no other as "something", if it can be."""
    is_known = gap.scope.patterns.get(gap.name) == KNOWN_PATTERNS.get(gap.name)
    own = ACTION_QUESTION_PATTERNS.get(gap.name, "") if is_known else ""
    return choose(gap.action, gap.scope, takes=_has_slot(gap.place), pattern=own)


def _has_slot(place: int) -> Callable[[GlossAlternative], bool]:
    def has(alternative: GlossAlternative) -> bool:
        slots = alternative.slots
        says_unknown = any(slot.value == UNKNOWN_VALUE for slot in slots)
        return not says_unknown and any(slot.place == place and not slot.value for slot in slots)

    return has


def _is_known(description: Application) -> Callable[[GlossAlternative], bool]:
    """Accept alternatives that say nothing which is open."""

    def is_known(alternative: GlossAlternative) -> bool:
        places = (slot.place for slot in alternative.slots if slot.place)
        said = (description.arguments[each] for each in places if each < len(description.arguments))
        return not any(map(is_open, said))

    return is_known


def _around(
    alternative: GlossAlternative, form: Application, place: int, scope: Scope
) -> tuple[str, str] | None:
    """Return what is said before and after the argument at ``place``, to whom gives the command; None if that is
    not said."""
    places = [
        piece.place if isinstance(piece, PatternSlot) and not piece.value else None
        for piece in alternative.pieces
    ]
    if place not in places:
        return None
    number = places.index(place)
    before = GlossAlternative(alternative.pieces[:number])
    # "take {1} and put it on {2}": what the question begins with needs no pronoun.
    after = GlossAlternative(
        tuple(
            _IT.sub("", each) if isinstance(each, str) else each
            for each in alternative.pieces[number + 1 :]
        )
    )
    words = _fold(_say(before, form, scope, leaves_out=True)).split()
    if words and words[-1] in ARTICLES:
        words.pop()
    return " ".join(words), _fold(_say(after, form, scope, leaves_out=True))


def _say(
    alternative: GlossAlternative,
    form: Application,
    scope: Scope,
    first: str | None = None,
    leaves_out: bool = False,
) -> str:
    """Return the text of an alternative.

    Args:
        first: how argument 1 is said, if that is known.
        leaves_out: whether an argument of which nothing is known is left out where that is possible.
    """
    said: list[str] = []
    for piece in alternative.pieces:
        if isinstance(piece, str):
            said.append(_ME.sub("you", piece))
        elif piece.value or piece.place is None or piece.place >= len(form.arguments):
            continue
        elif piece.place == 0 and first is not None:
            said.append(first)
        elif _is_nameless(form.arguments[piece.place], scope):
            *others, last = "".join(said[-1:]).split() or [""]
            if leaves_out and last in PREPOSITIONS_LEFT_OUT:
                said[-1:] = [f"{' '.join(others)} "]
            else:
                said.append(_pronoun(form, piece, scope))
        else:
            said.append(say_slot(piece, form.arguments, scope))
    return "".join(said)


def _is_nameless(argument: Form, scope: Scope) -> bool:
    """Whether so much of an argument is open that a pronoun says all that is known of it."""
    about = _about(argument, scope)
    if about is None:
        return isinstance(argument, Constant | Unknown) and is_open(argument)
    said = noun_phrase(about, scope)
    everything = _about(argument, replace(scope, is_spoken=False)) or ()
    is_all_open = not everything or any(map(is_open, everything))
    return said.is_bare and said.noun in ("", PERSON) and is_all_open


def _about(argument: Form, scope: Scope) -> tuple[Application, ...] | None:
    """Return what is said of an argument; None where it is no description."""
    if isinstance(argument, Lambda):
        _, inner = open_lambda(argument, replace(scope, conjuncts=()))
        return inner.about(argument.variable)
    return scope.about(argument.index) if isinstance(argument, Variable) else None


def _pronoun(form: Application, slot: PatternSlot, scope: Scope) -> str:
    assert slot.place is not None
    argument = form.arguments[slot.place]
    about = _about(argument, replace(scope, is_spoken=False)) or ()
    name = _argument_name(str(form.predicate), slot.place)
    is_person = (
        _is_person(about)
        or QUESTION_WORDS.get(argument_kind(argument)) == WHO
        or (not about and ARGUMENT_QUESTION_WORDS.get(name) == WHO)
    )
    return "them" if is_person or slot.kind == "plural" else "it"


def _owner(variable: int, scope: Scope, is_plural: bool) -> tuple[str, bool]:
    """Return how to say what a variable describes, ``the cups in the kitchen`` or ``it``, and if it is plural."""
    phrase = noun_phrase(scope.about(variable), scope)
    phrase.is_plural |= is_plural
    if phrase.is_bare and not phrase.noun:
        if not _is_person(replace(scope, is_spoken=False).about(variable)):
            return ("they" if phrase.is_plural else "it"), phrase.is_plural
        phrase.noun = PERSON
    return phrase.with_article(), phrase.is_plural


def _is_person(about: Sequence[Application]) -> bool:
    return any(each.predicate in PERSON_PREDICATES for each in about)


def _word_of_argument(gap: _Gap, entity_class: str) -> str:
    """Return the question word for the argument of an action."""
    name = _argument_name(gap.name, gap.place)
    of_name = ARGUMENT_QUESTION_WORDS.get(name, WHAT)
    is_of_class = entity_class and name != ArgumentKind.TEXT
    return _word(entity_class, gap.scope) if is_of_class else of_name


def _argument_name(action: str, place: int) -> str:
    """Return what plans call an argument of which nothing is known."""
    names = ARGUMENT_NAMES.get(action, ())[place : place + 1]
    return next((each if isinstance(each, str) else each.get("", "") for each in names), "")


def _word(entity_class: str, scope: Scope) -> str:
    """Return ``what``, ``who``, ``where``, or ``which`` with the noun of a class."""
    return QUESTION_WORDS.get(entity_class) or f"which {_noun(entity_class, scope)}"


def _noun(entity_class: str, scope: Scope) -> str:
    if not entity_class:
        return "thing"
    return QUESTION_NOUNS.get(entity_class) or scope.classes.noun(entity_class)


def _which_one(entity_class: str, scope: Scope) -> str:
    return f"Which {_noun(entity_class, scope)} do you mean?"


def _word_before(word: str, before: str, entity_class: str, scope: Scope) -> tuple[str, str]:
    """Return the question word and what is said before the gap: "where" goes without "to" and needs a preposition."""
    if word != WHERE:
        return word, before
    *others, last = before.split() or [""]
    if last in PREPOSITIONS_OF_WHERE:
        return word, " ".join(others)
    if last in PREPOSITIONS_LEFT_OUT:
        return word, before
    return f"which {_noun(entity_class, scope)}" if entity_class else WHAT, before


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _fold(text: str) -> str:
    return " ".join(text.split()).replace(" ,", ",").replace(" ?", "?")
