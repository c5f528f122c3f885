// SPDX-License-Identifier: Apache-2.0
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { type Channel, FoxgloveClient, type Service } from "@foxglove/ws-protocol";
import type { Answer, Connection, Handlers, ViewRequest } from "./connection";
import type { Topic } from "./messages";

interface Subscribed {
  topic: Topic;
  reader: MessageReader;
}

const firstWait = 250; // [ms]
const longestWait = 4000;

/** A client of the server from which the page was loaded. It reconnects when the connection is lost. */
export class ServerConnection implements Connection {
  readonly received = new Map<Topic, bigint>();
  private client: FoxgloveClient | undefined;
  private channels = new Map<string, Channel>();
  private subscribed = new Map<number, Subscribed>();
  private wanted = new Set<Topic>();
  private service: Service | undefined;
  private calls = new Map<number, { resolve: (answer: Answer) => void }>();
  private nextCall = 1;
  private wait = firstWait;

  constructor(
    private readonly url: string,
    private readonly handlers: Handlers,
    private readonly changed: (isConnected: boolean) => void,
  ) {
    this.connect();
  }

  want(topic: Topic, isWanted = true): void {
    if (isWanted === this.wanted.has(topic)) return;
    if (isWanted) {
      this.wanted.add(topic);
      this.subscribe(topic);
      return;
    }
    this.wanted.delete(topic);
    for (const [id, { topic: of }] of this.subscribed) {
      if (of !== topic) continue;
      this.client?.unsubscribe(id);
      this.subscribed.delete(id);
    }
  }

  ask(request: ViewRequest): Promise<Answer> {
    const { client, service } = this;
    if (!client || !service) return Promise.resolve({ done: false, text: "there is no connection" });
    const callId = this.nextCall++;
    const data = new TextEncoder().encode(JSON.stringify(request));
    return new Promise((resolve) => {
      this.calls.set(callId, { resolve });
      client.sendServiceCallRequest({
        serviceId: service.id,
        callId,
        encoding: "json",
        data: new DataView(data.buffer),
      });
    });
  }

  private connect(): void {
    const client = new FoxgloveClient({ ws: new WebSocket(this.url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
    client.on("open", () => {
      this.client = client;
      this.wait = firstWait;
      this.changed(true);
    });
    client.on("advertise", (channels) => {
      for (const channel of channels) this.channels.set(channel.topic, channel);
      for (const topic of this.wanted) this.subscribe(topic);
    });
    client.on("advertiseServices", (services) => {
      this.service = services.find((each) => each.name === "/cohort/control");
    });
    client.on("message", ({ subscriptionId, timestamp, data }) => this.take(subscriptionId, timestamp, data));
    client.on("serviceCallResponse", ({ callId, data }) => {
      this.answer(callId, JSON.parse(new TextDecoder().decode(data)) as Answer);
    });
    client.on("serviceCallFailure", ({ callId, message }) => this.answer(callId, { done: false, text: message }));
    client.on("status", ({ message }) => console.warn(message));
    client.on("error", () => undefined); // "close" follows
    client.on("close", () => this.lost());
  }

  private lost(): void {
    this.client = undefined;
    this.service = undefined;
    this.channels.clear();
    this.subscribed.clear();
    for (const callId of [...this.calls.keys()]) this.answer(callId, { done: false, text: "the connection was lost" });
    this.changed(false);
    setTimeout(() => this.connect(), this.wait);
    this.wait = Math.min(2 * this.wait, longestWait);
  }

  private subscribe(topic: Topic): void {
    const channel = this.channels.get(topic);
    if (!this.client || !channel) return;
    const reader = new MessageReader(parse(channel.schema, { ros2: true }));
    this.subscribed.set(this.client.subscribe(channel.id), { topic, reader });
  }

  private take(subscription: number, time: bigint, data: ArrayBufferView): void {
    const found = this.subscribed.get(subscription);
    if (!found) return;
    const handler = this.handlers[found.topic] as ((message: unknown, bytes: number) => void) | undefined;
    handler?.(found.reader.readMessage(data), data.byteLength);
    this.received.set(found.topic, time);
  }

  private answer(callId: number, answer: Answer): void {
    this.calls.get(callId)?.resolve(answer);
    this.calls.delete(callId);
  }
}

/**
 * Returns the address of this page's WebSocket. The token is in the page's fragment, after `#`, which browsers do not
 * send.
 */
export function addressOfServer(page: Location): string {
  const token = new URLSearchParams(page.hash.slice(1)).get("token");
  return `ws://${page.host}/${token ? `?token=${encodeURIComponent(token)}` : ""}`;
}
