"""Starts freezing for pages and routes: at once where a split is small, otherwise as a job."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from annotations.background.job_weight import MOST_EXAMPLES
from annotations.background.requesting import start_work
from annotations.background.watching import JobProgress
from annotations.generation.freezing import (
    as_items,
    freeze_split,
    plan_split,
    report_of,
    require_free,
    unresolved_prompts,
)
from annotations.generation.renewing import freeze_anew, require_last
from annotations.generation.split_statistics import figures_of_planned
from annotations.language.corpus import Criterion
from annotations.language.texts import LanguageError
from annotations.models import Job, JobKind, Split, User, World


def start_freezing(
    world: World, by: User, name: str, must_be_new: bool = False, **choice: Any
) -> Job | Split:
    """Freeze now, or return the job that does. ``choice`` and what is raised are as in ``freeze_split``."""
    if must_be_new:
        require_free(world, name)
    arguments = {"name": name, "must_be_new": must_be_new, **choice}
    asked = is_large(world), JobKind.FREEZE, world, by, arguments
    return start_work(*asked, lambda: freeze_split(world, by=by, **arguments))


def start_renewal(old: Split, by: User) -> Job | Split:
    """Freeze ``old`` anew now, or return the job that does. Raises as ``freeze_anew``."""
    require_last(old)
    is_heavy = is_large(old.world) or old.examples.count() > MOST_EXAMPLES
    asked = is_heavy, JobKind.FREEZE, old.world, by, {"follows": old.pk}
    return start_work(*asked, lambda: freeze_anew(old, by))


def start_preview(world: World, by: User, **choice: Any) -> Job | dict[str, Any]:
    """Return what ``preview`` does, or the job that reports it."""
    asked = is_large(world), JobKind.FREEZE, world, by, choice
    return start_work(*asked, lambda: preview(world, **choice))


def is_large(world: World) -> bool:
    """Return whether a split of ``world`` takes too long for a request."""
    rows = world.commands, world.paraphrases.accepted(), world.utterances.labelled()
    return sum(each.count() for each in rows) > MOST_EXAMPLES


def preview(world: World, **choice: Any) -> dict[str, Any]:
    """Count what ``freeze_split`` would store: ``counts`` by source, and the ``unresolved`` prompts."""
    planned = plan_split(world, **choice)
    is_by_prompt = choice["criterion"] == Criterion.SOURCE_COMMAND
    unresolved = unresolved_prompts(as_items(planned)).values() if is_by_prompt else ()
    counts = [{**asdict(each), "total": each.total} for each in figures_of_planned(planned).counts]
    return {"counts": counts, "unresolved": sorted(unresolved)}


def freeze_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    """Freeze a split, freeze one anew, or only preview one, as the arguments of the job say."""
    world, arguments = job.world, job.arguments
    if world is None:
        raise LanguageError(f"there is no world “{job.world_name}” any more")
    if "follows" in arguments:
        old = world.splits.get(pk=arguments["follows"])
        return report_of(freeze_anew(old, job.created_by, progress))
    if "name" in arguments:
        return report_of(freeze_split(world, by=job.created_by, progress=progress, **arguments))
    progress.report(0, "parting the pairs")
    return preview(world, **arguments)
