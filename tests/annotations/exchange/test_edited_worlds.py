"""Whatever people make of a world, its archive makes the same world again."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from annotations.exchange.generator_import import import_generator
from annotations.exchange.world_deletion import delete_world
from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.language.texts.text import normalise_line
from annotations.models import Paraphrase, SemanticTemplate, World
from tests.annotations.conftest import TINY, as_bytes
from tests.annotations.exchange.packing import same_again

# As every entrance lets them in; what an import does with other texts, test_row_texts.py asks.
_WRITTEN = st.text(st.characters(codec="utf-8", exclude_characters="\0"), min_size=1, max_size=12)
WORDS = _WRITTEN.map(normalise_line).filter(bool)


@st.composite
def edits(draw):
    """What people may make of the tiny world."""
    return {
        "patterns": draw(st.lists(WORDS, max_size=3)),
        "status": draw(st.sampled_from(["draft", "ready", "disputed"])),
        "entity": draw(WORDS),
        "attributes": draw(st.dictionaries(WORDS, WORDS, max_size=2)),
        "gloss": draw(WORDS),
        "utterances": draw(st.lists(WORDS, max_size=4)),
        "description": draw(WORDS),
        "is_generated": draw(st.booleans()),
        "is_split": draw(st.booleans()),
        "has_detached": draw(st.booleans()),
    }


@settings(
    max_examples=25,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
@given(edit=edits())
def test_any_edited_world(db, edit):
    world = edited_world(edit)
    try:
        same_again(world)
    finally:
        for each in World.objects.all():
            delete_world(each)


def edited_world(edit) -> World:
    import_generator("edited", as_bytes(TINY))
    world = World.objects.get(name="edited")
    World.objects.filter(pk=world.pk).update(description=edit["description"])
    if edit["is_generated"]:
        generate_pairs(world)
    for pattern in edit["patterns"]:
        add_draft(world, pattern)
    world.grammar.templates.filter(pattern__startswith="go").update(status=edit["status"])
    world.ontology.entities.filter(text="tea").update(
        text=edit["entity"], attributes=edit["attributes"], aliases=[edit["gloss"]]
    )
    world.predicates.filter(name="go").update(gloss=edit["gloss"], is_edited=True)
    for position, utterance in enumerate(edit["utterances"]):
        add_paraphrase(world, utterance, position, edit["has_detached"])
    if edit["is_split"] and world.commands.exists():
        freeze_split(world, "frozen", seed=3)
    return world


def add_draft(world: World, pattern: str) -> None:
    last = world.grammar.templates.count()
    SemanticTemplate.objects.create(
        grammar=world.grammar,
        source="tiny_category_1_semantics.txt",
        pattern=pattern,
        form=pattern,
        status="draft",
        position=last,
        version=2,
    )


def add_paraphrase(world: World, utterance: str, position: int, is_detached: bool) -> None:
    Paraphrase.objects.create(
        world=world,
        command=None if is_detached else world.commands.first(),
        prompt="go to the bath",
        utterance=utterance,
        grounded_form='( go " bath " )',
        logical_form='( go " <room> " )',
        edit_distance=position,
        jaccard_distance=1 / 3,
        status=["pending", "accepted", "rejected"][position % 3],
        position=position,
    )
