// The page: its controls, its keys, and the loop that shows one moment after the other.

// Keys as the help names them, or two with one meaning each; what they do; and how.
const ACTIONS = [
  [["Space"], "play, pause", (page) => page.playOrPause()],
  [["←", "→"], "one step back or on", (page) => page.clock.move(-1), (page) => page.clock.move(1)],
  [["PgUp", "PgDn"], "ten steps back or on", (page) => page.clock.move(-10), (page) => page.clock.move(10)],
  [["Home", "End"], "to the start, or to the end", (page) => page.goTo(0), (page) => page.goTo(page.clock.last)],
  [["N", "Shift+N"], "next contact, previous contact", (page) => page.goToContact(false), (page) => page.goToContact(true)],
  [["+", "\u2212"], "faster, or slower", (page) => page.faster(1), (page) => page.faster(-1)],
  [["J"], "loop", (page) => page.setLoop(!page.clock.loop)],
  [["A"], "choose layers", (page) => page.openLayers(find("layers").hidden)],
  [["Shift+arrows"], "move the picture"],
  [["F"], "fit all into the view", (page) => page.fit()],
  [["D"], "dark or light", (page) => page.setDark(!page.look.dark)],
  [["Esc"], "clear the selection", (page) => (find("layers").hidden ? page.pick(-1) : page.openLayers(false))],
  [["F1", "?"], "this help", (page) => find("helping").showModal()],
];
const LABELS = {
  " ": "Space", ArrowLeft: "←", ArrowRight: "→", PageUp: "PgUp", PageDown: "PgDn", Escape: "Esc",
  "=": "+", "-": "\u2212",
}; // by what the browser calls them
const BUTTONS = { // by their ids
  play: "Space", first: "Home", last: "End", back: "←", ahead: "→", loop: "J", fit: "F", dark: "D",
  help: "F1", show: "A",
};
const ARROWS = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] };

// An element of the page with properties, and with elements or texts in it.
function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// What the key of a label does, if anything.
function actionOf(label) {
  for (const [labels, , ...acts] of ACTIONS) {
    const k = labels.indexOf(label);
    if (k >= 0) return acts[k] ?? acts[0];
  }
  return null;
}

const find = (id) => document.getElementById(id);
const NEAR = { mouse: 8, touch: 24, pen: 16 }; // pixels within which a body is met

class Replay {
  constructor(record) {
    this.record = record;
    this.clock = new Clock(record);
    this.canvas = find("picture");
    this.picture = new Picture(this.canvas, record, this.clock);
    this.panel = new Panel(find("panel"), this.picture);
    this.legend = new Legend(find("legend"), record);
    this.marks = new Marks(find("marks"), record, find("ticks"));
    this.look = Object.fromEntries(record.layers.map(({ name, on }) => [name, on]));
    this.look.picked = -1;
    this.drawn = "";
    this.said = 0;
    this.layers = record.layers.filter((layer) => layer.switch && this.has(layer.name));
    this.prepare();
    this.listen();
    this.setDark(matchMedia("(prefers-color-scheme: dark)").matches);
    this.resize();
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (!calm && window.parent === window) this.clock.play();
    this.before = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  // Whether there is something to see on a layer.
  has(name) {
    const { record } = this;
    return name in record.drawn || name === "grid" || name === "trails";
  }

  // -- what stands there from the start ---------------------------------------------------------

  prepare() {
    const { record } = this, { bodies } = record;
    const parts = [record.file, `seed ${record.seed}`].filter(Boolean);
    find("subtitle").append(parts.join(" · "));
    const badge = (text) => find("subtitle").append(" ", element("b", {}, text));
    if (!record.finished) badge("not finished");
    if (record.changed) badge("changed by hand");
    const option = (value, text) => element("option", { value }, text);
    find("bodies").append(option(-1, "Pick a robot"), ...bodies.map(({ name }, i) => option(i, name)));
    find("speed").append(...SPEEDS.map((speed) => option(speed, `${speed}×`)));
    find("slider").max = this.record.rows - 1;
    for (const { name, title, key } of this.layers) {
      const words = key ? `${title} (${key.toUpperCase()})` : title;
      const button = element("button", { id: `layer-${name}`, title: words }, title);
      button.addEventListener("click", () => this.toggle(name));
      find("layers").append(button);
    }
    const switches = this.layers.filter(({ key }) => key);
    const keyed = [...ACTIONS, ...switches.map(
      ({ title, key }) => [[key.toUpperCase()], `${title.toLowerCase()} on and off`])];
    find("keys").append(...keyed.map(([labels, does]) => element("tr", {},
      element("td", {}, ...labels.flatMap((label) => [element("kbd", {}, label), " "])),
      element("td", {}, does))));
    this.tell();
  }

  // Fill the page on where the run comes from, and what of it is not in the file.
  tell() {
    const { record, clock } = this, { picture } = this;
    const versions = Object.entries(record.versions).map(([name, version]) => `${name} ${version}`);
    const robots = picture.robots, props = record.bodies.length - robots;
    const counted = (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`;
    const facts = [
      ["experiment", record.file || record.title],
      ["seed", record.seed],
      ["bodies", [counted(robots, "robot"), ...(props ? [counted(props, "prop")] : [])].join(", ")],
      ["time", `${this.seconds(clock.end)} s in ${record.rows - 1} steps of ${record.step} s`],
      ["end", this.ending()],
      ["versions", versions.join(", ")],
      ["digest", record.digest],
    ];
    find("facts").append(...facts.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
    const millimetres = record.columns.places.step * 500;
    const lines = [
      `positions are rounded by at most ${Number(millimetres.toPrecision(2))} mm; between two rows all moves evenly`,
      ...record.notes,
    ];
    if (record.changed) lines.push("bodies or parts were moved or changed by hand as it ran");
    const items = lines.map((line) => element("li", {}, line));
    find("notes").append(element("h3", {}, "What this file holds"), element("ul", {}, ...items));
  }

  ending() {
    const { over, finished } = this.record;
    if (!finished) return `not finished${over ? `: ${over}` : ""}`;
    return over || "the run is over";
  }

  seconds(time) {
    const digits = Math.min(Math.max(0, -Math.floor(Math.log10(this.record.step) + 1e-9)), 3);
    return time.toFixed(digits);
  }

  // -- what one can do --------------------------------------------------------------------------

  listen() {
    const { clock } = this, on = (id, act) => find(id).addEventListener("click", act);
    for (const [id, label] of Object.entries(BUTTONS)) on(id, () => actionOf(label)(this));
    on("nearer", () => this.zoom(1.4));
    on("farther", () => this.zoom(1 / 1.4));
    on("unpick", () => this.pick(-1));
    on("about", () => find("telling").showModal());
    find("slider").addEventListener("input", (event) => {
      clock.playing = false;
      this.goTo(clock.positionOf(Number(event.target.value)));
    });
    find("speed").addEventListener("change", (event) => {
      clock.speed = Number(event.target.value);
    });
    find("bodies").addEventListener("change", (event) => this.pick(Number(event.target.value)));
    for (const dialog of document.querySelectorAll("dialog")) {
      dialog.querySelector(".close").addEventListener("click", () => dialog.close());
      dialog.addEventListener("click", (event) => {
        if (event.target === dialog) dialog.close();
      });
    }
    document.addEventListener("pointerdown", (event) => {
      if (!event.target.closest("#layers, #show")) this.openLayers(false);
    });
    document.addEventListener("keydown", (event) => this.key(event));
    for (const kind of ["click", "change"]) { // what was clicked gives the keys back: Space plays again
      document.addEventListener(kind, ({ target, detail }) => {
        if (detail || kind === "change") target.closest("button, select")?.blur();
      });
    }
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    scheme.addEventListener("change", (event) => this.setDark(event.matches));
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.listenToPointers();
  }

  // Drag, pinch, wheel and click on the picture.
  listenToPointers() {
    const { canvas, picture } = this, held = new Map();
    let moved = 0;
    const spread = () => {
      const [a, b] = [...held.values()];
      return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, far: Math.hypot(a.x - b.x, a.y - b.y) };
    };
    const at = (event) => ({ x: event.offsetX, y: event.offsetY });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (held.size === 0) moved = 0;
      held.set(event.pointerId, at(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      const here = at(event), before = held.get(event.pointerId);
      if (!before) {
        canvas.classList.toggle("over", picture.bodyAt(here.x, here.y, NEAR.mouse) >= 0);
        return;
      }
      moved += Math.hypot(here.x - before.x, here.y - before.y);
      if (held.size === 2) {
        const old = spread();
        held.set(event.pointerId, here);
        const now = spread();
        picture.camera.pan(now.x - old.x, now.y - old.y);
        if (old.far > 0) picture.camera.zoom(now.far / old.far, now.x, now.y);
      } else {
        held.set(event.pointerId, here);
        if (moved > (event.pointerType === "mouse" ? 3 : 8)) {
          canvas.classList.add("dragged");
          picture.camera.pan(here.x - before.x, here.y - before.y);
        }
      }
    });
    const release = (event) => {
      const clicked = held.size === 1 && held.has(event.pointerId) && event.type === "pointerup";
      held.delete(event.pointerId);
      if (held.size === 0) canvas.classList.remove("dragged");
      if (clicked && moved <= (event.pointerType === "mouse" ? 3 : 8)) {
        const { x, y } = at(event);
        this.pick(picture.bodyAt(x, y, NEAR[event.pointerType] ?? 8));
      }
      if (held.size > 0) moved = Infinity; // what is left of a pinch picks nothing
    };
    canvas.addEventListener("pointerup", release);
    canvas.addEventListener("pointercancel", release);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 0 ? event.deltaY / 100 : event.deltaY / 3;
      const { x, y } = at(event);
      this.zoom(1.2 ** -Math.min(Math.max(lines, -3), 3), x, y);
    }, { passive: false });
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented) return;
    if (document.querySelector("dialog[open]")) return; // which has its own
    const { target } = event;
    const control = target.closest?.("button, select, input")?.tagName;
    const slides = target.id === "slider", moves = /^(Arrow|Home|End|Page)/.test(event.key);
    if (control === "SELECT" && event.key !== "Escape" && event.key !== "F1") return;
    if (control === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
    if (slides && moves && !event.shiftKey && event.key !== "PageUp" && event.key !== "PageDown") return;
    const act = this.action(event.key, event.shiftKey);
    if (!act) return;
    event.preventDefault();
    act();
  }

  // What a key does.
  action(key, shift) {
    if (shift && key in ARROWS) {
      return () => {
        this.picture.camera.pan(...ARROWS[key]);
      };
    }
    const layer = this.layers.find((each) => each.key === key.toLowerCase());
    if (layer) return () => this.toggle(layer.name, layer.along);
    const label = LABELS[key] ?? (key.length === 1 ? key.toUpperCase() : key);
    const act = (shift && actionOf(`Shift+${label}`)) || actionOf(label);
    return act && (() => act(this));
  }

  playOrPause() {
    const { clock } = this;
    if (clock.playing) clock.playing = false;
    else clock.play();
    this.say(clock.playing ? "Playing" : `Paused at ${this.seconds(clock.time)} s`);
  }

  goTo(position) {
    this.clock.playing = false;
    this.clock.go(position);
  }

  faster(steps) {
    this.clock.faster(steps);
    find("speed").value = this.clock.speed;
    this.say(`Speed ${this.clock.speed}`);
  }

  setLoop(loop) {
    this.clock.loop = loop;
    find("loop").setAttribute("aria-pressed", loop);
  }

  zoom(factor, px, py) {
    this.picture.camera.zoom(factor, px, py);
  }

  fit() {
    this.picture.camera.fit();
  }

  setDark(dark) {
    document.documentElement.classList.toggle("dark", dark);
    find("dark").setAttribute("aria-pressed", dark);
    this.look.dark = dark;
  }

  // Go to the next row at which a contact begins, or to the one before; forces are shown there.
  goToContact(before) {
    const rows = this.record.columns["marks:collision"]?.values ?? [], { position } = this.clock;
    const found = before ? rows.filter((row) => row < position).at(-1) : rows.find((row) => row > position);
    for (const layer of this.layers) {
      if (layer.name === "forces" || layer.name === "impulses") this.look[layer.name] = true;
    }
    this.goTo(found ?? (before ? 0 : this.clock.last));
  }

  // A key switches other layers along with its own.
  toggle(layer, along = []) {
    const on = !this.look[layer];
    for (const name of [layer, ...along]) this.look[name] = on;
    if (layer === "grid") this.resize();
  }

  openLayers(open) {
    find("layers").hidden = !open;
    find("show").setAttribute("aria-expanded", open);
  }

  pick(body) {
    if (body === this.look.picked) return;
    this.look.picked = body;
    find("bodies").value = body;
    this.panel.pick(body);
    this.say(body < 0 ? "Nothing is picked" : `${this.record.bodies[body].name} is picked`);
  }

  // Tell a screen reader.
  say(words) {
    find("live").textContent = words;
  }

  resize() {
    const { width, height } = this.canvas.getBoundingClientRect();
    this.picture.resize(width, height, Math.min(window.devicePixelRatio || 1, 3), this.look.grid);
    this.drawn = "";
  }

  // -- one moment after the other ---------------------------------------------------------------

  tick(now) {
    const { clock } = this, played = clock.playing;
    clock.pass(Math.min((now - this.before) / 1000, 0.5)); // no leap after the page was hidden
    this.before = now;
    if (played && !clock.playing) this.say(`The end: ${this.ending()}`);
    this.show(now);
    requestAnimationFrame((next) => this.tick(next));
  }

  show(now) {
    const { clock, picture, look } = this, { camera } = picture;
    const state = () => JSON.stringify([clock.position, clock.playing, camera.key, look]);
    if (this.drawn === state()) return;
    picture.move(clock.position);
    picture.draw(look);
    this.drawn = state();
    this.legend.draw(look, camera, picture.ratio, this.layers.map(({ name }) => name));
    this.marks.draw(clock);
    this.panel.write();
    const row = Math.floor(clock.rowAt(clock.position) + 1e-9), time = `${this.seconds(clock.time)} / ${this.seconds(clock.end)} s`;
    find("slider").value = row;
    if (find("time").textContent !== time) find("time").textContent = time;
    if (document.body.classList.toggle("playing", clock.playing)) find("play").setAttribute("aria-label", "Pause");
    else find("play").setAttribute("aria-label", "Play");
    find("speed").value = clock.speed;
    for (const { name } of this.layers) find(`layer-${name}`).setAttribute("aria-pressed", Boolean(look[name]));
    if (!clock.playing || now - this.said > 500) {
      this.said = now;
      const at = `${this.seconds(clock.time)} s of ${this.seconds(clock.end)} s`;
      find("slider").setAttribute("aria-valuetext", at);
      this.canvas.setAttribute("aria-label", this.description());
    }
    const over = clock.atEnd && !clock.playing;
    find("banner").hidden = !over;
    find("banner").classList.toggle("broken", !this.record.finished);
    if (over) find("banner").textContent = this.ending();
  }

  description() {
    const { robots } = this.picture, props = this.record.bodies.length - robots;
    const what = `${robots} robot${robots === 1 ? "" : "s"}${props ? ` and ${props} prop${props === 1 ? "" : "s"}` : ""}`;
    return `${this.record.title}: ${what}, seen from above at ${this.seconds(this.clock.time)} s`;
  }
}

function trouble(words) {
  find("trouble").textContent = words;
  find("trouble").hidden = false;
}

if (!("DecompressionStream" in window)) {
  trouble("This browser is too old to unpack the replay: it needs one from 2023 or later.");
} else {
  readRecord(find("record").textContent).then(
    (record) => new Replay(record),
    () => trouble("This file is damaged: what it holds of the run can't be unpacked."),
  );
}
