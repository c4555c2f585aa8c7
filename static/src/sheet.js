// Below 800 px the rail is a bottom sheet: all else is inert while it is open, Escape closes it.
import { keyOf } from "./typing.js";

const rail = document.getElementById("rail");
const button = document.querySelector("[data-sheet-toggle]");
const veil = document.querySelector("[data-sheet-close]");
const behind = document.querySelectorAll(".topbar, main, .banner, .skip");

function show(isOpen) {
  rail.classList.toggle("is-open", isOpen);
  button.setAttribute("aria-expanded", String(isOpen));
  veil.hidden = !isOpen;
  behind.forEach((element) => {
    element.inert = isOpen;
  });
  if (isOpen) (rail.querySelector("[aria-current=page]") ?? rail.querySelector("a")).focus();
  else if (rail.contains(document.activeElement)) button.focus();
}

const isOpen = () => rail.classList.contains("is-open");

if (rail && button && veil) {
  button.addEventListener("click", () => show(!isOpen()));
  veil.addEventListener("click", () => show(false));
  document.addEventListener("keydown", (event) => {
    if (keyOf(event) === "Escape" && isOpen()) show(false);
  });
  matchMedia("(width >= 800px)").addEventListener("change", (event) => event.matches && show(false));
}
