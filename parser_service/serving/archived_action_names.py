"""What an archive of a world holds of its robot: the names of actions."""

from __future__ import annotations

from typing import Any

from annotations.exchange.archive_tables import ArchiveTable
from parser_service.models import ActionNames
from parser_service.serving.action_naming import is_name


def are_names(value: Any) -> bool:
    """Return whether ``value`` is what ``ActionNames.names`` holds: action → its name, and arguments by name."""
    return isinstance(value, dict) and all(_is_named(*each) for each in value.items())


def _is_named(action: str, value: Any) -> bool:
    if not isinstance(value, dict) or value.keys() != {"name", "arguments"}:
        return False
    name, arguments = value["name"], value["arguments"]
    if not isinstance(arguments, dict) or not isinstance(name, str):
        return False
    texts = list(arguments.values())
    has_names = all(isinstance(each, str) and is_name(each) for each in texts)
    # An action of which only arguments are renamed keeps its own name, whatever that is.
    return has_names and len(set(texts)) == len(texts) and (name == action or is_name(name))


ACTION_NAMES = ArchiveTable(
    "action_names", ActionNames, "world", people=("changed_by",), shapes={"names": are_names}
)
