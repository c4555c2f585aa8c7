"""The folder of a competition by page and by REST, and then the rooms of its locations."""

from __future__ import annotations

import io
import zipfile

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.background import claim
from annotations.background.carrying_out_jobs import carry_out
from annotations.language.world.competition_folder import LOCATIONS, NAMES, OBJECTS
from annotations.models import Entity, Job, JobKind
from tests.annotations.language.world.test_competition_folder import FOLDER

PAGE, ROOMS_PAGE = "/w/home/import/competition/", "/w/home/ontology/rooms/"
API = "worlds/home/import/competition/"


def files(**changes):
    contents = {**FOLDER, **changes}
    return [
        SimpleUploadedFile(path.split("/")[1], text.encode()) for path, text in contents.items()
    ]


def archive():
    """A zip of the repository as a code host packs it, with pictures and questions."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as zipped:
        for path, text in FOLDER.items():
            zipped.writestr(f"RoboCup2026-main/{path}", text)
        zipped.writestr("RoboCup2026-main/objects/known_objects/red_bull.png", b"\x89PNG\x00")
        zipped.writestr("RoboCup2026-main/questions/questions.md", "Q: what?")
        zipped.writestr("RoboCup2026-main/README.md", "# Names\n| Names |\n")
    return [SimpleUploadedFile("RoboCup2026-main.zip", packed.getvalue())]


def texts(entity_class):
    rows = Entity.objects.filter(ontology__world__name="home", entity_class=entity_class)
    return list(rows.order_by("position").values_list("text", flat=True))


@pytest.mark.parametrize("make", [files, archive])
def test_files_and_an_archive_are_imported(world, adam, make):
    answer = adam.post(PAGE, {"files": make()}, follow=True)
    assert answer.status_code == 200
    job = Job.objects.get()
    assert (job.kind, job.status) == (JobKind.IMPORT_COMPETITION, "succeeded")
    assert job.report["entities"] == {
        **{"category": 1, "object": 1, "room": 2, "location": 2, "name": 2}
    }
    assert texts("name") == ["Ada", "Antônia"]
    assert ROOMS_PAGE in answer.content.decode()


def test_a_large_folder_is_imported_by_a_worker(world, adam, settings, tmp_path):
    settings.VAR_DIR = tmp_path
    prose = f"{'Who they are. ' * 30}\n" * 1_200
    answer = adam.post(PAGE, {"files": files(**{NAMES: prose + FOLDER[NAMES]})})
    job = Job.objects.get()
    assert answer["Location"] == f"/jobs/{job.pk}/"
    assert (job.kind, job.status) == (JobKind.IMPORT_COMPETITION, "queued")
    carry_out(claim("a worker", "quick", Job, job))
    job.refresh_from_db()
    assert job.report["entities"]["name"] == 2
    assert texts("name") == ["Ada", "Antônia"]


def test_a_fault_is_shown_at_its_place_and_nothing_is_stored(world, adam):
    answer = adam.post(PAGE, {"files": files(**{NAMES: "| Names |\n| Ada |\n"})}, follow=True)
    assert answer.context["is_refused"]
    assert [(each["file"], each["line"]) for each in answer.context["problems"]] == [(NAMES, 1)]
    assert not Entity.objects.exists()
    assert Job.objects.get().status == "failed"


def test_a_row_that_a_generator_loses_is_shown_beside_its_entity(world, adam):
    adam.post(PAGE, {"files": files()})
    lost = Entity.objects.get(text="Antônia")
    (job,) = Job.objects.all()
    assert job.report["lost"]["April 2026"] == {"name": 1, "location": 1}
    answer = adam.get(f"/jobs/{job.pk}/")
    shown = next(each for each in answer.context["problems"] if each["file"] == NAMES)
    assert (shown["line"], shown["severity"]) == (5, "warning")
    assert shown["url"] == f"/w/home/ontology/{lost.pk}/"
    assert "April 2026" in answer.content.decode()


def test_a_script_in_a_name_is_shown_as_text(world, adam):
    script = "<script>alert(1)</script>"
    for name in (NAMES, OBJECTS):
        text = FOLDER[name].replace("Ada", script).replace("red_bull", script)
        answer = adam.post(PAGE, {"files": files(**{name: text})}, follow=True)
        assert answer.context["is_refused"]
        assert script not in answer.content.decode()
    place = FOLDER[LOCATIONS].replace("| drinks |", f"| {script} |")
    answer = adam.post(PAGE, {"files": files(**{LOCATIONS: place})}, follow=True)
    assert (answer.status_code, script in answer.content.decode()) == (200, False)
    assert "&lt;script&gt;" in answer.content.decode()


def test_a_file_that_is_no_archive_is_refused(world, adam):
    answer = adam.post(PAGE, {"files": [SimpleUploadedFile("event.zip", b"not a zip")]})
    assert answer.status_code == 422
    assert answer.context["form"].errors.keys() == {"files"}


def test_a_program_imports_it(world, admin, call_as):
    answer = call_as(admin, "post", API, files={"files": archive()})
    assert answer.status_code == 200
    assert answer.json()["report"]["without_room"] == ["side table", "sofa"]
    broken = call_as(admin, "post", API, files={"files": files(**{NAMES: "nobody"})})
    assert broken.status_code == 422
    assert broken.json()["problems"][0]["file"] == NAMES


@pytest.fixture
def locations(world, adam):
    adam.post(PAGE, {"files": files()})
    rows = Entity.objects.filter(entity_class="location").order_by("position")
    return {row.text: row for row in rows}


def test_rooms_are_chosen_and_stay(locations, adam, anna):
    sofa, table = locations["sofa"], locations["side table"]
    answer = anna.post(ROOMS_PAGE, {sofa.pk: "living room", table.pk: ""})
    assert (answer.status_code, answer["Location"]) == (302, "/w/home/ontology/")
    sofa.refresh_from_db()
    assert (sofa.attributes["room"], sofa.version) == ("living room", 2)
    table.refresh_from_db()
    assert table.version == 1
    adam.post(PAGE, {"files": files()})
    sofa.refresh_from_db()
    assert (sofa.attributes["room"], sofa.version) == ("living room", 2)
    anna.post(ROOMS_PAGE, {sofa.pk: ""})
    sofa.refresh_from_db()
    assert "room" not in sofa.attributes


def test_a_room_that_is_not_there_is_refused(locations, anna):
    sofa = locations["sofa"]
    answer = anna.post(ROOMS_PAGE, {sofa.pk: "attic"})
    assert answer.status_code == 422
    sofa.refresh_from_db()
    assert "room" not in sofa.attributes


@pytest.mark.parametrize("entity_class", ["location", "room"])
def test_without_locations_or_rooms_the_page_says_what_to_do(locations, anna, entity_class):
    Entity.objects.filter(entity_class=entity_class).delete()
    answer = anna.get(ROOMS_PAGE)
    assert answer.status_code == 200
    assert "<select" not in answer.content.decode().partition("<main")[2]
