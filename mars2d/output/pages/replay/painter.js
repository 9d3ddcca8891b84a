// Paints shapes on a canvas, as the window does: lengths in metres, widths and letters in pixels.

const DASHES = { "--": [9, 6], ":": [2, 4.5], "-.": [9, 5, 2, 5] };
const MARK_SPACING = 9;
const HEAD_LENGTH = 4, HEAD_WIDTH = 3.4, SHORTEST = 1.6; // of arrows, in widths of the shaft
const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";

class Painter {
  constructor(context, camera, images) {
    Object.assign(this, { context, camera, images });
    this.place = null;
  }

  // Let what follows be drawn in the frame of a body at a pose; without one, in that of the world.
  at(x, y, theta) {
    this.place = [x, y, Math.cos(theta), Math.sin(theta)];
    return this;
  }

  world() {
    this.place = null;
    return this;
  }

  across(x, y) {
    if (!this.place) return this.camera.x + this.camera.scale * x;
    return this.camera.x + this.camera.scale * (this.place[0] + this.place[2] * x - this.place[3] * y);
  }

  down(x, y) {
    if (!this.place) return this.camera.y - this.camera.scale * y;
    return this.camera.y - this.camera.scale * (this.place[1] + this.place[3] * x + this.place[2] * y);
  }

  shapes(list) {
    for (const [style, numbers] of list) this.shape(style, numbers, 0, numbers.length, 1);
  }

  // Paint a shape; its numbers are `count` from `start` on, in steps of so many metres.
  shape(style, numbers, start, count, step) {
    this[style[0]](style, numbers, start, count, step);
  }

  ink(fill, stroke, width) {
    const context = this.context;
    if (fill) {
      context.fillStyle = fill;
      context.fill();
    }
    if (stroke) {
      context.lineJoin = "round";
      context.strokeStyle = stroke;
      context.lineWidth = width;
      context.stroke();
    }
  }

  circle([, fill, stroke, width, pixels], n, k, count, step) {
    const x = n[k] * step, y = n[k + 1] * step, radius = n[k + 2] * step;
    const context = this.context;
    context.beginPath();
    const far = Math.max(this.camera.scale * radius + pixels, 0);
    context.arc(this.across(x, y), this.down(x, y), far, 0, 2 * Math.PI);
    this.ink(fill, stroke, width);
  }

  trace(n, k, count, step) {
    const context = this.context;
    context.beginPath();
    for (let i = k; i < k + count; i += 2) {
      const x = n[i] * step, y = n[i + 1] * step;
      context.lineTo(this.across(x, y), this.down(x, y));
    }
  }

  polygon([, fill, stroke, width], n, k, count, step) {
    this.trace(n, k, count, step);
    this.context.closePath();
    this.ink(fill, stroke, width);
  }

  line([, stroke, width, style], n, k, count, step) {
    const { marker, dashes, solid } = wakeOf(style), context = this.context;
    if (solid || dashes) {
      this.trace(n, k, count, step);
      let wide = width;
      if (count === 4) { // a short line stays a line: a small robot's heading must be no blob
        const dx = (n[k + 2] - n[k]) * step, dy = (n[k + 3] - n[k + 1]) * step;
        wide = Math.min(width, Math.max(1, Math.hypot(dx, dy) * this.camera.scale / 3.5));
      }
      if (dashes) context.setLineDash(dashes);
      this.ink(null, stroke, wide);
      if (dashes) context.setLineDash([]);
    }
    if (!marker) return;
    let along = 0, bucket = -1, px = 0, py = 0;
    for (let i = k; i < k + count; i += 2) {
      const x = this.across(n[i] * step, n[i + 1] * step);
      const y = this.down(n[i] * step, n[i + 1] * step);
      if (i > k) along += Math.hypot(x - px, y - py);
      [px, py] = [x, y];
      if (Math.floor(along / MARK_SPACING) > bucket) this.mark(marker, x, y, stroke, width);
      bucket = Math.floor(along / MARK_SPACING);
    }
  }

  mark(marker, x, y, color, width) {
    const context = this.context, r = marker === "." ? 1.2 + 0.5 * width : 3.2;
    context.beginPath();
    if (marker === "x") {
      for (const s of [1, -1]) {
        context.moveTo(x - r, y - s * r);
        context.lineTo(x + r, y + s * r);
      }
    } else if (marker === "+" || marker === "*") {
      const arms = marker === "+" ? 2 : 3;
      for (let i = 0; i < arms; i++) {
        const c = r * Math.cos(Math.PI * i / arms), s = r * Math.sin(Math.PI * i / arms);
        context.moveTo(x - c, y - s);
        context.lineTo(x + c, y + s);
      }
    } else if (marker === "s") context.rect(x - r, y - r, 2 * r, 2 * r);
    else context.arc(x, y, r, 0, 2 * Math.PI);
    if (marker === ".") this.ink(color);
    else this.ink(null, color, Math.max(1, 0.7 * width));
  }

  // Write words; an anchor "left" puts their left end at the point.
  text([, text, color, size, anchor, halo], n, k, count, step) {
    const x = this.across(n[k] * step, n[k + 1] * step), y = this.down(n[k] * step, n[k + 1] * step);
    const context = this.context, lines = text.split("\n"), height = 1.25 * size, gap = 4;
    context.font = `${size}px ${FONT}`;
    context.textBaseline = "middle";
    context.textAlign = anchor === "left" ? "left" : anchor === "right" ? "right" : "center";
    const left = x + (anchor === "left" ? gap : anchor === "right" ? -gap : 0);
    let middle = y - height * (lines.length - 1) / 2;
    if (anchor === "above") middle = y - gap - height * (lines.length - 0.5);
    if (anchor === "below") middle = y + gap + height / 2;
    for (const line of lines) {
      if (halo) {
        context.strokeStyle = halo;
        context.lineWidth = 3;
        context.lineJoin = "round";
        context.strokeText(line, left, middle);
      }
      context.fillStyle = color;
      context.fillText(line, left, middle);
      middle += height;
    }
  }

  arrow([, fill, stroke, width], n, k, count, step) {
    const [ax, ay, bx, by] = [n[k], n[k + 1], n[k + 2], n[k + 3]].map((v) => v * step);
    const x = this.across(ax, ay), y = this.down(ax, ay);
    const dx = this.across(bx, by) - x, dy = this.down(bx, by) - y;
    const context = this.context, length = Math.hypot(dx, dy);
    if (length < 0.5) return;
    const wide = Math.min(width, length / (SHORTEST * HEAD_LENGTH)), half = wide / 2;
    const neck = length - HEAD_LENGTH * wide, head = HEAD_WIDTH * half;
    const c = dx / length, s = dy / length;
    const ends = [[0, half], [neck, half], [neck, head], [length, 0]];
    ends.push(...ends.slice(0, 3).reverse().map(([along, aside]) => [along, -aside]));
    context.beginPath();
    for (const [along, aside] of ends) context.lineTo(x + c * along - s * aside, y + s * along + c * aside);
    context.closePath();
    if (stroke) this.ink(null, stroke, 0.8 * width);
    this.ink(fill);
  }

  image([, name], n, k, count, step) {
    const picture = this.images(name);
    const left = this.across(n[k] * step, 0), right = this.across(n[k + 1] * step, 0);
    const bottom = this.down(0, n[k + 2] * step), top = this.down(0, n[k + 3] * step);
    const context = this.context;
    context.imageSmoothingEnabled = (right - left) / picture.width < 6; // large pixels are sharp
    context.drawImage(picture, left, top, right - left, bottom - top);
  }
}

// A wake style as of Matlab's plot: what marks there are, which dashes, or a solid line.
function wakeOf(style) {
  const plain = style in DASHES || style === "-";
  const marker = plain ? "" : style[0], line = plain ? style : style.slice(1);
  return { marker, dashes: DASHES[line], solid: line === "-" };
}
