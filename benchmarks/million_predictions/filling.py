"""Fill an installation with a split of many examples, its runs, and what is said of their errors."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from typing import Any

from benchmarks.fresh_site import WORLD

RUNS = 5
PARSERS_OF_RUNS = ("knn", "seq2seq", "ranker", "seq2seq", "ranker")
ACCURACIES = (0.6, 0.7, 0.8, 0.86, 0.92)
TRAINING = 0.25  # training examples, as a share of the test examples
AT_ONCE = 5_000
SLICES = {
    "Short errors": "outcome=wrong&max_words=6",
    "Long utterances": "min_words=12",
    "Deep forms": "min_depth=4",
    "Form not in training": "label=new",
    "Malformed answers": "outcome=malformed",
    "Navigation": "head=go",
    "Something is brought": "head=bring&source=paraphrased",
    "Taken for a delivery": "answer_head=bring&outcome=wrong",
}


def fill(examples: int) -> None:
    """Fill the database of the environment with a split, its runs and what is said of their errors."""
    import django

    django.setup()
    from django.db import connection, transaction

    from annotations.generation.generating import generate_pairs
    from annotations.models import Split, User, World
    from parser_service.models import Slice

    world = World.objects.get(name=WORLD)
    generate_pairs(world)
    User.objects.create_superuser("root", password="a password for the benchmark")
    commands = list(world.commands.select_related("logical_form"))
    with transaction.atomic():
        split = Split.objects.create(
            world=world, name="large", criterion="command", content_hash="0" * 64, seed=0
        )
        store_examples(split, "test", commands, examples)
        store_examples(split, "train", commands, round(TRAINING * examples))
        for name, query in SLICES.items():
            Slice.objects.create(world=world, name=name, query=query)
    tested = split.examples.filter(part="test").order_by("pk")
    keys = list(tested.values_list("pk", "logical_form"))
    forms = sorted({form for _, form in keys})
    for number in range(RUNS):
        with transaction.atomic():
            store_run(split, number, keys, forms)
        print(f"run {number + 1} is stored", flush=True)
    analyse(split)
    with connection.cursor() as cursor:
        if connection.vendor == "postgresql":
            cursor.execute("VACUUM ANALYZE")  # what autovacuum does within minutes


def analyse(split: Any) -> None:
    """Let the analyses of a whole part be stored, as a worker does."""
    from annotations.background.progress import UNWATCHED
    from parser_service.reviews.analysis_job import OF_PARTS
    from parser_service.reviews.stored_findings import keep_finding
    from parser_service.reviews.target import Target

    for run in split.runs.all():
        target = Target(run, "test")
        for step in OF_PARTS:
            began = time.process_time()
            keep_finding(run, "test", step.name, step.find(target, UNWATCHED), UNWATCHED)
            used = time.process_time() - began
            print(f"{step.name} of run {run.pk}: {used:.1f} s of processor time", flush=True)


def store_examples(split: Any, part: str, commands: list[Any], count: int) -> None:
    """Store examples of a part: commands with a word of their own."""
    from annotations.models import Example

    dice = random.Random(part)
    for numbers in batches(range(count)):
        rows = []
        for number in numbers:
            command = dice.choice(commands)
            rows.append(
                Example(
                    split=split,
                    position=number,
                    part=part,
                    source="generated" if number % 3 else "paraphrased",
                    utterance=f"{command.anonymized_text} w{number % 5000}",
                    source_command=command.anonymized_text,
                    task_category=command.task_category,
                    logical_form=command.logical_form.text,
                )
            )
        Example.objects.bulk_create(rows)


def store_run(split: Any, number: int, keys: list[tuple[int, str]], forms: list[str]) -> None:
    """Store a run with its first answers and a proposed category for each wrong one."""
    from parser_service.models import Prediction, Review
    from parser_service.reviews.world_categories import ensure_categories

    dice, share = random.Random(number + 1), ACCURACIES[number]
    run = make_run(split, number)
    categories = list(ensure_categories(split.world).values())
    correct = 0
    for some in batches(keys):
        rows = [predict(run, key, form, forms, dice, share) for key, form in some]
        Prediction.objects.bulk_create(rows)
        wrong = [row for row in rows if not row.is_exact_match]
        correct += len(rows) - len(wrong)
        Review.objects.bulk_create(
            Review(
                run=run,
                example_id=row.example_id,
                category=dice.choice(categories),
                is_proposed=True,
                answer=row.logical_form,
                reason="generated",
            )
            for row in wrong
        )
    store_scores(run, len(keys), correct)


def make_run(split: Any, number: int) -> Any:
    from django.utils import timezone

    from parser_service.models import TrainingRun
    from parser_service.parsers.registry import parsers

    parser = PARSERS_OF_RUNS[number]
    return TrainingRun.objects.create(
        world=split.world,
        split=split,
        parser=parser,
        parser_version=parsers()[parser].version,
        protocol="strict",
        train_sources="gen+para",
        seed=number,
        content_key=f"{number:064}",
        status="succeeded",
        finished_at=timezone.now(),
    )


def store_scores(run: Any, count: int, correct: int) -> None:
    from parser_service.models import Evaluation

    share = correct / count
    for source in ("mixed", "gen", "para"):
        Evaluation.objects.create(
            run=run,
            test_source=source,
            part="test",
            count=count,
            correct=correct,
            accuracy=share,
            interval_low=share - 0.01,
            interval_high=share + 0.01,
            equivalent=share,
            well_formed=0.98,
        )


def predict(
    run: Any, key: int, label: str, forms: list[str], dice: random.Random, share: float
) -> Any:
    """Return a first answer: right, a default form, another form, no form or none."""
    from parser_service.models import Prediction

    luck = dice.random()
    if luck < share:
        answer = label
    elif luck < share + 0.01:
        answer = dice.choice(["", "( bring ( lambda"])
    else:
        answer = forms[0] if luck > 0.97 else dice.choice(forms)
    is_form = answer.endswith(")") or answer == "UNKNOWN"
    return Prediction(
        run=run,
        example_id=key,
        rank=1,
        logical_form=answer,
        score=dice.random(),
        is_exact_match=answer == label,
        is_equivalent=answer == label,
        is_well_formed=is_form,
        answer_in_training=len(answer) % 7,
        label_in_training=len(label) % 5,
    )


def batches(rows: Any) -> Iterator[Any]:
    for start in range(0, len(rows), AT_ONCE):
        yield rows[start : start + AT_ONCE]
