// SPDX-License-Identifier: Apache-2.0

/** A level of picture quality. */
export interface Level {
  /** Resolution relative to the screen's. */
  resolution: number;
  shadows: boolean;
  /** True if surfaces reflect the sky. */
  reflections: boolean;
  /** Time between pictures from which the page chooses a coarser level [ms]. */
  slow: number;
}

/** All levels, from the finest to the coarsest. */
export const levels: readonly Level[] = [
  { resolution: 1, shadows: true, reflections: true, slow: 40 },
  { resolution: 1, shadows: true, reflections: false, slow: 55 },
  { resolution: 0.75, shadows: true, reflections: false, slow: 55 },
  { resolution: 0.5, shadows: true, reflections: false, slow: 70 },
  { resolution: 0.5, shadows: false, reflections: false, slow: 130 },
  { resolution: 0.35, shadows: false, reflections: false, slow: Infinity },
];

const fast = 24; // [ms] between pictures, below which a finer level is tried
const pause = 1000; // [ms]; a longer single gap does not count as slow drawing
const leastTime = 700; // [ms] of slow pictures before it draws coarser
const firstWait = 3000; // [ms] of fast pictures before it draws finer
const longestWait = 60_000; // [ms]; each attempt that was too slow doubles the wait
const smoothing = 0.25;

/**
 * Chooses the level from the time between pictures. A finer level is an attempt: if it is too slow, the next attempt
 * comes after twice the wait.
 */
export class Quality {
  level: number;
  /** The level is not changed, such as while a film is recorded. */
  isHeld = false;
  private average = fast;
  private slowFor = 0;
  private fastFor = 0;
  private wait = firstWait;
  private isAttempt = false;

  constructor(
    private readonly finest = 0,
    private readonly coarsest = levels.length - 1,
  ) {
    this.level = finest;
  }

  /** Takes the time since the previous picture [ms]. Returns whether the level has changed. */
  take(elapsed: number): boolean {
    if (this.isHeld || elapsed <= 0) return false;
    this.average += smoothing * (Math.min(elapsed, pause) - this.average);
    this.slowFor = this.average > levels[this.level].slow ? this.slowFor + elapsed : 0;
    this.fastFor = this.average < fast ? this.fastFor + elapsed : 0;
    if (this.slowFor > leastTime && this.level < this.coarsest) {
      if (this.isAttempt) this.wait = Math.min(longestWait, 2 * this.wait);
      return this.change(1, false);
    }
    if (this.fastFor > this.wait && this.level > this.finest) return this.change(-1, true);
    if (this.isAttempt && this.fastFor > firstWait) this.isAttempt = false;
    return false;
  }

  /** Ignores the time since the previous picture, because the page was not drawn. */
  forget(): void {
    this.slowFor = this.fastFor = 0;
    this.average = fast;
  }

  private change(by: number, isAttempt: boolean): boolean {
    this.level += by;
    this.isAttempt = isAttempt;
    this.forget();
    return true;
  }
}
