"""Labels that may be wrong: answers of parsers that did not see them, and the checks of the language core."""

from parser_service.audit.auditing import audit_labels
from parser_service.audit.out_of_fold import AUDITORS

__all__ = ["AUDITORS", "audit_labels"]
