"""Which runs can be trained again on a split that was frozen anew, and which have been."""

from __future__ import annotations

import json
from dataclasses import dataclass

from annotations.generation.renewing import last_of
from annotations.models import Split
from parser_service.models import TrainingRun
from parser_service.models.runs import TrainingRunQuerySet
from parser_service.runs.run_requests import sources_on

MOST_RUNS = 200  # the newest of a split that are looked at


@dataclass(frozen=True, slots=True)
class Retrainable:
    """A run on the split before, and the one with the same configuration on the new split, if any."""

    run: TrainingRun
    again: TrainingRun | None


def retrainable(split: Split) -> list[Retrainable]:
    """Return the newest succeeded run of each configuration on the split that ``split`` follows."""
    if split.follows_id is None:
        return []
    before = (
        TrainingRun.objects.succeeded().on_all_pairs().filter(split=split.follows_id).for_table()
    )
    newest: dict[str, TrainingRun] = {}
    for run in before.order_by("-pk")[:MOST_RUNS]:
        newest.setdefault(_configuration(run, sources_on(split, run)), run)
    again = _by_configuration(TrainingRun.objects.filter(split=split).for_table())
    return [Retrainable(run, again.get(key)) for key, run in newest.items()]


def retrained(run: TrainingRun) -> tuple[Split | None, TrainingRun | None]:
    """Return the newest split that follows that of ``run``, and the run with its configuration there;
    None for what there is not."""
    newest = last_of(run.split)
    if newest.pk == run.split_id:
        return None, None
    same = TrainingRun.objects.filter(split=newest, parser=run.parser, seed=run.seed)
    return newest, _by_configuration(same).get(_configuration(run, sources_on(newest, run)))


def _by_configuration(runs: TrainingRunQuerySet) -> dict[str, TrainingRun]:
    """Return the newest run of each configuration that has or will have a result."""
    found: dict[str, TrainingRun] = {}
    for run in runs.scored_or_active().order_by("-pk")[:MOST_RUNS]:
        found.setdefault(_configuration(run, run.train_sources), run)
    return found


def _configuration(run: TrainingRun, train_sources: str) -> str:
    values = run.parser, run.protocol, train_sources, run.train_share, run.seed, run.config
    return json.dumps(values, sort_keys=True)
