// The token that Django wants with everything that is sent. It changes when somebody logs in again, in this tab
// or another; forms that were on the page before take the present one when they are sent.
export function csrfToken() {
  return /(?:^|; )csrftoken=([^;]+)/.exec(document.cookie)?.[1] ?? "";
}

/** Put the present token into every form of the page, for what is sent without a submit. */
export function useToken() {
  for (const field of document.querySelectorAll("input[name=csrfmiddlewaretoken]")) field.value = csrfToken();
}

document.addEventListener("submit", (event) => {
  const field = event.target.elements.csrfmiddlewaretoken;
  if (field && csrfToken()) field.value = csrfToken();
});
