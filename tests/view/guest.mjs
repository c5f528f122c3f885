// SPDX-License-Identifier: Apache-2.0

// A second client beside the page under test, without a browser: sends a page's requests, and reads the robots'
// commands.
import rosmsg from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const { FoxgloveClient } = protocol;

export class Guest {
  /** `page`: address of the page. */
  static async at(page) {
    const address = new URL(page.replace(/^http/, "ws"));
    address.hash = "";
    const client = new FoxgloveClient({ ws: new WebSocket(address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
    const channels = new Promise((resolve) => client.on("advertise", resolve));
    const services = new Promise((resolve) => client.on("advertiseServices", resolve));
    return new Guest(client, await channels, (await services)[0]);
  }

  constructor(client, channels, service) {
    Object.assign(this, { client, channels, service, calls: 0 });
  }

  ask(request) {
    const call = ++this.calls;
    const data = new TextEncoder().encode(JSON.stringify(request));
    const answer = new Promise((resolve) =>
      this.client.on("serviceCallResponse", ({ callId, data: payload }) => {
        if (callId === call) resolve(JSON.parse(new TextDecoder().decode(payload)));
      }),
    );
    this.client.sendServiceCallRequest({
      serviceId: this.service.id,
      callId: call,
      encoding: "json",
      data: new DataView(data.buffer),
    });
    return answer;
  }

  /** The first message of a topic, from now on, of which `look` gives something that is true: what it gives. */
  async sees(topic, look) {
    const channel = this.channels.find((each) => each.topic === topic);
    const reader = new serialization.MessageReader(rosmsg.parse(channel.schema, { ros2: true }));
    const id = this.client.subscribe(channel.id);
    const found = await new Promise((resolve) =>
      this.client.on("message", ({ subscriptionId, data }) => {
        const seen = subscriptionId === id && look(reader.readMessage(data));
        if (seen) resolve(seen);
      }),
    );
    this.client.unsubscribe(id);
    return found;
  }

  close() {
    this.client.close();
  }
}
