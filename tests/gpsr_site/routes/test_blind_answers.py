"""While several people are asked what an utterance means, nobody reads what another has answered.

Which pages and routes there are is asked of the site itself; each is fetched, archives are unpacked.
"""

from __future__ import annotations

import io
import zipfile

import pytest
from django.urls import reverse

from annotations.labelling.agreeing import report_agreement
from annotations.labelling.giving import take
from annotations.labelling.item_answers import answer
from annotations.models import Label, Predicate, User, WorkItem
from annotations.models.worlds import Role
from tests.conftest import member
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import ALL_ROUTES
from tests.gpsr_site.routes.policy import POLICY, YES
from tests.gpsr_site.routes.sample_rows import utterance, work_item

SAID, REPLACED = "zebra_marker", "yak_marker"
ARCHIVES = {"download", "api:download"}  # complete for admins


@pytest.fixture
def item(sample) -> WorkItem:
    """An item for two, which bella has answered: once, and then otherwise."""
    row, asked = utterance(sample), work_item(sample)
    WorkItem.objects.filter(pk=asked.pk).update(people=2, places=2)
    bella = member(sample.world, "bella", Role.ANNOTATOR)
    for name in (REPLACED, SAID):
        form = f'( go_there " {name} " )'
        made = answer(row, "form", form, bella, row.version, reason=f"because of {name}")
    assert (made.accepted_at, Label.objects.filter(annotator=bella).count()) == (None, 2)
    return WorkItem.objects.get(pk=asked.pk)


def differ(item: WorkItem, by: User) -> WorkItem:
    """Let ``by`` say something else. Returns the item in which somebody settles it."""
    answer(item.utterance, "unknown", "", by, item.utterance.version)
    return item.followed_by


def text_of(response) -> str:
    body = b"".join(response.streaming_content) if response.streaming else response.content
    if body[:2] != b"PK":
        return body.decode(errors="replace")
    with zipfile.ZipFile(io.BytesIO(body)) as archive:
        return "\n".join(archive.read(name).decode(errors="replace") for name in archive.namelist())


def leaks(client, sample, person: str) -> list[str]:
    """The pages and routes on which ``person`` reads what bella has answered."""
    opened, leaking = 0, []
    for rule in POLICY:
        if rule.method != "get" or getattr(rule, person) != YES or rule.name not in ALL_ROUTES:
            continue
        response = client.get(address(rule.name, sample))
        opened += response.status_code == YES
        if any(marker in text_of(response) for marker in (SAID, REPLACED)):
            leaking.append(rule.name)
    assert opened > 100
    return leaking


def test_the_second_of_two_reads_nothing_of_the_first(item, sample, annotator, client_as):
    take(annotator, item)
    client = client_as("annotator")
    assert leaks(client, sample, "annotator") == []
    row = Predicate.objects.create(world=sample.world, name="go_there", kind="action")
    page = client.get(
        reverse("rename", args=["home", "predicate", row.pk]),
        {"old": "go_there", "new": "walk_there"},
    )
    assert [len(touched) for touched in page.context["form"].touched] == [1, 2]
    assert SAID not in text_of(page)


@pytest.mark.parametrize("person", ["annotator", "reviewer", "admin"])
def test_nobody_reads_what_differs_but_who_settles_it(
    person, item, sample, annotator, reviewer, admin, client_as
):
    carl = member(sample.world, "carl", Role.ANNOTATOR)
    settling = differ(item, annotator if person == "annotator" else carl)
    client = client_as(person)
    leaking = leaks(client, sample, person)
    assert set(leaking) <= (ARCHIVES if person == "admin" else set())
    assert report_agreement(sample.world).unsettled == 1
    if person == "annotator":
        return
    own = {"reviewer": reviewer, "admin": admin}[person]
    take(own, settling)
    assert SAID in text_of(client.get(f"/w/home/queue/{settling.pk}/"))
    assert SAID in text_of(client.get(f"/api/v1/worlds/home/work-items/{settling.pk}/"))


def test_everybody_reads_it_afterwards(item, sample, annotator, reviewer, client_as):
    settling = differ(item, annotator)
    take(reviewer, settling)
    answer(item.utterance, "unknown", "", reviewer, item.utterance.version)
    page = address("utterance", sample)
    assert SAID in text_of(client_as("annotator").get(page))
    assert not item.utterance.labels.exclude(pk__in=Label.objects.visible_to(annotator)).exists()
