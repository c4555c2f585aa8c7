"""Verbs: the files of a campaign: tasks for a crowd market, submissions as a table, accepted rewrites as triples."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from django.db.models import QuerySet

from annotations.campaigns.tasks import Dealer
from annotations.exchange.tables import TableFormat, table_pieces, text_pieces
from annotations.language.corpus import write_triples
from annotations.models import Campaign, Submission

MOST_TASKS = 2_000  # of one file
CHUNK = 1_000  # rows fetched at once
# The keys of the table of submissions, in this order in every release.
FIELDS = (
    *("id", "campaign", "contributor", "by", "kind", "prompt", "text", "logical_form"),
    *("grounded_form", "flags", "seconds", "was_pasted", "answered_at", "status"),
)


def task_file(campaign: Campaign, tasks: int) -> Iterator[bytes]:
    """Return a table with a row for each of so many tasks, in pieces (docs/reference/formats.md, Crowd tables).

    Prompts are dealt as contributors get them by link: forms with fewest submissions first, no prompt twice in a
    task. Cells without a prompt are empty. Planted checks are left out.
    """
    texts = ("shown", "logical_form", "grounded_form")
    prompts = {key: row for key, *row in campaign.prompts.values_list("pk", *texts)}
    dealer = Dealer(campaign)
    size = campaign.task_size
    head = [
        f"{name}{number}"
        for number in range(1, size + 1)
        for name in ("command", "parse", "parse_ground")
    ]

    def rows() -> Iterator[list[str]]:
        for _ in range(tasks):
            cells = [cell for key in dealer.deal(size) for cell in prompts[key]]
            yield cells + [""] * (len(head) - len(cells))

    return table_pieces(rows(), head, TableFormat.CSV)


def submission_table(rows: QuerySet[Submission]) -> Iterator[bytes]:
    """Return submissions as CSV in pieces, by pseudonyms alone. ``flags`` are JSON."""
    related = rows.select_related("contributor__campaign", "prompt").order_by("pk")
    cells = (_cells(row) for row in related.iterator(chunk_size=CHUNK))
    return table_pieces(cells, FIELDS, TableFormat.CSV)


def accepted_triples(campaign: Campaign) -> Iterator[bytes]:
    """Return the accepted rewrites of a campaign as triples in pieces: paraphrase, prompt, grounded form."""
    rows = campaign.world.paraphrases.accepted().filter(contributor__campaign=campaign)
    texts = rows.order_by("pk").values_list("utterance", "prompt", "grounded_form")
    return text_pieces(write_triples(texts.iterator(chunk_size=CHUNK)))


def _cells(row: Submission) -> list[Any]:
    prompt = row.prompt
    return [
        row.pk,
        row.contributor.campaign.name,
        row.contributor.pseudonym,
        row.contributor.kind,
        row.kind,
        prompt.shown if prompt else "",
        row.text,
        prompt.logical_form if prompt else "",
        prompt.grounded_form if prompt else "",
        json.dumps(row.flags, ensure_ascii=False),
        row.seconds,
        row.was_pasted,
        row.answered_at.isoformat() if row.answered_at else "",
        row.status,
    ]
