"use strict";

const find = (id) => document.getElementById(id);

// Dark or light: as the reader's system is, until the button is used.
function setDark(dark) {
  document.documentElement.classList.toggle("dark", dark);
  find("dark").setAttribute("aria-pressed", dark);
}

const scheme = matchMedia("(prefers-color-scheme: dark)");
scheme.addEventListener("change", (event) => setDark(event.matches));
find("dark").addEventListener("click", () => setDark(find("dark").getAttribute("aria-pressed") !== "true"));
setDark(scheme.matches);
