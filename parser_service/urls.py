"""The pages of what machines learn. All lie under ``/w/<world>/``."""

from django.urls import path

from parser_service.views import (
    audit,
    labelling,
    predictions,
    results,
    run_new,
    runs,
    suggestions,
)

urlpatterns = [
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
    path("runs/<int:pk>/predictions/", predictions.predictions, name="predictions"),
    path("runs/<int:pk>/predictions/<int:example>/", predictions.prediction, name="prediction"),
    path("results/", results.results, name="results"),
    path("results/table/", results.results_table, name="results_table"),
    path("results.csv", results.results_csv, name="results_csv"),
]
