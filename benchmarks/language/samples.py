"""How long a sample of a large language takes, in seconds of processor time, and how much memory.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.language.samples [--commands 20000]

The languages are made of the published 2019 EGPSR grammar: each alternative of a large nonterminal becomes a line,
so that forms compose. The second language says three of its tasks one after the other. The bounds are those
that the project promises for 20,000 commands.
"""

from __future__ import annotations

import argparse
import resource
import time

from annotations.language.forms import Nonterminal, print_sequence, walk_symbols
from annotations.language.grammar import Grammar, read_productions, readable
from annotations.language.templates import (
    Balance,
    Language,
    SampleRequest,
    TaskCategory,
    read_generator_folder,
    read_template,
)
from benchmarks.fresh_site import DATA

MOST_SECONDS, MOST_MEGABYTES = 60, 500
LARGE = 200  # commands of a nonterminal whose alternatives become lines
THREE = (
    "$first -> $task = $task",
    "$second -> $task = $task",
    "$third -> $task = $task",
    "$first , $second , and then $third = (sequence $first $second $third)",
)


def annotated_lines(grammar: Grammar) -> list[str]:
    """Return a line for each alternative of a large nonterminal that mentions no other of these twice."""
    large = {name for name in grammar.reachable() - {"Main"} if grammar.size(name) > LARGE}
    lines = []
    for name in sorted(large | {"Main"}):
        for number, alternative in enumerate(grammar.alternatives(name)):
            inner = [
                str(symbol)
                for symbol in walk_symbols(alternative, notes=False)
                if isinstance(symbol, Nonterminal) and symbol.name in large
            ]
            if len(set(inner)) == len(inner):
                head = "" if name == "Main" else f"${name} -> "
                form = f"({' '.join([f'{name}_{number}', *inner])})"
                lines.append(f"{head}{print_sequence(alternative)} = {form}")
    return lines


def languages() -> dict[str, TaskCategory]:
    grammar = read_generator_folder(DATA / "generator-2019").grammars.grammar("egpsr.txt")
    lines = annotated_lines(grammar)
    of_lines = tuple(map(read_template, lines))
    tasks = [line for line in lines if line.startswith("$")]
    further = read_productions("$first = $task\n$second = $task\n$third = $task").productions
    three = Grammar((*grammar.productions, *further))
    of_three = tuple(map(read_template, [*tasks, *THREE]))
    return {
        "EGPSR": TaskCategory("egpsr", grammar, of_lines),
        "three tasks of EGPSR": TaskCategory("three", three, of_three),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--commands", type=int, default=20_000)
    size = parser.parse_args().commands
    for name, category in languages().items():
        start = time.process_time()
        language = Language([category])
        counted = time.process_time() - start
        print(f"{name}: {readable(language.size)} derivations, counted in {counted:.3f} s")
        for balance in (Balance.NONE, Balance.LINES):
            start = time.process_time()
            sample = Language([category]).sample(SampleRequest(size, balance=balance))
            took = time.process_time() - start
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            forms = len({each.form_text for each in sample.generated.expansions})
            is_held = took < MOST_SECONDS and peak < MOST_MEGABYTES
            print(
                f"{took:8.1f} s {peak:6.0f} MB  {sample.note}, balanced {balance}: {forms:,} forms, "
                f"{len(sample.generated.conflicts):,} conflicts   "
                f"(bounds {MOST_SECONDS} s, {MOST_MEGABYTES} MB: {'held' if is_held else 'MISSED'})"
            )


if __name__ == "__main__":
    main()
