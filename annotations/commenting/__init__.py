"""Comments on the rows of a world, mentions of its members, and their inboxes."""

from annotations.commenting.comments import add_comment, comments_on, mark_read, people_of
from annotations.commenting.subjects import SUBJECTS, Subject

__all__ = [
    "SUBJECTS",
    "Subject",
    "add_comment",
    "comments_on",
    "mark_read",
    "people_of",
]
