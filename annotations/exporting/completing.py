"""Complete some files of a generator with what the world has, so that importing them changes nothing else."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from annotations.exporting.generator_export import Part, files_of_part
from annotations.models import SemanticTemplate, World


def complete(world: World, uploads: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files of ``world`` with ``uploads`` in the place of those of the same name.

    The lines of templates are as the import knows them: one that people have changed here is the line that
    it was imported as, so that it stays what they made of it.
    """
    rows = list(SemanticTemplate.objects.filter(grammar__world=world))
    stored: dict[str, str] = {}
    for part in (Part.ONTOLOGY, Part.GRAMMAR, Part.PREDICATES):
        stored |= files_of_part(world, part)
    stored |= _imported_templates(rows)
    known = {row.source: _imported_lines(rows, row.source) for row in rows}
    files = {name: text.encode() for name, text in stored.items()}
    return files | {name: _as_imported(data, known.get(name, {})) for name, data in uploads.items()}


def _imported_templates(rows: list[SemanticTemplate]) -> dict[str, str]:
    lines: dict[str, list[str]] = defaultdict(list)
    for row in rows:
        if row.imported_text:
            lines[row.source].append(row.imported_text)
    return {name: "".join(f"{line}\n" for line in some) for name, some in lines.items()}


def _imported_lines(rows: list[SemanticTemplate], source: str) -> dict[bytes, bytes]:
    """Return what a template of the file is now → the line that it was imported as; empty for one written here."""
    return {str(row).encode(): row.imported_text.encode() for row in rows if row.source == source}


def _as_imported(data: bytes, known: Mapping[bytes, bytes]) -> bytes:
    return b"\n".join(known.get(line.strip(), line) for line in data.split(b"\n"))
