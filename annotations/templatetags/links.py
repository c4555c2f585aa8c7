"""What pages say of the links that they give."""

from __future__ import annotations

from django import template

from annotations.people.local_names import is_local_link

register = template.Library()
register.filter("is_local_link", is_local_link)
