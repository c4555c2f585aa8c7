"""The pages of what machines learn. All lie under ``/w/<world>/``."""

from django.urls import path

from parser_service.web.labelling import (
    against_pages,
    audit_pages,
    label_pages,
    model_pages,
    suggestion_pages,
)
from parser_service.web.results import (
    analysis_pages,
    compare_pages,
    default_pages,
    report_pages,
    result_pages,
    sensitivity_pages,
    slice_pages,
    tryout_pages,
)
from parser_service.web.reviews import error_category_pages, prediction_pages, review_pages
from parser_service.web.runs import learning_curve_pages, new_run_pages, run_pages
from parser_service.web.serving import (
    dialogue_pages,
    joint_pages,
    playground_pages,
    promotion_pages,
    robot_pages,
)

urlpatterns = [
    path("dialogue/", dialogue_pages.dialogues, name="dialogues"),
    path("dialogue/<int:pk>/", dialogue_pages.dialogue, name="dialogue"),
    path("dialogue/<int:pk>/keep/", dialogue_pages.dialogue_keep, name="dialogue_keep"),
    path("ontology/offered/", dialogue_pages.offered_entities, name="offered_entities"),
    path(
        "ontology/offered/<int:pk>/decide/",
        dialogue_pages.offered_entity_decide,
        name="offered_entity_decide",
    ),
    path("predicates/robot/", robot_pages.robot, name="robot"),
    path("predicates/robot/<str:name>", robot_pages.plan_schema_file, name="plan_schema"),
    path("label/", label_pages.label_page, name="label"),
    path("label/item/", label_pages.label_item, name="label_item"),
    path("label/send/", label_pages.label_send, name="label_send"),
    path("label/<int:pk>/answer/", label_pages.label_answer, name="label_answer"),
    path("label/<int:pk>/check/", label_pages.label_check, name="label_check"),
    path("label/<int:pk>/mend/", label_pages.label_mend, name="label_mend"),
    path("label/answers/<int:pk>/take-back/", label_pages.label_take_back, name="label_take_back"),
    path(
        "templates/suggestions/", suggestion_pages.template_suggestions, name="template_suggestions"
    ),
    path("audit/", audit_pages.audit, name="audit"),
    path("audit/start/", audit_pages.audit_start, name="audit_start"),
    path("audit/<int:pk>/", audit_pages.audit_item, name="audit_item"),
    path("audit/<int:pk>/decide/", audit_pages.audit_decide, name="audit_decide"),
    path("audit/<int:pk>/check/", audit_pages.audit_check, name="audit_check"),
    path(
        "audit/decisions/<int:pk>/take-back/", audit_pages.audit_take_back, name="audit_take_back"
    ),
    path("runs/", run_pages.runs, name="runs"),
    path("runs/table/", run_pages.runs_table, name="runs_table"),
    path("runs/new/", new_run_pages.run_new, name="run_new"),
    path("runs/<int:pk>/", run_pages.run, name="run"),
    path("runs/<int:pk>/state/", run_pages.run_state, name="run_state"),
    path("runs/<int:pk>/charts/", run_pages.run_charts, name="run_charts"),
    path("runs/<int:pk>/curves/", run_pages.run_curves, name="run_curves"),
    path("runs/<int:pk>/cancel/", run_pages.run_cancel, name="run_cancel"),
    path("runs/<int:pk>/retrain/", new_run_pages.run_retrain, name="run_retrain"),
    path("compare/report.html", report_pages.compare_report, name="compare_report"),
    path("runs/<int:pk>/report.html", report_pages.run_report, name="run_report"),
    path("splits/<int:pk>/runs/", new_run_pages.split_runs, name="split_runs"),
    path("runs/<int:pk>/analysis/", analysis_pages.analysis_state, name="analysis_state"),
    path("runs/<int:pk>/analysis/start/", analysis_pages.analysis_start, name="analysis_start"),
    path("runs/<int:pk>/analysis/cancel/", analysis_pages.analysis_cancel, name="analysis_cancel"),
    path("runs/<int:pk>/predictions/", prediction_pages.predictions, name="predictions"),
    path(
        "runs/<int:pk>/predictions/send/",
        prediction_pages.predictions_send,
        name="predictions_send",
    ),
    path("runs/<int:pk>/defaults/", default_pages.defaults, name="defaults"),
    path("runs/<int:pk>/sensitivity/", sensitivity_pages.sensitivity, name="sensitivity"),
    path("runs/<int:pk>/probes/", analysis_pages.probes, name="probes"),
    path("parse/", playground_pages.playground, name="playground"),
    path("parse/together/", joint_pages.joint_plan, name="joint_plan"),
    path("parse/together/ask/", joint_pages.joint_plan_ask, name="joint_plan_ask"),
    path("parse/ask/", playground_pages.playground_ask, name="playground_ask"),
    path("parse/wrong/", playground_pages.playground_wrong, name="playground_wrong"),
    path("parse/state/", promotion_pages.parser_state, name="parser_state"),
    path("promotion/", promotion_pages.promotions, name="promotions"),
    path("promotion/answering/", promotion_pages.answering, name="answering"),
    path("promotion/promote/", promotion_pages.promotion_promote, name="promotion_promote"),
    path("promotion/roll-back/", promotion_pages.promotion_roll_back, name="promotion_roll_back"),
    path(
        "promotion/<int:pk>/decline/", promotion_pages.promotion_decline, name="promotion_decline"
    ),
    path("try/", tryout_pages.tryout, name="tryout"),
    path("try/ask/", tryout_pages.tryout_ask, name="tryout_ask"),
    path("review/", review_pages.review, name="review"),
    path("review/<int:pk>/tag/", review_pages.review_tag, name="review_tag"),
    path("review/<int:pk>/note/", review_pages.review_note, name="review_note"),
    path("review/<int:pk>/doubt/", review_pages.review_doubt, name="review_doubt"),
    path("error-categories/", error_category_pages.error_categories, name="error_categories"),
    path("error-categories/<int:pk>/", error_category_pages.error_category, name="error_category"),
    path(
        "error-categories/<int:pk>/move/",
        error_category_pages.error_category_move,
        name="error_category_move",
    ),
    path(
        "error-categories/<int:pk>/delete/",
        error_category_pages.error_category_delete,
        name="error_category_delete",
    ),
    path("results/", result_pages.results, name="results"),
    path("results/measure/", result_pages.results_measure, name="results_measure"),
    path("results/table/", result_pages.results_table, name="results_table"),
    path("compare/", compare_pages.compare, name="compare"),
    path("slices/", slice_pages.slices, name="slices"),
    path("slices/<int:pk>/rename/", slice_pages.slice_rename, name="slice_rename"),
    path("slices/<int:pk>/delete/", slice_pages.slice_delete, name="slice_delete"),
    path("results.<slug:as_>", result_pages.results_download, name="results_download"),
    path("results/curves/", learning_curve_pages.learning_curves_page, name="learning_curves"),
    path(
        "results/curves/table/",
        learning_curve_pages.learning_curves_table,
        name="learning_curves_table",
    ),
    path(
        "results/curves/data/",
        learning_curve_pages.learning_curves_data,
        name="learning_curves_data",
    ),
    path(
        "runs/<int:pk>/learning-curve/",
        learning_curve_pages.learning_curve_start,
        name="learning_curve_start",
    ),
    path("campaigns/<int:pk>/model/", model_pages.campaign_model, name="campaign_model"),
    path("paraphrases/figures/runs/", against_pages.paraphrase_runs, name="paraphrase_runs"),
    path(
        "paraphrases/figures/runs/start/",
        against_pages.paraphrase_runs_start,
        name="paraphrase_runs_start",
    ),
]
