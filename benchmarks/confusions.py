"""How many of the ranker's errors by source command are distinctions that paraphrases seldom keep.

    GPSR_SHARED_DATA=… .venv/bin/python benchmarks/confusions.py [--splits 1,5] [--setting para-para]

Trains the ranker (domain, seed 0) on new splits by source command, a few minutes each, and asks it for the
paraphrases of the other two parts. Three distinctions are set apart: an open category ("objects") or none,
biggest or largest, and an explicit ``and`` or none. By part: exact match, and exact match but for these.
"""

from __future__ import annotations

import argparse
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
from fresh_site import Site
from new_splits import SETTINGS, trained

CATEGORY = re.compile(r'\( is_a \$\d " <category> " \)')


def blurred(form: str) -> str:
    """The words of a form without the three distinctions."""
    text = CATEGORY.sub("", form).replace("( biggest ", "( largest ").replace("( and ", "")
    return " ".join(re.sub(r"[()]", " ", text).split())


def answers(split: int, setting: str) -> Iterator[dict[str, object]]:
    """Every held-out paraphrase of a split: its part, whether the answer is right, and whether it is but
    for the three distinctions."""
    parser, corpus = trained(split, setting)
    for part in ("validation", "test"):
        pairs = corpus.pairs(part, ["paraphrased"])
        for pair, ranked in zip(pairs, parser.predict([p.utterance for p in pairs]), strict=True):
            said, meant = ranked[0].form, pair.form
            yield {
                "split": split,
                "part": part,
                "exact": 100.0 * (said == meant),
                "but for these": 100.0 * (blurred(said) == blurred(meant)),
            }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--splits", default="0", help="their numbers, separated by commas")
    parser.add_argument("--setting", default=SETTINGS[0], choices=SETTINGS)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        splits = [int(number) for number in given.splits.split(",")]
        table = pd.DataFrame(row for split in splits for row in answers(split, given.setting))
    by_part = table.groupby(["split", "part"], sort=False)
    print(by_part[["exact", "but for these"]].mean().assign(pairs=by_part.size()).round(1))


if __name__ == "__main__":
    main()
