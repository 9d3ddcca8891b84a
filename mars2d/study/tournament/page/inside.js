// Runs before the player of a replay where it stands in the page of a tournament.
(() => {
  "use strict";
  const outside = window.parent, dark = document.documentElement.classList.contains("dark");
  const asked = window.matchMedia.bind(window);

  // The player takes itself for a page of its own, which plays at once, as dark as the one outside.
  window.parent = window;
  window.matchMedia = (query) =>
    query.includes("color-scheme") ? { matches: dark, addEventListener() {} } : asked(query);

  // What is played stands outside already.
  document.querySelector(".what").hidden = true;
  document.querySelector(".tools").style.marginLeft = "auto";

  // Keys that the player has no use for are told outside: Escape, up and down.
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (document.querySelector("dialog[open]")) return;
    const open = document.querySelector("#layers.open, #panel:not([hidden])");
    const takes = event.target.closest?.("select, input");
    const key = event.key === "Escape" ? !open : /^Arrow(Up|Down)$/.test(event.key) && !takes;
    if (!key) return;
    event.preventDefault();
    outside.postMessage(event.key, "*");
  }, true);
})();
