"""No page and no list asks the database more often, or lets it read more, because there are more rows."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

from django.core.cache import cache
from django.db import connection, reset_queries
from django.test.utils import CaptureQueriesContext

from annotations.rows import kept
from annotations.showing import listing
from gpsr_site.overview import counts
from tests.database_work import counted_work
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.policy import POLICY
from tests.gpsr_site.routes.rules import undone
from tests.many_rows import ManyRows

GET_ROUTES = sorted(
    {rule.name for rule in POLICY if rule.method == "get"}
    - {"admin:index", "download", "api:download", "api:schema", "logout"}
)
EXPORTS = {
    *("api:campaign-triples", "api:paraphrase-export"),
    *("api:submission-export", "api:utterance-export"),
}
# What searches the texts of a world for a word, or compares a split with all that the world has now.
SEARCHES = {"api:split-changes", "entity", "split", "split_changes"}
# What is counted of all rows for each page. A new page does not belong here: keep what it counts (``kept``).
FIGURES = {
    *("api:audit", "api:campaign-list", "api:contributor-list", "api:paraphrase-contributors"),
    *("api:paraphrase-figures", "api:paraphrase-forms", "api:progress", "api:results"),
    *("api:uncovered", "api:utterance-candidates", "audit", "campaigns", "coverage"),
    *("error_categories", "label", "label_item", "logical_form", "outside_grammar", "paraphrase"),
    *("paraphrase_contributors", "paraphrase_figures", "paraphrase_forms", "paraphrase_runs"),
    *("progress", "results", "results_download", "results_table", "templates", "uncovered"),
    *("unmatched", "utterances_delete", "world"),
}
READ_ALL = EXPORTS | SEARCHES | FIGURES
FEW = 300  # rows of each kind; a page of a list has 200 at most
WRITES = ("INSERT", "UPDATE", "DELETE", "BEGIN", "SAVEPOINT")


def queries_of(client, path: str) -> list[str]:
    reset_queries()  # the log has room for 9,000
    with CaptureQueriesContext(connection) as queries:
        answer = client.get(path)
        if answer.streaming:
            b"".join(answer.streaming_content)
    return [each["sql"] for each in queries]


@dataclass(frozen=True)
class Asked:
    """What a request asks of the database: statements, and what it does for them."""

    statements: int
    work: int


def asked_by(client, pages: dict[str, str]) -> dict[str, Asked]:
    """Request each page, the second time, when whatever is loaded only once is there."""
    cache.clear()
    asked = {}
    for name, path in pages.items():
        with undone():
            queries_of(client, path)
            with counted_work() as work:
                statements = len(queries_of(client, path))
            asked[name] = Asked(statements, work.done)
    return asked


def test_more_rows_cost_no_page_more(sample, client_as, subtests, monkeypatch):
    """With 4 times as many of all that grows, the database does nothing more, but for what has to read all."""
    monkeypatch.setattr(listing, "MOST_COUNTED", FEW // 3)  # as if the rows were very many
    monkeypatch.setattr(kept, "_kept", OrderedDict())
    monkeypatch.setattr(kept, "MOST_READ", 0)
    monkeypatch.setattr(counts, "_kept", {})
    monkeypatch.setattr(counts, "MOST_READ", 0)
    monkeypatch.setattr(kept, "SHARE", 10**9)
    monkeypatch.setattr(kept, "MOST_SECONDS", 10**9)
    monkeypatch.setattr(counts, "MOST_EXACT", FEW // 3)
    client, many = client_as("admin"), ManyRows(sample.world)
    pages = {name: address(name, sample) for name in GET_ROUTES}
    with undone():
        first = asked_by(client, pages)
        many.multiply(FEW)
        few = asked_by(client, pages)
        assert many.multiply(4 * FEW) > 20 * FEW
        most = asked_by(client, pages)
    for name in pages:
        with subtests.test(name):
            # A template that another one repeats looks for a task category that would take it: there are 5 more.
            more = 3 + 2 * 5 * (name == "template")
            assert few[name].statements <= first[name].statements + more
            assert most[name].statements <= few[name].statements + 1
            if connection.vendor == "sqlite" and name not in READ_ALL:
                assert most[name].work <= 1.15 * few[name].work + 500


def test_who_only_looks_writes_nothing(sample, client_as, subtests):
    """Else a page would wait for whoever writes."""
    for name in GET_ROUTES:
        client, path = client_as("admin"), address(name, sample)
        with subtests.test(name), undone():
            queries_of(client, path)
            writes = [sql for sql in queries_of(client, path) if sql.startswith(WRITES)]
            assert [sql for sql in writes if not sql.startswith("SAVEPOINT")] == []
