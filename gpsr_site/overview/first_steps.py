"""What a new world needs, in order: a list for each way in which a world begins, ticked by what is true."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum

from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.models import Duty, Entity, Production, Submission, TaskCategory, World
from annotations.rows.composition import split_entry
from gpsr_site.overview.counts import Counts
from parser_service.parsers.conditions import PARAPHRASED, written_sources

WHO = {
    Duty.VIEW: "",
    Duty.ANNOTATE: "an annotator or admin does this",
    Duty.MANAGE: "an admin does this",
}


class Beginning(StrEnum):
    """How a world began, as its grammar tells: with nothing, with a shipped world, with files, or written here."""

    EMPTY = "empty"
    COMPETITION = "competition"
    STARTER = "starter"
    FILES = "files"
    WRITTEN = "written"


# The page of the documents that says more.
GUIDES = {
    Beginning.EMPTY: "guides/greenhouse",
    Beginning.COMPETITION: "guides/first-steps#a-world-for-a-competition",
    Beginning.STARTER: "guides/first-steps#the-first-minute",
    Beginning.FILES: "guides/importing",
    Beginning.WRITTEN: "guides/first-steps#a-world-of-your-own",
}


@dataclass(frozen=True, slots=True)
class FirstStep:
    """One step. ``name`` is the URL of its page, or of an action that it sends ``sends`` to; ``who`` says who takes it
    where the reader may not. The steps after an ``is_optional`` one do not wait for it."""

    sentence: str
    label: str
    name: str
    duty: Duty
    is_done: bool = False
    sends: str = ""
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


def beginning_of(world: World) -> Beginning:
    """Return how a world began."""
    sources = {
        split_entry(entry)[0]
        for each in TaskCategory.objects.filter(grammar__world=world)
        for entry in each.rule_sources
    }
    if not sources:
        return Beginning.EMPTY
    for name, beginning in (
        ("competition", Beginning.COMPETITION),
        ("household", Beginning.STARTER),
    ):
        if any((SHIPPED_WORLDS[name].folder / source).is_file() for source in sources):
            return beginning
    from_files = Production.objects.filter(grammar__world=world, line__gt=0)
    return Beginning.FILES if from_files.exists() else Beginning.WRITTEN


def first_steps(
    world: World, beginning: Beginning, counts: Counts, duties: frozenset[Duty]
) -> list[FirstStep]:
    """List the steps of a world for somebody with ``duties``."""
    steps = list(_steps(world, counts, beginning))
    first_open = next((step for step in steps if not (step.is_done or step.is_optional)), None)
    return [
        replace(step, is_next=step is first_open, is_allowed=step.duty in duties) for step in steps
    ]


def _steps(world: World, counts: Counts, beginning: Beginning) -> Iterable[FirstStep]:
    view, annotate, manage = Duty.VIEW, Duty.ANNOTATE, Duty.MANAGE
    people = FirstStep(
        *("Invite the people who work on it with you.", "Invite people", "people", manage),
        is_done=counts.members > 1,
        is_optional=True,
    )
    generate = FirstStep(
        *("Generate the commands of the templates.", "Generate commands", "generate", annotate),
        is_done=bool(counts.commands),
        sends="generate",
    )
    train = FirstStep(
        "Train what is recommended here, for what people say in other words.",
        *("Train it", "run_today", manage),
        is_done=bool(counts.runs),
        sends="train",
    )
    again = replace(
        train,
        sentence="Train it once more, with what people wrote.",
        label="Train it again",
        is_done=world.runs.filter(train_sources__contains=written_sources({PARAPHRASED})).exists(),
        is_optional=True,
    )
    wrong = FirstStep(
        *("Read its wrong answers.", "Watch the runs", "runs", view), is_done=bool(counts.evaluated)
    )
    ask = _of_paraphrases(world, counts)
    attempt = FirstStep(
        *("Say something to it.", "Try a command", "playground", view), is_optional=True
    )
    robot = FirstStep(*("Connect your robot.", "How a robot asks", "robot", view), is_optional=True)
    written = FirstStep(
        "Write templates: each gives the commands of a pattern their logical form.",
        *("Write a template", "template_new", annotate),
        is_done=bool(counts.templates),
    )
    named = FirstStep(
        "Name what your robot knows: plants, beds, people.",
        *("Name an entity", "entity_new", annotate),
        is_done=bool(counts.entities),
    )
    grammar = FirstStep(
        "Write a grammar: how people say the commands.",
        *("Write a production", "production_new", annotate),
        is_done=bool(counts.productions),
    )
    files = FirstStep(
        "Or import the files of a command generator or a competition.",
        *("Import files", "import", manage),
        is_optional=True,
    )
    examples = FirstStep(
        "Write what people say: entities, grammar and templates follow from it.",
        *("Write examples", "by_example", annotate),
        is_done=bool(counts.templates),
    )
    by_hand = replace(
        named,
        sentence="Or write it by hand: what the robot knows, then a grammar, then templates.",
        is_optional=True,
    )
    asked = (ask, again) if counts.paraphrases and counts.runs else (ask,)
    to_the_end = (*asked, train, wrong, robot, people)
    match beginning:
        case Beginning.EMPTY:
            return (examples, files, by_hand, attempt, people)
        case Beginning.COMPETITION:
            return (*_of_competition(world), generate, attempt, train, *asked, robot, people)
        case Beginning.STARTER:
            return (attempt, generate, train, wrong, *asked, robot, people)
        case Beginning.WRITTEN:
            return (named, grammar, written, generate, attempt, *to_the_end)
        case Beginning.FILES:
            return (written, generate, attempt, *to_the_end)


def _of_paraphrases(world: World, counts: Counts) -> FirstStep:
    """Return the step to paraphrases: a campaign at one press, then its link, then what came in by it."""
    said = Submission.objects.filter(contributor__campaign__world=world)
    sends = ""
    if not counts.paraphrases and said.awaiting_moderation().exists():
        asked = ("Accept what people wrote.", "Read what came in", "submissions")
    elif not counts.paraphrases and world.campaigns.exists():
        asked = ("Send the link of your campaign to people.", "Show the link", "campaigns")
    else:
        sentence = "Ask ten people how they would say the commands, by a link."
        asked = (sentence, "Make a campaign", "campaign_new")
        sends = "ten_tasks" if counts.commands else ""
    return FirstStep(
        *(*asked, Duty.MANAGE), is_done=bool(counts.paraphrases), is_optional=True, sends=sends
    )


def _of_competition(world: World) -> Iterable[FirstStep]:
    """Return the steps that make the world that of one competition: its folder, and where its locations are."""
    entities = Entity.objects.filter(ontology__world=world)
    has_folder = entities.filter(source__endswith=".md").exists()
    locations = entities.filter(entity_class="location")
    with_room = [bool(each.attributes.get("room")) for each in locations]
    yield FirstStep(
        "Drop the folder of your competition: its names, rooms, locations and objects.",
        *("Import the folder", "import_competition", Duty.MANAGE),
        is_done=has_folder,
    )
    yield FirstStep(
        "Say in which room each location is; names that tell are guessed.",
        *("Choose rooms", "location_rooms", Duty.ANNOTATE),
        is_done=has_folder and all(with_room),
        is_optional=has_folder and any(with_room),  # who does not know them all goes on
    )
