// The page of a tournament: sorts its tables, filters its matches and plays its replays.
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

const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const textOf = (row, cell) => row.querySelector(cell)?.textContent ?? "";

// -- sorting --------------------------------------------------------------------------------------

const collator = new Intl.Collator("en", { numeric: true, sensitivity: "base" });

// Sort a table by a column: ascending first, descending on the second click; dashes stay last.
function sort(header) {
  const body = header.closest("table").tBodies[0], column = header.cellIndex;
  const order = header.ariaSort === "ascending" ? "descending" : "ascending";
  const rows = [...body.rows].map((row) => [row.cells[column].textContent.trim(), row]);
  const none = (text) => text === "-" || text === "";
  rows.sort(([a], [b]) => {
    if (none(a) || none(b)) return none(a) - none(b);
    return order === "ascending" ? collator.compare(a, b) : collator.compare(b, a);
  });
  body.append(...rows.map(([, row]) => row));
  for (const other of header.parentNode.cells) other.ariaSort = other === header ? order : null;
}

for (const button of all("button.sort")) button.addEventListener("click", () => sort(button.parentNode));

// -- choosing -------------------------------------------------------------------------------------

const body = document.querySelector("table.matches tbody");
const lists = ["law", "against"].map(find);

function fits(row) {
  const [law, rival] = lists.map((list) => list.value);
  const [one, other] = all(".player bdi", row).map((name) => name.textContent);
  const plays = (a, b) => (law === "" || law === a) && (rival === "" || rival === b);
  if (!plays(one, other) && !plays(other, one)) return false;
  return !find("forfeits").checked || row.querySelector(".forfeit") !== null;
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

for (const control of [...lists, find("forfeits")]) control.addEventListener("change", choose);
find("all").addEventListener("click", () => {
  for (const list of lists) list.value = "";
  find("forfeits").checked = false;
  choose();
  find("law").focus();
});
choose();

// A cell of the matrix selects its matches.
for (const cell of all("table.matrix button")) {
  cell.addEventListener("click", () => {
    find("law").value = cell.dataset.law;
    find("against").value = cell.dataset.rival;
    choose();
    find("matchesTitle").scrollIntoView();
    find("law").focus({ preventScroll: true });
  });
}

// -- replays --------------------------------------------------------------------------------------

let shown = null; // the row whose match is shown

const numberOf = (row) => textOf(row, ".head");

function element(name, ...content) {
  const made = document.createElement(name);
  made.append(...content);
  return made;
}

// A replay is a page in a sandboxed frame: the player, with the match's data.
function staged(row) {
  const data = find(`replay-${numberOf(row)}`)?.textContent;
  if (!data) return element("p", "There is no replay: it was left out, or the match was over before it began.");
  const [before, after] = JSON.parse(find("player").textContent), frame = element("iframe");
  frame.setAttribute("sandbox", "allow-scripts");
  frame.title = `Replay of match ${find("showTitle").textContent}`;
  frame.addEventListener("load", () => frame.focus()); // so that keys go to the replay
  const dark = document.documentElement.classList.contains("dark");
  frame.srcdoc = before.replace("<html ", dark ? '<html class="dark" ' : "<html ") + data + after;
  return frame;
}

function show(row) {
  shown = row;
  const rows = [...body.rows].filter((each) => !each.hidden), at = rows.indexOf(row);
  const head = row.closest("table").tHead.rows[0];
  const players = all(".player", row).map((cell) => {
    const copies = [...cell.childNodes].map((each) => each.cloneNode(true));
    return element("span", ...copies, ` as ${head.cells[cell.cellIndex].textContent}`);
  });
  find("showTitle").replaceChildren(`${numberOf(row)}. `, players[0], " against ", players[1]);
  find("ending").replaceChildren(`seed ${textOf(row, ".seed")} · `, ...row.querySelector(".ending").cloneNode(true).childNodes);
  const printed = all("template", row).map((each) => each.content.cloneNode(true));
  find("printed").replaceChildren(...printed);
  find("printed").hidden = printed.length === 0;
  find("previous").disabled = at <= 0;
  find("next").disabled = at === rows.length - 1;
  if (!find("show").open) find("show").showModal();
  history.replaceState(null, "", `#match-${numberOf(row)}`);
  const content = staged(row);
  find("stage").replaceChildren(content);
  if (content.nodeName !== "IFRAME") find("close").focus();
}

function go(by) {
  const rows = [...body.rows].filter((row) => !row.hidden), row = rows[rows.indexOf(shown) + by];
  if (row) show(row);
}

const keys = { Escape: () => find("show").close(), ArrowUp: () => go(-1), ArrowDown: () => go(1) };

body.addEventListener("click", (event) => {
  const row = event.target.closest("tr");
  if (row && (event.target.closest("button") || getSelection().isCollapsed)) show(row);
});
find("previous").addEventListener("click", keys.ArrowUp);
find("next").addEventListener("click", keys.ArrowDown);
find("close").addEventListener("click", keys.Escape);
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

const linked = [...body.rows].find((row) => `#match-${numberOf(row)}` === location.hash);
if (linked) show(linked);
