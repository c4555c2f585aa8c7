"""A greenhouse: a world with other classes, actions and descriptions than a household, and none of its words."""

from __future__ import annotations

from annotations.exchange.generator_import import import_generator
from annotations.language.forms import EntityClass, EntityClasses
from annotations.language.world import (
    Entity,
    Ontology,
    Predicate,
    PredicateKind,
    read_signatures,
)
from annotations.models import World

CLASSES = EntityClasses(
    tuple(
        EntityClass(each, each, f"{each}s", hue, each)
        for each, hue in (("plant", 140), ("bed", 50), ("tool", 20))
    )
)
ONTOLOGY = Ontology(
    (
        *(Entity("plant", each) for each in ("basil", "tomato")),
        *(Entity("bed", each) for each in ("first bed", "last bed")),
        *(Entity("tool", each) for each in ("hose", "shears")),
    ),
    CLASSES,
)
# Name → kind, signatures and gloss; an empty gloss is made of the name.
_ROWS = {
    "water": ("action", "(plant, bed?)\n(lambda)", "water {1} | water {1} in {2}"),
    "prune": ("action", "(plant, tool?)", ""),
    "scan_shelf": ("action", "(bed)", "scan the shelf of {1}"),
    "fetch": ("action", "(tool)", "fetch me {1}"),
    "measure": ("action", "(plant)", "measure {1} | = the height of {1}"),
    "report": ("action", "(form)", "tell me {1}"),
    "grows": ("description", "(variable, plant)", "{2}"),
    "stands_in": ("description", "(variable, bed)", "_ in {2}"),
}
PREDICATES = {
    name: Predicate(name, PredicateKind(kind), read_signatures(signatures, CLASSES), said)
    for name, (kind, signatures, said) in _ROWS.items()
}
FILES = {
    "classes.xml": "<classes>"
    + "".join(
        f'<class token="{each.token}" singular="{each.singular}" plural="{each.plural}" '
        f'hue="{each.hue}" said="{each.said}"/>'
        for each in CLASSES
    )
    + "</classes>",
    "entities.xml": "<entities>"
    + "".join(f'<{each.entity_class} name="{each.text}"/>' for each in ONTOLOGY.entities)
    + "</entities>",
    "green_category_1_grammar.txt": (
        "; grammar name Green\n"
        "$Main = water the {plant} | water the {plant} in the {bed}\n"
        "$Main = prune the {plant} with the {tool} | fetch me the {tool}\n"
        "$Main = scan the shelf of the {bed}\n"
    ),
    "green_category_1_semantics.txt": (
        "water the {plant} = (water {plant})\n"
        "water the {plant} in the {bed} = (water {plant} {bed})\n"
        "prune the {plant} with the {tool} = (prune {plant} {tool})\n"
        "fetch me the {tool} = (fetch {tool})\n"
        "scan the shelf of the {bed} = (scan_shelf {bed})\n"
    ),
}


def fill_greenhouse(world: World) -> World:
    """Import the grammar, the entities and the commands of the greenhouse."""
    files = {name: text.encode() for name, text in FILES.items()}
    assert not import_generator(world.name, files).is_refused
    return world
