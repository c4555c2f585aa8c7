"""The audit log calls what people do by verbs."""

from __future__ import annotations

from annotations.people.audit_log import UNRECORDED, WHAT
from tests.gpsr_site.routes.policy import POLICY

POSTED = {
    rule.name
    for rule in POLICY
    if rule.method == "post" and ":" not in rule.name and not UNRECORDED.search(rule.name)
}


def test_whatever_a_page_changes_has_words_of_its_own():
    assert sorted(POSTED - WHAT.keys()) == []
