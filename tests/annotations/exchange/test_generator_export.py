from __future__ import annotations

from pathlib import Path

import pytest

import annotations
from annotations.exchange.generator_export import generator_files
from annotations.exchange.generator_import import import_generator
from annotations.models import SemanticTemplate, World
from annotations.models.description import TemplateStatus
from tests.annotations.rows_of import contents_of

STARTER = Path(annotations.__file__).parent / "starter" / "household"


def round_trip(source):
    """Return what a world holds after an import, and another one after importing the export of the first."""
    import_generator("first", source)
    first = World.objects.get(name="first")
    files = {name: text.encode() for name, text in generator_files(first).items()}
    report = import_generator("second", files)
    assert not report.is_refused
    return contents_of(first), contents_of(World.objects.get(name="second"))


@pytest.mark.parametrize("year", ["2018", "2019"])
def test_a_real_generator_exports_and_imports_as_the_same_rows(db, shared_data, year):
    before, after = round_trip(shared_data / f"generator-{year}")
    assert after == before


def test_the_starter_world_exports_and_imports_as_the_same_rows(db):
    before, after = round_trip(STARTER)
    assert after == before


def test_an_import_under_another_name_survives_the_round_trip(db):
    files = {
        "part.txt": b"$Main = {object} | $Extra\n$Extra = cup\n",
        "whole.txt": b"; import part.txt as $thing\n$Main = take the $thing\n",
    }
    before, after = round_trip(files)
    assert after == before


def test_importing_its_own_export_changes_nothing_in_a_world(tiny_world):
    import_generator(tiny_world.name, as_bytes := generator_bytes(tiny_world))
    report = import_generator(tiny_world.name, as_bytes)
    assert report.changes.as_json() == {"added": 0, "changed": 0, "removed": 0, "moved": 0}


def test_drafts_stay_behind(tiny_world):
    SemanticTemplate.objects.filter(pattern__startswith="go").update(status=TemplateStatus.DRAFT)
    text = generator_files(tiny_world)["tiny_category_1_semantics.txt"]
    assert text == "$vbfind the $object = (find (λ$1:e (is_a $1 $object)))\n"


def generator_bytes(world):
    return {name: text.encode() for name, text in generator_files(world).items()}
