"""Store the classes of a household in worlds that have used them without a row of their own."""

from typing import Any

from django.db import migrations

# As they were, in order: token, singular, plural, hue, said, is_closed.
CLASSES = (
    ("object", "object", "objects", 52, "object", False),
    ("category", "category", "categories", 95, "category", False),
    ("name", "name", "names", 8, "name", False),
    ("location", "location", "locations", 190, "location", False),
    ("room", "room", "rooms", 145, "room", False),
    ("gesture", "gesture", "gestures", 328, "gesture", True),
    ("question", "question", "questions", 292, "question", True),
    ("whattosay", "saying", "sayings", 238, "sentence", True),
)
COLUMNS = ("token", "singular", "plural", "hue", "said", "is_closed")


def store(apps: Any, editor: Any) -> None:
    """Add what is missing in front, where it was read until now."""
    rows = apps.get_model("annotations", "EntityClass").objects
    for world in apps.get_model("annotations", "World").objects.iterator():
        own = list(rows.filter(world=world).order_by("position"))
        tokens = {row.token for row in own}
        missing = [values for values in CLASSES if values[0] not in tokens]
        if not missing:
            continue
        for row in reversed(own):  # the last first: no position is taken twice in between
            row.position += len(CLASSES)
            row.save(update_fields=["position"])
        for position, values in enumerate(missing):
            rows.create(world=world, position=position, **dict(zip(COLUMNS, values, strict=True)))


class Migration(migrations.Migration):
    dependencies = [("annotations", "0049_task_categories_are_edited")]

    operations = [migrations.RunPython(store, migrations.RunPython.noop, elidable=True)]
