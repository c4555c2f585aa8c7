"""What a comment said at each of its versions, and how they differ."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise

from annotations.models import Comment
from annotations.presentation import Pieces, compare


@dataclass(frozen=True, slots=True)
class CommentVersion:
    """``pieces`` mark what is other than in the version before."""

    number: int
    text: str
    written_at: datetime
    pieces: Pieces


def versions_of(comment: Comment) -> list[CommentVersion]:
    """Return the versions of ``comment``, the newest first."""
    texts = [(each.text, each.written_at) for each in comment.earlier_texts.all()]
    texts.append((comment.text, comment.edited_at or comment.created_at))
    first, at = texts[0]
    versions = [CommentVersion(1, first, at, [("same", first)])]
    for (before, _), (text, moment) in pairwise(texts):
        _, pieces = compare(before, text, False)
        versions.append(CommentVersion(len(versions) + 1, text, moment, pieces))
    return versions[::-1]
