// Where the motion in view stands: an independent variable that plays, and is told to all that show it.

export type Listener = (at: number) => void;

/** Plays over a range again and again, or once. */
export class Clock {
  at = 0;
  /** Where the motion begins and ends; its variable may fall on the way. */
  from = 0;
  to = 0;
  playing = false;
  loop = true;
  speed = 1;
  /** Seconds to the value of the independent variable, and back. */
  private seconds: (at: number) => number = (at) => at;
  private place: (seconds: number) => number = (seconds) => seconds;
  private listeners = new Set<Listener>();
  private states = new Set<() => void>();
  private last = 0;

  /** A new range; `seconds` and `place` say how long its way takes at speed 1. */
  range(from: number, to: number, seconds: (at: number) => number, place: (seconds: number) => number): void {
    [this.from, this.to, this.seconds, this.place] = [from, to, seconds, place];
    this.seek(Number.isFinite(this.at) ? this.at : from);
    if (this.playing && to === from) this.play(false);
  }

  seek(at: number): void {
    const [low, high] = this.from < this.to ? [this.from, this.to] : [this.to, this.from];
    this.at = Math.min(Math.max(at, low), high);
    this.listeners.forEach((listener) => listener(this.at));
  }

  play(on = !this.playing): void {
    if (on && this.at === this.to) this.seek(this.from);
    this.playing = on && this.to !== this.from;
    this.last = performance.now();
    this.states.forEach((tell) => tell());
    if (this.playing) requestAnimationFrame((now) => this.tick(now));
  }

  /** One part in `parts` of the range forth or back. */
  step(parts: number): void {
    this.play(false);
    this.seek(this.at + (this.to - this.from) / parts);
  }

  /** Who is told the place; the answer ends that. */
  tell(listener: Listener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Who is told that it plays or stands. */
  tellState(listener: () => void): void {
    this.states.add(listener);
  }

  private tick(now: number): void {
    if (!this.playing) return;
    const passed = Math.min(Math.max(now - this.last, 0), 100) / 1000;
    this.last = now;
    let seconds = this.seconds(this.at) + passed * this.speed;
    const end = this.seconds(this.to);
    if (seconds >= end) {
      if (!this.loop) {
        this.seek(this.to);
        this.play(false);
        return;
      }
      const begin = this.seconds(this.from);
      seconds = begin + ((seconds - begin) % (end - begin));
    }
    this.seek(this.place(seconds));
    requestAnimationFrame((next) => this.tick(next));
  }
}
