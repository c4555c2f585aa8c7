"""Starts the launch of a campaign for pages and routes: at once where it draws few prompts, otherwise as a job."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from django.core.serializers.json import DjangoJSONEncoder

from annotations.background.job_weight import MOST_PROMPTS
from annotations.background.requesting import start_work
from annotations.background.watching import JobProgress
from annotations.campaigns.launching import (
    PromptChoice,
    draw_prompts,
    launch,
    name_taken,
    report_of,
)
from annotations.generation.language_size import is_large
from annotations.language.texts import LanguageError
from annotations.models import Campaign, Job, JobKind, SemanticTemplate, User, World
from annotations.models.campaigns import Balance

MOST_SHOWN = 8  # prompts of a preview


def start_launch(
    world: World, values: Mapping[str, Any], choice: PromptChoice, by: User
) -> Job | Campaign:
    """Launch a campaign of these ``values`` now, or return the job that does. Raises as ``launch``."""
    if world.campaigns.filter(name=values["name"]).exists():
        raise name_taken(values["name"])
    kept = json.loads(json.dumps(values, cls=DjangoJSONEncoder))  # a day and a price as text
    arguments = {"choice": asdict(choice), "values": kept}
    asked = is_heavy(world, choice), JobKind.LAUNCH, world, by, arguments
    return start_work(*asked, lambda: launch(Campaign(world=world, **values), choice, by))


def start_preview(world: World, choice: PromptChoice, by: User) -> Job | dict[str, Any]:
    """Return what ``preview`` does, or the job that reports it. Raises likewise."""
    asked = is_heavy(world, choice), JobKind.LAUNCH, world, by, {"choice": asdict(choice)}
    return start_work(*asked, lambda: preview(world, choice))


def is_heavy(world: World, choice: PromptChoice) -> bool:
    """Return whether drawing the prompts takes too long for a request."""
    is_by_line = choice.balance == Balance.LINES
    lines = SemanticTemplate.objects.filter(grammar__world=world)
    groups = lines if is_by_line else world.logical_forms
    prompts = groups.count() * choice.prompts_per_form
    if choice.most_prompts is not None:
        prompts = min(prompts, choice.most_prompts)
    return prompts > MOST_PROMPTS or is_large(world)


def preview(world: World, choice: PromptChoice) -> dict[str, Any]:
    """Count what ``launch`` would draw, and show some ``prompts`` of it. Raises as ``draw_prompts``."""
    drawn = draw_prompts(world, choice)
    forms = {each.expansion.form_text for each in drawn}
    step = -(-len(drawn) // MOST_SHOWN)  # from all over: those of one form stand together
    shown = [each.shown for each in drawn[::step]]
    return {"prompts": shown, "count": len(drawn), "forms": len(forms)}


def launch_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    """Launch a campaign, or only preview one, as the arguments of the job say."""
    if job.world is None:
        raise LanguageError(f"there is no world “{job.world_name}” any more")
    asked = job.arguments["choice"]
    choice = PromptChoice(**{**asked, "task_categories": tuple(asked["task_categories"])})
    if "values" in job.arguments:
        unsaved = Campaign(world=job.world, **job.arguments["values"])
        return report_of(launch(unsaved, choice, job.created_by, progress))
    progress.report(0, "drawing prompts")
    return preview(job.world, choice)
