/** How finely the picture is drawn. */
export interface Level {
  /** Ratio to the pixels of the screen. */
  resolution: number;
  shadows: boolean;
  /** Surfaces reflect the sky. */
  reflections: boolean;
  /** Time between pictures of which the page draws coarser [ms]. */
  slow: number;
}

/** From the finest to the coarsest. */
export const levels: readonly Level[] = [
  { resolution: 1, shadows: true, reflections: true, slow: 40 },
  { resolution: 1, shadows: true, reflections: false, slow: 55 },
  { resolution: 0.75, shadows: true, reflections: false, slow: 55 },
  { resolution: 0.5, shadows: true, reflections: false, slow: 70 },
  { resolution: 0.5, shadows: false, reflections: false, slow: 130 },
  { resolution: 0.35, shadows: false, reflections: false, slow: Infinity },
];

const fast = 24; // [ms], of which it tries to draw finer
const pause = 1000; // [ms]; longer without a picture is not slow drawing, unless it lasts
const leastTime = 700; // [ms] of slow pictures before it draws coarser
const firstWait = 3000; // [ms] of fast pictures before it draws finer
const longestWait = 60_000; // [ms]; each attempt that was too slow doubles the wait
const smoothing = 0.25;

/**
 * Chooses how finely to draw by the time between pictures. Drawing finer is an attempt: if it is too slow, the next
 * attempt waits twice as long.
 */
export class Quality {
  level: number;
  /** No changes, such as while a film is recorded. */
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

  /** Takes the time since the picture before [ms]; returns whether the level is another one. */
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

  /** The page was not drawn: the time since the picture before says nothing. */
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
