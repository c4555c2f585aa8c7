"""Downloading a world, and importing one, in the browser."""

from __future__ import annotations

import io

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from annotations.labelling.collecting import collect
from annotations.models import World
from annotations.models.worlds import Duty
from tests.annotations.exchange.packing import everything_of, members_of, pack


@pytest.fixture
def root(superuser) -> Client:
    client = Client()
    client.force_login(superuser)
    return client


def test_a_member_downloads_everything(tiny_world, anna):
    answer = anna.get("/w/home/download/")
    assert answer["Content-Disposition"] == 'attachment; filename="home-world.zip"'
    members = members_of(io.BytesIO(b"".join(answer.streaming_content)))
    assert {"world.json", "generator/objects.xml", "rows/templates.jsonl"} <= members.keys()


def test_an_archive_becomes_a_world_of_whoever_sent_it(tiny_world, root, superuser):
    archive = SimpleUploadedFile("home-world.zip", pack(tiny_world).read())
    answer = root.post("/worlds/import/", {"name": "again", "archive": archive})
    assert answer.status_code == 302 and answer["Location"] == "/w/again/"
    again = World.objects.get(name="again")
    assert everything_of(again) == everything_of(tiny_world)
    assert again.memberships.get().user == superuser and again.allows(superuser, Duty.MANAGE)


def test_a_defect_is_said_on_the_page(world, root):
    archive = SimpleUploadedFile("home-world.zip", b"nothing")
    answer = root.post("/worlds/import/", {"name": "again", "archive": archive})
    assert answer.status_code == 422
    assert list(answer.context["form"].errors) == ["archive"]


def test_the_next_page_names_the_rows_whose_texts_were_changed(tiny_world, root):
    collect(tiny_world, ["bring me tea"])
    tiny_world.utterances.update(text="bring\u200b me tea")
    archive = SimpleUploadedFile("home.zip", pack(tiny_world).getvalue())
    answer = root.post("/worlds/import/", {"name": "again", "archive": archive}, follow=True)
    said = [str(each) for each in answer.context["messages"]]
    assert any("rows/utterances.jsonl:1:1: warning" in each for each in said)
