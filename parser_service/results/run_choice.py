"""Which runs a comparison is of: those that its address names, of one split, and those it could take too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from django.db.models import Count
from django.http import QueryDict

from annotations.language.corpus import KNOWN, Part
from annotations.language.texts import say_count
from annotations.models import Split, World
from annotations.showing.paging import number_in
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers import registry
from parser_service.serving.default_runs import best_two, opening_split

PARTS = (Part.VALIDATION, Part.TEST)
MOST_RUNS = 12  # at once
MOST_SUGGESTED = 5
LETTERS = "ABCDEFGHIJKL"


@dataclass(frozen=True, slots=True)
class OfferedRun:
    """A run that has answers on the part. ``scores`` are by test source; ``is_chosen`` where it is compared."""

    run: TrainingRun
    scores: Mapping[str, ShownScore]
    is_chosen: bool

    @property
    def title(self) -> str:
        return title_of(self.run)

    @property
    def accuracy(self) -> float:
        """The one to rank by: of commands and paraphrases together where there are both."""
        order = ("mixed", "para", "said", "gen", "model")
        best = [self.scores[source] for source in order if source in self.scores]
        return best[0].accuracy if best else 0.0


@dataclass(frozen=True)
class RunChoice:
    """``runs`` are compared; ``offered`` are all that could be, of ``split``. ``notes`` say what was left out."""

    part: str
    split: Split | None
    splits: Sequence[Split]
    runs: tuple[TrainingRun, ...]
    offered: Sequence[OfferedRun]
    notes: list[str] = field(default_factory=list)

    @cached_property
    def opening(self) -> list[TrainingRun]:
        """The two runs to compare where the address names none; none where the split has fewer."""
        return best_two(self.split, [each.run for each in self.offered]) if self.split else []

    @cached_property
    def suggested(self) -> list[TrainingRun]:
        """The best run of each parser, the best first; fewer than two are no suggestion."""
        best: dict[str, OfferedRun] = {}
        for each in sorted(self.offered, key=lambda each: -each.accuracy):
            best.setdefault(each.run.parser, each)
        runs = [each.run for each in best.values()][:MOST_SUGGESTED]
        return runs if len(runs) > 1 else []

    @property
    def names(self) -> list[str]:
        """What sentences call the runs."""
        return [f"{title_of(run)} (run {run.pk})" for run in self.runs]


def title_of(run: TrainingRun) -> str:
    """Return what pages call the parser of a run, and the share of the training pairs that it learned from
    where that is not all."""
    title = registry.title_of(run.parser)
    return f"{title}, {run.share_in_words} of the pairs" if run.share_in_words else title


def choose_runs(world: World, query: QueryDict, part: str) -> RunChoice:
    """Return the runs that ``query`` names by ``run``, in its order, as far as they can be compared on ``part``.

    They have to be of the split of the first one, and to have answers there. Without any, the split is the one that
    ``split`` names, or the one that a page opens on (``parser_service.serving.default_runs``).
    """
    keys = named_keys(query)
    scored = Evaluation.objects.filter(run__world=world, part=part).order_by()
    runs = world.runs.succeeded().select_related("split").in_bulk(keys)
    named = [runs[key] for key in keys if key in runs]
    splits = list(world.splits.filter(runs__evaluations__in=scored).distinct())
    by_name = {split.name: split for split in reversed(splits)}
    split = named[0].split if named else by_name.get(query.get("split", ""))
    if split is None:
        counts = scored.values_list("run__split").annotate(Count("run", distinct=True))
        split = opening_split(world, splits, dict(counts))
    scores = _scores(world, split, part) if split else {}
    fitting = [run for run in named if run.pk in scores]
    chosen = tuple(fitting[:MOST_RUNS])
    rows = world.runs.succeeded().filter(pk__in=scores).order_by("-pk")
    others = [run for run in rows if run not in chosen]
    # Those that are compared come first, so that the form sends them in their order.
    offered = [OfferedRun(run, scores[run.pk], run in chosen) for run in (*chosen, *others)]
    return RunChoice(
        part, split, splits, chosen, offered, _notes(keys, named, fitting, split, part)
    )


def named_keys(query: QueryDict) -> list[int]:
    """Return the keys of the runs that an address names by ``run``, each once."""
    return list(dict.fromkeys(filter(None, map(number_in, query.getlist("run")))))


def _scores(world: World, split: Split, part: str) -> dict[int, dict[str, ShownScore]]:
    """Return the scores on a part by run and test source."""
    rows = Evaluation.objects.filter(run__world=world, run__split=split, part__in=[part, KNOWN])
    of_runs: dict[int, list[Evaluation]] = {}
    for score in rows.defer("outcomes").order_by():
        of_runs.setdefault(score.run_id, []).append(score)
    shown = {run: shown_scores(of_run, split.criterion) for run, of_run in of_runs.items()}
    return {
        run: {source: score for (_, source), score in of_run.items()}
        for run, of_run in shown.items()
        if of_run
    }


def _notes(
    keys: Sequence[int],
    named: Sequence[TrainingRun],
    fitting: Sequence[TrainingRun],
    split: Split | None,
    part: str,
) -> list[str]:
    notes = []
    if len(named) < len(keys):
        missing = len(keys) - len(named)
        notes.append(
            f"{say_count(missing, 'run')} of this address {'is' if missing == 1 else 'are'} not in this world "
            "or did not succeed."
        )
    for run in named:
        if run.split != split:
            notes.append(
                f"Run {run.pk} was trained on another split ({run.split.name}): its examples are others."
            )
        elif run not in fitting:
            notes.append(f"Run {run.pk} has no answers on the {part} part.")
    if len(fitting) > MOST_RUNS:
        notes.append(f"{MOST_RUNS} runs are compared at once, the first ones.")
    return notes
