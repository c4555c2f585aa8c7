"""How many of the labels that people have looked at were wrong."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import Count

from annotations.language.corpus import wilson_interval
from annotations.models import FindingStatus, World


@dataclass(frozen=True, slots=True)
class Precision:
    """Decided findings by what became of them. ``share`` is the fraction that was corrected or excluded,
    with its 95 % interval."""

    kept: int
    corrected: int
    excluded: int

    @property
    def decided(self) -> int:
        return self.kept + self.wrong

    @property
    def wrong(self) -> int:
        return self.corrected + self.excluded

    @property
    def share(self) -> float:
        return self.wrong / self.decided

    @property
    def interval(self) -> tuple[float, float]:
        return wilson_interval(self.wrong, self.decided)


def precision_of(world: World) -> Precision | None:
    """Return the precision of the audits of ``world``; None before the first decision."""
    rows = world.audit_findings.decided().order_by().values_list("status")
    counts = dict(rows.annotate(count=Count("pk")))
    if not counts:
        return None
    decided = (FindingStatus.KEPT, FindingStatus.CORRECTED, FindingStatus.EXCLUDED)
    return Precision(*(counts.get(status, 0) for status in decided))
