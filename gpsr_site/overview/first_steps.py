"""What a new world needs, in order, until a first parser has been scored in it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from annotations.models import Duty
from gpsr_site.overview.counts import Counts

WHO = {
    Duty.VIEW: "",
    Duty.ANNOTATE: "an annotator or admin does this",
    Duty.MANAGE: "an admin does this",
}


@dataclass(frozen=True, slots=True)
class FirstStep:
    """One step. ``name`` is the URL of its page, or of the action where ``is_action``; ``who`` says
    who takes it where the reader may not. The steps after an ``is_optional`` one do not wait for it."""

    sentence: str
    label: str
    name: str
    duty: Duty
    is_done: bool
    is_action: bool = False
    is_optional: bool = False
    is_next: bool = False
    is_allowed: bool = False

    @property
    def is_ready(self) -> bool:
        """Whether it can be taken now."""
        return not self.is_done and (self.is_next or self.is_optional)

    @property
    def who(self) -> str:
        return "" if self.is_allowed else WHO[self.duty]


def first_steps(counts: Counts, duties: frozenset[Duty]) -> list[FirstStep]:
    """List the steps for somebody with ``duties``; nothing once a run has been evaluated."""
    if counts.evaluated:
        return []
    steps = [
        FirstStep(
            "Import the files of a command generator or a competition, if you have them.",
            "Import files",
            "import",
            Duty.MANAGE,
            bool(counts.productions),
            is_optional=True,
        ),
        FirstStep(
            "Or write what people say: entities, grammar and templates follow from it.",
            "Write examples",
            "by_example",
            Duty.ANNOTATE,
            bool(counts.templates),
            is_optional=True,
        ),
        FirstStep(
            "Name what your robot knows: plants, beds, people.",
            "Name an entity",
            "entity_new",
            Duty.ANNOTATE,
            bool(counts.entities),
        ),
        FirstStep(
            "Write a grammar: how people say the commands.",
            "Write a production",
            "production_new",
            Duty.ANNOTATE,
            bool(counts.productions),
        ),
        FirstStep(
            "Invite the people who work on it with you.",
            "Invite people",
            "people",
            Duty.MANAGE,
            counts.members > 1,
            is_optional=True,
        ),
        FirstStep(
            "Write templates: each gives the commands of a pattern their logical form.",
            "Write a template",
            "template_new",
            Duty.ANNOTATE,
            bool(counts.templates),
        ),
        FirstStep(
            "Generate the commands of the templates.",
            "Generate commands",
            "generate",
            Duty.ANNOTATE,
            bool(counts.commands),
            is_action=True,
        ),
        FirstStep(
            "Freeze a split into parts to train, validate and test on.",
            "Freeze a split",
            "split_new",
            Duty.ANNOTATE,
            bool(counts.splits),
        ),
        FirstStep(
            "Train a first parser.", "Start a run", "run_new", Duty.MANAGE, bool(counts.runs)
        ),
        FirstStep("Read its wrong answers.", "Watch the runs", "runs", Duty.VIEW, False),
    ]
    first_open = next((step for step in steps if not (step.is_done or step.is_optional)), None)
    return [
        replace(step, is_next=step is first_open, is_allowed=step.duty in duties) for step in steps
    ]
