// The token that Django wants with everything that is sent. It changes when somebody logs in again, in this tab
// or another; forms that were on the page before take the present one when they are sent.
export function csrfToken() {
  return /(?:^|; )csrftoken=([^;]+)/.exec(document.cookie)?.[1] ?? "";
}

document.addEventListener("submit", (event) => {
  const field = event.target.elements.csrfmiddlewaretoken;
  if (field && csrfToken()) field.value = csrfToken();
});
