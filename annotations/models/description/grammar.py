"""The command grammar of a world: its productions, and which files make up a task category."""

from __future__ import annotations

from django.db import models

from annotations.models.editing import Editable
from annotations.models.worlds import World


class Grammar(models.Model):
    world = models.OneToOneField(World, on_delete=models.CASCADE, related_name="grammar")

    def __str__(self) -> str:
        return f"grammar of {self.world}"


class TaskCategory(models.Model):
    """A difficulty class of commands, with the rule and template sets it is generated from, in order.

    ``rule_sources`` and ``template_sources`` are lists of ``Production.source`` and
    ``SemanticTemplate.source``; where two templates give one command different forms, the later wins.

    ``commands_in_grammar`` counts the distinct commands of its grammar and ``commands_with_form``
    those among them that have a logical form, as of the last import or generation. Both are None
    where nothing was counted, or the grammar is too large to count (``annotations.generation.coverage``).
    """

    grammar = models.ForeignKey(Grammar, on_delete=models.CASCADE, related_name="task_categories")
    name = models.CharField(max_length=60)
    position = models.PositiveIntegerField()
    rule_sources = models.JSONField(default=list)
    template_sources = models.JSONField(default=list)
    commands_in_grammar = models.PositiveIntegerField(null=True, editable=False)
    commands_with_form = models.PositiveIntegerField(null=True, editable=False)

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["grammar", "name"], name="task_category_name")
        ]
        verbose_name_plural = "task categories"

    def __str__(self) -> str:
        return self.name

    @property
    def is_counted(self) -> bool:
        """Whether the commands of its grammar have been counted."""
        return self.commands_in_grammar is not None and self.commands_with_form is not None

    @property
    def commands_without_form(self) -> int:
        """How many commands of the grammar no template gives a form; 0 where nothing was counted."""
        return (self.commands_in_grammar or 0) - (self.commands_with_form or 0)

    @property
    def covered_percent(self) -> float | None:
        """The share of the grammar's commands that have a form, in percent; None if unknown."""
        if not self.is_counted or not self.commands_in_grammar:
            return None
        return 100 * self.commands_with_form / self.commands_in_grammar


class Production(Editable):
    """One production line: ``$nonterminal = expansion``. ``source`` is its file name."""

    world_path = "grammar__world"
    edited_fields = ("source", "task_category", "nonterminal", "expansion")
    bears_on_commands = True

    grammar = models.ForeignKey(Grammar, on_delete=models.CASCADE, related_name="productions")
    source = models.CharField(max_length=200)
    line = models.PositiveIntegerField(default=0)
    nonterminal = models.CharField(max_length=120)
    expansion = models.TextField()
    task_category = models.CharField(max_length=60, blank=True)
    position = models.PositiveIntegerField()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["grammar", "position"], name="production_position")
        ]
        indexes = [models.Index(fields=["grammar", "nonterminal"])]

    def __str__(self) -> str:
        return f"${self.nonterminal} = {self.expansion}"
