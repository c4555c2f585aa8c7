"""Which marks are of one class: those that somebody says so of, and those that take one another's place."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count, product
from string import ascii_lowercase
from typing import TypeAlias

from annotations.language.induction.marked_lines import Mark
from annotations.language.texts import NUMBERS, singular

UNNAMED = "thing"  # the token of a class whose name nothing says

Evidence: TypeAlias = "tuple[str, ...]"


@dataclass(frozen=True, slots=True)
class MarkedPlace:
    """A mark, the predicate and the role in which it stands, and its line."""

    mark: Mark
    predicate: str
    role: str
    line: int


@dataclass(frozen=True, slots=True)
class MarkedClass:
    """The marks of one class. ``is_named`` is false where the token is only the next that was free.

    ``evidence`` says what made them one, as (kind, what): ("said", token), ("role", predicate, role), ("text", text),
    ("word", word).
    """

    token: str
    texts: tuple[str, ...]
    lines: tuple[int, ...]
    is_named: bool
    evidence: tuple[Evidence, ...]

    @property
    def marks(self) -> tuple[Mark, ...]:
        """A mark for each text, with the class where somebody has said it."""
        return tuple(Mark(text, self.token if self.is_named else "") for text in self.texts)


def classes_of(
    places: Sequence[MarkedPlace],
    known_texts: Mapping[str, str],
    roles: Mapping[tuple[str, str], str],
) -> tuple[dict[Mark, str], tuple[MarkedClass, ...]]:
    """Put marks into classes.

    Args:
        places: where the marks stand.
        known_texts: what the entities of the world are called, folded, with their class.
        roles: the class of a role of a predicate that the world has.

    Returns:
        The token of each mark, and the classes in the order of their first mark.
    """
    groups = _joined(places, known_texts, roles)
    taken = {each.mark.entity_class for each in places} | set(known_texts.values())
    tokens: dict[Mark, str] = {}
    found: list[MarkedClass] = []
    for marks, evidence in groups:
        said = next((each[1] for each in evidence if each[0] == "said"), "")
        proposed = said or _shared_word(marks)
        token = proposed or next(each for each in _unnamed_tokens() if each not in taken)
        taken.add(token)
        tokens |= dict.fromkeys(marks, token)
        here = [each for each in places if each.mark in marks]
        texts: dict[str, str] = {}
        for each in here:
            texts.setdefault(folded(each.mark.text), each.mark.text)
        lines = tuple(dict.fromkeys(each.line for each in here))
        found.append(
            MarkedClass(token, tuple(texts.values()), lines, bool(proposed), tuple(evidence))
        )
    return tokens, tuple(found)


def _unnamed_tokens() -> Iterator[str]:
    yield UNNAMED
    for length in count(1):
        for letters in product(ascii_lowercase, repeat=length):
            yield f"{UNNAMED}_{''.join(letters)}"


def folded(text: str) -> str:
    """Return how an entity is compared: its singular in lower case."""
    return singular(text.lower())


def _joined(
    places: Sequence[MarkedPlace],
    known_texts: Mapping[str, str],
    roles: Mapping[tuple[str, str], str],
) -> list[tuple[dict[Mark, None], dict[Evidence, None]]]:
    """Return the marks that belong together with what says so; marks of different named classes never do."""
    groups: list[tuple[dict[Mark, None], dict[Evidence, None]]] = []

    def join(evidence_of: Callable[[MarkedPlace], Iterable[Evidence]]) -> None:
        by_evidence: defaultdict[Evidence, list[Mark]] = defaultdict(list)
        for place in places:
            for evidence in evidence_of(place):
                by_evidence[evidence].append(place.mark)
        for evidence, marks in by_evidence.items():
            mine = [each for each in groups if each[0].keys() & set(marks)]
            by_token: defaultdict[str, list[tuple[dict[Mark, None], dict[Evidence, None]]]]
            by_token = defaultdict(list)
            for group in mine:
                by_token[_token_of(group[1])].append(group)
            tokens = [token for token in by_token if token]
            if len(tokens) > 1:
                continue
            together = [*by_token[""], *(by_token[tokens[0]] if tokens else ())]
            if len(together) > 1 or evidence[0] == "said":
                for group in together:
                    groups.remove(group)
                groups.append(
                    (
                        {mark: None for group in together for mark in group[0]},
                        {each: None for group in together for each in group[1]} | {evidence: None},
                    )
                )

    for place in places:
        if not any(place.mark in group[0] for group in groups):
            groups.append(({place.mark: None}, {}))
    join(lambda place: [("said", place.mark.entity_class)] if place.mark.entity_class else [])
    join(lambda place: _known(place, known_texts, roles))
    join(lambda place: [("text", folded(place.mark.text))])
    join(lambda place: [("role", place.predicate, place.role)])
    join(lambda place: [("word", word) for word in _words(place.mark.text)])
    order = {place.mark: n for n, place in reversed(list(enumerate(places)))}
    return sorted(groups, key=lambda group: min(order[mark] for mark in group[0]))


def _token_of(evidence: Iterable[Evidence]) -> str:
    return next((each[1] for each in evidence if each[0] == "said"), "")


def _known(
    place: MarkedPlace, known_texts: Mapping[str, str], roles: Mapping[tuple[str, str], str]
) -> list[Evidence]:
    if place.mark.entity_class:
        return []
    token = known_texts.get(folded(place.mark.text)) or roles.get((place.predicate, place.role), "")
    return [("said", token)] if token else []


def _words(text: str) -> list[str]:
    """Return the words that members of one class may share: all but numbers, of a text that has several."""
    words = text.lower().split()
    return (
        [each for each in words if each.isalpha() and each not in NUMBERS] if len(words) > 1 else []
    )


def _shared_word(marks: Iterable[Mark]) -> str:
    """Return the word that all marks have, as the token of their class: ``bed`` of "bed two" and "bed three"."""
    texts = [each.text for each in marks]
    if len(set(texts)) < 2:
        return ""
    shared = set.intersection(*(set(_words(text)) for text in texts))
    words = [word for word in _words(texts[0]) if word in shared and word.isascii()]
    return words[-1] if words else ""
