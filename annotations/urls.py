"""The pages of what people write. All lie under ``/w/<world>/``."""

from django.urls import path

from annotations.views import (
    commands,
    forms,
    grammar,
    importing,
    ontology,
    paraphrases,
    splits,
    templates,
)

urlpatterns = [
    path("import/", importing.import_files, name="import"),
    path("import/pairs/", importing.import_pair_files, name="import_pairs"),
    path("generate/", importing.generate, name="generate"),
    path("ontology/", ontology.ontology, name="ontology"),
    path("predicates/", ontology.predicates, name="predicates"),
    path("grammar/", grammar.grammar, name="grammar"),
    path("grammar/coverage/", grammar.coverage, name="coverage"),
    path("templates/", templates.templates, name="templates"),
    path("templates/new/", templates.template_new, name="template_new"),
    path("templates/check/", templates.template_check, name="template_check"),
    path("templates/preview/", templates.template_preview, name="template_preview"),
    path("templates/<int:pk>/", templates.template, name="template"),
    path("commands/", commands.commands, name="commands"),
    path("commands/complexity/", commands.complexity, name="complexity"),
    path("forms/", forms.forms, name="forms"),
    path("forms/<int:pk>/", forms.form, name="form"),
    path("paraphrases/", paraphrases.paraphrases, name="paraphrases"),
    path("splits/", splits.splits, name="splits"),
    path("splits/new/", splits.split_new, name="split_new"),
    path("splits/<int:pk>/", splits.split, name="split"),
    path("splits/<int:pk>/near/", splits.near_duplicates, name="near_duplicates"),
]
