"""Edits after which an utterance means exactly the same: politeness, articles, spelling and synonyms."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

from annotations.language.forms import Form, head_predicate
from annotations.language.texts import ARTICLES, NO_COMMAND_WORDS, POLITE_OPENINGS, article
from parser_service.analysis.edit import EditKind, UtteranceEdit
from parser_service.analysis.facts import WorldFacts
from parser_service.analysis.mentions import TokenizedUtterance

SHORTEST_MISSPELLED = 5  # letters; shorter words become other words too easily
_OPENINGS = sorted((opening.split() for opening in POLITE_OPENINGS), key=len, reverse=True)


def change_politeness(utterance: TokenizedUtterance, form: Form) -> Iterator[UtteranceEdit]:
    """Take polite words away where there are some, add “please” where there are none."""
    words = [each.text.lower() for each in utterance.mentions]
    if not words:
        return
    opening = next((each for each in _OPENINGS if words[: len(each)] == each), [])
    if opening and len(words) > len(opening):
        old = utterance.text[: utterance.mentions[len(opening)].start]
        text = _like(utterance.text, utterance.text[len(old) :])
        yield UtteranceEdit(EditKind.POLITENESS, text, form, old.strip(" ,"), "")
    elif "please" in words:
        mention = utterance.mentions[words.index("please")]
        before = utterance.text[: mention.start].rstrip(" ,")
        text = before + utterance.text[mention.end :]
        yield UtteranceEdit(EditKind.POLITENESS, text, form, mention.text, "")
    elif words[0] in NO_COMMAND_WORDS:
        end = len(utterance.text.rstrip(" .?!"))
        text = f"{utterance.text[:end]} please{utterance.text[end:]}"
        yield UtteranceEdit(EditKind.POLITENESS, text, form, "", "please")
    else:
        rest = utterance.text
        if not utterance.mentions[0].value:
            rest = rest[:1].lower() + rest[1:]
        text = f"{_like(utterance.text, 'please')} {rest}"
        yield UtteranceEdit(EditKind.POLITENESS, text, form, "", "please")


def change_article(
    utterance: TokenizedUtterance, form: Form, facts: WorldFacts
) -> Iterator[UtteranceEdit]:
    """Exchange “the” and “a” before something that the world has by name or class."""
    for said, noun in zip(utterance.mentions, utterance.mentions[1:], strict=False):
        # A category is a plural, and people go without an article.
        is_noun = facts.ontology.classes.has_plurals(noun.entity_class)
        if said.text.lower() in ARTICLES and is_noun and noun.entity_class != "category":
            is_definite = said.text.lower() == "the"
            new = _like(said.text, article(noun.text.lstrip("<")) if is_definite else "the")
            text = utterance.text[: said.start] + new + utterance.text[said.end :]
            yield UtteranceEdit(EditKind.ARTICLE, text, form, said.text, new)


def misspell(
    utterance: TokenizedUtterance, form: Form, facts: WorldFacts, random: Random
) -> Iterator[UtteranceEdit]:
    """Exchange two letters inside one long plain word, unless that makes a word of the world."""
    for word in utterance.mentions:
        letters = word.text
        is_short = len(letters) < SHORTEST_MISSPELLED
        if word.entity_class or is_short or not letters.isalpha():
            continue
        places = [at for at in range(1, len(letters) - 2) if letters[at] != letters[at + 1]]
        if not places:
            continue
        at = random.choice(places)
        new = letters[:at] + letters[at + 1] + letters[at] + letters[at + 2 :]
        if new.lower() not in facts.vocabulary:
            text = utterance.replace(word, new)
            yield UtteranceEdit(EditKind.SPELLING, text, form, letters, new)


def exchange_synonym(
    utterance: TokenizedUtterance, form: Form, facts: WorldFacts
) -> Iterator[UtteranceEdit]:
    """Exchange a phrase for another alternative of its nonterminal, where the grammar keeps the form."""
    head = head_predicate(form)
    words = [each.word for each in utterance.mentions]
    for (old, needed, following), others in facts.synonyms.items():
        if needed != head:
            continue
        phrase = [*old.split(), *following.split()]
        last = len(words) - len(phrase) + 1
        places = [at for at in range(last) if words[at : at + len(phrase)] == phrase]
        if len(places) != 1:
            continue
        first = utterance.mentions[places[0]]
        end = utterance.mentions[places[0] + len(old.split()) - 1].end
        for new in others:
            written = _like(first.text, new)
            text = utterance.text[: first.start] + written + utterance.text[end:]
            yield UtteranceEdit(EditKind.SYNONYM, text, form, old, new)


def _like(model: str, text: str) -> str:
    """Return the text with a capital letter at its beginning where ``model`` has one."""
    return text[:1].upper() + text[1:] if model[:1].isupper() else text
