// The guidelines beside the item (`[data-guidelines]`): g opens and folds them.
import { isTyping } from "./keys.js";
import { isPlain } from "./typing.js";

document.addEventListener("keydown", (event) => {
  const panel = document.querySelector("[data-guidelines]");
  if (!panel || event.key !== "g" || event.repeat || event.defaultPrevented) return;
  if (!isPlain(event) || isTyping(event)) return;
  event.preventDefault();
  panel.open = !panel.open;
});
