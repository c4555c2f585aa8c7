"""How long the pages of the error analysis take with a million predictions.

    .venv/bin/python -m benchmarks.million_predictions [--examples 200000] [--requests 50] [--keep FOLDER]
        [--database postgres://postgres@127.0.0.1:5432/million] [--only compare]

Makes a world in a fresh installation: five runs of one split with 200,000 test examples, whose utterances and forms
are those of the published 2018 generator with a word of their own, first answers of which 60 to 92 % are right, and
a proposed error category for each wrong one. Then requests each page of ``PAGES`` 50 times through Django's test
client, each time with other filters, runs or places in the list, and prints the median and the 95th percentile of
the wall time in milliseconds, the slowest request, the same of the processor time of this process (on SQLite the whole
cost, on a machine that does something else as well), and its peak memory.

On PostgreSQL the database is made, and dropped in the end unless ``--keep`` is given. With ``--keep`` a folder that
holds an installation already is measured as it is.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.fresh_site import DATA, ROOT, WORLD, Site

RUNS = 5
PARSERS_OF_RUNS = ("knn", "seq2seq", "ranker", "seq2seq", "ranker")
ACCURACIES = (0.6, 0.7, 0.8, 0.86, 0.92)
AT_ONCE = 5_000
BOUND = 1_000  # milliseconds, for the 95th percentile
ASKED = "run={run}&run={other}&run={third}&part=test"

# Each page below /w/WORLD/. In braces: keys of runs and of an example, a predicate, a task category, a category of
# errors, a saved slice, a number of words, and the cursor of a page somewhere in a list (``place``).
PAGES = {
    "results": "results/?part=test",
    "predictions": "runs/{run}/predictions/?part=test",
    "predictions, wrong ones": "runs/{run}/predictions/?part=test&outcome=wrong",
    "predictions, some page": "runs/{run}/predictions/?part=test&outcome=wrong&after={place}",
    "predictions, filtered": "runs/{run}/predictions/?head={head}&min_words={words}&outcome=wrong",
    "predictions, by utterance": "runs/{run}/predictions/?part=test&sort=utterance",
    "predictions, by score": "runs/{run}/predictions/?part=test&sort=-score",
    "predictions, searched": "runs/{run}/predictions/?part=test&q=w{words}3",
    "predictions, by error category": "runs/{run}/predictions/?part=test&category={category}",
    "predictions, win of a run": "runs/{run}/predictions/?outcome=wrong&versus={other}"
    "&versus_outcome=correct&part=test",
    "review": "review/?run={run}&part=test&outcome=wrong&example={example}",
    "review, two runs": "review/?run={run}&run={other}&part=test&outcome=wrong&example={example}",
    "review, where runs differ": "review/?run={run}&run={other}&differ=1&from={example}",
    "review, by error category": "review/?run={run}&category={category}&example={example}",
    "review, tagged before": "review/?run={run}&outcome=wrong&earlier=tagged&example={example}",
    "error categories": "error-categories/?run={run}",
    "compare": f"compare/?{ASKED}",
    "compare, five runs": "compare/?{runs}&part=test&confusion={run}",
    "compare, on a slice": f"compare/?{ASKED}&head={{head}}&min_words={{words}}",
    "compare, on a saved slice": f"compare/?{ASKED}&slice={{slice}}",
    "compare, on an error category": f"compare/?{ASKED}&category={{category}}",
    "slices": "slices/",
    "defaults": "runs/{run}/defaults/?part=test",
    "sensitivity": "runs/{run}/sensitivity/?part=test",
    "probes": "runs/{run}/probes/",
}


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
        store_examples(split, commands, examples)
        for name, query in SLICES.items():
            Slice.objects.create(world=world, name=name, query=query)
    keys = list(split.examples.order_by("pk").values_list("pk", "logical_form"))
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
    from parser_service.analysing.carrying_out import OF_PARTS
    from parser_service.analysing.findings import keep_finding
    from parser_service.analysing.target import Target

    for run in split.runs.all():
        target = Target(run, "test")
        for step in OF_PARTS:
            began = time.process_time()
            keep_finding(run, "test", step.name, step.find(target, UNWATCHED), UNWATCHED)
            used = time.process_time() - began
            print(f"{step.name} of run {run.pk}: {used:.1f} s of processor time", flush=True)


def store_examples(split: Any, commands: list[Any], count: int) -> None:
    from annotations.models import Example

    dice = random.Random(0)
    for numbers in batches(range(count)):
        rows = []
        for number in numbers:
            command = dice.choice(commands)
            rows.append(
                Example(
                    split=split,
                    position=number,
                    part="test",
                    source="generated" if number % 3 else "paraphrased",
                    utterance=f"{command.anonymized_text} w{number % 5000}",
                    source_command=command.anonymized_text,
                    task_category=command.task_category,
                    logical_form=command.logical_form.text,
                )
            )
        Example.objects.bulk_create(rows)


def store_run(split: Any, number: int, keys: list[tuple[int, str]], forms: list[str]) -> None:
    from django.utils import timezone

    from parser_service.models import Evaluation, Prediction, Review, TrainingRun
    from parser_service.parsers.registry import PARSERS
    from parser_service.reviewing.categories import ensure_categories

    dice, share = random.Random(number + 1), ACCURACIES[number]
    run = TrainingRun.objects.create(
        world=split.world,
        split=split,
        parser=PARSERS_OF_RUNS[number],
        parser_version=PARSERS[PARSERS_OF_RUNS[number]].version,
        protocol="strict",
        train_sources="gen+para",
        seed=number,
        content_key=f"{number:064}",
        status="succeeded",
        finished_at=timezone.now(),
    )
    categories = list(ensure_categories(split.world).values())
    correct = 0
    for some in batches(keys):
        rows = [predict(run, key, form, forms, dice, share) for key, form in some]
        Prediction.objects.bulk_create(rows)
        correct += sum(row.is_exact_match for row in rows)
        Review.objects.bulk_create(
            Review(
                run=run,
                example_id=row.example_id,
                category=dice.choice(categories),
                is_proposed=True,
                answer=row.logical_form,
                reason="generated",
            )
            for row in rows
            if not row.is_exact_match
        )
    for source in ("mixed", "gen", "para"):
        Evaluation.objects.create(
            run=run,
            test_source=source,
            part="test",
            count=len(keys),
            correct=correct,
            accuracy=correct / len(keys),
            interval_low=correct / len(keys) - 0.01,
            interval_high=correct / len(keys) + 0.01,
            equivalent=correct / len(keys),
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


class Places:
    """What the addresses of ``PAGES`` are filled with, drawn anew for each request."""

    def __init__(self) -> None:
        from annotations.models import World
        from parser_service.models import Prediction

        world = World.objects.get(name=WORLD)
        self.dice = random.Random(0)
        self.runs = list(world.runs.order_by("pk").values_list("pk", flat=True))
        self.slices = list(world.slices.values_list("pk", flat=True))
        self.heads = list(
            world.splits.get(name="large")
            .examples.order_by("head_predicate")
            .values_list("head_predicate", flat=True)
            .distinct()
        )
        self.categories = list(world.error_categories.values_list("code", flat=True))
        keys = Prediction.objects.filter(run=self.runs[0], rank=1).order_by("example_id")
        self.first, self.last = (
            keys.values_list("example_id", flat=True)[0],
            keys.order_by("-example_id").values_list("example_id", flat=True)[0],
        )

    def fill(self, page: str) -> str:
        """Return an address of a page."""
        runs = self.dice.sample(self.runs, 3)
        example = self.dice.randint(self.first, self.last)
        values = {
            **dict(zip(("run", "other", "third"), runs, strict=True)),
            "runs": "&".join(f"run={key}" for key in self.runs),
            "example": example,
            "place": f"%5B{example}%2C+0%5D",
            "head": self.dice.choice(self.heads),
            "category": self.dice.choice(self.categories),
            "slice": self.dice.choice(self.slices),
            "words": self.dice.randint(2, 12),
        }
        return f"/w/{WORLD}/{page.format(**values)}"


def measure(requests: int, only: str) -> bool:
    """Print what each page takes; return whether all kept the bound."""
    from django.conf import settings
    from django.db import connection
    from django.test import Client

    from annotations.models import User

    settings.ALLOWED_HOSTS = ["testserver"]
    settings.STORAGES = {  # pages render although nothing is built
        **settings.STORAGES,
        "staticfiles": {"BACKEND": "django.contrib.staticfiles.storage.StaticFilesStorage"},
    }
    client = Client()
    client.force_login(User.objects.get(username="root"))
    places, missed = Places(), []
    print(f"{connection.vendor}, load {os.getloadavg()[0]:.1f}", flush=True)
    print("   median      p95  slowest      processor: median  p95")
    for name, page in PAGES.items():
        if only not in name:
            continue
        times, processor = [], []
        for _ in range(requests):
            address = places.fill(page)
            began, used = time.perf_counter(), time.process_time()
            answer = client.get(address)
            times.append(1000 * (time.perf_counter() - began))
            processor.append(1000 * (time.process_time() - used))
            if answer.status_code != 200:
                sys.exit(f"{address} answered {answer.status_code}")
        p95 = sorted(times)[int(0.95 * (len(times) - 1))]
        missed += [name] if p95 > BOUND else []
        median = statistics.median(processor)
        used = sorted(processor)[int(0.95 * (len(times) - 1))]
        verdict = f"   more than {BOUND:,}" if p95 > BOUND else ""
        print(
            f"{statistics.median(times):9.0f}{p95:9.0f}{max(times):9.0f} ms{median:18.0f}{used:5.0f} ms"
            f"  {name}{verdict}",
            flush=True,
        )
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"peak memory {peak:.0f} MiB, load {os.getloadavg()[0]:.1f}")
    return not missed


def create_database(address: str) -> None:
    """Create the database that an address names. Exits where there is one, which might hold something."""
    import psycopg

    server, _, name = address.rpartition("/")
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        try:
            connection.execute(f'CREATE DATABASE "{name}"')
        except psycopg.errors.DuplicateDatabase:
            sys.exit(f"There is a database {name} already; name another one.")


def drop_database(address: str) -> None:
    import psycopg

    server, _, name = address.rpartition("/")
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        connection.execute(f'DROP DATABASE "{name}" WITH (FORCE)')


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--examples", type=int, default=200_000)
    parser.add_argument("--requests", type=int, default=50)
    parser.add_argument("--database", default="")
    parser.add_argument("--keep", type=Path, help="folder of the installation")
    parser.add_argument("--only", default="", help="pages whose name has this in it")
    parser.add_argument("--fill", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    sys.path.insert(0, str(ROOT))
    os.environ["DJANGO_SETTINGS_MODULE"] = "gpsr_site.settings"
    if arguments.fill:
        return fill(arguments.examples)
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or Path(temporary)
        is_filled = (folder / "filled").exists()
        if arguments.database and not is_filled:
            create_database(arguments.database)
        folder.mkdir(parents=True, exist_ok=True)
        site = Site(folder, arguments.database)
        if not is_filled:
            prepare(site, arguments.examples)
            (folder / "filled").touch()
        site.enter()
        is_kept = measure(arguments.requests, arguments.only)
        if arguments.database and not arguments.keep:
            from django.db import connection

            connection.close()
            drop_database(arguments.database)
    sys.exit(0 if is_kept else 1)


def prepare(site: Site, examples: int) -> None:
    """Fill the installation, in a process of its own, so that this one stays small."""
    if not DATA.is_dir():
        sys.exit(f"needs the published files (GPSR_SHARED_DATA), and {DATA} does not hold them")
    site.import_world()
    site.run("createcachetable")
    command = [sys.executable, "-m", __spec__.name, "--fill", f"--examples={examples}"]
    began = time.perf_counter()
    if subprocess.run(command, cwd=ROOT, env=site.environment, check=False).returncode:
        sys.exit("The database could not be filled.")
    print(f"filled in {time.perf_counter() - began:.0f} s", flush=True)


if __name__ == "__main__":
    main()
