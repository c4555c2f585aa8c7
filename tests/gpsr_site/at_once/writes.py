"""What many send at the same moment: to each route that changes a version, and to each that makes a name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from annotations.exchange.generator_import import import_generator
from annotations.exchange.world_export import world_archive
from annotations.models import ApiToken, User, World
from annotations.models.people import LogInSession
from annotations.people.accounts import sessions_of
from tests.annotations.conftest import TINY, as_bytes
from tests.conftest import client_of
from tests.gpsr_site.routes.addresses import KEYS, RouteKeys
from tests.sample_world import SampleWorld, comment_in, paraphrase_in

# What the writer with this number sends in this round; every round differs from the one before.
Body: TypeAlias = Callable[[int, int], dict[str, Any]]


def nothing(writer: int, turn: int) -> dict[str, Any]:
    return {}


def different(writer: int, turn: int) -> str:
    return f"of {writer} in {turn}"


# Route and method → body. Whatever takes ``If-Match`` stands here.
CHANGES: dict[tuple[str, str], Body] = {
    ("api:entity-detail", "PATCH"): lambda *each: {"aliases": [different(*each)]},
    ("api:entity-class-detail", "PATCH"): lambda *each: {"said": different(*each)},
    ("api:predicate-detail", "PATCH"): lambda *each: {"gloss": different(*each)},
    ("api:task-category-detail", "PATCH"): lambda *each: {"rule_sources": [different(*each)]},
    ("api:recipe-detail", "PATCH"): lambda *each: {
        "text": f'go(destination) -> say("{different(*each)}")'
    },
    ("api:primitive-detail", "PATCH"): lambda *each: {"text": f'dance() "{different(*each)}"'},
    ("api:recipe-book", "PATCH"): lambda *each: {
        "recipes": [f'go(destination) -> say("{different(*each)}")']
    },
    ("api:production-detail", "PATCH"): lambda *each: {"expansion": f"go {different(*each)}"},
    ("api:template-detail", "PATCH"): lambda *each: {"pattern": f"find {different(*each)} $object"},
    ("api:rename", "POST"): lambda writer, turn: {"new": f"name_{writer}_{turn}"},
    ("api:paraphrase-detail", "PATCH"): lambda *each: {
        "logical_form": f'( go " {different(*each)} " )'
    },
    ("api:comment-detail", "PATCH"): lambda *each: {"text": different(*each)},
    ("api:world", "PATCH"): lambda *each: {"description": different(*each)},
    ("api:guidelines", "PATCH"): lambda *each: {"text": different(*each)},
    ("api:queue-settings", "PATCH"): lambda writer, turn: {"unlabelled": 1 + writer + 30 * turn},
    ("api:answerer", "PATCH"): lambda writer, turn: {
        "allowed_wrong": (1 + writer + 30 * turn) / 1000
    },
    ("api:account-detail", "PATCH"): lambda writer, turn: {"is_active": bool(turn % 2)},
    ("api:member-detail", "PATCH"): lambda writer, turn: {
        "roles": ["annotator", "admin"][: 1 + turn % 2]
    },
    ("api:answer-review", "PATCH"): lambda *each: {"note": different(*each)},
    ("api:error-category-detail", "PATCH"): lambda *each: {"name": different(*each)},
    ("api:campaign-detail", "PATCH"): lambda *each: {"thanks": different(*each)},
    ("api:slice-detail", "PATCH"): lambda *each: {"name": different(*each)},
    **{
        (f"api:{name}", "DELETE"): nothing
        for name in (
            *(
                "entity-detail",
                "entity-class-detail",
                "predicate-detail",
                "task-category-detail",
                "recipe-detail",
                "primitive-detail",
                "production-detail",
                "template-detail",
                "paraphrase-detail",
                "comment-detail",
                "world",
            ),
            "utterance-detail",
            *(
                "token-detail",
                "session",
                "member-detail",
                "invitation-detail",
                "error-category-detail",
                "slice-detail",
            ),
        )
    },
}
# Routes that show no version, by those that do.
SHOWN_BY = {"api:rename": "api:predicate-detail"}

# Routes that make something of a name that is there once.
NAMES: dict[str, dict[str, Any]] = {
    "api:entity-list": {"entity_class": "object", "text": "flurb"},
    "api:entity-class-list": {
        **{"token": "garment", "singular": "garment", "plural": "garments"},
        **{"said": "garment", "hue": 60},
    },
    "api:predicate-list": {"name": "shines", "kind": "description", "signatures": [["object"]]},
    "api:task-category-list": {"name": "baking"},
    "api:recipe-list": {"text": "dance() -> greet(operator)"},
    "api:primitive-list": {"text": "dance()"},
    "api:worlds": {"name": "attic"},
    "api:import-world": {"name": "attic"},
    "api:split-list": {"name": "mine"},
    "api:campaign-list": {"name": "spring"},
    "api:slice-list": {"name": "wrong ones", "query": "outcome=wrong"},
    "api:error-category-list": {"name": "Slip", "description": "", "slice": None},
    "api:member-list": {"name": "someone in home", "roles": ["annotator"]},
}
# Routes that are posted to and make no name: several rows may say the same, what is made has no name,
# or nothing is made. Actions that are done once have tests of their own beside their verbs.
NAMELESS = {
    *(
        "production-list",
        "task-category-order",
        "entity-class-household",
        "template-list",
        "proposals",
        "examples",
        "proposed-recipes",
        "comments",
        "utterance-list",
        "invitation-list",
        "token-list",
        "dialogue-list",
    ),
    *(
        "run-list",
        "run-learning-curve",
        "paraphrase-runs",
        "run-retrain",
        "run-today",
        "run-analysis",
        "results-measure",
        "run-cancel",
        "audit",
        "work-item-list",
    ),
    *(
        "promotion-list",
        "promotion-decline",
        "promotion-roll-back",
        "split-renew",
        "history",
        "rename",
    ),
    *(
        "import",
        "import-competition",
        "import-pairs",
        "generate",
        "job-answer",
        "job-cancel",
        "site-job-cancel",
    ),
    *("check-recipe", "check-primitive", "task-plan", "joint-plan"),
    *("check-form", "check-predicate", "check-production", "check-template", "suggestions"),
    *("parse", "parse-wrong", "plan", "action-names", "dialogue-answer", "dialogue-keep"),
    *("offered-entity-decide", "answer-doubt", "example-send", "predictions-send"),
    *(
        "audit-finding-decide",
        "audit-decision-take-back",
        "label-take-back",
        "utterance-label",
        "utterance-spans",
    ),
    *("work-item-assign", "work-item-finish", "work-item-give-back", "work-item-next"),
    *("work-item-skip", "work-item-take", "work-item-withdraw", "work-item-assign-many"),
    *("comment-restore", "error-category-move", "account-link", "join", "sessions-end"),
    *("campaign-model", "submission-decide", "submission-mend", "submission-take-back"),
    *("submission-with-form", "submission-with-doubt"),
    *("campaign-close", "campaign-reopen", "campaign-revoke-link", "campaign-renew-link"),
    "campaign-results",
    *(
        "contributor-forget",
        "notice-read",
        "notice-read-all",
        "upload-list",
        "upload-undo",
        "upload-redo",
        "parse-jobs",
    ),
}


def keys_for(person: User, sample: SampleWorld) -> dict[str, RouteKeys]:
    """Return the keys of routes about rows of ``sample``, and about what ``person`` alone has."""
    token, _ = ApiToken.issue(person, "of another program")
    client_of(person)
    LogInSession.objects.filter(user=None).delete()
    handle = sessions_of(person)[0].handle
    comment = comment_in(sample.world)
    comment.author = person
    comment.save()
    paraphrase = paraphrase_in(sample.world)
    paraphrase.grounded_form, paraphrase.logical_form = "", '( go " kitchen " )'
    paraphrase.save()
    return {
        **KEYS,
        "api:token-detail": lambda _: {"pk": token.pk},
        "api:session": lambda _: {"handle": handle},
    }


def small_archive() -> bytes:
    """Return the archive of a world with a grammar alone."""
    world = World.objects.create(name="cellar")
    assert not import_generator(world.name, as_bytes(TINY)).is_refused
    return b"".join(world_archive(world))
