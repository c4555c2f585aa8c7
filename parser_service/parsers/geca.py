"""Good-enough compositional augmentation (Andreas 2020), on short forms and words.

Where two training commands differ in one span, and their forms in one token, the spans mean the
tokens. Exchanging them in other training pairs gives commands with forms that training never showed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

from annotations.language.forms import canonical_text, read_form
from annotations.language.texts import LanguageError
from parser_service.parsers.interface import Check, Pair, keep_going
from parser_service.parsers.pool import SURE, WayToForm
from parser_service.parsers.short import lengthen, name_of, shorten
from parser_service.parsers.spreading import spread, visiting_order
from parser_service.parsers.words import words

NAME = "geca"
LONGEST_SPAN = 6  # words
LEAST_CONTEXT = 3  # words that the two commands share around the span
MOST_COMMANDS = 24  # a form
MOST_EXAMPLES = 3000  # that rules are found in, and applied to
MOST_RULES = 5000
MOST_MADE = 60_000  # commands

Words = tuple[str, ...]
Short = tuple[str, ...]


@dataclass(frozen=True, slots=True, order=True)
class ExchangeRule:
    """Where ``words`` mean ``token``, ``other_words`` mean ``other_token``."""

    token: str
    other_token: str
    words: Words
    other_words: Words


def geca(pairs: Sequence[Pair], check: Check = keep_going) -> list[WayToForm]:
    """Return new forms with their commands, from exchanges that ``pairs`` themselves show.

    Rules come from the generated pairs where there are any: paraphrases differ in more than their
    meaning. A command that would get two forms is dropped. Of very many pairs, some of each form are
    looked at. ``check`` is called for each.
    """
    generated = [pair for pair in pairs if pair.source == "generated"]
    rules = find_rules(_examples(generated or pairs), check)
    return recombine(_examples(pairs), rules, check)


def find_rules(
    examples: Sequence[tuple[Words, Short]], check: Check = keep_going
) -> list[ExchangeRule]:
    """Return the exchanges that two examples show, in a fixed order."""
    frames: defaultdict[tuple[Words, Words], set[tuple[Words, Short]]] = defaultdict(set)
    for sentence, short in examples:
        check()
        longest = min(LONGEST_SPAN, len(sentence) - LEAST_CONTEXT)
        for begin, size in product(range(len(sentence)), range(1, longest + 1)):
            end = begin + size
            if end <= len(sentence):
                frames[sentence[:begin], sentence[end:]].add((sentence[begin:end], short))
    rules: set[ExchangeRule] = set()
    for filled in frames.values():
        if len(filled) > 1:
            check()
            rules.update(_rules_of(sorted(filled)))
    return spread(sorted(rules), MOST_RULES, lambda rule: rule.token)


def recombine(
    examples: Sequence[tuple[Words, Short]],
    rules: Sequence[ExchangeRule],
    check: Check = keep_going,
) -> list[WayToForm]:
    """Return the forms that the rules make from the examples and that no example has."""
    by_token: defaultdict[str, list[ExchangeRule]] = defaultdict(list)
    for rule in rules:
        by_token[rule.token].append(rule)
    known = {short for _, short in examples}
    meanings: defaultdict[Words, dict[Short, tuple[Short, str]]] = defaultdict(dict)
    for at in visiting_order(len(examples)) if len(rules) == MOST_RULES else range(len(examples)):
        check()
        sentence, short = examples[at]
        if len(meanings) >= MOST_MADE:
            break
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
    made = []
    for short, said in commands.items():
        changed, change = origins[short]
        form, changed_form = canonical_text(lengthen(short)), canonical_text(lengthen(changed))
        made.append(WayToForm(form, NAME, changed_form, change, tuple(said[:MOST_COMMANDS]), SURE))
    return made


def _examples(pairs: Sequence[Pair]) -> list[tuple[Words, Short]]:
    read = cache(_shorten)
    some = spread(pairs, MOST_EXAMPLES, lambda pair: pair.form)
    examples = ((words(pair.utterance), read(pair.form)) for pair in some)
    return list(dict.fromkeys((said, short) for said, short in examples if short is not None))


def _shorten(text: str) -> Short | None:
    """Return the short form; None for a text that is none, which can be an answer, but not recombined."""
    try:
        return shorten(read_form(text))
    except LanguageError:
        return None


def _rules_of(filled: Sequence[tuple[Words, Short]]) -> Iterator[ExchangeRule]:
    """Yield the exchanges between the fillers of one frame."""
    alike: defaultdict[tuple[Short, Short], list[tuple[Words, str]]] = defaultdict(list)
    for span, short in filled:
        for place, token in enumerate(short):
            alike[short[:place], short[place + 1 :]].append((span, token))
    for fillers in alike.values():
        for span, token in fillers:
            for other_span, other in fillers:
                is_other = (
                    token != other and span[0] != other_span[0] and span[-1] != other_span[-1]
                )
                if is_other:
                    yield ExchangeRule(token, other, span, other_span)


def _apply(
    sentence: Words, short: Short, by_token: dict[str, list[ExchangeRule]]
) -> Iterator[tuple[ExchangeRule, Words, Short]]:
    for place, token in enumerate(short):
        for rule in by_token.get(token, ()):
            size = len(rule.words)
            places = range(len(sentence) - size + 1)
            occurrences = [at for at in places if sentence[at : at + size] == rule.words]
            made = (*short[:place], rule.other_token, *short[place + 1 :])
            names = [name for name in map(name_of, made) if name]
            # Hardly any command means a predicate twice.
            if len(occurrences) == 1 and len(names) == len(set(names)):
                [at] = occurrences
                yield rule, (*sentence[:at], *rule.other_words, *sentence[at + size :]), made
