"""The command grammar of a world: its productions, and which files make up a task category."""

from __future__ import annotations

from django.db import models

from annotations.models.worlds import World


class Grammar(models.Model):
    world = models.OneToOneField(World, on_delete=models.CASCADE, related_name="grammar")

    def __str__(self) -> str:
        return f"grammar of {self.world}"


class TaskCategory(models.Model):
    """A difficulty class of commands, with the rule and template sets it is generated from, in order.

    ``rule_sources`` and ``template_sources`` are lists of ``Production.source`` and
    ``SemanticTemplate.source``; where two templates give one command different forms, the later wins.
    """

    grammar = models.ForeignKey(Grammar, on_delete=models.CASCADE, related_name="task_categories")
    name = models.CharField(max_length=60)
    position = models.PositiveIntegerField()
    rule_sources = models.JSONField(default=list)
    template_sources = models.JSONField(default=list)

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["grammar", "name"], name="task_category_name")
        ]
        verbose_name_plural = "task categories"

    def __str__(self) -> str:
        return self.name


class Production(models.Model):
    """One production line: ``$nonterminal = expansion``. ``source`` is its file name."""

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
