"""The REST API and its description."""

from __future__ import annotations

REST_FRAMEWORK = {
    "DEFAULT_AUTHENTICATION_CLASSES": [
        "annotations.api.authentication.TokenAuthentication",
        "rest_framework.authentication.SessionAuthentication",
    ],
    "DEFAULT_PARSER_CLASSES": [
        "annotations.api.parsing.BoundedJSONParser",
        "rest_framework.parsers.FormParser",
        "rest_framework.parsers.MultiPartParser",
    ],
    "DEFAULT_RENDERER_CLASSES": ["rest_framework.renderers.JSONRenderer"],
    "DEFAULT_PERMISSION_CLASSES": ["annotations.api.permissions.DenyByDefault"],
    "DEFAULT_SCHEMA_CLASS": "annotations.api.schema.Schema",
    "EXCEPTION_HANDLER": "annotations.api.problems.handle",
    "URL_FORMAT_OVERRIDE": None,
    "DEFAULT_FILTER_BACKENDS": ["django_filters.rest_framework.DjangoFilterBackend"],
}
SPECTACULAR_SETTINGS = {
    "TITLE": "GPSR Workbench",
    "VERSION": "1",
    "OAS_VERSION": "3.1.0",
    "DESCRIPTION": "Everything that the pages can do, for programs: see docs/api.md.",
    "ENUM_NAME_OVERRIDES": {
        "TemplateStatus": "annotations.models.description.template_status_choices",
        "ParaphraseStatus": "annotations.models.corpus.paraphrase_status_choices",
        "UtteranceStatus": "annotations.models.corpus.utterance_status_choices",
        "FindingStatus": "annotations.models.queueing.finding_status_choices",
        "LabelDecision": "annotations.models.queueing.decision_choices",
        "PredicateKind": "annotations.models.description.predicate_kind_choices",
        "Role": "annotations.models.worlds.role_choices",
        "WorkStatus": "annotations.models.background.status_choices",
        "WorkKind": "annotations.models.queueing.work_kind_choices",
        "WorkSubjectKind": ["utterance", "template", "paraphrase"],
        "FindingSubjectKind": ["utterance", "paraphrase"],
    },
    "SERVE_INCLUDE_SCHEMA": False,
    "SCHEMA_PATH_PREFIX": r"/api/v1",
}
