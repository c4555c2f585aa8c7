"""Routes below ``/api/v1/``."""

from __future__ import annotations

from django.urls import path
from drf_spectacular.views import SpectacularAPIView
from rest_framework.permissions import AllowAny

from annotations.api.views import SplitExport

app_name = "api"

urlpatterns = [
    # The schema says what exists and shows no row, so that tools may read it without a token.
    path("schema/", SpectacularAPIView.as_view(permission_classes=[AllowAny]), name="schema"),
    path("worlds/<slug:world>/splits/<int:pk>/export/", SplitExport.as_view(), name="split-export"),
]
