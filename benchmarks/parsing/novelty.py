"""The threshold by which new forms have to fit better than known ones: accuracy for several values.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.novelty [--splits 1,2,4,5] [--setting para-para]

Trains the ranker (domain, seed 0) on new splits by source command, a few minutes each, and parses the
paraphrases of the test parts. Then raises the threshold by some nats, or lowers it (below 0). Prints for each
change the share of new forms among the answers, and exact match, in %.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

from benchmarks.parsing.new_splits import Trained, table_of

MOVES = [step / 2 for step in range(-6, 7)]  # nats
EVERY_FORM = sys.maxsize  # answers to an utterance


def answers(trained: Trained) -> Iterator[dict[str, float]]:
    """Yield for every test paraphrase and every change whether the answer is a new form, and whether it is
    right."""
    pairs = trained.held_out["test"]
    ranked_answers = trained.parser.predict([pair.utterance for pair in pairs], EVERY_FORM)
    for pair, ranked in zip(pairs, ranked_answers, strict=True):
        for move in MOVES:
            best = max(
                ranked, key=lambda each: each.score - move * (each.form not in trained.known)
            )
            yield {
                "move": move,
                "new": 100.0 * (best.form not in trained.known),
                "exact": 100.0 * (best.form == pair.form),
            }


def main() -> None:
    table = table_of(__doc__.partition("\n")[0], "1,2,4,5", answers)
    by_move = table.groupby("move")[["new", "exact"]].mean()
    exact = table.pivot_table(index="move", columns="split", values="exact").add_prefix("split ")
    print(by_move.join(exact).round(1).to_string())


if __name__ == "__main__":
    main()
