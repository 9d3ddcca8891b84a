// Where the plane lies on the screen: metres to pixels, y upwards to y downwards.

const NEAREST = 64, FARTHEST = 0.25; // of what fits

class Camera {
  constructor(view) {
    this.view = view;
    this.scale = this.fitted = 1;
    this.x = this.y = 0;
    this.width = this.height = 1;
    this.moved = false; // by hand: then a new size of the window does not fit it anew
  }

  // Take a new size, with room left for the numbers along two sides.
  resize(width, height, room) {
    const center = this.toWorld(this.width / 2, this.height / 2), share = this.scale / this.fitted;
    Object.assign(this, { width, height, room });
    if (!this.moved) return this.fit();
    this.fitted = this.best();
    this.scale = share * this.fitted;
    this.centerOn(...center);
  }

  best() {
    const [xmin, xmax, ymin, ymax] = this.view, { left, right, top, bottom } = this.room;
    const wide = Math.max(this.width - left - right, 40);
    const high = Math.max(this.height - top - bottom, 40);
    return Math.min(wide / (xmax - xmin), high / (ymax - ymin));
  }

  fit() {
    const [xmin, xmax, ymin, ymax] = this.view, { left, right, top, bottom } = this.room;
    this.scale = this.fitted = this.best();
    this.x = (left + this.width - right) / 2 - this.scale * (xmin + xmax) / 2;
    this.y = (top + this.height - bottom) / 2 + this.scale * (ymin + ymax) / 2;
    this.moved = false;
  }

  toWorld(px, py) {
    return [(px - this.x) / this.scale, (this.y - py) / this.scale];
  }

  toPixels(x, y) {
    return [this.x + this.scale * x, this.y - this.scale * y];
  }

  centerOn(x, y) {
    this.x = this.width / 2 - this.scale * x;
    this.y = this.height / 2 + this.scale * y;
  }

  // Enlarge by a factor; the point under a pixel stays there.
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const before = this.scale;
    const wanted = before * factor;
    this.scale = Math.min(Math.max(wanted, FARTHEST * this.fitted), NEAREST * this.fitted);
    this.x = px + (this.x - px) * this.scale / before;
    this.y = py + (this.y - py) * this.scale / before;
    this.moved = true;
  }

  pan(dx, dy) {
    this.x += dx;
    this.y += dy;
    this.moved = true;
  }

  get key() {
    return `${this.scale} ${this.x} ${this.y} ${this.width} ${this.height}`;
  }
}
