"""Lets a language model paraphrase the prompts of a campaign. A worker carries it out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from http import HTTPStatus
from typing import Any

from annotations.background.progress import Progress
from annotations.background.requesting import request_job_once
from annotations.campaigns.model_rewrites import (
    ModelSettings,
    WantedRewrites,
    exact_names,
    model_contributor,
    prompts_to_ask,
    store_rewrites,
)
from annotations.campaigns.tasks import require_open
from annotations.labelling.proposal_requests import request_readings
from annotations.language.corpus import check_instructions, rewrite_request, rewrites_in
from annotations.language.texts import Refusal
from annotations.models import Campaign, Job, JobKind, User
from annotations.models.campaigns import SubmissionStatus
from parser_service.parsers.model_server.asker import Asker
from parser_service.parsers.model_server.exchange import NoAnswer
from parser_service.parsers.model_server.protocol import Question
from parser_service.parsers.server_address import problem_of, server

AT_ONCE = 4  # questions that the server has at a time
TOGETHER = 8  # prompts that are asked before what came of them is stored
MOST_TOKENS = 1_000  # of a reply
MOST_SILENT = 24  # prompts in a row without an answer, after which the server is away


def request_paraphrases(campaign: Campaign, settings: ModelSettings, by: User) -> tuple[Job, bool]:
    """Queue a job that lets a model contribute; the one that waits or runs already comes back with False.

    Raises:
        Refusal: no server can be asked, the campaign is over, or the settings are none.
    """
    if problem := problem_of(server()):
        raise Refusal(problem, "no_language_model_server", HTTPStatus.CONFLICT)
    require_open(campaign)
    check_instructions(settings.instructions)
    if not settings.model:
        raise Refusal("Name a model that the server has.", "no_model")
    waiting = Job.objects.active().filter(
        kind=JobKind.PARAPHRASE, world=campaign.world, arguments__campaign=campaign.pk
    )
    arguments = {"campaign": campaign.pk, **asdict(settings)}
    return request_job_once(waiting, JobKind.PARAPHRASE, campaign.world, by, arguments)


def paraphrase_of(job: Job, progress: Progress) -> dict[str, Any]:
    """Carry out a job of ``request_paraphrases`` and return its report."""
    arguments = dict(job.arguments)
    campaign = Campaign.objects.filter(world=job.world, pk=arguments.pop("campaign")).first()
    if campaign is None:
        raise Refusal("The campaign is gone.", "campaign_gone", HTTPStatus.CONFLICT)
    return paraphrase(campaign, ModelSettings(**arguments), progress)


def paraphrase(campaign: Campaign, settings: ModelSettings, progress: Progress) -> dict[str, Any]:
    """Ask the model for rewrites of prompts whose forms want more, within its budget.

    Forms of which rewrites were dropped have their turn again, with other prompts. What it wrote is stored
    prompt by prompt, and the server's answers are kept, so that a job after an interruption asks nothing
    twice. A prompt that the server does not answer is asked again by the next job.

    Returns:
        ``asked`` prompts, ``rewrites`` that wait for moderation, ``dropped`` by code, prompts ``unanswered``, and
        whether the ``budget`` ended it.

    Raises:
        Refusal: the server answers nobody.
    """
    contributor = model_contributor(campaign, settings)
    asker = Asker(server(), AT_ONCE)
    counts: Counter[str] = Counter()
    dropped: Counter[str] = Counter()
    silent: list[int] = []  # keys of the prompts without an answer
    in_a_row = 0
    while wanted := prompts_to_ask(contributor, settings.wordings, silent):
        done = counts["asked"] + len(silent)
        some = wanted[: min(TOGETHER, settings.budget - done)]
        if not some:
            break
        total = min(settings.budget, done + len(wanted))
        progress.report(done / total, f"{done:,} of {total:,} prompts")
        answers = asker.ask_each(_questions(some, settings), progress.check)
        for asked, answer in zip(some, answers, strict=True):
            if isinstance(answer, NoAnswer):
                silent.append(asked.prompt.pk)
                in_a_row += 1
                continue
            in_a_row = 0
            counts["asked"] += 1
            rewrites = rewrites_in(answer.text)[: asked.number]
            # A transaction for each prompt: flags are worked out within, and others write meanwhile.
            with progress.writing():
                stored = store_rewrites(contributor, asked.prompt, answer.text, rewrites)
            for each in stored:
                if each.status == SubmissionStatus.PENDING:
                    counts["rewrites"] += 1
                else:
                    dropped.update(flag["code"] for flag in each.flags)
        if in_a_row >= MOST_SILENT and isinstance(answers[-1], NoAnswer):
            raise answers[-1]
    request_readings(campaign.world)
    return {
        "campaign": campaign.pk,
        "asked": counts["asked"],
        "rewrites": counts["rewrites"],
        "dropped": dict(dropped),
        "unanswered": len(silent),
        "budget_spent": bool(wanted),
    }


def _questions(wanted: Sequence[WantedRewrites], settings: ModelSettings) -> list[Question]:
    questions = []
    for asked in wanted:
        text = rewrite_request(
            settings.instructions, asked.prompt.shown, exact_names(asked.prompt), asked.number
        )
        messages = ({"role": "user", "content": text},)
        questions.append(
            Question(
                settings.model, messages, None, settings.seed, MOST_TOKENS, settings.temperature
            )
        )
    return questions
