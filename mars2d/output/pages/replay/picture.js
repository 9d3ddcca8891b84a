// The picture of one moment, layer by layer: what stands still and the paths are kept, all else is
// drawn anew.

const LEAST_GRID = 42; // pixels between its lines

class Picture {
  constructor(canvas, record, clock) {
    Object.assign(this, { canvas, record, clock });
    this.columns = record.columns;
    this.bodies = record.bodies;
    this.robots = record.bodies.filter((body) => body.robot).length;
    this.camera = new Camera(record.view);
    this.images = imagesOf(record.columns);
    this.drawn = Object.fromEntries(Object.entries(record.drawn).map(
      ([name, header]) => [name, new Drawings(header, record.columns)]));
    this.x = new Float64Array(this.bodies.length);
    this.y = new Float64Array(this.bodies.length);
    this.theta = new Float64Array(this.bodies.length);
    this.still = document.createElement("canvas");
    this.paths = document.createElement("canvas");
    this.stillKey = this.pathsKey = "";
    this.pathRow = 0;
    this.ends = [];
    this.leaps = record.bodies.map(() => new Set()); // the rows on the way to which there is no line
    const { values: rows } = record.columns["leaps:row"], { values: leapt } = record.columns["leaps:body"];
    rows.forEach((row, k) => this.leaps[leapt[k]].add(row));
    this.namePlaces = new Map(); // of the names in the last picture
    this.ui = 1; // pixels of the page for one of the picture
  }

  resize(width, height, ratio, numbers) {
    if (!(width > 0 && height > 0)) return;
    const size = { width: Math.round(width * ratio), height: Math.round(height * ratio) };
    for (const canvas of [this.canvas, this.still, this.paths]) Object.assign(canvas, size);
    this.ratio = ratio;
    const edge = 12;
    this.camera.resize(width, height, {
      left: numbers ? 44 : edge, bottom: numbers ? 30 : edge, right: edge, top: edge,
    });
    this.stillKey = this.pathsKey = "";
  }

  // -- where everything is ----------------------------------------------------------------------

  // Put all bodies where they are at a position between two rows.
  move(position) {
    const row = Math.floor(position), next = Math.min(row + 1, this.columns.places.rows - 1);
    this.bodies.forEach((_, i) => {
      const share = this.leaps[i].has(row + 1) ? 0 : position - row; // what is put elsewhere stays until then
      const before = this.placeAt(row, i), after = this.placeAt(next, i);
      [this.x[i], this.y[i], this.theta[i]] = before.map((value, k) => value * (1 - share) + after[k] * share);
    });
    this.position = position;
    this.row = row;
  }

  placeAt(row, body) {
    const { places, headings } = this.columns, n = this.bodies.length;
    const [low, bottom] = places.entry.low;
    return [low + places.at(row, body), bottom + places.at(row, n + body), headings.at(row, body)];
  }

  // The centre [m] and the radius of the circle round a body.
  bound(i) {
    const [ahead, left, radius] = this.bodies[i].bound;
    const c = Math.cos(this.theta[i]), s = Math.sin(this.theta[i]);
    return [this.x[i] + c * ahead - s * left, this.y[i] + s * ahead + c * left, radius];
  }

  // The body that is drawn at a pixel, or -1: the nearest of those within reach.
  bodyAt(px, py, reach) {
    let found = -1, nearest = Infinity;
    for (let i = 0; i < this.bodies.length; i++) {
      const [x, y, radius] = this.bound(i), { camera } = this;
      const [across, down] = camera.toPixels(x, y), off = Math.hypot(across - px, down - py);
      if (off <= Math.max(camera.scale * radius, reach) && off < nearest) [found, nearest] = [i, off];
    }
    return found;
  }

  // How fast a body moved and turned on the way to the row.
  velocity(i) {
    const { row } = this;
    if (row < 1 || this.leaps[i].has(row)) return [0, 0];
    const before = this.placeAt(row - 1, i), after = this.placeAt(row, i);
    const spent = this.clock.timeOf(row) - this.clock.timeOf(row - 1);
    const speed = Math.hypot(after[0] - before[0], after[1] - before[1]) / spent;
    return [speed, (after[2] - before[2]) / spent];
  }

  // The contacts of the control step that led to the row, or of the last one with arrows, the
  // strongest first.
  contacts() {
    const row = this.columns["contacts:row"];
    if (!row) return [];
    const shown = this.columns["contacts:shown"].values, wanted = shown[countUpTo(shown, this.row) - 1];
    const end = countUpTo(row.values, wanted), begin = countUpTo(row.values, wanted - 1);
    const of = (name, k) => this.columns[`contacts:${name}`].at(k);
    const { words } = this.columns["contacts:force"].entry;
    return Array.from({ length: end - begin }, (_, i) => (
      { a: of("a", begin + i), b: of("b", begin + i), force: words[of("force", begin + i)] }));
  }

  effort(i) {
    return this.columns.effort.at(this.row, i);
  }

  // -- drawing ----------------------------------------------------------------------------------

  draw(look) {
    const context = this.canvas.getContext("2d"), { camera } = this;
    const painter = new Painter(context, camera, look.dark, this.images);
    this.drawStill(look);
    this.put(context, this.still);
    for (const { name, stands } of this.record.layers) {
      if (look[name] && !stands) {
        if (name === "trails") this.drawTrails(context, look);
        else if (name === "sensors") this.drawSensors(painter, look);
        else if (name === "names") this.drawNames(painter, look);
        else this.paintLayer(painter, name);
      }
      if (name === this.record.lastBodies && look.picked >= 0) this.drawPicked(context, look);
    }
    if (look.grid) this.drawNumbers(painter, look);
  }

  // Put one canvas on another, pixel by pixel.
  put(context, canvas) {
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(canvas, 0, 0);
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
  }

  paintLayer(painter, name) {
    const layer = this.drawn[name];
    if (layer) for (const each of layer.drawings) this.paintDrawing(painter, layer, each);
  }

  drawNames(painter, look) {
    const layer = this.drawn.names, { camera } = this;
    if (!layer) return;
    const boxOf = (i) => {
      const [x, y, radius] = this.bound(i), ring = i === look.picked ? 11 : 0;
      const far = Math.max(camera.scale * radius + ring, this.bodies[i].ring ?? 0);
      return [...camera.toPixels(x, y), far, far];
    };
    const orderOf = (each) => layer.orders[layer.order[layer.sceneAt(each, this.row)]];
    const isName = (each) => each.body !== null && orderOf(each).length === 1;
    const named = layer.drawings.filter(isName);
    for (const each of layer.drawings) if (!isName(each)) this.paintDrawing(painter, layer, each);
    const labels = named.map((each) => {
      const [[style]] = orderOf(each), [, text, color, size, , halo] = layer.styles[style];
      return { body: boxOf(each.body), text, color, size, halo, wide: 0.5 * LETTER * size * text.length, high: 0.6 * size };
    });
    const view = [camera.width / 2, camera.height / 2, camera.width / 2, camera.height / 2];
    const picked = named.findIndex(({ body }) => body === look.picked);
    const placed = placedNames(labels, this.bodies.map((_, i) => boxOf(i)), view, picked, this.namePlaces);
    this.namePlaces = new Map(placed.map(({ place }, i) => [i, place]));
    placed.forEach(({ box: [x, y], place }, i) => {
      const { body, text, color, size, halo } = labels[i], { context } = painter;
      if (NAME_PLACES[place][0] > 1) {
        context.beginPath();
        context.moveTo(body[0], body[1]);
        context.lineTo(x, y);
        painter.ink(null, color, 0.7);
      }
      if (place) painter.words(text, x, y, color, size, "center", halo);
      else painter.words(text, body[0], body[1] - body[2], color, size, "above", halo);
    });
  }

  drawStill(look) {
    const { camera, record } = this;
    const layers = record.layers.filter(({ name, stands }) => stands && look[name]).map(({ name }) => name);
    const scenes = layers.map((name) => (this.drawn[name]?.drawings ?? []).map(
      (each) => this.drawn[name].sceneAt(each, this.row)));
    const key = [camera.key, look.dark, ...layers, ...scenes].join();
    if (key === this.stillKey) return;
    this.stillKey = key;
    const context = this.still.getContext("2d"), { colors } = look;
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.fillStyle = record.workspace ? colors.page : colors.paper;
    context.fillRect(0, 0, camera.width, camera.height);
    const painter = new Painter(context, camera, look.dark, this.images);
    for (const name of layers) {
      if (name === "grid") this.drawGrid(context, colors);
      else this.paintLayer(painter, name);
    }
  }

  // Where the grid is, in metres, and how far apart its lines are.
  gridOf() {
    const { camera } = this, least = LEAST_GRID / camera.scale;
    const power = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 5, 10].map((k) => k * power).find((value) => value >= least * (1 - 1e-9));
    const [left, top] = camera.toWorld(0, 0), [right, bottom] = camera.toWorld(camera.width, camera.height);
    let area = [left, right, bottom, top];
    if (this.record.grid) {
      const [xmin, xmax, ymin, ymax] = this.record.grid;
      area = [Math.max(left, xmin), Math.min(right, xmax), Math.max(bottom, ymin), Math.min(top, ymax)];
    }
    const ticks = (low, high) => {
      const found = [];
      for (let k = Math.ceil(low / step - 1e-6); k <= high / step + 1e-6; k++) found.push(k * step);
      return found;
    };
    return { step, area, xs: ticks(area[0], area[1]), ys: ticks(area[2], area[3]) };
  }

  drawGrid(context, colors) {
    const { camera } = this, { area, xs, ys } = this.gridOf();
    const [left, top] = camera.toPixels(area[0], area[3]), [right, bottom] = camera.toPixels(area[1], area[2]);
    for (const x of xs) {
      context.fillStyle = Math.abs(x) < 1e-9 ? colors["grid-axis"] : colors.grid;
      context.fillRect(Math.round(camera.x + camera.scale * x), top, 1, bottom - top);
    }
    for (const y of ys) {
      context.fillStyle = Math.abs(y) < 1e-9 ? colors["grid-axis"] : colors.grid;
      context.fillRect(left, Math.round(camera.y - camera.scale * y), right - left, 1);
    }
  }

  // The metres along the left and lower side of the grid, or of what is seen of it.
  drawNumbers(painter, look) {
    const { camera } = this, { context } = painter, { step, area, xs, ys } = this.gridOf();
    if (!(area[0] < area[1] && area[2] < area[3])) return;
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const label = (value) => (Math.abs(value) < step / 2 ? 0 : value).toFixed(decimals).replace("-", "\u2212");
    const below = Math.min(camera.y - camera.scale * area[2] + 14, camera.height - 12);
    const beside = Math.max(camera.x + camera.scale * area[0] - 7, 40);
    const write = (text, x, y, align) => {
      context.textAlign = align;
      const wide = context.measureText(text).width + 6;
      context.globalAlpha = 0.8;
      context.fillStyle = this.record.workspace ? look.colors.page : look.colors.paper;
      context.fillRect(align === "right" ? x - wide + 3 : x - wide / 2, y - 8, wide, 16);
      context.globalAlpha = 1;
      context.fillStyle = look.colors.muted;
      context.fillText(text, x, y);
    };
    context.font = `12px ${FONT}`;
    context.textBaseline = "middle";
    for (const y of ys) {
      const py = camera.y - camera.scale * y;
      if (py > 8 && py < below - 14) write(label(y), beside, py, "right");
    }
    for (const x of xs) {
      const px = camera.x + camera.scale * x;
      if (px > beside - 2 && px < camera.width - 8) write(label(x), px, below, "center");
    }
  }

  // -- paths ------------------------------------------------------------------------------------

  drawTrails(context, look) {
    this.drawPaths(look);
    this.put(context, this.paths);
    this.drawLooseEnds(context, look);
  }

  // As it looks with its opacity on the paper: pieces of a path overlap.
  trailColor(i, look) {
    return laidOver(shade(this.bodies[i].trail[0], look.dark), look.colors.paper);
  }

  // Prolong the paths on their own canvas up to the row, or draw them from the start.
  drawPaths(look) {
    const key = `${this.camera.key} ${look.dark}`;
    if (key !== this.pathsKey || this.pathRow > this.row) {
      this.pathsKey = key;
      this.paths.getContext("2d").setTransform(1, 0, 0, 1, 0, 0);
      this.paths.getContext("2d").clearRect(0, 0, this.paths.width, this.paths.height);
      this.ends = this.bodies.map(() => ({ row: 0, along: 0 }));
      this.pathRow = 0;
    }
    const context = this.paths.getContext("2d");
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    for (let i = 0; i < this.bodies.length; i++) this.prolong(context, i, this.ends[i], look);
    this.pathRow = this.row;
  }

  // A body's path after a row, in pixels, without steps too short to be seen: no dots on top of dots.
  *stepsAfter(start, i) {
    let [px, py] = this.pixelsAt(start, i);
    for (let row = start + 1; row <= this.row; row++) {
      const [x, y] = this.pixelsAt(row, i), length = Math.hypot(x - px, y - py);
      const leapt = this.leaps[i].has(row); // it was put there, and went no way
      if (!leapt && length < 1.5) continue;
      yield { row, x, y, leapt, length };
      [px, py] = [x, y];
    }
  }

  pixelsAt(row, i) {
    const [x, y] = this.placeAt(row, i);
    return this.camera.toPixels(x, y);
  }

  prolong(context, i, end, look) {
    const [, width, style] = this.bodies[i].trail, { marker, dashes, solid } = wakeOf(style);
    const start = this.pixelsAt(end.row, i), marks = end.row === 0 && end.along === 0 ? [start] : [];
    const offset = end.along;
    context.beginPath();
    context.moveTo(...start);
    for (const { row, x, y, leapt, length } of this.stepsAfter(end.row, i)) {
      end.row = row;
      if (leapt) {
        context.moveTo(x, y);
        continue;
      }
      context.lineTo(x, y);
      const before = end.along;
      end.along += length;
      if (Math.floor(end.along / MARK_SPACING) > Math.floor(before / MARK_SPACING)) marks.push([x, y]);
    }
    this.pathInk(context, i, look);
    if (solid || dashes) {
      context.setLineDash(dashes ?? []);
      context.lineDashOffset = offset;
      context.stroke();
      context.setLineDash([]);
    }
    if (!marker) return;
    const painter = new Painter(context, this.camera, false, this.images);
    for (const [x, y] of marks) painter.mark(marker, x, y, this.trailColor(i, look), width);
  }

  pathInk(context, i, look) {
    context.strokeStyle = this.trailColor(i, look);
    context.globalAlpha = 1;
    context.lineWidth = this.bodies[i].trail[1];
    context.lineJoin = "round";
  }

  // From where each path was last drawn to where its body is; and the path of the picked one, broad.
  drawLooseEnds(context, look) {
    const here = (i) => this.camera.toPixels(this.x[i], this.y[i]);
    for (let i = 0; i < this.bodies.length; i++) {
      if (!wakeOf(this.bodies[i].trail[2]).solid) continue;
      this.pathInk(context, i, look);
      context.beginPath();
      context.moveTo(...this.pixelsAt(this.ends[i].row, i));
      context.lineTo(...here(i));
      context.stroke();
    }
    const i = look.picked;
    if (i < 0) return;
    context.beginPath();
    context.moveTo(...this.pixelsAt(0, i));
    for (const { x, y, leapt } of this.stepsAfter(0, i)) {
      if (leapt) context.moveTo(x, y);
      else context.lineTo(x, y);
    }
    context.lineTo(...here(i));
    this.pathInk(context, i, look);
    context.lineWidth = 3.2;
    context.stroke();
  }

  // -- what is laid over ------------------------------------------------------------------------

  paintDrawing(painter, drawings, each) {
    const scene = drawings.sceneAt(each, this.row);
    if (scene < 0) return;
    if (each.body !== null) {
      const i = each.body;
      if (each.stays) painter.at(...this.placeAt(drawings.rowOf(scene, this.row), i));
      else if (each.upright) painter.at(this.x[i], this.y[i], 0);
      else painter.at(this.x[i], this.y[i], this.theta[i]);
    }
    if (drawings.every) drawings.paintBetween(painter, scene, each.end, this.position);
    else drawings.paint(painter, scene);
    painter.world();
  }

  // Of a robot that is picked its own sensors alone, of which it has some.
  drawSensors(painter, look) {
    const { sensors } = this.drawn;
    if (!sensors) return;
    const own = sensors.drawings.filter((each) => each.body === look.picked);
    for (const each of own.length ? own : sensors.drawings) this.paintDrawing(painter, sensors, each);
  }

  drawPicked(context, look) {
    const [x, y, radius] = this.bound(look.picked), { camera } = this;
    const far = camera.scale * radius + 6;
    for (const [color, width] of [[look.colors.paper, 5], [look.colors.running, 2.5]]) {
      context.beginPath();
      context.arc(...camera.toPixels(x, y), far, 0, 2 * Math.PI);
      context.strokeStyle = color;
      context.lineWidth = width;
      context.stroke();
    }
  }
}
