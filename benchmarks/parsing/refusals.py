"""What a ranker does not answer: texts that are no command, and right answers that it withholds.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.refusals [--saved FOLDER]

Trains on the generated and paraphrased commands of the published split by command, under *strict*, or takes a
saved parser. Asks it as it is served the validation paraphrases and the texts of ``out_of_scope``: empty,
foreign and unrelated ones. The bound is chosen on validation utterances alone; ``chosen_with.txt`` is for
comparing scores that a bound may be set on, ``asked.txt`` for the figure. Prints for each score the share of the
texts that stay answered where at most 5 % of the right answers are withheld.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.fresh_site import DATA, Site

if TYPE_CHECKING:  # the project can be imported only after a site was entered
    from parser_service.neural.ranker.form_ranker import FormRanker
    from parser_service.parsers.interface import Pair

FOLDER = Path(__file__).parent / "out_of_scope"
EMPTY = {"(nothing)": "", "(blank)": "   "}
MOST_ANSWERED = 5
WITHHELD = 0.05


def read_texts(name: str) -> list[str]:
    lines = (FOLDER / f"{name}.txt").read_text(encoding="utf-8").splitlines()
    return [EMPTY.get(line, line) for line in lines]


def scores_of(parser: FormRanker, texts: Sequence[str]) -> dict[str, list[float]]:
    """Return the scores that a bound may be set on: how near something is, and the probability of the best form."""
    scores = parser._model_or_refuse().scores(texts, lambda: None)
    best = parser._decision.log_probabilities(scores).amax(-1)
    nearest = scores.known[0].amax(-1)
    return {
        "nearness of examples and glosses": scores.nearness.tolist(),
        "nearness of examples": nearest.tolist(),
        "log-probability": best.tolist(),
    }


def answered(parser: FormRanker, texts: Sequence[str]) -> int:
    return sum(ranked[0].form != "UNKNOWN" for ranked in parser.predict(texts))


def report(parser: FormRanker, validation: Sequence[Pair]) -> bool:
    """Print the figures; return whether few enough of the texts are answered."""
    said = [pair.utterance for pair in validation]
    forms = [ranked[0].form for ranked in parser.predict(said)]
    right = [
        text for text, form, pair in zip(said, forms, validation, strict=True) if form == pair.form
    ]
    of_right, of_others = scores_of(parser, right), scores_of(parser, read_texts("chosen_with"))
    for name, values in of_right.items():
        bound = sorted(values)[int(WITHHELD * len(values))]
        left = sum(value >= bound for value in of_others[name])
        print(f"{left:3d} of {len(of_others[name])} answered by the {name} (bound {bound:.2f})")
    served = parser.hesitant()
    others = answered(served, read_texts("asked"))
    withheld = len(right) - answered(served, right)
    print(
        f"as served: {others} of {len(read_texts('asked'))} texts answered (bound {MOST_ANSWERED}); "
        f"{withheld} of {len(right)} right answers withheld ({100 * withheld / len(right):.1f} %)"
    )
    return others <= MOST_ANSWERED


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--saved", type=Path, help="folder of a saved parser under strict")
    saved = arguments.parse_args().saved
    with tempfile.TemporaryDirectory() as folder:
        Site(Path(folder) / "var").enter()
        from parser_service.benchmarking.corpus import read_corpus
        from parser_service.neural.ranker.form_ranker import FormRanker

        corpus, sources = read_corpus(DATA / "walker2019", "command"), ("generated", "paraphrased")
        if saved:
            parser = FormRanker.load(saved)
        else:
            parser = FormRanker()
            parser.fit(corpus.pairs("train", sources), corpus.pairs("validation", sources))
        held = report(parser, corpus.pairs("validation", ["paraphrased"]))
    if not held:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
