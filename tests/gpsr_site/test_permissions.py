"""Who may do what: one line a route, and no route without a line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from django.test import Client
from django.urls import URLPattern, URLResolver, get_resolver, reverse

from annotations.models import (
    Entity,
    Job,
    Label,
    Membership,
    Paraphrase,
    User,
    Utterance,
    WorkItem,
    World,
)
from annotations.models.worlds import Role
from tests.sample_world import SampleWorld

PEOPLE = ("anonymous", "stranger", "annotator", "reviewer", "admin")
LOG_IN, NOWHERE, NO, YES, GONE_ON, WRONG, BAD = 302, 404, 403, 200, 302, 405, 400


@dataclass(frozen=True)
class Rule:
    """What happens to each of ``PEOPLE`` who asks for ``name`` with ``method``.

    ``stranger`` has every duty, in another world.
    """

    name: str
    anonymous: int
    stranger: int
    annotator: int
    reviewer: int
    admin: int
    method: str = "get"

    def __str__(self) -> str:
        return f"{self.method} {self.name}"


MEMBERS = (LOG_IN, NOWHERE, YES, YES, YES)
ANNOTATORS = (LOG_IN, NOWHERE, YES, NO, YES)
ADMINS = (LOG_IN, NOWHERE, NO, NO, YES)

POLICY = [
    # Outside of any world
    Rule("healthz", YES, YES, YES, YES, YES),
    Rule("login", YES, GONE_ON, GONE_ON, GONE_ON, GONE_ON),
    Rule("logout", LOG_IN, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("password", LOG_IN, YES, YES, YES, YES),
    Rule("password", LOG_IN, YES, YES, YES, YES, method="post"),
    Rule("home", LOG_IN, YES, YES, YES, YES),
    Rule("inbox", LOG_IN, YES, YES, YES, YES),
    Rule("inbox", LOG_IN, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("notice_open", LOG_IN, NOWHERE, NOWHERE, NOWHERE, NOWHERE, method="post"),
    Rule("banner", LOG_IN, YES, YES, YES, YES),
    Rule("admin:index", LOG_IN, LOG_IN, LOG_IN, LOG_IN, LOG_IN),
    Rule("world_new", LOG_IN, NO, NO, NO, NO),
    Rule("world_new", LOG_IN, NO, NO, NO, NO, method="post"),
    Rule("world_import", LOG_IN, NO, NO, NO, NO),
    Rule("world_import", LOG_IN, NO, NO, NO, NO, method="post"),
    Rule("world_delete", LOG_IN, NOWHERE, NO, NO, NO),
    Rule("world_delete", LOG_IN, NOWHERE, NO, NO, NO, method="post"),
    # What members look at
    *(
        Rule(name, *MEMBERS)
        for name in (
            "world",
            "search",
            "download",
            "jobs",
            "job",
            "job_state",
            "ontology",
            "entity",
            "predicates",
            "grammar",
            "coverage",
            "uncovered",
            "unmatched",
            "conflicts",
            "outside_grammar",
            "templates",
            "template",
            "commands",
            "command",
            "complexity",
            "logical_forms",
            "logical_form",
            "paraphrases",
            "paraphrase",
            "utterances",
            "utterance",
            "splits",
            "split",
            "example",
            "near_duplicates",
            "runs",
            "runs_table",
            "run",
            "run_state",
            "run_charts",
            "run_curves",
            "predictions",
            "prediction",
            "results",
            "results_table",
            "results_csv",
            "history",
            "deleted",
            "queue",
            "queue_item",
            "agreement",
            "progress",
        )
    ),
    # What annotators write
    Rule("template_new", *ANNOTATORS),
    Rule("template_completion", *ANNOTATORS),
    Rule("template_duplicate", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("delete_row", *ANNOTATORS),
    Rule("delete_row", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("template", *ANNOTATORS, method="post"),
    Rule("template_new", *ANNOTATORS, method="post"),
    Rule("template_check", *ANNOTATORS, method="post"),
    Rule("template_preview", *ANNOTATORS, method="post"),
    Rule("entity", *ANNOTATORS, method="post"),
    Rule("download_part", *MEMBERS),
    Rule("predicate", *MEMBERS),
    Rule("predicate", *ANNOTATORS, method="post"),
    Rule("predicate_new", *ANNOTATORS),
    Rule("predicate_new", *ANNOTATORS, method="post"),
    Rule("predicate_preview", *ANNOTATORS, method="post"),
    Rule("production", *MEMBERS),
    Rule("production", *ANNOTATORS, method="post"),
    Rule("production_new", *ANNOTATORS),
    Rule("production_new", *ANNOTATORS, method="post"),
    Rule("production_check", *ANNOTATORS, method="post"),
    Rule("production_preview", *ANNOTATORS, method="post"),
    Rule("entity_new", *ANNOTATORS),
    Rule("entity_new", *ANNOTATORS, method="post"),
    Rule("entities_new", *ANNOTATORS),
    Rule("entities_new", *ANNOTATORS, method="post"),
    Rule("rename", *ANNOTATORS),
    Rule("rename", *ANNOTATORS, method="post"),
    Rule("comments", *MEMBERS),
    Rule("comments", *MEMBERS, method="post"),
    Rule("template_suggestions", *ANNOTATORS, method="post"),
    Rule("template_repair", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("draft", *ANNOTATORS),
    Rule("draft", LOG_IN, NOWHERE, BAD, NO, BAD, method="post"),
    Rule("template_consequences", *ANNOTATORS, method="post"),
    Rule("history", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("generate", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("split_new", *ANNOTATORS),
    Rule("split_new", *ANNOTATORS, method="post"),
    Rule("utterances_new", *ANNOTATORS),
    Rule("utterances_new", LOG_IN, NOWHERE, 422, NO, 422, method="post"),
    Rule("label", *ANNOTATORS),
    Rule("label_item", *ANNOTATORS),
    Rule("label_answer", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("label_send", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("label_mend", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("label_take_back", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("label_check", *ANNOTATORS, method="post"),
    # The queue itself knows who may do which item
    *(
        Rule(name, LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON, method="post")
        for name in ("queue_next", "queue_act", "queue_settle")
    ),
    Rule("queue_ask", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    # What admins decide
    Rule("queue_assign", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("queue_settings", *ADMINS),
    Rule("queue_settings", *ADMINS, method="post"),
    Rule("import", *ADMINS),
    Rule("import_pairs", *ADMINS),
    Rule("job_cancel", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("job_answer", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("run_new", *ADMINS),
    Rule("run_new", *ADMINS, method="post"),
    Rule("run_cancel", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("people", *ADMINS, method="post"),
    Rule("member", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("member", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    # What changes something is not done by following a link
    Rule("generate", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("run_cancel", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("template_check", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("template_preview", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("template_consequences", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("template_suggestions", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("template_repair", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    # The API (its own tests say more)
    Rule("api:schema", YES, YES, YES, YES, YES),
    Rule("api:split-export", 401, NOWHERE, YES, YES, YES),
    Rule("api:utterances", 401, NOWHERE, YES, YES, YES),
    Rule("api:utterances", 401, NOWHERE, 400, NO, 400, method="post"),
    Rule("api:utterance", 401, NOWHERE, YES, YES, YES),
    Rule("api:work-items", 401, NOWHERE, YES, YES, YES),
    Rule("api:work-item", 401, NOWHERE, YES, YES, YES),
    Rule("api:work-item-next", 401, NOWHERE, YES, 204, YES, method="post"),
    Rule("api:work-item-finish", 401, NOWHERE, 409, 409, 409, method="post"),
    Rule("api:work-item-give-back", 401, NOWHERE, 409, 409, 409, method="post"),
]


def address(name: str, world: SampleWorld, things: SampleWorld | None = None) -> str:
    """The address of a route below ``world``, about ``things`` (of that world, unless given)."""
    things = things or world
    keys = {
        "member": {"pk": member_of(things.world)},
        "template": {"pk": things.template.pk},
        "template_duplicate": {"pk": things.template.pk},
        "delete_row": {"kind": "template", "pk": things.template.pk},
        "template_repair": {"pk": things.template.pk},
        "template_completion": {"pk": things.world.grammar.task_categories.first().pk},
        "logical_form": {"pk": things.form.pk},
        "split": {"pk": things.split.pk},
        "example": {"split": things.split.pk, "pk": things.example.pk},
        "entity": {"pk": Entity.objects.filter(ontology__world=things.world).first().pk},
        "command": {"pk": things.world.commands.first().pk},
        "paraphrase": {"pk": paraphrase_in(things.world).pk},
        "history": {"kind": "template", "pk": things.template.pk},
        "deleted": {"kind": "template"},
        "predicate": {"pk": things.world.predicates.first().pk},
        "download_part": {"part": "grammar"},
        "production": {"pk": things.world.grammar.productions.first().pk},
        "rename": {"kind": "predicate", "pk": things.world.predicates.first().pk},
        "comments": {"kind": "template", "pk": things.template.pk},
        "notice_open": {"pk": 10**6},
        "draft": {"kind": "template", "subject": things.template.pk},
        "utterance": {"pk": utterance_in(things.world).pk},
        **{
            name: {"pk": utterance_in(things.world).pk}
            for name in ("label_answer", "label_check", "label_mend", "api:utterance")
        },
        **{
            name: {"pk": work_item_in(things.world).pk}
            for name in (
                *("queue_item", "queue_act", "queue_settle"),
                *("api:work-item", "api:work-item-finish", "api:work-item-give-back"),
            )
        },
        "queue_ask": {"kind": "utterance", "pk": utterance_in(things.world).pk},
        "label_take_back": {"pk": label_in(things.world).pk},
        "near_duplicates": {"pk": things.split.pk},
        "api:split-export": {"pk": things.split.pk},
        "prediction": {"pk": things.run.pk, "example": things.example.pk},
    }
    if name in ("job", "job_state", "job_cancel", "job_answer"):
        return reverse(name, kwargs={"pk": job_of(things.world)})
    about_a_run = ("run", "run_state", "run_charts", "run_curves", "run_cancel", "predictions")
    route_keys = {"pk": things.run.pk} if name in about_a_run else keys.get(name, {})
    if name in ROUTES_OF_WORLDS:
        route_keys["world"] = world.world.name
    return reverse(name, kwargs=route_keys) + ("?as=jsonl" if name == "api:split-export" else "")


def job_of(world: World) -> int:
    """An import that waits."""
    return Job.objects.get_or_create(world=world, world_name=world.name, kind="import_generator")[
        0
    ].pk


def member_of(world: World) -> int:
    """Somebody with a role there, whom nobody can lose."""
    user, _ = User.objects.get_or_create(username=f"someone in {world}")
    Membership.objects.get_or_create(world=world, user=user, role=Role.REVIEWER)
    return user.pk


def paraphrase_in(world: World) -> Paraphrase:
    """The paraphrase of ``world`` that the routes are about; the sample world brings none."""
    texts = dict.fromkeys(("prompt", "utterance", "grounded_form", "logical_form"), "go")
    distances = {"edit_distance": 0, "jaccard_distance": 0.0}
    return Paraphrase.objects.get_or_create(
        world=world, position=0, defaults={**texts, **distances}
    )[0]


def utterance_in(world: World) -> Utterance:
    """The utterance of ``world`` that the routes are about."""
    texts = {"text": "bring me tea", "anonymized_text": "bring me <object>"}
    return Utterance.objects.get_or_create(world=world, **texts)[0]


def label_in(world: World) -> Label:
    """An answer to it, of an account that was deleted."""
    return Label.objects.get_or_create(utterance=utterance_in(world), verdict="skip")[0]


def work_item_in(world: World) -> WorkItem:
    """What the queue asks about that utterance."""
    return WorkItem.objects.get_or_create(
        world=world, utterance=utterance_in(world), kind="unlabelled", priority=10
    )[0]


def routes(patterns, namespace: str = "", path: str = "") -> Iterator[tuple[str, str]]:
    """Name and path of every route; what Django's own admin adds counts as ``admin:index``."""
    for pattern in patterns:
        here = path + str(pattern.pattern)
        if isinstance(pattern, URLResolver):
            inside = f"{pattern.namespace}:" if pattern.namespace else namespace
            if pattern.namespace == "admin":
                yield "admin:index", here
            else:
                yield from routes(pattern.url_patterns, inside, here)
        elif isinstance(pattern, URLPattern):
            yield f"{namespace}{pattern.name}", here


ALL_ROUTES = dict(routes(get_resolver().url_patterns))
ROUTES_OF_WORLDS = {name for name, path in ALL_ROUTES.items() if "<slug:world>" in path}
ROUTES_OF_THINGS = sorted(name for name in ROUTES_OF_WORLDS if "<int:" in ALL_ROUTES[name])


# Routes of things that are not read, only changed.
ONLY_POSTED = (
    *("run_cancel", "member", "template_duplicate", "template_repair"),
    *("queue_ask", "queue_act", "queue_settle", "api:work-item-finish", "api:work-item-give-back"),
    *("label_answer", "label_check", "label_mend", "label_take_back"),
)


def test_every_route_has_a_rule():
    assert {rule.name for rule in POLICY} == set(ALL_ROUTES)


@pytest.mark.parametrize("person", PEOPLE)
@pytest.mark.parametrize("rule", POLICY, ids=str)
def test_the_policy_holds(rule, person, sample, request, client):
    if person != "anonymous":
        client.force_login(request.getfixturevalue(person))
    answer = getattr(client, rule.method)(address(rule.name, sample))
    assert answer.status_code == getattr(rule, person)


@pytest.mark.parametrize("name", ROUTES_OF_THINGS)
@pytest.mark.parametrize("method", ["get", "post", "put", "patch", "delete"])
def test_an_id_of_another_world_is_not_found(name, method, sample, other_sample, admin, client):
    client.force_login(admin)
    answer = getattr(client, method)(address(name, sample, other_sample))
    assert answer.status_code in (404, 405)
    if method in ("get", "post") and answer.status_code == 405:
        assert (name, method) in {
            *((each, "get") for each in ONLY_POSTED),
            *(
                (each, "post")
                for each in ROUTES_OF_THINGS
                if each
                not in (
                    "template",
                    "entity",
                    "production",
                    "history",
                    "comments",
                    "rename",
                    *ONLY_POSTED,
                )
            ),
        }


def test_an_account_that_is_switched_off_is_nobody(sample, annotator, client):
    client.force_login(annotator)
    annotator.is_active = False
    annotator.save()
    assert client.get(address("world", sample)).status_code == LOG_IN


def test_what_changes_something_needs_a_token_of_the_page(sample, admin):
    client = Client(enforce_csrf_checks=True)
    client.force_login(admin)
    for rule in POLICY:
        if rule.method == "post":
            assert client.post(address(rule.name, sample)).status_code == 403, rule


def test_accounts_are_the_business_of_superusers(superuser, admin, client):
    client.force_login(superuser)
    assert client.get(reverse("admin:index")).status_code == YES
    admin.is_staff = True
    admin.save()
    client.force_login(admin)
    assert client.get(reverse("admin:index")).status_code == LOG_IN
