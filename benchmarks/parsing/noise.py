"""How often the grammar oracle understands generated commands through noise, by kind of noise.

    .venv/bin/python -m benchmarks.parsing.noise WORLD [--commands 200] [--seed 0] [--show 3]

The world's language is sampled, and each command is put through each kind of noise and through three kinds at once.
An answer is right where its form and its entities are those of the command, wrong where they are others. What is
left is not understood. Milliseconds are of processor time.
"""

from __future__ import annotations

import argparse
import os
import re
from collections import Counter
from collections.abc import Callable
from functools import cache
from random import Random
from time import process_time

import django
from spellchecker import SpellChecker

from annotations.language.texts import sounds_like

FILLERS = ("uhm", "uh,", "er", "you know", "well", "like", ", um,")
OPENINGS = (
    "hey robot,",
    "could you please",
    "I'd like you to",
    "would you be so kind as to",
    "so,",
    "okay, can you",
)
ARTICLES = ("the", "a", "an")
SHORTENED = {"what is": "what's", "there are": "there're", "who is": "who's", "there is": "there's"}


def without_articles(words: list[str], random: Random) -> list[str]:
    return [word for word in words if word not in ARTICLES] or words


def doubled(words: list[str], random: Random) -> list[str]:
    at, size = random.randrange(len(words)), random.choice((1, 1, 2))
    return words[: at + size] + words[at : at + size] + words[at + size :]


def filled(words: list[str], random: Random) -> list[str]:
    at = random.randrange(1, len(words))
    return [*words[:at], random.choice(FILLERS), *words[at:]]


def opened(words: list[str], random: Random) -> list[str]:
    return [random.choice(OPENINGS), *words]


def swapped(words: list[str], random: Random) -> list[str]:
    """Two letters of a longer word change places."""
    longer = [at for at, word in enumerate(words) if len(word) > 4 and word.isalpha()]
    if not longer:
        return words
    at = random.choice(longer)
    cut = random.randrange(1, len(words[at]) - 2)
    letters = list(words[at])
    letters[cut], letters[cut + 1] = letters[cut + 1], letters[cut]
    return [*words[:at], "".join(letters), *words[at + 1 :]]


def left_out(words: list[str], random: Random) -> list[str]:
    """A longer word loses a letter."""
    longer = [at for at, word in enumerate(words) if len(word) > 5 and word.isalpha()]
    if not longer:
        return words
    at = random.choice(longer)
    cut = random.randrange(1, len(words[at]) - 1)
    return [*words[:at], words[at][:cut] + words[at][cut + 1 :], *words[at + 1 :]]


def joined(words: list[str], random: Random) -> list[str]:
    pairs = [at for at in range(len(words) - 1) if min(map(len, words[at : at + 2])) > 3]
    if not pairs:
        return words
    at = random.choice(pairs)
    return [*words[:at], words[at] + words[at + 1], *words[at + 2 :]]


def split(words: list[str], random: Random) -> list[str]:
    """A compound of two English words is written as two."""
    longer = [
        (at, cut)
        for at, word in enumerate(words)
        for cut in range(3, len(word) - 2)
        if {word[:cut], word[cut:]} <= set(english().word_frequency.words())
    ]
    if not longer:
        return words
    at, cut = random.choice(longer)
    return [*words[:at], words[at][:cut], words[at][cut:], *words[at + 1 :]]


def misheard(words: list[str], random: Random) -> list[str]:
    """A word becomes another English one that sounds alike."""
    options = [
        (at, other) for at, word in enumerate(words) for other in homophones(word.casefold())
    ]
    if not options:
        return words
    at, other = random.choice(options)
    return [*words[:at], other, *words[at + 1 :]]


def shortened(words: list[str], random: Random) -> list[str]:
    text = " ".join(words)
    for long, short in SHORTENED.items():
        text = re.sub(rf"\b{long}\b", short, text, count=1)
    return text.split()


def corrected(words: list[str], random: Random) -> list[str]:
    """The first noun phrase is begun with a mistake: "the box, no, the cola"."""
    at = next((at for at, word in enumerate(words[1:], 1) if word in ARTICLES), None)
    return words if at is None else [*words[:at], "the", "box,", "no,", *words[at:]]


KINDS: dict[str, Callable[[list[str], Random], list[str]]] = {
    "articles left out": without_articles,
    "words twice": doubled,
    "filler": filled,
    "courtesy": opened,
    "two letters swapped": swapped,
    "a letter left out": left_out,
    "words joined": joined,
    "compound split": split,
    "homophone": misheard,
    "contraction": shortened,
    "correction": corrected,
}


@cache
def english() -> SpellChecker:
    return SpellChecker(language="en")


@cache
def homophones(word: str) -> tuple[str, ...]:
    """Return frequent English words that sound like ``word``."""
    if len(word) < 3 or not word.isalpha():
        return ()
    frequency = english().word_frequency
    near = english().edit_distance_2(word) if len(word) < 7 else english().edit_distance_1(word)
    return tuple(
        sorted(
            other
            for other in english().known(near)
            if other != word
            and frequency[other] > 500
            and len(other) > 2
            and sounds_like(word, other)
        )
    )


def several(words: list[str], random: Random) -> list[str]:
    for kind in random.sample(list(KINDS), 3):
        words = KINDS[kind](words, random)
    return words


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("world")
    parser.add_argument("--commands", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--show", type=int, default=3, help="answers of each kind that are not right"
    )
    given = parser.parse_args()
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    django.setup()
    from annotations.generation.grounded_pairs import grounded_pairs
    from annotations.models import World
    from parser_service.parsers.interface import Candidate
    from parser_service.parsers.oracle import GrammarOracle
    from parser_service.runs.knowledge import knowledge_of

    world = World.objects.get(name=given.world)
    oracle = GrammarOracle(knowledge=knowledge_of(world, "grammar"))

    def said(answers: list[Candidate]) -> tuple[object, ...]:
        return (answers[0].form, answers[0].values) if answers else ()

    random = Random(given.seed)
    pairs = grounded_pairs(world, given.commands, given.seed)
    commands = {text: said(answers) for text, _ in pairs if (answers := oracle.predict([text])[0])}
    print(f"{len(commands)} of {len({text for text, _ in pairs})} are understood without noise")
    for name, noise in {**KINDS, "three at once": several}.items():
        counts: Counter[str] = Counter()
        times = []
        for command, meant in commands.items():
            text = " ".join(noise(command.split(), random)).replace(" ,", ",")
            if text == command.replace(" ,", ","):
                continue
            start = process_time()
            answers = oracle.predict([text], 2)[0]
            times.append(process_time() - start)
            is_open = len(answers) > 1 and answers[0].score == answers[1].score
            outcome = "silent" if not answers else "right" if said(answers) == meant else "wrong"
            counts["asked" if outcome == "wrong" and is_open else outcome] += 1
            if outcome != "right" and counts[outcome] <= given.show:
                print(f"  {outcome}: {text} | {command} -> {answers[:1]}")
        n = max(1, counts.total())
        print(
            f"{name:20s} n {n:4d}  right {counts['right'] / n:6.1%}  silent {counts['silent'] / n:6.1%}"
            f"  asked {counts['asked'] / n:5.1%}  wrong {counts['wrong'] / n:5.1%}"
            f"  {1000 * sum(times) / n:.0f} ms, at most {1000 * max(times, default=0):.0f}"
        )


if __name__ == "__main__":
    main()
