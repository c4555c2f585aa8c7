"""What waits in a world, sorted by who does it. The overview shows it, the reader's own work first.

Each count is the number of rows on the page that its link opens: tests/gpsr_site/overview/test_work_list.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from django.urls import reverse

from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.language.texts import say_count
from annotations.models import Duty, Job, World
from annotations.models.worlds import Role
from gpsr_site.overview.best_runs import BestRuns
from gpsr_site.overview.counts import Counts
from gpsr_site.overview.workers import Workers

# The duty that makes somebody one of a role, the role with most to decide first.
ROLES = {Role.ADMIN: Duty.MANAGE, Role.ANNOTATOR: Duty.ANNOTATE, Role.REVIEWER: Duty.REVIEW}


@dataclass(frozen=True, slots=True)
class Task:
    """Something to do: how much, and the page (or, where ``is_action``, the button) that does it.

    ``tone`` is ``bad`` for what went wrong, ``warn`` for what should be looked at, or empty.
    """

    count: int
    sentence: str
    label: str
    url: str
    tone: str = ""
    is_action: bool = False


@dataclass(frozen=True, slots=True)
class WorkGroup:
    """The work of one role; ``is_own`` where the reader has that role."""

    role: Role
    items: tuple[Task, ...]
    is_own: bool

    @property
    def title(self) -> str:
        return "Your work" if self.is_own else f"For {self.role}s"


@dataclass(frozen=True, slots=True)
class WaitingRows:
    """Rows that wait. ``field`` is the field of ``Counts``, ``page`` and ``query`` list exactly them.

    Said as ``3 draft templates``, with ``after`` behind it. Where it ``is_action``, ``page`` is posted to.
    """

    field: str
    noun: str
    label: str
    page: str
    query: str = ""
    tone: str = ""
    after: str = ""
    is_action: bool = False


FOR_ADMINS = (
    WaitingRows("runs_failed", "failed run", "Read why", "runs", "?status=failed&since=no", "bad"),
    WaitingRows("runs_lost", "lost run", "Read why", "runs", "?status=lost&since=no", "bad"),
    WaitingRows(
        "promotions_proposed", "run", "Decide", "promotions", "", "", "proposed for promotion"
    ),
    WaitingRows("ontology_problems", "warning", "Read", "ontology", "", "warn", "on the ontology"),
    WaitingRows("grammar_problems", "warning", "Read", "grammar", "", "warn", "on the grammar"),
    WaitingRows("runs_running", "run", "Watch", "runs", "?status=running", "", "in progress"),
)
FOR_ANNOTATORS = (
    WaitingRows(
        *("work_items_free", "item", "Take the next", "queue_next"),
        after="in the work queue",
        is_action=True,
    ),
    WaitingRows("uncovered", "command", "Annotate", "uncovered", "", "warn", "without a form"),
    WaitingRows(
        "template_problems",
        "template",
        "Repair",
        "templates",
        "?problems=yes",
        "warn",
        "with problems",
    ),
    WaitingRows(
        *("utterances_waiting", "utterance", "Label", "label"),
        after="without a form, not waiting in the queue",
    ),
    WaitingRows("command_problems", "warning", "Read", "commands", "", "warn", "on commands"),
    WaitingRows("drafts", "draft template", "Finish", "templates", "?status=draft"),
    WaitingRows("disputed", "disputed template", "Settle", "templates", "?status=disputed"),
)
FOR_REVIEWERS = (
    WaitingRows(
        "paraphrases_waiting",
        "paraphrase",
        "Read",
        "paraphrases",
        "?status=pending",
        "",
        "to judge",
    ),
    WaitingRows("audit_findings", "label", "Decide", "audit", "?status=open", "", "in doubt"),
)


@dataclass(frozen=True, slots=True)
class WorkList:
    """What waits in ``world`` for somebody with ``duties``.

    ``is_only_world`` is true for an administrator of the site, who may make another one, where there is none yet.
    """

    world: World
    counts: Counts
    duties: frozenset[Duty]
    workers: Workers
    best: BestRuns | None = None
    jobs: Iterable[Job] = ()
    is_only_world: bool = False

    @property
    def groups(self) -> list[WorkGroup]:
        """The items by role, the reader's own first; others' groups without items are left out.

        An item stands once, in the first group that has it.
        """
        order = [*self.own_roles, *(role for role in ROLES if role not in self.own_roles)]
        groups: list[WorkGroup] = []
        seen: set[Task] = set()
        for role in order:
            items = tuple(item for item in self._items_of(role) if item not in seen)
            seen.update(items)
            groups.append(WorkGroup(role, items, role in self.own_roles))
        own = [group for group in groups if group.is_own]
        if own:  # one group, for somebody with several roles
            items = tuple(item for each in own for item in each.items)
            others = [group for group in groups if not group.is_own]
            groups = [WorkGroup(own[0].role, items, True), *others]
        return [group for group in groups if group.items or group.is_own]

    @property
    def items(self) -> list[Task]:
        """All items in one list, the reader's own first."""
        return [item for group in self.groups for item in group.items]

    @property
    def own_roles(self) -> list[Role]:
        """The reader's roles. An admin may do everything; the others' work stands behind theirs."""
        roles = [role for role, duty in ROLES.items() if duty in self.duties]
        return roles[:1] if Role.ADMIN in roles else roles

    def _items_of(self, role: Role) -> Iterator[Task]:
        yield from self._jobs_of(role)
        if role == Role.ADMIN:
            yield from self._stale()
            yield from self._queued_runs()
            yield from self._waiting(FOR_ADMINS)
            yield from self._missing_people()
            yield from self._missing_world()
        elif role == Role.ANNOTATOR:
            yield from self._waiting(FOR_ANNOTATORS)
            yield from self._stale()
        else:
            # For others these stand beside the best parsers.
            is_reviewer = Role.REVIEWER in self.own_roles
            best = self.best if is_reviewer else None
            source = best.source if best else ""
            for run in best.runs if best else ():
                if run.wrong:
                    answers = say_count(run.wrong, "wrong answer")
                    sentence = f"{answers} of {run.title} on {source}"
                    yield Task(run.wrong, sentence, "Read", run.wrong_url)
            yield from self._waiting(FOR_REVIEWERS)

    def _missing_people(self) -> Iterator[Task]:
        """Yield an item for whoever may add people; before the first parser it is one of the first steps."""
        is_alone = self.counts.members <= 1 and self.counts.evaluated
        if is_alone and Duty.MANAGE in self.duties:
            who = "Only one person" if self.counts.members else "Nobody"
            sentence = f"{who} belongs to this world"
            yield Task(1, sentence, "Invite people", self._address("people"))

    def _missing_world(self) -> Iterator[Task]:
        """Yield an item for an administrator of the site whose only world came with the project."""
        if self.is_only_world and self.world.name in SHIPPED_WORLDS:
            sentence = "Your own files need a world of their own"
            yield Task(1, sentence, "New world", reverse("world_new"))

    def _waiting(self, declared: Iterable[WaitingRows]) -> Iterator[Task]:
        for waiting in declared:
            if waiting.field == "uncovered" and self.counts.awaits_first_commands:
                continue
            if count := getattr(self.counts, waiting.field):
                sentence = f"{say_count(count, waiting.noun)} {waiting.after}".strip()
                url = self._address(waiting.page) + waiting.query
                yield Task(count, sentence, waiting.label, url, waiting.tone, waiting.is_action)

    def _jobs_of(self, role: Role) -> Iterator[Task]:
        """Yield an item for each import or generation, which leads to its own page."""
        for job in self.jobs:
            if job.duty == ROLES[role]:
                url = reverse("job", kwargs={"pk": job.pk})
                if job.is_waiting_for_answer:
                    sentence = f"{job.title} waits for an answer"
                    yield Task(1, sentence, "Answer", url, "warn")
                else:
                    yield Task(1, f"{job.title}: {job.status}", "Watch", url)

    def _stale(self) -> Iterator[Task]:
        """Yield one item, a button that generates all commands; not where it is one of the first steps."""
        is_first_step = self.counts.awaits_first_commands and not self.counts.evaluated
        if is_first_step or not self.counts.generation_waiting or Duty.ANNOTATE not in self.duties:
            return
        sentence = (
            "Commands are out of date: grammar or templates have changed"
            if self.counts.commands
            else "Commands wait to be generated"
        )
        yield Task(
            1, sentence, "Generate commands", self._address("generate"), "warn", is_action=True
        )

    def _queued_runs(self) -> Iterator[Task]:
        waiting = self.counts.runs_queued
        if not waiting:
            return
        url = self._address("runs") + "?status=queued"
        if not self.workers.is_work_left:
            yield Task(waiting, say_count(waiting, "queued run"), "Watch", url)
        else:
            verb = "waits" if waiting == 1 else "wait"
            sentence = f"{say_count(waiting, 'run')} {verb}. {self.workers.headline}"
            yield Task(waiting, sentence, "Watch", url, "bad")

    def _address(self, page: str) -> str:
        return reverse(page, kwargs={"world": self.world.name})
