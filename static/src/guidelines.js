// The guidelines beside the item (`[data-guidelines]`): g opens and folds them.
import { isTyping } from "./keys.js";
import { keyOf } from "./typing.js";

document.addEventListener("keydown", (event) => {
  const panel = document.querySelector("[data-guidelines]");
  if (!panel || keyOf(event) !== "g" || event.repeat || event.defaultPrevented) return;
  if (isTyping(event)) return;
  event.preventDefault();
  panel.open = !panel.open;
});
