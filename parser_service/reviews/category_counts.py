"""How often each error category is proposed and given, and how well reviewers agree who tag the same answers."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from django.db.models import Count, OuterRef, QuerySet, Subquery

from annotations.language.corpus import Agreement, measure
from annotations.models import World
from annotations.rows.kept import kept
from parser_service.models import ErrorCategory, Review, TrainingRun

MOST_ITEMS = 5_000  # the newest ones; the bootstrap costs time with each


@dataclass(frozen=True, slots=True)
class CategoryCount:
    """``proposed`` by the machine, ``tagged`` by people; of the tags on answers for which it was proposed,
    ``accepted`` say the same, out of ``judged``."""

    category: ErrorCategory
    proposed: int
    tagged: int
    accepted: int
    judged: int

    @property
    def accepted_share(self) -> float | None:
        return self.accepted / self.judged if self.judged else None


def count_categories(
    world: World, categories: Sequence[ErrorCategory], run: TrainingRun | None = None
) -> list[CategoryCount]:
    """Count the reviews of each category, those of one run or of all runs of the world; of very many, as of a while
    ago."""
    counted = kept(
        ("reviews", world.pk, run and run.pk),
        lambda: _count_all(world, run),
        lambda counts: counts[0].total() + counts[1].total(),
    )
    return [CategoryCount(each, *(counts[each.pk] for counts in counted)) for each in categories]


def _count_all(world: World, run: TrainingRun | None) -> tuple[Counter[int], ...]:
    """Return the numbers of ``CategoryCount``, each by category."""
    proposed = _count(_of(world, run, is_proposed=True))
    tags = _of(world, run, is_proposed=False)
    tagged = _count(tags)
    # By proposed category: the tags on answers with a proposal, and those that agree with it.
    judged: Counter[int] = Counter()
    accepted: Counter[int] = Counter()
    proposal = Review.objects.proposed().filter(run=OuterRef("run"), example=OuterRef("example"))
    beside = tags.annotate(said=Subquery(proposal.values("category")[:1]))
    pairs = beside.filter(said__isnull=False).values("said", "category").annotate(count=Count("pk"))
    for said, given, count in pairs.values_list("said", "category", "count"):
        judged[said] += count
        accepted[said] += count if said == given else 0
    return proposed, tagged, accepted, judged


def _of(world: World, run: TrainingRun | None, is_proposed: bool) -> QuerySet[Review]:
    rows = Review.objects.filter(is_proposed=is_proposed, category__isnull=False).order_by()
    return rows.filter(run=run) if run else rows.filter(run__in=world.runs.all())


def _count(rows: QuerySet[Review]) -> Counter[int]:
    counts = rows.values("category").annotate(count=Count("pk"))
    return Counter(dict(counts.values_list("category", "count")))


def agreement_of_reviewers(world: World) -> Agreement:
    """Return the agreement over the answers that two or more people of ``world`` have tagged.

    An answer that several runs give counts once for each; reviewers whose accounts are gone count too.
    """
    rows = Review.objects.by_people().filter(run__in=world.runs.all(), category__isnull=False)
    newest = rows.order_by("-pk").values_list("run", "example", "category__code")
    tags: dict[tuple[int, int], list[str]] = defaultdict(list)
    for run, example, code in newest[: 2 * MOST_ITEMS]:
        tags[run, example].append(code)
    return measure([codes for codes in tags.values() if len(codes) > 1])
