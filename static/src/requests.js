// How htmx behaves here: what did not change is not swapped, polls rest in hidden tabs, a lost
// session goes to the log-in page, and a server that does not answer is said so.
import htmx from "htmx.org";
import { csrfToken } from "./csrf.js";
import { session } from "./log-in.js";

const answers = new WeakMap();
const askedAfter = new WeakMap(); // request → how often the person had logged in before it
const isPoll = (element) => /\bevery\b/.test(element.getAttribute("hx-trigger") || "");

function sameContent(target, fragment) {
  const copy = document.createElement("div");
  copy.append(fragment.cloneNode(true));
  const next = copy.firstElementChild ?? copy;
  return (
    next.innerHTML.trim() === target.innerHTML.trim() && next.dataset.state === target.dataset.state
  );
}

function showConnection(isLost) {
  const line = document.getElementById("connection");
  if (line) line.hidden = !isLost;
}

function toLogin(xhr) {
  const login = document.querySelector('meta[name="login-url"]')?.content;
  if (!login || !xhr.responseURL) return false;
  if (new URL(xhr.responseURL).pathname !== login) return false;
  // Somebody writes here: they are told beside the form, and log in without leaving it.
  if (document.querySelector("form[data-draft-url]")) {
    if (askedAfter.get(xhr) === session.logIns) document.dispatchEvent(new CustomEvent("session:ended"));
    return true;
  }
  location.assign(`${login}?next=${encodeURIComponent(location.pathname + location.search)}`);
  return true;
}

// Logging in again changes the token; the cookie always has the present one.
document.addEventListener("htmx:configRequest", (event) => {
  if (csrfToken()) event.detail.headers["X-CSRFToken"] = csrfToken();
});

document.addEventListener("htmx:beforeRequest", (event) => {
  if (document.hidden && isPoll(event.detail.elt)) event.preventDefault();
  askedAfter.set(event.detail.xhr, session.logIns);
});

document.addEventListener("htmx:oobBeforeSwap", (event) => {
  const { target, fragment } = event.detail;
  if (sameContent(target, fragment)) event.detail.shouldSwap = false;
});

document.addEventListener("htmx:beforeSwap", (event) => {
  const { xhr, elt, target } = event.detail;
  showConnection(false);
  if (toLogin(xhr)) {
    event.detail.shouldSwap = false;
    return;
  }
  if (!elt.hasAttribute("data-swap-if-changed")) return;
  // The element is replaced by each swap, so its id is what lasts.
  const last = answers.get(document.body)?.[target.id];
  if (last === xhr.responseText) event.detail.shouldSwap = false;
  answers.set(document.body, { ...answers.get(document.body), [target.id]: xhr.responseText });
});

document.addEventListener("htmx:sendError", () => showConnection(true));
document.addEventListener("htmx:timeout", () => showConnection(true));
document.addEventListener("htmx:responseError", (event) => {
  const { xhr, target } = event.detail;
  if (xhr.status >= 502) showConnection(true);
  if (!target?.hasAttribute("aria-busy")) return;
  target.removeAttribute("aria-busy");
  target.textContent = "The server could not give this part of the page. Reload the page to ask again.";
});

export { htmx };
