"""Labels that may be wrong: answers of parsers that did not see them, and the checks of the language core."""

from parser_service.audit.auditing import Audit, audit_labels
from parser_service.audit.out_of_fold import AUDITORS, answer_out_of_fold

__all__ = ["AUDITORS", "Audit", "answer_out_of_fold", "audit_labels"]
