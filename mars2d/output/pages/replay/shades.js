// How colours made for white paper look on dark paper; the file says it for each that it has.

const darkened = {};

// What a colour of a scene, #rrggbb or #rrggbbaa, becomes.
function shade(color, dark) {
  return dark && color ? (darkened[color.slice(0, 7)] ?? color.slice(0, 7)) + color.slice(7) : color;
}

// A colour with its opacity laid over a ground.
function laidOver(color, ground) {
  const of = (text, k) => parseInt(text.slice(k, k + 2), 16), share = of(color, 7) / 255;
  const mixed = [1, 3, 5].map((k) => Math.round(of(ground, k) + share * (of(color, k) - of(ground, k))));
  return "#" + mixed.map((value) => value.toString(16).padStart(2, "0")).join("");
}

// An element of the page with properties, and with elements or texts in it.
function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}
