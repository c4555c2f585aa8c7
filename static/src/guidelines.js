// The guidelines beside the item (`[data-guidelines]`): g opens and folds them, and the browser remembers which.
import { onContent } from "./content.js";
import { isTyping } from "./keys.js";
import { keyOf } from "./typing.js";

const KEY = "guidelines-open";

function remembered() {
  try {
    return localStorage.getItem(KEY) === "yes";
  } catch {
    return false;
  }
}

onContent((root) => {
  root.querySelectorAll("[data-guidelines]").forEach((panel) => {
    panel.open = remembered();
    panel.addEventListener("toggle", () => {
      try {
        localStorage.setItem(KEY, panel.open ? "yes" : "no");
      } catch {
        // then it lasts for this page
      }
    });
  });
});

document.addEventListener("keydown", (event) => {
  const panel = document.querySelector("[data-guidelines]");
  if (!panel || keyOf(event) !== "g" || event.repeat || event.defaultPrevented) return;
  if (isTyping(event)) return;
  event.preventDefault();
  panel.open = !panel.open;
});
