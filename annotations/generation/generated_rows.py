"""Writes generated commands: compared with those that are there first, then written in one short transaction."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from typing import Any, Self

from django.db.models import OuterRef, QuerySet, Subquery

from annotations import models
from annotations.background.progress import Progress
from annotations.language.templates import Expansion
from annotations.rows.staging import Staging
from annotations.rows.synchronise import Changes, batches

COLUMNS = ("anonymized_text", "template_id", "length", "task_category", "is_in_grammar", "position")
# Template, form, length, task category, whether the grammar has it, position.
Values = tuple[int | None, str, int, str, bool, int]
STORED = (
    *("pk", "anonymized_text", "template_id", "logical_form__text", "length", "task_category"),
    *("is_in_grammar", "position"),
)


class CommandRows:
    """What has to be done so that the commands of a world are the generated ones.

    Making one reads and collects; only ``apply``, inside a transaction, writes. ``new_forms`` counts the
    commands that are there already and get another form.
    """

    def __init__(
        self,
        world: models.World,
        expansions: Sequence[Expansion],
        templates: Mapping[str, Sequence[models.SemanticTemplate]],
        progress: Progress,
    ) -> None:
        self._world = world
        self._wanted = {
            each.command: (
                templates[each.task_category][each.template_index].pk,
                each.form_text,
                len(each.command.split()),
                each.task_category,
                each.in_grammar,
                position,
            )
            for position, each in enumerate(expansions)
        }
        self._progress = progress
        self._stack = ExitStack()
        self._counts = {"added": 0, "changed": 0, "moved": 0}
        self.new_forms = 0
        self._removed: list[int] = []

    def __enter__(self) -> Self:
        self._staging = self._stack.enter_context(Staging(models.Command, COLUMNS, ["form_text"]))
        stored: dict[str, tuple[int, Values]] = {}
        for pk, text, *values in self._world.commands.values_list(*STORED).iterator():
            stored[text] = pk, tuple(values)
        self._removed = [pk for text, (pk, _) in stored.items() if text not in self._wanted]
        self._staging.add(self._differing(stored), self._progress)
        return self

    def __exit__(self, *raised: Any) -> None:
        self._stack.__exit__(*raised)

    def _differing(self, stored: Mapping[str, tuple[int, Values]]) -> Iterator[tuple[Any, ...]]:
        for text, wanted in self._wanted.items():
            pk, values = stored.get(text, (None, None))
            if values == wanted:
                continue
            if values is None:
                self._counts["added"] += 1
            else:
                self._counts["moved" if values[:-1] == wanted[:-1] else "changed"] += 1
                self.new_forms += values[1] != wanted[1]
            template, form, *others = wanted
            yield pk, text, template, *others, form

    def apply(self) -> Changes:
        """Write the differences; the forms must be there by now."""
        for keys in batches(self._removed):
            gone = models.Command.objects.filter(pk__in=keys)
            _keep_texts(gone)
            gone.delete()
        form = (
            "(SELECT f.id FROM annotations_logicalform f "
            f"WHERE f.world_id = {int(self._world.pk)} AND f.text = s.form_text)"
        )
        self._staging.update(logical_form_id=form)
        self._staging.insert(logical_form_id=form, world_id=str(int(self._world.pk)))
        if self._counts["added"]:
            _find_again(self._world)
        return Changes(removed=len(self._removed), **self._counts)


def _keep_texts(commands: QuerySet[models.Command]) -> None:
    """Note in the paraphrases of ``commands``, which are about to go, what these were."""
    text = commands.filter(pk=OuterRef("command")).values("anonymized_text")
    models.Paraphrase.objects.filter(command__in=commands).update(command_text=Subquery(text))


def _find_again(world: models.World) -> None:
    """Give paraphrases their commands back that are made again."""
    lost = world.paraphrases.filter(command=None).exclude(command_text="").order_by()
    for texts in batches(lost.values_list("command_text", flat=True).distinct()):
        commands = world.commands.filter(anonymized_text__in=texts)
        for command in commands.values("pk", "anonymized_text"):
            same = lost.filter(command_text=command["anonymized_text"])
            same.update(command=command["pk"], command_text="")
