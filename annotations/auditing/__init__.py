"""Verbs: store what an audit finds, doubt a label, decide whether a label is right, take a decision back.

Findings come from ``parser_service.audit``. ``store_findings`` keeps what people have decided before;
``decide`` keeps, corrects or excludes a pair and ends its item in the work queue, and ``end_item`` does
the same for somebody who ends the item. ``correct_label`` needs no audit.
"""

from annotations.auditing.correcting import correct_label
from annotations.auditing.deciding import DecidedMeanwhile, decide, take_back
from annotations.auditing.doubting import doubt
from annotations.auditing.items import end_item
from annotations.auditing.pairs import examples_before
from annotations.auditing.storing import FoundPair, store_findings

__all__ = [
    "DecidedMeanwhile",
    "FoundPair",
    "correct_label",
    "decide",
    "doubt",
    "end_item",
    "examples_before",
    "store_findings",
    "take_back",
]
