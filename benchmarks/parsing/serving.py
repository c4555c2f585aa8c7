"""What the parse server adds to its parser: latency, throughput, and the time until its first answer.

    .venv/bin/python -m benchmarks.parsing.serving [--parser ranker] [--rounds 3] [--folder FOLDER]

Loads the starter world into a fresh SQLite database, trains the parser there for a few steps (what an answer costs
does not depend on how well it has learned, but on how many forms it has), promotes it and starts ``manage.py
parse_server``. What was trained into ``--folder`` is kept there for the next time.
The utterances are the validation paraphrases of the split. Single parses are asked one after
the other, each with its own connection as the site does it; batches are JSON lines.

The bare loop calls ``predict`` of the same parser, in this process, with the same texts and beam: one at a time, and
as many together as the server takes of JSON lines. Rounds of the loop and of the service alternate, and the fastest
round of each counts, because other work on the machine only adds. Spent beside the parser are finding the entities,
five answers with their entities, English sentences, questions and plans, JSON and HTTP; and in the loop nothing. The
server works out once what depends on a form alone, so that the first round costs more than those after it: the
first lines that it is ever sent are reported by themselves.

The table at the end is of this process alone, without HTTP: answers in a second of processor time, of each part of the
answerer. It has answered some paraphrases of the training part before, and is asked each of the validation part once.
"""

from __future__ import annotations

import argparse
import json
import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

# As in the server; read when numpy and torch are loaded.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

from benchmarks.fresh_site import ROOT, Site
from benchmarks.parsing.parse_command import SHORT, SPLIT, STARTER, WORLD

MOST_MILLISECONDS = 60.0
LEAST_A_SECOND = 150.0
MOST_ADDED = 0.15
MOST_SECONDS_TO_FIRST = 10.0
WARM_UP = 20
WARMING = 150  # utterances before the table
PATIENCE = 120.0


def make_site(folder: Path, parser: str) -> Site:
    """Return an installation with one promoted run of ``parser``. Exits where training fails."""
    is_new = not (folder / "var").is_dir()
    site = Site(folder / "var")
    if not is_new:
        return site
    config = SHORT.get(parser, [])
    where = ("--world", WORLD, "--split", SPLIT, "--sources", "gen,para")
    commands = (
        ("shell", "-c", STARTER),
        ("train", parser, *where, *(["--config", *config] if config else [])),
    )
    for command in commands:
        spent = site.run(*command)
        if spent.status:
            sys.exit(spent.errors)
    return site


def promote_run() -> Any:
    """Promote the run, where a rule has not, and return it."""
    from annotations.models import World
    from parser_service.runs.promoting import promote, promoted_run

    world = World.objects.get(name=WORLD)
    if promoted_run(world) is None:
        promote(world.runs.get(), None)
    return promoted_run(world)


@contextmanager
def running_server(site: Site, client: Any, utterance: str) -> Iterator[float]:
    """Start the parse server; give the seconds until its first answer."""
    from parser_service.serving.parser_client import ParserAway, ParserRefused

    began = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "manage.py", "parse_server"], cwd=ROOT, env=site.environment
    )
    try:
        while True:
            try:
                client.parse(WORLD, utterance)
                break
            except (ParserAway, ParserRefused) as error:
                if process.poll() is not None or time.perf_counter() - began > PATIENCE:
                    sys.exit(f"The parse server has not answered: {error}")
                time.sleep(0.02)
        yield time.perf_counter() - began
    finally:
        process.terminate()
        process.wait()


def seconds_of(ask: Callable[[Any], object], asked: Sequence[Any]) -> np.ndarray:
    """Return the seconds that each call takes."""
    seconds = []
    for each in asked:
        began = time.perf_counter()
        ask(each)
        seconds.append(time.perf_counter() - began)
    return np.array(seconds)


def fastest(rounds: Sequence[np.ndarray]) -> np.ndarray:
    """Return the round that took the least time."""
    return min(rounds, key=lambda each: float(each.sum()))


def measure(client: Any, parser: Any, utterances: Sequence[str], rounds: int) -> None:
    """Print a line for single parses and one for batches."""
    from parser_service.runs.evaluating import BEAM_WIDTH
    from parser_service.serving.answerer import LINES_TOGETHER

    def bare(texts: Sequence[str]) -> None:
        parser.predict(texts, BEAM_WIDTH)

    def serve_lines(lines: bytes) -> None:
        answers = b"".join(client.parse_lines(WORLD, lines)).splitlines()
        assert len(answers) == len(utterances) and b'"candidates"' in answers[-1]

    many = list(utterances)
    together = [many[at : at + LINES_TOGETHER] for at in range(0, len(many), LINES_TOGETHER)]
    lines = b"\n".join(json.dumps({"utterance": each}).encode() for each in many)
    seconds_of(bare, [[text] for text in utterances[:WARM_UP]])
    cold = seconds_of(serve_lines, [lines])
    seconds_of(lambda text: client.parse(WORLD, text), utterances[:WARM_UP])
    kinds: dict[str, list[np.ndarray]] = {name: [] for name in ("one", "bare one", "many", "bare")}
    for _ in range(rounds):
        kinds["bare one"].append(seconds_of(bare, [[text] for text in utterances]))
        kinds["one"].append(seconds_of(lambda text: client.parse(WORLD, text), utterances))
        kinds["bare"].append(seconds_of(bare, together))
        kinds["many"].append(seconds_of(serve_lines, [lines]))
    best = {name: fastest(each) for name, each in kinds.items()}
    report_singles(1000 * best["one"], 1000 * best["bare one"])
    report_batches(len(many) / best["many"].sum(), len(many) / best["bare"].sum())
    print(f"the first batches ever: {len(many) / cold.sum():.0f} a second")


def report_per_core(run: Any, utterances: Sequence[str]) -> None:
    """Print the table of answers a second per core: one at a time, as many together as of JSON lines, and the same
    found but not written."""
    from parser_service.parsers.registry import ORACLE
    from parser_service.runs.evaluating import BEAM_WIDTH
    from parser_service.serving.answerer import LINES_TOGETHER
    from parser_service.serving.metrics import Metrics
    from parser_service.serving.shelf import Shelf

    known = run.split.examples.filter(part="train", source="paraphrased")
    warming = list(known.values_list("utterance", flat=True)[:WARMING])
    parts = (("oracle", None, ORACLE), (run.parser, run.pk, ""), ("answerer", None, ""))
    print(f"{'answers a second per core':28}{'single':>8}{'batch':>8}{'unwritten':>11}")
    for name, number, parser in parts:
        rates = []
        for together, verb in ((1, "parse"), (LINES_TOGETHER, "parse"), (1, "ask")):
            # Each from the same start: an utterance that was answered is remembered.
            ask = getattr(Shelf(0, Metrics()).load(WORLD, number, parser), verb)
            for text in warming:
                ask([text], BEAM_WIDTH)
            began = time.process_time()
            for at in range(0, len(utterances), together):
                ask(utterances[at : at + together], BEAM_WIDTH)
            rates.append(len(utterances) / (time.process_time() - began))
        print(f"{name:28}{rates[0]:8.0f}{rates[1]:8.0f}{rates[2]:11.0f}", flush=True)


def report_singles(served: np.ndarray, bare: np.ndarray) -> None:
    slow = np.percentile(served, 95)
    print(
        f"single: p50 {np.percentile(served, 50):.1f} ms, p95 {slow:.1f} ms; bare loop p50 "
        f"{np.percentile(bare, 50):.1f} ms, p95 {np.percentile(bare, 95):.1f} ms; "
        f"{served.mean() - bare.mean():.1f} ms more on average   "
        f"(bound p95 {MOST_MILLISECONDS:g} ms: {held(slow <= MOST_MILLISECONDS)})"
    )


def report_batches(served: float, bare: float) -> None:
    added = bare / served - 1
    print(
        f"batches: {served:.0f} a second; bare loop {bare:.0f}; {100 * added:.1f} % added   "
        f"(bounds {LEAST_A_SECOND:g} a second: {held(served >= LEAST_A_SECOND)}; "
        f"{100 * MOST_ADDED:g} %: {held(added <= MOST_ADDED)})"
    )


def held(is_held: bool) -> str:
    return "held" if is_held else "MISSED"


def free_port() -> int:
    with socket.socket() as chosen:
        chosen.bind(("127.0.0.1", 0))
        return int(chosen.getsockname()[1])


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--parser", default="ranker")
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument(
        "--folder", type=Path, help="where an installation is, or is made and kept"
    )
    given = arguments.parse_args()
    os.environ["PARSER_PORT"] = str(free_port())
    with tempfile.TemporaryDirectory() as folder:
        site = make_site(given.folder or Path(folder), given.parser)
        site.enter()
        from parser_service.serving.loading import load_parser
        from parser_service.serving.parser_client import client

        run = promote_run()
        spoken = run.split.examples.filter(part="validation", source="paraphrased")
        utterances = list(spoken.values_list("utterance", flat=True))
        with running_server(site, client(), utterances[0]) as first:
            is_soon = held(first <= MOST_SECONDS_TO_FIRST)
            print(
                f"first answer after {first:.1f} s   (bound {MOST_SECONDS_TO_FIRST:g} s: {is_soon})"
            )
            measure(client(), load_parser(run), utterances, given.rounds)
        report_per_core(run, utterances)


if __name__ == "__main__":
    main()
