"""Infer predicates from forms, check forms against them, and say forms in English."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import chain

from rapidfuzz.distance import Indel
from rapidfuzz.process import extractOne

from annotations.language.forms import (
    DEFAULT_CLASSES,
    UNKNOWN,
    Application,
    Constant,
    EntityClasses,
    Form,
    Lambda,
    Variable,
    children,
    walk,
)
from annotations.language.texts import MAX_GLOSS, Position, Problem, say_count, warning_at
from annotations.language.world.asking import question
from annotations.language.world.gloss_patterns import (
    ALL_IN_ORDER,
    GlossAlternative,
    PatternSlot,
    default_pattern,
    lengthen,
    read_pattern,
)
from annotations.language.world.glossing import Scope, choose, sentence
from annotations.language.world.signatures import (
    ArgumentKind,
    Signature,
    is_entity_kind,
    signature_of,
)

ALIKE = 0.6  # the least share of common letters with which one name is offered for another


class PredicateKind(StrEnum):
    """An ACTION is something to do; a SEQUENCE does the actions that are its arguments, in their order; a
    DESCRIPTION says something about what a variable stands for."""

    ACTION = "action"
    SEQUENCE = "sequence"
    DESCRIPTION = "description"


@dataclass(frozen=True, slots=True)
class Predicate:
    """A name, its signatures (several if it is overloaded) and its gloss pattern.

    The pattern is explained in ``gloss_patterns``.
    """

    name: str
    kind: PredicateKind
    signatures: tuple[Signature, ...]
    gloss: str = ""

    @property
    def is_action(self) -> bool:
        """Whether it is something to do, alone or in a sequence."""
        return self.kind is not PredicateKind.DESCRIPTION

    @property
    def says_noun(self) -> bool:
        """Whether it says what kind of thing something is: its pattern has its second argument and no word."""
        alternatives = () if self.is_action else read_pattern(self.gloss or _default(self))
        return any(each.pieces == (PatternSlot(1),) for each in alternatives)


def infer_signatures(forms: Iterable[Form]) -> dict[str, Predicate]:
    """Return the predicates that occur in the forms, by name and sorted by it, with default glosses.

    A predicate is an action if it heads a form, if it is inside an action and has no variable as an
    argument itself (``(say (count …))``), or if it is next to such a predicate in a sequence. One that
    always has two or more actions as arguments, and nothing else, is a sequence. All others are
    descriptions.
    """
    signatures: defaultdict[str, set[Signature]] = defaultdict(set)
    arguments: defaultdict[str, list[tuple[Form, ...]]] = defaultdict(list)
    actions: set[str] = set()
    for form in dict.fromkeys(forms):
        actions.update(_actions(form))
        for application in _applications(form):
            signatures[str(application.predicate)].add(signature_of(application))
            arguments[str(application.predicate)].append(application.arguments)

    def kind(name: str) -> PredicateKind:
        if name not in actions:
            return PredicateKind.DESCRIPTION
        is_sequence = all(
            len(given) > 1
            and all(isinstance(each, Application) and each.predicate in actions for each in given)
            for given in arguments[name]
        )
        return PredicateKind.SEQUENCE if is_sequence else PredicateKind.ACTION

    inferred: dict[str, Predicate] = {}
    for name in sorted(signatures):
        predicate = Predicate(name, kind(name), tuple(sorted(signatures[name])))
        pattern = _default(predicate)
        # A pattern too long to store is made again from the name whenever a form is glossed.
        inferred[name] = replace(predicate, gloss=pattern if len(pattern) <= MAX_GLOSS else "")
    return inferred


@dataclass(frozen=True, slots=True)
class Misuse:
    """A predicate used as nothing declares it.

    ``node`` is the number of the term that is wrong, the application or its argument, in the order
    of ``walk``. ``undeclared`` names the predicate if nothing declares it.
    """

    node: int
    message: str
    hint: str
    undeclared: str = ""


def check_form(
    form: Form, predicates: Mapping[str, Predicate], position: Position | None = None
) -> list[Problem]:
    """Return warnings, all at ``position``: unknown predicate, wrong arity, wrong kind of argument."""
    place = position or Position()
    misuses = find_misuses(form, predicates)
    return list(dict.fromkeys(warning_at(place, each.message, each.hint) for each in misuses))


def find_misuses(form: Form, predicates: Mapping[str, Predicate]) -> Iterator[Misuse]:
    """Yield what ``check_form`` warns of; a nonterminal in the place of a predicate is not known yet."""
    for node, term in enumerate(walk(form)):
        if isinstance(term, Application) and isinstance(term.predicate, str):
            misuse = _misuse(node, term, predicates)
            if misuse is not None:
                yield misuse


def gloss(
    form: Form,
    predicates: Mapping[str, Predicate],
    classes: EntityClasses = DEFAULT_CLASSES,
    named: Mapping[str, str] | None = None,
) -> str:
    """Return a short English sentence for a form, the same on every call.

    ``( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )`` is "bring me the object". Predicates that
    are not declared are glossed by their names. ``classes`` say how class tokens are called; ``named`` gives
    the classes of texts that name entities: a thing is in a room, but at a location.
    """
    scope = _scope_of(form, declared_or_inferred(predicates, form), classes)
    return sentence(form, replace(scope, named=named or {}))


def ask_for(
    form: Form,
    path: Sequence[int],
    entity_class: str,
    predicates: Mapping[str, Predicate],
    classes: EntityClasses = DEFAULT_CLASSES,
    named: Mapping[str, str] | None = None,
) -> str:
    """Return the question for the part of a form at ``path``, which leads to it by child numbers.

    ``( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )`` gives "What shall I bring you?". It says what else is
    known, and leaves out what is open too. ``entity_class`` is that of what is asked for, empty for any; ``named``
    gives the classes of texts of the form that name entities.
    """
    declared = declared_or_inferred(predicates, form)

    def kinds_of(name: str, place: int) -> frozenset[str]:
        signatures = (each.arguments for each in declared[name].signatures)
        return frozenset(
            kinds[place] for kinds in signatures if kinds[place:] and is_entity_kind(kinds[place])
        )

    scope = replace(_scope_of(form, declared, classes), named=named or {})
    return question(form, path, entity_class, scope, kinds_of)


def _scope_of(form: Form, declared: Mapping[str, Predicate], classes: EntityClasses) -> Scope:
    uses: defaultdict[str, set[Signature]] = defaultdict(set)
    for application in _applications(form):
        uses[_name_of(application)].add(signature_of(application))
    used = {name: declared[name] for name in uses}
    patterns = {name: _pattern_for(each, uses[name]) for name, each in used.items()}
    actions = frozenset(name for name, each in used.items() if each.is_action)
    return Scope(patterns, actions, classes)


def _pattern_for(predicate: Predicate, uses: Iterable[Signature]) -> str:
    """Return the gloss pattern of a predicate. It says more arguments than are declared too."""
    pattern = predicate.gloss or _default(predicate)
    most = max((len(each.arguments) for each in predicate.signatures), default=0)
    longer = [each for each in uses if len(each.arguments) > most]
    return lengthen(pattern, predicate.is_action, longer) if longer else pattern


def declared_or_inferred(
    predicates: Mapping[str, Predicate], form: Form
) -> Mapping[str, Predicate]:
    """Return the predicates, together with those that the form uses and nothing declares."""
    if all(_name_of(each) in predicates for each in _applications(form)):
        return predicates
    return {**infer_signatures([form]), **predicates}


def _name_of(application: Application) -> str:
    return str(application.predicate)


def _default(predicate: Predicate) -> str:
    if predicate.kind is PredicateKind.SEQUENCE:
        return ALL_IN_ORDER
    return default_pattern(predicate.name, predicate.is_action, predicate.signatures)


def _applications(form: Form) -> Iterator[Application]:
    """Yield the applications with a named predicate; a nonterminal in its place is not known yet."""
    for node in walk(form):
        if isinstance(node, Application) and isinstance(node.predicate, str):
            yield node


def _actions(form: Form) -> Iterator[str]:
    """Yield the predicates of a command that are actions."""
    if isinstance(form, Lambda):
        for body in form.bodies:
            if isinstance(body, Lambda) or not _takes_variable(body):
                yield from _actions(body)
    elif isinstance(form, Application):
        yield str(form.predicate)
        inside = [each for each in form.arguments if isinstance(each, Application)]
        if not all(map(_takes_variable, inside)):
            for each in inside:
                yield from _actions(each)


def _takes_variable(form: Form) -> bool:
    return any(isinstance(argument, Variable) for argument in children(form))


def _misuse(node: int, form: Application, predicates: Mapping[str, Predicate]) -> Misuse | None:
    name = str(form.predicate)
    if name not in predicates:
        close = extractOne(
            name, predicates.keys(), scorer=Indel.normalized_similarity, score_cutoff=ALIKE
        )
        hint = f"did you mean {close[0]}?" if close else "declare it, or use one that is declared"
        return Misuse(node, f"there is no predicate {name}", hint, undeclared=name)
    declared = predicates[name].signatures
    given = signature_of(form)
    choices = " or ".join(f"{name}{each}" for each in declared)
    candidates = [each for each in declared if len(each.arguments) == len(given.arguments)]
    if not candidates:
        message = f"{name} does not take {say_count(len(given.arguments), 'argument')}"
        return Misuse(node, message, f"write {choices}" if choices else "declare a signature")
    places = min((each.mismatches(given) for each in candidates), key=len)
    if not places:
        return None
    kind = given.arguments[places[0]]
    message = f"argument {places[0] + 1} of {name} cannot be of the kind {kind}"
    before = sum(1 for each in form.arguments[: places[0]] for _ in walk(each))
    return Misuse(node + 1 + before, message, f"write {choices}")


def sample_forms(
    predicate: Predicate,
    predicates: Mapping[str, Predicate] | None = None,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> Iterator[Form]:
    """Yield a form with class tokens for each signature, made of what the world has.

    A description stands in the first action that takes one, or alone where the world has none.
    """
    predicates = predicates or {}
    for signature in predicate.signatures:
        form = sample_use(predicate, signature, predicates, classes)
        if predicate.is_action and ArgumentKind.VARIABLE not in signature.arguments:
            yield form
        else:
            described = Lambda(1, "e", (form,))
            action = _first_taking(predicates, (ArgumentKind.LAMBDA,))
            yield Application(action, (described,)) if action else described


def sample_use(
    predicate: Predicate,
    signature: Signature,
    predicates: Mapping[str, Predicate] | None = None,
    classes: EntityClasses = DEFAULT_CLASSES,
) -> Application:
    """Return the predicate with class tokens and the like as its arguments."""
    kinds = signature.arguments
    samples = _samples(predicates or {}, classes)
    arguments = (
        Constant(f"<{kind}>")
        if is_entity_kind(kind)
        else samples[ArgumentKind.ANY if kind == "variable" in kinds[:place] else kind]
        for place, kind in enumerate(kinds)
    )
    return Application(predicate.name, tuple(arguments))


def said_of(use: Application, predicate: Predicate, names: Sequence[str]) -> tuple[str, str]:
    """Return how a use of an action is said, and what it is called inside another action; empty where it has no
    words for that.

    ``names`` stand in braces in place of its arguments: ``water {plant} in {bed}``.
    """
    pattern = lengthen(predicate.gloss or _default(predicate), True, predicate.signatures)
    scope = Scope({predicate.name: pattern}, frozenset((predicate.name,)), DEFAULT_CLASSES)

    def text(alternative: GlossAlternative) -> str:
        pieces = (
            each if isinstance(each, str) else each.with_names(names) for each in alternative.pieces
        )
        return " ".join("".join(pieces).split())

    nested = choose(use, scope, is_nested=True)
    return text(choose(use, scope)), text(nested) if nested.is_nested else ""


def _samples(predicates: Mapping[str, Predicate], classes: EntityClasses) -> Mapping[str, Form]:
    """Return an argument of each kind that every world has."""
    signatures = (each.signatures for each in predicates.values())
    taken = {kind for each in chain.from_iterable(signatures) for kind in each.arguments}
    token = next((each for each in classes.tokens if each in taken), next(iter(classes.tokens), ""))
    thing: Form = Constant(f"<{token}>") if token else UNKNOWN
    noun = next((name for name, each in predicates.items() if each.says_noun), "")
    action = _first_taking(predicates, (token,))
    bodies = (Application(noun, (Variable(2), thing)),) if noun else ()
    return {
        ArgumentKind.VARIABLE: Variable(1),
        ArgumentKind.LAMBDA: Lambda(2, "e", bodies) if bodies else thing,
        ArgumentKind.FORM: Application(action, (thing,)) if action else thing,
        ArgumentKind.NUMBER: Constant(2),
        ArgumentKind.TEXT: Constant("something"),
        ArgumentKind.UNKNOWN: UNKNOWN,
        ArgumentKind.ANY: thing,
    }


def _first_taking(predicates: Mapping[str, Predicate], kinds: tuple[str, ...]) -> str:
    """Return the first action that takes these kinds of arguments and no more; empty where none does."""
    return next(
        (
            name
            for name, each in predicates.items()
            if each.kind is PredicateKind.ACTION and Signature(kinds) in each.signatures
        ),
        "",
    )
