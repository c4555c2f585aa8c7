"""Which entities a prompt names, so that a rewrite can be checked for them."""

from __future__ import annotations

from annotations.language.corpus.rewrite_checks import Named, lost_entities
from annotations.language.forms import Constant, Form, walk
from annotations.language.grounding import Grounded
from annotations.language.world import Entity, Ontology


def entities_of(grounded: Grounded, ontology: Ontology) -> tuple[Named, ...]:
    """Return what ``grounded.text`` names, in the order of its wildcards, each once.

    An obfuscated entity is called by its category or its room. What the text does not say, such as the
    question that a person asks, is left out.
    """
    named = (
        _as_named(wildcard.entity_class, entity, grounded.text, ontology)
        for wildcard, entity in grounded.values
    )
    return tuple(dict.fromkeys(each for each in named if each is not None))


def entities_in(prompt: str, form: Form, ontology: Ontology) -> tuple[Named, ...]:
    """Return the constants of a grounded form that ``prompt`` names, each once: for prompts from elsewhere.

    Those that the ontology has as well have its other names.
    """
    texts = (each.value for each in walk(form) if isinstance(each, Constant))
    entities = {each.text: each for each in reversed(ontology.entities)}
    named = []
    for text in dict.fromkeys(each for each in texts if isinstance(each, str)):
        entity = entities.get(text)
        is_described = entity is not None and ontology.classes.is_closed(entity.entity_class)
        aliases = entity.aliases if entity else ()
        if not lost_entities(prompt, [Named(text, aliases)]):
            named.append(Named(text, aliases, is_described))
    return tuple(named)


def _as_named(entity_class: str, entity: Entity, text: str, ontology: Ontology) -> Named | None:
    is_described = ontology.classes.is_closed(entity_class)
    whole = Named(entity.text, entity.aliases, is_described)
    category = entity.attribute("category")
    vague = (category and ontology.singular(category), entity.attribute("room"))
    for named in (whole, *(Named(name) for name in vague if name)):
        # A description counts as said only where the prompt has all of it.
        if not lost_entities(text, [Named(named.text)]):
            return named
    return None
