"""The pages of single rows lead to each other; a row of another world has no page."""

from __future__ import annotations

import pytest

from annotations.generation.freezing import freeze_split
from annotations.models import Command, Entity, Example, Paraphrase


@pytest.fixture
def command(sample) -> Command:
    return sample.world.commands.get(anonymized_text="find the <object>")


@pytest.fixture
def paraphrase(sample, command) -> Paraphrase:
    return Paraphrase.objects.create(
        world=sample.world,
        command=command,
        prompt="find the tea",
        utterance="where is the tea",
        grounded_form='( find ( lambda $1 e ( is_a $1 " tea " ) ) )',
        logical_form=command.logical_form.text,
        edit_distance=9,
        jaccard_distance=0.5,
        position=0,
    )


@pytest.fixture
def example(sample, paraphrase) -> Example:
    split = freeze_split(sample.world, "mine", proportions=(1, 0, 0))
    return split.examples.get(utterance=paraphrase.utterance)


@pytest.fixture
def links(sample, command, paraphrase, example) -> dict[str, str]:
    """Kind of row → the address of its page."""
    entity = Entity.objects.get(text="tea")
    return {
        "command": f"/w/home/commands/{command.pk}/",
        "template": f"/w/home/templates/{command.template_id}/",
        "form": f"/w/home/forms/{command.logical_form_id}/",
        "paraphrase": f"/w/home/paraphrases/{paraphrase.pk}/",
        "example": f"/w/home/splits/{example.split_id}/examples/{example.pk}/",
        "entity": f"/w/home/ontology/{entity.pk}/",
    }


LEADS_TO = [
    ("command", ["template", "form", "paraphrase"]),
    ("form", ["command", "paraphrase"]),
    ("paraphrase", ["command", "form", "example"]),
    ("example", ["command", "paraphrase", "form"]),
    ("entity", ["paraphrase"]),
]


@pytest.mark.parametrize(("kind", "others"), LEADS_TO)
def test_a_page_leads_to_what_belongs_to_it(kind, others, links, anna):
    page = anna.get(links[kind]).content.decode()
    missing = [other for other in others if f'href="{links[other]}"' not in page]
    assert not missing


LISTED = [
    ("commands", "command"),
    ("templates", "template"),
    ("forms", "form"),
    ("paraphrases", "paraphrase"),
    ("ontology", "entity"),
]


@pytest.mark.parametrize(("path", "kind"), LISTED)
def test_a_list_leads_to_the_page_of_each_row(path, kind, links, anna):
    assert f'href="{links[kind]}"' in anna.get(f"/w/home/{path}/").content.decode()


def test_a_split_leads_to_its_examples(links, example, anna):
    page = anna.get(f"/w/home/splits/{example.split_id}/").content.decode()
    assert f'href="{links["example"]}"' in page


def test_a_template_leads_to_its_commands_and_productions(links, command, anna):
    page = anna.get(links["template"]).content.decode()
    assert f'href="/w/home/commands/?template={command.template_id}"' in page
    assert 'href="/w/home/grammar/?task_category=1"' in page


@pytest.mark.parametrize("kind", ["form", "template"])
def test_a_form_leads_to_its_predicates_and_they_lead_back(kind, links, sample, anna):
    page = anna.get(links[kind]).content.decode()
    find = sample.world.predicates.get(name="find")
    assert f'href="/w/home/predicates/{find.pk}/"' in page
    back = anna.get(f"/w/home/predicates/{find.pk}/").content.decode()
    assert 'href="/w/home/forms/?mentions=find"' in back
    assert links["form"] in anna.get("/w/home/forms/?mentions=find").content.decode()


@pytest.mark.parametrize("path", ["", "{entity}/"])
def test_an_attribute_leads_to_what_it_names(path, links, sample, anna):
    sink = Entity.objects.filter(text="sink", attributes__room="kitchen").get()
    page = anna.get(f"/w/home/ontology/{path.format(entity=sink.pk)}").content.decode()
    address = "/w/home/ontology/?entity_class=room&amp;q=kitchen"
    assert f'href="{address}"' in page
    (room,) = anna.get(address.replace("&amp;", "&")).context["listing"].rows
    assert (room.entity_class, room.text) == ("room", "kitchen")


def test_a_row_of_another_world_has_no_page(links, other_world, stranger, client):
    client.force_login(stranger)
    for link in links.values():
        assert client.get(link.replace("/w/home/", "/w/laboratory/")).status_code == 404
