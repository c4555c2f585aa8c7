"""Logging in, with a limit on how often one may get it wrong."""

from __future__ import annotations

from django.contrib.auth.views import LoginView
from django.core.exceptions import ValidationError
from django.forms import Form
from django.http import HttpRequest, HttpResponse

from annotations.rates import FAILED_LOG_INS

TOO_OFTEN = (
    "Too many wrong attempts for this name from this address. "
    f"Try again in {FAILED_LOG_INS.seconds // 60} minutes."
)


class LogIn(LoginView):
    """The log-in page. Failures count per address and name; above the limit even the right password waits."""

    redirect_authenticated_user = True

    def post(self, request: HttpRequest, *args: object, **kwargs: object) -> HttpResponse:
        if not FAILED_LOG_INS.is_spent(self.key):
            return super().post(request, *args, **kwargs)
        form = self.get_form()
        form.full_clean()
        form.errors.clear()
        form.add_error(None, ValidationError(TOO_OFTEN))
        return self.render_to_response(self.get_context_data(form=form), status=429)

    def form_valid(self, form: Form) -> HttpResponse:
        FAILED_LOG_INS.forget(self.key)
        return super().form_valid(form)

    def form_invalid(self, form: Form) -> HttpResponse:
        FAILED_LOG_INS.count(self.key)
        return super().form_invalid(form)

    @property
    def key(self) -> str:
        name = self.request.POST.get("username", "").strip().lower()
        return f"{self.request.META['REMOTE_ADDR']} {name}"
