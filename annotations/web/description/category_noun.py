"""The task categories of a grammar."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.generation.category_uses import count_alone
from annotations.models import TaskCategory, World
from annotations.people.access import WorldRequest
from annotations.rows.composition import plain_name, rule_files
from annotations.web.description.category_forms import TaskCategoryForm, categories_of
from annotations.web.editing.nouns import Noun


class TaskCategoryNoun(Noun):
    form = TaskCategoryForm
    template = "annotations/description/task_category.html"

    def context(
        self, request: WorldRequest, world: World, row: TaskCategory | None, form: TaskCategoryForm
    ) -> Mapping[str, Any]:
        """Return what the category alone is made of, and whether there are sets to choose from."""
        known = [*categories_of(world)]
        templates = {each for category in known for each in category.template_sources}
        has_choice = len(rule_files(known)) > 1 or len(templates) > 1 or form.errors
        return {
            "alone": count_alone(row) if row else {},
            "shows_sets": bool(row) or bool(has_choice),
            "rule_sets": [plain_name(each) for each in rule_files(known)],
            "template_sets": sorted(map(plain_name, templates)),
        }


TASK_CATEGORIES = TaskCategoryNoun()
