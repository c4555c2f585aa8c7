"""Pages and routes that only read go on while the disk is full: none of them has to write."""

from __future__ import annotations

import re

from django.db import OperationalError, connection

from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.policy import POLICY, YES
from tests.gpsr_site.routes.rules import undone

WRITES = re.compile(r"\s*(INSERT|UPDATE|DELETE)\b", re.IGNORECASE)
# Both hand out an item, which is leased in the database: nobody could answer it on a full disk.
HAND_OUT = {"label", "label_item"}
READ = sorted(
    {rule.name for rule in POLICY if rule.method == "get" and rule.admin == YES} - HAND_OUT
)


def refuse_writes(execute, sql, params, many, context):
    """Fail as SQLite does when the disk is full."""
    if WRITES.match(sql):
        raise OperationalError("database or disk is full")
    return execute(sql, params, many, context)


def test_a_page_is_read_while_the_disk_is_full(sample, client_as, subtests):
    for name in READ:
        with subtests.test(name), undone(), connection.execute_wrapper(refuse_writes):
            assert client_as("admin").get(address(name, sample)).status_code < 500
