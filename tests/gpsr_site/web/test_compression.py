"""Texts are compressed for whoever asks, and nothing that relies on what is sent breaks by it."""

from __future__ import annotations

import gzip

import pytest

from annotations.models import ApiToken

GZIP = {"accept-encoding": "gzip, deflate, br"}


@pytest.fixture
def token(admin) -> dict[str, str]:
    return {"authorization": f"Bearer {ApiToken.issue(admin, 'notebook', scope='admin')[1]}"}


def test_a_page_is_compressed_for_who_takes_it_so(client, sample, admin):
    client.force_login(admin)
    plain, packed = (client.get("/w/home/", headers=each) for each in ({}, GZIP))
    assert "Content-Encoding" not in plain.headers
    assert packed["Content-Encoding"] == "gzip"
    assert "Accept-Encoding" in packed["Vary"] and "Accept-Encoding" in plain["Vary"]
    assert len(packed.content) < len(plain.content) / 2
    assert gzip.decompress(packed.content).rstrip().endswith(b"</html>")


def test_a_packed_answer_has_another_length_each_time(client):
    """So that nobody guesses a secret of the page by what they can have written beside it (BREACH)."""
    assert len({len(client.get("/login/", headers=GZIP).content) for _ in range(20)}) > 1


def test_the_tag_of_a_row_is_good_for_changing_it_and_a_weak_one_is_not(client, sample, token):
    path = f"/api/v1/worlds/home/templates/{sample.template.pk}/"
    tag = client.get(path, headers={**token, **GZIP})["ETag"]

    def status_with(match: str, status: str) -> int:
        headers = {**token, "if-match": match}
        sent = {"status": status}
        return client.patch(
            path, sent, content_type="application/json", headers=headers
        ).status_code

    assert status_with(f"W/{tag}", "draft") == 412
    assert status_with(f'W/{tag}, "999"', "draft") == 412
    assert status_with(f'"999", {tag}', "draft") == 200
    assert status_with(tag, "ready") == 412


def test_the_schema_is_packed_and_asked_about_by_its_tag(client, db):
    packed = client.get("/api/v1/schema/", headers=GZIP)
    assert packed["Content-Encoding"] == "gzip" and len(packed.content) < 100_000
    again = client.get("/api/v1/schema/", headers={**GZIP, "if-none-match": packed["ETag"]})
    assert again.status_code == 304


@pytest.mark.parametrize("path", ["splits/{}/export/?as=jsonl", "splits/{}/export/?as=zip"])
def test_what_is_sent_in_pieces_is_sent_as_it_is(client, sample, token, path):
    address = f"/api/v1/worlds/home/{path.format(sample.split.pk)}"
    answer = client.get(address, headers={**token, **GZIP})
    assert answer.streaming and "Content-Encoding" not in answer.headers
