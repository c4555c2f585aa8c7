// Logging in again on the page where the session has ended, so that nothing typed there is lost.
import { csrfToken, useToken } from "./csrf.js";

const dialog = () => document.getElementById("log-in-again");
const loginPath = () => document.querySelector('meta[name="login-url"]')?.content;
// How often the person has logged in on this page: what was asked before says nothing of the session since.
export const session = { logIns: 0 };
let whenBack = [];

/** Whether an answer is the page for logging in, to which people without a session are sent. */
export function isLogin(answer) {
  return answer.redirected && new URL(answer.url).pathname === loginPath();
}

/** Ask for the password; call back once the person is logged in. */
export function askToLogIn(callback) {
  whenBack.push(callback);
  if (dialog() && !dialog().open) dialog().showModal();
}

async function send(form) {
  const body = new URLSearchParams(new FormData(form));
  body.set("csrfmiddlewaretoken", csrfToken());
  const answer = await fetch(form.action, { method: "POST", body });
  if (answer.ok && new URL(answer.url).pathname !== loginPath()) return "";
  const page = new DOMParser().parseFromString(await answer.text(), "text/html");
  return page.querySelector(".form-errors")?.textContent || "The password was not accepted. Try again.";
}

async function logIn(form) {
  const note = form.querySelector(".form-errors");
  note.textContent = "";
  try {
    note.textContent = await send(form);
  } catch {
    note.textContent = "The server does not answer. Try again.";
  }
  if (note.textContent) return;
  form.elements.password.value = "";
  session.logIns += 1;
  useToken(); // logging in has changed it
  dialog().close();
  const waiting = whenBack;
  whenBack = [];
  waiting.forEach((callback) => callback());
}

document.addEventListener("submit", (event) => {
  if (!event.target.closest("#log-in-again")) return;
  event.preventDefault();
  logIn(event.target);
});

document.addEventListener("click", (event) => {
  if (event.target.closest("[data-close-dialog]")) event.target.closest("dialog").close();
});
