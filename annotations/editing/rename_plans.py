"""Which rows name something, such as a nonterminal, and what they say once it has another name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, Protocol

from django.db.models import Q

from annotations.editing.entity_rename import EntityRename, RenamedRows, differing
from annotations.language.corpus import (
    rename_nonterminal_in_form,
    rename_nonterminal_in_pattern,
    rename_predicate,
    require_nonterminal,
    require_predicate,
)
from annotations.language.grammar import ROOT
from annotations.language.plans import Primitive as PrimitiveValue
from annotations.language.plans import read_primitive
from annotations.language.texts import LanguageError
from annotations.models import (
    AuditDecision,
    AuditFinding,
    AuditReason,
    CampaignPrompt,
    Command,
    Editable,
    Entity,
    Label,
    LogicalForm,
    Paraphrase,
    Predicate,
    Primitive,
    Production,
    SemanticTemplate,
    TaskCategory,
    Utterance,
)
from annotations.rows.composition import (
    RULES,
    TEMPLATES,
    require_set_name,
    rule_files,
    split_entry,
)
from annotations.rows.from_rows import primitive_of, recipe_of


class RenamePlan(Protocol):
    """What to do so that a row that was called ``old`` has another name."""

    def require_free(self, new: str) -> None:
        """Raise LanguageError where ``new`` is taken or means something else."""

    def changes(self, new: str) -> Iterator[tuple[str, RenamedRows]]:
        """Yield each kind of row with the rows that change and their new values."""


class NonterminalRename:
    """Renames the nonterminal of a production, in all lines and templates of the world."""

    def __init__(self, row: Production, old: str) -> None:
        self.old = row.nonterminal
        self.grammar = row.grammar

    def require_free(self, new: str) -> None:
        if self.old == ROOT:
            raise LanguageError(f"${ROOT} cannot be renamed: commands begin there")
        require_nonterminal(new)
        same = Q(nonterminal=new) | Q(expansion__contains=f"${new}")
        lines = self.grammar.productions.filter(same)
        is_taken = any(
            line.nonterminal == new
            or rename_nonterminal_in_pattern(line.expansion, new, "") != line.expansion
            for line in lines
        )
        templates = self.grammar.templates.filter(
            Q(pattern__contains=f"${new}") | Q(form__contains=f"${new}")
        )
        is_taken = is_taken or any(
            rename_nonterminal_in_pattern(row.pattern, new, "") != row.pattern
            or rename_nonterminal_in_form(row.form, new, "") != row.form
            for row in templates
        )
        if is_taken or any(
            new == split_entry(entry)[1]
            for category in self.grammar.task_categories.all()
            for entry in category.rule_sources
        ):
            raise LanguageError(f"there is a ${new} already", hint="choose another name")

    def changes(self, new: str) -> Iterator[tuple[str, RenamedRows]]:
        old, token = self.old, f"${self.old}"
        lines = self.grammar.productions.filter(Q(nonterminal=old) | Q(expansion__contains=token))
        renamed_lines = (
            (
                line,
                {
                    "nonterminal": new if line.nonterminal == old else line.nonterminal,
                    "expansion": rename_nonterminal_in_pattern(line.expansion, old, new),
                },
            )
            for line in lines
        )
        yield "production", differing(renamed_lines)
        templates = self.grammar.templates.filter(
            Q(pattern__contains=token) | Q(form__contains=token)
        )
        renamed_templates = (
            (
                row,
                {
                    "pattern": rename_nonterminal_in_pattern(row.pattern, old, new),
                    "form": rename_nonterminal_in_form(row.form, old, new),
                },
            )
            for row in templates
        )
        yield "template", differing(renamed_templates)
        renamed_categories = (
            (row, {"rule_sources": [_rename_alias(each, old, new) for each in row.rule_sources]})
            for row in self.grammar.task_categories.all()
        )
        yield "task category", differing(renamed_categories)


class PredicateRename:
    """Renames a predicate in templates, and in all stored forms of what people said."""

    def __init__(self, row: Predicate, old: str) -> None:
        self.row = row
        self.old = row.name

    def require_free(self, new: str) -> None:
        require_predicate(new)
        templates = SemanticTemplate.objects.filter(
            grammar__world=self.row.world, form__contains=new
        )
        is_used = any(
            rename_predicate(each.form, new, f"{new}0") != each.form for each in templates
        )
        if is_used or self.row.world.predicates.filter(name=new).exists():
            raise LanguageError(f"there is a predicate {new} already", hint="choose another name")

    def changes(self, new: str) -> Iterator[tuple[str, RenamedRows]]:
        yield "predicate", [(self.row, {"name": new})]
        world, old = self.row.world, self.old
        for noun, rows, names in (
            ("template", SemanticTemplate.objects.filter(grammar__world=world), ("form",)),
            (
                "paraphrase",
                Paraphrase.objects.filter(world=world),
                ("grounded_form", "logical_form"),
            ),
            ("utterance", Utterance.objects.filter(world=world), ("logical_form",)),
            ("label", Label.objects.filter(utterance__world=world), ("form",)),
            (
                "audit finding",
                AuditFinding.objects.filter(world=world),
                ("form", "suggested_form", "decided_form"),
            ),
            (
                "audit reason",
                AuditReason.objects.filter(finding__world=world),
                ("suggested_form",),
            ),
            ("audit decision", AuditDecision.objects.filter(finding__world=world), ("form",)),
        ):
            naming = Q()
            for name in names:
                naming |= Q(**{f"{name}__contains": old})
            yield (
                noun,
                differing(
                    (row, {name: rename_predicate(getattr(row, name), old, new) for name in names})
                    for row in rows.filter(naming).iterator()
                ),
            )


class PrimitiveRename:
    """Renames a primitive in the recipe book of the world."""

    def __init__(self, row: Primitive, old: str) -> None:
        self.row = row
        self.old = row.name

    def require_free(self, new: str) -> None:
        renamed = self._primitive(new)
        if renamed.name != new:
            raise LanguageError(f"“{new}” is no name", hint="use letters, digits and _")
        if self.row.world.primitives.filter(name=renamed.name).exists():
            raise LanguageError(f"there is a primitive {new} already", hint="choose another name")

    def changes(self, new: str) -> Iterator[tuple[str, RenamedRows]]:
        yield "primitive", [(self.row, Primitive.columns_of(str(self._primitive(new))))]
        recipes = self.row.world.recipes.filter(text__contains=self.old)
        yield (
            "recipe",
            differing((row, {"text": self._renamed(row.text, new)}) for row in recipes),
        )

    def _primitive(self, new: str) -> PrimitiveValue:
        """Return the primitive under its new name. Raises LanguageError where this is none."""
        renamed = replace(primitive_of(self.row.text), name=new)
        return read_primitive(str(renamed))

    def _renamed(self, text: str, new: str) -> str:
        recipe = recipe_of(text)
        calls = (
            replace(call, primitive=new) if call.primitive == self.old else call
            for call in recipe.calls
        )
        return str(replace(recipe, calls=tuple(calls)))


class CategoryRename:
    """Renames a task category, with the sets that are named after it, in all that belongs to it."""

    def __init__(self, row: TaskCategory, old: str) -> None:
        self.row = row
        self.old = row.name
        self.grammar = row.grammar

    def require_free(self, new: str) -> None:
        require_set_name(new)
        others = self.grammar.task_categories.exclude(pk=self.row.pk)
        sets = {each.lower() for each in (*rule_files(others), *self._templates_of(others))}
        is_taken = others.filter(name__iexact=new).exists() or self.old == new
        if is_taken or not sets.isdisjoint({f"{new}{RULES}".lower(), f"{new}{TEMPLATES}".lower()}):
            raise LanguageError(
                f"there is a task category or a set {new} already", hint="choose another name"
            )

    def changes(self, new: str) -> Iterator[tuple[str, RenamedRows]]:
        old, world = self.old, self.row.owning_world
        files = {f"{old}{ending}": f"{new}{ending}" for ending in (RULES, TEMPLATES)}
        renamed_categories = (
            (
                each,
                {
                    "name": new if each.pk == self.row.pk else each.name,
                    "rule_sources": [_rename_set(entry, files) for entry in each.rule_sources],
                    "template_sources": [files.get(name, name) for name in each.template_sources],
                },
            )
            for each in self.grammar.task_categories.all()
        )
        yield "task category", differing(renamed_categories)
        for noun, rows in (
            ("production", self.grammar.productions.all()),
            ("template", self.grammar.templates.all()),
        ):
            of_it = rows.filter(Q(task_category=old) | Q(source__in=files))
            yield (
                noun,
                differing(
                    (
                        each,
                        {
                            "task_category": new
                            if each.task_category == old
                            else each.task_category,
                            "source": files.get(each.source, each.source),
                        },
                    )
                    for each in of_it
                ),
            )
        prompts = CampaignPrompt.objects.filter(campaign__world=world)
        for noun, made in (
            ("command", Command.objects.filter(world=world)),
            ("form", LogicalForm.objects.filter(world=world)),
            ("prompt", prompts),
        ):
            yield noun, [(each, {"task_category": new}) for each in made.filter(task_category=old)]

    @staticmethod
    def _templates_of(categories: Iterable[TaskCategory]) -> Iterator[str]:
        return (name for each in categories for name in each.template_sources)


def _rename_set(entry: str, files: Mapping[str, str]) -> str:
    source, alias = split_entry(entry)
    renamed = files.get(source, source)
    return f"{renamed} as ${alias}" if alias else renamed


def _rename_alias(entry: str, old: str, new: str) -> str:
    source, alias = split_entry(entry)
    return f"{source} as ${new}" if alias == old else entry


PLANS: dict[type[Editable], Callable[[Any, str], RenamePlan]] = {
    Production: NonterminalRename,
    Predicate: PredicateRename,
    Entity: EntityRename,
    Primitive: PrimitiveRename,
    TaskCategory: CategoryRename,
}
