"""Plans, names of actions and words from dialogues over REST."""

from __future__ import annotations

import jsonschema

from annotations.language.plans import Offer, plan_schema
from annotations.models import ApiToken, Entity
from parser_service.serving.entity_offers import offer
from tests.annotations.language.plans.xml_schema import xml_schema
from tests.parser_service.served import make_home

WORLD = "/api/v1/worlds/home/"
FORM = '( bring ( lambda $1 e ( is_a $1 " red cup " ) ( at $1 " desk " ) ) )'


def test_a_form_becomes_a_plan_as_json_and_as_a_behaviour_tree(world, call, reviewer):
    make_home(world)
    plan = call(reviewer, f"{WORLD}plan/", {"form": FORM}, scope="read").json()
    jsonschema.validate(plan, plan_schema())
    assert plan["is_executable"] and plan["steps"][0]["action"] == "bring"
    tree = call(reviewer, f"{WORLD}plan/", {"form": FORM, "as": "xml"}, scope="read")
    assert tree["Content-Type"] == "application/xml"
    xml_schema().validate(tree.content.decode())
    bad = call(reviewer, f"{WORLD}plan/", {"form": "( bring"}, scope="read")
    assert bad.status_code == 400 and bad.json()["problems"][0]["field"] == "form"


def test_names_of_actions_are_replaced_as_a_whole(world, client, call, annotator):
    make_home(world)
    _, key = ApiToken.issue(annotator, "robot", scope="annotate")
    address = f"{WORLD}robot/action-names/"

    def put(version, **names):
        body = {"version": version, "names": names}
        headers = {"authorization": f"Bearer {key}"}
        return client.post(address, body, content_type="application/json", headers=headers)

    assert call(annotator, address).json() == {"version": 0, "names": {}}
    fetch = {"name": "Fetch", "arguments": "thing=object"}
    assert put(0, bring=fetch).json() == {"version": 1, "names": {"bring": fetch}}
    assert put(0, bring=fetch).status_code == 409
    assert "“no name”" in put(1, bring={"name": "no name"}).json()["detail"]
    step = call(annotator, f"{WORLD}plan/", {"form": FORM}).json()["steps"][0]
    assert (step["action"], list(step["arguments"])) == ("Fetch", ["object"])
    assert put(1).json() == {"version": 2, "names": {}}


def test_words_from_dialogues_are_decided_once(world, call, annotator, reviewer):
    make_home(world)
    row = offer(world, Offer("object", "flurb"), "bring me the flurb")
    (listed,) = call(reviewer, f"{WORLD}offered-entities/").json()["results"]
    assert (listed["text"], listed["state"]) == ("flurb", "waiting")
    address = f"{WORLD}offered-entities/{row.pk}/decide/"
    assert call(reviewer, address, {"decision": "confirm"}).status_code == 403
    decided = call(annotator, address, {"decision": "confirm"}).json()
    assert (decided["state"], decided["decided_by"]) == ("confirmed", annotator.username)
    assert Entity.objects.filter(text="flurb").exists()
    assert call(annotator, address, {"decision": "refuse"}).status_code == 409
