"""Verb: export a world as the files of a generator."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from django.db import models

from annotations.importing.predicates_file import PREDICATES_FILE, write_predicates
from annotations.language.ontology import write_ontology
from annotations.models import Production, SemanticTemplate, TaskCategory, World
from annotations.models.description import TemplateStatus
from annotations.rows.composition import split_entry
from annotations.rows.from_rows import ontology_of, predicates_of


class Part(models.TextChoices):
    """What is downloaded by itself."""

    ONTOLOGY = "ontology"
    GRAMMAR = "grammar"
    TEMPLATES = "templates"
    PREDICATES = "predicates"


def generator_files(world: World) -> dict[str, str]:
    """Return the files of a generator that imports as the same rows: file name → text.

    Drafts are left out.
    """
    files: dict[str, str] = {}
    for part in (Part.GRAMMAR, Part.TEMPLATES, Part.ONTOLOGY, Part.PREDICATES):
        files |= files_of_part(world, part)
    return files


def files_of_part(world: World, part: str) -> dict[str, str]:
    """Return the files of one ``Part`` of the world: file name → text."""
    match part:
        case Part.GRAMMAR:
            return _grammar_files(world)
        case Part.TEMPLATES:
            return _template_files(world)
        case Part.ONTOLOGY:
            return write_ontology(ontology_of(world))
    predicates = predicates_of(world)
    return {PREDICATES_FILE: write_predicates(predicates.values())} if predicates else {}


def _grammar_files(world: World) -> dict[str, str]:
    grammar: dict[str, list[str]] = defaultdict(list)
    for category in TaskCategory.objects.filter(grammar__world=world):
        *imports, own = category.rule_sources
        grammar[own] += [_import_line(entry) for entry in imports]
    for row in Production.objects.filter(grammar__world=world):
        grammar[row.source].append(f"${row.nonterminal} = {row.expansion}")
    return _texts(grammar)


def _template_files(world: World) -> dict[str, str]:
    templates: dict[str, list[str]] = defaultdict(list)
    for row in SemanticTemplate.objects.filter(grammar__world=world, status=TemplateStatus.READY):
        templates[row.source].append(f"{row.pattern} = {row.form}")
    return _texts(templates)


def _texts(lines: Mapping[str, list[str]]) -> dict[str, str]:
    return {name: "\n".join(some) + "\n" for name, some in lines.items()}


def _import_line(entry: str) -> str:
    source, alias = split_entry(entry)
    return f'; import "{source}" as ${alias}' if alias else f'; import "{source}"'
