// SPDX-License-Identifier: Apache-2.0
import type { Commands } from "../commands";
import { element } from "../element";
import type { Panels } from "./panels";

const historyKey = "cohort.view.history";
const longestHistory = 200;
const callTime = 6000; // [ms]

/** The console, where the user types commands, with output, history and completion. */
export class ConsolePanel {
  private readonly lines = element("lines");
  private readonly input = element("command") as HTMLInputElement;
  private history: string[] = [];
  private place = 0;
  private calling: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly commands: Commands,
    private readonly panels: Panels,
  ) {
    try {
      this.history = JSON.parse(localStorage.getItem(historyKey) ?? "[]") as string[];
    } catch {
      this.history = [];
    }
    this.place = this.history.length;
    this.input.addEventListener("keydown", (event) => this.onKey(event));
  }

  get isOpen(): boolean {
    return this.panels.isShown("console");
  }

  toggle(open = !this.isOpen): void {
    if (open) {
      this.panels.show("console");
      this.input.focus();
    } else {
      this.panels.close("console");
      this.input.blur();
    }
  }

  say(text: string, kind: "said" | "typed" | "wrong" = "said"): void {
    if (text === "") return;
    if (kind === "wrong" && !this.isOpen) this.call(text);
    const line = document.createElement("pre");
    line.className = kind;
    line.textContent = text;
    this.lines.append(line);
    while (this.lines.childElementCount > 500) this.lines.firstElementChild?.remove();
    this.lines.scrollTop = this.lines.scrollHeight;
  }

  async run(line: string): Promise<void> {
    try {
      this.say(await this.commands.run(line));
    } catch (error) {
      this.say(error instanceof Error ? error.message : String(error), "wrong");
    }
  }

  // Shows an error of an action that did not come from the console.
  private call(text: string): void {
    const told = element("told");
    told.textContent = text;
    told.hidden = false;
    clearTimeout(this.calling);
    this.calling = setTimeout(() => {
      told.hidden = true;
    }, callTime);
  }

  private onKey(event: KeyboardEvent): void {
    event.stopPropagation();
    if (event.key === "Enter") void this.enter();
    else if (event.key === "Tab") this.complete();
    else if (event.key === "ArrowUp") this.recall(-1);
    else if (event.key === "ArrowDown") this.recall(1);
    else if (event.key === "Escape" || event.key === "`") this.toggle(false);
    else return;
    event.preventDefault();
  }

  private async enter(): Promise<void> {
    const line = this.input.value.trim();
    this.input.value = "";
    if (line === "") return;
    if (this.history[this.history.length - 1] !== line) this.history.push(line);
    this.history = this.history.slice(-longestHistory);
    this.place = this.history.length;
    try {
      localStorage.setItem(historyKey, JSON.stringify(this.history));
    } catch {
      // Storage is not available: the history is lost when the page is closed.
    }
    this.say(`› ${line}`, "typed");
    await this.run(line);
  }

  private recall(step: number): void {
    this.place = Math.min(this.history.length, Math.max(0, this.place + step));
    this.input.value = this.history[this.place] ?? "";
  }

  private complete(): void {
    const line = this.input.value;
    const found = this.commands.complete(line);
    if (found.length === 0) return;
    const start = line.slice(0, line.length - (line.match(/\S*$/)?.[0].length ?? 0));
    let shared = found[0];
    for (const each of found) while (!each.startsWith(shared)) shared = shared.slice(0, -1);
    this.input.value = start + shared + (found.length === 1 ? " " : "");
    if (found.length > 1) this.say(found.slice(0, 60).join("  "));
  }
}
