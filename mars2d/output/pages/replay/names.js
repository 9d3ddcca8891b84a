// Names beside their bodies, none over another or over a body: as mars2d/output/layers/placement.py.

const NAME_RINGS = 6, LETTER = 0.6, NAME_STAYS = 0.05;
const WAYS = [[0, 1], [0, -1], [1, 0], [-1, 0], [0.7, 0.7], [-0.7, 0.7], [0.7, -0.7], [-0.7, -0.7]];
const NAME_PLACES = Array.from({ length: NAME_RINGS * WAYS.length }, (_, k) => (
  [Math.floor(k / WAYS.length), ...WAYS[k % WAYS.length]]));

// The area that two boxes share: each its centre, and half its width and height.
function shared([x, y, wide, high], [u, v, w, h]) {
  const across = Math.min(x + wide, u + w) - Math.max(x - wide, u - w);
  const along = Math.min(y + high, v + h) - Math.max(y - high, v - h);
  return Math.max(across, 0) * Math.max(along, 0);
}

// Labels with the box of their body and half their size: the index of a place for each.
function placedNames(labels, bodies, view, first, last) {
  const at = ({ body: [x, y, far], wide, high }, [ring, across, up]) => {
    const gap = (2 * ring + 0.3) * high;
    return [x + across * (far + gap + wide), y - up * (far + gap + high), wide, high];
  };
  const sum = (box, others) => others.reduce((total, other) => total + shared(box, other), 0);
  const outside = (box) => 4 * box[2] * box[3] - shared(box, view);
  const above = labels.map((label) => at(label, NAME_PLACES[0]));
  const seen = labels.map(({ body }) => Math.abs(body[0] - view[0]) <= view[2] && Math.abs(body[1] - view[1]) <= view[3]);
  const free = above.map((box, i) => i === first || sum(box, bodies) + outside(box)
    + above.reduce((total, other, k) => total + (k === i ? 0 : shared(box, other)), 0) < 1e-6);
  const taken = above.filter((_, i) => seen[i] && free[i]);
  const chosen = new Map();
  labels.forEach((label, i) => {
    if (!seen[i] || free[i]) return;
    let best = 0, least = Infinity;
    NAME_PLACES.forEach((place, k) => {
      const box = at(label, place);
      let cost = 10 * sum(box, taken) + sum(box, bodies) + 10 * outside(box);
      if (last.get(i) === k) cost -= NAME_STAYS * 4 * label.wide * label.high;
      if (cost < least - 1e-9) [best, least] = [k, cost];
    });
    chosen.set(i, best);
    taken.push(at(label, NAME_PLACES[best]));
  });
  return labels.map((label, i) => ({ box: at(label, NAME_PLACES[chosen.get(i) ?? 0]), place: chosen.get(i) ?? 0 }));
}
