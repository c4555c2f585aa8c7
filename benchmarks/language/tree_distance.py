"""Seconds of processor time for the distances of all pairs of many forms.

The forms are those of ``walker2019``, filled with names until there are as many as asked for:

    python -m benchmarks.language.tree_distance ../shared/data/walker2019 --forms 1000
"""

from __future__ import annotations

import argparse
import random
import re
import time
from pathlib import Path

from annotations.language.forms import FormDistances, read_form

NAMES = ["apple", "tea", "milk", "kitchen", "bath", "anna", "sofa", "chair", "bed", "lamp", "cup"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("corpus", type=Path)
    parser.add_argument("--forms", type=int, default=1000)
    arguments = parser.parse_args()
    files = sorted(arguments.corpus.glob("gen*/*.txt")) + sorted(
        arguments.corpus.glob("para*/*.txt")
    )
    texts = sorted({line for file in files for line in file.read_text("utf-8").splitlines()[1::2]})
    chance = random.Random(1)
    many = set(texts)
    while len(many) < arguments.forms:
        many.add(re.sub(r"<\w+>", lambda _: chance.choice(NAMES), chance.choice(texts)))
    forms = [read_form(text) for text in sorted(many)[: arguments.forms]]
    start = time.process_time()
    FormDistances().matrix(forms)
    print(f"{len(forms):,} forms: {time.process_time() - start:.1f} s")


if __name__ == "__main__":
    main()
