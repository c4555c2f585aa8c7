"""The policy of access: one line for each route and method."""

from __future__ import annotations

from tests.gpsr_site.routes.api_policy import API_POLICY
from tests.gpsr_site.routes.rules import (
    BAD,
    GONE_ON,
    LOG_IN,
    NO,
    NOWHERE,
    PEOPLE,
    YES,
    Rule,
)

__all__ = ["LOG_IN", "NO", "NOWHERE", "PEOPLE", "POLICY", "YES", "Rule"]

MEMBERS = (LOG_IN, NOWHERE, YES, YES, YES)
ANNOTATORS = (LOG_IN, NOWHERE, YES, NO, YES)
ADMINS = (LOG_IN, NOWHERE, NO, NO, YES)

POLICY = [
    # Outside of any world
    Rule("favicon", *[GONE_ON] * 5),
    Rule("healthz", YES, YES, YES, YES, YES),
    # The documents hold nothing of anybody
    *(Rule(name, *[YES] * 5) for name in ("documents", "document", "document_image")),
    Rule("login", YES, GONE_ON, GONE_ON, GONE_ON, GONE_ON),
    Rule("login", YES, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("logout", LOG_IN, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("password", LOG_IN, YES, YES, YES, YES),
    Rule("password", LOG_IN, YES, YES, YES, YES, method="post"),
    # Everybody has an account, and tokens and sessions of their own alone
    Rule("account", LOG_IN, YES, YES, YES, YES),
    Rule("token_new", LOG_IN, 422, 422, 422, 422, method="post"),
    Rule("token_revoke", LOG_IN, NOWHERE, NOWHERE, NOWHERE, NOWHERE, method="post"),
    Rule("session_end", LOG_IN, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("sessions_end", LOG_IN, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("accounts", LOG_IN, NO, NO, NO, NO),
    Rule("account_close", LOG_IN, NO, NO, NO, NO, method="post"),
    Rule("account_link", LOG_IN, NO, NO, NO, NO, method="post"),
    Rule("password_set", YES, YES, YES, YES, YES),
    Rule("password_set", YES, YES, YES, YES, YES, method="post"),
    Rule("site_log", LOG_IN, NO, NO, NO, NO),
    # Whoever has the link of an invitation joins
    Rule("join", YES, YES, YES, YES, YES),
    Rule("join", 422, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    # Whoever has the link of a campaign contributes; who has not begun is led to its first page
    Rule("campaign", YES, YES, YES, YES, YES),
    Rule("campaign", 422, 422, 422, 422, 422, method="post"),
    Rule("campaign_place", *[GONE_ON] * 5),
    Rule("campaign_place", *[GONE_ON] * 5, method="post"),
    Rule("campaign_check", YES, YES, YES, YES, YES, method="post"),
    Rule("campaign_done", *[GONE_ON] * 5),
    Rule("campaign_done", *[GONE_ON] * 5, method="post"),
    Rule("home", LOG_IN, YES, YES, YES, YES),
    Rule("my_drafts", LOG_IN, YES, YES, YES, YES),
    Rule("inbox", LOG_IN, YES, YES, YES, YES),
    Rule("inbox", LOG_IN, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("notice_open", LOG_IN, NOWHERE, NOWHERE, NOWHERE, NOWHERE, method="post"),
    Rule("banner", LOG_IN, YES, YES, YES, YES),
    Rule("admin:index", LOG_IN, LOG_IN, LOG_IN, LOG_IN, LOG_IN),
    Rule("world_new", LOG_IN, NO, NO, NO, NO),
    Rule("world_new", LOG_IN, NO, NO, NO, NO, method="post"),
    Rule("world_import", LOG_IN, NO, NO, NO, NO),
    Rule("world_import", LOG_IN, NO, NO, NO, NO, method="post"),
    Rule("world_edit", LOG_IN, NOWHERE, NO, NO, YES),
    Rule("world_edit", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    Rule("world_delete", LOG_IN, NOWHERE, NO, NO, NO),
    Rule("world_delete", LOG_IN, NOWHERE, NO, NO, NO, method="post"),
    Rule("campaign_model", *ADMINS),
    Rule("campaign_model", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    # Who reviews moderates what contributors wrote
    *(Rule(name, LOG_IN, NOWHERE, NO, YES, YES) for name in ("submissions", "submission")),
    Rule("paraphrase_contributors", LOG_IN, NOWHERE, NO, YES, YES),
    Rule("submission_decide", LOG_IN, NOWHERE, NO, 422, 422, method="post"),
    Rule("submissions_decide", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    Rule("submissions_take_back", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
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
            "entity_classes",
            "task_categories",
            "class_colours",
            "recipes",
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
            "paraphrase_figures",
            "paraphrase_forms",
            "paraphrase_runs",
            "paraphrase",
            "utterances",
            "utterance",
            "uploads",
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
            "playground",
            "joint_plan",
            "parser_state",
            "promotions",
            "predictions",
            "review",
            "error_categories",
            "error_category",
            "dialogues",
            "dialogue",
            "offered_entities",
            "robot",
            "plan_schema",
            "results",
            "results_table",
            "results_download",
            "compare",
            "slices",
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
    Rule("joint_plan_ask", *MEMBERS, method="post"),
    # Who may see a world may talk about its commands
    Rule("dialogues", LOG_IN, NOWHERE, 422, 422, 422, method="post"),
    Rule("dialogue", LOG_IN, NOWHERE, 422, 422, 422, method="post"),
    # What annotators write
    Rule("dialogue_keep", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("offered_entity_decide", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("robot", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("template_new", *ANNOTATORS),
    Rule("template_completion", *ANNOTATORS),
    Rule("template_duplicate", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("delete_row", *ANNOTATORS),
    Rule("delete_row", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("template", *ANNOTATORS, method="post"),
    Rule("template_new", *ANNOTATORS, method="post"),
    Rule("template_check", *ANNOTATORS, method="post"),
    Rule("template_preview", *ANNOTATORS, method="post"),
    Rule("by_example", *ANNOTATORS),
    Rule("by_example", LOG_IN, NOWHERE, 422, NO, 422, method="post"),
    Rule("by_example_preview", *ANNOTATORS, method="post"),
    Rule("try_examples", *ANNOTATORS, method="post"),
    Rule("entity", *ANNOTATORS, method="post"),
    Rule("download_part", *MEMBERS),
    Rule("entity_class", *MEMBERS),
    Rule("entity_class", LOG_IN, NOWHERE, 409, NO, 409, method="post"),  # without a version
    Rule("entity_class_new", *ANNOTATORS),
    Rule("classes_of_household", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("entity_class_new", *ANNOTATORS, method="post"),
    Rule("task_category", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("compare_baseline", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("first_steps", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON, method="post"),
    *(Rule(name, *MEMBERS) for name in ("recipe", "primitive", "task_category")),
    *(
        Rule(name, *ANNOTATORS, method="post")
        for name in ("recipe", "primitive", "recipe_preview", "primitive_preview")
    ),
    *(Rule(name, *ANNOTATORS) for name in ("recipe_new", "primitive_new", "task_category_new")),
    *(
        Rule(name, *ANNOTATORS, method="post")
        for name in ("recipe_new", "primitive_new", "task_category_new")
    ),
    *(
        Rule(name, LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post")
        for name in ("recipe_book", "recipes_proposed", "task_categories")
    ),
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
    Rule("location_rooms", *ANNOTATORS),
    Rule("location_rooms", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
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
    Rule("generation", *ANNOTATORS),
    Rule("generation", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("split_new", *ANNOTATORS),
    Rule("split_renew", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("split_new", *ANNOTATORS, method="post"),
    Rule("utterances_new", *ANNOTATORS),
    Rule("utterances_new", LOG_IN, NOWHERE, 422, NO, 422, method="post"),
    *(Rule(name, *ANNOTATORS) for name in ("upload", "upload_undo", "utterances_delete")),
    *(
        Rule(name, LOG_IN, NOWHERE, outcome, NO, outcome, method="post")
        for name, outcome in (
            ("upload", YES),  # it is stored already
            ("upload_undo", GONE_ON),
            ("upload_redo", GONE_ON),
            ("utterances_delete", YES),  # does not say how many
            ("utterances_restore", GONE_ON),
        )
    ),
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
    Rule("results_measure", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    Rule("audit_start", LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post"),
    # Reviewers save slices
    *(
        Rule(name, LOG_IN, NOWHERE, NO, GONE_ON, GONE_ON, method="post")
        for name in ("slices", "slice_rename", "slice_delete")
    ),
    Rule("tryout", LOG_IN, NOWHERE, GONE_ON, GONE_ON, GONE_ON),
    Rule("beside_ask", *MEMBERS, method="post"),
    Rule("playground_ask", *MEMBERS, method="post"),
    Rule("playground_wrong", LOG_IN, NOWHERE, 422, 422, 422, method="post"),
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
    Rule("answering", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("promotion_promote", LOG_IN, NOWHERE, NO, NO, NOWHERE, method="post"),
    Rule("promotion_roll_back", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("promotion_decline", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("queue_assign", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("guidelines", *MEMBERS),
    Rule("guidelines", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("guidelines_preview", *ADMINS, method="post"),
    Rule("queue_settings", *ADMINS),
    Rule("queue_settings", *ADMINS, method="post"),
    Rule("import", *MEMBERS),  # where everybody exports
    *(Rule(name, *ADMINS) for name in ("import_competition", "import_pairs")),
    *(
        Rule(name, LOG_IN, NOWHERE, NO, NO, 422, method="post")
        for name in ("import", "import_competition", "import_pairs")
    ),
    Rule("job_cancel", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("job_answer", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    # Admins let people contribute
    *(Rule(name, *ADMINS) for name in ("campaigns", "campaign_page", "campaign_state")),
    *(Rule(name, *ADMINS) for name in ("campaign_new", "campaign_results")),
    Rule("campaign_results", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    Rule("campaign_new", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    Rule("campaign_edit", *ADMINS),
    Rule("campaign_edit", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    Rule("campaign_act", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("contributor_forget", *ADMINS),
    Rule("contributor_forget", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("run_new", *ADMINS),
    Rule("run_new", *ADMINS, method="post"),
    Rule("run_today", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("run_cancel", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("run_retrain", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("learning_curve_start", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("paraphrase_runs_start", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("split_runs", *ADMINS),
    Rule("people", *MEMBERS),
    Rule("people", *ADMINS, method="post"),
    Rule("member", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("audit_log", *ADMINS),
    Rule("invite", LOG_IN, NOWHERE, NO, NO, 422, method="post"),
    Rule("invitation_withdraw", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    Rule("people_take_back", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    *API_POLICY,
]
