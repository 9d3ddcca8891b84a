// The page of a tournament: sorts its tables, filters its matches and plays its replays.
(() => {
"use strict";

const find = (id) => document.getElementById(id);
const all = (selector, within = document) => [...within.querySelectorAll(selector)];

// -- dark or light --------------------------------------------------------------------------------

function setDark(dark) {
  document.documentElement.classList.toggle("dark", dark);
  find("dark").setAttribute("aria-pressed", dark);
}

const scheme = matchMedia("(prefers-color-scheme: dark)");
scheme.addEventListener("change", (event) => setDark(event.matches));
find("dark").addEventListener("click", () => setDark(find("dark").getAttribute("aria-pressed") !== "true"));
setDark(scheme.matches);

// -- sorting --------------------------------------------------------------------------------------

const collator = new Intl.Collator("en", { numeric: true, sensitivity: "base" });

// The sort key of a cell: a number, a text, or null for a dash.
function valueOf(cell) {
  const value = cell.dataset.value ?? cell.textContent.trim();
  if (value === "\u2013" || value === "") return null;
  return Number.isNaN(Number(value)) ? value : Number(value);
}

function compared(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return collator.compare(a, b);
}

// Sort a table by a column: ascending first, descending on the second click; dashes stay last.
function sort(header) {
  const table = header.closest("table"), body = table.tBodies[0], column = header.cellIndex;
  const down = header.getAttribute("aria-sort") === "ascending";
  const rows = [...body.rows].map((row) => [valueOf(row.cells[column]), row]);
  rows.sort(([a], [b]) => {
    if (a === null || b === null) return (a === null) - (b === null);
    return down ? compared(b, a) : compared(a, b);
  });
  body.append(...rows.map(([, row]) => row));
  all("th[aria-sort]", table).forEach((other) => other.removeAttribute("aria-sort"));
  header.setAttribute("aria-sort", down ? "descending" : "ascending");
}

for (const button of all("button.sort")) button.addEventListener("click", () => sort(button.parentNode));

// -- tables that are wider than the page -----------------------------------------------------------

// Let a side fade out beyond which there are more columns.
function fade(wide) {
  const { scrollLeft, scrollWidth, clientWidth } = wide;
  wide.classList.toggle("before", scrollLeft > 1);
  wide.classList.toggle("beyond", scrollLeft + clientWidth < scrollWidth - 1);
}

for (const wide of all(".wide")) {
  wide.addEventListener("scroll", () => fade(wide), { passive: true });
  new ResizeObserver(() => fade(wide)).observe(wide);
}

// -- choosing -------------------------------------------------------------------------------------

const body = document.querySelector("table.matches tbody");
const chosen = () => [...body.rows].filter((row) => !row.hidden);

function fits(row) {
  const laws = row.dataset.laws.split(" "), law = find("law").value, rival = find("rival").value;
  const [one, other] = laws;
  const plays = (a, b) => (law === "" || law === a) && (rival === "" || rival === b);
  if (!plays(one, other) && !plays(other, one)) return false;
  if (find("round") && !["", row.dataset.round].includes(find("round").value)) return false;
  return !find("forfeits").checked || "forfeit" in row.dataset;
}

function choose() {
  let count = 0;
  for (const row of body.rows) {
    row.hidden = !fits(row);
    count += !row.hidden;
  }
  const total = body.rows.length;
  find("count").textContent = count === total ? `${total} matches` : `${count} of ${total} matches`;
  find("all").hidden = count === total;
}

const lists = ["law", "rival", "round"].map(find).filter(Boolean);
for (const control of [...lists, find("forfeits")]) control.addEventListener("change", choose);
find("all").addEventListener("click", () => {
  for (const list of lists) list.value = "";
  find("forfeits").checked = false;
  choose();
  find("law").focus();
});
choose();

// A cell of the matrix selects its matches. Arrow keys move between cells; only one is a tab stop.
const cells = all("table.matrix button");
const grid = all("table.matrix tbody tr").map((row) => [...row.cells].map((cell) => cell.firstChild));
cells.forEach((cell, k) => (cell.tabIndex = k ? -1 : 0));

function step(cell, down, right) {
  const y = cell.closest("tr").sectionRowIndex, x = cell.parentNode.cellIndex;
  for (let k = 1; ; k++) {
    const there = grid[y + k * down]?.[x + k * right];
    if (!there || there.nodeName === "SPAN") return;
    if (there.nodeName !== "BUTTON") continue; // an empty cell
    cells.forEach((each) => (each.tabIndex = each === there ? 0 : -1));
    there.focus();
    return;
  }
}

for (const cell of cells) {
  cell.addEventListener("click", () => {
    find("law").value = cell.dataset.law;
    find("rival").value = cell.dataset.rival;
    choose();
    find("matchesTitle").scrollIntoView();
    find("law").focus({ preventScroll: true });
  });
  cell.addEventListener("keydown", (event) => {
    const way = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    step(cell, ...way);
  });
}

// -- replays --------------------------------------------------------------------------------------

let shown = null; // the row whose match is shown

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).text();
}

// A replay is a page in a sandboxed frame: the player, with the match's data.
async function frameOf(data) {
  const [before, after] = await Promise.all(find("player").textContent.split(" ").map(unpacked));
  const frame = document.createElement("iframe");
  frame.setAttribute("sandbox", "allow-scripts");
  frame.title = `Replay of match ${find("showTitle").textContent}`;
  frame.addEventListener("load", () => frame.focus()); // so that keys go to the replay
  const dark = document.documentElement.classList.contains("dark");
  frame.srcdoc = before.replace("<html ", dark ? '<html class="dark" ' : "<html ") + data + after;
  return frame;
}

function said(words) {
  const paragraph = document.createElement("p");
  paragraph.textContent = words;
  return paragraph;
}

async function staged(row) {
  const data = find(`replay-${row.dataset.match}`)?.textContent;
  if (!data) return said(row.dataset.without);
  if (!("DecompressionStream" in window)) {
    return said("This browser is too old to unpack the replay: it needs one from 2023 or later.");
  }
  return frameOf(data).catch(() => said("This file is damaged: the replay can't be unpacked."));
}

async function show(row) {
  shown = row;
  const { match } = row.dataset, rows = chosen(), at = rows.indexOf(row);
  const players = all("[data-role]", row).map((cell) => {
    const name = document.createElement(cell.classList.contains("won") ? "strong" : "span");
    const copies = [...cell.childNodes].map((each) => each.cloneNode(true));
    name.append(...copies, ` as ${cell.dataset.role}`);
    return name;
  });
  find("showTitle").replaceChildren(`${match}. `, players[0], " against ", players[1]);
  const ending = row.querySelector(".ending").cloneNode(true).childNodes;
  find("ending").replaceChildren(`${row.dataset.start} · `, ...ending);
  const printed = all(`template[data-match="${match}"]`).map((each) => each.content.cloneNode(true));
  find("printed").replaceChildren(...printed);
  find("printed").hidden = printed.length === 0;
  find("previous").disabled = at <= 0;
  find("next").disabled = at === rows.length - 1;
  if (!find("show").open) find("show").showModal();
  history.replaceState(null, "", `#match-${match}`);
  const content = await staged(row);
  if (shown !== row) return; // another one was picked meanwhile
  find("stage").replaceChildren(content);
  if (content.nodeName !== "IFRAME") find("close").focus();
}

function go(by) {
  const rows = chosen(), row = rows[rows.indexOf(shown) + by];
  if (row) show(row);
}

const keys = { Escape: () => find("show").close(), ArrowUp: () => go(-1), ArrowDown: () => go(1) };

body.addEventListener("click", (event) => {
  const row = event.target.closest("tr");
  if (row && (event.target.closest("button") || getSelection().isCollapsed)) show(row);
});
find("previous").addEventListener("click", () => go(-1));
find("next").addEventListener("click", () => go(1));
find("close").addEventListener("click", () => find("show").close());
find("show").addEventListener("keydown", (event) => {
  if (event.key === "Escape" || !(event.key in keys) || event.target.closest("pre")) return;
  event.preventDefault();
  keys[event.key]();
});
addEventListener("message", (event) => {
  const frame = find("stage").querySelector("iframe");
  if (frame && event.source === frame.contentWindow && Object.hasOwn(keys, event.data)) keys[event.data]();
});
find("show").addEventListener("close", () => {
  find("stage").replaceChildren(); // ends the replay
  history.replaceState(null, "", location.href.split("#")[0]);
  shown.scrollIntoView({ block: "nearest" });
  shown.querySelector("button").focus();
  shown = null;
});

const linked = body.querySelector(`tr[data-match="${/^#match-(\d+)$/.exec(location.hash)?.[1]}"]`);
if (linked) show(linked);
})();
