// The page of a game's rules: dark or light, as the reader's system is.
(() => {
"use strict";
const scheme = matchMedia("(prefers-color-scheme: dark)");
const setDark = (dark) => document.documentElement.classList.toggle("dark", dark);
scheme.addEventListener("change", (event) => setDark(event.matches));
setDark(scheme.matches);
})();
