"""A split is frozen anew from the corpus of today; what it has in common with the old one stays in its part."""

from __future__ import annotations

import pytest

from annotations.exchange.pair_import import import_pairs
from annotations.generation.freezing import content_hash_of, freeze_split
from annotations.generation.renewing import changes_since, freeze_anew, last_of
from annotations.labelling.label_decisions import correct_label
from annotations.language.texts.errors import LanguageError
from annotations.models import Command, Paraphrase, Split, Utterance
from annotations.models.corpus import ParaphraseStatus
from tests.annotations.generation.test_freezing import full  # noqa: F401
from tests.sample_world import make_paraphrase

NEW_FORM = '( find " <room> " )'


def totals(split) -> dict[str, int]:
    names = ("added", "removed", "relabelled", "moved")
    parts = changes_since(split).parts
    return {name: sum(getattr(each, name) for each in parts) for name in names}


def parts_of(split) -> dict[tuple[str, str], str]:
    rows = split.examples.values_list("source", "utterance", "part")
    return {(source, utterance): part for source, utterance, part in rows}


@pytest.fixture
def split(full) -> Split:  # noqa: F811
    return freeze_split(full, "first", seed=3, proportions=(0.6, 0.2, 0.2))


def test_nothing_has_changed_at_first(split):
    assert changes_since(split).is_none
    with pytest.raises(LanguageError, match=split.name):
        freeze_anew(split)
    assert not split.world.splits.exclude(pk=split.pk).exists()


def test_what_would_change_is_counted_by_part(split):
    first, second, third = Paraphrase.objects.all()[:3]
    Paraphrase.objects.filter(pk=first.pk).update(logical_form=NEW_FORM)
    Paraphrase.objects.filter(pk=second.pk).update(status=ParaphraseStatus.EXCLUDED)
    make_paraphrase(split.world, utterance="something new", logical_form=NEW_FORM)
    changes = changes_since(split)
    assert totals(split) == {"added": 1, "removed": 1, "relabelled": 1, "moved": 0}
    (relabelled,) = changes.relabelled
    assert (relabelled.before, relabelled.now) == (first.logical_form, NEW_FORM)
    assert relabelled.part == parts_of(split)["paraphrased", first.utterance]
    assert third.logical_form != NEW_FORM


def test_a_new_split_has_the_labels_of_today_and_the_old_one_stays(split, annotator):
    row = Paraphrase.objects.first()
    Paraphrase.objects.filter(pk=row.pk).update(logical_form=NEW_FORM)
    before = list(split.examples.values())
    renewed = freeze_anew(split, annotator)
    assert renewed.examples.get(utterance=row.utterance).logical_form == NEW_FORM
    assert list(split.examples.values()) == before
    assert (renewed.name, renewed.follows, renewed.created_by) == ("first-2", split, annotator)
    assert (renewed.criterion, renewed.seed, renewed.proportions) == ("command", 3, [0.6, 0.2, 0.2])
    assert content_hash_of(renewed) == renewed.content_hash
    assert changes_since(renewed).is_none


def test_every_utterance_keeps_its_part_where_the_criterion_allows_it(split):
    for number, command in enumerate(Command.objects.all()[:5]):
        make_paraphrase(
            split.world,
            command=command,
            utterance=f"new {number}",
            logical_form=command.logical_form.text,
        )
    before = parts_of(split)
    after = parts_of(freeze_anew(split))
    assert {key: after[key] for key in before} == before


def test_a_corrected_label_moves_where_the_new_form_is_kept_apart(full):  # noqa: F811
    split = freeze_split(full, "forms", "logical_form")
    row = Paraphrase.objects.get(
        utterance=split.examples.of("test", "paraphrased").first().utterance
    )
    taken = split.examples.of("train").first().logical_form
    Paraphrase.objects.filter(pk=row.pk).update(logical_form=taken)
    assert totals(split) == {"added": 0, "removed": 0, "relabelled": 1, "moved": 1}
    renewed = freeze_anew(split)
    assert parts_of(renewed)["paraphrased", row.utterance] == "train"
    forms = {part: set() for part in ("train", "validation", "test")}
    for part, form in renewed.examples.values_list("part", "logical_form"):
        forms[part].add(form)
    assert not forms["train"] & forms["test"]


def test_a_corrected_label_with_a_form_of_its_own_stays_in_its_part(full):  # noqa: F811
    split = freeze_split(full, "forms", "logical_form")
    row = Paraphrase.objects.get(
        utterance=split.examples.of("test", "paraphrased").first().utterance
    )
    Paraphrase.objects.filter(pk=row.pk).update(logical_form=NEW_FORM)
    assert parts_of(freeze_anew(split))["paraphrased", row.utterance] == "test"


def test_names_count_on_and_a_split_is_frozen_anew_once(split):
    make_paraphrase(split.world, utterance="one", logical_form=NEW_FORM)
    second = freeze_anew(split)
    make_paraphrase(split.world, utterance="two", logical_form=NEW_FORM)
    with pytest.raises(LanguageError, match=second.name):
        freeze_anew(split)
    third = freeze_anew(second)
    assert (third.name, third.follows) == ("first-3", second)
    assert last_of(split) == last_of(third) == third


def test_shares_that_nobody_noted_are_those_of_the_parts(split):
    Split.objects.filter(pk=split.pk).update(proportions=[])
    split.refresh_from_db()
    make_paraphrase(split.world, utterance="one", logical_form=NEW_FORM)
    train, validation, test = freeze_anew(split).proportions
    assert train + validation + test == pytest.approx(1)
    assert train == pytest.approx(0.6, abs=0.05)


def test_a_world_without_pairs_cannot_be_frozen_anew(split):
    split.world.commands.all().delete()
    split.world.paraphrases.all().delete()
    with pytest.raises(LanguageError):
        changes_since(split)


@pytest.fixture
def imported(world, tmp_path) -> Split:
    """A published split of three paraphrases, of which one is a row of the world too, and another row."""
    for part, said in (("train", ["go there now"]), ("val", ["walk there", "run there"])):
        path = tmp_path / "para" / f"{part}.txt"
        path.parent.mkdir(exist_ok=True)
        path.write_text("".join(f'{text}\n( go " <room> " )\n' for text in said), encoding="utf-8")
    assert not import_pairs(world.name, "published", tmp_path).problems
    make_paraphrase(world, utterance="walk there", logical_form="UNKNOWN")
    make_paraphrase(world, utterance="jump there", logical_form="UNKNOWN")
    return world.splits.get()


def say(world, text: str) -> None:
    Utterance.objects.create(
        world=world, text=text, anonymized_text=text, status="labelled", logical_form=NEW_FORM
    )


def test_pairs_of_an_import_stay_where_nobody_has_decided_otherwise(imported, annotator):
    assert changes_since(imported).is_none
    row = Paraphrase.objects.get(utterance="walk there")
    correct_label(row, NEW_FORM, annotator, row.version)
    say(imported.world, "hop there")
    assert totals(imported) == {"added": 1, "removed": 0, "relabelled": 1, "moved": 0}
    renewed = freeze_anew(imported)
    labels = dict(renewed.examples.values_list("utterance", "logical_form"))
    assert labels["run there"] == labels["go there now"] == '( go " <room> " )'
    assert labels["walk there"] == NEW_FORM
    before, after = parts_of(imported), parts_of(renewed)
    assert {key: after[key] for key in before} == before


def test_pairs_of_an_import_go_where_people_have_withdrawn_them(imported):
    Paraphrase.objects.update(status=ParaphraseStatus.EXCLUDED)
    Utterance.objects.create(
        world=imported.world, text="run there", anonymized_text="run there", status="unknown"
    )
    assert totals(imported) == {"added": 0, "removed": 2, "relabelled": 0, "moved": 0}


def test_what_follows_an_import_keeps_its_pairs_too(imported):
    say(imported.world, "hop there")
    second = freeze_anew(imported)
    assert changes_since(second).is_none
