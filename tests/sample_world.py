"""A world with one of everything in it, small enough to read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from annotations.exchange.generator_import import import_generator
from annotations.generation.generating import generate_pairs
from annotations.models import (
    Comment,
    EntityClass,
    Example,
    Guidelines,
    LogicalForm,
    Paraphrase,
    Primitive,
    SemanticTemplate,
    Split,
    World,
)
from parser_service.analysis.outcomes import outcomes_of
from parser_service.analysis.scores import Judgement
from parser_service.models import EpochMetric, Evaluation, Prediction, TrainingRun
from parser_service.models.runs import Status
from parser_service.runs import run_requests
from parser_service.runs.split_pairs import cluster_of
from tests.annotations.conftest import TINY, as_bytes
from tests.parser_service.made_up import make_split


@dataclass(frozen=True)
class SampleWorld:
    """``world`` and something of every kind in it; ``run`` has succeeded and has been scored."""

    world: World
    template: SemanticTemplate
    form: LogicalForm
    split: Split
    run: TrainingRun
    example: Example


def fill_world(world: World) -> SampleWorld:
    """Put something of every kind into an empty world."""
    assert not import_generator(world.name, as_bytes(TINY)).is_refused
    generate_pairs(world)
    split = make_split(world, f"{world.name}-split")
    run = scored_run(world, split)
    return SampleWorld(
        world=world,
        template=SemanticTemplate.objects.filter(grammar__world=world).first(),
        form=world.logical_forms.first(),
        split=split,
        run=run,
        example=run.predictions.first().example,
    )


def scored_run(
    world: World, split: Split, parser: str = "knn", right: int = 3, seed: int = 0
) -> TrainingRun:
    """Store a run that succeeded and predicted the first ``right`` validation examples correctly."""
    run, _ = run_requests.request(world, split, parser, seed=seed, send=False)
    TrainingRun.objects.filter(pk=run.pk).update(status=Status.SUCCEEDED, progress=1)
    examples = list(split.examples.filter(part="validation"))
    clusters = [cluster_of(example, split.criterion) for example in examples]
    judgements = [Judgement(n < right, n < right, True, n < right) for n in range(len(examples))]
    for number, example in enumerate(examples):
        answer(run, example, example.logical_form if number < right else '( go " <room> " )')
    Evaluation.objects.create(
        run=run,
        test_source="gen",
        part="validation",
        count=len(examples),
        correct=right,
        accuracy=right / len(examples),
        interval_low=0.1,
        interval_high=0.6,
        equivalent=right / len(examples),
        well_formed=1,
        same_plan=right / len(examples),
        outcomes=outcomes_of(clusters, judgements),
    )
    EpochMetric.objects.create(
        run=run, epoch=1, train_loss=2.5, validation_loss=2.0, validation_accuracy=0.25, seconds=1
    )
    run.refresh_from_db()
    return run


def answer(run: TrainingRun, example: Example, form: str) -> Prediction:
    """Store the run's first-ranked candidate for ``example``."""
    is_right = form == example.logical_form
    return Prediction.objects.create(
        run=run,
        example=example,
        rank=1,
        logical_form=form,
        score=0.5,
        is_exact_match=is_right,
        is_equivalent=is_right,
        is_well_formed=True,
        is_same_plan=is_right,
    )


def paraphrase_in(world: World) -> Paraphrase:
    """Return the first paraphrase of ``world``, made where there is none: a sample world brings none."""
    return world.paraphrases.first() or make_paraphrase(
        world, grounded_form="go", logical_form="go"
    )


def guidelines_in(world: World) -> Guidelines:
    """Return the guidelines of ``world``, made where there are none: a sample world brings none."""
    return Guidelines.objects.get_or_create(world=world, defaults={"text": "Say bring."})[0]


def own_class_in(world: World) -> EntityClass:
    """Return a class of ``world`` that not every world has, made where there is none."""
    words = {"singular": "pose", "plural": "poses", "said": "pose", "hue": 20, "position": 90}
    return EntityClass.objects.get_or_create(world=world, token="pose", defaults=words)[0]


def unused_primitive_in(world: World) -> Primitive:
    """Return a primitive of ``world`` that no recipe uses, the last one, made where there is none."""
    columns = Primitive.columns_of('dance() "dance"')
    return Primitive.objects.get_or_create(
        world=world, name=columns["name"], defaults={**columns, "position": 990}
    )[0]


def comment_in(world: World) -> Comment:
    """Return a comment in ``world``, made where there is none, by nobody of its members."""
    template = world.grammar.templates.first()
    about = {"kind": "template", "subject": template.pk, "about": str(template)}
    return Comment.objects.get_or_create(world=world, text="Hm.", **about)[0]


def make_paraphrase(
    world: World, prompt: str = "go", utterance: str = "go", **columns: Any
) -> Paraphrase:
    """Store an accepted paraphrase of ``prompt``, after those of the world; ``columns`` says what else it has."""
    defaults = {"edit_distance": 1, "jaccard_distance": 0.5, "position": world.paraphrases.count()}
    return Paraphrase.objects.create(
        world=world, prompt=prompt, utterance=utterance, **{**defaults, **columns}
    )
