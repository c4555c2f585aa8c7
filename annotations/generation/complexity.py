"""How complex the commands of a world are: a table by task category, computed by the database."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from django.db.models import Count, Sum

from annotations.models import Command, LogicalForm, SemanticTemplate, TaskCategory, World
from annotations.rows.kept import kept


@dataclass(frozen=True, slots=True)
class Complexity:
    """One column of the table. Lengths are in tokens; a form counts in its first task category.

    ``task_category`` is empty for all of them together; templates count in the category that they were
    written for. Sums rather than means are kept, so that columns add up.
    """

    task_category: str
    templates: int = 0
    commands: int = 0
    forms: int = 0
    command_tokens: int = 0
    form_tokens: int = 0

    @property
    def mean_command_length(self) -> float | None:
        return self.command_tokens / self.commands if self.commands else None

    @property
    def mean_form_length(self) -> float | None:
        """Over the distinct forms."""
        return self.form_tokens / self.forms if self.forms else None

    @property
    def commands_per_form(self) -> float | None:
        return self.commands / self.forms if self.forms else None


def complexity(world: World) -> list[Complexity]:
    """Return a column for each task category, in its order, and one for all. Three grouped queries."""
    commands = _sums(Command.objects.filter(world=world))
    forms = _sums(LogicalForm.objects.filter(world=world))
    rows = SemanticTemplate.objects.filter(grammar__world=world).order_by()
    templates = dict(rows.values_list("task_category").annotate(Count("id")))
    ordered = TaskCategory.objects.filter(grammar__world=world).values_list("name", flat=True)
    names = dict.fromkeys([*ordered, *commands, *forms])
    columns = [
        Complexity(
            name,
            templates.get(name, 0),
            *(sums.get(name, (0, 0))[0] for sums in (commands, forms)),
            *(sums.get(name, (0, 0))[1] for sums in (commands, forms)),
        )
        for name in names
    ]
    sums = {key: sum(asdict(column)[key] for column in columns) for key in SUMMED}
    return [*columns, Complexity("", **sums)]


def kept_complexity(world: World) -> list[Complexity]:
    """Return the same; of very many commands, as it was a while ago."""
    key = "complexity", world.pk, world.revision, world.generations
    return kept(key, lambda: complexity(world), lambda columns: columns[-1].commands)


def _sums(rows: Any) -> dict[str, tuple[int, int]]:
    """Return task category → number of rows and of their tokens."""
    grouped = rows.order_by().values("task_category").annotate(n=Count("id"), tokens=Sum("length"))
    return {group["task_category"]: (group["n"], group["tokens"]) for group in grouped}


SUMMED = ("templates", "commands", "forms", "command_tokens", "form_tokens")
