"""Everything that an import or a generation may write, as values to compare."""

from __future__ import annotations

from django.apps import apps

from annotations.models import World


def rows_of(world: World) -> dict[str, list[dict]]:
    """Model name → all rows of ``world`` with their ids."""
    grammar, ontology = world.grammar, world.ontology
    chosen = {
        "Entity": ontology.entities,
        "TaskCategory": grammar.task_categories,
        "Production": grammar.productions,
        "SemanticTemplate": grammar.templates,
        "Predicate": world.predicates,
        "StoredProblem": world.problems,
        "LogicalForm": world.logical_forms,
        "Command": world.commands,
    }
    return {name: list(rows.order_by("pk").values()) for name, rows in chosen.items()}


def contents_of(world: World) -> dict[str, list[dict]]:
    """The same in order of position, without what says where a row came from or which it is.

    Problems name lines of the files, so they go too.
    """
    without = {"id", "line", "problems", "world_id", "grammar_id", "ontology_id", "template_id"}
    rows = rows_of(world)
    del rows["StoredProblem"]
    return {
        name: [
            {key: value for key, value in row.items() if key not in without}
            for row in sorted(values, key=lambda row: (row.get("position", 0), row.get("name", "")))
        ]
        for name, values in rows.items()
    }


def counts() -> dict[str, int]:
    """The number of rows of every model of this project."""
    return {
        model.__name__: model.objects.count()
        for model in apps.get_app_config("annotations").get_models()
    }
