"""What the chart takes against other parsers, in seconds of processor time, on commands of the published generator.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.language.chart [--commands 1000]

The chart parses and makes the forms; lark's Earley parser and, where nltk is installed, its left-corner chart parser
build trees of the same rules. All get words; a grammar for each task category, one after the other.
"""

from __future__ import annotations

import argparse
import random
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import product
from typing import Any

from lark import Lark, Token, UnexpectedInput
from lark.lexer import Lexer

from annotations.language.grammar import Alternative, ChartRule, Run
from annotations.language.templates import TemplateChart, generate, read_generator_folder
from benchmarks.fresh_site import DATA

Accepts = Callable[[Sequence[str]], bool]
SEED = 1


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--commands", type=int, default=1_000)
    categories = read_generator_folder(DATA / "generator-2018").categories()
    commands = sorted({each.command for each in generate(categories).expansions})
    commands = random.Random(SEED).sample(commands, options.parse_args().commands)
    chart = TemplateChart(categories)
    ours = seconds_of(lambda: [chart.parse(command) for command in commands])
    print(f"{ours:8.2f} s  {len(commands)} commands by the chart, with forms")
    some = [command.split() for command in commands[:: max(1, len(commands) // 100)]]
    for name, make in (("lark, Earley", by_lark), ("nltk, left corner", by_nltk)):
        try:
            parsers = [make(rules, root) for rules, root in chart.rules]
        except ImportError:
            print(f"{'':>8}    {name}: not installed")
            continue
        took = seconds_of(partial(parse_all, parsers, some)) * len(commands) / len(some)
        print(f"{took:8.2f} s  {name}, of {len(some)}: {took / ours:.1f} times as long")


def parse_all(parsers: Sequence[Accepts], commands: Sequence[Sequence[str]]) -> None:
    """Ask every parser about every command, of which each has to be accepted by one."""
    for words in commands:
        assert sum(accepts(words) for accepts in parsers), words


def seconds_of(work: Callable[[], object]) -> float:
    """Return the processor time of the quicker of two times."""
    times = []
    for _ in range(2):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def without_empty(rules: Sequence[ChartRule]) -> Iterator[tuple[int, Alternative]]:
    """Yield each rule's number with its alternatives, those of them anew in which an item that can be empty is left
    out; none that is empty. Rules stand after those that they are made of."""
    filled: set[int] = set()
    for number, rule in enumerate(rules):
        seen: set[Alternative] = set()
        for alternative in rule.alternatives:
            ways: list[tuple[Alternative, ...]] = [
                ((item,), ()) if isinstance(item, int) and rules[item].can_be_empty else ((item,),)
                for item in alternative
            ]
            for way in product(*ways):
                items = tuple(item for some in way for item in some)
                is_made = all(isinstance(item, Run) or item in filled for item in items)
                if items and is_made and items not in seen:
                    seen.add(items)
                    filled.add(number)
                    yield number, items


class Words(Lexer):
    """Gives lark the words of a command as they are."""

    def __init__(self, conf: object) -> None:
        """lark asks for a lexer of one argument."""

    def lex(self, data: Any) -> Iterator[Token]:  # type: ignore[override]  # of words, not of a text
        for name in data:
            yield Token(name, name)


def by_lark(rules: Sequence[ChartRule], root: int) -> Accepts:
    names: dict[str, str] = {}

    def terminal(word: str) -> str:
        return names.setdefault(word, f"W{len(names)}")

    lines: dict[int, list[str]] = {}
    for number, items in without_empty(rules):
        said = (
            [f"r{item}"] if isinstance(item, int) else map(terminal, item.words) for item in items
        )
        lines.setdefault(number, []).append(" ".join(name for some in said for name in some))
    grammar = [f"r{number}: {' | '.join(some)}" for number, some in lines.items()]
    declared = [f"%declare {name}" for name in names.values()]
    parser = Lark("\n".join((*grammar, *declared)), start=f"r{root}", parser="earley", lexer=Words)

    def accepts(words: Sequence[str]) -> bool:
        if any(word not in names for word in words):
            return False
        try:
            parser.parse([names[word] for word in words])
        except UnexpectedInput:
            return False
        return True

    return accepts


def by_nltk(rules: Sequence[ChartRule], root: int) -> Accepts:
    from nltk import CFG, Nonterminal, Production  # type: ignore[import-not-found]
    from nltk.parse.chart import LeftCornerChartParser  # type: ignore[import-not-found]

    def side(items: Alternative) -> Iterator[object]:
        for item in items:
            if isinstance(item, Run):
                yield from item.words
            else:
                yield Nonterminal(str(item))

    made = [
        Production(Nonterminal(str(number)), list(side(items)))
        for number, items in without_empty(rules)
    ]
    words = {word for each in made for word in each.rhs() if isinstance(word, str)}
    parser = LeftCornerChartParser(CFG(Nonterminal(str(root)), made))

    def accepts(said: Sequence[str]) -> bool:
        return words >= set(said) and any(True for _ in parser.parse(said))

    return accepts


if __name__ == "__main__":
    main()
