// The time that is shown: a position between the rows, which runs on while it plays.

const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];

class Clock {
  constructor(record) {
    const last = record.columns.places.rows - 1, spacing = record.stride * record.step;
    const end = (record.rows - 1) * record.step;
    this.last = last;
    this.end = end;
    record.timeOf = (position) => {
      const row = Math.min(Math.floor(position), last), share = position - row;
      const time = (k) => Math.min(k * spacing, end);
      return time(row) + share * (time(row + 1) - time(row));
    };
    this.record = record;
    this.spacing = spacing;
    this.position = 0;
    this.playing = false;
    this.loop = false;
    this.speed = this.firstSpeed(record.speed);
  }

  // As the experiment says, unless it would take more than five minutes; where it says nothing of
  // use, the one that takes about half a minute.
  firstSpeed(wanted) {
    const said = typeof wanted === "number" && wanted > 0;
    const near = said ? Math.max(wanted, this.end / 300) : Math.max(this.end / 30, 0.1);
    return SPEEDS.reduce((best, each) =>
      Math.abs(Math.log(each / near)) < Math.abs(Math.log(best / near)) ? each : best);
  }

  get time() {
    return this.record.timeOf(this.position);
  }

  get atEnd() {
    return this.position >= this.last;
  }

  go(position) {
    this.position = Math.min(Math.max(position, 0), this.last);
  }

  // Whole rows on or back; from between two rows, to the nearer one on that side first.
  step(rows) {
    const from = rows > 0 ? Math.floor(this.position + 1e-9) : Math.ceil(this.position - 1e-9);
    this.playing = false;
    this.go(from + rows);
  }

  play() {
    if (this.atEnd) this.go(0);
    this.playing = this.last > 0;
  }

  // Let so many seconds of the real time pass.
  pass(seconds) {
    if (!this.playing) return;
    const time = this.time + seconds * this.speed;
    if (time < this.end) {
      const row = Math.min(Math.floor(time / this.spacing), this.last - 1);
      const begin = this.record.timeOf(row), next = this.record.timeOf(row + 1);
      this.go(row + (time - begin) / (next - begin));
    } else if (this.loop) this.go(0);
    else {
      this.go(this.last);
      this.playing = false;
    }
  }

  faster(steps) {
    const k = SPEEDS.indexOf(this.speed) + steps;
    this.speed = SPEEDS[Math.min(Math.max(k, 0), SPEEDS.length - 1)];
  }
}
