// Ticks along the time bar, where something happened.

const THUMB = 16, TICK = 6, AWAY = 5; // pixels: of the handle, of a tick, and from the line to it

class Marks {
  constructor(canvas, record, list) {
    Object.assign(this, { canvas, record });
    this.drawn = "";
    for (const { kind, meaning } of record.marks) {
      const tick = element("i", {});
      tick.style.background = `var(--mark-${kind})`;
      list.append(element("li", {}, tick, `on the time bar: ${meaning}`));
    }
  }

  draw(clock) {
    const { canvas, record } = this, { width, height } = canvas.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1, dark = document.documentElement.className;
    const state = [width, height, ratio, dark].join();
    if (state === this.drawn) return;
    this.drawn = state;
    Object.assign(canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    const context = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const { kind, above, below } of record.marks) {
      context.fillStyle = style.getPropertyValue(`--mark-${kind}`).trim();
      const top = height / 2 - (above ? AWAY + TICK : -AWAY), bottom = height / 2 + (below ? AWAY + TICK : -AWAY);
      for (const row of record.columns[`marks:${kind}`].values) {
        const x = THUMB / 2 + (width - THUMB) * clock.rows[row] / Math.max(clock.rows[clock.last], 1);
        context.fillRect(Math.round(x - 0.75), top, 1.5, bottom - top);
      }
    }
  }
}
