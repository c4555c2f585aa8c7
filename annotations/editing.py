"""Verb: change a template. Nobody's work is overwritten unseen."""

from __future__ import annotations

from django.db import transaction
from django.db.models import F, Max

from annotations.models import SemanticTemplate, TaskCategory, User


class Overtaken(Exception):
    """Somebody saved the template in the meantime; ``current`` is what it says now."""

    def __init__(self, current: SemanticTemplate):
        super().__init__(
            f"{current.author or 'Somebody'} has saved version {current.version} in the meantime. "
            "Compare it with yours below, then save again."
        )
        self.current = current


def add_template(
    category: TaskCategory, pattern: str, form: str, status: str, by: User
) -> SemanticTemplate:
    """A new template at the end of the set that ``category`` calls its own."""
    with transaction.atomic():
        rows = SemanticTemplate.objects.select_for_update().filter(grammar=category.grammar)
        last = rows.aggregate(last=Max("position"))["last"]
        return SemanticTemplate.objects.create(
            grammar=category.grammar,
            source=category.template_sources[-1],
            task_category=category.name,
            pattern=pattern,
            form=form,
            status=status,
            author=by,
            position=0 if last is None else last + 1,
        )


def change_template(
    template: SemanticTemplate, pattern: str, form: str, status: str, by: User, version: int
) -> SemanticTemplate:
    """The next version of ``template``, which ``by`` edited while it was at ``version``.

    Raises Overtaken where it is at another one by now; nothing is changed then.
    """
    rows = SemanticTemplate.objects.filter(pk=template.pk, version=version)
    values = {"pattern": pattern, "form": form, "status": status, "author": by}
    is_saved = rows.update(**values, version=F("version") + 1)
    template.refresh_from_db()
    if not is_saved:
        raise Overtaken(template)
    return template
