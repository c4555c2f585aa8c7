"""Every defect of an archive is a sentence, and nothing of it stays."""

from __future__ import annotations

import io
import json
import re
import zipfile
from secrets import token_hex

import pytest

from annotations.exchange import world_import
from annotations.exchange.row_checks import SHAPES
from annotations.exchange.world_import import import_world
from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.language.texts.errors import LanguageError
from annotations.models import World
from tests.annotations.exchange.packing import members_of, pack, pack_members
from tests.annotations.rows_of import counts


@pytest.fixture
def members(tiny_world) -> dict[str, bytes]:
    """The files of the archive of a small world with commands."""
    generate_pairs(tiny_world)
    return members_of(pack(tiny_world))


def refusal_of(archive: io.BytesIO) -> LanguageError:
    before = counts()
    with pytest.raises(LanguageError) as refusal:
        import_world("again", archive)
    assert counts() == before
    return refusal.value


def change_row(members, table, number=0, **values):
    """Changes columns of one row; ``None`` for the name of a column removes it."""
    path = f"rows/{table}.jsonl"
    lines = members[path].splitlines()
    lines[number] = json.dumps({**json.loads(lines[number]), **values}).encode()
    members[path] = b"\n".join(lines) + b"\n"


def change_manifest(members, **values):
    members["world.json"] = json.dumps({**json.loads(members["world.json"]), **values}).encode()


@pytest.mark.parametrize(
    ("table", "values", "named"),
    [
        ("commands", {"template": 99}, "99 of templates"),
        ("commands", {"template": True}, "True of templates"),
        ("commands", {"logical_form": None}, "None of forms"),
        ("entities", {"source": "../up.md"}, "path"),
        ("entities", {"source": "maps/.hidden"}, "path"),
        ("productions", {"source": "maps/rules.txt"}, "path"),
        ("recipes", {"text": "go(destination)"}, "->"),
        ("recipes", {"left": "go()"}, "left"),
        ("primitives", {"name": "fly"}, "name"),
        ("commands", {"position": -1}, "position"),
        ("commands", {"position": 10**30}, "position"),
        ("commands", {"position": "1"}, "position"),
        ("commands", {"is_in_grammar": 1}, "is_in_grammar"),
        ("commands", {"task_category": "x" * 61}, "task_category"),
        ("commands", {"anonymized_text": "a\0b"}, "NUL"),
        ("commands", {"anonymized_text": "a\\\0b"}, "NUL"),
        ("commands", {"anonymized_text": "\ud800"}, "UTF-8"),
        ("commands", {"world_id": 1}, ": world_id"),
        ("entities", {"entity_class": "planet"}, "“planet”"),
        ("entities", {"attributes": ["a"]}, "attributes"),
        ("entities", {"aliases": "a"}, "aliases"),
        ("productions", {"source": "../evil.txt"}, "“../evil.txt”"),
        ("productions", {"expansion": "( a | b"}, ""),
        ("task_categories", {"rule_sources": []}, "rule_sources"),
        ("task_categories", {"template_sources": ["/etc/passwd"]}, "“/etc/passwd”"),
        ("predicates", {"signatures": [["planet"]]}, "signatures"),
        ("templates", {"form": "(go"}, ""),
        ("templates", {"author": 7}, "author"),
        ("forms", {"text": "( go"}, "text"),
    ],
)
def test_a_row_that_cannot_be_stored(members, table, values, named):
    change_row(members, table, **values)
    assert named in refusal_of(pack_members(members)).message


def test_a_row_twice(members):
    first, *rest = members["rows/commands.jsonl"].splitlines()
    members["rows/commands.jsonl"] = b"\n".join([first, first, *rest[1:]]) + b"\n"
    refusal = refusal_of(pack_members(members))
    assert re.findall(r"\b\d+\b", refusal.message.partition("“")[0]) == ["1", "2"]
    assert (refusal.source, refusal.line) == ("rows/commands.jsonl", 2)


@pytest.mark.parametrize(
    "line", [b"{", b"[1]", b"\xff", b"[" * 5000, b'{"position": 1e999}', b"9" * 5000]
)
def test_a_line_that_is_no_object(members, line):
    members["rows/commands.jsonl"] = line + b"\n"
    refusal = refusal_of(pack_members(members))
    assert (refusal.source, refusal.line) == ("rows/commands.jsonl", 1)


def test_a_line_too_long(members):
    members["rows/commands.jsonl"] = json.dumps(token_hex(500_001)).encode()
    refusal = refusal_of(pack_members(members))
    assert "1,000,000" in refusal.message and refusal.source == "rows/commands.jsonl"


def test_rows_that_are_missing(members):
    members["rows/commands.jsonl"] = members["rows/commands.jsonl"].split(b"\n")[0] + b"\n"
    refusal = refusal_of(pack_members(members))
    assert re.findall(r"\b\d+\b", refusal.message) == ["1", "3"]


def test_a_split_whose_pairs_were_changed(members, tiny_world):
    freeze_split(tiny_world, "frozen")
    members = members_of(pack(tiny_world))
    change_row(members, "examples", utterance="something else")
    assert "frozen" in refusal_of(pack_members(members)).message


def test_a_file_that_was_changed_after_the_download(members):
    members["generator/objects.xml"] += b"<!-- one more -->"
    refusal = refusal_of(pack_members(members, is_consistent=False))
    assert refusal.source == "generator/objects.xml"
    assert "generator/" in refusal.hint


def test_a_file_that_is_missing(members):
    del members["rows/forms.jsonl"]
    assert "rows/forms.jsonl" in str(refusal_of(pack_members(members, is_consistent=False)))


def test_no_manifest(members):
    del members["world.json"]
    assert "world.json" in refusal_of(pack_members(members, is_consistent=False)).message


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"version": 2}, r"\b2\b.*\b1\b"),
        ({"format": "other"}, "“format”"),
        ({"has_grammar": "yes"}, r"\bhas_grammar\b"),
        ({"has_grammar": False}, r"\bgrammar\b"),
        ({"revision": -1}, r"\brevision\b"),
        ({"description": None}, r"\bdescription\b"),
        ({"rows": 3}, "“rows”"),
        ({"files": {"world.json": "x"}}, "“files”"),
    ],
)
def test_a_manifest_that_says_something_else(members, values, named):
    change_manifest(members, **values)
    is_consistent = "files" not in values
    assert re.search(named, str(refusal_of(pack_members(members, is_consistent))))


@pytest.mark.parametrize("text", [b"", b"[]", b"{", b"\xff\xfe", b"9" * 5000])
def test_a_manifest_that_is_none(members, text):
    members["world.json"] = text
    assert refusal_of(pack_members(members, is_consistent=False)).source == "world.json"


def test_a_folder_that_was_packed_is_read_too(members):
    inside = {f"home-world/{name}": data for name, data in pack_and_read(members).items()}
    import_world("again", pack_members(inside, is_consistent=False))
    assert World.objects.filter(name="again").exists()


def pack_and_read(members):
    return members_of(pack_members(members))


def test_what_is_no_archive(members):
    assert refusal_of(io.BytesIO(b"PK\x03\x04 no zip")).hint


@pytest.mark.parametrize("method", [zipfile.ZIP_DEFLATED, zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_a_stream_that_is_damaged(members, method):
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", method) as file:
        for name, data in members.items():
            file.writestr(name, data)
        info = file.getinfo("rows/commands.jsonl")
    data = bytearray(target.getvalue())
    start = info.header_offset + 30 + len(info.filename)
    data[start : start + info.compress_size] = b"\x99" * info.compress_size
    refusal = refusal_of(io.BytesIO(bytes(data)))
    assert refusal.code == "unreadable"


def test_more_than_an_archive_may_hold(members, settings):
    settings.ARCHIVE_MAX_FILES = 3
    assert re.search(r"\b3\b", refusal_of(pack_members(members)).message)
    settings.ARCHIVE_MAX_FILES, settings.ARCHIVE_MAX_BYTES = 5000, 100
    assert re.search(r"\b100\b", refusal_of(pack_members(members)).message)


def test_a_bomb(members):
    members["rows/bomb.jsonl"] = b" " * 10_000_000
    assert "bomb" in refusal_of(pack_members(members)).hint


@pytest.mark.parametrize("name", ["Upper", "", "x" * 61, "home"])
def test_a_name_that_no_new_world_can_have(members, name):
    before = counts()
    with pytest.raises(LanguageError, match=f"“{name}”"):
        import_world(name, pack_members(members))
    assert counts() == before


def test_a_name_that_is_taken_in_the_meantime(members, monkeypatch):
    def check_slowly(world):
        World.objects.create(name="again")

    monkeypatch.setattr(world_import, "_check_world", check_slowly)
    with pytest.raises(LanguageError, match="“again”"):
        import_world("again", pack_members(members))
    assert set(World.objects.values_list("name", flat=True)) == {"again", "home"}


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("entities", {}),
        ("entities", [{"text": "tea"}]),
        ("entities", [{"text": "tea", "aliases": [1], "is_described": False}]),
        ("entities", [{"text": "tea", "aliases": [], "is_described": 0}]),
        ("flags", [{"code": "copy"}]),
        ("flags", [{"code": "copy", "evidence": 1}]),
        ("flags", ["copy"]),
        ("settings", []),
        ("settings", {"name": ["x"]}),
    ],
)
def test_what_prompts_submissions_and_contributors_cannot_hold(column, value):
    assert not SHAPES[column](value)
