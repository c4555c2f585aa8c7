"""The rows of an archive are read normalised, as whatever else comes in; frozen splits are not."""

from __future__ import annotations

import json

import pytest

from annotations.editing.commenting import SUBJECTS, add_comment
from annotations.exchange import world_import
from annotations.exchange.world_import import import_world
from annotations.generation.freezing import content_hash_of, freeze_split
from annotations.generation.generating import generate_pairs
from annotations.labelling.collecting import collect
from annotations.language.corpus import distance
from annotations.language.texts.errors import LanguageError
from annotations.models import Entity, Example, Split, Utterance, World
from tests.annotations.commands.run_command import run
from tests.annotations.exchange.packing import everything_of, members_of, pack, pack_members
from tests.annotations.rows_of import counts
from tests.doubted_labels import say


def import_changed(world: World):
    """What an import of the archive of ``world`` reports, and the world that it makes."""
    imported = import_world("again", pack(world))
    return imported, World.objects.get(name="again")


def refusal_of(world: World) -> LanguageError:
    before = counts()
    with pytest.raises(LanguageError) as refusal:
        import_world("again", pack(world))
    assert counts() == before
    return refusal.value


def places(imported) -> list[tuple[str, int]]:
    return [(each.position.source, each.position.line) for each in imported.problems]


def test_a_clean_world_gives_no_warning(tiny_world):
    imported, again = import_changed(tiny_world)
    assert imported.problems == () and imported.as_json()["problems"] == []
    assert everything_of(again) == everything_of(tiny_world)


def test_texts_names_and_comments_are_normalised_and_named(tiny_world, annotator):
    World.objects.filter(pk=tiny_world.pk).update(description="our\u200b lab")
    entity = tiny_world.ontology.entities.first()
    add_comment(tiny_world, SUBJECTS["entity"], entity, "why?\n  cafe", annotator)
    tiny_world.comments.update(text="why?\n  cafe\u0301")
    Entity.objects.filter(pk=entity.pk).update(
        text="pl\xadum", aliases=["the\u2028plu\ufeffm"], attributes={"ro\u200bom": "cafe\u0301"}
    )
    imported, again = import_changed(tiny_world)
    read = again.ontology.entities.first()
    assert (read.text, read.aliases) == ("plum", ["the plum"])
    assert read.attributes == {"room": "caf\u00e9"}
    assert again.description == "our lab"
    assert again.comments.get().text == "why?\n  caf\u00e9"
    assert places(imported) == [
        ("world.json", 1),
        ("rows/entities.jsonl", 1),
        ("rows/comments.jsonl", 1),
    ]
    assert (
        "3 invisible characters were removed, 1 word has composed" in imported.problems[1].message
    )


def test_spans_stay_at_their_words(tiny_world, annotator):
    collect(tiny_world, ["bring the cafe to anna"], by=annotator)
    text = "\u200bbring the cafe\u0301 to\u200d an\xadna"
    begin, other = text.index("cafe"), text.index("an\xad")
    spans = [[other, len(text), "name", "an\xadna"], [begin, begin + 5, "object", "cafe\u0301"]]
    tiny_world.utterances.update(text=text, spans=spans)
    _, again = import_changed(tiny_world)
    row = again.utterances.get()
    assert row.text == "bring the caf\u00e9 to anna"
    assert [row.text[start:end] for start, end, _, _ in row.spans] == ["anna", "caf\u00e9"]
    assert [entity for *_, entity in row.spans] == ["anna", "caf\u00e9"]


def test_a_paraphrase_is_measured_as_it_is_read(tiny_world):
    row = say(tiny_world, "how many girls")
    apart = distance(row.utterance, row.prompt)
    tiny_world.paraphrases.update(utterance="how m\u200bany girls", edit_distance=99)
    _, again = import_changed(tiny_world)
    read = again.paraphrases.get()
    assert read.utterance == "how many girls"
    assert (read.edit_distance, read.jaccard_distance) == (apart.edit, apart.jaccard)


def test_two_utterances_that_are_equal_now_are_refused_with_both_lines(tiny_world, annotator):
    collect(tiny_world, ["hello", "bring me tea", "good night", "bring me milk"], by=annotator)
    tiny_world.utterances.filter(text="bring me milk").update(text="bring me\u200b tea")
    refusal = refusal_of(tiny_world)
    assert (refusal.source, refusal.line) == ("rows/utterances.jsonl", 4)
    assert "lines 2 and 4 " in refusal.message
    assert "“bring me tea”" in refusal.message and refusal.hint


def test_the_earlier_row_may_be_many_rows_before(tiny_world, annotator, monkeypatch):
    monkeypatch.setattr(world_import, "BATCH", 2)
    collect(tiny_world, ["a", "b", "c", "d", "e"], by=annotator)
    tiny_world.utterances.filter(text="e").update(text="b\u200b")
    assert "lines 2 and 5 " in refusal_of(tiny_world).message


def test_two_entities_that_people_wrote_and_are_equal_now_are_refused(tiny_world):
    last = tiny_world.ontology.entities.order_by("position").last().position
    for number, text in enumerate(["plum", "PL\u200bUM"], start=1):
        Entity.objects.create(
            ontology=tiny_world.ontology, entity_class="object", text=text, position=last + number
        )
    refusal = refusal_of(tiny_world)
    count = tiny_world.ontology.entities.count()
    assert f"lines {count - 1} and {count} " in refusal.message


def test_a_text_in_which_nothing_shows_is_refused(tiny_world, annotator):
    collect(tiny_world, ["hello"], by=annotator)
    tiny_world.utterances.update(text="\u200b \u200d")
    refusal = refusal_of(tiny_world)
    assert "text" in refusal.message.split() and refusal.line == 1


def test_two_names_of_attributes_that_are_equal_now_are_refused(tiny_world):
    entity = tiny_world.ontology.entities.first()
    Entity.objects.filter(pk=entity.pk).update(attributes={"room": "a", "ro\u200bom": "b"})
    refusal = refusal_of(tiny_world)
    assert (refusal.source, refusal.line) == ("rows/entities.jsonl", 1)


def test_a_frozen_split_keeps_its_texts_and_its_hash(tiny_world):
    generate_pairs(tiny_world)
    freeze_split(tiny_world, "frozen")
    split = tiny_world.splits.get()
    example = split.examples.first()
    Example.objects.filter(pk=example.pk).update(utterance="go\u200b to the cafe\u0301")
    Split.objects.filter(pk=split.pk).update(content_hash=content_hash_of(split))
    imported, again = import_changed(tiny_world)
    assert imported.problems == ()
    assert again.splits.get().content_hash == Split.objects.get(pk=split.pk).content_hash
    assert again.splits.get().examples.filter(utterance="go\u200b to the cafe\u0301").exists()


def test_many_changed_rows_are_counted(tiny_world, annotator):
    collect(tiny_world, [f"say {number}" for number in range(30)], by=annotator)
    for row in tiny_world.utterances.all():
        Utterance.objects.filter(pk=row.pk).update(text=f"{row.text}\u200b")
    imported, again = import_changed(tiny_world)
    assert set(again.utterances.values_list("text", flat=True)) == {
        f"say {number}" for number in range(30)
    }
    assert len(imported.problems) == 21
    assert (
        "10 invisible characters were removed in 10 further lines" in imported.problems[-1].message
    )


def test_the_command_prints_the_warnings(tiny_world, annotator, tmp_path):
    members = members_of(pack(tiny_world))
    first, *rest = members["rows/templates.jsonl"].splitlines()
    pattern = json.loads(first)["pattern"]
    row = {**json.loads(first), "pattern": f"{pattern}\u200b"}
    members["rows/templates.jsonl"] = b"\n".join([json.dumps(row).encode(), *rest]) + b"\n"
    (tmp_path / "home.zip").write_bytes(pack_members(members).getvalue())
    report, failure = run("import_world", tmp_path / "home.zip", "--world", "again")
    assert failure is None
    (problem,) = report["problems"]
    assert (problem["file"], problem["line"], problem["severity"]) == (
        "rows/templates.jsonl",
        1,
        "warning",
    )
    assert World.objects.get(name="again").grammar.templates.first().pattern == pattern
