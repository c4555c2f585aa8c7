"""What the world says about its words, as far as edits need it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import permutations

from annotations.language.forms import (
    Constant,
    Form,
    Nonterminal,
    canonicalize,
    equivalent,
    head_predicate,
)
from annotations.language.grammar import Grammar
from annotations.language.grounding import Anonymizer
from annotations.language.texts import RECIPIENT_PRONOUNS
from annotations.language.world import Ontology, Predicate
from parser_service.analysis.edit import substitute
from parser_service.analysis.mining import mine_pairs, words_of

MOST_PHRASES = 12  # a nonterminal with more of them is no set of synonyms

# A phrase, the head predicate of the form, and the word that follows, empty at the end of a command.
Phrase = tuple[str, str, str]
Contrasts = Mapping[tuple[str, str], tuple[tuple[Form, Form], ...]]


@dataclass(frozen=True)
class WorldFacts:
    """Plain values of a world; any of them may be missing.

    Args:
        ontology: whose names utterances may contain.
        predicates: declared predicates; a form that misuses them is no form to expect.
        known: anonymized command, as its words joined by spaces → its form.
        synonyms: a phrase in its context → phrases that the grammar has in its place.
        contrasts: (word, other word) → the forms of known commands with the one and with the other.
    """

    ontology: Ontology = field(default_factory=Ontology)
    predicates: Mapping[str, Predicate] = field(default_factory=dict)
    known: Mapping[str, Form] = field(default_factory=dict)
    synonyms: Mapping[Phrase, tuple[str, ...]] = field(default_factory=dict)
    contrasts: Contrasts = field(default_factory=dict)

    @cached_property
    def anonymizer(self) -> Anonymizer:
        return Anonymizer(self.ontology)

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """The words of the known commands and of the ontology's names."""
        texts = [*self.known, *(each.text for each in self.ontology.entities)]
        return frozenset(word for text in texts for word in words_of(text))

    def contradicts(self, text: str, form: Form) -> bool:
        """Return whether a text is a known command with another form, once both have class tokens."""
        anonymized = self.anonymizer.anonymize(text)
        expected = self.known.get(" ".join(words_of(anonymized.text)))
        if expected is None:
            return False
        for span in anonymized.spans:
            form = substitute(form, Constant(span.value), Constant(f"<{span.entity_class}>"))
        return not equivalent(expected, form)


def gather_facts(
    ontology: Ontology,
    grammars: Sequence[Grammar],
    pairs: Iterable[tuple[str, Form]],
    predicates: Mapping[str, Predicate],
) -> WorldFacts:
    """Learn from generated pairs what a change of words does to the form.

    Args:
        ontology: the entities of the world.
        grammars: those of the task categories, whose nonterminals say which phrases may stand for one another.
        pairs: anonymized commands with their forms, both with class tokens.
        predicates: the declared predicates by name.

    Raises:
        LanguageError: a grammar has a cycle or is too large to expand.
    """
    known = {" ".join(words_of(text)): canonicalize(form) for text, form in pairs}
    tokens = (f"<{name}>" for name in ontology.classes.tokens)
    contrasts = _contrasts(known, frozenset((*tokens, *RECIPIENT_PRONOUNS)))
    return WorldFacts(ontology, predicates, known, _synonyms(grammars, known), contrasts)


def _synonyms(
    grammars: Sequence[Grammar], known: Mapping[str, Form]
) -> dict[Phrase, tuple[str, ...]]:
    """Return the phrases that some nonterminal has as alternatives and that never change a known form.

    What a phrase means depends on what the command is about and on what follows (“take”, “tell me”), so that it
    has synonyms for one head predicate and before one word.
    """
    verdicts: dict[tuple[Phrase, str], bool] = {}
    alternatives = {each for grammar in grammars for each in _alternatives(grammar)}
    for phrases in sorted(alternatives):
        for old, new in permutations(phrases, 2):
            for phrase, is_same in _exchange_in(known, old, new):
                verdicts[phrase, new] = verdicts.get((phrase, new), True) and is_same
    synonyms: dict[Phrase, tuple[str, ...]] = {}
    for (phrase, new), is_same in sorted(verdicts.items()):
        if is_same:
            synonyms[phrase] = (*synonyms.get(phrase, ()), new)
    return synonyms


def _alternatives(grammar: Grammar) -> Iterator[tuple[str, ...]]:
    """Yield the phrases of each nonterminal that becomes nothing but a few phrases of words."""
    for name in grammar.rules:
        sequence = (Nonterminal(name),)
        if 1 < grammar.size(name) <= MOST_PHRASES:
            phrases = {" ".join(items).lower() for items, _ in grammar.expander.stream(sequence)}
            if len(phrases) > 1 and all(each and "<" not in each for each in phrases):
                yield tuple(sorted(phrases))


def _exchange_in(known: Mapping[str, Form], old: str, new: str) -> Iterator[tuple[Phrase, bool]]:
    """Yield for each known command with ``old`` that is known with ``new`` too, whether the forms are equal."""
    for text, form in known.items():
        before, phrase, after = f" {text} ".partition(f" {old} ")
        if phrase and f" {old} " not in f" {after}":
            other = known.get(f"{before} {new} {after}".strip())
            if other is not None:
                following = after.partition(" ")[0]
                yield (old, head_predicate(form), following), equivalent(form, other)


def _contrasts(known: Mapping[str, Form], exchangeable: frozenset[str]) -> Contrasts:
    """Return what an exchange of recipients or class tokens does to the forms of known commands."""
    texts, forms = list(known), list(known.values())
    pairs = mine_pairs(texts)
    contrasts: dict[tuple[str, str], dict[tuple[Form, Form], None]] = {}
    for number in range(len(pairs)):
        old, new = pairs.changed_words(number)
        if {old, new} <= exchangeable:
            first, second = forms[pairs.first[number]], forms[pairs.second[number]]
            contrasts.setdefault((old, new), {})[first, second] = None
            contrasts.setdefault((new, old), {})[second, first] = None
    return {words: tuple(examples) for words, examples in contrasts.items()}
