// The time that is shown: a position between the rows of the file, which runs on while it plays.

const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];

class Clock {
  constructor(record) {
    this.step = record.step;
    this.rows = record.columns.rows.values; // the rows of the run that the file has
    this.last = this.rows.length - 1;
    this.end = this.rows[this.last] * this.step;
    this.position = 0;
    this.playing = false;
    this.loop = false;
    this.speed = this.firstSpeed(record.speed);
  }

  // As the experiment says; where it says nothing of use, the one that takes about half a minute.
  firstSpeed(wanted) {
    const near = wanted > 0 ? wanted : Math.max(this.end / 30, 0.1);
    return SPEEDS.reduce((best, each) =>
      Math.abs(Math.log(each / near)) < Math.abs(Math.log(best / near)) ? each : best);
  }

  // The row of the run at a position, with its fraction.
  rowAt(position) {
    const row = Math.floor(position), next = Math.min(row + 1, this.last);
    return this.rows[row] + (position - row) * (this.rows[next] - this.rows[row]);
  }

  timeOf(position) {
    return this.rowAt(position) * this.step;
  }

  // The position of a row of the run; it may have a fraction.
  positionOf(row) {
    const before = Math.min(Math.max(countUpTo(this.rows, row + 1e-9) - 1, 0), Math.max(this.last - 1, 0));
    const first = this.rows[before];
    return this.last ? before + (row - first) / (this.rows[before + 1] - first) : 0;
  }

  get time() {
    return this.timeOf(this.position);
  }

  get atEnd() {
    return this.position >= this.last;
  }

  go(position) {
    this.position = Math.min(Math.max(position, 0), this.last);
  }

  // Whole rows on or back; from between two rows, to the nearer one on that side first.
  move(rows) {
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
    if (time < this.end) this.go(this.positionOf(time / this.step));
    else if (this.loop) this.go(0);
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
