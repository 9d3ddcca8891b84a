// The picture of one moment: what stands still and the paths are kept, what moves is drawn anew.

const FORCE = "#a3003c", SLIP = "#ffc20a", SLIP_EDGE = "#3d2f00", SLIPPING = 0.999;
const LOST_LINK = "#c92a2a", INK = "#3d4852", ROPE = "#7a5c2e", STEEL = "#52606d";
const MESSAGE_LINKS = 400, LABELS = 6, LABELED = 0.15;
const LEAST_GRID = 42; // pixels between its lines

class Picture {
  constructor(canvas, record) {
    this.canvas = canvas;
    this.record = record;
    this.columns = record.columns;
    this.bodies = record.bodies;
    this.robots = record.bodies.filter((body) => body.robot).length;
    this.camera = new Camera(record.view);
    this.images = imagesOf(record.columns);
    const drawings = (name) => record[name] && new Drawings(record[name], record.columns);
    this.ground = drawings("ground");
    this.addons = drawings("addons");
    this.theory = drawings("theory");
    this.sensors = drawings("sensors");
    this.x = new Float64Array(this.bodies.length);
    this.y = new Float64Array(this.bodies.length);
    this.theta = new Float64Array(this.bodies.length);
    this.still = document.createElement("canvas");
    this.paths = document.createElement("canvas");
    this.stillKey = this.pathsKey = "";
    this.pathRow = 0;
    this.ends = [];
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
    const { places, headings } = this.columns, rows = places.rows, n = this.bodies.length;
    const row = Math.floor(position), next = Math.min(row + 1, rows - 1), share = position - row;
    const between = (values, k) =>
      values[k * rows + row] * (1 - share) + values[k * rows + next] * share;
    const [low, bottom] = places.entry.low;
    for (let i = 0; i < n; i++) {
      this.x[i] = low + places.step * between(places.values, i);
      this.y[i] = bottom + places.step * between(places.values, n + i);
      this.theta[i] = headings.step * between(headings.values, i);
    }
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
      const off = Math.hypot(camera.x + camera.scale * x - px, camera.y - camera.scale * y - py);
      if (off <= Math.max(camera.scale * radius, reach) && off < nearest) [found, nearest] = [i, off];
    }
    return found;
  }

  // How fast a body moved and turned on the way to the row.
  velocity(i) {
    const { row } = this;
    if (row < 1) return [0, 0];
    const before = this.placeAt(row - 1, i), after = this.placeAt(row, i);
    const spent = this.record.timeOf(row) - this.record.timeOf(row - 1);
    const speed = Math.hypot(after[0] - before[0], after[1] - before[1]) / spent;
    return [speed, (after[2] - before[2]) / spent];
  }

  // -- contacts and messages --------------------------------------------------------------------

  // The contacts of the control step that led to the row, the strongest first.
  contacts() {
    const row = this.columns["contacts:row"];
    if (!row) return [];
    const every = row.every, wanted = Math.floor(this.row / every) * every;
    const end = countUpTo(row.values, wanted), begin = countUpTo(row.values, wanted - 1);
    const of = (name, k, part) => this.columns[`contacts:${name}`].at(k, part);
    return Array.from({ length: end - begin }, (_, i) => {
      const k = begin + i, force = [of("force", k, 0), of("force", k, 1)];
      const [a, b] = [of("a", k), of("b", k)];
      const start = [this.x[a] + of("offset", k, 0), this.y[a] + of("offset", k, 1)];
      return { a, b, force, start, size: Math.hypot(...force) };
    });
  }

  // The messages that are under way, with how far each has got.
  messages() {
    const sent = this.columns["messages:time"];
    if (!sent) return [];
    const time = this.record.timeOf(this.position), dt = this.record.step, slack = 1e-6 * dt;
    const flight = this.columns["messages:flight"];
    this.longest ??= flight.values.reduce((most, v) => (v === MISSING ? most : Math.max(most, v)), 0);
    const oldest = (time - Math.max(this.longest * flight.step, dt) - dt) / sent.step;
    const begin = countUpTo(sent.values, oldest), end = countUpTo(sent.values, (time - slack) / sent.step);
    const found = [];
    for (let k = end - 1; k >= begin && found.length < MESSAGE_LINKS; k--) {
      const since = time - sent.values[k] * sent.step, lasts = flight.values[k] * flight.step;
      const arrives = flight.values[k] !== MISSING;
      if (since <= dt + slack || (arrives && since <= lasts + slack)) {
        const of = (name) => this.columns[`messages:${name}`].values[k];
        const fails = of("status") > 1;
        const share = arrives && lasts > 0 ? Math.min(since / lasts, 1) : 1;
        found.push({ one: of("sender"), other: of("receiver"), fails, share });
      }
    }
    return found;
  }

  effort(i) {
    return this.columns.effort.at(this.row, i);
  }

  // -- drawing ----------------------------------------------------------------------------------

  draw(look) {
    const context = this.canvas.getContext("2d"), { camera } = this;
    this.drawStill(look);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.still, 0, 0);
    if (look.trails) {
      this.drawPaths(look);
      context.drawImage(this.paths, 0, 0);
    }
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const painter = new Painter(context, camera, look.dark, this.images);
    if (look.trails) this.drawLooseEnds(context, look);
    if (look.sensors) this.drawSensors(painter, look);
    for (const part of ["addons", "theory"]) {
      if (look[part] && this[part]) {
        for (const each of this[part].drawings) this.paintDrawing(painter, this[part], each);
      }
    }
    if (look.messages) this.drawMessages(painter);
    const order = [...this.bodies.keys()].sort((i, j) => this.bodies[i].robot - this.bodies[j].robot);
    for (const i of order) {
      if (this.inSight(i)) painter.at(this.x[i], this.y[i], this.theta[i]).shapes(this.bodies[i].filled);
    }
    painter.world();
    for (const tie of this.record.ties) this.drawTie(painter, tie);
    if (look.picked >= 0) this.drawPicked(context, look);
    if (look.contacts) this.drawContacts(painter);
    if (look.names) this.drawNames(painter);
    if (look.grid) this.drawNumbers(painter, look);
  }

  inSight(i) {
    const [x, y, radius] = this.bound(i), { camera } = this, reach = camera.scale * radius + 12;
    const px = camera.x + camera.scale * x, py = camera.y - camera.scale * y;
    return px > -reach && py > -reach && px < camera.width + reach && py < camera.height + reach;
  }

  groundScenes() {
    return this.ground.drawings.map((drawing) => this.ground.sceneAt(drawing, this.row));
  }

  drawStill(look) {
    const { camera, record } = this, scenes = this.groundScenes();
    const key = [camera.key, look.dark, look.grid, ...scenes].join();
    if (key === this.stillKey) return;
    this.stillKey = key;
    const context = this.still.getContext("2d");
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const colors = look.colors, [workspace, floor, obstacles] = scenes;
    context.fillStyle = record.workspace ? colors.page : colors.paper;
    context.fillRect(0, 0, camera.width, camera.height);
    const painter = new Painter(context, camera, look.dark, this.images);
    if (workspace >= 0) this.ground.paint(painter, workspace);
    if (floor >= 0) this.ground.paint(painter, floor);
    if (look.grid) this.drawGrid(context, colors);
    if (workspace >= 0) {
      for (const [style, count] of this.ground.orders[this.ground.order[workspace]]) {
        const [kind, , stroke, width] = this.ground.styles[style];
        const edge = [kind, null, stroke, width];
        painter.shape(edge, this.ground.numbers, this.ground.begins[workspace], count, this.ground.step);
      }
    }
    if (obstacles >= 0) this.ground.paint(painter, obstacles);
    if (record.starts) {
      for (const body of this.bodies) painter.at(...body.start).shapes(body.hollow);
      painter.world();
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
    const [left, right, top, bottom] = [
      camera.x + camera.scale * area[0], camera.x + camera.scale * area[1],
      camera.y - camera.scale * area[3], camera.y - camera.scale * area[2],
    ];
    for (const x of xs) {
      context.fillStyle = Math.abs(x) < 1e-9 ? colors.axis : colors.grid;
      context.fillRect(Math.round(camera.x + camera.scale * x), top, 1, bottom - top);
    }
    for (const y of ys) {
      context.fillStyle = Math.abs(y) < 1e-9 ? colors.axis : colors.grid;
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

  // As it looks with some opacity on the paper: pieces of a path overlap.
  trailColor(i, look) {
    const { robot, color } = this.bodies[i], share = robot ? 0.85 : 0.6;
    const ink = shade(robot ? color : colorOf(numbersOf(color).map((value) => 0.45 * value)), look.dark);
    const paper = numbersOf(look.colors.paper);
    return colorOf(numbersOf(ink).map((value, k) => paper[k] + share * (value - paper[k])));
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

  prolong(context, i, end, look) {
    const { places } = this.columns, { rows } = places, { camera } = this, n = this.bodies.length;
    const scale = camera.scale * places.step;
    const left = camera.x + camera.scale * places.entry.low[0];
    const foot = camera.y - camera.scale * places.entry.low[1];
    const robot = this.bodies[i].robot;
    const { marker, dashes, solid } = wakeOf(robot ? this.record.wake : "-");
    const xs = i * rows, ys = (n + i) * rows;
    let px = left + scale * places.values[xs + end.row], py = foot - scale * places.values[ys + end.row];
    const marks = [], start = end.along;
    let drawn = false;
    context.beginPath();
    context.moveTo(px, py);
    if (marker && end.row === 0 && end.along === 0) marks.push([px, py]);
    for (let row = end.row + 1; row <= this.row; row++) {
      const x = left + scale * places.values[xs + row], y = foot - scale * places.values[ys + row];
      const length = Math.hypot(x - px, y - py);
      if (length < 1.5) continue; // no dots on top of dots; the loose end leads on to the body
      context.lineTo(x, y);
      const before = end.along;
      end.along += length;
      if (marker && Math.floor(end.along / MARK_SPACING) > Math.floor(before / MARK_SPACING)) marks.push([x, y]);
      end.row = row;
      [px, py] = [x, y];
      drawn = true;
    }
    this.pathInk(context, i, look);
    if (drawn && (solid || dashes)) {
      if (dashes) {
        context.setLineDash(dashes);
        context.lineDashOffset = start;
      }
      context.stroke();
      context.setLineDash([]);
    }
    if (marks.length) {
      const painter = new Painter(context, camera, false, this.images);
      for (const [x, y] of marks) painter.mark(marker, x, y, this.trailColor(i, look), 1.6);
    }
  }

  pathInk(context, i, look) {
    context.strokeStyle = this.trailColor(i, look);
    context.globalAlpha = 1;
    context.lineWidth = this.bodies[i].robot ? 1.6 : 1;
    context.lineJoin = "round";
  }

  // From where each path was last drawn to where its body is; and the path of the picked one, broad.
  drawLooseEnds(context, look) {
    const { camera } = this, wake = wakeOf(this.record.wake);
    for (let i = 0; i < this.bodies.length; i++) {
      if (this.bodies[i].robot && !wake.solid) continue;
      this.pathInk(context, i, look);
      context.beginPath();
      const [x, y] = this.placeAt(this.ends[i].row, i);
      context.moveTo(camera.x + camera.scale * x, camera.y - camera.scale * y);
      context.lineTo(camera.x + camera.scale * this.x[i], camera.y - camera.scale * this.y[i]);
      context.stroke();
    }
    if (look.picked < 0) return;
    const i = look.picked;
    context.beginPath();
    let px = Infinity, py = Infinity;
    for (let row = 0; row <= this.row + 1; row++) {
      const [x, y] = row > this.row ? [this.x[i], this.y[i]] : this.placeAt(row, i);
      const at = [camera.x + camera.scale * x, camera.y - camera.scale * y];
      if (row <= this.row && Math.hypot(at[0] - px, at[1] - py) < 1.5) continue;
      context.lineTo(...at);
      [px, py] = at;
    }
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
      if (each.stays) painter.at(...this.placeAt(this.row, i));
      else painter.at(this.x[i], this.y[i], this.theta[i]);
    }
    if (drawings.every) drawings.paintBetween(painter, scene, each.end, this.position);
    else drawings.paint(painter, scene);
    painter.world();
  }

  // Of a robot that is picked its own sensors alone, of which it has some.
  drawSensors(painter, look) {
    const own = (robot) => robot === look.picked;
    const fans = this.record.fans, drawn = this.sensors ? this.sensors.drawings : [];
    const alone = fans.some((fan) => own(fan.robot)) || drawn.some((each) => own(each.body));
    if (this.sensors) {
      for (const each of drawn) {
        if (!alone || own(each.body)) this.paintDrawing(painter, this.sensors, each);
      }
    }
    let first = 0;
    for (const fan of fans) {
      if (!alone || own(fan.robot)) this.drawFan(painter, fan, first);
      first += fan.beams;
    }
  }

  // The distances of a scanner at the row, and the row at which they were read.
  distances(fan, first) {
    const column = this.columns.fans, row = Math.floor(this.row / column.every);
    const start = row * column.width + first, far = new Float64Array(fan.beams);
    for (let k = 0; k < fan.beams; k++) {
      const level = column.values[start + k];
      far[k] = level > 254 ? Infinity : level / 254 * fan.range;
    }
    return { far, row: row * column.every };
  }

  drawFan(painter, fan, first) {
    const { far, row } = this.distances(fan, first), { context, camera } = painter;
    const [x, y, theta] = this.placeAt(row, fan.robot), [ahead, left, turned] = fan.mount;
    const c = Math.cos(theta), s = Math.sin(theta), color = this.bodies[fan.robot].color;
    const px = camera.x + camera.scale * (x + c * ahead - s * left);
    const py = camera.y - camera.scale * (y + s * ahead + c * left);
    const begin = theta + turned + fan.first;
    if (fan.cone) {
      far.forEach((length, k) => {
        const reach = camera.scale * Math.min(length, fan.range), middle = -begin - k * fan.apart;
        const sides = [middle - fan.cone / 2, middle + fan.cone / 2];
        context.beginPath();
        context.moveTo(px, py);
        context.arc(px, py, reach, ...sides);
        context.closePath();
        painter.ink(`${color}1a`);
        if (length > fan.range) return;
        context.beginPath();
        context.arc(px, py, reach, ...sides);
        painter.ink(null, `${color}e6`, 2);
      });
      return;
    }
    const hits = [];
    context.beginPath();
    if (!fan.closed) context.moveTo(px, py);
    for (let k = 0; k < far.length; k++) {
      const angle = begin + k * fan.apart, reach = camera.scale * Math.min(far[k], fan.range);
      const hx = px + reach * Math.cos(angle), hy = py - reach * Math.sin(angle);
      context.lineTo(hx, hy);
      if (far[k] <= fan.range) hits.push(hx, hy);
    }
    context.closePath();
    painter.ink(`${color}12`);
    context.fillStyle = painter.color(`${color}e6`);
    for (let k = 0; k < hits.length; k += 2) context.fillRect(hits[k] - 1, hits[k + 1] - 1, 2, 2);
  }

  drawMessages(painter) {
    const { context, camera } = painter;
    for (const { one, other, fails, share } of this.messages()) {
      const dx = this.x[other] - this.x[one], dy = this.y[other] - this.y[one];
      const apart = Math.hypot(dx, dy), sizes = [this.bodies[one].bound[2], this.bodies[other].bound[2]];
      if (apart <= sizes[0] + sizes[1]) continue;
      const c = dx / apart, s = dy / apart, aside = 0.3 * Math.min(...sizes);
      const pixel = (along) => [
        camera.x + camera.scale * (this.x[one] + along * c + aside * s),
        camera.y - camera.scale * (this.y[one] + along * s - aside * c),
      ];
      const tail = pixel(sizes[0]), tip = pixel(apart - sizes[1]);
      const part = (k) => [tail[0] + k * (tip[0] - tail[0]), tail[1] + k * (tip[1] - tail[1])];
      const color = this.bodies[one].color;
      context.beginPath();
      context.moveTo(...tail);
      context.lineTo(...tip);
      if (fails) {
        context.setLineDash([9, 6]);
        painter.ink(null, `${LOST_LINK}bf`, 1.1);
        context.setLineDash([]);
        painter.mark("x", ...part(0.6), LOST_LINK, 2.2);
      } else {
        painter.ink(null, `${color}80`, 1.1);
        const start = part(Math.max(share - 0.35, 0)), head = part(share);
        painter.dart(...start, head[0] - start[0], head[1] - start[1], `${color}e6`, null, 2.2);
      }
    }
  }

  drawTie(painter, tie) {
    const { context, camera } = painter;
    const placed = (body, [x, y]) => {
      if (body < 0) return [x, y];
      const c = Math.cos(this.theta[body]), s = Math.sin(this.theta[body]);
      return [this.x[body] + c * x - s * y, this.y[body] + s * x + c * y];
    };
    const start = placed(tie.a, tie.from), end = placed(tie.b, tie.to);
    const pixel = ([x, y]) => [camera.x + camera.scale * x, camera.y - camera.scale * y];
    const dot = (point, radius, fill, stroke, width) => {
      context.beginPath();
      context.arc(...pixel(point), radius, 0, 2 * Math.PI);
      painter.ink(fill, stroke, width);
    };
    if (tie.kind === "hinge") return dot(start, 4, "#ffffff", INK, 2);
    const apart = Math.hypot(end[0] - start[0], end[1] - start[1]);
    const normal = apart > 0 ? [-(end[1] - start[1]) / apart, (end[0] - start[0]) / apart] : [0, 1];
    const polyline = (pairs, stroke, width) => {
      context.beginPath();
      for (const [share, aside] of pairs) {
        context.lineTo(...pixel([0, 1].map((k) => start[k] + share * (end[k] - start[k]) + aside * normal[k])));
      }
      context.lineJoin = "round";
      painter.ink(null, stroke, width);
    };
    const straight = [[0, 0], [1, 0]];
    if (tie.kind === "rope") {
      const slack = tie.length - apart > 2e-3 * tie.length;
      const height = Math.sqrt(Math.max(tie.length ** 2 - apart ** 2, 0)) / 8 * (1 - 0.1 * apart / tie.length);
      const wave = Array.from({ length: 49 }, (_, k) => [k / 48, height * Math.sin(4 * Math.PI * k / 48)]);
      polyline(slack ? wave : straight, slack ? `${ROPE}bf` : ROPE, 2);
    } else if (tie.kind === "spring") {
      const height = 0.1 * Math.max(tie.length, 0.6);
      const lead = Math.min(0.1 * Math.max(tie.length, apart), 0.2 * apart) / Math.max(apart, 1e-9);
      const coils = Array.from({ length: 18 }, (_, k) =>
        [lead + (1 - 2 * lead) * (k + 0.5) / 18, k % 2 ? -height : height]);
      polyline([[0, 0], [lead, 0], ...coils, [1 - lead, 0], [1, 0]], STEEL, 1.8);
    } else {
      polyline(straight, "#ffffff", 6);
      polyline(straight, STEEL, 4);
    }
    for (const point of [start, end]) dot(point, 3, tie.kind === "rope" ? ROPE : STEEL);
  }

  drawPicked(context, look) {
    const [x, y, radius] = this.bound(look.picked), { camera } = this;
    const far = camera.scale * radius + 6;
    for (const [color, width] of [[look.colors.paper, 5], [look.colors.accent, 2.5]]) {
      context.beginPath();
      context.arc(camera.x + camera.scale * x, camera.y - camera.scale * y, far, 0, 2 * Math.PI);
      context.strokeStyle = color;
      context.lineWidth = width;
      context.stroke();
    }
  }

  // Forces as arrows from where bodies touch, one on either; rings round robots whose wheels slip.
  drawContacts(painter) {
    const { context, camera } = painter, scale = this.record.force;
    for (let i = 0; i < this.robots; i++) {
      if (this.effort(i) < SLIPPING) continue;
      const [x, y, radius] = this.bound(i), far = camera.scale * radius + 1.5;
      for (const [color, width] of [[SLIP_EDGE, 4.5], [SLIP, 2.7]]) {
        context.beginPath();
        context.arc(camera.x + camera.scale * x, camera.y - camera.scale * y, far, 0, 2 * Math.PI);
        painter.ink(null, color, scale.ring * width);
      }
    }
    this.contacts().forEach(({ b, force, start, size }, rank) => {
      const reach = Math.min(scale.newton * size, scale.longest) / size * camera.scale;
      const px = camera.x + camera.scale * start[0], py = camera.y - camera.scale * start[1];
      const ways = b >= 0 ? [[1, -1], [-1, 1]] : [[-1, 1]];
      for (const [across, down] of ways) {
        painter.dart(px, py, across * reach * force[0], down * reach * force[1], FORCE, "#ffffff", scale.width);
      }
      if (rank >= LABELS || size < LABELED * scale.strongest) return;
      const [across, down] = ways[0], way = [across * reach * force[0], down * reach * force[1]];
      const sideways = Math.abs(way[0]) > Math.abs(way[1]);
      const side = sideways ? (way[0] > 0 ? "left" : "right") : way[1] < 0 ? "above" : "below";
      painter.words(inNewtons(size), px + way[0], py + way[1], FORCE, 13, side, "#ffffff");
    });
  }

  drawNames(painter) {
    const { camera } = this, { crowd } = this.record;
    this.bodies.forEach((body, i) => {
      const [x, y, radius] = this.bound(i);
      const text = crowd && body.name === `robot${i}` ? String(i) : body.name;
      const px = camera.x + camera.scale * x, py = camera.y - camera.scale * (y + radius);
      painter.words(text, px, py, INK, crowd ? 11 : 13, "above", "#ffffff");
    });
  }
}

function inNewtons(force) {
  if (force >= 1000) return `${Number((force / 1000).toPrecision(3))} kN`;
  return `${force.toFixed(force < 1 ? 2 : force < 10 ? 1 : 0)} N`;
}
