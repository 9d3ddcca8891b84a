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
    this.leaps = record.bodies.map(() => new Set()); // the rows on the way to which there is no line
    const { values: rows } = record.columns["leaps:row"], { values: leapt } = record.columns["leaps:body"];
    rows.forEach((row, k) => this.leaps[leapt[k]].add(row));
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

  // -- drawing ----------------------------------------------------------------------------------

  draw(look) {
    const context = this.canvas.getContext("2d"), painter = new Painter(context, this.camera, this.images);
    this.drawStill(look);
    this.put(context, this.still);
    for (const { name, stands } of this.record.layers) {
      if (look[name] && !stands) {
        if (name === "trails") this.drawTrails(painter);
        else this.paintLayer(painter, name);
      }
      if (name === this.record.lastBodies && look.picked >= 0) this.drawPicked(painter, look.picked);
    }
    if (look.grid) this.drawNumbers(context);
  }

  // Put one canvas on another, pixel by pixel.
  put(context, canvas) {
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(canvas, 0, 0);
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
  }

  paintLayer(painter, name) {
    const drawings = this.drawn[name];
    for (const each of drawings?.drawings ?? []) {
      const scene = drawings.sceneAt(each, this.row);
      if (scene < 0) continue;
      if (each.body !== null) painter.at(this.x[each.body], this.y[each.body], each.upright ? 0 : this.theta[each.body]);
      if (drawings.every) drawings.paintBetween(painter, scene, each.end, this.position);
      else drawings.paint(painter, scene);
      painter.world();
    }
  }

  drawStill(look) {
    const { camera, record } = this;
    const layers = record.layers.filter(({ name, stands }) => stands && look[name]).map(({ name }) => name);
    const scenes = layers.map((name) => (this.drawn[name]?.drawings ?? []).map(
      (each) => this.drawn[name].sceneAt(each, this.row)));
    const key = [camera.key, ...layers, ...scenes].join();
    if (key === this.stillKey) return;
    this.stillKey = key;
    const context = this.still.getContext("2d");
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.fillStyle = record.ground;
    context.fillRect(0, 0, camera.width, camera.height);
    const painter = new Painter(context, camera, this.images);
    for (const name of layers) {
      if (name === "grid") this.drawGrid(context);
      else this.paintLayer(painter, name);
    }
  }

  // Where the grid is, in metres, and how far apart its lines are.
  gridOf() {
    const { camera } = this, least = LEAST_GRID / camera.scale;
    const power = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 5, 10].map((k) => k * power).find((value) => value >= least * (1 - 1e-9));
    const [left, top] = camera.toWorld(0, 0), [right, bottom] = camera.toWorld(camera.width, camera.height);
    const [xmin, xmax, ymin, ymax] = this.record.grid ?? [left, right, bottom, top];
    const area = [Math.max(left, xmin), Math.min(right, xmax), Math.max(bottom, ymin), Math.min(top, ymax)];
    const ticks = (low, high) => {
      const found = [];
      for (let k = Math.ceil(low / step - 1e-6); k <= high / step + 1e-6; k++) found.push(k * step);
      return found;
    };
    return { step, area, xs: ticks(area[0], area[1]), ys: ticks(area[2], area[3]) };
  }

  drawGrid(context) {
    const { camera } = this, { area, xs, ys } = this.gridOf(), { grid, grid_axis: axis } = this.record.colors;
    const [left, top] = camera.toPixels(area[0], area[3]), [right, bottom] = camera.toPixels(area[1], area[2]);
    for (const x of xs) {
      context.fillStyle = Math.abs(x) < 1e-9 ? axis : grid;
      context.fillRect(Math.round(camera.x + camera.scale * x), top, 1, bottom - top);
    }
    for (const y of ys) {
      context.fillStyle = Math.abs(y) < 1e-9 ? axis : grid;
      context.fillRect(left, Math.round(camera.y - camera.scale * y), right - left, 1);
    }
  }

  // The metres along the left and lower side of the grid, or of what is seen of it.
  drawNumbers(context) {
    const { camera } = this, { step, area, xs, ys } = this.gridOf();
    if (!(area[0] < area[1] && area[2] < area[3])) return;
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const below = Math.min(camera.y - camera.scale * area[2] + 14, camera.height - 12);
    const beside = Math.max(camera.x + camera.scale * area[0] - 7, 40);
    const write = (value, x, y, align) => {
      const text = (Math.abs(value) < step / 2 ? 0 : value).toFixed(decimals).replace("-", "\u2212");
      context.textAlign = align;
      context.strokeText(text, x, y);
      context.fillText(text, x, y);
    };
    Object.assign(context, {
      font: `12px ${FONT}`, textBaseline: "middle", lineWidth: 3, strokeStyle: this.record.ground,
      fillStyle: this.record.colors.muted,
    });
    for (const y of ys) {
      const py = camera.y - camera.scale * y;
      if (py > 8 && py < below - 14) write(y, beside, py, "right");
    }
    for (const x of xs) {
      const px = camera.x + camera.scale * x;
      if (px > beside - 2 && px < camera.width - 8) write(x, px, below, "center");
    }
  }

  // -- paths ------------------------------------------------------------------------------------

  // The paths up to the row grow on a canvas of their own; dashed ones and marks are drawn anew.
  drawTrails(painter) {
    const context = this.paths.getContext("2d"), { key } = this.camera, { row } = this;
    const grows = key === this.pathsKey && this.pathRow <= row && this.bodies[0].trail[3] === "-";
    if (!grows) {
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, this.paths.width, this.paths.height);
    }
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const growing = new Painter(context, this.camera, this.images);
    for (let i = 0; i < this.bodies.length; i++) this.drawPath(growing, i, grows ? Math.max(this.pathRow - 1, 0) : 0, row);
    [this.pathsKey, this.pathRow] = [key, row];
    this.put(painter.context, this.paths);
    this.bodies.forEach(({ trail }, i) => {
      const [x, y] = this.placeAt(row, i), end = [this.x[i], this.y[i]];
      if (trail[3] === "-") painter.line(trail, [x, y, ...end, ...end], 0, 6, 1); // of two points it would be thin
    });
  }

  // Draw a body's path between two rows, in pieces between its leaps.
  drawPath(painter, i, from, to) {
    let piece = [];
    const draw = () => piece.length > 2 && painter.line(this.bodies[i].trail, piece, 0, piece.length, 1);
    for (let row = from; row <= to; row++) {
      if (this.leaps[i].has(row) && row > from) {
        draw();
        piece = [];
      }
      const [x, y] = this.placeAt(row, i);
      piece.push(x, y);
    }
    draw();
  }

  drawPicked(painter, body) {
    const [x, y, radius] = this.bound(body), { paper, running } = this.record.colors;
    for (const [color, width] of [[paper, 5], [running[0], 2.5]]) {
      painter.circle(["circle", null, color, width, 6], [x, y, radius], 0, 3, 1);
    }
  }
}
