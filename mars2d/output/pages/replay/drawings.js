// What was drawn by parts of the experiment while it was recorded: scenes that last until the next.

class Drawings {
  constructor(header, columns) {
    Object.assign(this, { styles: header.styles, step: header.step, every: header.every, leap: header.leap });
    this.between = [];
    this.known = new Map();
    this.orders = header.orders.map((flat) => {
      const pairs = [];
      for (let k = 0; k < flat.length; k += 2) pairs.push([flat[k], flat[k + 1]]);
      return pairs;
    });
    const of = (part) => columns[`${header.name}:${part}`].values;
    this.rows = of("rows");
    this.order = of("orders");
    this.numbers = of("numbers");
    this.begins = new Int32Array(this.rows.length);
    let scene = 0, at = 0;
    this.drawings = header.drawings.map((drawing) => {
      const first = scene, last = new Map();
      for (; scene < first + drawing.scenes; scene++) {
        this.begins[scene] = at;
        at = this.restore(this.orders[this.order[scene]], at, last);
      }
      return { ...drawing, first, end: scene };
    });
  }

  // Each shape is written as what it differs from the last one at its place with as many numbers.
  restore(order, at, last) {
    order.forEach(([, count], place) => {
      const key = `${place} ${count}`, before = last.get(key);
      if (before !== undefined) for (let k = 0; k < count; k++) this.numbers[at + k] += this.numbers[before + k];
      last.set(key, at);
      at += count;
    });
    return at;
  }

  // The scene of a drawing that is seen at a row, or -1.
  sceneAt({ first, end }, row) {
    const found = countUpTo(this.rows, row, first, end) - 1;
    return found < first ? -1 : found;
  }

  paint(painter, scene) {
    let at = this.begins[scene];
    for (const [style, count] of this.orders[this.order[scene]]) {
      painter.shape(this.styles[style], this.numbers, at, count, this.step);
      at += count;
    }
  }

  // Paint a scene on its way to the next: each shape that is there again moves evenly, or leaps.
  paintBetween(painter, scene, end, position) {
    const next = scene + 1;
    const share = next < end ? 1 - (this.rows[next] - position) / this.every : 0;
    if (share <= 0) return this.paint(painter, scene);
    const again = this.again(this.order[scene], this.order[next]);
    let at = this.begins[scene];
    this.orders[this.order[scene]].forEach(([style, count], place) => {
      const to = this.begins[next] + again[place];
      let far = again[place] < 0 ? Infinity : 0;
      for (let k = 0; far < Infinity && k < count; k++) {
        const way = this.numbers[to + k] - this.numbers[at + k];
        this.between[k] = this.numbers[at + k] + share * way;
        far = Math.max(far, Math.abs(way));
      }
      const leaps = far * this.step > this.leap;
      painter.shape(this.styles[style], leaps ? this.numbers : this.between, leaps ? at : 0, count, this.step);
      at += count;
    });
  }

  // For each shape of an order of shapes, where the numbers of the same one begin in another; or -1.
  again(one, other) {
    const key = `${one} ${other}`;
    if (!this.known.has(key)) {
      const places = new Map();
      let at = 0;
      for (const [style, count] of this.orders[other]) {
        const kind = `${style} ${count}`;
        places.set(kind, [...(places.get(kind) ?? []), at]);
        at += count;
      }
      this.known.set(key, this.orders[one].map(([style, count]) => places.get(`${style} ${count}`)?.shift() ?? -1));
    }
    return this.known.get(key);
  }
}

// The images of a record, made when they are first seen.
function imagesOf(columns) {
  const made = new Map();
  return (name) => {
    if (!made.has(name)) {
      const { entry, values } = columns[name], [height, width] = entry.shape;
      const pixels = Uint8ClampedArray.from(values, (_, k) => values[(k % (4 * width)) * height + Math.floor(k / (4 * width))]);
      const canvas = document.createElement("canvas");
      Object.assign(canvas, { width, height });
      canvas.getContext("2d").putImageData(new ImageData(pixels, width, height), 0, 0);
      made.set(name, canvas);
    }
    return made.get(name);
  };
}
