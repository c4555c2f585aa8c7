// What opens over a page or in it closes by Escape: menus (`details[data-menu]`), which a click elsewhere closes too;
// any other fold that the focus is in; and the legend that is shown while the pointer or the focus is on it.
// What was typed in them stays there.
import { keyOf } from "./typing.js";

const openMenus = () => [...document.querySelectorAll("details[data-menu][open]")];

document.addEventListener("click", (event) => {
  openMenus().forEach((menu) => {
    if (!menu.contains(event.target)) menu.open = false;
  });
});

function close(fold) {
  const hadFocus = fold.contains(document.activeElement);
  fold.open = false;
  if (hadFocus) fold.querySelector("summary").focus();
}

const SHOWN = ".legend:is(:hover, :focus-within):not([data-is-closed])";

/** Close what Escape means first. Returns whether there was something. */
function closeNext(from) {
  const legends = document.querySelectorAll(SHOWN);
  legends.forEach((legend) => legend.setAttribute("data-is-closed", ""));
  const menus = openMenus();
  menus.forEach(close);
  if (legends.length || menus.length) return true;
  const fold = from.closest?.("details[open]");
  if (fold) close(fold);
  return Boolean(fold);
}

document.addEventListener("keydown", (event) => {
  if (event.defaultPrevented || keyOf(event) !== "Escape" || document.querySelector("dialog[open]")) return;
  if (closeNext(event.target)) event.preventDefault();
});

// It is shown again when one comes back to it.
for (const leaving of ["mouseout", "focusout"]) {
  document.addEventListener(leaving, (event) => {
    const legend = event.target.closest?.("[data-is-closed]");
    if (legend && !legend.contains(event.relatedTarget)) legend.removeAttribute("data-is-closed");
  });
}
