// How drafts reach the server.
import { csrfToken } from "./csrf.js";

/** Send a draft, or that one is discarded, to its address on the server, for the account that the page was made for. */
export function postDraft(url, account, sent, options = {}) {
  const headers = { "content-type": "application/json", "X-CSRFToken": csrfToken() };
  return fetch(url, { method: "POST", headers, body: JSON.stringify({ ...sent, of: account }), ...options });
}
