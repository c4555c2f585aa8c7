"""walker2019 or a cut of it in a world, with three parsers trained on it."""

from __future__ import annotations

import os
from pathlib import Path

from annotations.background.progress import UNWATCHED
from annotations.exchange.generator_import import import_generator
from annotations.exchange.pair_import import import_pairs
from annotations.generation.generating import generate_pairs
from annotations.models import Example, Split, World
from annotations.rows.occurrences import paraphrase_of_example
from parser_service.models import TrainingRun
from parser_service.reviews.category_proposals import propose_for_run
from tests.parser_service.made_up import TINY
from tests.parser_service.neural.tiny_encoder import write_tiny_encoder
from tests.parser_service.runs.test_train_run import trained

IS_FULL = os.environ.get("TEST_WALK") == "full"
UNKNOWN = "UNKNOWN"
PAIRS = {"train": 80, "val": 24}  # of a cut, from each file
PAIR, TRIPLE = 2, 3  # lines


def train_three(world: World, published: Path, folder: Path) -> list[TrainingRun]:
    """Bring the corpus into ``world`` and return runs of seq2seq, knn and the ranker on its split by command.

    They are trained as by default where ``TEST_WALK`` is full, else on the shortest pairs and tiny.
    """
    assert not import_generator(world.name, published / "generator-2018").is_refused
    generate_pairs(world)
    pairs = published / "walker2019"
    report = import_pairs(world.name, "walker2019", pairs if IS_FULL else cut(pairs, folder))
    assert not report.is_refused
    split = Split.objects.get(world=world, criterion="command")
    configs = (
        {name: {} for name in ("seq2seq", "knn", "ranker")} if IS_FULL else tiny(split, folder)
    )
    runs = [
        trained(split, name, config=config, train_sources="gen+para", anywhere=True)
        for name, config in configs.items()
    ]
    assert {run.status for run in runs} == {"succeeded"}
    world.jobs.all().delete()  # the analysis of their errors; what it proposes is made here
    for run in runs:
        propose_for_run(run, frozenset(), UNWATCHED)
    return runs


def cut(published: Path, folder: Path) -> Path:
    """Copy the first pairs of each split, and where these paraphrases come from. Returns the folder."""
    said = set()
    for source in ("gen", "para", "gen_logical", "para_logical"):
        (folder / source).mkdir(parents=True)
        for part, most in PAIRS.items():
            lines = _lines(published / source / f"{part}.txt")[: PAIR * most]
            (folder / source / f"{part}.txt").write_text("".join(lines), encoding="utf-8")
            said.update(lines[::PAIR])
    lines = iter(_lines(published / "paraphrasings.txt"))
    triples = zip(*[lines] * TRIPLE, strict=True)
    kept = ["".join(triple) for triple in triples if triple[0] in said]
    (folder / "paraphrasings.txt").write_text("".join(kept), encoding="utf-8")
    return folder


def tiny(split: Split, folder: Path) -> dict[str, dict[str, object]]:
    """Return configurations that are trained in seconds."""
    words = {
        word for text in split.examples.values_list("utterance", flat=True) for word in text.split()
    }
    encoder = write_tiny_encoder(folder / "encoder", words)
    ranker = {"encoder": str(encoder), "steps": 20, "batch_size": 8, "threads": 1}
    return {"knn": {}, "seq2seq": {**TINY, "epochs": 3}, "ranker": ranker}


def doubtful(runs: list[TrainingRun]) -> tuple[Example, str]:
    """Return the first paraphrase whose label the most of ``runs`` contradict with one form, the first of
    them among these, and that form."""
    answers = [dict(run.predictions.best().values_list("example", "logical_form")) for run in runs]
    rows = runs[0].split.examples.filter(part="validation", source="paraphrased").order_by("pk")

    def support(example: Example) -> int:
        form = answers[0][example.pk]
        is_wrong = form not in (example.logical_form, UNKNOWN)
        if not is_wrong or paraphrase_of_example(example) is None:
            return 0
        return sum(each[example.pk] == form for each in answers)

    chosen = max(rows, key=support)
    assert support(chosen)
    return chosen, answers[0][chosen.pk]


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines(keepends=True)
