"""How much processor time each page and route that writes takes, in a world of some 3,000 commands.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.writes [--verbs 8] [--least 0.1] [--only split] [--at-once]

Makes a fresh SQLite installation: the published 2018 generator with ``--verbs`` more verbs (8 make 3,000 commands, 30
some 10,500), the published paraphrases, a split of all that, a run with an answer for each example, a thousand
utterances, and a campaign with a thousand submissions. Sends each page and route of ``POLICY`` that writes a body, the
one of ``sent_to`` or else an empty one, rolls back what it did, and prints seconds of processor time and the status of
the answer, the slowest first. What becomes a job costs here what asking for the job does; with ``--at-once``
splits and campaigns of any size are made in the request.
"""

from __future__ import annotations

import argparse
import logging
import sys
import tempfile
import time
from itertools import cycle, islice
from pathlib import Path
from typing import Any

from benchmarks.fresh_site import DATA, WORLD, Site

UTTERANCES = SUBMISSIONS = 1_000
LINES = 5_000  # that are pasted at once
SPLIT = {"name": "mine", "criterion": "logical_form", "seed": "0"}
LAUNCHED = {
    **{"name": "spring", "wording": "command", "target_per_form": "50", "seed": "0"},
    **{"balance": "forms", "prompts_per_form": "20", "task_size": "12", "free_commands": "2"},
    **{"check_every": "0", "taboo_words": "0", "most_per_hour": "1000", "launch": "yes"},
}


def files_of(folder: str) -> dict[str, bytes]:
    """Return the files below a folder of published data by their paths."""
    paths = (path for path in (DATA / folder).rglob("*") if path.is_file())
    return {str(path.relative_to(DATA / folder)): path.read_bytes() for path in paths}


def fill(verbs: int) -> Any:
    """Fill the installation. Return its world as the tables of ``tests/gpsr_site/routes/`` take it."""
    from django.utils import timezone

    from annotations.campaigns.launching import PromptChoice, launch
    from annotations.exchange.generator_import import import_generator
    from annotations.exchange.pair_import import import_pairs
    from annotations.generation.freezing import freeze_split
    from annotations.generation.generating import generate_pairs
    from annotations.labelling.collecting import collect
    from annotations.labelling.enqueuing import refill
    from annotations.models import Campaign, Submission, User, World
    from benchmarks.million_predictions.filling import store_run
    from tests.sample_world import SampleWorld

    root = User.objects.create_superuser("root", password="a password for the benchmark")
    world = World.objects.create(name=WORLD)
    files = files_of("generator-2018")
    for number in range(verbs):
        line = "\n$vbbring = bring{0} me\n$vbtake = take{0}\n$vbplace = place{0}\n"
        files["common_rules.txt"] += line.format(number).encode()
    if (made := import_generator(WORLD, files, root)).is_refused:
        sys.exit(str(made.errors))
    generate_pairs(world)
    import_pairs(WORLD, "published", files_of("walker2019"), root)
    split = freeze_split(world, "all", "logical_form", by=root)
    world.paraphrases.all()[0].delete()  # so that the split can be frozen anew
    keys = list(split.examples.values_list("pk", "logical_form"))
    store_run(split, 0, keys, sorted({form for _, form in keys}))
    said = [f"{text} now" for text in world.paraphrases.values_list("utterance", flat=True)]
    collect(world, list(dict.fromkeys(said))[:UTTERANCES], by=root)
    refill(world)
    campaign = launch(Campaign(world=world, name="first"), PromptChoice(prompts_per_form=5), root)
    somebody = campaign.contributors.create(pseudonym="somebody")
    asked = zip(range(SUBMISSIONS), cycle(campaign.prompts.all()), cycle(said), strict=False)
    Submission.objects.bulk_create(
        Submission(
            contributor=somebody,
            position=number + 1,
            prompt=prompt,
            text=f"{text} {number}",
            answered_at=timezone.now(),
        )
        for number, prompt, text in asked
    )
    run, template = world.runs.get(), world.grammar.templates.filter(pattern__contains="$vb")[0]
    example = run.predictions.all()[0].example
    print(f"{world.commands.count():,} commands, a split of {len(keys):,} examples")
    return SampleWorld(world, template, world.logical_forms.all()[0], split, run, example)


def sent_to(sample: Any) -> dict[str, dict[str, Any]]:
    """Return what pages are sent where an empty form would make them do little. Other fields are as the page shows
    them."""
    from django.core.files.uploadedfile import SimpleUploadedFile

    from annotations.models import Submission

    def uploads(folder: str) -> list[Any]:
        return [
            SimpleUploadedFile(name.replace("/", "-"), data)
            for name, data in files_of(folder).items()
        ]

    def lines(count: int) -> str:
        return "\n".join(f"thing number {number}" for number in range(count))

    world, template = sample.world, sample.template
    category = world.grammar.task_categories.get(name=template.task_category)
    texts = {"task_category": category.pk, "pattern": template.pattern, "form": "UNKNOWN"}
    verb = {"nonterminal": "$vbtake", "expansion": "hand over", "source": "common_rules.txt"}
    pasted = {"entity_class": "object", "lines": lines(500), "attributes": "", "add": "yes"}
    keys = islice(Submission.objects.values_list("pk", flat=True), SUBMISSIONS)
    together = {"command1": "go to the kitchen", "command2": "bring me the apple"}
    said = {"text": "bring me the apple"}
    return {
        "template": {"form": "UNKNOWN"},
        "template_new": {**texts, "status": "ready"},
        **dict.fromkeys(("template_check", "template_preview", "template_consequences"), texts),
        "production": {"expansion": "go there"},
        **dict.fromkeys(("production_new", "production_check", "production_preview"), verb),
        "entity": {"aliases": "another name"},
        "entities_new": pasted,
        "rename": {"new": "quite_another"},
        "recipe_book": {"shipped": "tasks"},
        "split_new": {**SPLIT, "train": "70", "validation": "10", "test": "20", "freeze": "yes"},
        "campaign_new": LAUNCHED,
        "utterances_new": {"text": lines(LINES)},
        "utterances_delete": {"total": str(world.utterances.count())},
        "submissions_decide": {"row": list(keys), "decision": "accept"},
        "predictions_send": {"reason": "Look."},
        "import": {"files": uploads("generator-2018")},
        "import_pairs": {"name": "again", "archive": uploads("walker2019")},
        "import_competition": {"files": uploads("competition-2025")},
        "world_edit": {"name": "renamed"},
        "world_delete": {"name": world.name},
        "run_new": {"split": sample.split.pk, "parser": "knn"},
        "joint_plan_ask": together,
        "playground_ask": said,
        "beside_ask": {**said, "beside": sample.run.pk},
    }


def shown_at(client: Any, path: str) -> dict[str, Any]:
    """Return what the form of a page would send if nobody touched it."""
    answer = client.get(path)
    form = answer.context.get("form") if answer.context else None
    if answer.status_code != 200 or form is None or not hasattr(form, "fields"):
        return {}
    values = {field.html_name: getattr(field.value(), "pk", field.value()) for field in form}
    return {name: value for name, value in values.items() if value not in (None, False)}


def measure(sample: Any, only: str) -> list[tuple[float, int, str]]:
    """Send to each page and route whose name has ``only`` in it. Return processor seconds, status and name."""
    from django.conf import settings
    from django.db import transaction
    from django.test import Client
    from django.test.utils import setup_test_environment

    from annotations.models import User
    from tests.gpsr_site.at_once.writes import CHANGES, NAMES, SHOWN_BY
    from tests.gpsr_site.routes.addresses import address
    from tests.gpsr_site.routes.policy import POLICY

    setup_test_environment()  # so that answers tell of their forms
    logging.disable()
    client = Client(raise_request_exception=False)
    client.force_login(User.objects.get(username="root"))
    session = client.cookies[settings.SESSION_COOKIE_NAME].value
    sent, times = sent_to(sample), []
    for rule in POLICY:
        name, method = rule.name, rule.method
        if method == "get" or only not in name:
            continue
        with transaction.atomic():
            client.cookies[settings.SESSION_COOKIE_NAME] = session  # some routes end it
            path = address(name, sample)
            options: dict[str, Any] = {}
            if name.startswith("api:"):
                tag = client.get(address(SHOWN_BY.get(name, name), sample)).headers.get("ETag", "")
                options = {"content_type": "application/json", "headers": {"if-match": tag}}
                change = CHANGES.get((name, method.upper()))
                body = change(0, 0) if change else NAMES.get(name, {})
            else:
                body = {**shown_at(client, path), **sent.get(name, {})}
            began = time.process_time()
            answer = getattr(client, method)(path, body, **options)
            times.append((time.process_time() - began, answer.status_code, f"{method} {name}"))
            transaction.set_rollback(True)
    return times


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--verbs", type=int, default=8)
    parser.add_argument("--least", type=float, default=0.1, help="seconds, of what is printed")
    parser.add_argument("--only", default="", help="routes whose name has this in it")
    parser.add_argument("--at-once", action="store_true", help="splits and campaigns as no jobs")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="writes-") as folder:
        site = Site(Path(folder))
        site.run("createcachetable")
        site.run("collectstatic", "--no-input", "-v0")
        site.enter()
        if given.at_once:
            from annotations.background import job_weight

            job_weight.MOST_EXAMPLES = job_weight.MOST_PROMPTS = job_weight.MOST_COMMANDS = (
                sys.maxsize
            )
        times = measure(fill(given.verbs), given.only)
    for seconds, status, name in sorted(times, reverse=True):
        if seconds >= given.least:
            print(f"{seconds:8.2f} s  {status}  {name}")
    print(f"{len(times)} pages and routes")


if __name__ == "__main__":
    main()
