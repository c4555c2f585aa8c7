"""The parsers to choose from, grouped by what one needs, with what this world knows of each."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from statistics import median

from annotations.language.corpus import KNOWN
from annotations.models import Split, World
from parser_service.models import Evaluation
from parser_service.models.runs import Status
from parser_service.models.shown_scores import ShownScore, shown_scores
from parser_service.parsers.registry import PARSERS, Entry, Needs, make_config
from parser_service.parsers.weights.files import find_gaps

MOST_RUNS = 200  # the newest that times are taken from
TITLES = {
    Needs.NOTHING: "Needs nothing",
    Needs.CPU: "Minutes on a CPU",
    Needs.GPU: "A GPU is recommended",
    Needs.WEIGHTS: "Weights to bring",
    Needs.SERVER: "A server to ask",
}
SOURCES = {"gen": "commands", "para": "paraphrases"}


@dataclass(frozen=True, slots=True)
class ParserOption:
    """One parser. ``seconds`` is the median time of its finished runs here, None before the first;
    ``scores`` its best accuracies on the validation part, by source; ``missing`` names
    the weights, or the server, that are not there."""

    name: str
    entry: Entry
    missing: tuple[str, ...] = ()
    seconds: float | None = None
    scores: tuple[tuple[str, ShownScore], ...] = ()

    @property
    def sentence(self) -> str:
        return self.entry.in_short or self.entry.description


@dataclass(frozen=True, slots=True)
class ParserGroup:
    title: str
    options: tuple[ParserOption, ...]


def parser_groups(world: World, split: Split | None) -> list[ParserGroup]:
    """Return all parsers by what they need; accuracies are those on ``split``. Two queries."""
    seconds, scores = _seconds(world), _scores(world, split)
    options = [
        ParserOption(
            name,
            entry,
            tuple(gap.name for gap in find_gaps(make_config(name), anywhere=False)),
            seconds.get(name),
            tuple(scores.get(name, {}).items()),
        )
        for name, entry in PARSERS.items()
    ]
    return list(_group(options))


def _group(options: list[ParserOption]) -> Iterator[ParserGroup]:
    for needs, title in TITLES.items():
        of_group = tuple(each for each in options if each.entry.needs == needs)
        if of_group:
            yield ParserGroup(title, of_group)


def _seconds(world: World) -> dict[str, float]:
    """Return the median seconds of training of the newest finished runs, by parser."""
    times: dict[str, list[float]] = defaultdict(list)
    runs = (
        world.runs.succeeded()
        .on_all_pairs()
        .order_by("-id")
        .values_list("parser", "seconds_trained")
    )
    for parser, seconds in runs[:MOST_RUNS]:
        times[parser].append(seconds)
    return {parser: median(each) for parser, each in times.items()}


def _scores(world: World, split: Split | None) -> dict[str, dict[str, ShownScore]]:
    """Return the best score by parser and source; by form that with the highest harmonic mean."""
    best: dict[str, dict[str, ShownScore]] = defaultdict(dict)
    if split is None:
        return best
    rows = Evaluation.objects.filter(
        run__world=world,
        run__split=split,
        run__status=Status.SUCCEEDED,
        run__train_share=1,
        part__in=["validation", KNOWN],
        test_source__in=SOURCES,
    )
    of_runs: dict[tuple[str, int], list[Evaluation]] = defaultdict(list)
    for row in rows.select_related("run").defer("outcomes").order_by("test_source"):
        of_runs[row.run.parser, row.run_id].append(row)
    for (parser, _), of_run in of_runs.items():
        for (_, source), score in shown_scores(of_run, split.criterion).items():
            name = SOURCES[source]
            best[parser][name] = max(score, best[parser].get(name, score), key=_rank)
    return best


def _rank(score: ShownScore) -> tuple[bool, float]:
    return not score.alone, score.accuracy
