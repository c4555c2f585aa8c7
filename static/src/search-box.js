// The search of the top bar: while one types, what it has found stands below it. Arrows walk the options, Enter opens the
// one that is marked or else searches all, Escape closes. Without scripts the form searches.
import { keyOf } from "./typing.js";

const field = document.querySelector(".search [role=combobox]");
const found = () => document.getElementById("search-found");
const options = () => [...found().querySelectorAll("[role=option]")];
const marked = () => found().querySelector("[aria-selected=true]");

function mark(option) {
  marked()?.setAttribute("aria-selected", "false");
  option?.setAttribute("aria-selected", "true");
  option?.scrollIntoView({ block: "nearest" });
  if (option) field.setAttribute("aria-activedescendant", option.id);
  else field.removeAttribute("aria-activedescendant");
}

function show(isOpen) {
  found().hidden = !isOpen;
  field.setAttribute("aria-expanded", String(isOpen));
  if (!isOpen) mark(null);
}

function move(step) {
  const all = options();
  if (!all.length) return;
  show(true);
  // Before the first and after the last is the field itself.
  const at = (all.indexOf(marked()) + 1 + step + all.length + 1) % (all.length + 1);
  mark(all[at - 1] ?? null);
}

const keys = {
  ArrowDown: () => move(1),
  ArrowUp: () => move(-1),
  Enter: () => marked().click(),
  Escape: () => show(false),
};

if (field) {
  field.addEventListener("keydown", (event) => {
    const key = keyOf(event);
    if (!Object.hasOwn(keys, key)) return;
    if ((key === "Enter" && !marked()) || (key === "Escape" && found().hidden)) return;
    event.preventDefault();
    keys[key]();
  });
  field.addEventListener("focus", () => show(options().length > 0));
  field.form.addEventListener("focusout", (event) => {
    if (!field.form.contains(event.relatedTarget)) show(false);
  });
  field.form.addEventListener("htmx:afterSwap", () => {
    show(document.activeElement === field && options().length > 0);
  });
}
