// What was typed into a form with data-draft outlives a reload and a lost session. It is kept in
// this browser under the form's name and comes back when the page differs from it. Sending the form
// only marks the draft, because a lost session may swallow it; it is dropped when the server has shown
// another page of the workbench, or the same with the same words. Only text is kept, never a password.
import { onContent } from "./content.js";

const key = (form) => `draft:${form.dataset.draft}`;
const KEPT = "textarea[name], input[type=text][name]";
const fieldsOf = (form) => [...form.elements].filter((field) => field.matches(KEPT));

function read(form) {
  try {
    return JSON.parse(localStorage.getItem(key(form)));
  } catch {
    return null;
  }
}

function write(form, isSent = false) {
  const fields = Object.fromEntries(fieldsOf(form).map((field) => [field.name, field.value]));
  try {
    localStorage.setItem(key(form), JSON.stringify({ fields, isSent }));
  } catch {
    // A full or forbidden storage loses the draft, not the form.
  }
}

function drop(form) {
  try {
    localStorage.removeItem(key(form));
  } catch {
    // see write()
  }
}

function restore(form, fields) {
  for (const field of fieldsOf(form)) {
    if (fields[field.name] === undefined) continue;
    field.value = fields[field.name];
    field.dispatchEvent(new CustomEvent("draft:restored"));
  }
}

function note(form) {
  const line = document.createElement("p");
  line.className = "saved";
  line.role = "status";
  line.append("What you typed here before was not sent yet and is back. ");
  const discard = document.createElement("button");
  discard.type = "button";
  discard.className = "link-button small-button";
  discard.textContent = "Discard it";
  discard.addEventListener("click", () => {
    drop(form);
    restore(form, Object.fromEntries(fieldsOf(form).map((field) => [field.name, field.defaultValue])));
    line.remove();
  });
  line.append(discard);
  form.prepend(line);
}

function differs(form, fields) {
  return fieldsOf(form).some((field) => (fields[field.name] ?? field.value) !== field.value);
}

function enhance(form) {
  const draft = read(form);
  if (draft && differs(form, draft.fields)) {
    restore(form, draft.fields);
    note(form);
  } else if (draft) {
    drop(form);
  }
  form.addEventListener("input", () => write(form));
}

// The sent drafts of forms that this page does not hold have arrived.
function dropArrived() {
  const here = new Set([...document.querySelectorAll("form[data-draft]")].map(key));
  for (const name of Object.keys(localStorage)) {
    if (!name.startsWith("draft:") || here.has(name)) continue;
    if (JSON.parse(localStorage.getItem(name)).isSent) localStorage.removeItem(name);
  }
}

document.addEventListener("submit", (event) => {
  if (event.target.matches("form[data-draft]")) write(event.target, true);
});

try {
  dropArrived();
} catch {
  // see write()
}
onContent((root) => root.querySelectorAll("form[data-draft]").forEach(enhance));
