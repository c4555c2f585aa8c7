"""Write the audit log: one entry for each request that has changed something.

Middleware of the site calls ``record`` in one place, so that no page or route can be forgotten. A view
may say with ``note`` what its address does not. Commands that change something call ``record_command``.
"""

from __future__ import annotations

import logging
import re
from datetime import datetime
from typing import Any

from django.db import DatabaseError, transaction
from django.http import HttpRequest, HttpResponse
from django.urls import ResolverMatch

from annotations.models import ApiToken, AuditEntry, Scope, World

logger = logging.getLogger(__name__)

# Who does what a management command does, and what nobody has asked for.
COMMAND_LINE, RULE = "command line", "rule"
MOST_AT_ONCE = 5_000  # entries that are deleted in one transaction
SAFE_METHODS = ("GET", "HEAD", "OPTIONS", "TRACE")
# Routes that are posted to and change nothing that others see; and contributors of campaigns, who are known by
# a pseudonym alone also where they are logged in.
UNRECORDED = re.compile(
    r"_(check|preview|suggestions|completion|consequences)$"
    r"|^(draft|inbox|notice_open|notice-read-all|notice-read|queue_next|work-item-next|tryout_ask|playground_ask|joint_plan_ask)$"
    r"|^(campaign|campaign_place|campaign_done)$"
)
VERBS = {"POST": "create", "PUT": "change", "PATCH": "change", "DELETE": "delete"}
# What a route does where its name does not say it.
WHAT = {
    **dict.fromkeys(("submission_decide", "submissions_decide"), "moderate submissions"),
    "submissions_take_back": "take back a moderation",
    **dict.fromkeys(("campaign_model", "campaign-model"), "ask a language model for paraphrases"),
    "login": "log in",
    "join": "join",
    "password": "change password",
    "password_set": "set password",
    "account_close": "close or open an account",
    "account_link": "make a link for a new password",
    "token_new": "make a token",
    "token_revoke": "revoke a token",
    "logout": "log out",
    "session_end": "log out elsewhere",
    "sessions_end": "log out everywhere",
    "people": "add a member",
    "member": "change roles",
    "invite": "invite",
    "invitation_withdraw": "withdraw an invitation",
    "people_take_back": "undo a change of people",
    "world_new": "create a world",
    "world_import": "import a world",
    "world_edit": "describe the world",
    "world_delete": "delete the world",
    "import": "import files",
    "import_competition": "import a competition",
    "import_pairs": "import pairs",
    "location_rooms": "choose rooms",
    "generate": "generate commands",
    "generation": "generate commands",
    "job_answer": "answer a job",
    "job_cancel": "cancel a job",
    "rename": "rename everywhere",
    "history": "restore a version",
    "deleted": "restore a deleted row",
    "delete_row": "delete",
    "comments": "comment",
    "comment": "change a comment",
    "comment_delete": "delete a comment",
    "comment_restore": "restore a comment",
    **{name: f"change {name}" for name in ("template", "entity", "predicate", "production")},
    **{f"{name}_new": f"new {name}" for name in ("template", "entity", "predicate", "production")},
    "entities_new": "add entities",
    "entity_class": "change class",
    "entity_class_new": "new class",
    **{name: f"change {name}" for name in ("recipe", "primitive")},
    **{f"{name}_new": f"new {name}" for name in ("recipe", "primitive")},
    "recipe_book": "replace the recipes",
    "offered_entity_decide": "decide about a word from dialogues",
    "robot": "name actions",
    "template_duplicate": "copy a template",
    "template_repair": "repair a template",
    "utterances_new": "add utterances",
    "upload": "store an upload",
    "upload_undo": "undo an upload",
    "upload_redo": "store an undone upload again",
    "utterances_delete": "delete utterances",
    "utterances_restore": "restore utterances",
    "paraphrase_label": "label a paraphrase",
    **dict.fromkeys(("campaign_results", "campaign-results"), "check crowd results"),
    "campaign_new": "launch a campaign",
    "campaign_edit": "change a campaign",
    "campaign_act": "close or open a campaign",
    "contributor_forget": "forget a contributor",
    "split_new": "freeze a split",
    "split_renew": "freeze a split anew",
    "run_new": "start a run",
    "run_cancel": "cancel a run",
    "run_retrain": "retrain a run",
    "learning_curve_start": "start runs of a learning curve",
    **dict.fromkeys(("paraphrase_runs_start", "paraphrase-runs"), "train on people and on models"),
    "analysis_start": "analyse errors",
    "analysis_cancel": "cancel an error analysis",
    "review_tag": "tag an answer",
    "review_note": "write a note on an answer",
    "review_doubt": "doubt a label",
    "error_categories": "add an error category",
    "error_category": "change an error category",
    "error_category_delete": "delete an error category",
    "error_category_move": "move an error category",
    "slices": "save a slice",
    "slice_rename": "rename a slice",
    "slice_delete": "delete a slice",
    "example_send": "send an example to the work queue",
    "predictions_send": "send answers to the work queue",
    "promotion_promote": "promote a run",
    "promotion_roll_back": "roll back to the run before",
    "promotion_decline": "decline a proposed run",
    "answering": "choose what answers",
    "playground_wrong": "report a wrong answer",
    "dialogues": "begin a dialogue",
    "dialogue": "answer in a dialogue",
    "dialogue_keep": "keep a dialogue as an utterance",
    "label_answer": "label",
    "label_mend": "correct what names an entity",
    "label_send": "send an utterance to be labelled",
    "label_take_back": "take a label back",
    "audit_start": "start a label audit",
    **dict.fromkeys(("results_measure", "results-measure"), "measure what a robot gets"),
    "audit_decide": "decide about a label",
    "audit_take_back": "take a decision back",
    "queue_settings": "set shares",
    "guidelines": "write guidelines",
    "queue_act": "work on an item",
    "queue_ask": "ask for a look",
    "queue_assign": "assign an item",
    "queue_settle": "settle two labels",
}


def note(request: HttpRequest, sentence: str) -> None:
    """Say in the audit log what the request was about, of a page or of the API; never a secret."""
    plain: Any = getattr(request, "_request", request)  # the one below that of a route
    plain.audit_note = sentence


def record(request: HttpRequest, response: HttpResponse) -> AuditEntry | None:
    """Write down what ``request`` has done; None for one that has changed nothing."""
    match = request.resolver_match
    if match is None or not _has_done_something(request, match, response):
        return None
    assert request.user.is_authenticated
    token, world = getattr(request, "auth", None), getattr(request, "world", None)
    name = world.name if world else match.kwargs.get("world")
    # None where the request has just deleted it.
    world = World.objects.filter(name=name).first() if name else None
    # What a view has noted, else the kind and key of the row that the address names.
    names = ("kind", "split", "subject", "pk", "object_id")
    row = " ".join(str(match.kwargs[each]) for each in names if each in match.kwargs)
    subject = str(getattr(request, "audit_note", "") or row)
    return AuditEntry.objects.create(
        world=world,
        world_name=world.name if world else "",
        who=request.user,
        who_name=request.user.get_username(),
        through=token.name if isinstance(token, ApiToken) else "",
        what=_what(request, match),
        subject=subject,
    )


def record_command(
    what: str, subject: str = "", world: World | None = None, who: str = COMMAND_LINE
) -> None:
    """Write down what a management command or a rule has done; it stays done where that fails."""
    try:
        with transaction.atomic():
            AuditEntry.objects.create(
                world=world,
                world_name=world.name if world else "",
                who_name=who,
                what=what,
                subject=subject,
            )
    except DatabaseError:
        logger.exception("An entry of the audit log could not be written.")


def prune(before: datetime, world: World | None = None) -> int:
    """Delete the entries from before a moment, of one world or of all, and return how many they were.

    In short transactions, so that people work meanwhile.
    """
    old = AuditEntry.objects.filter(at__lt=before).order_by("pk")
    if world is not None:
        old = old.filter(world=world)
    count = 0
    while keys := list(old.values_list("pk", flat=True)[:MOST_AT_ONCE]):
        AuditEntry.objects.filter(pk__in=keys).delete()
        count += len(keys)
    return count


def _has_done_something(request: HttpRequest, match: ResolverMatch, response: HttpResponse) -> bool:
    if request.method in SAFE_METHODS or response.status_code >= 400:
        return False
    if not request.user.is_authenticated or UNRECORDED.search(match.url_name or ""):
        return False
    if _is_api(match):
        method = request.method or ""
        asked = getattr(match.func, "actions", {}).get(method.lower(), method)
        scopes = getattr(getattr(match.func, "cls", None), "scopes", {})
        return scopes.get(asked) != Scope.READ
    # A page that answers a form with itself has refused it, unless it says otherwise.
    is_htmx = bool(getattr(request, "htmx", False))
    return response.status_code != 200 or is_htmx or hasattr(request, "audit_note")


def _is_api(match: ResolverMatch) -> bool:
    return "api" in match.namespaces


def _what(request: HttpRequest, match: ResolverMatch) -> str:
    name = match.url_name or ""
    if name.endswith("-list"):  # of a view set: its address has the plural
        name = match.route.strip("/").rpartition("/")[2]
    words = re.sub(r"[_-]+", " ", name.removesuffix("-detail"))
    if _is_api(match):
        return f"{VERBS[request.method or '']} {words}"
    if "admin" in match.namespaces:
        return f"site administration: {words}"
    return WHAT.get(name, words)
