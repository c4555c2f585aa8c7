"""Seconds that each analysis takes for a million generated predictions.

    python -m benchmarks.analysis [--predictions 1000000] [--only attractors]

Commands and forms are those of the starter world. Every command gets a word of its own, so that texts differ;
four answers of five are right, some are a default form, and the rest are forms of other commands.
"""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Callable, Sequence

import numpy as np

from annotations.language.forms import read_form
from annotations.language.templates import generate, read_generator_folder
from annotations.language.world import Ontology, infer_signatures
from benchmarks.fresh_site import ROOT
from parser_service.analysis.all_edits import generate_edits
from parser_service.analysis.attractors import find_attractors
from parser_service.analysis.category_proposals import propose_category
from parser_service.analysis.comparing import compare_runs
from parser_service.analysis.confusions import confuse_heads, confuse_slots
from parser_service.analysis.encoded_labels import encode
from parser_service.analysis.error_evidence import RunEvidence
from parser_service.analysis.facts import gather_facts
from parser_service.analysis.mining import mine_pairs
from parser_service.analysis.outcomes import MOST_CLUSTERS
from parser_service.analysis.probe_texts import make_probes
from parser_service.analysis.risk_coverage import risk_coverage
from parser_service.analysis.sensitivity import (
    EditAnswers,
    find_deciding_words,
    measure_sensitivity,
)
from parser_service.analysis.slicing import (
    accuracy_of_labels,
    head_predicates,
)

RUNS = 5


class AnalysedData:
    """Predictions of five runs for commands of the starter world."""

    def __init__(self, count: int) -> None:
        self.categories = read_generator_folder(
            ROOT / "annotations" / "starter" / "household"
        ).categories()
        expansions = generate(self.categories).expansions
        self.commands = [each.command for each in expansions]
        self.forms = [each.form_text for each in expansions]
        random = np.random.default_rng(0)
        drawn = random.integers(len(expansions), size=count)
        self.utterances = [
            f"{self.commands[place]} w{number % 5000}"
            for number, place in enumerate(drawn.tolist())
        ]
        self.gold = [self.forms[place] for place in drawn.tolist()]
        luck, others = random.random(count), random.integers(len(expansions), size=count)
        answers = np.where(luck < 0.8, drawn, np.where(luck < 0.9, 0, others))
        self.predicted = [self.forms[place] for place in answers.tolist()]
        self.clusters = drawn % MOST_CLUSTERS
        self.correct = random.random((RUNS, count)) < np.linspace(0.7, 0.9, RUNS)[:, None]
        self.scores = random.random(count)
        pairs = set(zip(self.gold, self.predicted, strict=True))
        self.errors = [pair for pair in pairs if pair[0] != pair[1]]

    def slice_by(self, labels: Sequence[object]) -> None:
        accuracy_of_labels(self.correct, encode(labels), self.clusters)


def tasks(world: AnalysedData) -> dict[str, Callable[[], object]]:
    right = world.correct[0]
    return {
        "comparing": lambda: compare_runs(world.correct, world.clusters),
        "slicing: head predicate": lambda: world.slice_by(head_predicates(world.gold)),
        "confusions: heads": lambda: confuse_heads(
            *(encode(head_predicates(forms)) for forms in (world.gold, world.predicted))
        ),
        "confusions: slots": lambda: confuse_slots(world.gold, world.predicted),
        "attractors": lambda: find_attractors(world.utterances, world.gold, world.predicted),
        "risk and coverage": lambda: risk_coverage(world.scores, right).at(0.5),
        "edits: mining": lambda: mine_pairs(world.utterances),
        f"edits: generating for {len(world.commands):,}": lambda: edit(world),
        "sensitivity": lambda: measure(world),
        "deciding words": lambda: find_deciding_words(
            [text.partition(" ")[0] for text in world.utterances], right
        ),
        "probing": lambda: make_probes(world.utterances, 200),
        "categories": lambda: propose(world),
    }


def propose(world: AnalysedData) -> None:
    evidence = RunEvidence(attractors=frozenset({world.forms[0]}))
    for label, answer in world.errors:
        propose_category(read_form(label), read_form(answer), evidence)


def edit(world: AnalysedData) -> None:
    known = list(zip(world.commands, map(read_form, world.forms), strict=True))
    grammars = [category.grammar for category in world.categories]
    predicates = infer_signatures(form for _, form in known)
    facts = gather_facts(Ontology(), grammars, known, predicates)
    for utterance, form in known:
        generate_edits(utterance, form, facts)


def measure(world: AnalysedData) -> None:
    count = len(world.gold)
    kinds = [("article", "entity", "place")[number % 3] for number in range(count)]
    bases = [number // 4 for number in range(count)]
    after = world.predicted[1:] + world.predicted[:1]
    measure_sensitivity(EditAnswers(kinds, bases, world.predicted, after, world.gold, world.gold))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--predictions", type=int, default=1_000_000)
    parser.add_argument("--only", default="", help="measure what has this in its name")
    arguments = parser.parse_args()
    world = AnalysedData(arguments.predictions)
    print(
        f"{arguments.predictions:,} predictions, {len(set(world.utterances)):,} texts, "
        f"{len(set(world.forms)):,} forms, {len(world.errors):,} distinct errors"
    )
    for name, task in tasks(world).items():
        if arguments.only in name:
            began = time.process_time()
            task()
            print(f"{name:40} {time.process_time() - began:8.2f} s", flush=True)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"most memory: {peak:,.0f} MiB")


if __name__ == "__main__":
    main()
