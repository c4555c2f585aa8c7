from __future__ import annotations

from collections import defaultdict

import pytest

from annotations.exchange.pair_import import import_pairs
from annotations.exchange.split_export import export_split
from annotations.generation.freezing import as_items, freeze_split, unresolved_prompts
from annotations.generation.generating import generate_pairs
from annotations.generation.renewing import changes_since, freeze_anew
from annotations.generation.split_statistics import figures_of
from annotations.language.texts.errors import LanguageError
from annotations.models import Command, Example, Paraphrase
from annotations.models.campaigns import ContributorKind
from annotations.models.corpus import ParaphraseStatus
from tests.sample_world import make_paraphrase

ROOMS = [f"{adjective} {room}" for adjective in ("red", "blue", "old", "new") for room in "abcde"]


@pytest.fixture
def full(tiny_world, tiny):
    """``tiny_world`` with enough commands and paraphrases to part."""
    productions = [f"go to the {each} room" for each in ROOMS]
    for number, text in enumerate(productions):
        tiny_world.grammar.templates.create(
            source="tiny_category_1_semantics.txt",
            pattern=text,
            form=f'(go "{text[10:]}")',
            position=100 + number,
        )
    generate_pairs(tiny_world)
    for number, command in enumerate(Command.objects.select_related("logical_form")):
        for word in ("please", "now"):
            make_paraphrase(
                tiny_world,
                command=command,
                prompt=command.anonymized_text,
                utterance=f"{word} {command.anonymized_text}",
                grounded_form=command.logical_form.text,
                logical_form=command.logical_form.text,
                position=2 * number + (word == "now"),
            )
    return tiny_world


def parts_by(split, field):
    parts = defaultdict(set)
    for part, value in split.examples.values_list("part", field):
        parts[value].add(part)
    return parts


@pytest.mark.parametrize(
    ("criterion", "field"),
    [
        ("command", "utterance"),
        ("source_command", "source_command"),
        ("logical_form", "logical_form"),
    ],
)
def test_two_parts_share_nothing_of_the_criterion(full, criterion, field):
    split = freeze_split(full, "first", criterion, seed=3)
    assert all(len(parts) == 1 for parts in parts_by(split, field).values())
    assert set(split.examples.values_list("part", flat=True)) == {"train", "validation", "test"}


def test_every_command_and_accepted_paraphrase_is_in_it_once(full):
    Paraphrase.objects.filter(position=0).update(status=ParaphraseStatus.REJECTED)
    Paraphrase.objects.filter(position=2).update(status=ParaphraseStatus.PENDING)
    split = freeze_split(full, "first")
    assert split.examples.filter(source="generated").count() == full.commands.count()
    assert split.examples.filter(source="paraphrased").count() == full.paraphrases.count() - 2


def test_positions_follow_the_length_of_the_utterance(full):
    split = freeze_split(full, "first")
    for part in ("train", "validation", "test"):
        lengths = [len(each.utterance) for each in split.examples.of(part, "paraphrased")]
        assert lengths == sorted(lengths)


def test_an_equal_seed_gives_the_same_split_and_another_seed_another(full):
    first, again = freeze_split(full, "first", seed=1), freeze_split(full, "again", seed=1)
    other = freeze_split(full, "other", seed=2)
    assert first.content_hash == again.content_hash != other.content_hash


def test_freezing_the_same_again_gives_the_split_that_is_there(full):
    first = freeze_split(full, "first", seed=1)
    assert freeze_split(full, "first", seed=1) == first


def test_a_name_that_is_taken_by_another_split_is_refused(full):
    freeze_split(full, "first", seed=1)
    before = Example.objects.count()
    with pytest.raises(LanguageError, match="first"):
        freeze_split(full, "first", seed=2)
    assert Example.objects.count() == before


def test_a_later_edit_never_changes_a_split(full):
    split = freeze_split(full, "first")
    before = list(split.examples.values())
    full.grammar.templates.all().delete()
    generate_pairs(full)
    full.paraphrases.all().delete()
    assert list(split.examples.values()) == before


def test_proportions_are_the_callers(full):
    split = freeze_split(full, "first", proportions=(0.5, 0.25, 0.25))
    sizes = [split.examples.of(part, "generated").count() for part in ("train", "validation")]
    total = full.commands.count()
    assert abs(sizes[0] - total / 2) <= 1
    assert abs(sizes[1] - total / 4) <= 1


@pytest.mark.parametrize(
    ("proportions", "said"),
    [((0.7, 0.1), r"\b2\b"), ((0.7, 0.1, 0.1), "90 %"), ((1.2, -0.1, -0.1), "-10 %")],
)
def test_shares_that_are_no_whole_are_refused(full, proportions, said):
    with pytest.raises(LanguageError, match=said):
        freeze_split(full, "first", proportions=proportions)


def test_an_empty_world_has_nothing_to_freeze(world):
    with pytest.raises(LanguageError):
        freeze_split(world, "first")
    assert not world.splits.exists()


def test_a_frozen_split_is_read_again_as_it_was_written(full, tmp_path):
    split = freeze_split(full, "first", "logical_form")
    export_split(split, "txt", tmp_path)
    assert not import_pairs("elsewhere", "copy", tmp_path).problems
    fields = ["source", "part", "position", "utterance", "logical_form"]
    copied = Example.objects.filter(split__name="copy-logical_form").values_list(*fields)
    assert list(copied) == list(split.examples.values_list(*fields))


def test_by_source_command_a_prompt_of_no_command_goes_to_training(full):
    """Its siblings may be told from it, but not the command that they all rewrite."""
    lost = full.paraphrases.order_by("position")[:12]
    for said in lost:
        full.paraphrases.filter(pk=said.pk).update(command=None, prompt=f"prompt {said.position}")
    split = freeze_split(full, "first", "source_command", seed=3)
    assert parts_by(split, "source_command")["prompt 0"] == {"train"}
    of_lost = split.examples.filter(utterance__in=[said.utterance for said in lost])
    assert set(of_lost.values_list("part", flat=True)) == {"train"}
    assert len(unresolved_prompts(as_items(split.examples.all()))) == 12
    by_command = freeze_split(full, "second", "command", seed=3)
    assert len({part for (part,) in by_command.examples.values_list("part")}) == 3


def test_without_generated_commands_prompts_are_what_there_is(full):
    full.paraphrases.update(command=None)
    full.commands.all().delete()
    split = freeze_split(full, "first", "source_command")
    assert set(split.examples.values_list("part", flat=True)) == {"train", "validation", "test"}


@pytest.fixture
def by_model(full):
    """Give some paraphrases of ``full`` to a language model, the others to a person; return the world."""
    campaign = full.campaigns.create(name="spring")
    model = campaign.contributors.create(kind=ContributorKind.MODEL, pseudonym="model")
    person = campaign.contributors.create(pseudonym="person")
    for row in Paraphrase.objects.all():
        row.contributor = model if row.utterance.startswith("please") else person
        row.save(update_fields=["contributor"])
    return full


def parts_of(split, source):
    return set(split.examples.filter(source=source).values_list("part", flat=True))


def test_what_a_language_model_wrote_is_trained_on_and_never_tested_on(by_model):
    split = freeze_split(by_model, "apart", "source_command")
    assert parts_of(split, "model") == {"train"}
    assert parts_of(split, "paraphrased") == {"train", "validation", "test"}
    people = split.examples.filter(source="paraphrased")
    assert people.count() == Paraphrase.objects.filter(contributor__kind="person").count()
    counts = {each.source: each for each in figures_of(split).counts}
    assert counts["model"].total == split.examples.filter(source="model").count() > 0
    positions = people.filter(part="test").values_list("position", flat=True)
    assert sorted(positions) == list(range(people.filter(part="test").count()))


def test_a_split_tests_on_models_where_it_asks_for_them_also_when_it_is_frozen_anew(by_model):
    split = freeze_split(by_model, "both", "source_command", tests_on_models=True)
    assert parts_of(split, "model") == {"train", "validation", "test"}
    written = Paraphrase.objects.filter(contributor__kind="model")
    assert split.examples.filter(source="model").count() == written.count()
    changed = written.first()
    changed.utterance += " now"
    changed.save()
    again = freeze_anew(split)
    assert again.tests_on_models
    assert parts_of(again, "model") == {"train", "validation", "test"}


def test_what_people_said_is_a_source_of_its_own(full):
    texts = ("give me a hand with that", "over here please", "that one", "the other one")
    forms = full.logical_forms.values_list("text", flat=True)
    for text, form in zip(texts, forms, strict=False):
        full.utterances.create(
            text=text, anonymized_text=text, status="labelled", logical_form=form
        )
    split = freeze_split(full, "said", proportions=(0.5, 0.25, 0.25))
    said = split.examples.filter(source="said")
    assert set(said.values_list("utterance", flat=True)) == set(texts)
    assert parts_of(split, "said") == {"train", "validation", "test"}


def test_a_split_that_calls_what_was_said_paraphrased_does_not_change_by_the_name(full):
    form = full.logical_forms.first().text
    full.utterances.create(text="over here", status="labelled", logical_form=form)
    split = freeze_split(full, "old")
    split.examples.filter(source="said").update(source="paraphrased", position=10_000)
    assert changes_since(split).is_none
