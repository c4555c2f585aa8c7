"""Which route of the API does what a page does, or shows what it shows: one line for each page.

A line names method and route, several where the page does several things, or gives the reason why
there is none.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class NoRoute:
    """Why a page does something that no route does."""

    reason: str


BROWSER = NoRoute("It begins or ends a log-in of a browser; programs have tokens.")
PASSWORD = NoRoute(
    "A password is typed by a person and is not sent by programs; it ends their tokens."
)
UNSAVED = NoRoute("It keeps what somebody has typed and not saved, for the next look at the page.")
PEOPLE_ALONE = NoRoute(
    "It is for people without an account; what a program writes comes by a file."
)
NOUNS = (
    *("template", "entity", "entity_class", "predicate", "production", "recipe", "primitive"),
    "task_category",
)

PAGE_ACTIONS: dict[str, str | NoRoute] = {
    # One's account
    **dict.fromkeys(("login", "logout"), BROWSER),
    **dict.fromkeys(("password", "password_set"), PASSWORD),
    "token_new": "post token-list",
    "token_revoke": "delete token-detail",
    "session_end": "delete session",
    "sessions_end": "post sessions-end",
    "join": "post join",
    "inbox": "post notice-read-all",
    "notice_open": "post notice-read",
    # What contributors write
    **dict.fromkeys(("campaign", "campaign_place", "campaign_done"), PEOPLE_ALONE),
    "campaign_check": PEOPLE_ALONE,
    "submission_decide": "post submission-decide, post submission-mend, post submission-with-form, "
    "post submission-with-doubt",
    "submissions_decide": "post submission-decide",
    "campaign_model": "post campaign-model",
    "submissions_take_back": "post submission-take-back",
    "campaign_results": "post campaign-results",
    "campaign_new": "post campaign-list",
    "campaign_edit": "patch campaign-detail",
    "campaign_act": "post campaign-close, post campaign-reopen, post campaign-revoke-link, post campaign-renew-link",
    "contributor_forget": "post contributor-forget",
    # The site
    "account_close": "patch account-detail",
    "account_link": "post account-link",
    "world_new": "post worlds",
    "world_import": "post import-world",
    "world_edit": "patch world",
    "world_delete": "delete world",
    # Who is in a world
    "people": "post member-list",
    "member": "patch member-detail, delete member-detail",
    "invite": "post invitation-list",
    "invitation_withdraw": "delete invitation-detail",
    "people_take_back": NoRoute(
        "It is the button in a message; a program says what it wants instead."
    ),
    "compare_baseline": NoRoute("It pins a run for one reader; a program names the runs."),
    "first_steps": NoRoute("It closes a list on a page, for one reader."),
    # Files, jobs, commands
    "import": "post import",
    "import_competition": "post import-competition",
    "import_pairs": "post import-pairs",
    "generate": "post generate",
    "generation": "post generate",
    "job_cancel": "post job-cancel, post site-job-cancel",
    "job_answer": "post job-answer",
    # What annotators write, and what is said of it before it is stored
    **{noun: f"patch {noun.replace('_', '-')}-detail" for noun in NOUNS},
    **{f"{noun}_new": f"post {noun.replace('_', '-')}-list" for noun in NOUNS},
    "classes_of_household": "post entity-class-household",
    "task_categories": "post task-category-order",
    "entities_new": "post entity-list",
    "by_example": "post examples",
    "by_example_preview": "post proposals",
    "try_examples": NoRoute(
        "A program stores examples into a world of its own, asks parse/, and deletes that world."
    ),
    "location_rooms": "patch entity-detail",
    "recipe_preview": "post check-recipe",
    "primitive_preview": "post check-primitive",
    "recipe_book": "patch recipe-book",
    "recipes_proposed": "post proposed-recipes",
    "predicate_preview": "post check-predicate",
    "production_check": "post check-production",
    "production_preview": "post check-production",
    "template_duplicate": "post template-list",
    "template_repair": "patch template-detail, delete template-detail",
    "template_check": "post check-template",
    "template_preview": "post check-template",
    "template_consequences": "post check-template",
    "template_suggestions": "post suggestions",
    "delete_row": "delete entity-detail, delete predicate-detail, delete production-detail, "
    "delete entity-class-detail, delete recipe-detail, delete primitive-detail, "
    "delete task-category-detail, "
    "delete template-detail, delete paraphrase-detail, delete utterance-detail",
    "history": "post history",
    "rename": "post rename",
    "comments": "post comments",
    "comment": "patch comment-detail",
    "comment_delete": "delete comment-detail",
    "comment_restore": "post comment-restore",
    "draft": UNSAVED,
    # Utterances and labels
    "utterances_new": "post upload-list, post utterance-list",
    "upload": "post upload-list",
    "upload_undo": "post upload-undo",
    "upload_redo": "post upload-redo",
    "utterances_delete": "delete utterance-detail",
    "utterances_restore": "post history",
    "label_answer": "post utterance-label",
    "label_send": "post utterance-list",
    "label_mend": "post utterance-spans",
    "label_take_back": "post label-take-back",
    "label_check": "post check-form",
    "paraphrase_label": "patch paraphrase-detail",
    "paraphrase_check": "post check-form",
    "audit_start": "post audit",
    "results_measure": "post results-measure",
    "audit_decide": "post audit-finding-decide",
    "audit_take_back": "post audit-decision-take-back",
    "audit_check": "post check-form",
    # The work queue
    "queue_next": "post work-item-next",
    "queue_act": (
        "post work-item-take, post work-item-give-back, post work-item-skip, post work-item-finish, "
        "post work-item-assign, post work-item-withdraw"
    ),
    "queue_settle": "post work-item-finish",
    "queue_ask": "post work-item-list",
    "queue_assign": "post work-item-assign-many",
    "queue_settings": "patch queue-settings",
    "guidelines": "patch guidelines",
    "guidelines_preview": UNSAVED,
    "example_send": "post example-send",
    "predictions_send": "post predictions-send",
    # Splits, runs, and what comes of them
    "split_new": "post split-list",
    "split_renew": "post split-renew",
    "run_new": "post run-list",
    "run_today": "post run-today",
    "run_cancel": "post run-cancel",
    "run_retrain": "post run-retrain",
    "learning_curve_start": "post run-learning-curve",
    "paraphrase_runs_start": "post paraphrase-runs",
    "analysis_start": "post run-analysis",
    "analysis_cancel": "post job-cancel",
    "slices": "post slice-list",
    "slice_rename": "patch slice-detail",
    "slice_delete": "delete slice-detail",
    "review_tag": "patch answer-review",
    "review_note": "patch answer-review",
    "review_doubt": "post answer-doubt",
    "error_categories": "post error-category-list",
    "error_category": "patch error-category-detail",
    "error_category_move": "post error-category-move",
    "error_category_delete": "delete error-category-detail",
    "beside_ask": "post parse",
    # Parsing
    "playground_ask": "post parse",
    "joint_plan_ask": "post joint-plan",
    "playground_wrong": "post parse-wrong",
    "answering": "patch answerer",
    "promotion_promote": "post promotion-list",
    "promotion_roll_back": "post promotion-roll-back",
    "promotion_decline": "post promotion-decline",
    "dialogues": "post dialogue-list",
    "dialogue": "post dialogue-answer",
    "dialogue_keep": "post dialogue-keep",
    "offered_entity_decide": "post offered-entity-decide",
    "robot": "post action-names",
}


CHOICES = NoRoute("A form with its choices; the schema says what its route takes.")
HERE = NoRoute("It says how this server is, for whoever looks after it.")
PRINTED = NoRoute("One file to read or print of what runs, results and predictions hold.")
DOCUMENTS = NoRoute("It is a text for people, and a file of the code.")
IN_EDITOR = NoRoute("It completes what somebody types, of predicates, entities and productions.")

# Pages that are looked at and not posted to.
PAGE_VIEWS: dict[str, str | NoRoute] = {
    **dict.fromkeys(("favicon", "healthz", "banner", "admin:index"), HERE),
    **dict.fromkeys(("documents", "document", "document_image"), DOCUMENTS),
    "home": "get worlds",
    "my_drafts": UNSAVED,
    "account": "get token-list, get sessions",
    "accounts": "get account-list",
    "site_log": "get site-log",
    "audit_log": "get audit-log",
    "world": "get world",
    **dict.fromkeys(("search", "search_found"), NoRoute("Each list takes q.")),
    "download": "get download",
    "download_part": "get download-part",
    "jobs": "get job-list",
    **dict.fromkeys(("job", "job_state"), "get job-detail, get site-job-detail"),
    "ontology": "get entity-list",
    "entity_classes": "get entity-class-list",
    "class_colours": NoRoute("The route of classes gives their hues."),
    "recipes": "get recipe-list, get primitive-list, get recipe-book, get shipped-books, "
    "get proposed-recipes",
    "predicates": "get predicate-list",
    "grammar": "get production-list",
    "coverage": "get task-category-list",
    "uncovered": "get uncovered",
    **dict.fromkeys(("unmatched", "outside_grammar"), "get template-list"),
    "conflicts": "get conflicts",
    "templates": "get template-list",
    "template_completion": IN_EDITOR,
    "deleted": "get deleted",
    "commands": "get command-list",
    "command": "get command-detail",
    "complexity": "get complexity",
    "logical_forms": "get form-list",
    "logical_form": "get form-detail",
    "paraphrases": "get paraphrase-list",
    "paraphrase_figures": "get paraphrase-figures",
    "paraphrase_forms": "get paraphrase-forms",
    "paraphrase_contributors": "get paraphrase-contributors",
    "paraphrase_runs": "get paraphrase-runs",
    "paraphrase": "get paraphrase-detail",
    "submissions": "get submission-list",
    "submission": "get submission-detail",
    "campaigns": "get campaign-list",
    "campaign_page": "get campaign-detail, get contributor-list, get submission-list",
    "campaign_state": "get campaign-progress",
    "utterances": "get utterance-list",
    "utterance": "get utterance-detail",
    "uploads": "get upload-list",
    "splits": "get split-list",
    "split": "get split-detail",
    "example": "get split-examples",
    "near_duplicates": "get near-duplicates",
    "split_changes": "get split-changes",
    "split_runs": CHOICES,
    "queue": "get work-item-list",
    "queue_item": "get work-item-detail",
    "agreement": "get agreement",
    "progress": "get progress",
    **dict.fromkeys(("label", "label_item"), "get utterance-candidates, get label-list"),
    "audit": "get audit, get audit-finding-list",
    "audit_item": "get audit-finding-detail",
    **dict.fromkeys(("runs", "runs_table"), "get run-list"),
    **dict.fromkeys(("run", "run_state"), "get run-detail, get run-log, get run-checkpoints"),
    **dict.fromkeys(("run_charts", "run_curves"), "get run-curves"),
    **dict.fromkeys(("run_report", "compare_report"), PRINTED),
    **dict.fromkeys(("analysis_state", "defaults", "sensitivity"), "get run-findings"),
    "probes": "get run-probes",
    "predictions": "get predictions, get candidates",
    "review": "get predictions, get answer-review",
    **dict.fromkeys(("playground", "joint_plan"), CHOICES),
    "tryout": NoRoute("An old address, which leads to Parse."),
    **dict.fromkeys(("promotions", "parser_state"), "get promotion-list"),
    "offered_entities": "get offered-entity-list",
    "plan_schema": NoRoute("The page is the file itself, for programs."),
    **dict.fromkeys(("results", "results_table", "results_download"), "get results"),
    "compare": "get evaluation-list, get predictions",
    **dict.fromkeys(
        ("learning_curves", "learning_curves_table", "learning_curves_data"),
        "get evaluation-list, get run-list",
    ),
}


def routes_of(line: str) -> list[tuple[str, str]]:
    """Return route and method for each part of a line of the table."""
    parts = (part.split() for part in line.split(", "))
    return [(f"api:{name}", method) for method, name in parts]
