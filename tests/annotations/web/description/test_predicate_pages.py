"""Predicates are edited in place, with their English and the templates that they would break."""

from __future__ import annotations

import json
from io import BytesIO
from zipfile import ZipFile

import pytest

from annotations.editing.edits import change
from annotations.exchange.generator_import import import_generator
from annotations.models import Predicate, SemanticTemplate


@pytest.fixture
def go(sample) -> Predicate:
    return Predicate.objects.get(name="go")


def sent(**values):
    kept = {"kind": "action", "signatures": "(room)", "gloss": "go to {1}", "version": 1}
    return {**kept, **values}


def test_a_preview_says_it_in_english_and_names_the_templates_that_break(go, anna):
    address = f"/w/home/predicates/preview/?row={go.pk}"
    answer = anna.post(address, sent(gloss="walk into {1}"))
    checked = answer.context["checked"]
    assert [each.sentence for each in checked.samples] == ["walk into the room"]
    assert "walk into the room" in answer.content.decode()
    assert checked.templates == ()
    answer = anna.post(address, sent(signatures="(gesture)"))
    ((row, told),) = answer.context["checked"].templates
    assert row.form == "(go {room})" and told
    assert row.pattern in answer.content.decode() and told[0] in answer.content.decode()
    answer = anna.post(address, sent(signatures="(planet)"))
    assert "checked" not in answer.context and "planet" in answer.context["trouble"]


def test_what_is_saved_is_the_next_version_and_templates_have_its_problems(go, anna):
    address = f"/w/home/predicates/{go.pk}/"
    before = problems_of("(go {room})")
    assert anna.post(address, sent(signatures="(gesture)\n(name, room?)")).status_code == 302
    go.refresh_from_db()
    assert go.signatures == [["gesture"], ["name"], ["name", "room"]]
    assert (go.version, go.is_edited) == (2, True)
    new = problems_of("(go {room})") - before
    (message,) = new
    assert "go" in message.split() and "room" in message.split()
    assert anna.post(address, sent(version=2)).status_code == 302
    assert problems_of("(go {room})") == before


def problems_of(form):
    rows = SemanticTemplate.objects.get(form=form).problems
    return {remark["message"] for remark in rows}


def test_two_people_on_one_predicate_get_a_merge(go, anna, admin):
    change(go, {"gloss": "walk to {1}"}, admin, 1)
    answer = anna.post(f"/w/home/predicates/{go.pk}/", sent(signatures="(room)\n(location)"))
    assert answer.status_code == 409
    assert answer.context["form"]["version"].value() == 2
    assert "walk to {1}" in answer.content.decode()


def test_a_predicate_is_declared_once(sample, anna):
    new = sent(name="fly", signatures="(location)", gloss="")
    assert anna.post("/w/home/predicates/new/", new).status_code == 302
    for refused in (new, sent(name="lambda")):
        answer = anna.post("/w/home/predicates/new/", refused)
        assert answer.status_code == 200 and list(answer.context["form"].errors) == ["name"]
    assert sample.world.predicates.filter(name="fly").count() == 1
    assert not sample.world.predicates.filter(name="lambda").exists()


def test_the_parts_that_are_downloaded_import_without_a_change(sample, rene, admin):
    files = {}
    for each in ("ontology", "grammar", "templates", "predicates"):
        data = rene.get(f"/w/home/download/{each}/")
        if data["Content-Type"] == "application/zip":
            with ZipFile(BytesIO(data.content)) as archive:
                files |= {name: archive.read(name) for name in archive.namelist()}
        else:
            files[data["Content-Disposition"].split('"')[1]] = data.content
    report = import_generator("home", files, admin)
    assert report.changes.is_none, report
    assert json.loads(files["predicates.json"])


def test_a_part_that_is_not_there_is_not_found(world, anna):
    assert anna.get("/w/home/download/planets/").status_code == 404
    assert anna.get("/w/home/download/grammar/").status_code == 404
