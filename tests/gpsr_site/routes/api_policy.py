"""The policy of access to the API: one line for each route and method.

What is allowed is refused for another reason here, as the requests bring nothing: a body that is no
JSON (415), a change that does not say of which version (428).
"""

from __future__ import annotations

from tests.gpsr_site.routes.rules import NO, NOWHERE, YES, Rule

NO_TOKEN, CLASH, NO_JSON, NO_VERSION, NOTHING = 401, 409, 415, 428, 204
READ = (NO_TOKEN, NOWHERE, YES, YES, YES)

# Lists and rows that members read.
READABLE = (
    *(
        "entity-list",
        "entity-detail",
        "entity-class-list",
        "entity-class-detail",
        "predicate-list",
        "predicate-detail",
        "recipe-list",
        "recipe-detail",
        "primitive-list",
        "primitive-detail",
        "recipe-book",
        "shipped-books",
        "proposed-recipes",
        "task-category-list",
        "task-category-detail",
        "production-list",
    ),
    *(
        "production-detail",
        "template-list",
        "template-detail",
        "command-list",
        "command-detail",
        "form-list",
        "form-detail",
    ),
    *(
        "paraphrase-list",
        "paraphrase-detail",
        "paraphrase-figures",
        "paraphrase-forms",
        "paraphrase-runs",
        "utterance-list",
        "utterance-detail",
        "split-list",
        "split-detail",
    ),
    *(
        "split-examples",
        "split-export",
        "split-manifest",
        "audit-finding-list",
        "audit-finding-detail",
    ),
    *("work-item-list", "work-item-detail", "world"),
    *(
        "run-list",
        "run-detail",
        "run-log",
        "run-curves",
        "run-checkpoints",
        "predictions",
        "candidates",
    ),
    *(
        "results",
        "evaluation-list",
        "evaluation-detail",
        "review-list",
        "review-detail",
        "answer-review",
    ),
    *("slice-list", "slice-detail", "error-category-list", "error-category-detail"),
    *("job-list", "job-detail", "download", "history", "deleted", "comments", "comment-detail"),
    *(
        "member-list",
        "member-detail",
        "label-list",
        "audit",
        "download-part",
        "run-findings",
        "run-probes",
    ),
    *(
        "complexity",
        "generation",
        "uncovered",
        "conflicts",
        "near-duplicates",
        "agreement",
        "progress",
        "guidelines",
    ),
    *("split-changes", "upload-list", "upload-detail", "utterance-export"),
    *("vocabulary", "paraphrase-export", "events"),
)
# Lists that annotators add to, and rows that they change and delete.
ADDED_BY_ANNOTATORS = (
    "entity-list",
    "entity-class-list",
    "predicate-list",
    "recipe-list",
    "primitive-list",
    "task-category-list",
    "production-list",
    "template-list",
    "utterance-list",
    "split-list",
)
CHANGED_BY_ANNOTATORS = (
    "entity-detail",
    "entity-class-detail",
    "predicate-detail",
    "recipe-detail",
    "primitive-detail",
    "task-category-detail",
    "production-detail",
    "template-detail",
)


def annotators(outcome: int) -> tuple[int, ...]:
    return NO_TOKEN, NOWHERE, outcome, NO, outcome


def reviewers(outcome: int) -> tuple[int, ...]:
    return NO_TOKEN, NOWHERE, NO, outcome, outcome


def admins(outcome: int) -> tuple[int, ...]:
    return NO_TOKEN, NOWHERE, NO, NO, outcome


def everybody(outcome: int) -> tuple[int, ...]:
    return NO_TOKEN, *[outcome] * 4


def members(outcome: int) -> tuple[int, ...]:
    return NO_TOKEN, NOWHERE, *[outcome] * 3


API_POLICY = [
    Rule("api:root", YES, YES, YES, YES, YES),
    Rule("api:schema", YES, YES, YES, YES, YES),
    Rule("api:worlds", *everybody(YES)),
    # Everybody has tokens, log-ins and notices of their own alone
    *(Rule(f"api:{name}", *everybody(YES)) for name in ("token-list", "sessions", "notice-list")),
    Rule("api:token-list", *everybody(NO_JSON), method="post"),
    *(Rule(f"api:{name}", *everybody(NOWHERE)) for name in ("token-detail", "session")),
    *(
        Rule(f"api:{each}", *everybody(NOWHERE), method="delete")
        for each in ("token-detail", "session")
    ),
    Rule("api:sessions-end", *everybody(NOTHING), method="post"),
    Rule("api:notice-read-all", *everybody(YES), method="post"),
    Rule("api:notice-read", *everybody(NOWHERE), method="post"),
    Rule("api:join", *everybody(NO_JSON), method="post"),
    # Jobs of worlds that are not there are for who asked for them
    Rule("api:site-job-detail", *everybody(NOWHERE)),
    Rule("api:site-job-cancel", *everybody(NOWHERE), method="post"),
    # Worlds and accounts are made and unmade by administrators of the site, who are none of these
    *(
        Rule(f"api:{name}", *everybody(NO))
        for name in ("account-list", "account-detail", "site-log")
    ),
    Rule("api:account-detail", *everybody(NO), method="patch"),
    *(
        Rule(f"api:{name}", *everybody(NO), method="post")
        for name in ("worlds", "import-world", "account-link")
    ),
    Rule("api:world", *admins(NO_VERSION), method="patch"),
    Rule("api:world", *members(NO), method="delete"),
    # Admins say who is in a world, and see who did what there
    *(
        Rule(f"api:{name}", *admins(YES))
        for name in ("invitation-list", "invitation-detail", "audit-log")
    ),
    # Admins let people contribute, and know them by pseudonyms
    *(
        Rule(f"api:{name}", *admins(YES))
        for name in (
            *("campaign-list", "campaign-detail", "campaign-progress", "contributor-list"),
            *("campaign-tasks", "campaign-triples"),
            "contributor-detail",
        )
    ),
    *(
        Rule(f"api:campaign-{name}", *admins(YES), method="post")
        for name in ("close", "reopen", "revoke-link", "renew-link")
    ),
    Rule("api:campaign-detail", *admins(NO_VERSION), method="patch"),
    Rule("api:contributor-forget", *admins(NOTHING), method="post"),
    *(
        Rule(f"api:{name}", *admins(NO_JSON), method="post")
        for name in ("member-list", "invitation-list", "campaign-list")
    ),
    Rule("api:member-detail", *admins(NO_VERSION), method="patch"),
    *(
        Rule(f"api:{name}", *admins(NO_VERSION), method="delete")
        for name in ("member-detail", "invitation-detail")
    ),
    *(Rule(f"api:{name}", *READ) for name in READABLE),
    *(Rule(f"api:{name}", *annotators(NO_JSON), method="post") for name in ADDED_BY_ANNOTATORS),
    # Every member comments; what somebody said is their own, and admins may take it away.
    Rule("api:comments", NO_TOKEN, NOWHERE, *[NO_JSON] * 3, method="post"),
    Rule("api:comment-detail", NO_TOKEN, NOWHERE, NO, NO, NO, method="patch"),
    Rule("api:comment-detail", NO_TOKEN, NOWHERE, NO, NO, NO_VERSION, method="delete"),
    Rule("api:comment-restore", NO_TOKEN, NOWHERE, YES, YES, YES, method="post"),  # it is there
    Rule("api:generate", *annotators(NO_JSON), method="post"),
    Rule("api:upload-list", *annotators(400), method="post"),  # neither a file nor a text
    Rule("api:upload-undo", *annotators(NO_JSON), method="post"),
    Rule("api:upload-redo", *annotators(CLASH), method="post"),  # it is not undone
    Rule("api:utterance-detail", *annotators(NO_VERSION), method="delete"),
    Rule("api:history", *annotators(NO_JSON), method="post"),
    Rule("api:rename", *annotators(NO_VERSION), method="post"),
    Rule("api:entity-class-household", *annotators(YES), method="post"),
    Rule("api:task-category-order", *annotators(NO_JSON), method="post"),
    *(
        Rule(f"api:{name}", *admins(400), method="post")
        for name in ("import", "import-competition", "import-pairs", "campaign-results")
    ),
    Rule("api:job-cancel", *admins(YES), method="post"),
    Rule("api:job-answer", *admins(NO_JSON), method="post"),
    Rule("api:utterance-candidates", *annotators(YES)),
    # What is only checked
    *(
        Rule(f"api:{name}", *annotators(NO_JSON), method="post")
        for name in (
            *("check-template", "check-production", "check-predicate", "suggestions"),
            *("check-recipe", "check-primitive", "proposals", "examples"),
        )
    ),
    Rule("api:check-form", *members(NO_JSON), method="post"),
    # What annotators answer; the queue itself knows who may do which item
    *(
        Rule(f"api:{name}", *annotators(NO_JSON), method="post")
        for name in ("utterance-label", "utterance-spans")
    ),
    Rule("api:label-take-back", *annotators(CLASH), method="post"),  # it is of nobody
    Rule("api:work-item-take", NO_TOKEN, NOWHERE, YES, CLASH, YES, method="post"),
    Rule("api:work-item-skip", *members(CLASH), method="post"),  # nobody holds it
    Rule("api:job-result", *members(CLASH)),  # it has not ended
    Rule("api:parse-jobs", *members(NO_JSON), method="post"),
    Rule("api:parse-wrong", *members(NO_JSON), method="post"),
    # Everybody with a role decides about labels in doubt, reviewers let them be looked for
    Rule("api:campaign-model", *admins(NO_JSON), method="post"),
    # What contributors wrote, by pseudonym
    Rule("api:paraphrase-contributors", *reviewers(YES)),
    *(Rule(f"api:submission-{name}", *reviewers(YES)) for name in ("list", "detail", "export")),
    *(
        Rule(f"api:submission-{name}", *reviewers(NO_JSON), method="post")
        for name in ("decide", "mend", "with-form", "with-doubt")
    ),
    Rule("api:submission-take-back", *reviewers(CLASH), method="post"),
    Rule("api:audit-finding-decide", *members(NO_JSON), method="post"),
    Rule("api:audit-decision-take-back", *members(CLASH), method="post"),
    *(
        Rule(f"api:{name}", *reviewers(NO_JSON), method="post")
        for name in ("audit", "results-measure", "work-item-list", "example-send")
    ),
    # Admins say who does what
    Rule("api:recipe-book", *annotators(NO_VERSION), method="patch"),
    Rule("api:proposed-recipes", *annotators(NO_JSON), method="post"),
    Rule("api:guidelines", *admins(NO_VERSION), method="patch"),
    Rule("api:queue-settings", *admins(YES)),
    Rule("api:queue-settings", *admins(NO_VERSION), method="patch"),
    *(
        Rule(f"api:{name}", *admins(NO_JSON), method="post")
        for name in ("work-item-assign-many", "work-item-assign")
    ),
    Rule("api:work-item-withdraw", *admins(YES), method="post"),
    # What reviewers say, what admins decide
    *(
        Rule(f"api:{name}", *reviewers(NO_JSON), method="post")
        for name in ("slice-list", "answer-doubt", "predictions-send")
    ),
    Rule("api:answer-review", *reviewers(NO_VERSION), method="patch"),
    *(
        Rule("api:slice-detail", *reviewers(NO_VERSION), method=method)
        for method in ("patch", "delete")
    ),
    *(
        Rule(f"api:{name}", *admins(NO_JSON), method="post")
        for name in ("run-list", "error-category-list", "error-category-move")
    ),
    *(
        Rule("api:error-category-detail", *admins(NO_VERSION), method=method)
        for method in ("patch", "delete")
    ),
    Rule("api:run-learning-curve", *admins(NO_JSON), method="post"),
    Rule("api:paraphrase-runs", *admins(NO_JSON), method="post"),
    Rule("api:run-analysis", *reviewers(202), method="post"),
    Rule("api:run-cancel", *admins(CLASH), method="post"),  # it has ended
    Rule("api:run-today", *admins(201), method="post"),
    Rule("api:run-retrain", *admins(400), method="post"),  # there is no newer split
    *(
        Rule(f"api:{name}", *annotators(NO_VERSION), method=method)
        for name in CHANGED_BY_ANNOTATORS
        for method in ("patch", "delete")
    ),
    # Who corrects a label is the business of the work queue.
    Rule("api:paraphrase-detail", NO_TOKEN, NOWHERE, *[NO_VERSION] * 3, method="patch"),
    Rule("api:paraphrase-detail", *annotators(NO_VERSION), method="delete"),
    Rule("api:split-renew", *annotators(400), method="post"),  # nothing has changed since
    Rule("api:work-item-next", NO_TOKEN, NOWHERE, YES, NOTHING, YES, method="post"),
    Rule("api:work-item-finish", NO_TOKEN, NOWHERE, *[CLASH] * 3, method="post"),
    Rule("api:work-item-give-back", NO_TOKEN, NOWHERE, *[CLASH] * 3, method="post"),
    Rule("api:parse", NO_TOKEN, NOWHERE, *[NO_JSON] * 3, method="post"),
    Rule("api:answerer", *READ),
    Rule("api:answerer", *admins(NO_VERSION), method="patch"),
    Rule("api:promotion-list", *READ),
    Rule("api:promotion-list", *admins(NO_JSON), method="post"),
    Rule("api:promotion-roll-back", *admins(NO_JSON), method="post"),
    Rule("api:promotion-decline", *admins(YES), method="post"),
    # Who may see a world may talk about its commands; only annotators label what comes of it.
    Rule("api:dialogue-list", *READ),
    Rule("api:dialogue-detail", *READ),
    Rule("api:dialogue-list", NO_TOKEN, NOWHERE, *[NO_JSON] * 3, method="post"),
    Rule("api:dialogue-answer", NO_TOKEN, NOWHERE, *[NO_JSON] * 3, method="post"),
    *(
        Rule(f"api:{name}", *members(NO_JSON), method="post")
        for name in ("plan", "task-plan", "joint-plan")
    ),
    Rule("api:action-names", *READ),
    Rule("api:action-names", *annotators(NO_JSON), method="post"),
    Rule("api:offered-entity-list", *READ),
    Rule("api:offered-entity-decide", *annotators(NO_JSON), method="post"),
    Rule("api:dialogue-keep", NO_TOKEN, NOWHERE, CLASH, NO, CLASH, method="post"),
]
