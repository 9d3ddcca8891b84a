// What the file holds: plain data, and columns of numbers over time.

const MISSING = -(2 ** 28); // stands for a number that is none, or without end

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function bytesOf(text) {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let k = 0; k < bytes.length; k++) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

// A column of `rows` rows, each of `width` numbers in whole steps.
class Column {
  constructor(entry, bytes) {
    this.entry = entry;
    this.rows = entry.shape[0];
    this.width = entry.shape.slice(1).reduce((a, b) => a * b, 1);
    this.step = entry.step ?? 1;
    this.every = entry.every ?? 1;
    this.values = this.summed(new Int32Array(bytes.buffer));
  }

  // Whole numbers, series by series, from their differences in time.
  summed(values) {
    for (let round = 0; round < this.entry.order; round++) {
      for (let start = 0; start < values.length; start += this.rows) {
        const end = start + this.rows;
        for (let k = start + 1; k < end; k++) values[k] += values[k - 1];
      }
    }
    return values;
  }

  // A number of a row, counted in rows of the replay; NaN where there is none.
  at(row, k = 0) {
    const value = this.values[k * this.rows + Math.floor(row / this.every)];
    return value === MISSING ? NaN : value * this.step;
  }
}

async function readRecord(text) {
  const [head, body] = text.trim().split(" ").map(bytesOf);
  const record = JSON.parse(new TextDecoder().decode(await inflated(head)));
  const entries = Object.entries(record.columns);
  const columns = await Promise.all(entries.map(async ([, entry]) =>
    new Column(entry, await inflated(body.subarray(entry.at, entry.at + entry.bytes)))));
  record.columns = Object.fromEntries(entries.map(([name], k) => [name, columns[k]]));
  return record;
}

// How many of the rising numbers are at most `value`.
function countUpTo(values, value, from = 0, to = values.length) {
  while (from < to) {
    const middle = (from + to) >> 1;
    if (values[middle] <= value) from = middle + 1;
    else to = middle;
  }
  return from;
}
