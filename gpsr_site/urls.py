"""All pages and routes."""

from django.contrib import admin
from django.contrib.auth.views import LogoutView
from django.urls import include, path

from annotations.views.worlds import world_new
from gpsr_site import pages
from gpsr_site.accounts import LogIn

urlpatterns = [
    path("", pages.home, name="home"),
    path("login/", LogIn.as_view(), name="login"),
    path("logout/", LogoutView.as_view(), name="logout"),
    path("banner/", pages.banner, name="banner"),
    path("healthz", pages.healthz, name="healthz"),
    path("worlds/new/", world_new, name="world_new"),
    path("w/<slug:world>/", pages.world, name="world"),
    path("w/<slug:world>/", include("annotations.urls")),
    path("w/<slug:world>/", include("parser_service.urls")),
    path("api/v1/", include("annotations.api.urls")),
    path("admin/", admin.site.urls),
]
