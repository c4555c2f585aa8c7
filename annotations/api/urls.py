"""Routes below ``/api/v1/``."""

from __future__ import annotations

from django.urls import path
from drf_spectacular.views import SpectacularAPIView
from rest_framework.permissions import AllowAny

from annotations.api.audit import AuditFindings, OneAuditFinding
from annotations.api.utterances import OneUtterance, Utterances
from annotations.api.views import SplitExport
from annotations.api.work_items import (
    FinishWorkItem,
    GiveBackWorkItem,
    NextWorkItem,
    OneWorkItem,
    WorkItems,
)

app_name = "api"

urlpatterns = [
    # The schema says what exists and shows no row, so that tools may read it without a token.
    path("schema/", SpectacularAPIView.as_view(permission_classes=[AllowAny]), name="schema"),
    path("worlds/<slug:world>/splits/<int:pk>/export/", SplitExport.as_view(), name="split-export"),
    path("worlds/<slug:world>/utterances/", Utterances.as_view(), name="utterances"),
    path("worlds/<slug:world>/utterances/<int:pk>/", OneUtterance.as_view(), name="utterance"),
    path("worlds/<slug:world>/audit-findings/", AuditFindings.as_view(), name="audit-findings"),
    path(
        "worlds/<slug:world>/audit-findings/<int:pk>/",
        OneAuditFinding.as_view(),
        name="audit-finding",
    ),
    path("worlds/<slug:world>/work-items/", WorkItems.as_view(), name="work-items"),
    path("worlds/<slug:world>/work-items/next/", NextWorkItem.as_view(), name="work-item-next"),
    path("worlds/<slug:world>/work-items/<int:pk>/", OneWorkItem.as_view(), name="work-item"),
    path(
        "worlds/<slug:world>/work-items/<int:pk>/finish/",
        FinishWorkItem.as_view(),
        name="work-item-finish",
    ),
    path(
        "worlds/<slug:world>/work-items/<int:pk>/give-back/",
        GiveBackWorkItem.as_view(),
        name="work-item-give-back",
    ),
]
