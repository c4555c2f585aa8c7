"""The pages of a world in the order of the flow: groups of the rail, their entries, and two rows of tabs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from annotations.language.texts import say_count
from annotations.models import Duty
from annotations.rows.row_kinds import KINDS
from gpsr_site.overview.counts import Counts


@dataclass(frozen=True, slots=True, kw_only=True)
class Waiting:
    """What the dot of an entry says, such as ``3 templates not ready``: a count, its noun, a reason.

    ``count`` is a field of ``Counts``; 0 of it is no dot. Without a noun the reason stands alone.
    """

    count: str
    noun: str = ""
    reason: str

    def sentence(self, counts: Counts) -> str:
        """Say what waits; empty for nothing."""
        number = getattr(counts, self.count)
        if not number:
            return ""
        return f"{say_count(number, self.noun)} {self.reason}" if self.noun else self.reason


@dataclass(frozen=True, slots=True, kw_only=True)
class RailEntry:
    """A page that the rail or a row of tabs leads to.

    ``label`` is its one name: in the rail or on its tab, as its heading, in the breadcrumb and as its title.
    ``page`` and ``pages_below`` are URL names; the pages below have names of their own. Those of the rows of a kind
    are below its list, and are not named. The first tab of an entry with tabs is the entry itself; the tabs of a tab
    are a second row. ``query`` is the filter with which its tab opens. ``count`` is a field of ``Counts`` that stands
    beside the label. Only people with ``duty`` see the tab; the rail leads others to the first tab that they may open.
    """

    label: str
    page: str
    query: str = ""
    count: str = ""
    waiting: Waiting | None = None
    duty: Duty = Duty.VIEW
    pages_below: tuple[str, ...] = ()
    tabs: tuple[RailEntry, ...] = ()

    @property
    def has_page(self) -> bool:
        """Whether a page bears its label: ``Settings`` has tabs alone, and leads to the first of them."""
        return all(tab.page != self.page for tab in self.tabs)

    def way_to(self, page: str) -> tuple[RailEntry, ...]:
        """Return the entries on the way to a page, from this one on; empty where it is not here."""
        for tab in self.tabs:
            if way := tab.way_to(page):
                return (self, *way)
        return (self,) if page in (self.page, *self.pages_below) else ()

    def page_for(self, duties: frozenset[Duty]) -> RailEntry:
        """Return the entry itself, or the first of its tabs, whichever a person with ``duties`` may open first."""
        if self.duty in duties:
            return self
        return next((tab for tab in self.tabs if tab.duty in duties), self)

    def sentence(self, counts: Counts) -> str:
        """Say what waits here and on the tabs; empty for nothing."""
        here = self.waiting.sentence(counts) if self.waiting else ""
        below = (tab.sentence(counts) for tab in self.tabs)
        return ", ".join(filter(None, (here, *below)))


@dataclass(frozen=True, slots=True)
class Group:
    """Places of the rail below one heading; the first and the last group need none."""

    heading: str
    entries: tuple[RailEntry, ...]


DESCRIBE = (
    RailEntry(
        label="Ontology",
        page="ontology",
        count="entities",
        waiting=Waiting(count="ontology_problems", noun="warning", reason="to read"),
        pages_below=("entities_new", "location_rooms"),
        tabs=(
            RailEntry(label="Classes", page="entity_classes"),
            RailEntry(label="Predicates", page="predicates"),
            RailEntry(label="Words from dialogues", page="offered_entities"),
        ),
    ),
    RailEntry(
        label="Grammar",
        page="grammar",
        count="productions",
        waiting=Waiting(count="grammar_problems", noun="warning", reason="to read"),
        tabs=(RailEntry(label="Task categories", page="task_categories"),),
    ),
    RailEntry(
        label="Templates",
        page="templates",
        count="templates",
        waiting=Waiting(count="templates_waiting", noun="template", reason="not ready"),
        tabs=(
            RailEntry(label="By example", page="by_example", duty=Duty.ANNOTATE),
            RailEntry(
                label="Coverage",
                page="uncovered",
                tabs=(
                    RailEntry(label="Templates without effect", page="unmatched"),
                    RailEntry(label="Conflicts", page="conflicts"),
                    RailEntry(label="Outside the grammar", page="outside_grammar"),
                ),
            ),
        ),
    ),
)

COLLECT = (
    RailEntry(
        label="Commands",
        page="commands",
        count="commands",
        waiting=Waiting(count="generation_waiting", reason="to be generated"),
        pages_below=("command", "generation"),
        tabs=(
            RailEntry(label="Logical forms", page="logical_forms", pages_below=("logical_form",)),
            RailEntry(label="Complexity", page="complexity"),
        ),
    ),
    RailEntry(
        label="Paraphrases",
        page="paraphrases",
        count="paraphrases",
        tabs=(
            RailEntry(
                label="Campaigns",
                page="campaigns",
                duty=Duty.MANAGE,
                pages_below=(
                    *("campaign_new", "campaign_page", "campaign_edit", "campaign_results"),
                    *("campaign_model", "contributor_forget"),
                ),
            ),
            RailEntry(
                label="Moderation",
                page="submissions",
                query="?status=pending",
                duty=Duty.REVIEW,
                waiting=Waiting(count="paraphrases_waiting", noun="paraphrase", reason="to judge"),
                pages_below=("submission", "submission_decide"),
            ),
            RailEntry(
                label="Figures",
                page="paraphrase_figures",
                tabs=(
                    RailEntry(label="Figures by form", page="paraphrase_forms"),
                    RailEntry(
                        label="Contributors", page="paraphrase_contributors", duty=Duty.REVIEW
                    ),
                ),
            ),
        ),
    ),
    RailEntry(
        label="Label",
        page="label",
        duty=Duty.ANNOTATE,
        count="work_items",
        tabs=(
            RailEntry(
                label="Queue",
                page="queue",
                waiting=Waiting(count="work_items_free", noun="item", reason="to do"),
                pages_below=("queue_item",),
                tabs=(
                    RailEntry(label="Agreement", page="agreement"),
                    RailEntry(label="Progress", page="progress"),
                    RailEntry(label="Double labelling", page="queue_settings", duty=Duty.MANAGE),
                ),
            ),
            RailEntry(
                label="Utterances",
                page="utterances",
                waiting=Waiting(
                    count="utterances_waiting",
                    noun="utterance",
                    reason="without a form, not waiting in the queue",
                ),
                pages_below=("utterances_new", "utterances_delete"),
                tabs=(
                    RailEntry(
                        label="Uploads", page="uploads", pages_below=("upload", "upload_undo")
                    ),
                ),
            ),
            RailEntry(label="Label audit", page="audit"),
            RailEntry(label="Guidelines", page="guidelines"),
        ),
    ),
)

TRAIN_AND_JUDGE = (
    RailEntry(
        label="Splits", page="splits", count="splits", pages_below=("split", "split_new", "example")
    ),
    RailEntry(
        label="Runs",
        page="runs",
        count="runs",
        waiting=Waiting(count="runs_active", noun="run", reason="queued or running"),
        pages_below=("run", "run_new", "predictions", "defaults", "sensitivity", "probes"),
    ),
    RailEntry(
        label="Results",
        page="results",
        count="evaluated",
        tabs=(
            RailEntry(label="Compare", page="compare"),
            RailEntry(label="Slices", page="slices"),
            RailEntry(label="Learning curves", page="learning_curves"),
        ),
    ),
    RailEntry(label="Review", page="review", pages_below=("error_categories", "error_category")),
)

USE = (
    RailEntry(
        label="Parse",
        page="playground",
        tabs=(
            RailEntry(label="Dialogue", page="dialogues", pages_below=("dialogue",)),
            RailEntry(label="Several commands", page="joint_plan"),
        ),
    ),
    RailEntry(
        label="Robot",
        page="robot",
        tabs=(
            RailEntry(label="Recipes", page="recipes"),
            RailEntry(
                label="Promotion",
                page="promotions",
                waiting=Waiting(
                    count="promotions_proposed", noun="run", reason="proposed for promotion"
                ),
            ),
        ),
    ),
)

SETTINGS = RailEntry(
    label="Settings",
    page="people",
    tabs=(
        RailEntry(label="People", page="people", pages_below=("invite",)),
        RailEntry(
            label="Import and export",
            page="import",
            pages_below=("import_competition", "import_pairs"),
        ),
        RailEntry(label="Jobs", page="jobs", pages_below=("job",)),
        RailEntry(label="Audit log", page="audit_log", duty=Duty.MANAGE),
        RailEntry(
            label="World", page="world_edit", duty=Duty.MANAGE, pages_below=("world_delete",)
        ),
    ),
)

GROUPS = (
    Group("", (RailEntry(label="Overview", page="world"),)),
    Group("Describe", DESCRIBE),
    Group("Collect", COLLECT),
    Group("Train and judge", TRAIN_AND_JUDGE),
    Group("Use", USE),
    Group("", (SETTINGS,)),
)

# Kind of row → the route of the list that holds it.
LISTS = {kind.name: kind.list_page for kind in KINDS.values()}
LISTS |= {"form": "logical_forms"}


def way_to(page: str) -> tuple[RailEntry, ...]:
    """Return the entries on the way to a page of a world, the one of the rail first; empty for a page of no entry.

    ``page`` is a URL name, or the name of a kind: the page of a row, and of a new one, is below the list of its kind.
    """
    page = LISTS.get(page.removesuffix("_new"), page)
    ways = (entry.way_to(page) for group in GROUPS for entry in group.entries)
    return next(filter(None, ways), ())


def all_entries() -> Iterator[RailEntry]:
    """Yield every entry of the rail and every tab, each after the entry that holds it."""
    waiting = [entry for group in reversed(GROUPS) for entry in reversed(group.entries)]
    while waiting:
        entry = waiting.pop()
        yield entry
        waiting += reversed(entry.tabs)
