"""Some files are imported without touching what the others say, and what people changed stays."""

from __future__ import annotations

from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.editing.edits import add, change
from annotations.exchange.generator_export import GeneratorPart, complete, files_of_part
from annotations.exchange.generator_import import import_generator
from annotations.models import Entity, Production, SemanticTemplate


def lines_of(world):
    return sorted(map(str, SemanticTemplate.objects.filter(grammar__world=world)))


def test_nothing_changes_without_a_file(tiny_world, admin):
    report = import_generator("home", complete(tiny_world, {}), admin)
    assert report.changes.is_none, report


def test_what_was_downloaded_and_is_uploaded_again_changes_nothing(tiny_world, admin):
    row = SemanticTemplate.objects.get(form="(go {room})")
    change(row, {"pattern": "walk to the {room}"}, admin, 1)
    values = {"grammar": row.grammar, "source": row.source, "task_category": row.task_category}
    add(SemanticTemplate(pattern="move to the {room}", form="(go {room})", **values), admin)
    before = lines_of(tiny_world)
    downloaded = files_of_part(tiny_world, GeneratorPart.TEMPLATES)
    uploads = {name: text.encode() for name, text in downloaded.items()}
    report = import_generator("home", complete(tiny_world, uploads), admin)
    assert not report.is_refused
    assert lines_of(tiny_world) == before
    assert len(before) == 3


def test_a_file_of_one_part_replaces_that_part_alone(tiny_world, adam):
    productions = sorted(map(str, Production.objects.all()))
    rooms = b'<rooms><room name="den"><location name="desk" isPlacement="true"/></room></rooms>'
    sent = {"files": SimpleUploadedFile("locations.xml", rooms), "keeps_others": "on"}
    answer = adam.post("/w/home/import/", sent, follow=True)
    assert answer.status_code == 200
    assert sorted(map(str, Production.objects.all())) == productions
    assert Entity.objects.filter(text="tea").exists()
    assert "kitchen" in answer.content.decode()  # asked before it is removed
    page = adam.get("/w/home/import/?part=ontology").content.decode()
    assert "checked" in page
