"""What people hold in the work queue and may not do any more is free for others."""

from __future__ import annotations

from django.db import migrations

# As roles and kinds of work are when this is written: admins and annotators do all, reviewers these.
DOES_ALL = ("annotator", "admin")
OF_REVIEWERS = ("adjudication", "audit")


def release(apps, schema_editor):
    alias = schema_editor.connection.alias
    Assignment = apps.get_model("annotations", "Assignment")
    Membership = apps.get_model("annotations", "Membership")
    roles = {}
    for world, user, role in Membership.objects.using(alias).values_list("world", "user", "role"):
        roles.setdefault((world, user), set()).add(role)
    held = Assignment.objects.using(alias).filter(outcome="held").select_related("item", "person")
    for part in held.iterator():
        of_person = roles.get((part.item.world_id, part.person_id), set())
        if part.person is not None and part.person.is_active:
            if part.person.is_superuser or of_person.intersection(DOES_ALL):
                continue
            if "reviewer" in of_person and part.item.kind in OF_REVIEWERS:
                continue
        part.outcome, part.leased_until = "returned", None
        part.save(update_fields=["outcome", "leased_until"])
        # Read anew: an item may have two parts.
        item = type(part.item)._default_manager.using(alias).get(pk=part.item_id)
        item.places += 1
        item.save(update_fields=["places"])


class Migration(migrations.Migration):
    dependencies = [("annotations", "0030_uploads_and_deleted_utterances")]

    operations = [migrations.RunPython(release, migrations.RunPython.noop)]
