"""What describes a world: ontology, predicates, grammar, templates, and what the checker says of them."""

from __future__ import annotations

import re
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

from django.core.validators import MaxValueValidator
from django.db import models
from django.db.models.fields.json import KeyTextTransform
from django.db.models.functions import Coalesce, Left, Lower

from annotations.language.forms import (
    DEFAULT_CLASSES,
    HUES,
    MAX_CLASS_WORDS,
    MAX_TOKEN,
    EntityClasses,
    split_head,
)
from annotations.language.forms import EntityClass as ClassValue
from annotations.language.texts import MAX_INDEXED_BYTES, MAX_PREDICATE, MAX_ROW, LanguageError
from annotations.models.editing import Editable
from annotations.models.people import User
from annotations.models.worlds import World

if TYPE_CHECKING:
    from annotations.language.plans import ActionPattern, RecipeBook

MOST_CHARACTERS_OF_GUIDELINES = 20_000


class EntityClassQuerySet(models.QuerySet["EntityClass"]):
    def as_value(self) -> EntityClasses:
        """Return the classes as a value, in order."""
        return EntityClasses(tuple(row.as_value for row in self))

    def add_of_household(self, world: World) -> None:
        """Store those classes of GPSRCmdGen that ``world`` has not got, behind its own."""
        self.bulk_create(self.missing_of_household(world))

    def missing_of_household(self, world: World) -> list[EntityClass]:
        """Return, unsaved, those classes of GPSRCmdGen that ``world`` has not got."""
        rows = list(world.entity_classes.all())
        tokens = {row.token for row in rows}
        missing = (value for value in DEFAULT_CLASSES if value.token not in tokens)
        first = rows[-1].position + 1 if rows else 0
        return [EntityClass.of(world, value, n) for n, value in enumerate(missing, first)]


class EntityClass(Editable):
    """A class of the entities of a world, as ``annotations.language.forms.EntityClass`` explains it.

    The token stands in entities, templates, forms and commands, and does not change.
    """

    edited_fields = ("token", "singular", "plural", "said", "hue", "is_closed")

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="entity_classes")
    token = models.CharField(max_length=MAX_TOKEN)
    singular = models.CharField(max_length=MAX_CLASS_WORDS)
    plural = models.CharField(max_length=MAX_CLASS_WORDS)
    said = models.CharField(max_length=MAX_CLASS_WORDS)
    hue = models.PositiveSmallIntegerField(validators=[MaxValueValidator(HUES - 1)])
    is_closed = models.BooleanField(default=False)
    position = models.PositiveIntegerField()

    objects = EntityClassQuerySet.as_manager()

    class Meta:
        ordering = ["position"]
        verbose_name_plural = "entity classes"
        constraints = [
            models.UniqueConstraint(
                fields=["world", "token"],
                name="entity_class_token",
                violation_error_message="There is a class of this token already.",
            ),
            models.UniqueConstraint(fields=["world", "position"], name="entity_class_position"),
        ]

    def __str__(self) -> str:
        return self.token

    @classmethod
    def of(cls, world: World, value: ClassValue, position: int) -> EntityClass:
        """Return an unsaved row for a value."""
        return cls(world=world, position=position, **asdict(value))

    @property
    def as_value(self) -> ClassValue:
        return ClassValue(
            self.token, self.singular, self.plural, self.hue, self.said, self.is_closed
        )


class BookRow(Editable):
    """A row of the recipe book of a world, as a text that ``annotations.language.plans`` reads and writes."""

    edited_fields = ("text",)

    text = models.CharField(max_length=MAX_ROW)
    position = models.PositiveIntegerField()

    class Meta:
        abstract = True
        ordering = ["position", "pk"]

    def __str__(self) -> str:
        return self.text


class PrimitiveQuerySet(models.QuerySet["Primitive"]):
    def start_book(self, world: World, book: RecipeBook) -> None:
        """Store the primitives of ``book`` in a world that has none."""
        rows = enumerate(map(str, book.primitives))
        self.bulk_create(
            Primitive(world=world, position=n, **Primitive.columns_of(text)) for n, text in rows
        )


class Primitive(BookRow):
    """Something that the team's robot can do. ``name`` is that in the text."""

    fields_beside = ("name",)

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="primitives")
    name = models.CharField(max_length=MAX_PREDICATE)

    objects = PrimitiveQuerySet.as_manager()

    class Meta(BookRow.Meta):
        constraints = [
            models.UniqueConstraint(
                fields=["world", "name"],
                name="primitive_name",
                violation_error_message="There is a primitive of this name already.",
            )
        ]

    @staticmethod
    def columns_of(text: str) -> dict[str, str]:
        """Return the columns that follow from a text, and the text in its one spelling. Raises LanguageError."""
        from annotations.language.plans import read_primitive

        value = read_primitive(text)
        return {"text": str(value), "name": value.name}


class RecipeQuerySet(models.QuerySet["Recipe"]):
    def start_book(self, world: World, book: RecipeBook) -> None:
        """Store the recipes of ``book`` in a world that has none."""
        rows = enumerate(map(str, book.recipes))
        self.bulk_create(
            Recipe(world=world, position=n, **Recipe.columns_of(text)) for n, text in rows
        )


class Recipe(BookRow):
    """How the robot does an action of a form: its primitives in order.

    ``action`` is that of the text, and ``left`` its left side with the arguments in order: of two recipes with the
    same one, none fits better than the other.
    """

    fields_beside = ("action", "left")

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="recipes")
    action = models.CharField(max_length=MAX_PREDICATE)
    left = models.CharField(max_length=MAX_ROW)

    objects = RecipeQuerySet.as_manager()

    class Meta(BookRow.Meta):
        constraints = [
            models.UniqueConstraint(
                fields=["world", "left"],
                name="recipe_left_side",
                violation_error_message="There is a recipe with this left side already.",
            )
        ]

    @staticmethod
    def columns_of(text: str) -> dict[str, str]:
        """Return the columns that follow from a text, and the text in its one spelling. Raises LanguageError."""
        from annotations.language.plans import read_recipe

        value = read_recipe(text)
        left = str(_in_order(value.pattern))
        if len(left.encode()) > MAX_INDEXED_BYTES:
            raise LanguageError("the left side is too long", hint="give its arguments short names")
        return {"text": str(value), "action": value.pattern.action, "left": left}


def _in_order(pattern: ActionPattern) -> ActionPattern:
    """Return a left side with its arguments in the order of their names."""
    parameters = (
        replace(each, action=_in_order(each.action)) if each.action else each
        for each in pattern.parameters
    )
    return replace(pattern, parameters=tuple(sorted(parameters, key=lambda each: each.name)))


class Ontology(models.Model):
    world = models.OneToOneField(World, on_delete=models.CASCADE, related_name="ontology")

    def __str__(self) -> str:
        return f"ontology of {self.world}"


class EntityQuerySet(models.QuerySet["Entity"]):
    def count_by_class(self) -> dict[str, int]:
        """Return how many entities each class has; those that have none are left out."""
        counted = self.order_by().values_list("entity_class").annotate(models.Count("pk"))
        return dict(counted)


# Of an attribute that tells entities of one text apart; an index of PostgreSQL has a longest row.
COMPARED_CHARACTERS = 60


def compared(attribute: str) -> Left:
    """Return the beginning of an attribute, without regard to case, as the database compares it."""
    value = Coalesce(KeyTextTransform(attribute, "attributes"), models.Value(""))
    return Left(Lower(value), COMPARED_CHARACTERS)


class Entity(Editable):
    """One row of an ontology file. Rows may repeat a text (a name of either gender, a sink in two rooms).

    Those of files may repeat all the rest too, as the files do; those that people write may not.
    """

    world_path = "ontology__world"
    edited_fields = ("entity_class", "text", "aliases", "attributes")

    ontology = models.ForeignKey(Ontology, on_delete=models.CASCADE, related_name="entities")
    entity_class = models.CharField(max_length=MAX_TOKEN)
    text = models.TextField()
    aliases = models.JSONField(default=list, blank=True)
    attributes = models.JSONField(default=dict, blank=True)
    source = models.CharField(max_length=200, blank=True)
    line = models.PositiveIntegerField(default=0)
    position = models.PositiveIntegerField()

    objects = EntityQuerySet.as_manager()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["ontology", "position"], name="entity_position"),
            models.UniqueConstraint(
                "ontology",
                "entity_class",
                Lower("text"),
                compared("room"),
                compared("gender"),
                condition=models.Q(source=""),
                name="entity_once",
                violation_error_message="This entity is there already.",
            ),
        ]
        indexes = [models.Index(fields=["ontology", "entity_class", "text"])]

    def __str__(self) -> str:
        return f"{self.text} ({self.entity_class})"


def predicate_kind_choices() -> list[tuple[str, str]]:
    return [("action", "action"), ("sequence", "sequence"), ("description", "description")]


class Predicate(Editable):
    """A name with its signatures (a list of lists of argument kinds) and its English gloss.

    ``is_edited`` says that a person has changed it: from then on an import leaves it alone.
    """

    edited_fields = ("name", "kind", "signatures", "gloss")
    bears_on_commands = True  # templates are checked against it

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="predicates")
    name = models.CharField(max_length=80)
    kind = models.CharField(max_length=20, choices=predicate_kind_choices)
    signatures = models.JSONField(default=list)
    gloss = models.CharField(max_length=200, blank=True)
    is_edited = models.BooleanField(default=False)

    class Meta:
        ordering = ["name"]
        constraints = [models.UniqueConstraint(fields=["world", "name"], name="predicate_name")]

    def __str__(self) -> str:
        return self.name

    def note_editor(self, by: User) -> None:
        self.is_edited = True


class Grammar(models.Model):
    world = models.OneToOneField(World, on_delete=models.CASCADE, related_name="grammar")

    def __str__(self) -> str:
        return f"grammar of {self.world}"


class TaskCategory(Editable):
    """A difficulty class of commands, with the rule and template sets it is generated from, in order.

    ``rule_sources`` and ``template_sources`` are lists of ``Production.source`` and
    ``SemanticTemplate.source``, the category's own last; where two templates give one command different
    forms, the later wins.

    ``commands_in_grammar`` counts the distinct commands of its grammar and ``commands_with_form``
    those among them that have a logical form, as of the last import or generation. Both are None
    where nothing was counted, or the grammar is too large to count (``annotations.generation.coverage``).
    """

    world_path = "grammar__world"
    edited_fields = ("name", "rule_sources", "template_sources")
    bears_on_commands = True

    grammar = models.ForeignKey(Grammar, on_delete=models.CASCADE, related_name="task_categories")
    name = models.CharField(max_length=60)
    position = models.PositiveIntegerField()
    rule_sources = models.JSONField(default=list)
    template_sources = models.JSONField(default=list)
    commands_in_grammar = models.PositiveIntegerField(null=True, editable=False)
    commands_with_form = models.PositiveIntegerField(null=True, editable=False)

    class Meta:
        ordering = ["position", "pk"]
        constraints = [
            models.UniqueConstraint(
                fields=["grammar", "name"],
                name="task_category_name",
                violation_error_message="There is a task category of this name already.",
            )
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
        if self.commands_with_form is None or not self.commands_in_grammar:
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


class TemplateStatus(models.TextChoices):
    DRAFT = "draft"
    READY = "ready"
    DISPUTED = "disputed"


def template_status_choices() -> list[tuple[str, str]]:
    return TemplateStatus.choices


class SemanticTemplateQuerySet(models.QuerySet["SemanticTemplate"]):
    def with_problems(self) -> SemanticTemplateQuerySet:
        """Return the templates that the checker had something to say about when they were last stored."""
        return self.exclude(problems=[])

    def for_nonterminal(self, name: str) -> SemanticTemplateQuerySet:
        """Return the lines that say what ``$name`` may become and mean."""
        return self.filter(pattern__regex=rf"^\s*[$]{re.escape(name)}\s*->")


class SemanticTemplate(Editable):
    """``pattern = form``: a partial expansion of the grammar and the logical form of its commands.

    ``source`` is the file or set it belongs to; ``task_category`` the category that set was written for.
    ``imported_text`` is the line that it was imported as, by which a later import knows it whatever
    people have made of it since; empty for one that a person wrote here. ``problems`` are what the
    checker said when it was last stored, as ``annotations.rows.stored_problems`` writes them.
    """

    world_path = "grammar__world"
    edited_fields = ("task_category", "source", "pattern", "form", "status")
    fields_beside = ("problems",)
    bears_on_commands = True

    grammar = models.ForeignKey(Grammar, on_delete=models.CASCADE, related_name="templates")
    source = models.CharField(max_length=200)
    line = models.PositiveIntegerField(default=0)
    task_category = models.CharField(max_length=60, blank=True)
    pattern = models.TextField()
    form = models.TextField()
    imported_text = models.TextField(blank=True)
    status = models.CharField(
        max_length=20, choices=template_status_choices, default=TemplateStatus.READY
    )
    author = models.ForeignKey(User, null=True, blank=True, on_delete=models.SET_NULL)
    position = models.PositiveIntegerField()
    problems = models.JSONField(default=list, blank=True)

    objects = SemanticTemplateQuerySet.as_manager()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["grammar", "position"], name="template_position")
        ]

    def __str__(self) -> str:
        return f"{self.pattern} = {self.form}"

    @classmethod
    def for_category(cls, category: TaskCategory, **values: Any) -> SemanticTemplate:
        """Return an unsaved template with ``values`` in the set that ``category`` calls its own."""
        return cls(grammar=category.grammar, **cls.set_of(category), **values)

    @staticmethod
    def set_of(category: TaskCategory) -> dict[str, str]:
        """Return the fields that put a template into the set that ``category`` calls its own."""
        return {"source": category.template_sources[-1], "task_category": category.name}

    def moved_to(self, category: TaskCategory | None) -> dict[str, str]:
        """Return the fields that change when the template moves to ``category``.

        None do where it is there already, or in a set that belongs to no task category.
        """
        if category is None or self.task_category in ("", category.name):
            return {}
        return self.set_of(category)

    @property
    def makes_commands(self) -> bool:
        return self.status == TemplateStatus.READY

    @property
    def nonterminal(self) -> str:
        """What a line ``$name -> pattern`` is for; empty for a template of commands."""
        return split_head(self.pattern)[0]

    def note_editor(self, by: User) -> None:
        self.author = by


class Guidelines(Editable):
    """The guidelines for the annotators of a world, in Markdown. A world has one row at most."""

    edited_fields = ("text",)

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="guidelines")
    text = models.TextField(blank=True, max_length=MOST_CHARACTERS_OF_GUIDELINES)

    class Meta:
        verbose_name_plural = "guidelines"
        constraints = [
            models.UniqueConstraint(
                fields=["world"],
                name="one_guidelines_each",
                violation_error_message="Somebody has just written guidelines. Reload the page.",
            )
        ]

    def __str__(self) -> str:
        return "Guidelines"


class ProblemSubject(models.TextChoices):
    ONTOLOGY = "ontology"
    GRAMMAR = "grammar"
    TEMPLATES = "templates"
    COMMANDS = "commands"
    PAIRS = "pairs"


def subject_choices() -> list[tuple[str, str]]:
    return ProblemSubject.choices


class StoredProblem(models.Model):
    """A warning: ``source:line:column: message (hint)``, about one part of a world."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="problems")
    subject = models.CharField(max_length=20, choices=subject_choices)
    source = models.CharField(max_length=200, blank=True)
    line = models.PositiveIntegerField(default=1)
    column = models.PositiveIntegerField(default=1)
    severity = models.CharField(max_length=10)
    message = models.TextField()
    hint = models.TextField(blank=True)

    class Meta:
        ordering = ["source", "line", "column", "id"]
        indexes = [models.Index(fields=["world", "subject"])]

    def __str__(self) -> str:
        return f"{self.source}:{self.line}:{self.column}: {self.message}"
