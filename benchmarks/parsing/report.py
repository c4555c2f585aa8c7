"""How long the report of a run takes, and how much memory, with a million predictions.

    .venv/bin/python -m benchmarks.parsing.report [--examples 1000000] [--keep FOLDER] [--repeat 3]

Makes a world in a fresh installation: one run on a split whose validation part has the commands of the published 2018
generator, each with a word of its own, and first answers of which 80 % are right; the others are forms of other
commands, each with a proposed error category. Then writes the report in a process of its own and prints its size, the
seconds (wall and processor) and the peak memory. With ``--keep`` a folder that holds the installation is used again.
"""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.fresh_site import ROOT, WORLD, Site

RIGHT = 0.8
AT_ONCE = 20_000
EPOCHS = 30


def fill(examples: int) -> None:
    """Fill the installation that this process has entered."""
    from django.db import connection, transaction

    from annotations.models import World

    world = World.objects.get(name=WORLD)
    commands = list(
        world.commands.values_list("anonymized_text", "logical_form__text", "task_category")
    )
    run = make_run(world)
    store_scores(run, examples, sum(is_right for *_, is_right in answered(commands, examples)))
    tables = (
        ("annotations_example", EXAMPLE, example_rows(run.split_id, commands, examples)),
        ("parser_service_prediction", PREDICTION, prediction_rows(run.pk, commands, examples)),
        (
            "parser_service_review",
            REVIEW,
            review_rows(run.pk, category_of(world), commands, examples),
        ),
    )
    with transaction.atomic(), connection.cursor() as cursor:
        for table, columns, rows in tables:
            insert(cursor, table, columns, rows)
    with connection.cursor() as cursor:
        cursor.execute("ANALYZE")


def make_run(world: Any) -> Any:
    """Return a run that has succeeded, on a split without examples."""
    from django.utils import timezone

    from annotations.models import Split
    from annotations.models.background import Status
    from parser_service.models import TrainingRun

    split = Split.objects.create(
        world=world, name="large", criterion="command", seed=0, content_hash="0" * 64
    )
    return TrainingRun.objects.create(
        world=world,
        split=split,
        parser="seq2seq",
        parser_version=1,
        protocol="strict",
        train_sources="gen+para",
        content_key="0" * 64,
        status=Status.SUCCEEDED,
        finished_at=timezone.now(),
    )


def store_scores(run: Any, examples: int, correct: int) -> None:
    from parser_service.models import EpochMetric, Evaluation

    scores = {"accuracy": correct / examples, "interval_low": 0.79, "interval_high": 0.81}
    counts = {"count": examples, "correct": correct, "equivalent": 0.8, "well_formed": 1}
    Evaluation.objects.create(run=run, test_source="gen", part="validation", **scores, **counts)
    EpochMetric.objects.bulk_create(
        EpochMetric(run=run, epoch=each, train_loss=2 / each, validation_loss=3 / each, seconds=1)
        for each in range(1, EPOCHS + 1)
    )


EXAMPLE = {
    **dict.fromkeys(("source_command", "written_form", "grounded_form"), ""),
    **{"part": "validation", "source": "generated"},
}
PREDICTION = {
    **{"rank": 1, "is_well_formed": True, "answer_in_training": 8, "label_in_training": 8},
    **{"origin": "", "score_parts": "{}"},
}
REVIEW = {
    **{"is_proposed": True, "answer": "", "note": "", "reason": "It goes by the difference."},
    **{"created_at": "2026-01-01 00:00:00", "changed_at": "2026-01-01 00:00:00"},
}


def category_of(world: Any) -> int:
    from parser_service.models import ErrorCategory

    made, _ = ErrorCategory.objects.get_or_create(
        world=world, code="wrong_predicate", defaults={"name": "Wrong predicate", "position": 0}
    )
    return int(made.pk)


def answered(
    commands: list[tuple[str, str, str]], examples: int
) -> Iterator[tuple[int, str, str, str, str, bool]]:
    """Yield key, utterance, label, task category, answer and whether it is right, the same at each call."""
    chance = random.Random(1)
    for key in range(1, examples + 1):
        text, label, category = commands[key % len(commands)]
        answer = label if chance.random() < RIGHT else chance.choice(commands)[1]
        yield key, f"{text} w{key}", label, category, answer, answer == label


def example_rows(split: int, commands: Any, examples: int) -> Iterator[dict[str, Any]]:
    from annotations.models.splits import shape_of

    for key, text, label, category, *_ in answered(commands, examples):
        head, depth = shape_of(label)
        yield {
            **{"id": key, "split_id": split, "position": key, "utterance": text},
            **{"task_category": category, "logical_form": label},
            **{"head_predicate": head, "depth": depth, "word_count": len(text.split())},
        }


def prediction_rows(run: int, commands: Any, examples: int) -> Iterator[dict[str, Any]]:
    chance = random.Random(2)
    for key, _, _, _, answer, is_right in answered(commands, examples):
        yield {
            **{"run_id": run, "example_id": key, "logical_form": answer},
            **{"is_exact_match": is_right, "is_equivalent": is_right, "score": -chance.random()},
        }


def review_rows(run: int, category: int, commands: Any, examples: int) -> Iterator[dict[str, Any]]:
    for key, *_, is_right in answered(commands, examples):
        if not is_right:
            yield {"run_id": run, "example_id": key, "category_id": category}


def insert(cursor: Any, table: str, same: dict[str, Any], rows: Iterator[dict[str, Any]]) -> None:
    """Insert rows, whose other columns are the ``same`` in all of them."""
    first = next(rows)
    names = [*same, *first]
    places = ", ".join(["%s"] * len(names))
    statement = f"INSERT INTO {table} ({', '.join(names)}) VALUES ({places})"
    batch = [(*same.values(), *first.values())]
    for row in rows:
        batch.append((*same.values(), *row.values()))
        if len(batch) == AT_ONCE:
            cursor.executemany(statement, batch)
            batch = []
    cursor.executemany(statement, batch)


def write(target: Path) -> None:
    """Write the report of the only run to ``target``: what the measured process does."""
    from parser_service.models import TrainingRun
    from parser_service.reviews.run_report import part_of, run_report

    run = TrainingRun.objects.select_related("split", "world", "created_by").get(
        split__name="large"
    )
    with target.open("w", encoding="utf-8") as file:
        file.writelines(run_report(run, part_of(run) or ""))


def measure(site: Site, target: Path) -> dict[str, float]:
    """Write the report in a process of its own, which has to stay small until then."""
    began = time.perf_counter()
    child = subprocess.Popen(
        [sys.executable, "-m", "benchmarks.parsing.report", "--write", str(target)],
        env=site.environment,
        cwd=ROOT,
    )
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return {
        "status": child.returncode,
        "wall_seconds": round(time.perf_counter() - began, 1),
        "processor_seconds": round(usage.ru_utime + usage.ru_stime, 1),
        "peak_mib": round(usage.ru_maxrss / 1024),
        "file_mib": round(target.stat().st_size / 2**20, 1),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--examples", type=int, default=1_000_000)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--write", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--fill", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.write or options.fill:
        os.environ["DJANGO_SETTINGS_MODULE"] = "gpsr_site.settings"
        sys.path.insert(0, str(ROOT))
        import django

        django.setup()
        fill(options.fill) if options.fill else write(options.write)
        return
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        is_there = (folder / "db.sqlite3").exists()
        folder.mkdir(parents=True, exist_ok=True)
        site = Site(folder)
        if not is_there:
            site.import_world()
            site.run("generate_pairs", WORLD)
            filler = [
                sys.executable,
                "-m",
                "benchmarks.parsing.report",
                "--fill",
                str(options.examples),
            ]
            subprocess.run(filler, env=site.environment, cwd=ROOT, check=True)
        for _ in range(options.repeat):
            print(measure(site, folder / "report.html"), flush=True)


if __name__ == "__main__":
    main()
