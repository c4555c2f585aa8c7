// Suggested texts for a field: choosing one writes it there. The digits choose while nobody types.
import { isTyping } from "./keys.js";
import { keyOf } from "./typing.js";

function write(radio) {
  const field = document.getElementById(radio.closest("[data-suggestions]").dataset.suggestions);
  if (!field) return;
  field.value = radio.value;
  field.dispatchEvent(new CustomEvent("draft:restored")); // its editor shows the new text
  const { status } = field.form.elements;
  if (status?.value === "draft") status.value = "ready"; // somebody has read this form and takes it
  field.dispatchEvent(new Event("input", { bubbles: true })); // checker, preview and draft look again
}

// Suggestions that come while somebody works: the one that is written stays chosen.
document.addEventListener("htmx:afterSwap", () => {
  for (const radio of document.querySelectorAll("[data-suggestions] input[type=radio]")) {
    const field = document.getElementById(radio.closest("[data-suggestions]").dataset.suggestions);
    if (field && field.value.trim() === radio.value) radio.checked = true;
  }
});

document.addEventListener("change", (event) => {
  if (event.target.matches("[data-suggestions] input[type=radio]")) write(event.target);
});

document.addEventListener("keydown", (event) => {
  const key = keyOf(event);
  if (event.defaultPrevented || !/^[1-9]$/.test(key) || isTyping(event)) return;
  const radio = document.querySelectorAll("[data-suggestions] input[type=radio]")[Number(key) - 1];
  if (!radio) return;
  event.preventDefault();
  radio.focus();
  if (radio.checked) write(radio);
  else radio.click();
});
