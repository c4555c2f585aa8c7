// Suggested texts for a field: choosing one writes it there, and what is written there shows which one is chosen.
// The digits choose while nobody types.
import { isTyping } from "./keys.js";
import { actionOf, keyOf } from "./typing.js";

const RADIOS = "[data-suggestions] input[type=radio]";
const fieldOf = (radio) => document.getElementById(radio.closest("[data-suggestions]").dataset.suggestions);

function write(radio) {
  const field = fieldOf(radio);
  if (!field) return;
  field.value = radio.value;
  field.dispatchEvent(new CustomEvent("draft:restored")); // its editor shows the new text
  field.dispatchEvent(new Event("input", { bubbles: true })); // checker, preview and draft look again
}

/** The suggestion that is written is the chosen one; a text of one's own clears the choice. */
function showChoice() {
  for (const radio of document.querySelectorAll(RADIOS)) {
    radio.checked = fieldOf(radio)?.value.trim() === radio.value;
  }
}

document.addEventListener("htmx:afterSwap", showChoice);
document.addEventListener("input", (event) => {
  const isSuggestedFor = (radio) => event.target === fieldOf(radio) || event.target === fieldOf(radio)?.form;
  if ([...document.querySelectorAll(RADIOS)].some(isSuggestedFor)) showChoice();
});

document.addEventListener("change", (event) => {
  if (event.target.matches(RADIOS)) write(event.target);
});

document.addEventListener("keydown", (event) => {
  if (event.defaultPrevented || actionOf(event) !== "digit" || isTyping(event)) return;
  const radio = document.querySelectorAll(RADIOS)[Number(keyOf(event)) - 1];
  if (!radio) return;
  event.preventDefault();
  radio.focus();
  if (radio.checked) write(radio);
  else radio.click();
});
