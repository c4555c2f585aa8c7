"""Verb: export a world as the files of a generator, and complete some of these files with what the world has."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from django.db import models

from annotations.exchange.predicates_file import PREDICATES_FILE, write_predicates
from annotations.language.world import write_ontology
from annotations.models import Production, SemanticTemplate, TaskCategory, World
from annotations.models.description import TemplateStatus
from annotations.rows.composition import split_entry
from annotations.rows.from_rows import ontology_of, predicates_of


class GeneratorPart(models.TextChoices):
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
    for part in (
        GeneratorPart.GRAMMAR,
        GeneratorPart.TEMPLATES,
        GeneratorPart.ONTOLOGY,
        GeneratorPart.PREDICATES,
    ):
        files |= files_of_part(world, part)
    return files


def files_of_part(world: World, part: str) -> dict[str, str]:
    """Return the files of one ``GeneratorPart`` of the world: file name → text."""
    match part:
        case GeneratorPart.GRAMMAR:
            grammar: dict[str, list[str]] = defaultdict(list)
            for category in TaskCategory.objects.filter(grammar__world=world):
                *imports, own = category.rule_sources
                lines = grammar[own]
                for source, alias in map(split_entry, imports):
                    lines.append(f'; import "{source}"' + (f" as ${alias}" if alias else ""))
            for row in Production.objects.filter(grammar__world=world):
                grammar[row.source].append(f"${row.nonterminal} = {row.expansion}")
            return _texts(grammar)
        case GeneratorPart.TEMPLATES:
            templates: dict[str, list[str]] = defaultdict(list)
            for template in SemanticTemplate.objects.filter(
                grammar__world=world, status=TemplateStatus.READY
            ):
                templates[template.source].append(f"{template.pattern} = {template.form}")
            return _texts(templates)
        case GeneratorPart.ONTOLOGY:
            return write_ontology(ontology_of(world))
    predicates = predicates_of(world)
    return {PREDICATES_FILE: write_predicates(predicates.values())} if predicates else {}


def _texts(lines: Mapping[str, list[str]]) -> dict[str, str]:
    return {name: "\n".join(some) + "\n" for name, some in lines.items()}


def complete(world: World, uploads: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files of ``world`` with ``uploads`` in the place of those of the same name, in any case of letters.

    The lines of templates are as the import knows them: one that people have changed here is the line that
    it was imported as, so that it stays what they made of it.
    """
    rows = SemanticTemplate.objects.filter(grammar__world=world)
    stored: dict[str, str] = {}
    for part in (GeneratorPart.ONTOLOGY, GeneratorPart.GRAMMAR, GeneratorPart.PREDICATES):
        stored |= files_of_part(world, part)
    imported: dict[str, list[str]] = defaultdict(list)
    # File → what a template of it is now → the line that it was imported as; empty for one written here.
    known: dict[str, dict[bytes, bytes]] = defaultdict(dict)
    for row in rows:
        if row.imported_text:
            imported[row.source].append(row.imported_text)
        known[row.source][str(row).encode()] = row.imported_text.encode()
    stored |= _texts(imported)
    sent = {name.lower() for name in uploads}
    files = {name: text.encode() for name, text in stored.items() if name.lower() not in sent}
    return files | {
        name: b"\n".join(known.get(name, {}).get(line.strip(), line) for line in data.split(b"\n"))
        for name, data in uploads.items()
    }
