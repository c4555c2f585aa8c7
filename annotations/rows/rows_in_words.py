"""What pages and reports call the rows of a model."""

from __future__ import annotations

from django.db import models

from annotations.language.texts import plural

# Where the name of the model says less.
IN_WORDS = {
    "answer columns": "tables of answers",
    "example columns": "tables of examples",
    "ontology": "ontologies",
    "run analysis": "error analyses",
    "semantic template": "templates",
    "training run": "runs",
    "work share": "settings of double labelling",
}


def rows_in_words(model: type[models.Model]) -> str:
    """Return what rows of ``model`` are called: ``entities``, and ``earlier versions of entities`` in its history."""
    if of := getattr(model, "instance_type", None):
        return f"earlier versions of {rows_in_words(of)}"
    name = str(model._meta.verbose_name)
    return IN_WORDS.get(name) or plural(name)
