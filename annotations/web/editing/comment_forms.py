"""The forms of a comment, and how many of them somebody may write."""

from __future__ import annotations

from django import forms

from annotations.models.editing import MOST_CHARACTERS_OF_COMMENT
from annotations.people.rate_limits import Rate

COMMENTS = Rate("comments", limit=60, seconds=600)
TOO_MANY = "That were many comments. Wait some minutes, then send again."


class CommentForm(forms.Form):
    """What somebody says about a row."""

    text = forms.CharField(
        label="Your comment",
        max_length=MOST_CHARACTERS_OF_COMMENT,
        widget=forms.Textarea(attrs={"rows": 3}),
        help_text="Write @name to reach a member of this world.",
    )


class CommentEditForm(CommentForm):
    """The new text of a comment. ``version`` is the one that was edited."""

    version = forms.IntegerField(min_value=1, widget=forms.HiddenInput)
