// A menu (`details[data-menu]`) closes when one clicks elsewhere or presses Escape.
import { keyOf } from "./typing.js";

const openMenus = () => document.querySelectorAll("details[data-menu][open]");

document.addEventListener("click", (event) => {
  openMenus().forEach((menu) => {
    if (!menu.contains(event.target)) menu.open = false;
  });
});

document.addEventListener("keydown", (event) => {
  if (keyOf(event) !== "Escape") return;
  openMenus().forEach((menu) => {
    menu.open = false;
    if (menu.contains(event.target)) menu.querySelector("summary").focus();
  });
});
