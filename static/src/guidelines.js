// The guidelines beside the item (`[data-guidelines]`): a key opens and folds them.
import { isTyping } from "./keys.js";
import { actionOf } from "./typing.js";

document.addEventListener("keydown", (event) => {
  const panel = document.querySelector("[data-guidelines]");
  if (!panel || actionOf(event) !== "guidelines" || event.repeat || event.defaultPrevented) return;
  if (isTyping(event)) return;
  event.preventDefault();
  panel.open = !panel.open;
});
