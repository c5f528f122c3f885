// SPDX-License-Identifier: Apache-2.0
import { seconds, type ViewStatus } from "../data/messages";
import { element } from "../element";
import { clockText } from "./time_bar";

const endings: Record<string, string> = {
  finished: "finished",
  interrupted: "interrupted",
  failed: "failed",
  shut_down: "shut down",
};

/** Returns the state of a run as text, and whether it is an error. */
export function stateOf(status: ViewStatus | undefined, isConnected: boolean): { text: string; isWrong: boolean } {
  const isOver = status?.phase === "ended" || status?.phase === "gone";
  if (!isConnected && !isOver) return { text: status ? "disconnected" : "connecting", isWrong: status !== undefined };
  switch (status?.phase) {
    case undefined:
      return { text: "connecting", isWrong: false };
    case "waiting":
      return { text: "waiting for a server", isWrong: false };
    case "gathering":
      return { text: "waiting for controllers", isWrong: false };
    case "ended":
      return { text: `■ ${endings[status.end] ?? "ended"}`, isWrong: status.end === "failed" };
    case "gone":
      return { text: "server unreachable", isWrong: true };
    case "running":
      return { text: status.is_playing ? "▶ running" : "❚❚ paused", isWrong: false };
  }
}

/** Shows the name and the state of the run or recording. A button shows further numbers for experts. */
export class TopBar {
  private status: ViewStatus | undefined;
  private isConnected = false;

  constructor() {
    const more = element("more");
    const details = element("details");
    const open = (isOpen: boolean): void => {
      details.hidden = !isOpen;
      more.setAttribute("aria-expanded", String(isOpen));
    };
    more.addEventListener("click", () => open(details.hidden));
    addEventListener("pointerdown", ({ target }) => {
      if (!(target as Element).closest("#details, #more")) open(false);
    });
  }

  connect(isConnected: boolean): void {
    this.isConnected = isConnected;
    this.show();
  }
  take(status: ViewStatus): void {
    this.status = status;
    this.show();
  }

  private show(): void {
    const { status } = this;
    const { text, isWrong } = stateOf(status, this.isConnected);
    element("phase-word").textContent = text;
    element("state").dataset.phase = isWrong ? "wrong" : "";
    if (!status) return;
    element("name").textContent = status.name;
    element("seed").textContent = status.seed === "" ? "" : `seed ${status.seed}`;
    document.title = `${status.name} · Cohort`;
    const isRunning = status.phase === "running" && status.is_playing;
    element("clock").textContent =
      clockText(seconds(status.time_ns)) + (isRunning ? ` · ${status.real_time_factor.toFixed(1)} ×` : "");
    element("factor").textContent = status.is_playing ? `${status.real_time_factor.toFixed(2)} ×` : "paused";
  }
}
