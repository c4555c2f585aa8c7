"""How long the language core takes, in seconds of processor time.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.language.core

Reads and expands the published 2018 generator, parses its commands with the chart, expands the 2019
generator, reads the published forms, and asks a grammar of 10^12 commands for its size and a parse.
The bound beside a figure is the one the project promises; a figure without one is for comparison.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

from annotations.language.corpus import read_pairs
from annotations.language.forms import read_form
from annotations.language.grammar import Grammar, Recognizer, read_productions
from annotations.language.templates import (
    TemplateChart,
    generate,
    read_generator_folder,
)
from benchmarks.fresh_site import DATA

T = TypeVar("T")


def time_once(name: str, work: Callable[[], T], bound: float | None = None) -> T:
    """Do ``work`` once, print what it took and whether that is within ``bound``."""
    start = time.process_time()
    result = work()
    took = time.process_time() - start
    verdict = (
        "" if bound is None else f"   (bound {bound:g} s: {'held' if took < bound else 'MISSED'})"
    )
    print(f"{took:8.3f} s  {name}{verdict}")
    return result


def huge_grammar() -> Grammar:
    words = " | ".join(f"w{number}" for number in range(10))
    return Grammar(read_productions(f"$Main = go{' $word' * 12}\n$word = {words}").productions)


def main() -> None:
    folder = DATA / "generator-2018"
    categories = time_once(
        "read generator-2018", lambda: read_generator_folder(folder).categories()
    )
    generated = time_once(
        "expand generator-2018 with its templates", lambda: generate(categories), 0.5
    )
    chart = time_once("compile the chart", lambda: TemplateChart(categories))
    commands = [each.command for each in generated.expansions]
    time_once(f"chart-parse {len(commands)} commands", lambda: list(map(chart.parse, commands)))

    later = read_generator_folder(DATA / "generator-2019").grammars
    gpsr = later.grammar("gpsr.txt")
    time_once("expand generator-2019 gpsr", lambda: list(gpsr.commands()))
    time_once("size of generator-2019 egpsr", later.grammar("egpsr.txt").size)

    text = (DATA / "walker2019" / "para" / "train.txt").read_bytes()
    time_once("read para/train.txt, 1,265 pairs", lambda: read_pairs(text, "train.txt"))
    line = '( bring ( lambda $1 e ( is_a $1 " <object{}> " ) ( at $1 " <location> " ) ) )'
    time_once(
        "read 3,000 different forms", lambda: [read_form(line.format(n)) for n in range(3000)], 1.0
    )

    huge = huge_grammar()
    time_once("size of a grammar of 10^12", huge.size)
    sentence = "go " + " ".join(f"w{number % 10}" for number in range(12))
    time_once("recognise a sentence of it", lambda: Recognizer(huge).accepts(sentence))


if __name__ == "__main__":
    main()
