"""Every route of the site, and the address of each below a sample world."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from datetime import timedelta
from typing import TypeAlias

from django.db.models import Model
from django.urls import URLPattern, URLResolver, get_resolver, reverse
from django.utils import timezone

from annotations.language.dialogue import Offer, Phase, State
from annotations.models import (
    AuditDecision,
    AuditFinding,
    Entity,
    Invitation,
    Job,
    Label,
    Membership,
    User,
    Utterance,
    WorkItem,
)
from annotations.models.people import digest_of
from annotations.models.worlds import Role
from parser_service.conversing.offering import offer
from parser_service.models import Dialogue, OfferedEntity, Promotion, PromotionState, Slice
from parser_service.reviewing.categories import ensure_categories
from tests.sample_world import SampleWorld, comment_in, paraphrase_in

RouteKeys: TypeAlias = Callable[[SampleWorld], dict[str, object]]


def list_routes(patterns, namespace: str = "", path: str = "") -> Iterator[tuple[str, str]]:
    """Yield name and path of every route; what Django's own admin adds counts as ``admin:index``."""
    for pattern in patterns:
        here = path + str(pattern.pattern)
        if isinstance(pattern, URLResolver):
            inside = f"{pattern.namespace}:" if pattern.namespace else namespace
            if pattern.namespace == "admin":
                yield "admin:index", here
            else:
                yield from list_routes(pattern.url_patterns, inside, here)
        elif isinstance(pattern, URLPattern):
            yield f"{namespace}{pattern.name}", here


def list_views(patterns, namespace: str = "") -> Iterator[tuple[str, type]]:
    """Yield name and class of every route of the API."""
    for pattern in patterns:
        if isinstance(pattern, URLResolver):
            inside = f"{pattern.namespace}:" if pattern.namespace else namespace
            yield from list_views(pattern.url_patterns, inside)
        elif isinstance(pattern, URLPattern) and namespace == "api:":
            yield f"{namespace}{pattern.name}", pattern.callback.view_class


ALL_ROUTES = dict(list_routes(get_resolver().url_patterns))
API_VIEWS = dict(list_views(get_resolver().url_patterns))
ROUTES_OF_WORLDS = {name for name, path in ALL_ROUTES.items() if "<slug:world>" in path}
ROUTES_OF_ROWS = sorted(name for name in ROUTES_OF_WORLDS if "<int:" in ALL_ROUTES[name])


def address(name: str, world: SampleWorld, rows: SampleWorld | None = None) -> str:
    """Return the address of a route below ``world``, about a row of ``rows`` (of ``world`` unless given)."""
    keys = KEYS[name](rows or world) if name in KEYS else {}
    if name in ROUTES_OF_WORLDS:
        keys["world"] = world.world.name
    return reverse(name, kwargs=keys) + ("?as=jsonl" if name == "api:split-export" else "")


def pk_of(row: Callable[[SampleWorld], Model], **others: str) -> RouteKeys:
    """Return a function that gives the keys of a route about ``row``, beside ``others``."""
    return lambda sample: {"pk": row(sample).pk, **others}


def waiting_job(sample: SampleWorld) -> Job:
    world = sample.world
    return Job.objects.get_or_create(world=world, world_name=world.name, kind="import_generator")[0]


def job_without_world(sample: SampleWorld) -> Job:
    """Return the import of a world that is not there yet, which nobody of the policy asked for."""
    name = f"copy-of-{sample.world}"
    return Job.objects.get_or_create(world=None, world_name=name, kind="import_world")[0]


def proposal(sample: SampleWorld) -> Promotion:
    """Return a proposal that nobody has decided."""
    return Promotion.objects.get_or_create(
        world=sample.world, run=sample.run, state=PromotionState.PROPOSED
    )[0]


def removable_member(sample: SampleWorld) -> User:
    """Return somebody with a role in the world, whom no test needs."""
    user, _ = User.objects.get_or_create(username=f"someone in {sample.world}")
    Membership.objects.get_or_create(world=sample.world, user=user, role=Role.REVIEWER)
    return user


def invitation(sample: SampleWorld) -> Invitation:
    """Return an invitation to the world, whose link has a key that ``key_of`` knows."""
    later = timezone.now() + timedelta(days=1)
    values = {"roles": [Role.REVIEWER], "places": 100, "expires_at": later}
    values["created_by"] = removable_member(sample)
    return Invitation.objects.get_or_create(
        world=sample.world, digest=digest_of(key_of(sample)), defaults=values
    )[0]


def key_of(sample: SampleWorld) -> str:
    return f"key-of-{sample.world}"


def join_keys(sample: SampleWorld) -> dict[str, object]:
    invitation(sample)
    return {"key": key_of(sample)}


def utterance(sample: SampleWorld) -> Utterance:
    texts = {"text": "bring me tea", "anonymized_text": "bring me <object>"}
    return Utterance.objects.get_or_create(world=sample.world, **texts)[0]


def answer_of_nobody(sample: SampleWorld) -> Label:
    """Return an answer to the utterance, of an account that was deleted."""
    return Label.objects.get_or_create(utterance=utterance(sample), verdict="skip")[0]


def work_item(sample: SampleWorld) -> WorkItem:
    """Return what the queue asks about the utterance."""
    row = utterance(sample)
    return WorkItem.objects.get_or_create(
        world=sample.world, utterance=row, title=row.text, kind="unlabelled", priority=10
    )[0]


def finding(sample: SampleWorld) -> AuditFinding:
    """Return a label that is in doubt."""
    forms = {"form": "( go )", "suggested_form": "( find )"}
    return AuditFinding.objects.get_or_create(
        world=sample.world,
        paraphrase=paraphrase_in(sample.world),
        defaults={**forms, "rank": 1, "score": 1.0},
    )[0]


def decision_of_nobody(sample: SampleWorld) -> AuditDecision:
    """Return what somebody whose account was deleted decided about it."""
    return AuditDecision.objects.get_or_create(finding=finding(sample), decision="kept")[0]


def saved_slice(sample: SampleWorld) -> Slice:
    return Slice.objects.get_or_create(
        world=sample.world, name="wrong ones", query="outcome=wrong"
    )[0]


def error_category(sample: SampleWorld) -> Model:
    return list(ensure_categories(sample.world).values())[-1]


def review(sample: SampleWorld) -> Model:
    """Return what somebody whose account was deleted wrote about an answer."""
    return sample.run.reviews.get_or_create(example=sample.example, note="Hm.")[0]


def dialogue(sample: SampleWorld) -> Dialogue:
    """Return a dialogue about a command that nobody understood."""
    state = State(Phase.REPHRASING, prompt="Please say it another way.").as_json()
    values = {"state": state, "phase": "rephrasing"}
    return Dialogue.objects.get_or_create(world=sample.world, utterance="dance", defaults=values)[0]


def offered_entity(sample: SampleWorld) -> OfferedEntity:
    return offer(sample.world, Offer("object", "flurb"), "bring me the flurb")


def predicate(sample: SampleWorld) -> Model:
    return sample.world.predicates.first()


def template(sample: SampleWorld) -> Model:
    return sample.template


def split(sample: SampleWorld) -> Model:
    return sample.split


def run(sample: SampleWorld) -> Model:
    return sample.run


KEYS: dict[str, RouteKeys] = {
    **dict.fromkeys(
        ("member", "api:member", "api:account", "api:account-link"), pk_of(removable_member)
    ),
    **dict.fromkeys(("invitation_withdraw", "api:invitation"), pk_of(invitation)),
    **dict.fromkeys(("api:token", "api:notice-read"), lambda _: {"pk": 10**6}),
    "api:session": lambda _: {"handle": "none"},
    **dict.fromkeys(("api:site-job", "api:site-job-cancel"), pk_of(job_without_world)),
    "join": join_keys,
    **dict.fromkeys(("account_close", "account_link"), pk_of(removable_member)),
    "password_set": lambda _: {"uidb64": "MQ", "token": "none"},
    "token_revoke": lambda _: {"pk": 10**6},
    "session_end": lambda _: {"handle": "none"},
    **dict.fromkeys(
        ("template", "template_duplicate", "template_repair", "api:template"), pk_of(template)
    ),
    "template_completion": pk_of(lambda sample: sample.world.grammar.task_categories.first()),
    "delete_row": pk_of(template, kind="template"),
    **dict.fromkeys(("history", "api:history"), pk_of(template, kind="template")),
    **dict.fromkeys(("comments", "api:comments"), pk_of(template, kind="template")),
    **dict.fromkeys(
        ("comment", "comment_delete", "comment_restore", "api:comment", "api:comment-restore"),
        pk_of(lambda sample: comment_in(sample.world)),
    ),
    "draft": lambda sample: {"kind": "template", "subject": sample.template.pk},
    **dict.fromkeys(("deleted", "api:deleted"), lambda _: {"kind": "template"}),
    **dict.fromkeys(("logical_form", "api:form"), pk_of(lambda sample: sample.form)),
    **dict.fromkeys(
        ("command", "api:command"), pk_of(lambda sample: sample.world.commands.first())
    ),
    **dict.fromkeys(
        ("paraphrase", "paraphrase_label", "paraphrase_check", "api:paraphrase"),
        pk_of(lambda sample: paraphrase_in(sample.world)),
    ),
    **dict.fromkeys(
        ("entity", "api:entity"),
        pk_of(lambda sample: Entity.objects.filter(ontology__world=sample.world).first()),
    ),
    **dict.fromkeys(("predicate", "api:predicate"), pk_of(predicate)),
    **dict.fromkeys(("rename", "api:rename"), pk_of(predicate, kind="predicate")),
    **dict.fromkeys(
        ("production", "api:production"),
        pk_of(lambda sample: sample.world.grammar.productions.first()),
    ),
    **dict.fromkeys(("download_part", "api:download-part"), lambda _: {"part": "grammar"}),
    "notice_open": lambda _: {"pk": 10**6},
    **dict.fromkeys(
        (
            *("split", "near_duplicates", "split_changes", "split_renew", "split_runs"),
            *("api:split-export", "api:split", "api:split-renew", "api:split-examples"),
            *("api:split-manifest", "api:near-duplicates", "api:split-changes"),
        ),
        pk_of(split),
    ),
    **dict.fromkeys(
        ("example", "example_send", "api:example-send"),
        lambda sample: {"split": sample.split.pk, "pk": sample.example.pk},
    ),
    **dict.fromkeys(
        (
            *("run", "run_state", "run_charts", "run_curves", "run_cancel", "run_retrain"),
            *("run_report", "predictions", "predictions_send"),
            "learning_curve_start",
            *("api:run", "api:run-log", "api:run-curves", "api:run-checkpoints"),
            *("api:run-cancel", "api:run-retrain", "api:predictions", "api:candidates"),
            *("api:learning-curve", "api:run-analyse", "api:predictions-send"),
            *("api:run-findings", "api:run-probes"),
        ),
        pk_of(run),
    ),
    **dict.fromkeys(("analysis_state", "analysis_start", "analysis_cancel"), pk_of(run)),
    **dict.fromkeys(("defaults", "sensitivity", "probes"), pk_of(run)),
    **dict.fromkeys(
        ("review_tag", "review_note", "review_doubt"), pk_of(lambda sample: sample.example)
    ),
    **dict.fromkeys(
        (
            *("error_category", "error_category_move", "error_category_delete"),
            *("api:error-category", "api:error-category-move"),
        ),
        pk_of(error_category),
    ),
    "api:evaluation": pk_of(lambda sample: sample.run.evaluations.first()),
    "api:review": pk_of(review),
    **dict.fromkeys(
        ("api:answer-review", "api:answer-doubt"),
        lambda sample: {"run": sample.run.pk, "pk": sample.example.pk},
    ),
    **dict.fromkeys(
        (
            *("job", "job_state", "job_cancel", "job_answer"),
            *("api:job", "api:job-cancel", "api:job-answer"),
        ),
        pk_of(waiting_job),
    ),
    **dict.fromkeys(
        (
            *("utterance", "label_answer", "label_check", "label_mend", "api:utterance"),
            *("api:utterance-label", "api:utterance-spans", "api:utterance-candidates"),
        ),
        pk_of(utterance),
    ),
    **dict.fromkeys(("label_take_back", "api:label-take-back"), pk_of(answer_of_nobody)),
    **dict.fromkeys(
        (
            *("queue_item", "queue_act", "queue_settle"),
            *("api:work-item", "api:work-item-finish", "api:work-item-give-back"),
            *("api:work-item-take", "api:work-item-skip"),
            *("api:work-item-assign", "api:work-item-withdraw"),
        ),
        pk_of(work_item),
    ),
    **dict.fromkeys(
        ("audit_item", "audit_decide", "audit_check", "api:audit-finding", "api:audit-decide"),
        pk_of(finding),
    ),
    **dict.fromkeys(("audit_take_back", "api:audit-take-back"), pk_of(decision_of_nobody)),
    **dict.fromkeys(
        (
            *("dialogue", "dialogue_keep"),
            *("api:dialogue", "api:dialogue-answer", "api:dialogue-keep"),
        ),
        pk_of(dialogue),
    ),
    **dict.fromkeys(("offered_entity_decide", "api:offered-entity-decide"), pk_of(offered_entity)),
    "plan_schema": lambda _: {"name": "plan.schema.json"},
    "queue_ask": pk_of(utterance, kind="utterance"),
    **dict.fromkeys(("slice_rename", "slice_delete", "api:slice"), pk_of(saved_slice)),
    **dict.fromkeys(("promotion_decline", "api:promotion-decline"), pk_of(proposal)),
}
