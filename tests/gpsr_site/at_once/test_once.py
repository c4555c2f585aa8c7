"""What may be done once, asked for by many at the same moment: it is done once, and the others are told."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

import pytest
from django.core.exceptions import ImproperlyConfigured
from django.db import transaction
from django.test import Client

from annotations.generation.freezing import freeze_split
from annotations.generation.split_statistics import store_figures
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.label_answers import label
from annotations.labelling.label_decisions import decide
from annotations.labelling.proposal_requests import request_proposals
from annotations.language.plans import Offer
from annotations.models import (
    ApiToken,
    Entity,
    FindingStatus,
    Invitation,
    Job,
    User,
    Utterance,
    WorkItem,
    World,
)
from annotations.models.worlds import Role
from annotations.people.accounts import password_path
from annotations.people.invitations import join
from gpsr_site import private_files
from gpsr_site.management.commands.quickstart import Command as Quickstart
from parser_service.labelling.audit_job import request_audit
from parser_service.models import Promotion, PromotionState, TrainingRun
from parser_service.results.measuring_job import request_measurement
from parser_service.runs import run_requests
from parser_service.runs.analysis_requests import request_analysis
from parser_service.runs.promotion_rule import consider
from parser_service.serving.batch_requests import MOST_AT_ONCE, request_batch
from parser_service.serving.entity_offers import offer
from tests.at_once import at_once
from tests.conftest import client_of, member
from tests.doubted_labels import doubt, say
from tests.gpsr_site.at_once.test_versions_and_names import send
from tests.gpsr_site.routes import sample_rows
from tests.parser_service.made_up import make_split
from tests.parser_service.served import trained_run
from tests.sample_world import SampleWorld, fill_world, scored_run

PEOPLE = 20
NEW = "a battery staple of {}"


@pytest.fixture
def sample(transactional_db, world, monkeypatch) -> SampleWorld:
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    return fill_world(world)


@pytest.fixture
def key(transactional_db, superuser) -> str:
    return ApiToken.issue(superuser, "robot")[1]


def test_a_campaign_at_one_press_is_made_once(sample, superuser):
    sample.world.campaigns.all().delete()
    clients = [client_of(superuser) for _ in range(8)]
    path = f"/w/{sample.world.name}/campaigns/new/"

    def press(number: int) -> str:
        return clients[number].post(path, {"ten_tasks": ""})["Location"]

    led_to = Counter(at_once(*(partial(press, number) for number in range(8))))
    made = sample.world.campaigns.get()
    assert led_to == {
        f"/w/{sample.world.name}/campaigns/{made.pk}/": 1,
        path.removesuffix("new/"): 7,
    }


def test_a_link_for_a_lost_password_sets_one(transactional_db, annotator):
    path = password_path(annotator)
    clients = [Client() for _ in range(8)]
    pages = [client.get(path)["Location"] for client in clients]

    def set_password(number: int) -> int:
        password = NEW.format(number)
        sent = {"new_password1": password, "new_password2": password}
        return clients[number].post(pages[number], sent).status_code

    statuses = at_once(*(partial(set_password, number) for number in range(8)))
    assert Counter(statuses) == {302: 1, 200: 7}
    annotator.refresh_from_db()
    assert annotator.check_password(NEW.format(statuses.index(302)))
    assert clients[0].get(path).context["validlink"] is False


def test_a_link_for_some_makes_as_many_accounts(transactional_db, world, admin):
    invitation, link = Invitation.issue(world, [Role.ANNOTATOR], admin, 7, 3, "")
    before = User.objects.count()

    def sign_up(number: int) -> int:
        password = NEW.format(number)
        sent = {"username": f"new{number}", "password1": password, "password2": password}
        client = Client(REMOTE_ADDR=f"10.0.0.{number}")
        return client.post(f"/join/{link}/", sent).status_code

    statuses = at_once(*(partial(sign_up, number) for number in range(PEOPLE)))
    assert Counter(statuses) == {302: 3, 404: PEOPLE - 3}
    invitation.refresh_from_db()
    assert (invitation.joined, User.objects.count() - before) == (3, 3)
    assert world.memberships.filter(user__username__startswith="new").count() == 3


def test_somebody_takes_one_place_however_often_they_ask(transactional_db, world, admin):
    invitation, _ = Invitation.issue(world, [Role.ANNOTATOR], admin, 7, 5, "")
    person = User.objects.create_user("nora")
    at_once(*[partial(join, invitation, person)] * PEOPLE)
    invitation.refresh_from_db()
    assert (invitation.joined, world.memberships.filter(user=person).count()) == (1, 1)


def test_who_has_joined_by_a_link_is_led_to_the_world_by_it(world, admin, annotator, client):
    _, link = Invitation.issue(world, [Role.ANNOTATOR], admin, 7, 1, "")
    Invitation.objects.update(joined=1)
    joined = client_of(annotator)
    assert joined.get(f"/join/{link}/")["Location"] == joined.post(f"/join/{link}/")["Location"]
    assert client.get(f"/join/{link}/").status_code == 404
    assert client_of(User.objects.create_user("nora")).get(f"/join/{link}/").status_code == 404


def test_a_request_with_one_key_is_done_once(sample, key):
    body = {"roles": ["annotator"], "name": "nora"}
    User.objects.create_user("nora")
    sent = partial(send, key, "POST", "/api/v1/worlds/home/members/", body, idempotency_key="1")
    answers = at_once(*[sent] * PEOPLE)
    statuses = Counter(answer.status_code for answer in answers)
    assert set(statuses) <= {201, 409}
    made = [each for each in answers if each.status_code == 201]
    assert sum("Idempotency-Replayed" not in each.headers for each in made) == 1


# An action of the API → what it is about, and the body: of all who ask for it one is answered.
def decide_offer(sample: SampleWorld, by: User) -> tuple[str, Any]:
    row = sample_rows.offered_entity(sample)
    return f"offered-entities/{row.pk}/decide/", {"decision": "confirm"}


def decline_proposal(sample: SampleWorld, by: User) -> tuple[str, Any]:
    return f"promotions/{sample_rows.proposal(sample).pk}/decline/", {}


def promote_run(sample: SampleWorld, by: User) -> tuple[str, Any]:
    return "promotions/", {"run": sample.run.pk}


def roll_back_run(sample: SampleWorld, by: User) -> tuple[str, Any]:
    for run in (sample.run, scored_run(sample.world, sample.split, seed=1)):
        Promotion.objects.create(
            world=sample.world, run=run, state=PromotionState.PROMOTED, decided_at=run.queued_at
        )
    return "promotions/roll-back/", {}


def decide_doubt(sample: SampleWorld, by: User) -> tuple[str, Any]:
    with transaction.atomic():
        store_findings(sample.world, [doubt(say(sample.world, "how many girls"))])
    row = sample.world.audit_findings.get()
    return f"audit-findings/{row.pk}/decide/", {"decision": "corrected"}


def take_decision_back(sample: SampleWorld, by: User) -> tuple[str, Any]:
    decide_doubt(sample, by)
    made = decide(sample.world.audit_findings.get(), FindingStatus.EXCLUDED, by)
    return f"audit-decisions/{made.pk}/take-back/", {}


def take_label_back(sample: SampleWorld, by: User) -> tuple[str, Any]:
    made = label(sample_rows.utterance(sample), "unknown", "", by, 1)
    return f"labels/{made.pk}/take-back/", {}


def mend_spans(sample: SampleWorld, by: User) -> tuple[str, Any]:
    row = sample_rows.utterance(sample)
    entity = Entity.objects.filter(ontology__world=sample.world, text="milk").get()
    sent = {"start": 9, "end": 12, "entity": entity.pk, "version": row.version}
    return f"utterances/{row.pk}/spans/", sent


def renew_split(sample: SampleWorld, by: User) -> tuple[str, Any]:
    split = freeze_split(sample.world, "first", proportions=(1, 0, 0))
    say(sample.world, "how many girls")
    return f"splits/{split.pk}/renew/", {}


def ask_about_template(sample: SampleWorld, by: User) -> tuple[str, Any]:
    sent = {"kind": "template", "id": sample.template.pk, "reason": "Is this right?"}
    return "work-items/", sent


def name_actions(sample: SampleWorld, by: User) -> tuple[str, Any]:
    return "robot/action-names/", {"version": 0, "names": {}}


ONCE: list[Callable[[SampleWorld, User], tuple[str, Any]]] = [
    decide_offer,
    decline_proposal,
    promote_run,
    roll_back_run,
    decide_doubt,
    take_decision_back,
    take_label_back,
    mend_spans,
    renew_split,
    ask_about_template,
    name_actions,
]


@pytest.mark.parametrize("prepare", ONCE)
def test_of_many_who_do_the_same_one_does_it(prepare, sample, superuser, key):
    path, body = prepare(sample, superuser)
    ask = partial(send, key, "POST", f"/api/v1/worlds/home/{path}", body)
    answers = at_once(*[ask] * PEOPLE)
    statuses = Counter(answer.status_code for answer in answers)
    assert statuses[200] + statuses[201] == 1, answers[0].text
    assert set(statuses) <= {200, 201, 400, 409}


def test_of_many_who_answer_one_version_one_is_first(sample):
    row = sample_rows.utterance(sample)
    people = [member(sample.world, f"anna{number}", Role.ANNOTATOR) for number in range(PEOPLE)]
    keys = [ApiToken.issue(person, "notebook")[1] for person in people]
    path = f"/api/v1/worlds/home/utterances/{row.pk}/label/"
    sent = {"verdict": "unknown", "version": row.version}
    answers = at_once(*(partial(send, key, "POST", path, sent) for key in keys))
    assert Counter(answer.status_code for answer in answers) == {201: 1, 409: PEOPLE - 1}
    assert row.labels.count() == 1


def test_somebody_who_answers_many_times_at_once_has_one_answer(sample, key):
    row = sample_rows.utterance(sample)
    path = f"/api/v1/worlds/home/utterances/{row.pk}/label/"
    sent = {"verdict": "unknown", "version": row.version}
    at_once(*[partial(send, key, "POST", path, sent)] * PEOPLE)
    assert row.labels.valid().count() == 1


def test_one_item_is_asked_about_one_row(sample, superuser, key):
    test_of_many_who_do_the_same_one_does_it(ask_about_template, sample, superuser, key)
    assert WorkItem.objects.filter(template=sample.template).count() == 1


def test_an_offer_makes_one_entity(sample, superuser, key):
    test_of_many_who_do_the_same_one_does_it(decide_offer, sample, superuser, key)
    assert Entity.objects.filter(text="flurb").count() == 1


@pytest.mark.parametrize(
    "ask",
    [
        lambda sample, by: request_audit(sample.world, by, {"parser": "", "folds": 2}),
        lambda sample, by: request_analysis(sample.run, by),
        lambda sample, by: request_proposals(sample.world, by),
        lambda sample, by: request_measurement(sample.world, by),
    ],
    ids=["audit", "analysis", "proposals", "measurement"],
)
def test_one_job_is_asked_for(ask, sample, superuser):
    Utterance.objects.create(world=sample.world, text="go", anonymized_text="go")
    at_once(*[partial(ask, sample, superuser)] * PEOPLE)
    assert Job.objects.count() == 1


def test_somebody_has_as_many_batches_as_may_wait(sample, superuser, settings, tmp_path):
    settings.VAR_DIR = tmp_path

    def send_batch() -> None:
        with suppress(ValueError):
            request_batch(sample.world, b'{"utterance": "go"}', 5, None, superuser)

    at_once(*[send_batch] * PEOPLE)
    assert Job.objects.count() == MOST_AT_ONCE


def test_one_run_is_trained_on_one_choice(sample, superuser):
    ask = partial(run_requests.request, sample.world, sample.split, "knn", seed=7, send=False)
    answers = at_once(*[ask] * PEOPLE)
    assert sum(is_new for _, is_new in answers) == 1
    assert TrainingRun.objects.filter(seed=7).count() == 1


def test_the_first_run_of_a_world_is_promoted_once(transactional_db, world):
    split = make_split(world)
    known = split.examples.filter(part="train").first().logical_form
    split.examples.filter(part="validation").update(logical_form=known)
    store_figures(split)
    runs = [trained_run(split, seed=seed, spoken=0.8) for seed in range(6)]
    at_once(*(partial(consider, run) for run in runs))
    assert Promotion.objects.promoted().count() == 1


def test_an_entity_that_many_dialogues_name_is_offered_once(sample):
    offered = Offer("object", "snark")
    rows = at_once(*[partial(offer, sample.world, offered, "bring me the snark")] * PEOPLE)
    assert len({row.pk for row in rows}) == 1
    rows[0].refresh_from_db()
    assert rows[0].times == PEOPLE


def test_a_fresh_installation_has_one_administrator(transactional_db):
    at_once(*[Quickstart().create_admin] * 5)
    assert User.objects.filter(is_superuser=True).count() == 1


def test_processes_that_start_together_read_one_secret_key(tmp_path):
    path = tmp_path / "key"
    keys = at_once(*[partial(private_files.read_or_make_secret_key, path)] * PEOPLE)
    assert len(set(keys)) == 1 and len(keys[0]) > 40
    assert path.stat().st_mode & 0o777 == 0o600


def test_a_secret_key_that_is_being_written_is_waited_for(tmp_path, monkeypatch):
    path = tmp_path / "key"
    path.touch()

    def write() -> None:
        time.sleep(0.1)
        path.write_text("whole")

    writer = threading.Thread(target=write)
    writer.start()
    assert private_files.read_or_make_secret_key(path) == "whole"
    writer.join()
    path.write_text("")
    monkeypatch.setattr(private_files, "PATIENCE_SECONDS", 0.0)
    with pytest.raises(ImproperlyConfigured):
        private_files.read_or_make_secret_key(path)


def test_a_world_is_deleted_once(sample, key):
    ask = partial(send, key, "DELETE", "/api/v1/worlds/home/", if_match="*")
    statuses = Counter(answer.status_code for answer in at_once(*[ask] * PEOPLE))
    assert statuses[204] + statuses[202] == 1 and set(statuses) <= {202, 204, 404}
    assert not World.objects.filter(name="home").exists()
