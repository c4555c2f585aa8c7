"""Request pages, each time with other filters, runs or places in the list, and print what they take."""

from __future__ import annotations

import os
import random
import resource
import statistics
import sys
import time
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote_plus

from benchmarks.fresh_site import WORLD

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
    "predictions, of an answer": "runs/{run}/predictions/?part=test&head={head}&answer_form={form}",
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
        forms = world.splits.get(name="large").examples.order_by("logical_form")
        self.forms = list(forms.values_list("logical_form", flat=True).distinct())
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
            "form": quote_plus(self.dice.choice(self.forms)),
            "category": self.dice.choice(self.categories),
            "slice": self.dice.choice(self.slices),
            "words": self.dice.randint(2, 12),
        }
        return f"/w/{WORLD}/{page.format(**values)}"


@dataclass(slots=True)
class Times:
    """Wall and processor time of the requests for one page, in milliseconds."""

    wall: list[float] = field(default_factory=list)
    processor: list[float] = field(default_factory=list)

    def request(self, client: Any, address: str) -> None:
        """Request a page. Exits where it is not answered."""
        began, used = time.perf_counter(), time.process_time()
        answer = client.get(address, follow=True)  # the next example that differs is one
        self.wall.append(1000 * (time.perf_counter() - began))
        self.processor.append(1000 * (time.process_time() - used))
        if answer.status_code != 200:
            sys.exit(f"{address} answered {answer.status_code}")

    @property
    def is_kept(self) -> bool:
        return p95(self.wall) <= BOUND

    def line(self, name: str) -> str:
        median, verdict = statistics.median, "" if self.is_kept else f"   more than {BOUND:,}"
        return (
            f"{median(self.wall):9.0f}{p95(self.wall):9.0f}{max(self.wall):9.0f} ms"
            f"{median(self.processor):18.0f}{p95(self.processor):5.0f} ms  {name}{verdict}"
        )


def p95(times: list[float]) -> float:
    return sorted(times)[int(0.95 * (len(times) - 1))]


def measure(requests: int, only: str) -> bool:
    """Print what each page takes; return whether all kept the bound."""
    from django.db import connection

    client, places, are_kept = make_client(), Places(), True
    print(f"{connection.vendor}, load {os.getloadavg()[0]:.1f}", flush=True)
    print("   median      p95  slowest      processor: median  p95")
    for name, page in PAGES.items():
        if only in name:
            times = Times()
            for _ in range(requests):
                times.request(client, places.fill(page))
            print(times.line(name), flush=True)
            are_kept &= times.is_kept
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"peak memory {peak:.0f} MiB, load {os.getloadavg()[0]:.1f}")
    return are_kept


def make_client() -> Any:
    """Return a browser in which an administrator has logged in."""
    from django.conf import settings
    from django.test import Client

    from annotations.models import User

    settings.ALLOWED_HOSTS = ["testserver"]
    settings.STORAGES = {  # pages render although nothing is built
        **settings.STORAGES,
        "staticfiles": {"BACKEND": "django.contrib.staticfiles.storage.StaticFilesStorage"},
    }
    client = Client()
    client.force_login(User.objects.get(username="root"))
    return client
