// SPDX-License-Identifier: Apache-2.0
import type { ViewStatus } from "../data/messages";
import { element } from "../element";
import { clockText } from "./time_bar";

interface Card {
  title: string;
  text: string;
  toType?: string;
  recording?: string;
  canRunAgain?: boolean;
  isWrong?: boolean;
  hasNumbers?: boolean; // shows the tick and the hash of the last state
}

const ends: Record<string, string> = {
  finished: "The run has finished",
  interrupted: "The run was interrupted",
  failed: "The run has failed",
  shut_down: "The run was shut down",
};

/** Returns the card before a run, after it, and without a connection; undefined during the run. */
export function cardOf(status: ViewStatus | undefined, isConnected: boolean): Card | undefined {
  const isOver = status?.phase === "ended" || status?.phase === "gone";
  if (!isConnected && !isOver)
    return {
      title: "The connection is lost",
      text: "The view has ended or cannot be reached. This page reconnects automatically.",
      isWrong: true,
    };
  if (!status) return undefined;
  const at = clockText(Number(status.time_ns) * 1e-9);
  const over = {
    toType: status.to_type,
    recording: isConnected ? status.recording : "",
    canRunAgain: isConnected && status.can_run_again,
  };
  switch (status.phase) {
    case "waiting":
      return {
        title: "Waiting for a server",
        text: `No server responds at ${status.name}. To start one:`,
        toType: status.to_type,
      };
    case "gathering": {
      const [first, ...others] = status.awaited;
      const more = others.length > 0 ? ` and ${others.length} more` : "";
      const drive = status.may_control ? ", or select a robot and press drive" : "";
      return {
        title: "Waiting for controllers",
        text: `No controller drives ${first ?? "the robots"}${more}. Start a controller${drive}, or in a shell:`,
        toType: status.to_type,
      };
    }
    case "ended":
      return {
        title: ends[status.end] ?? "The run has ended",
        text: `At ${at}${status.end_text ? `: ${status.end_text}` : "."}`,
        hasNumbers: true,
        isWrong: status.end === "failed",
        ...over,
      };
    case "gone":
      return {
        title: "The server is unreachable",
        text: `Since ${at}: it was killed or cannot be reached.`,
        isWrong: true,
        ...over,
      };
    default:
      return undefined;
  }
}

/** Shows the card over the picture, until the user closes it. */
export class PhaseCard {
  private status: ViewStatus | undefined;
  private isConnected = false;
  private isFirst = true;
  private closed = "";
  private readonly panel = element("phase");

  /** `numbers` returns the tick and the state hash to show. */
  constructor(
    replay: () => void,
    runAgain: () => void,
    private readonly numbers: () => string,
  ) {
    element("replay").addEventListener("click", replay);
    element("again").addEventListener("click", runAgain);
    element("phase-close").addEventListener("click", () => {
      this.closed = element("phase-title").textContent ?? "";
      this.show();
    });
    element("copy").addEventListener("click", () => {
      void navigator.clipboard?.writeText(element("to-type").textContent ?? "");
    });
  }

  take(status: ViewStatus): void {
    this.status = status;
    this.show();
  }
  connect(isConnected: boolean): void {
    if (this.isFirst && !isConnected) return;
    this.isFirst = false;
    this.isConnected = isConnected;
    this.show();
  }

  /** Called when the numbers of the last state have changed. */
  refresh(): void {
    if (!this.panel.hidden) this.show();
  }

  private show(): void {
    const card = cardOf(this.status, this.isConnected);
    if (card?.title !== this.closed) this.closed = "";
    this.panel.hidden = !card || this.closed !== "";
    if (!card) return;
    this.panel.classList.toggle("wrong", card.isWrong ?? false);
    element("phase-title").textContent = card.title;
    element("phase-text").textContent = card.hasNumbers ? `${card.text}\n${this.numbers()}` : card.text;
    element("phase-type").hidden = !card.toType;
    element("to-type").textContent = card.toType ?? "";
    element("replay").hidden = !card.recording;
    element("again").hidden = !card.canRunAgain;
  }
}
