"""A page that has done something answers with a redirect: a reload does nothing again, and the address is true."""

from __future__ import annotations

import pytest

from annotations.models import AuditEntry
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import API_ROUTES
from tests.gpsr_site.routes.policy import POLICY
from tests.gpsr_site.routes.rules import undone

POSTED = sorted({rule.name for rule in POLICY if rule.method == "post"} - set(API_ROUTES))
# What pages send; of the others an empty form is sent, which is enough where a button is all there is.
SENT = {
    "invite": {"invite-roles": ["annotator"], "invite-places": "1", "invite-days": "7"},
    "token_new": {"name": "robot", "scope": "read", "days": "30"},
    "world_new": {"name": "another"},
    "entity_new": {"entity_class": "object", "text": "kettle"},
    "entity_class_new": {"token": "pose", "hue": "20"},
    "predicate_new": {"name": "wave", "kind": "action"},
    "utterances_new": {"texts": "wave at the door", "add": "yes"},
    "error_categories": {"code": "odd", "description": "Odd", "slice": ""},
}


def test_what_is_done_is_answered_with_a_redirect(sample, client_as, subtests):
    for name in POSTED:
        with subtests.test(name), undone():
            before = AuditEntry.objects.count()
            answer = client_as("superuser").post(address(name, sample), SENT.get(name, {}))
            if answer.status_code == 200 and "text/html" in answer["Content-Type"]:
                assert AuditEntry.objects.count() == before


@pytest.mark.parametrize("name", ["invite", "token_new", "account_link"])
def test_a_secret_is_shown_once_by_the_page_that_follows(name, sample, client_as):
    client = client_as("superuser")
    answer = client.post(address(name, sample), SENT.get(name, {}))
    assert answer.status_code == 302
    shown = client.get(answer.url)
    assert "data-secret" in shown.content.decode() and "no-store" in shown["Cache-Control"]
    assert "data-secret" not in client.get(answer.url).content.decode()
