// A search field ([data-row-search]) hides the rows of the table beside it that do not have its words.
import { isCtrlEnter, keyOf } from "./typing.js";

document.addEventListener("input", (event) => {
  if (!event.target.matches?.("[data-row-search]")) return;
  const words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
  const scope = event.target.closest("[data-run-picker]");
  scope?.querySelectorAll("tbody tr").forEach((row) => {
    const text = row.textContent.toLowerCase();
    const isChosen = row.querySelector("input:checked") !== null;
    row.hidden = !isChosen && !words.every((word) => text.includes(word));
  });
});

// Enter looks for the row; it does not send the form.
document.addEventListener("keydown", (event) => {
  const isEnter = keyOf(event) === "Enter" || isCtrlEnter(event);
  if (isEnter && event.target.matches?.("[data-row-search]")) event.preventDefault();
});
