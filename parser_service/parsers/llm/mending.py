"""Holds what a language model writes to a world: its predicates, its entities, and what a reference can stand for.

A misspelt name becomes the one that is surely meant. What else the world does not have is left open, as UNKNOWN or
as a class token without an entity, so that somebody is asked.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace

from annotations.language.corpus import MisspeltNames
from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Variable,
    loose_references,
    walk,
)
from annotations.language.grounding import Anonymizer
from annotations.language.world import (
    ArgumentKind,
    Ontology,
    Predicate,
    PredicateKind,
    Signature,
    admits,
    signature_of,
)


@dataclass(frozen=True, slots=True)
class Mended:
    """A form that the world has, and the entities of its class tokens in order: None where it is not sure which."""

    form: Form
    values: tuple[str | None, ...]


class _Lost(Exception):
    """What stands here means nothing in this world; the argument around it stays open."""


@dataclass(slots=True)
class _Work:
    """The entities that the utterance names, by class and value, and the ``values`` of the tokens so far."""

    named: frozenset[tuple[str, str]]
    values: list[str | None] = field(default_factory=list)

    def token(self, entity_class: str, value: str | None) -> Constant:
        """Return a class token. It has an entity where the utterance names that: models invent others."""
        self.values.append(value if (entity_class, value) in self.named else None)
        return Constant(f"<{entity_class}>")


class Mender:
    """Knows what forms may hold: the declared predicates and, where it is given, the ontology."""

    def __init__(
        self,
        forms: Iterable[Form],
        predicates: Mapping[str, Predicate],
        ontology: Ontology | None = None,
    ):
        """``forms`` are those of the training pairs: texts that they write out may be written again."""
        self._predicates = predicates
        self._ontology = ontology
        self._anonymizer = None if ontology is None else Anonymizer(ontology)
        self._texts = {
            each.value
            for form in forms
            for each in walk(form)
            if isinstance(each, Constant) and isinstance(each.value, str)
        }
        self._misspelt = MisspeltNames()

    def mend(self, form: Form, utterance: str) -> Mended:
        """Return ``form`` with what the world has. Only entities that ``utterance`` names are among the values."""
        spans = () if self._anonymizer is None else self._anonymizer.anonymize(utterance).spans
        work = _Work(frozenset((span.entity_class, span.value) for span in spans))
        try:
            mended = self._form(form, work)
        except _Lost:
            return Mended(UNKNOWN, ())
        return Mended(without_loose(mended), tuple(work.values))

    def _form(self, form: Form, work: _Work) -> Form:
        if isinstance(form, Lambda):
            return replace(form, bodies=tuple(self._form(each, work) for each in form.bodies))
        return self._application(form, work) if isinstance(form, Application) else form

    def _application(self, form: Application, work: _Work) -> Form:
        predicate = self._predicate(form)
        if predicate.kind is PredicateKind.SEQUENCE:
            actions = tuple(self._action(each, work) for each in form.arguments)
            if all(each == UNKNOWN for each in actions):
                raise _Lost
            return Application(predicate.name, actions)
        fitting = [
            each for each in predicate.signatures if len(each.arguments) == len(form.arguments)
        ]
        if not fitting:
            raise _Lost
        arguments: list[Form] = []
        for place, argument in enumerate(form.arguments):
            kinds = {each.arguments[place] for each in fitting}
            before = len(work.values)
            try:
                arguments.append(self._argument(argument, kinds, work))
            except _Lost:
                if not predicate.is_action:
                    raise
                del work.values[before:]
                arguments.append(UNKNOWN)
        mended = Application(predicate.name, tuple(arguments))
        if not _is_declared(mended, fitting):
            raise _Lost
        return mended

    def _action(self, form: Form, work: _Work) -> Form:
        """Return an action of a sequence; UNKNOWN where it is none, so that the others keep their places."""
        before = len(work.values)
        try:
            if isinstance(form, Application | Lambda):
                return self._form(form, work)
        except _Lost:
            del work.values[before:]
        return UNKNOWN

    def _predicate(self, form: Application) -> Predicate:
        """Return the predicate that is meant: of the same kind, and with a place for each argument. Raises _Lost."""
        name = str(form.predicate)
        if name in self._predicates:
            return self._predicates[name]
        is_action = not (form.arguments and isinstance(form.arguments[0], Variable))
        alike = [
            each.name
            for each in self._predicates.values()
            if each.is_action is is_action
            and any(len(known.arguments) == len(form.arguments) for known in each.signatures)
        ]
        meant = self._misspelt.meant(name, alike)
        if meant is None:
            raise _Lost
        return self._predicates[meant]

    def _argument(self, form: Form, kinds: Collection[str], work: _Work) -> Form:
        """Return what may stand in a place that takes ``kinds``. Raises _Lost."""
        if (
            isinstance(form, Constant)
            and isinstance(form.value, str)
            and self._ontology is not None
        ):
            return self._text(form, self._ontology, kinds, work)
        return self._form(form, work)

    def _text(
        self, constant: Constant, ontology: Ontology, kinds: Collection[str], work: _Work
    ) -> Constant:
        """Return the class token or the text that is meant, and keep the entity of a token. Raises _Lost."""
        text = str(constant.value)
        classes = [
            each for each in ontology.classes.tokens if any(admits(kind, each) for kind in kinds)
        ]
        if (token := constant.token_class) in classes:
            return work.token(token, None)
        if token in ontology.classes:
            raise _Lost
        if token and (meant := self._misspelt.meant(token, classes)):
            return work.token(meant, None)
        if text in self._texts and ArgumentKind.TEXT in kinds:
            return constant
        if entities := self._entities(text, ontology, classes):
            return work.token(*min(entities, key=lambda each: each not in work.named))
        # Nothing has this name. Where only one class can stand here, the utterance or a person says which one.
        possible = [each for each in classes if each in {said for said, _ in work.named}]
        if len(possible) != 1:
            possible = classes
        if len(possible) != 1:
            raise _Lost
        return work.token(possible[0], None)

    def _entities(
        self, text: str, ontology: Ontology, classes: Collection[str]
    ) -> list[tuple[str, str]]:
        """Return the entities of ``classes`` that ``text`` names, each as its class and its value; none where it
        is not sure which."""
        assert self._anonymizer is not None
        spans = self._anonymizer.anonymize(text).spans
        whole = [span for span in spans if (span.start, span.end) == (0, len(text))]
        if whole and whole[0].entity_class in classes:
            return [(whole[0].entity_class, whole[0].value)]
        by_name: dict[str, list[tuple[str, str]]] = {}
        for entity_class in classes:
            for name in ontology.texts_of(entity_class):
                by_name.setdefault(name, []).append((entity_class, name))
        meant = self._misspelt.meant(text, by_name)
        return [] if meant is None else by_name[meant]


def tokens_in(form: Form) -> int:
    """Return how many class tokens a form has."""
    return sum(isinstance(each, Constant) and bool(each.token_class) for each in walk(form))


def without_loose(form: Form) -> Form:
    """Return ``form`` with UNKNOWN for ``it`` and ``them`` where these have nothing to stand for."""
    return _without(form, loose_references(form))


def _is_declared(form: Application, signatures: Iterable[Signature]) -> bool:
    """Return whether one of the signatures allows all arguments that are not open."""
    given = signature_of(form)
    return any(
        all(form.arguments[place] == UNKNOWN for place in each.mismatches(given))
        for each in signatures
    )


def _without(form: Form, references: Collection[str]) -> Form:
    """Return ``form`` with UNKNOWN for the references that have nothing to stand for."""
    if isinstance(form, Reference) and form.word in references:
        return UNKNOWN
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(_without(each, references) for each in form.bodies))
    if isinstance(form, Application):
        return replace(form, arguments=tuple(_without(each, references) for each in form.arguments))
    return form
