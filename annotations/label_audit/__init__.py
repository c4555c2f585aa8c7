"""Verbs: store what an audit finds, doubt a label, decide whether a label is right, take a decision back.

Findings come from ``parser_service.label_audit``. ``store_findings`` keeps what people have decided before;
``decide`` keeps, corrects or excludes a pair and ends its item in the work queue, and ``end_item`` does
the same for somebody who ends the item. ``correct_label`` needs no audit.
"""
