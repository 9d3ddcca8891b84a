// What the marks of the layers mean, in a corner: arrows of a round length, and signs.

const ROW = 24; // pixels

class Legend {
  constructor(corner, record) {
    this.longest = record.longestArrow;
    this.plates = record.legends.map((legend) => this.plate(corner, legend));
    this.drawn = "";
  }

  // A plate with a line for the arrow, and one for each sign.
  plate(corner, legend) {
    const plate = element("div", {}), { longest } = this;
    corner.append(plate);
    const room = Math.max(legend.arrow ? longest : 0, ...legend.signs.map((sign) => sign.room));
    const line = (words) => {
      const canvas = element("canvas", {}), said = element("span", {}, words);
      plate.append(element("p", {}, canvas, said));
      return { canvas, said };
    };
    return { ...legend, plate, room, ruler: legend.arrow && line(""), lines: legend.signs.map(({ meaning }) => line(meaning)) };
  }

  // The longest arrow of a round number that there is room for: in metres, and in words.
  measure({ lengths }, scale) {
    const short = lengths.filter(([metres]) => metres * scale <= this.longest * (1 + 1e-9));
    return short.length ? short[short.length - 1] : lengths[0];
  }

  draw(look, camera, ratio, names) {
    const seen = this.plates.map(({ layer }) => Boolean(look[layer]) && names.includes(layer));
    const state = [camera.scale, ratio, ...seen].join();
    if (state === this.drawn) return;
    this.drawn = state;
    this.plates.forEach((each, k) => {
      each.plate.hidden = !seen[k];
      if (!seen[k]) return;
      const picture = (canvas, shapes) => this.picture(canvas, each.room, shapes, ratio);
      if (each.ruler) {
        const [metres, words] = this.measure(each, camera.scale), half = metres * camera.scale / 2;
        each.ruler.said.textContent = words;
        picture(each.ruler.canvas, [[each.arrow, [-half, 0, half, 0]]]);
      }
      each.signs.forEach(({ shapes }, i) => picture(each.lines[i].canvas, shapes));
    });
  }

  picture(canvas, room, shapes, ratio) {
    Object.assign(canvas, { width: Math.round(room * ratio), height: Math.round(ROW * ratio) });
    Object.assign(canvas.style, { width: `${room}px`, height: `${ROW}px` });
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    new Painter(context, { x: room / 2, y: ROW / 2, scale: 1 }, null).shapes(shapes);
  }
}
