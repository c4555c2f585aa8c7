"""How well reviewers agree who tag the same answers."""

from __future__ import annotations

from collections import defaultdict

from annotations.language.agreement import Agreement, measure
from annotations.models import World
from parser_service.models import Review

MOST_ITEMS = 5_000  # the newest ones; the bootstrap costs time with each


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
