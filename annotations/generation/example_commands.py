"""Examples of what people can say in a world: commands of its own with entities of its own."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator

from django.db.models import Count, Exists, F, Max, Min, OuterRef, Window
from django.db.models.functions import RowNumber

from annotations.language.forms import CLASS_TOKEN, UNKNOWN, to_corpus
from annotations.models import Command, Entity, LogicalForm, World
from annotations.rows.kept import kept

_DIGITS = "0123456789"
MOST_WORDINGS = 20  # of a form that are looked at


def example_commands(world: World, how_many: int) -> list[str]:
    """Return at most ``how_many`` short commands with entities, each with another action first, the commonest first.

    The same on every call. A command with a class of which the world has no entity is left out, and so is one that says
    less than a robot needs, as "follow someone" does.
    """
    return [texts[0] for texts in _wordings(world, how_many, 1) if texts][:how_many]


def example_rewordings(world: World, how_many: int) -> list[tuple[str, str]]:
    """Return at most ``how_many`` such commands, each with another wording of the same form, where there is one."""
    wordings = _wordings(world, 2 * how_many, MOST_WORDINGS)
    return [(texts[0], texts[-1]) for texts in wordings if len(texts) > 1][:how_many]


def _wordings(world: World, how_many: int, most: int) -> Iterator[list[str]]:
    """Yield the ``most`` shortest commands of the shortest form of each action, those whose classes have entities."""
    shortest = kept(
        ("shortest forms", world.pk, world.revision, world.generations, how_many),
        lambda: _shortest_forms(world, 2 * how_many),
        lambda forms: sum(count for _, count in forms),
    )
    keys = [key for key, _ in shortest]
    of_form = Window(RowNumber(), partition_by=F("logical_form"), order_by=("length", "pk"))
    rows = Command.objects.filter(logical_form__in=keys).annotate(place=of_form)
    texts: defaultdict[int, list[str]] = defaultdict(list)
    for each in rows.filter(place__lte=most).order_by("place"):
        texts[each.logical_form_id].append(each.anonymized_text)
    classes = {each for some in texts.values() for text in some for each in _classes_in(text)}
    entities = _two_of_each_class(world, classes)
    for key in keys:
        known = (text for text in texts[key] if all(each in entities for each in _classes_in(text)))
        yield [_name_entities(text, entities) for text in known]


def _shortest_forms(world: World, how_many: int) -> list[tuple[int, int]]:
    """Return the key of the shortest form of each action with a command, and how many such forms there are; the
    commonest actions first."""
    has_command = Exists(Command.objects.filter(logical_form=OuterRef("pk")))
    forms = LogicalForm.objects.filter(has_command, world=world)
    forms = forms.exclude(text__contains=to_corpus(UNKNOWN))
    action = F("head_predicate")
    shortest_forms = (
        forms.annotate(
            place=Window(RowNumber(), partition_by=action, order_by=("length", "pk")),
            count=Window(Count("pk"), partition_by=action),
        )
        .filter(place=1)
        .order_by("-count", "head_predicate")
    )
    return [(each.pk, each.count) for each in shortest_forms[:how_many]]


def _classes_in(text: str) -> list[str]:
    return [token.rstrip(_DIGITS) for token in CLASS_TOKEN.findall(text)]


def _two_of_each_class(world: World, classes: set[str]) -> dict[str, list[str]]:
    """Return the texts of the first and the last entity of each class that has one."""
    rows = Entity.objects.filter(ontology__world=world, entity_class__in=classes)
    ends = rows.order_by().values("entity_class").annotate(first=Min("pk"), last=Max("pk"))
    keys = {key for each in ends for key in (each["first"], each["last"])}
    texts: defaultdict[str, list[str]] = defaultdict(list)
    for entity_class, text in rows.filter(pk__in=keys).values_list("entity_class", "text"):
        texts[entity_class].append(text)
    return dict(texts)


def _name_entities(text: str, entities: dict[str, list[str]]) -> str:
    """Return a command with entities for its class tokens, another one for the second of a class."""
    seen: defaultdict[str, int] = defaultdict(int)

    def name(token: re.Match[str]) -> str:
        entity_class = token[1].rstrip(_DIGITS)
        seen[entity_class] += 1
        texts = entities[entity_class]
        return texts[(seen[entity_class] - 1) % len(texts)]

    return CLASS_TOKEN.sub(name, text).replace(" ,", ",")
