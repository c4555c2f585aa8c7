"""GET /api/v1/worlds/<w>/splits/<id>/export/"""

from __future__ import annotations

import csv
import io
import json
import sys
import zipfile
from datetime import timedelta
from importlib import metadata

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.utils import timezone

from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.models import ApiToken


def url_of(split, query="", world=None):
    return f"/api/v1/worlds/{world or split.world}/splits/{split.pk}/export/{query}"


def text_of(response):
    assert response.streaming
    return b"".join(response.streaming_content).decode()


def test_json_lines_come_in_order_with_stable_keys(caller, split, annotator):
    response = caller(url_of(split, "?as=jsonl"), annotator)
    rows = [json.loads(line) for line in text_of(response).splitlines()]
    assert response["Content-Type"].startswith("application/jsonl")
    assert [row["part"] for row in rows] == ["test", "train", "train"]
    assert list(rows[0]) == [
        "position",
        "part",
        "source",
        "utterance",
        "source_command",
        "task_category",
        "logical_form",
        "grounded_form",
    ]


def test_text_is_one_pair_file(caller, split, reviewer):
    response = caller(url_of(split, "?as=txt&part=test&source=generated"), reviewer)
    assert text_of(response) == (
        'find the <object>\n( find ( lambda $1 e ( is_a $1 " <object> " ) ) )\n'
    )
    assert 'filename="walker-command-generated-test.txt"' in response["Content-Disposition"]


def test_text_without_part_and_source_is_refused_with_a_sentence(caller, split, annotator):
    response = caller(url_of(split, "?as=txt&part=test"), annotator)
    assert response.status_code == 400
    (problem,) = response.json()["problems"]
    assert "part=" in problem["message"] and "source=" in problem["message"]


def test_parquet_holds_the_rows_and_the_manifest(caller, split, annotator):
    import pyarrow.parquet as pq

    response = caller(url_of(split, "?as=parquet"), annotator, accept="text/html")
    table = pq.read_table(io.BytesIO(b"".join(response.streaming_content)))
    rows = table.to_pylist()
    assert [row["utterance"] for row in rows][2] == "=HYPERLINK the <room>"
    manifest = json.loads(table.schema.metadata[b"gpsr-workbench"])
    path = url_of(split).replace("export", "manifest")
    assert manifest == caller(path, annotator).json()
    assert (manifest["examples"], manifest["criterion"]) == (3, "command")
    assert manifest["counts"]["generated"] == {"train": 2, "validation": 0, "test": 1}
    assert response["X-Content-Hash"] == manifest["content_hash"] == split.content_hash
    assert manifest["code_version"].partition(" ")[0].startswith(metadata.version("gpsr-workbench"))
    part = caller(f"{path}?part=train", annotator).json()
    assert (part["examples"], part["chosen"]) == (2, {"part": "train"})


def test_parquet_without_its_package_is_refused(caller, split, annotator, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    response = caller(url_of(split, "?as=parquet"), annotator)
    assert (response.status_code, response.json()["code"]) == (501, "package_absent")
    assert "gpsr-workbench[parquet]" in response.json()["detail"]
    assert text_of(caller(url_of(split, "?as=csv"), annotator))


def test_an_archive_of_pair_files_comes_back_byte_for_byte(caller, tiny_world, admin, client):
    generate_pairs(tiny_world)
    first = freeze_split(tiny_world, "first", "logical_form", proportions=(0.5, 0, 0.5))
    packed = b"".join(caller(url_of(first, "?as=zip"), admin).streaming_content)
    _, key = ApiToken.issue(admin, "notebook")
    imported = client.post(
        "/api/v1/worlds/home/import/pairs/",
        {"name": "again", "archive": SimpleUploadedFile("pairs.zip", packed)},
        headers={"authorization": f"Bearer {key}"},
    )
    assert imported.status_code == 200, imported.json()
    second = tiny_world.splits.get(name=imported.json()["report"]["splits"]["logical_form"])
    before = zipfile.ZipFile(io.BytesIO(packed))
    after = b"".join(caller(url_of(second, "?as=zip"), admin).streaming_content)
    names = [name for name in before.namelist() if name != "manifest.json"]
    assert names == ["gen_logical/test.txt", "gen_logical/train.txt"]
    for name in names:
        assert zipfile.ZipFile(io.BytesIO(after)).read(name) == before.read(name)


def test_csv_never_starts_a_cell_with_a_formula(caller, split, annotator):
    text = text_of(caller(url_of(split, "?as=csv&part=train"), annotator))
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [row["utterance"] for row in rows] == ["go to the <room>", "'=HYPERLINK the <room>"]


@pytest.mark.parametrize("query", ["?as=xlsx", "?part=dev", "?source=gen"])
def test_an_unknown_value_is_refused(caller, split, annotator, query):
    assert caller(url_of(split, query), annotator).status_code == 400


def test_a_split_of_another_world_is_a_404(caller, split_elsewhere, world, annotator):
    assert caller(url_of(split_elsewhere, world=world), annotator).status_code == 404


def test_a_world_without_a_role_is_a_404(caller, split, stranger):
    assert caller(url_of(split), stranger).status_code == 404


def test_an_administrator_of_the_site_sees_every_world(caller, split, superuser):
    assert caller(url_of(split), superuser).status_code == 200


def test_no_token_is_a_401(caller, split):
    response = caller(url_of(split))
    assert response.status_code == 401
    assert response["WWW-Authenticate"] == "Bearer"


@pytest.mark.parametrize("header", ["Bearer wrong", "Bearer", "Bearer a b", "Bearer \xff"])
def test_a_bad_token_is_a_401(caller, split, header):
    assert caller(url_of(split), authorization=header).status_code == 401


def test_an_expired_token_is_a_401(caller, split, annotator):
    token, key = ApiToken.issue(annotator, "old")
    token.expires_at = timezone.now() - timedelta(seconds=1)
    token.save()
    assert caller(url_of(split), authorization=f"Bearer {key}").status_code == 401


def test_the_token_of_a_closed_account_is_a_401(caller, split, annotator):
    _, key = ApiToken.issue(annotator, "left")
    annotator.is_active = False
    annotator.save()
    assert caller(url_of(split), authorization=f"Bearer {key}").status_code == 401


@pytest.mark.parametrize("verb", ["post", "put", "patch", "delete"])
def test_an_export_is_read_only(client, split, annotator, verb):
    _, key = ApiToken.issue(annotator, "notebook")
    answer = getattr(client, verb)(url_of(split), headers={"authorization": f"Bearer {key}"})
    assert answer.status_code == 405
