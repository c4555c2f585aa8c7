"""Comments on the rows of a world, mentions of its members, and their inboxes."""

from annotations.commenting.changing import (
    EditedElsewhere,
    change_comment,
    delete_comment,
    restore_comment,
)
from annotations.commenting.comments import add_comment, comments_on, mark_read, people_of
from annotations.commenting.subjects import SUBJECTS

__all__ = [
    "SUBJECTS",
    "EditedElsewhere",
    "add_comment",
    "change_comment",
    "comments_on",
    "delete_comment",
    "mark_read",
    "people_of",
    "restore_comment",
]
