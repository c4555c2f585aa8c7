// What was typed into a form with data-draft outlives a reload and a lost session. It is kept in
// this browser under the form's name, offered again when the page differs from it, and dropped
// when the form is sent. Passwords and hidden fields are never kept.
import { onContent } from "./content.js";

const key = (form) => `draft:${form.dataset.draft}`;
const fieldsOf = (form) => [...form.elements].filter((field) => field.matches("textarea[name], input[type=text][name]"));

function read(form) {
  try {
    return JSON.parse(localStorage.getItem(key(form)));
  } catch {
    return null;
  }
}

function write(form) {
  const draft = Object.fromEntries(fieldsOf(form).map((field) => [field.name, field.value]));
  try {
    localStorage.setItem(key(form), JSON.stringify(draft));
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

function restore(form, draft) {
  for (const field of fieldsOf(form)) {
    if (draft[field.name] === undefined) continue;
    field.value = draft[field.name];
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

function enhance(form) {
  const draft = read(form);
  if (draft && fieldsOf(form).some((field) => draft[field.name] !== undefined && draft[field.name] !== field.value)) {
    restore(form, draft);
    note(form);
  }
  form.addEventListener("input", () => write(form));
}

// A sent draft is dropped once its page has been left for another: a form that comes back with
// errors holds what was typed anyway.
document.addEventListener("submit", (event) => {
  if (event.target.matches("form[data-draft]")) drop(event.target);
});

onContent((root) => root.querySelectorAll("form[data-draft]").forEach(enhance));
