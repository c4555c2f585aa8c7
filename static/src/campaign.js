// The page of a campaign on which somebody writes: advice while one types, Enter to go on, and what was typed
// survives a reload and a server that is away. Without this script the advice comes after saving.
import "./copying.js";
import { csrfToken } from "./csrf.js";
import "./time-zone.js";
import { isCtrlEnter, keyOf } from "./typing.js";

const PAUSE_MS = 700;
// What is missing, or too far, is told once most of the sentence may be there, or when the field is left.
const ENOUGH = 0.6;

const form = document.querySelector("form[data-campaign]");
if (form) watch(form);

function watch(form) {
  const field = form.elements.text;
  const list = form.querySelector("[data-advice]");
  const draft = `campaign:${form.dataset.place}`;
  let timer;
  let latest = 0;

  restore();
  field.addEventListener("input", () => {
    store();
    form.elements.advised.value = "";
    clearTimeout(timer);
    timer = setTimeout(() => advise(field.value.length >= ENOUGH * Number(form.dataset.length)), PAUSE_MS);
  });
  field.addEventListener("change", () => advise(true));
  field.addEventListener("paste", () => (form.elements.pasted.value = "on"));
  field.addEventListener("keydown", (event) => {
    if (event.shiftKey || !(keyOf(event) === "Enter" || isCtrlEnter(event))) return;
    event.preventDefault();
    form.requestSubmit();
  });

  async function advise(isWhole) {
    clearTimeout(timer);
    const asked = ++latest;
    const text = field.value;
    const answer = await ask(text);
    if (asked !== latest || text !== field.value || !answer) return;
    const told = answer.warnings.filter((each) => isWhole || each.code === "too_close");
    list.replaceChildren(
      ...told.map((each) => Object.assign(document.createElement("li"), { textContent: each.sentence })),
    );
    // All of the advice was seen: it need not come again after saving.
    form.elements.advised.value = told.length === answer.warnings.length ? "on" : "";
  }

  async function ask(text) {
    const body = new URLSearchParams({ text });
    try {
      const response = await fetch(form.dataset.campaign, {
        method: "POST",
        body,
        headers: { "X-CSRFToken": csrfToken() || form.elements.csrfmiddlewaretoken.value },
      });
      return response.ok ? await response.json() : null;
    } catch {
      return null; // without the server there is no advice; saving says that it is away
    }
  }

  function store() {
    try {
      sessionStorage.setItem(draft, field.value);
    } catch {
      // a full or forbidden storage keeps no copy
    }
  }

  // The copy stays until the server shows the same: what was sent may not have come.
  function restore() {
    try {
      const kept = sessionStorage.getItem(draft);
      if (kept === field.value) sessionStorage.removeItem(draft);
      else if (kept) {
        field.value = kept;
        advise(true);
      }
    } catch {
      // as above
    }
    field.focus();
    field.setSelectionRange(field.value.length, field.value.length);
  }
}
