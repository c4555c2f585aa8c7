"""Requests at a steady rate while the promoted parser is changed twice, then a parse server that is killed.

    python -m tests.load.parse_server [--requests 2000] [--seconds 20] [--parser ranker] [--folder FOLDER]
                                      [--database postgres://…]

Trains three runs of ``--parser`` in the starter world of a fresh database, on generated pairs, on paraphrases and on
both, so that their answers tell them apart (rankers with few steps by default: what an answer costs does not
depend on how well they have learned). Starts ``manage.py parse_server``
under the supervisor of ``make run`` and asks it over HTTP, ``--requests`` in all, evenly over ``--seconds``.
After a third and two thirds of the time another run is promoted. Every answer has to be complete, without an
error, and the very one that the run which it names gives alone. Then the server is killed with SIGKILL: says how
soon the client says that it is away, and when it answers again. Exits with 1 where any of that does not hold.
What was trained into ``--folder`` is kept there for the next time.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import tempfile
import threading
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.fresh_site import ROOT, Site
from benchmarks.parsing.parse_command import SHORT, SPLIT, STARTER, WORLD
from benchmarks.parsing.serving import free_port

DIFFERENT = 40  # utterances
BEAM = 3
MOST_AWAY, MOST_BACK = 2.0, 10.0  # seconds
SETTLED = 11.0  # seconds after which the supervisor starts a child again at once


@dataclass
class Outcome:
    """What became of the requests; ``answers`` counts them by run."""

    answers: Counter[int] = field(default_factory=Counter)
    problems: list[str] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)


def make_site(folder: Path, database: str, parser: str) -> Site:
    """Return an installation with three runs. Exits where training fails."""
    is_new = not (folder / "var").is_dir()
    site = Site(folder / "var", database)
    if not is_new:
        return site
    commands: list[tuple[str, ...]] = [("shell", "-c", STARTER)]
    config = ["--config", *SHORT[parser]] if parser in SHORT else []
    for sources in ("gen,para", "gen", "para"):
        where = ("--world", WORLD, "--split", SPLIT, "--sources", sources)
        commands.append(("train", parser, *where, *config))
    for command in commands:
        spent = site.run(*command)
        if spent.status:
            sys.exit(spent.errors)
    return site


def forms_of(candidates: list[dict[str, Any]]) -> list[str]:
    return [each["grounded"] or each["form"] for each in candidates]


def expected_answers(runs: list[Any], utterances: list[str]) -> dict[tuple[int, str], list[str]]:
    """Return what each run answers to each utterance by itself."""
    from parser_service.serving.metrics import Metrics
    from parser_service.serving.shelf import Shelf

    shelf = Shelf(0, Metrics())
    answerers = {run.pk: shelf.load(WORLD, run.pk) for run in runs}
    return {
        (key, text): forms_of(json.loads(answerer.parse([text], BEAM)[0])["candidates"])
        for key, answerer in answerers.items()
        for text in utterances
    }


def count_told_apart(expected: dict[tuple[int, str], list[str]]) -> int:
    """Return to how many utterances each run gives another answer than all others."""
    by_text: dict[str, list[list[str]]] = {}
    for (_, text), answers in expected.items():
        by_text.setdefault(text, []).append(answers)
    return sum(len(set(map(tuple, each))) == len(each) for each in by_text.values())


def ask(client: Any, text: str, expected: dict[tuple[int, str], list[str]], into: Outcome) -> None:
    began = time.perf_counter()
    try:
        answer = client.parse(WORLD, text, BEAM)
    except Exception as error:
        into.problems.append(f"{type(error).__name__}: {error}")
        return
    into.seconds.append(time.perf_counter() - began)
    into.answers[answer["run"]] += 1
    given, alone = forms_of(answer["candidates"]), expected.get((answer["run"], text))
    if given != alone:
        into.problems.append(f"run {answer['run']}: {text}: {given}, but alone {alone}")


def keep_asking(
    client: Any, runs: list[Any], given: argparse.Namespace, texts: list[str]
) -> Outcome:
    """Ask at a steady rate; promote the second and the third run meanwhile."""
    from parser_service.runs.promoting import promote

    outcome, expected = Outcome(), expected_answers(runs, texts)
    print(
        f"{count_told_apart(expected)} of {len(texts)} utterances have another answer by each run"
    )
    began = time.perf_counter()
    changes = {given.requests * place // len(runs): runs[place] for place in (1, 2)}
    with ThreadPoolExecutor(64) as threads:
        for number in range(given.requests):
            time.sleep(
                max(0.0, began + number * given.seconds / given.requests - time.perf_counter())
            )
            if number in changes:
                promote(changes[number], None, "the load test")
            threads.submit(ask, client, texts[number % len(texts)], expected, outcome)
    took = time.perf_counter() - began
    ordered = sorted(outcome.seconds) or [0.0]
    print(
        f"{given.requests} requests in {took:.1f} s, answers by run {dict(outcome.answers)}, "
        f"p50 {1000 * ordered[len(ordered) // 2]:.0f} ms, p95 "
        f"{1000 * ordered[int(len(ordered) * 0.95)]:.0f} ms, {len(outcome.problems)} problems"
    )
    for problem in outcome.problems[:5]:
        print(f"  {problem}")
    return outcome


def kill(supervisor: Any, client: Any, text: str) -> tuple[float, float]:
    """Kill the server; return the longest time that the client took to say so, and until an answer."""
    from parser_service.serving.parser_client import ParserAway, ParserRefused

    os.kill(supervisor.children["parse server"].pid, signal.SIGKILL)
    killed, longest = time.perf_counter(), 0.0
    while time.perf_counter() - killed < 60:
        began = time.perf_counter()
        try:
            client.parse(WORLD, text, BEAM)
            return longest, time.perf_counter() - killed
        except (ParserAway, ParserRefused):
            longest = max(longest, time.perf_counter() - began)
        time.sleep(0.05)
    return longest, float("inf")


def wait_for_first_answer(client: Any, text: str) -> None:
    while True:
        try:
            client.parse(WORLD, text, BEAM)
            return
        except Exception:
            time.sleep(0.1)


def measure(given: argparse.Namespace) -> bool:
    """Return whether all holds."""
    from annotations.models import World
    from gpsr_site.processes import PARSE_SERVER, Supervisor
    from parser_service.runs.promoting import promote, promoted_run
    from parser_service.serving.parser_client import client

    world = World.objects.get(name=WORLD)
    runs = list(world.runs.order_by("pk").select_related("world"))
    if promoted_run(world) != runs[0]:
        promote(runs[0], None)
    spoken = runs[0].split.examples.filter(part="validation", source="paraphrased")
    texts = list(spoken.values_list("utterance", flat=True)[:DIFFERENT])
    supervisor = Supervisor({"parse server": PARSE_SERVER}, print)
    supervisor.start()
    watching = threading.Thread(target=supervisor.watch)
    watching.start()
    try:
        wait_for_first_answer(client(), texts[0])
        outcome = keep_asking(client(), runs, given, texts)
        time.sleep(SETTLED)
        away, back = kill(supervisor, client(), texts[0])
    finally:
        supervisor.is_stopping = True
        watching.join()
    print(f"killed: said within {away:.2f} s, answers again after {back:.1f} s")
    changed = set(outcome.answers) == {run.pk for run in runs}
    return changed and not outcome.problems and away <= MOST_AWAY and back <= MOST_BACK


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--requests", type=int, default=2000)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--parser", default="ranker")
    parser.add_argument("--folder", type=Path, help="where an installation is, or is made and kept")
    parser.add_argument("--database", default="", help="a URL; its database has to be empty")
    given = parser.parse_args()
    os.chdir(ROOT)
    os.environ["PARSER_PORT"] = str(free_port())
    with tempfile.TemporaryDirectory(prefix="gpsr-load-") as folder:
        make_site(given.folder or Path(folder), given.database, given.parser).enter()
        is_held = measure(given)
    print("held" if is_held else "MISSED")
    sys.exit(not is_held)


if __name__ == "__main__":
    main()
