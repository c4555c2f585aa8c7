"""Runs whose parsers are saved and can be asked, made in milliseconds."""

from __future__ import annotations

from annotations.models import Entity, Ontology, Split, World
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.runs import Status
from parser_service.runs import run_requests
from parser_service.runs.checkpoints import model_folder, write_folder
from parser_service.runs.split_pairs import training_pairs
from parser_service.runs.train_run import make_parser
from tests.parser_service.made_up import make_split

THINGS = [("object", "red cup"), ("object", "bowl"), ("room", "kitchen"), ("location", "desk")]


def name_umbrella(world: World) -> None:
    """Give a world the thing of which the texts of the paper speak."""
    Entity.objects.create(
        ontology=world.ontology, entity_class="object", text="umbrella", position=99
    )


def make_home(world: World) -> Split:
    """Give ``world`` a few things and a split to train on."""
    ontology = Ontology.objects.create(world=world)
    for position, (kind, text) in enumerate(THINGS):
        Entity.objects.create(ontology=ontology, entity_class=kind, text=text, position=position)
    return make_split(world)


def trained_run(
    split: Split, seed: int = 0, spoken: float | None = 0.5, parser: str = "knn", **asked
) -> TrainingRun:
    """Train a parser, a nearest neighbour unless it is named; ``spoken`` is its accuracy on paraphrases,
    None where it was not asked."""
    run, _ = run_requests.request(split.world, split, parser, seed=seed, send=False, **asked)
    pairs = training_pairs(split, run.train_sources, run.train_share, run.seed)
    made = make_parser(run)
    made.fit(pairs)
    write_folder(model_folder(run.pk), made.save)
    TrainingRun.objects.filter(pk=run.pk).update(status=Status.SUCCEEDED, progress=1)
    if spoken is not None:
        score(run, spoken)
    run.refresh_from_db()
    return run


def score(run: TrainingRun, accuracy: float, source: str = "para") -> None:
    """Store how often ``run`` is right on validation pairs, of 100."""
    Evaluation.objects.create(
        run=run,
        test_source=source,
        part="validation",
        count=100,
        correct=round(100 * accuracy),
        accuracy=accuracy,
        interval_low=max(0.0, accuracy - 0.1),
        interval_high=min(1.0, accuracy + 0.1),
        equivalent=accuracy,
        well_formed=1,
    )
