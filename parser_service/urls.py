"""The pages of what machines learn. All lie under ``/w/<world>/``."""

from django.urls import path

from parser_service.views.analysis import analysis, defaults, probes, sensitivity, tryout
from parser_service.views.labelling import audit, labelling, suggestions
from parser_service.views.results import compare, reports, results, slices
from parser_service.views.reviewing import predictions, review, review_categories, sending
from parser_service.views.runs import learning_curves, retraining, run_new, runs
from parser_service.views.serving import playground, promotions
from parser_service.views.talking import dialogues, offered, robot

urlpatterns = [
    path("dialogue/", dialogues.dialogues, name="dialogues"),
    path("dialogue/<int:pk>/", dialogues.dialogue, name="dialogue"),
    path("dialogue/<int:pk>/keep/", dialogues.dialogue_keep, name="dialogue_keep"),
    path("ontology/offered/", offered.offered_entities, name="offered_entities"),
    path(
        "ontology/offered/<int:pk>/decide/",
        offered.offered_entity_decide,
        name="offered_entity_decide",
    ),
    path("predicates/robot/", robot.robot, name="robot"),
    path("predicates/robot/<str:name>", robot.plan_schema_file, name="plan_schema"),
    path("label/", labelling.label_page, name="label"),
    path("label/item/", labelling.label_item, name="label_item"),
    path("label/send/", labelling.label_send, name="label_send"),
    path("label/<int:pk>/answer/", labelling.label_answer, name="label_answer"),
    path("label/<int:pk>/check/", labelling.label_check, name="label_check"),
    path("label/<int:pk>/mend/", labelling.label_mend, name="label_mend"),
    path("label/answers/<int:pk>/take-back/", labelling.label_take_back, name="label_take_back"),
    path("templates/suggestions/", suggestions.template_suggestions, name="template_suggestions"),
    path("audit/", audit.audit, name="audit"),
    path("audit/start/", audit.audit_start, name="audit_start"),
    path("audit/<int:pk>/", audit.audit_item, name="audit_item"),
    path("audit/<int:pk>/decide/", audit.audit_decide, name="audit_decide"),
    path("audit/<int:pk>/check/", audit.audit_check, name="audit_check"),
    path("audit/decisions/<int:pk>/take-back/", audit.audit_take_back, name="audit_take_back"),
    path("runs/", runs.runs, name="runs"),
    path("runs/table/", runs.runs_table, name="runs_table"),
    path("runs/new/", run_new.run_new, name="run_new"),
    path("runs/<int:pk>/", runs.run, name="run"),
    path("runs/<int:pk>/state/", runs.run_state, name="run_state"),
    path("runs/<int:pk>/charts/", runs.run_charts, name="run_charts"),
    path("runs/<int:pk>/curves/", runs.run_curves, name="run_curves"),
    path("runs/<int:pk>/cancel/", runs.run_cancel, name="run_cancel"),
    path("runs/<int:pk>/retrain/", retraining.run_retrain, name="run_retrain"),
    path("compare/report.html", reports.compare_report, name="compare_report"),
    path("runs/<int:pk>/report.html", reports.run_report, name="run_report"),
    path("splits/<int:pk>/runs/", retraining.split_runs, name="split_runs"),
    path("runs/<int:pk>/analysis/", analysis.analysis_state, name="analysis_state"),
    path("runs/<int:pk>/analysis/start/", analysis.analysis_start, name="analysis_start"),
    path("runs/<int:pk>/analysis/cancel/", analysis.analysis_cancel, name="analysis_cancel"),
    path("runs/<int:pk>/predictions/", predictions.predictions, name="predictions"),
    path("runs/<int:pk>/predictions/send/", sending.predictions_send, name="predictions_send"),
    path("runs/<int:pk>/defaults/", defaults.defaults, name="defaults"),
    path("runs/<int:pk>/sensitivity/", sensitivity.sensitivity, name="sensitivity"),
    path("runs/<int:pk>/probes/", probes.probes, name="probes"),
    path("parse/", playground.playground, name="playground"),
    path("parse/ask/", playground.playground_ask, name="playground_ask"),
    path("parse/wrong/", playground.playground_wrong, name="playground_wrong"),
    path("parse/state/", promotions.parser_state, name="parser_state"),
    path("promotion/", promotions.promotions, name="promotions"),
    path("promotion/promote/", promotions.promotion_promote, name="promotion_promote"),
    path("promotion/roll-back/", promotions.promotion_roll_back, name="promotion_roll_back"),
    path("promotion/<int:pk>/decline/", promotions.promotion_decline, name="promotion_decline"),
    path("try/", tryout.tryout, name="tryout"),
    path("try/ask/", tryout.tryout_ask, name="tryout_ask"),
    path("review/", review.review, name="review"),
    path("review/<int:pk>/tag/", review.review_tag, name="review_tag"),
    path("review/<int:pk>/note/", review.review_note, name="review_note"),
    path("review/<int:pk>/doubt/", review.review_doubt, name="review_doubt"),
    path("error-categories/", review_categories.error_categories, name="error_categories"),
    path("error-categories/<int:pk>/", review_categories.error_category, name="error_category"),
    path(
        "error-categories/<int:pk>/move/",
        review_categories.error_category_move,
        name="error_category_move",
    ),
    path(
        "error-categories/<int:pk>/delete/",
        review_categories.error_category_delete,
        name="error_category_delete",
    ),
    path("results/", results.results, name="results"),
    path("results/table/", results.results_table, name="results_table"),
    path("compare/", compare.compare, name="compare"),
    path("slices/", slices.slices, name="slices"),
    path("slices/<int:pk>/rename/", slices.slice_rename, name="slice_rename"),
    path("slices/<int:pk>/delete/", slices.slice_delete, name="slice_delete"),
    path("results.csv", results.results_csv, name="results_csv"),
    path("results.tex", results.results_latex, name="results_latex"),
    path("results.json", results.results_json, name="results_json"),
    path("results/curves/", learning_curves.learning_curves_page, name="learning_curves"),
    path(
        "results/curves/table/", learning_curves.learning_curves_table, name="learning_curves_table"
    ),
    path("results/curves/data/", learning_curves.learning_curves_data, name="learning_curves_data"),
    path(
        "runs/<int:pk>/learning-curve/",
        learning_curves.learning_curve_start,
        name="learning_curve_start",
    ),
]
