"""How often a parser is right, by how many training pairs have the form that is asked for.

    GPSR_VAR_DIR=… .venv/bin/python -m benchmarks.parsing.form_counts --worlds household,robocup --parsers knn,linear

Trains each parser, *strict*, on all pairs of each split by command of these worlds, and answers its validation part.
Prints a line for each split and source, then one for all splits together: exact match, and right of asked by the
training pairs of the form. The figures of docs/design/parsers.md, "What to expect", are made so.
"""

from __future__ import annotations

import argparse
import os
from bisect import bisect_left
from collections import Counter, defaultdict
from collections.abc import Iterable

import django

MOST = (0, 1, 2, 4, 8, 16, 32)  # the upper ends of the columns; one more is open
Right = dict[tuple[str, int], list[int]]  # (source, column) → right, asked


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--worlds", default="household")
    arguments.add_argument("--parsers", default="knn,linear")
    asked = arguments.parse_args()
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    django.setup()
    from annotations.models import Split

    splits = Split.objects.filter(world__name__in=asked.worlds.split(","), criterion="command")
    for parser in asked.parsers.split(","):
        total: Right = defaultdict(lambda: [0, 0])
        for split in splits:
            of_split = count(parser, split.examples.values_list(*COLUMNS))
            report(f"{parser}, {split.world.name} {split.name}", of_split)
            for place, (right, of) in of_split.items():
                total[place][0] += right
                total[place][1] += of
        report(f"{parser}, together", total)


COLUMNS = ("part", "source", "utterance", "logical_form")


def count(name: str, rows: Iterable[tuple[str, ...]]) -> Right:
    """Train a parser and return how often it is right."""
    from parser_service.parsers.interface import Pair
    from parser_service.parsers.registry import load_class, make_config

    pairs: dict[str, list[Pair]] = defaultdict(list)
    for part, source, utterance, form in rows:
        pairs[part].append(Pair(utterance, form, source))
    parser = load_class(name)(make_config(name))
    parser.fit(pairs["train"], pairs["validation"])
    taught = Counter(pair.form for pair in pairs["train"])
    right: Right = defaultdict(lambda: [0, 0])
    answers = parser.predict([pair.utterance for pair in pairs["validation"]], 1)
    for pair, ranked in zip(pairs["validation"], answers, strict=True):
        counted = right[pair.source, bisect_left(MOST, taught[pair.form])]
        counted[0] += bool(ranked) and ranked[0].form == pair.form
        counted[1] += 1
    return right


def report(title: str, counted: Right) -> None:
    heads = [*(f"≤{most}" for most in MOST), f">{MOST[-1]}"]
    for source in sorted({source for source, _ in counted}):
        columns = {place: each for (of, place), each in sorted(counted.items()) if of == source}
        right, asked = map(sum, zip(*columns.values(), strict=True))
        cells = ", ".join(f"{heads[place]}: {r}/{of}" for place, (r, of) in columns.items())
        print(f"{title}, {source}: {100 * right / asked:.1f} % ({cells})")


if __name__ == "__main__":
    main()
