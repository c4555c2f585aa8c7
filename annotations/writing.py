"""Verb: give out what an import took in, as the files of a generator."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from annotations.composition import split_entry
from annotations.importing.predicates_file import PREDICATES_FILE, write_predicates
from annotations.language.ontology import write_ontology
from annotations.models import Production, SemanticTemplate, TaskCategory, World
from annotations.models.templates import Status
from annotations.reading import ontology_of, predicates_of


def export_generator(world: World, folder: Path) -> list[str]:
    """Writes the files of a generator that import as the same rows; returns their names.

    Drafts stay behind: they are nobody's but their author's yet. Raises OSError where ``folder``
    cannot be written.
    """
    files = generator_files(world)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8", newline="")
    return list(files)


def generator_files(world: World) -> dict[str, str]:
    """File name → text of the world's ontology, grammar, ready templates and predicates."""
    grammar: dict[str, list[str]] = defaultdict(list)
    for category in TaskCategory.objects.filter(grammar__world=world):
        *imports, own = category.rule_sources
        grammar[own] += [_import_line(entry) for entry in imports]
    for row in Production.objects.filter(grammar__world=world):
        grammar[row.source].append(f"${row.nonterminal} = {row.expansion}")
    templates: dict[str, list[str]] = defaultdict(list)
    for row in SemanticTemplate.objects.filter(grammar__world=world, status=Status.READY):
        templates[row.source].append(f"{row.pattern} = {row.form}")
    files = {name: "\n".join(lines) + "\n" for name, lines in (grammar | templates).items()}
    files |= write_ontology(ontology_of(world))
    predicates = predicates_of(world)
    return files | ({PREDICATES_FILE: write_predicates(predicates.values())} if predicates else {})


def _import_line(entry: str) -> str:
    source, alias = split_entry(entry)
    return f'; import "{source}" as ${alias}' if alias else f'; import "{source}"'
