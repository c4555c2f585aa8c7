"""What an archive of a world holds of what answers in it: the choice of its parts."""

from __future__ import annotations

from annotations.exchange.archive_tables import ArchiveTable
from parser_service.models import Answering

ANSWERING = ArchiveTable("answering", Answering, "world", people=("changed_by",))
