"""What each command of a grammar, each example of a split and each prediction costs, from few to a million.

    .venv/bin/python -m benchmarks.scale [--commands 20000 100000] [--predictions 10]
        [--database postgres://postgres@127.0.0.1:5432/scale]

For each number of commands: a fresh installation imports a grammar with that many expansions, generates them,
freezes a split, exports it in each format, stores so many predictions for each example of the split, writes a
backup and restores it into another installation (SQLite). Each step is a process of its own; of each stand seconds of
processor time, microseconds of it per item (command, example, prediction or row), and the peak of its memory. On
PostgreSQL, whose database is made and dropped, the time that the server itself spends is not in it.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.fresh_site import ROOT, Site, Spent

VERBS = ("fetch", "bring", "get", "hand", "pass", "find", "carry", "deliver")
WORDS_PER_PLACE = 100
AT_ONCE = 5_000
WORLD = "scale"


def write_generator(folder: Path, commands: int) -> None:
    """Write a generator whose grammar has ``commands`` expansions, of eight templates."""
    starter = ROOT / "annotations" / "starter" / "household"
    for path in starter.glob("*.xml"):
        shutil.copy(path, folder / path.name)
    shutil.copy(starter / "predicates.json", folder)
    last = max(1, commands // len(VERBS) // WORDS_PER_PLACE)
    places = {"size": WORDS_PER_PLACE, "shade": last}
    lines = ["; grammar name Scale category 1", "; grammar tier Easy", ""]
    lines += [f"$Main = {verb} me the $size $shade {{kobject}}" for verb in VERBS]
    lines += [
        f"${name} = {' | '.join(f'{name}{number}' for number in range(count))}"
        for name, count in places.items()
    ]
    (folder / "scale_category_1_grammar.txt").write_text("\n".join(lines) + "\n")
    forms = (
        f"{verb} me the $size $shade {{kobject}} = (bring (λ$1:e (is_a $1 {{kobject}})))"
        for verb in VERBS
    )
    (folder / "scale_category_1_semantics.txt").write_text("\n".join(forms) + "\n")


def store_predictions(each: int) -> None:
    """Store ``each`` ranked answers for every example of the split, in the batches of an evaluation."""
    import django

    django.setup()
    from annotations.models import Split
    from parser_service.models import Prediction, TrainingRun

    split = Split.objects.get()
    run = TrainingRun.objects.create(
        world=split.world,
        split=split,
        parser="knn",
        parser_version=1,
        protocol="strict",
        train_sources="gen",
        seed=0,
        content_key="0" * 64,
        status="succeeded",
    )
    answer = {"is_equivalent": False, "is_well_formed": True, "score": -1.25}
    rows: list[Prediction] = []
    for key, form in split.examples.values_list("pk", "logical_form").iterator():
        rows += [
            Prediction(
                run=run,
                example_id=key,
                rank=rank,
                logical_form=form,
                is_exact_match=rank == 1,
                **answer,
            )
            for rank in range(1, each + 1)
        ]
        if len(rows) >= AT_ONCE:
            Prediction.objects.bulk_create(rows)
            rows.clear()
    Prediction.objects.bulk_create(rows)


def measure(commands: int, predictions: int, database: str) -> None:
    """Print a line for each step."""
    folder = Path(tempfile.mkdtemp(prefix="scale-"))
    try:
        generator = folder / "generator"
        generator.mkdir()
        write_generator(generator, commands)
        site = Site(folder / "one", database)
        say("import", site.run("import_generator", str(generator), "--world", WORLD), commands)
        say("generate", site.run("generate_pairs", WORLD), commands)
        frozen = site.run("freeze_split", WORLD, "--name", "all", "--criterion", "command")
        say("freeze", frozen, commands)
        for form in ("txt", "jsonl", "csv"):
            target = str(folder / form)
            exported = site.run("export_split", WORLD, "all", "--as", form, "--output", target)
            say(f"export {form}", exported, commands)
        if predictions:
            say("predictions", run_here(site, predictions), commands * predictions)
        rows = commands * (2 + predictions)
        backup = folder / "backup.zip"
        say("backup", site.run("backup", str(backup)), rows)
        other = Site(folder / "two")
        say("restore", other.run("restore", str(backup)), rows)
        database_bytes = sum(path.stat().st_size for path in (folder / "two").glob("db.sqlite3*"))
        print(f"  {database_bytes / rows:,.0f} bytes a row in SQLite", end="")
        print(f", {backup.stat().st_size / rows:,.0f} in the backup", flush=True)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def run_here(site: Site, predictions: int) -> Spent:
    """Run ``store_predictions`` in a process of its own, as a command is run."""
    code = f"from benchmarks.scale import store_predictions; store_predictions({predictions})"
    before = dict(site.environment)
    site.environment |= {"DJANGO_SETTINGS_MODULE": "gpsr_site.settings"}
    try:
        return site.run("shell", "--no-imports", "--command", code)
    finally:
        site.environment = before


def say(step: str, spent: Spent, items: int) -> None:
    if spent.status:
        sys.exit(f"{step}: {spent.errors[-2000:]}")
    each = spent.processor / items * 1e6
    figures = f"{spent.processor:9.1f} s {each:9.1f} µs {spent.peak / 2**20:7.0f} MiB"
    print(f"  {step:12} {figures} {spent.wall:9.1f} s of wall time", flush=True)


def on_database(address: str, verb: str) -> None:
    """Make or drop the database of a PostgreSQL address."""
    server, _, name = address.rpartition("/")
    statement = {"make": f"CREATE DATABASE {name}", "drop": f"DROP DATABASE IF EXISTS {name}"}
    subprocess.run(["psql", "-q", f"{server}/postgres", "-c", statement[verb]], check=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--commands", type=int, nargs="+", default=[20_000, 100_000])
    parser.add_argument("--predictions", type=int, default=10, help="for each example")
    parser.add_argument("--database", default="", help="an address of PostgreSQL; else SQLite")
    args = parser.parse_args()
    for commands in args.commands:
        print(f"{commands:,} commands, load {os.getloadavg()[0]:.1f}", flush=True)
        if args.database:
            on_database(args.database, "make")
        try:
            measure(commands, args.predictions, args.database)
        finally:
            if args.database:
                on_database(args.database, "drop")


if __name__ == "__main__":
    main()
