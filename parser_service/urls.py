"""The pages of what machines learn. All lie under ``/w/<world>/``."""

from django.urls import path

from parser_service.views import predictions, results, runs

urlpatterns = [
    path("runs/", runs.runs, name="runs"),
    path("runs/table/", runs.runs_table, name="runs_table"),
    path("runs/new/", runs.run_new, name="run_new"),
    path("runs/<int:pk>/", runs.run, name="run"),
    path("runs/<int:pk>/state/", runs.run_state, name="run_state"),
    path("runs/<int:pk>/curves/", runs.run_curves, name="run_curves"),
    path("runs/<int:pk>/cancel/", runs.run_cancel, name="run_cancel"),
    path("runs/<int:pk>/predictions/", predictions.predictions, name="predictions"),
    path("runs/<int:pk>/predictions/<int:example>/", predictions.prediction, name="prediction"),
    path("results/", results.results, name="results"),
    path("results/table/", results.results_table, name="results_table"),
    path("results.csv", results.results_csv, name="results_csv"),
]
