"""The share of held-out forms that are among the candidates made from the training part.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.candidates [--splits 8]

Makes several new splits by form of the published train and validation pairs, and the candidates from each
training part. Prints for each protocol: the number of candidates per split; the share of the held-out
paraphrases whose form is a candidate; and by support, the number of forms made and the share of them that was
held out (is real).
"""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from benchmarks.fresh_site import DATA, WORLD, Site

HELD_OUT = ("validation", "test")


def support_of_forms(protocol: str, splits: int) -> Iterator[dict[str, object]]:
    """Yield every new form of every split: its support, and how many held-out paraphrases mean it.

    A held-out form that no step arrives at has support 0.
    """
    from annotations.models import World
    from parser_service.benchmarking.corpus import new_split
    from parser_service.parsers.generation import reach
    from parser_service.runs.knowledge import knowledge_of

    knowledge = knowledge_of(World.objects.get(name=WORLD), protocol)
    for seed in range(splits):
        corpus = new_split(DATA / "walker2019", "logical_form", seed)
        pairs = corpus.pairs("train", ("generated", "paraphrased"))
        training = {pair.form for pair in pairs}
        held = [pair for part in HELD_OUT for pair in corpus.pairs(part, ["paraphrased"])]
        meant = Counter(pair.form for pair in held)
        support = dict.fromkeys(meant, 0)
        for candidate in reach(pairs, knowledge).candidates():
            if candidate.form not in training:
                support[candidate.form] = candidate.support
        for form, number in support.items():
            yield {"support": number, "pairs": meant[form]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--splits", type=int, default=8)
    splits = parser.parse_args().splits
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        for protocol in ("strict", "domain"):
            report(protocol, pd.DataFrame(support_of_forms(protocol, splits)), splits)


def report(protocol: str, forms: pd.DataFrame, splits: int) -> None:
    from parser_service.neural.ranker.ranked_forms import MOST_SUPPORT
    from parser_service.parsers.pool import SURE

    kept = forms[forms["support"] >= SURE]
    covered = 100 * kept["pairs"].sum() / forms["pairs"].sum()
    print(
        f"\n{protocol}: {len(kept) / splits:.0f} candidates per split, which include the form of {covered:.1f} % "
        f"of the held-out paraphrases ({splits} splits by form)"
    )
    reached = forms[forms["support"] > 0]
    by_support = reached.groupby(reached["support"].clip(upper=MOST_SUPPORT))["pairs"]
    table = pd.DataFrame(
        {
            "forms per split": by_support.size() / splits,
            "real, %": 100 * by_support.agg(lambda meant: (meant > 0).mean()),
            "of the paraphrases, %": 100 * by_support.sum() / forms["pairs"].sum(),
        }
    )
    print(table.rename(index={MOST_SUPPORT: f"{MOST_SUPPORT} or more"}).round(1).to_string())


if __name__ == "__main__":
    main()
