// Secrets that are shown once: selected as one comes to them, copied by a button that says so.

const SHOWN_MS = 1500;

/** Put the value of the field that a button names into the clipboard. */
async function copyField(button) {
  const field = document.getElementById(button.dataset.copyField);
  field.select();
  try {
    await navigator.clipboard.writeText(field.value);
    say(button, "Copied");
  } catch {
    say(button, "Press Ctrl+C"); // without HTTPS there is no clipboard; the field is selected
  }
}

function say(button, text) {
  const before = (button.dataset.label ??= button.textContent);
  button.textContent = text;
  setTimeout(() => (button.textContent = before), SHOWN_MS);
}

document.addEventListener("click", (event) => {
  const button = event.target.closest("[data-copy-field]");
  if (button) copyField(button);
});

document.addEventListener("focusin", (event) => {
  if (event.target.matches?.("[data-secret]")) event.target.select();
});
