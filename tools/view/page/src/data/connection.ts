// SPDX-License-Identifier: Apache-2.0
import type { Messages, Topic } from "./messages";

export interface ViewRequest {
  operation: string;
  number?: number;
  name?: string;
  text?: string;
  numbers?: number[];
  names?: string[];
  from?: number;
  to?: number;
}
export interface Answer {
  done: boolean;
  text: string;
  series?: { robot: number; name: string; unit: string; times: number[]; values: (number | null)[] }[];
  reduced?: boolean;
  next?: number;
}

export type Handlers = { [T in Topic]?: (message: Messages[T], bytes: number) => void };

/** The source of the data that the page shows. */
export interface Connection {
  /** The time of the last message of each topic of a server [ns]. */
  readonly received: ReadonlyMap<Topic, bigint>;
  /** Starts or stops passing messages of a topic to its handler. Also holds after the connection was lost. */
  want(topic: Topic, isWanted?: boolean): void;
  ask(request: ViewRequest): Promise<Answer>;
}
