"""First steps: a list for each beginning, in order, ticked by what is true; closed and found again."""

from __future__ import annotations

import pytest

from annotations.campaigns.answering import save_answer
from annotations.campaigns.tasks import begin
from annotations.models import Entity, Grammar, Ontology, Production, TaskCategory
from annotations.models.worlds import DUTIES, Role
from gpsr_site.overview.counts import counts_of
from gpsr_site.overview.first_steps import Beginning, beginning_of, first_steps
from tests.launched_campaigns import fill_household
from tests.replaying import made_once


def names_of(world, role=Role.ADMIN):
    return [
        each.name
        for each in first_steps(world, beginning_of(world), counts_of(world), DUTIES[role])
    ]


def test_an_empty_world_says_what_to_do_first_in_order(world, adam, rene):
    steps = first_steps(world, beginning_of(world), counts_of(world), DUTIES[Role.ADMIN])
    assert names_of(world)[:3] == ["by_example", "import", "entity_new"]
    assert [step.name for step in steps if step.is_next] == ["by_example"]
    page = adam.get("/w/home/").content.decode()
    assert 'class="first-steps"' in page and 'href="/w/home/import/"' in page
    theirs = rene.get("/w/home/").content.decode()
    assert 'class="is-next"' in theirs and 'href="/w/home/ontology/new/"' not in theirs


@pytest.mark.parametrize(
    "source, beginning",
    [
        ("category_2025_grammar.txt", Beginning.COMPETITION),
        ("common_rules.txt as $common", Beginning.STARTER),
        ("general_grammar.txt", Beginning.WRITTEN),
    ],
)
def test_each_beginning_has_its_own_list(world, source, beginning):
    grammar, _ = Grammar.objects.get_or_create(world=world)
    TaskCategory.objects.create(grammar=grammar, name="one", position=0, rule_sources=[source])
    assert beginning_of(world) == beginning
    if beginning == Beginning.WRITTEN:
        Production.objects.create(
            grammar=grammar, nonterminal="Main", expansion="stop", line=1, position=1_000
        )
        assert beginning_of(world) == Beginning.FILES
    names = names_of(world)
    assert len(set(names)) == len(names) and {"playground", "robot", "people"} <= set(names)


def test_a_competition_wants_its_folder_then_rooms(world):
    grammar, _ = Grammar.objects.get_or_create(world=world)
    TaskCategory.objects.create(
        grammar=grammar, name="2025", position=0, rule_sources=["category_2025_grammar.txt"]
    )

    def next_step():
        steps = first_steps(world, beginning_of(world), counts_of(world), DUTIES[Role.ADMIN])
        return next(each.name for each in steps if each.is_next)

    assert next_step() == "import_competition"
    ontology, _ = Ontology.objects.get_or_create(world=world)
    Entity.objects.all().delete()
    sofa = Entity.objects.create(
        ontology=ontology,
        entity_class="location",
        text="sofa",
        source="maps/location_names.md",
        position=0,
    )
    assert next_step() == "location_rooms"
    sofa.attributes = {"room": "lounge"}
    sofa.save()
    Entity.objects.create(
        ontology=ontology, entity_class="location", text="desk", source=sofa.source, position=1
    )
    assert next_step() == "generate"  # where the desk is, nobody may know


def test_first_steps_close_with_the_first_score_and_come_back(sample, adam):
    def is_shown():
        return 'class="first-steps"' in adam.get("/w/home/").content.decode()

    assert not is_shown()
    assert adam.post("/w/home/first-steps/", {"open": ""}).status_code == 302
    assert is_shown()
    adam.post("/w/home/first-steps/", {"close": ""})
    assert not is_shown()


def test_people_are_invited_at_any_time_and_nothing_waits_for_it(world, admin, client):
    world.memberships.exclude(user=admin).delete()
    counts, duties = counts_of(world), DUTIES[Role.ADMIN]
    steps = first_steps(world, beginning_of(world), counts, duties)
    (people,) = [step for step in steps if step.name == "people"]
    assert (people.is_ready, people.is_next, people.is_done) == (True, False, False)
    client.force_login(admin)
    assert 'href="/w/home/people/"' in client.get("/w/home/").content.decode().partition("<main")[2]


def test_a_campaign_of_ten_tasks_is_one_press_and_the_steps_go_on(world, adam):
    household = made_once(fill_household, world)

    def step_to_paraphrases():
        steps = first_steps(household, Beginning.FILES, counts_of(household), DUTIES[Role.ADMIN])
        names = {"campaign_new", "campaigns", "submissions"}
        return next((each.name, each.sends) for each in steps if each.name in names)

    assert household.commands.exists() and not household.paraphrases.exists()
    assert step_to_paraphrases() == ("campaign_new", "ten_tasks")
    for page in ("", "commands/"):
        assert 'name="ten_tasks"' in adam.get(f"/w/home/{page}").content.decode()
    answer = adam.post("/w/home/campaigns/new/", {"ten_tasks": ""})
    again = adam.post("/w/home/campaigns/new/", {"ten_tasks": ""})
    assert again.url == "/w/home/campaigns/"
    campaign = household.campaigns.get()
    assert answer.url == f"/w/home/campaigns/{campaign.pk}/"
    assert 0 < campaign.prompts.count() <= 120
    assert campaign.most_submissions == 10 * (campaign.task_size + campaign.free_commands)
    assert f"/p/{campaign.key}/" in adam.get(answer.url).content.decode()
    assert 'name="ten_tasks"' not in adam.get("/w/home/commands/").content.decode()
    assert step_to_paraphrases() == ("campaigns", "")
    task = begin(campaign, "somebody")
    save_answer(task.submissions.first(), "would you please do what I have just asked for")
    assert step_to_paraphrases() == ("submissions", "")
