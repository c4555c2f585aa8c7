"""The address of each route of the site below a sample world."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from django.db.models import Model
from django.urls import reverse

from annotations.models import Entity
from tests.gpsr_site.routes.listing import ROUTES_OF_WORLDS
from tests.gpsr_site.routes.sample_rows import (
    answer_of_nobody,
    campaign_key,
    campaign_row,
    contributor_row,
    decision_of_nobody,
    dialogue,
    entity_class,
    error_category,
    finding,
    invitation,
    job_without_world,
    join_keys,
    offered_entity,
    predicate,
    primitive,
    proposal,
    recipe,
    removable_member,
    review,
    run,
    saved_slice,
    split,
    submission,
    task_category,
    template,
    upload,
    utterance,
    waiting_job,
    work_item,
)
from tests.sample_world import SampleWorld, comment_in, paraphrase_in

RouteKeys: TypeAlias = Callable[[SampleWorld], dict[str, object]]


# Without one, an export is refused, and Review leads to the run that it opens on.
QUERIES = {"api:split-export": "?as=jsonl", "review": "?part=validation"}


def address(name: str, world: SampleWorld, rows: SampleWorld | None = None) -> str:
    """Return the address of a route below ``world``, about a row of ``rows`` (of ``world`` unless given)."""
    keys = KEYS[name](rows or world) if name in KEYS else {}
    if name in ROUTES_OF_WORLDS:
        keys["world"] = world.world.name
    return reverse(name, kwargs=keys) + QUERIES.get(name, "")


def pk_of(row: Callable[[SampleWorld], Model], **others: str) -> RouteKeys:
    """Return a function that gives the keys of a route about ``row``, beside ``others``."""
    return lambda sample: {"pk": row(sample).pk, **others}


KEYS: dict[str, RouteKeys] = {
    **dict.fromkeys(
        ("member", "api:member-detail", "api:account-detail", "api:account-link"),
        pk_of(removable_member),
    ),
    **dict.fromkeys(("invitation_withdraw", "api:invitation-detail"), pk_of(invitation)),
    **dict.fromkeys(("api:token-detail", "api:notice-read"), lambda _: {"pk": 10**6}),
    "api:session": lambda _: {"handle": "none"},
    **dict.fromkeys(("api:site-job-detail", "api:site-job-cancel"), pk_of(job_without_world)),
    "results_download": lambda _: {"as_": "csv"},
    "document": lambda _: {"shelf": "guides", "page": "first-steps"},
    "document_image": lambda _: {"name": "run.png"},
    "join": join_keys,
    **dict.fromkeys(
        (
            *(
                "campaign_page",
                "campaign_edit",
                "campaign_state",
                "campaign_act",
                "api:campaign-detail",
            ),
            *("api:campaign-progress", "api:campaign-close", "api:campaign-reopen"),
            *("api:campaign-revoke-link", "api:campaign-renew-link"),
            *("api:campaign-tasks", "api:campaign-triples"),
        ),
        pk_of(campaign_row),
    ),
    **dict.fromkeys(
        ("contributor_forget", "api:contributor-detail", "api:contributor-forget"),
        pk_of(contributor_row),
    ),
    **dict.fromkeys(("campaign", "campaign_done"), campaign_key),
    **dict.fromkeys(("campaign_model", "api:campaign-model"), pk_of(campaign_row)),
    **dict.fromkeys(
        (
            *("submission", "submission_decide", "api:submission-detail", "api:submission-mend"),
            *("api:submission-take-back", "api:submission-with-form", "api:submission-with-doubt"),
        ),
        pk_of(submission),
    ),
    **dict.fromkeys(
        ("campaign_place", "campaign_check"), lambda sample: {**campaign_key(sample), "position": 1}
    ),
    **dict.fromkeys(("account_close", "account_link"), pk_of(removable_member)),
    "password_set": lambda _: {"uidb64": "MQ", "token": "none"},
    "token_revoke": lambda _: {"pk": 10**6},
    "session_end": lambda _: {"handle": "none"},
    **dict.fromkeys(
        ("template", "template_duplicate", "template_repair", "api:template-detail"),
        pk_of(template),
    ),
    "template_completion": pk_of(lambda sample: sample.world.grammar.task_categories.first()),
    "delete_row": pk_of(template, kind="template"),
    **dict.fromkeys(("history", "api:history"), pk_of(template, kind="template")),
    **dict.fromkeys(("comments", "api:comments"), pk_of(template, kind="template")),
    **dict.fromkeys(
        (
            "comment",
            "comment_delete",
            "comment_restore",
            "api:comment-detail",
            "api:comment-restore",
        ),
        pk_of(lambda sample: comment_in(sample.world)),
    ),
    "draft": lambda sample: {"kind": "template", "subject": sample.template.pk},
    **dict.fromkeys(("deleted", "api:deleted"), lambda _: {"kind": "template"}),
    **dict.fromkeys(("logical_form", "api:form-detail"), pk_of(lambda sample: sample.form)),
    **dict.fromkeys(
        ("command", "api:command-detail"), pk_of(lambda sample: sample.world.commands.first())
    ),
    **dict.fromkeys(
        ("paraphrase", "paraphrase_label", "paraphrase_check", "api:paraphrase-detail"),
        pk_of(lambda sample: paraphrase_in(sample.world)),
    ),
    **dict.fromkeys(
        ("entity", "api:entity-detail"),
        pk_of(lambda sample: Entity.objects.filter(ontology__world=sample.world).first()),
    ),
    **dict.fromkeys(("entity_class", "api:entity-class-detail"), pk_of(entity_class)),
    **dict.fromkeys(("recipe", "api:recipe-detail"), pk_of(recipe)),
    **dict.fromkeys(("task_category", "api:task-category-detail"), pk_of(task_category)),
    **dict.fromkeys(("primitive", "api:primitive-detail"), pk_of(primitive)),
    **dict.fromkeys(("predicate", "api:predicate-detail"), pk_of(predicate)),
    **dict.fromkeys(("rename", "api:rename"), pk_of(predicate, kind="predicate")),
    **dict.fromkeys(
        ("production", "api:production-detail"),
        pk_of(lambda sample: sample.world.grammar.productions.first()),
    ),
    **dict.fromkeys(("download_part", "api:download-part"), lambda _: {"part": "grammar"}),
    "notice_open": lambda _: {"pk": 10**6},
    **dict.fromkeys(
        (
            *("split", "near_duplicates", "split_changes", "split_renew", "split_runs"),
            *("api:split-export", "api:split-detail", "api:split-renew", "api:split-examples"),
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
            *("api:run-detail", "api:run-log", "api:run-curves", "api:run-checkpoints"),
            *("api:run-cancel", "api:run-retrain", "api:predictions", "api:candidates"),
            *("api:run-learning-curve", "api:run-analysis", "api:predictions-send"),
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
            *("api:error-category-detail", "api:error-category-move"),
        ),
        pk_of(error_category),
    ),
    "api:evaluation-detail": pk_of(lambda sample: sample.run.evaluations.first()),
    "api:review-detail": pk_of(review),
    **dict.fromkeys(
        ("api:answer-review", "api:answer-doubt"),
        lambda sample: {"run": sample.run.pk, "pk": sample.example.pk},
    ),
    **dict.fromkeys(
        (
            *("job", "job_state", "job_cancel", "job_answer"),
            *("api:job-detail", "api:job-cancel", "api:job-answer", "api:job-result"),
        ),
        pk_of(waiting_job),
    ),
    **dict.fromkeys(
        (
            *("utterance", "label_answer", "label_check", "label_mend", "api:utterance-detail"),
            *("api:utterance-label", "api:utterance-spans", "api:utterance-candidates"),
        ),
        pk_of(utterance),
    ),
    **dict.fromkeys(
        (
            *("upload", "upload_undo", "upload_redo"),
            *("api:upload-detail", "api:upload-undo", "api:upload-redo"),
        ),
        pk_of(upload),
    ),
    **dict.fromkeys(("label_take_back", "api:label-take-back"), pk_of(answer_of_nobody)),
    **dict.fromkeys(
        (
            *("queue_item", "queue_act", "queue_settle"),
            *("api:work-item-detail", "api:work-item-finish", "api:work-item-give-back"),
            *("api:work-item-take", "api:work-item-skip"),
            *("api:work-item-assign", "api:work-item-withdraw"),
        ),
        pk_of(work_item),
    ),
    **dict.fromkeys(
        (
            "audit_item",
            "audit_decide",
            "audit_check",
            "api:audit-finding-detail",
            "api:audit-finding-decide",
        ),
        pk_of(finding),
    ),
    **dict.fromkeys(("audit_take_back", "api:audit-decision-take-back"), pk_of(decision_of_nobody)),
    **dict.fromkeys(
        (
            *("dialogue", "dialogue_keep"),
            *("api:dialogue-detail", "api:dialogue-answer", "api:dialogue-keep"),
        ),
        pk_of(dialogue),
    ),
    **dict.fromkeys(("offered_entity_decide", "api:offered-entity-decide"), pk_of(offered_entity)),
    "plan_schema": lambda _: {"name": "plan.schema.json"},
    "queue_ask": pk_of(utterance, kind="utterance"),
    **dict.fromkeys(("slice_rename", "slice_delete", "api:slice-detail"), pk_of(saved_slice)),
    **dict.fromkeys(("promotion_decline", "api:promotion-decline"), pk_of(proposal)),
}
