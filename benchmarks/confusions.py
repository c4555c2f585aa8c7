"""How many of the ranker's errors by source command are distinctions that paraphrases seldom keep.

    GPSR_SHARED_DATA=… .venv/bin/python benchmarks/confusions.py [--splits 1,5] [--setting para-para]

Trains the ranker (domain, seed 0) on new splits by source command, a few minutes each, and asks it for the
paraphrases of the other two parts. Three distinctions are set apart: an open category ("objects") or none,
biggest or largest, and an explicit ``and`` or none. By part: exact match, and exact match but for these.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from new_splits import Trained, table_of

CATEGORY = re.compile(r'\( is_a \$\d " <category> " \)')


def blurred(form: str) -> str:
    """The words of a form without the three distinctions."""
    text = CATEGORY.sub("", form).replace("( biggest ", "( largest ").replace("( and ", "")
    return " ".join(re.sub(r"[()]", " ", text).split())


def answers(trained: Trained) -> Iterator[dict[str, object]]:
    """Every held-out paraphrase: its part, whether the answer is right, and whether it is but for the
    three distinctions."""
    for part, pairs in trained.held_out.items():
        found = trained.parser.predict([pair.utterance for pair in pairs])
        for pair, ranked in zip(pairs, found, strict=True):
            said, meant = ranked[0].form, pair.form
            yield {
                "part": part,
                "exact": 100.0 * (said == meant),
                "but for these": 100.0 * (blurred(said) == blurred(meant)),
            }


def main() -> None:
    table = table_of(__doc__.partition("\n")[0], "0", answers)
    by_part = table.groupby(["split", "part"], sort=False)
    print(by_part[["exact", "but for these"]].mean().assign(pairs=by_part.size()).round(1))


if __name__ == "__main__":
    main()
