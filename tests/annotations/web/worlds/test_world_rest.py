"""/api/v1/worlds/ and /api/v1/import-world/"""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.models import AuditEntry, Entity, Job, World


@pytest.fixture
def heavy(monkeypatch):
    """Everything takes long, so that it becomes a job."""
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    for name in ("world_deletion.is_heavy_deletion", "world_import_job.is_heavy_world"):
        monkeypatch.setattr(f"annotations.exchange.{name}", lambda *_: True)


def archive_of(call_as, user, world) -> SimpleUploadedFile:
    answer = call_as(user, "get", f"worlds/{world}/download/")
    return SimpleUploadedFile("home.zip", b"".join(answer.streaming_content))


def test_a_world_is_made_described_and_deleted(call_as, superuser):
    sent = {"name": "garden", "description": "A robot that waters."}
    made = call_as(superuser, "post", "worlds/", sent, idempotency_key="g")
    assert (made.status_code, made.json()["duties"]) == (201, sorted(made.json()["duties"]))
    assert made["Location"].endswith("/api/v1/worlds/garden/")
    again = call_as(superuser, "post", "worlds/", sent, idempotency_key="g")
    assert again["Idempotency-Replayed"] == "true"
    taken = call_as(superuser, "post", "worlds/", sent)
    assert (taken.status_code, taken.json()["problems"][0]["field"]) == (400, "name")
    address, dry = "worlds/garden/", {"description": "Dry."}
    assert call_as(superuser, "patch", address, dry).status_code == 428
    changed = call_as(superuser, "patch", address, dry, if_match=made["ETag"])
    assert changed.json()["description"] == "Dry."
    overtaken = call_as(superuser, "patch", address, {"description": ""}, if_match=made["ETag"])
    assert (overtaken.status_code, overtaken.json()["current"]["description"]) == (412, "Dry.")
    assert call_as(superuser, "delete", address).status_code == 428
    assert call_as(superuser, "delete", address, if_match=changed["ETag"]).status_code == 204
    assert not World.objects.exists()
    whats = ["create worlds", "change world", "delete world"]
    assert [each.what for each in AuditEntry.objects.order_by("pk")] == [whats[0], *whats]


def test_a_renamed_world_is_found_by_its_new_name(call_as, world, other_world, admin):
    address = "worlds/home/"
    for name in (other_world.name, "Not a name", ""):
        assert call_as(admin, "patch", address, {"name": name}, if_match="*").status_code == 400
    renamed = call_as(admin, "patch", address, {"name": "garden"}, if_match="*")
    assert (renamed.status_code, renamed.json()["name"]) == (200, "garden")
    assert call_as(admin, "get", address).status_code == 404
    assert call_as(admin, "get", "worlds/garden/").json()["duties"]


def test_admins_of_a_world_describe_it_and_delete_none(call_as, world, admin):
    assert call_as(admin, "post", "worlds/", {"name": "garden"}).status_code == 403
    kept = call_as(admin, "delete", "worlds/home/", if_match="*")
    assert kept.status_code == 403 and World.objects.filter(name="home").exists()
    sent = {"description": "Ours."}
    assert call_as(admin, "patch", "worlds/home/", sent, if_match="*").status_code == 200


def test_a_large_world_is_deleted_by_a_job(call_as, tiny_world, superuser, stranger, heavy):
    deleted = call_as(superuser, "delete", "worlds/home/", if_match="*")
    assert (deleted.status_code, deleted.json()["kind"]) == (202, "delete_world")
    job = deleted["Location"].partition("/api/v1/")[2]
    assert call_as(superuser, "get", "worlds/home/").status_code == 404
    assert call_as(superuser, "get", job).json()["status"] == "queued"
    assert call_as(stranger, "get", job).status_code == 404
    assert call_as(superuser, "post", f"{job}cancel/").status_code == 409


def test_a_world_moves_as_an_archive(call_as, tiny_world, superuser, admin):
    files = {"name": "copy", "archive": archive_of(call_as, admin, "home")}
    assert call_as(admin, "post", "import-world/", files=files).status_code == 403
    files["archive"].seek(0)
    done = call_as(superuser, "post", "import-world/", files=files)
    assert done.json()["report"]["world"] == "copy", done.json()
    assert Entity.objects.filter(ontology__world__name="copy", text="tea").exists()
    files["archive"].seek(0)
    taken = call_as(superuser, "post", "import-world/", files=files)
    assert (taken.status_code, taken["Content-Type"]) == (400, "application/problem+json")
    broken = {"name": "other", "archive": SimpleUploadedFile("home.zip", b"no archive")}
    assert call_as(superuser, "post", "import-world/", files=broken).status_code == 400


def test_the_import_of_a_large_world_is_a_job_that_can_be_cancelled(
    call_as, tiny_world, superuser, admin, heavy
):
    files = {"name": "copy", "archive": archive_of(call_as, admin, "home")}
    asked = call_as(superuser, "post", "import-world/", files=files)
    assert asked.status_code == 202
    job = asked["Location"].partition("/api/v1/")[2]
    assert job == f"jobs/{Job.objects.get().pk}/"
    assert call_as(superuser, "post", f"{job}cancel/").json()["status"] == "cancelled"


def test_a_job_of_a_world_is_seen_by_its_members_alone(call_as, world, admin, stranger):
    job = Job.objects.create(world=world, world_name="home", kind="generate", created_by=stranger)
    assert call_as(admin, "get", f"jobs/{job.pk}/").status_code == 200
    assert call_as(stranger, "get", f"jobs/{job.pk}/").status_code == 404
    assert call_as(admin, "post", f"jobs/{job.pk}/cancel/").status_code == 404
