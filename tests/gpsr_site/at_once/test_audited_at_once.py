"""Twenty people who change one world at the same moment: each change is stored, and each is in the audit log."""

from __future__ import annotations

import pytest
from django.db import connection, connections, transaction
from django.test import Client

from annotations.models import ApiToken, AuditEntry, Production, World
from annotations.models.worlds import Role
from annotations.people.audit_log import record_command
from gpsr_site.web.database import bound_statements
from tests.at_once import at_once
from tests.conftest import member
from tests.launched_campaigns import fill_household

PEOPLE = 20


@pytest.fixture
def bounded(transactional_db, monkeypatch) -> None:
    """Connections with the timeouts of a web process."""
    options = connections.settings["default"]["OPTIONS"]
    monkeypatch.setitem(options, "options", options.get("options", ""))
    if connection.vendor == "postgresql":
        bound_statements()
    else:
        del options["options"]


@pytest.mark.services
def test_twenty_productions_at_once_are_twenty_changes_and_twenty_entries(bounded):
    world = fill_household(World.objects.create(name="home"))
    production = world.grammar.productions.order_by("pk").first()
    token = ApiToken.issue(member(world, "anna", Role.ANNOTATOR), "notebook")[1]
    before = Production.objects.count()

    def post(number: int) -> int:
        sent = {
            "source": production.source,
            "nonterminal": production.nonterminal,
            "expansion": f"{production.expansion} number {number}",
        }
        return (
            Client()
            .post(
                f"/api/v1/worlds/{world.name}/productions/",
                sent,
                content_type="application/json",
                headers={"authorization": f"Bearer {token}"},
            )
            .status_code
        )

    assert (
        at_once(*[lambda number=number: post(number) for number in range(PEOPLE)]) == [201] * PEOPLE
    )
    assert Production.objects.count() == before + PEOPLE
    assert AuditEntry.objects.filter(what="create productions").count() == PEOPLE
    world.refresh_from_db()
    assert not world.commands_are_stale or world.jobs.queued().exists()


@pytest.mark.services
def test_an_entry_of_the_audit_log_does_not_wait_for_who_holds_the_world(bounded):
    if connection.vendor != "postgresql":
        pytest.skip("SQLite has one writer at a time")
    world = World.objects.create(name="home")
    with transaction.atomic():
        World.objects.hold().get(pk=world.pk)
        at_once(lambda: record_command("delete", "something", world))
        assert AuditEntry.objects.filter(world=world).exists()
