"""Counts beside the rows of a list, made for the rows that are shown alone."""

from __future__ import annotations

from typing import Any

from django.db.models import Count, IntegerField, OuterRef, QuerySet, Subquery
from django.db.models.functions import Coalesce

ALL = Count("pk")


def count_of(rows: QuerySet[Any], path: str, count: Count = ALL) -> Coalesce:
    """Return how many of ``rows`` refer to each row of another query by ``path``, or count something of them.

    A join would group all rows of a list before the first page is cut.
    """
    referring = rows.order_by().filter(**{path: OuterRef("pk")}).values(path)
    counted = referring.annotate(amount=count).values("amount")
    return Coalesce(Subquery(counted, output_field=IntegerField()), 0)
