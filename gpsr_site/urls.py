"""All pages and routes."""

from django.conf import settings
from django.contrib import admin
from django.contrib.auth.views import LogoutView
from django.urls import include, path

from annotations.api.urls import urlpatterns as corpus_routes
from annotations.views.editing import comments
from annotations.views.people import account, accounts
from annotations.views.people.audit_log import site_log
from annotations.views.people.joining import join
from annotations.views.worlds import jobs
from annotations.views.worlds.worlds import world_import, world_new
from gpsr_site.accounts.passwords import ChangePassword, LogIn, SetPassword
from gpsr_site.pages.search import search
from gpsr_site.pages.worlds import banner, healthz, home, world
from parser_service.api.urls import urlpatterns as parser_routes

API_ROUTES = [*corpus_routes, *parser_routes]

urlpatterns = [
    path("", home, name="home"),
    path("login/", LogIn.as_view(), name="login"),
    path("logout/", LogoutView.as_view(), name="logout"),
    path("password/", ChangePassword.as_view(), name="password"),
    path("log/", site_log, name="site_log"),
    path("accounts/", accounts.accounts, name="accounts"),
    path("accounts/<int:pk>/close/", accounts.account_close, name="account_close"),
    path("accounts/<int:pk>/link/", accounts.account_link, name="account_link"),
    path("password/<uidb64>/<token>/", SetPassword.as_view(), name="password_set"),
    path("account/", account.account, name="account"),
    path("account/tokens/new/", account.token_new, name="token_new"),
    path("account/tokens/<int:pk>/revoke/", account.token_revoke, name="token_revoke"),
    path("account/sessions/end/", account.sessions_end, name="sessions_end"),
    path("account/sessions/<slug:handle>/end/", account.session_end, name="session_end"),
    path("join/<str:key>/", join, name="join"),
    path("banner/", banner, name="banner"),
    path("healthz", healthz, name="healthz"),
    path("worlds/new/", world_new, name="world_new"),
    path("worlds/import/", world_import, name="world_import"),
    path("inbox/", comments.inbox, name="inbox"),
    path("inbox/<int:pk>/", comments.notice_open, name="notice_open"),
    path("jobs/<int:pk>/", jobs.job, name="job"),
    path("jobs/<int:pk>/state/", jobs.job_state, name="job_state"),
    path("jobs/<int:pk>/cancel/", jobs.job_cancel, name="job_cancel"),
    path("jobs/<int:pk>/answer/", jobs.job_answer, name="job_answer"),
    path("w/<slug:world>/", world, name="world"),
    path("w/<slug:world>/search/", search, name="search"),
    path("w/<slug:world>/", include("annotations.urls")),
    path("w/<slug:world>/", include("parser_service.urls")),
    path("api/v1/", include((API_ROUTES, "api"))),
    path("admin/", admin.site.urls),
]

if settings.SSO_SERVER_URL:
    urlpatterns.append(path("sso/", include("allauth.socialaccount.providers.openid_connect.urls")))

handler400 = "gpsr_site.web.errors.bad_request"
handler403 = "gpsr_site.web.errors.permission_denied"
handler404 = "gpsr_site.web.errors.not_found"
handler500 = "gpsr_site.web.errors.server_error"
