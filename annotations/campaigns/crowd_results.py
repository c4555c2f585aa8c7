"""Verbs: check the results of a crowd market, and import them as submissions that wait for moderation."""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from http import HTTPStatus
from typing import Any

from django.utils import timezone

from annotations.background.progress import UNWATCHED, Progress
from annotations.campaigns.answering import MOST_COMPARED, named_in
from annotations.campaigns.launching import MOST_PROMPTS, row_of
from annotations.campaigns.pseudonyms import pseudonym_of
from annotations.exchange.prompt_sources import SourceFinder
from annotations.language.corpus import (
    Assignment,
    CrowdRewrite,
    CrowdTable,
    Flag,
    FreeCommand,
    Named,
    Rewrite,
    bare_words,
    entities_in,
    free_command_flags,
    rewrite_flags,
)
from annotations.language.forms import read_form
from annotations.language.grounding import ground_text
from annotations.language.texts import (
    KnownWords,
    Position,
    Problem,
    Refusal,
    error_at,
    normalise_line,
    warning_at,
)
from annotations.models import Campaign, CampaignPrompt, Contributor, Submission, User, World
from annotations.models.campaigns import ContributorKind, SubmissionKind
from annotations.rows.from_rows import ontology_of
from annotations.rows.staging import insert_prepared, prepared
from annotations.rows.stored_problems import as_json, first_problems
from annotations.rows.synchronise import BATCH, batches

MOST_EXAMPLES = 12
PLAIN_EXAMPLES = 3  # of them without a flag
CHECK_EVERY = 50  # assignments
# Salts the hash by which an assignment is known again, and names it in the settings of its contributor.
ASSIGNMENT = "assignment"
# The columns of a submission: where it stands, and what needs no transaction to be known.
_PLACE = ("contributor_id", "position", "prompt_id")
_COLUMNS = (
    *("kind", "text", "raw", "seconds", "was_pasted", "flags", "given_at", "answered_at", "status"),
)


@dataclass(frozen=True, slots=True)
class PlannedSubmission:
    """What becomes a submission; ``prompt`` is None for a command of somebody's own."""

    prompt: CampaignPrompt | None
    text: str
    flags: Sequence[Flag]


@dataclass(frozen=True, slots=True)
class PlannedContributor:
    """Somebody who did a task. ``seconds`` are those of one answer."""

    assignment: Assignment
    seconds: float | None
    submissions: Sequence[PlannedSubmission]


@dataclass
class ResultPlan:
    """What an import of results would store.

    ``campaign`` is unsaved where the table makes a new one, of ``prompts``. ``repeated`` assignments are here
    already or stand twice in the table. ``unmatched`` answers are to no prompt of the campaign.
    """

    campaign: Campaign
    prompts: list[CampaignPrompt] = field(default_factory=list)
    contributors: list[PlannedContributor] = field(default_factory=list)
    repeated: int = 0
    unmatched: int = 0
    problems: list[Problem] = field(default_factory=list)

    @property
    def is_refused(self) -> bool:
        return any(each.is_error for each in self.problems)

    def submissions(self) -> Iterator[tuple[PlannedContributor, PlannedSubmission]]:
        for contributor in self.contributors:
            for submission in contributor.submissions:
                yield contributor, submission

    def report(self, table: CrowdTable) -> dict[str, Any]:
        """Return counts, flags and problems, as a job keeps them. Nobody's id is in them."""
        flags = Counter(flag.code for _, each in self.submissions() for flag in each.flags)
        kinds = Counter(each.prompt is None for _, each in self.submissions())
        workers = {(each.assignment.market, each.assignment.worker) for each in self.contributors}
        return {
            "campaign": self.campaign.pk,
            "name": self.campaign.name,
            "counts": {
                "assignments": len(self.contributors),
                "workers": len(workers),
                "rewrites": kinds[False],
                "free_commands": kinds[True],
                "prompts": len(self.prompts),
                "rejected": table.rejected,
                "unfinished": table.unfinished,
                "repeated": self.repeated,
                "empty": table.empty,
                "unmatched": self.unmatched,
                "comments": table.comments,
            },
            "flags": {str(code): count for code, count in sorted(flags.items())},
            "problems": [as_json(each) for each in first_problems(self.problems)],
        }

    def examples(self) -> list[dict[str, Any]]:
        """Return a few submissions without flags, and some for each flag."""
        shown: list[dict[str, Any]] = []
        counts = Counter[str]()
        for contributor, each in self.submissions():
            codes = [str(flag.code) for flag in each.flags] or [""]
            if all(counts[code] >= (1 if code else PLAIN_EXAMPLES) for code in codes):
                continue
            counts.update(codes)
            shown.append(
                {
                    "line": contributor.assignment.line,
                    "prompt": each.prompt.shown if each.prompt else "",
                    "text": each.text,
                    "flags": as_rows(each.flags),
                }
            )
            if len(shown) == MOST_EXAMPLES:
                break
        return shown


def as_rows(flags: Sequence[Flag]) -> list[dict[str, str]]:
    """Return flags as a submission stores them."""
    return [{"code": str(flag.code), "evidence": flag.evidence} for flag in flags]


def new_campaign(world: World, name: str, table: CrowdTable, by: User | None) -> Campaign:
    """Return an unsaved campaign that is closed, for results whose prompts no campaign has."""
    sizes = [(len(each.rewrites), len(each.free_commands)) for each in table.assignments]
    return Campaign(
        world=world,
        name=name,
        task_size=max((rewrites for rewrites, _ in sizes), default=1) or 1,
        free_commands=max((free for _, free in sizes), default=0),
        created_by=by,
        closed_at=timezone.now(),
    )


def plan_results(
    campaign: Campaign, table: CrowdTable, source: str, progress: Progress = UNWATCHED
) -> ResultPlan:
    """Find the prompt of each answer, and its flags: those that the public page gives, at the same bounds.

    Args:
        campaign: an unsaved one gets the prompts that the table has.
        source: the name of the file, for problems.
    """
    plan = ResultPlan(campaign, problems=list(table.problems))
    prompts: _OldPrompts | _NewPrompts
    prompts = _NewPrompts(plan, source) if campaign.pk is None else _OldPrompts(campaign)
    seen = _known_assignments(campaign)
    problems, has_matched = plan.problems, False
    for number, assignment in enumerate(table.assignments):
        if number % CHECK_EVERY == 0:
            progress.report(0.1 + 0.8 * number / len(table.assignments), "looking at the answers")
        if not seen.isdisjoint(_digests(campaign, assignment)):
            plan.repeated += 1
            continue
        seen.add(_digests(campaign, assignment)[0])
        matched: list[tuple[_Prompt, str]] = []
        for rewrite in assignment.rewrites:
            prompt = prompts.find(rewrite, assignment.line)
            if prompt is not None:
                matched.append((prompt, rewrite.text))
            elif campaign.pk is not None:
                plan.unmatched += 1
                place = Position(source, assignment.line, rewrite.column)
                message = "this answers no prompt of the campaign; left out"
                hint = "choose the campaign whose task file it was, or make a new one"
                problems.append(warning_at(place, message, hint))
        has_matched = has_matched or bool(matched)
        answers = len(assignment.rewrites) + len(assignment.free_commands)
        seconds = None if assignment.seconds is None else assignment.seconds / answers
        submissions = list(_submissions(matched, assignment.free_commands, seconds))
        if submissions:
            plan.contributors.append(PlannedContributor(assignment, seconds, submissions))
    if plan.unmatched and not has_matched:
        message = f"no answer in this table is to a prompt of {campaign.name}"
        hint = "choose its campaign, or make a new one"
        plan.problems[:] = [*table.problems, error_at(Position(source), message, hint)]
    return plan


def store_results(
    plan: ResultPlan, table: CrowdTable, by: User | None, progress: Progress = UNWATCHED
) -> dict[str, Any]:
    """Write what was planned, all or nothing, and return the report.

    A worker is known by a pseudonym, the same one that the link with their id gives. Assignments that somebody
    has imported meanwhile are left out.

    Raises:
        Refusal: the world has another campaign of the new one's name.
    """
    campaign, now = plan.campaign, timezone.now()
    progress.report(0.9, "writing")
    # Others write to the world only before and after the transaction, so that what can be done before it is.
    rows = []
    for each in plan.contributors:
        progress.check()
        rows.append(prepared(Submission, _COLUMNS, _unplaced(each, now)))
    with progress.writing():
        # Who imports at the same moment waits here, and finds these.
        World.objects.hold().get(pk=campaign.world_id)
        if campaign.pk is None:
            _store_campaign(plan)
        known = _known_assignments(campaign)
        attempts = Counter[str]()
        for pseudonym, attempt in campaign.contributors.values_list("pseudonym", "attempt"):
            attempts[pseudonym] = max(attempts[pseudonym], attempt)
        contributors: list[Contributor] = []
        new: list[int] = []
        for place, each in enumerate(plan.contributors):
            digests = _digests(campaign, each.assignment)
            if not known.isdisjoint(digests):
                plan.repeated += 1
                continue
            new.append(place)
            pseudonym = pseudonym_of(campaign, each.assignment.market, each.assignment.worker)
            attempts[pseudonym] += 1
            contributors.append(
                Contributor(
                    campaign=campaign,
                    kind=ContributorKind.FILE,
                    pseudonym=pseudonym,
                    attempt=attempts[pseudonym],
                    settings={ASSIGNMENT: digests[0]},
                    began_at=now,
                    finished_at=now,
                )
            )
        for some in batches(contributors, BATCH):
            progress.check()
            Contributor.objects.bulk_create(some)
        plan.contributors = [plan.contributors[place] for place in new]
        submissions = (
            [contributor.pk, position, submission.prompt and submission.prompt.pk, *values]
            for contributor, place, planned in zip(
                contributors, new, plan.contributors, strict=True
            )
            for position, (submission, values) in enumerate(
                zip(planned.submissions, rows[place], strict=True), start=1
            )
        )
        for batch in batches(submissions, BATCH):
            progress.check()
            insert_prepared(Submission, (*_PLACE, *_COLUMNS), batch)
        report = plan.report(table)
        progress.conclude(report)
    return report


def _unplaced(planned: PlannedContributor, now: datetime) -> Iterator[Submission]:
    for each in planned.submissions:
        yield Submission(
            kind=SubmissionKind.FREE if each.prompt is None else SubmissionKind.REWRITE,
            text=each.text,
            seconds=planned.seconds,
            flags=as_rows(each.flags),
            given_at=now,
            answered_at=now,
        )


def _store_campaign(plan: ResultPlan) -> None:
    campaign = plan.campaign
    if campaign.world.campaigns.filter(name=campaign.name).exists():
        said = f"This world has a campaign called {campaign.name} already. Choose another name."
        raise Refusal(said, "name_taken", HTTPStatus.CONFLICT)
    campaign.save()
    for position, prompt in enumerate(plan.prompts, start=1):
        prompt.campaign, prompt.position = campaign, position
    CampaignPrompt.objects.bulk_create(plan.prompts, batch_size=BATCH)


def _known_assignments(campaign: Campaign) -> set[str]:
    if campaign.pk is None:
        return set()
    rows = campaign.contributors.filter(kind=ContributorKind.FILE)
    return {settings.get(ASSIGNMENT, "") for settings in rows.values_list("settings", flat=True)}


def _digests(campaign: Campaign, assignment: Assignment) -> list[str]:
    """Return the hashes by which an assignment is known again; the first one is stored.

    That is of the market's id of it, where the table has one. Without it, and for what was stored before ids were
    read, it is of who did it and of all that they wrote.
    """
    answers = [(each.command, each.grounded_form, each.text) for each in assignment.rewrites]
    written = [assignment.market, assignment.worker, answers, assignment.free_commands]
    contents = [[assignment.market, assignment.key], written] if assignment.key else [written]
    return [pseudonym_of(campaign, ASSIGNMENT, json.dumps(each)) for each in contents]


@dataclass(slots=True)
class _Prompt:
    """A prompt, and what its rewrites are compared with.

    ``said`` are the texts that it has, by their words: to be compared with thousands at once.
    """

    row: CampaignPrompt
    names: tuple[Named, ...]
    known: KnownWords
    said: dict[str, str] = field(default_factory=dict)
    of_models: Sequence[str] = ()

    @classmethod
    def of(cls, row: CampaignPrompt, of_models: Sequence[str] = ()) -> _Prompt:
        known = KnownWords([row.shown, row.prompt])
        return cls(row, named_in(row), known, of_models=of_models)


class _OldPrompts:
    """The prompts of a stored campaign, with what was written for them."""

    def __init__(self, campaign: Campaign) -> None:
        answered = Submission.objects.answered().filter(
            contributor__campaign=campaign, kind=SubmissionKind.REWRITE
        )
        by_models = answered.filter(contributor__kind=ContributorKind.MODEL).order_by("pk")
        of_models: dict[str, list[str]] = defaultdict(list)
        for form, text in by_models.values_list("prompt__logical_form", "text").iterator():
            if len(of_models[form]) < MOST_COMPARED:
                of_models[form].append(text)
        rows = {
            row.pk: _Prompt.of(row, of_models.get(row.logical_form, ()))
            for row in campaign.prompts.filter(check_words="")
        }
        for key, text in answered.order_by("pk").values_list("prompt_id", "text").iterator():
            if key in rows:
                rows[key].said.setdefault(bare_words(text), text)
        self._shown: dict[str, list[_Prompt]] = defaultdict(list)
        for prompt in rows.values():
            for shown in {normalise_line(prompt.row.shown), normalise_line(prompt.row.prompt)}:
                self._shown[shown].append(prompt)

    def find(self, rewrite: CrowdRewrite, line: int) -> _Prompt | None:
        """Return the prompt with the text and the forms that the table has; None where there is none, or several."""
        fitting = self._shown.get(rewrite.command, [])
        if rewrite.grounded_form:
            fitting = [each for each in fitting if each.row.grounded_form == rewrite.grounded_form]
        if rewrite.form:
            fitting = [each for each in fitting if each.row.logical_form == rewrite.form]
        is_certain = len({each.row.logical_form for each in fitting}) == 1
        return fitting[0] if is_certain else None


class _NewPrompts:
    """Prompts that are made of a table, each once. They join those of the plan."""

    def __init__(self, plan: ResultPlan, source: str) -> None:
        self._plan, self._source = plan, source
        self._prompts: dict[tuple[str, str, str], _Prompt | None] = {}
        self._finder = SourceFinder(plan.campaign.world)
        self._ontology = ontology_of(plan.campaign.world)

    def find(self, rewrite: CrowdRewrite, line: int) -> _Prompt | None:
        """Return the prompt of an answer. None, with an error among the problems, where it cannot be made."""
        key = rewrite.command, rewrite.form, rewrite.grounded_form
        if key not in self._prompts:
            self._prompts[key] = self._make(rewrite, Position(self._source, line, rewrite.column))
        return self._prompts[key]

    def _make(self, rewrite: CrowdRewrite, place: Position) -> _Prompt | None:
        if not rewrite.grounded_form:
            hint = "add Input.parse_ground of this prompt, or choose the campaign that it is of"
            self._plan.problems.append(error_at(place, "this prompt has no logical form", hint))
            return None
        if len(self._plan.prompts) == MOST_PROMPTS:
            message = f"the table has more than {MOST_PROMPTS:,} prompts"
            self._plan.problems.append(error_at(place, message, "split it up"))
            return None
        grounded = read_form(rewrite.grounded_form)
        label = read_form(rewrite.form) if rewrite.form else None
        text = rewrite.command if label is None else ground_text(rewrite.command, label, grounded)
        found = self._finder.source(text, grounded)
        command = self._finder.command(rewrite.command) or found.command
        row = CampaignPrompt(
            command=command,
            command_text=command.anonymized_text if command else rewrite.command,
            task_category=command.task_category if command else "",
            logical_form=rewrite.form or found.logical_form,
            prompt=text,
            grounded_form=rewrite.grounded_form,
            shown=text,
            entities=[row_of(each) for each in entities_in(text, grounded, self._ontology)],
        )
        self._plan.prompts.append(row)
        return _Prompt.of(row)


def _submissions(
    rewrites: Sequence[tuple[_Prompt, str]], free_commands: Sequence[str], seconds: float | None
) -> Iterator[PlannedSubmission]:
    """Yield what one contributor submitted, with its flags, each compared with what came before it."""
    own: dict[str, str] = {}  # words → the text that has them
    written: list[tuple[_Prompt, str, str]] = []
    for prompt, text in rewrites:
        words = bare_words(text)
        repeated = own.get(words) or prompt.said.get(words)
        rewrite = Rewrite(
            text,
            prompt.row.shown,
            prompt.names,
            seconds,
            # Equal words alone make a repeat, so that one text stands for all.
            own=(repeated,) if repeated else (),
            of_models=prompt.of_models,
        )
        yield PlannedSubmission(prompt.row, text, rewrite_flags(rewrite, prompt.known.__contains__))
        own.setdefault(words, text)
        written.append((prompt, words, text))
    for prompt, words, text in written:  # what somebody writes twice is their own, not of others
        prompt.said.setdefault(words, text)
    prompts = tuple(prompt.row.shown for prompt, _ in rewrites)
    texts = [text for _, text in rewrites]
    known = KnownWords(prompts) if free_commands else None
    for text in free_commands:
        assert known is not None
        command = FreeCommand(text, prompts, tuple(texts))
        yield PlannedSubmission(None, text, free_command_flags(command, known.__contains__))
        texts.append(text)
