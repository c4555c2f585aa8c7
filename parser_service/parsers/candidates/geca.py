"""Good-enough compositional augmentation (Andreas 2020), on short forms and words.

Where two training commands differ in one span, and their forms in one token, the spans mean the
tokens. Exchanging them in other training pairs gives commands with forms that training never showed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from annotations.language.errors import LanguageError
from annotations.language.forms import canonical_text, read_form
from parser_service.parsers.candidates.pool import SURE, Made
from parser_service.parsers.candidates.short import lengthen, name_of, shorten
from parser_service.parsers.interface import Pair
from parser_service.parsers.words import words

NAME = "geca"
LONGEST_SPAN = 6  # words
LEAST_CONTEXT = 3  # words that the two commands share around the span
MOST_COMMANDS = 24  # a form

Words = tuple[str, ...]
Short = tuple[str, ...]


@dataclass(frozen=True, slots=True, order=True)
class Rule:
    """Where ``words`` mean ``token``, ``other_words`` mean ``other_token``."""

    token: str
    other_token: str
    words: Words
    other_words: Words


def geca(pairs: Sequence[Pair]) -> list[Made]:
    """Return new forms with their commands, from exchanges that ``pairs`` themselves show.

    Rules come from the generated pairs where there are any: paraphrases differ in more than their
    meaning. A command that would get two forms is dropped.
    """
    generated = [pair for pair in pairs if pair.source == "generated"]
    rules = find_rules(_examples(generated or pairs))
    return recombine(_examples(pairs), rules)


def find_rules(examples: Sequence[tuple[Words, Short]]) -> list[Rule]:
    """Return all exchanges that two examples show, in a fixed order."""
    frames: defaultdict[tuple[Words, Words], set[tuple[Words, Short]]] = defaultdict(set)
    for sentence, short in examples:
        for begin, end in _spans(len(sentence)):
            frame = sentence[:begin], sentence[end:]
            frames[frame].add((sentence[begin:end], short))
    return sorted({rule for filled in frames.values() for rule in _rules_of(sorted(filled))})


def recombine(examples: Sequence[tuple[Words, Short]], rules: Sequence[Rule]) -> list[Made]:
    """Return the forms that the rules make from the examples and that no example has."""
    by_token: defaultdict[str, list[Rule]] = defaultdict(list)
    for rule in rules:
        by_token[rule.token].append(rule)
    known = {short for _, short in examples}
    meanings: defaultdict[Words, dict[Short, tuple[Short, str]]] = defaultdict(dict)
    for sentence, short in examples:
        for rule, made_words, made_short in _apply(sentence, short, by_token):
            if made_short not in known:
                change = f"{rule.token} → {rule.other_token}"
                meanings[made_words].setdefault(made_short, (short, change))
    spoken = {sentence for sentence, _ in examples}
    commands: defaultdict[Short, list[str]] = defaultdict(list)
    origins: dict[Short, tuple[Short, str]] = {}
    for sentence, forms in meanings.items():
        if len(forms) == 1 and sentence not in spoken:
            [(short, origin)] = forms.items()
            commands[short].append(" ".join(sentence))
            origins.setdefault(short, origin)
    return [_make(short, said, *origins[short]) for short, said in commands.items()]


def _examples(pairs: Sequence[Pair]) -> list[tuple[Words, Short]]:
    examples = []
    for pair in pairs:
        try:
            examples.append((words(pair.utterance), shorten(read_form(pair.form))))
        except LanguageError:
            continue  # a text that is not a form can be an answer, but not recombined
    return list(dict.fromkeys(examples))


def _spans(length: int) -> Iterator[tuple[int, int]]:
    for begin in range(length):
        for end in range(begin + 1, min(begin + LONGEST_SPAN, length) + 1):
            if length - (end - begin) >= LEAST_CONTEXT:
                yield begin, end


def _rules_of(filled: Sequence[tuple[Words, Short]]) -> Iterator[Rule]:
    """Yield the exchanges between the fillers of one frame."""
    for span, short in filled:
        for other_span, other in filled:
            place = _only_difference(short, other)
            if place is not None and span[0] != other_span[0] and span[-1] != other_span[-1]:
                yield Rule(short[place], other[place], span, other_span)


def _only_difference(short: Short, other: Short) -> int | None:
    if len(short) != len(other):
        return None
    places = [place for place, token in enumerate(short) if token != other[place]]
    return places[0] if len(places) == 1 else None


def _apply(
    sentence: Words, short: Short, by_token: dict[str, list[Rule]]
) -> Iterator[tuple[Rule, Words, Short]]:
    for place, token in enumerate(short):
        for rule in by_token.get(token, ()):
            at = _only_occurrence(rule.words, sentence)
            made = (*short[:place], rule.other_token, *short[place + 1 :])
            if at is not None and not _repeats(made):
                yield (
                    rule,
                    (*sentence[:at], *rule.other_words, *sentence[at + len(rule.words) :]),
                    made,
                )


def _only_occurrence(span: Words, sentence: Words) -> int | None:
    size = len(span)
    places = [at for at in range(len(sentence) - size + 1) if sentence[at : at + size] == span]
    return places[0] if len(places) == 1 else None


def _repeats(short: Short) -> bool:
    """Return whether a predicate occurs twice, as hardly any command means it."""
    names = [name for name in map(name_of, short) if name]
    return len(names) > len(set(names))


def _make(short: Short, commands: Sequence[str], origin: Short, change: str) -> Made:
    return Made(
        canonical_text(lengthen(short)),
        NAME,
        canonical_text(lengthen(origin)),
        change,
        tuple(commands[:MOST_COMMANDS]),
        SURE,
    )
