// What is known of the body that is picked, in words.

const MINUS = "\u2212";

function inWords(value, unit = "", kind = "number") {
  if (kind === "angle") {
    const turned = ((value * 180 / Math.PI + 180) % 360 + 360) % 360 - 180;
    return `${Math.round(turned) + 0}°`.replace("-", MINUS);
  }
  const text = Math.abs(value) < 1000 ? value.toFixed(2) : value.toPrecision(3);
  return `${text === "-0.00" ? "0.00" : text} ${unit}`.trim().replace("-", MINUS);
}

class Panel {
  constructor(element, picture) {
    this.element = element;
    this.picture = picture;
    this.rows = [];
    this.picked = -1;
  }

  // Show another body, or none.
  pick(body) {
    this.picked = body;
    this.element.hidden = body < 0;
    if (body < 0) return;
    const { picture } = this, { record } = picture, about = picture.bodies[body];
    this.element.querySelector("h2").textContent = about.name;
    this.element.querySelector(".kind").textContent = about.kind;
    this.element.querySelector(".dot").style.background = about.color;
    const list = this.element.querySelector("dl");
    list.replaceChildren();
    this.rows = [];
    const row = (name, say) => {
      const words = element("dd", {});
      list.append(element("dt", {}, name), words);
      this.rows.push([words, say]);
    };
    row("pose", () => [
      `x ${inWords(picture.x[body], "m")}`, `y ${inWords(picture.y[body], "m")}`,
      `θ ${inWords(picture.theta[body], "", "angle")}`,
    ]);
    row("moves", () => {
      const [speed, spin] = picture.velocity(body);
      return [`v ${inWords(speed, "m/s")}`, `ω ${inWords(spin, "rad/s")}`];
    });
    if (about.robot) {
      const { command } = record.columns, n = picture.robots;
      row("command", () => about.commands.map(([name, unit, kind], k) =>
        `${name} ${inWords(command.at(picture.row, k * n + body), unit, kind)}`));
      row("effort", () => {
        const effort = record.columns.effort.at(picture.row, body);
        return [effort >= record.slipping ? "slips" : `${Math.round(100 * effort)} %`];
      });
    }
  }

  // Say it as it is now.
  write() {
    if (this.picked < 0) return;
    for (const [words, say] of this.rows) {
      const parts = say();
      if (parts.join("\n") === words.dataset.said) continue;
      words.dataset.said = parts.join("\n");
      words.replaceChildren(...parts.map((part) => element("span", {}, part)));
    }
  }
}
