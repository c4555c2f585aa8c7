"""The policy of access: one line for each route and method."""

from __future__ import annotations

from dataclasses import dataclass

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
    # Whoever has the link of an invitation joins
    Rule("join", YES, YES, YES, YES, YES),
    Rule("join", 422, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
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
            "split_changes",
            "runs",
            "runs_table",
            "run",
            "run_state",
            "run_charts",
            "run_curves",
            "run_report",
            "analysis_state",
            "defaults",
            "sensitivity",
            "probes",
            "tryout",
            "predictions",
            "review",
            "error_categories",
            "error_category",
            "results",
            "results_table",
            "results_csv",
            "compare",
            "slices",
            "results_latex",
            "results_json",
            "learning_curves",
            "learning_curves_table",
            "learning_curves_data",
            "history",
            "deleted",
            "queue",
            "queue_item",
            "audit",
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
    # Nobody edits the comment of somebody else; admins may delete it
    Rule("comment", *MEMBERS),
    Rule("comment", LOG_IN, NOWHERE, NO, NO, NO, method="post"),
    Rule("comment_delete", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("comment_restore", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("template_suggestions", *ANNOTATORS, method="post"),
    Rule("template_repair", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("draft", *ANNOTATORS),
    Rule("draft", LOG_IN, NOWHERE, BAD, NO, BAD, method="post"),
    Rule("template_consequences", *ANNOTATORS, method="post"),
    Rule("history", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("generate", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("split_new", *ANNOTATORS),
    Rule("split_renew", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
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
    # Without two runs there is nothing to report, and one goes on to the page that offers some
    Rule("compare_report", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON),
    # Reviewers send errors back to work; everybody with a role corrects a label
    Rule("example_send", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    Rule("predictions_send", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    Rule("paraphrase_label", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("paraphrase_check", *MEMBERS, method="post"),
    # Labels in doubt: everybody with a role decides, reviewers let them be looked for
    Rule("audit_item", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON),
    Rule("audit_check", *MEMBERS, method="post"),
    Rule("audit_decide", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("audit_take_back", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("audit_start", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    # Reviewers save slices
    *(
        Rule(name, LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post")
        for name in ("slices", "slice_rename", "slice_delete")
    ),
    Rule("tryout_ask", *MEMBERS, method="post"),
    Rule("analysis_start", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    Rule("analysis_cancel", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    # Reviewers say why answers are wrong
    *(
        Rule(name, LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post")
        for name in ("review_tag", "review_note", "review_doubt")
    ),
    # What admins decide
    Rule("error_categories", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    Rule("error_category", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    *(
        Rule(name, LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post")
        for name in ("error_category_move", "error_category_delete")
    ),
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
    Rule("run_retrain", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("learning_curve_start", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("split_runs", *ADMINS),
    Rule("people", *ADMINS, method="post"),
    Rule("member", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("invite", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    Rule("invitation_withdraw", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
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
    Rule("api:audit-findings", 401, NOWHERE, YES, YES, YES),
    Rule("api:audit-finding", 401, NOWHERE, YES, YES, YES),
    Rule("api:work-items", 401, NOWHERE, YES, YES, YES),
    Rule("api:work-item", 401, NOWHERE, YES, YES, YES),
    Rule("api:work-item-next", 401, NOWHERE, YES, 204, YES, method="post"),
    Rule("api:work-item-finish", 401, NOWHERE, 409, 409, 409, method="post"),
    Rule("api:work-item-give-back", 401, NOWHERE, 409, 409, 409, method="post"),
]

# Routes of rows that are not read, only changed.
ONLY_POSTED = {
    *("run_cancel", "member", "invitation_withdraw", "template_duplicate", "template_repair"),
    *("queue_ask", "queue_act", "queue_settle", "api:work-item-finish", "api:work-item-give-back"),
    *("label_answer", "label_check", "label_mend", "label_take_back"),
    *("example_send", "predictions_send", "paraphrase_label", "paraphrase_check"),
    *("split_renew", "run_retrain", "learning_curve_start"),
    *("comment_delete", "comment_restore"),
    *("audit_decide", "audit_check", "audit_take_back"),
    *("slice_rename", "slice_delete"),
    *("analysis_start", "analysis_cancel"),
    *("review_tag", "review_note", "review_doubt"),
    *("error_category_move", "error_category_delete"),
}
# Routes of rows that take a POST at the address where they are read.
READ_AND_POSTED = {
    "template",
    "entity",
    "production",
    "history",
    "comments",
    "comment",
    "rename",
    "delete_row",
    "error_category",
}
