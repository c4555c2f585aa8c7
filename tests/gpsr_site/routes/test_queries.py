"""No page and no list asks the database more often because there are more rows."""

from __future__ import annotations

from django.core.cache import cache
from django.db import DatabaseError, connection, models, reset_queries, transaction
from django.test.utils import CaptureQueriesContext

from annotations.exchange.world_deletion import _deletion_order, _paths_to_world
from parser_service.models import Evaluation
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.policy import POLICY
from tests.gpsr_site.routes.rules import undone

COPIES = 4
GET_ROUTES = sorted(
    {rule.name for rule in POLICY if rule.method == "get"}
    - {"admin:index", "download", "api:download", "api:schema", "logout"}
)
WRITES = ("INSERT", "UPDATE", "DELETE", "BEGIN", "SAVEPOINT")


def copy_rows(world) -> int:
    """Write every row below ``world`` a few times more, with other names and places. Returns how many."""
    paths, copied = _paths_to_world(), 0
    for model in reversed(_deletion_order(paths)):
        if model is Evaluation:  # its names are those of the parts and sources that there are
            continue
        belongs = models.Q()
        for path in paths[model]:
            belongs |= models.Q(**{path: world.pk})
        for row in list(model._default_manager.filter(belongs)[:3]):
            copied += sum(copy_row(row, number) for number in range(1, COPIES + 1))
    return copied


def copy_row(row: models.Model, number: int) -> bool:
    """Write ``row`` once more. Returns whether it could be, which unique rows of others may forbid."""
    fields = {field.name: field for field in row._meta.concrete_fields}
    unique = {name for some in row._meta.total_unique_constraints for name in some.fields}
    unique |= {name for some in row._meta.unique_together for name in some}
    unique |= {name for name, field in fields.items() if field.unique}
    for name, field in fields.items():
        value = getattr(row, field.attname)
        if name in unique | {"position"} and field.concrete and not field.is_relation:
            if isinstance(value, str) and not field.choices:
                setattr(row, field.attname, f"{value} {number}"[: field.max_length])
            elif isinstance(value, int) and not isinstance(value, bool):
                setattr(row, field.attname, value + 1000 * number)
    row.pk, row._state.adding = None, True
    try:
        with transaction.atomic():
            type(row)._base_manager.bulk_create([row])
    except DatabaseError:
        return False
    return True


def queries_of(client, path: str) -> list[str]:
    reset_queries()  # the log has room for 9,000
    with CaptureQueriesContext(connection) as queries:
        answer = client.get(path)
        if answer.streaming:
            b"".join(answer.streaming_content)
    return [each["sql"] for each in queries]


def test_more_rows_need_no_more_queries(sample, client_as, subtests):
    for name in GET_ROUTES:
        client, path = client_as("admin"), address(name, sample)
        with subtests.test(name), undone():
            queries_of(client, path)  # whatever is loaded only once is there now
            few = queries_of(client, path)
            cache.clear()
            assert copy_rows(sample.world) > 100
            queries_of(client, path)
            many = queries_of(client, path)
            assert len(many) <= len(few) + 3, "\n".join(sorted(many))


def test_who_only_looks_writes_nothing(sample, client_as, subtests):
    """Else a page would wait for whoever writes."""
    for name in GET_ROUTES:
        client, path = client_as("admin"), address(name, sample)
        with subtests.test(name), undone():
            queries_of(client, path)
            writes = [sql for sql in queries_of(client, path) if sql.startswith(WRITES)]
            assert [sql for sql in writes if not sql.startswith("SAVEPOINT")] == []
