"""What the robot of a world calls its actions, and the schemas of the plans that it gets."""

from __future__ import annotations

from dataclasses import dataclass

from django.contrib import messages
from django.http import Http404, HttpResponse, QueryDict
from django.shortcuts import redirect, render

from annotations.language.plans import (
    ActionName,
    behavior_tree_schema_text,
    joint_plan_schema_text,
    plan_schema_text,
    task_plan_schema_text,
)
from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.showing.paging import number_in
from parser_service.serving.action_naming import (
    actions_of,
    names_of,
    read_name,
    store_names,
    version_of,
    write_arguments,
)

SCHEMAS = {
    "plan.schema.json": ("application/schema+json", plan_schema_text),
    "task_plan.schema.json": ("application/schema+json", task_plan_schema_text),
    "joint_plan.schema.json": ("application/schema+json", joint_plan_schema_text),
    "behavior_tree.xsd": ("application/xml", behavior_tree_schema_text),
}


@dataclass(frozen=True, slots=True)
class ActionRow:
    """A line of the page: an action, what was written for it, and what is wrong with that, either the name or
    the arguments."""

    action: str
    name: str
    arguments: str
    trouble: str = ""
    is_name_wrong: bool = False


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE, does="name actions")
def robot(request: WorldRequest, world: World) -> HttpResponse:
    """Show the names of the actions; annotators change them, all at once."""
    actions, version = actions_of(world), version_of(world)
    trouble = ""
    if request.method == "POST":
        rows, names = _read(actions, request.POST)
        if not any(row.trouble for row in rows):
            try:
                store_names(world, names, request.user, number_in(request.POST.get("version", "")))
                messages.success(request, "Saved. Plans have these names from now on.")
                return redirect("robot", world=world.name)
            except Refusal as error:
                trouble = error.message
    else:
        names = names_of(world)
        rows = [
            ActionRow(action, name.name if name.name != action else "", write_arguments(name))
            if (name := names.get(action))
            else ActionRow(action, "", "")
            for action in actions
        ]
    has_trouble = bool(trouble) or any(row.trouble for row in rows)
    context = {"rows": rows, "version": version, "trouble": trouble, "schemas": list(SCHEMAS)}
    return render(
        request, "parser_service/serving/robot.html", context, status=422 if has_trouble else 200
    )


@world_view(Duty.VIEW)
def plan_schema_file(request: WorldRequest, world: World, name: str) -> HttpResponse:
    """Return a schema of plans as a file."""
    if name not in SCHEMAS:
        raise Http404("There is no such schema.")
    kind, read = SCHEMAS[name]
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return HttpResponse(read(), content_type=f"{kind}; charset=utf-8", headers=headers)


def _read(actions: list[str], sent: QueryDict) -> tuple[list[ActionRow], dict[str, ActionName]]:
    """Return the lines as they were written, and the names of those without trouble."""
    rows: list[ActionRow] = []
    names: dict[str, ActionName] = {}
    for action in actions:
        name, arguments = sent.get(f"name {action}", ""), sent.get(f"arguments {action}", "")
        try:
            value = read_name(action, name, arguments)
        except Refusal as error:
            rows.append(
                ActionRow(action, name, arguments, error.message, not _can_be(action, name))
            )
            continue
        rows.append(ActionRow(action, name, arguments))
        if value is not None:
            names[action] = value
    return rows, names


def _can_be(action: str, name: str) -> bool:
    try:
        read_name(action, name, "")
    except Refusal:
        return False
    return True
