"""How many of the ranker's errors by source command are distinctions that paraphrases rarely keep.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.confusions [--splits 1,5] [--setting para-para]

Trains the ranker (domain, seed 0) on new splits by source command, a few minutes each, and parses the
paraphrases of the other two parts. Prints for each part exact match, and exact match without three
distinctions: an open category ("objects") or none, biggest or largest, and an explicit ``and`` or none.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from benchmarks.parsing.new_splits import Trained, table_of

CATEGORY = re.compile(r'\( is_a \$\d " <category> " \)')


def blur(form: str) -> str:
    """Return the words of a form without the three distinctions."""
    text = CATEGORY.sub("", form).replace("( biggest ", "( largest ").replace("( and ", "")
    return " ".join(re.sub(r"[()]", " ", text).split())


def rows_of(trained: Trained) -> Iterator[dict[str, object]]:
    """Yield for every held-out paraphrase its part, whether the answer is right, and whether it is right
    without the three distinctions."""
    for part, pairs in trained.held_out.items():
        answers = trained.parser.predict([pair.utterance for pair in pairs])
        for pair, ranked in zip(pairs, answers, strict=True):
            answered, annotated = ranked[0].form, pair.form
            yield {
                "part": part,
                "exact": 100.0 * (answered == annotated),
                "without these": 100.0 * (blur(answered) == blur(annotated)),
            }


def main() -> None:
    table = table_of(__doc__.partition("\n")[0], "0", rows_of)
    by_part = table.groupby(["split", "part"], sort=False)
    print(by_part[["exact", "without these"]].mean().assign(pairs=by_part.size()).round(1))


if __name__ == "__main__":
    main()
