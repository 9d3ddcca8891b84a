// Runs before a replay's player inside the page of a tournament.
(() => {
  "use strict";
  const outside = window.parent, dark = document.documentElement.classList.contains("dark");
  const asked = window.matchMedia.bind(window);

  // Make the player behave like a page of its own, which plays at once with the outer page's theme.
  window.parent = window;
  window.matchMedia = (query) =>
    query.includes("color-scheme") ? { matches: dark, addEventListener() {} } : asked(query);

  // The outer page shows the title already.
  document.querySelector(".what").hidden = true;
  document.querySelector(".tools").style.marginLeft = "auto";

  // Pass keys that the player does not use to the outer page: Escape, up and down.
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (document.querySelector("dialog[open]")) return;
    const open = document.querySelector("#layers:not([hidden]), #panel:not([hidden])");
    const takes = event.target.closest?.("select, input");
    const key = event.key === "Escape" ? !open : /^Arrow(Up|Down)$/.test(event.key) && !takes;
    if (!key) return;
    event.preventDefault();
    outside.postMessage(event.key, "*");
  }, true);
})();
