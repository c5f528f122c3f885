// SPDX-License-Identifier: Apache-2.0

// Speaks the Foxglove WebSocket protocol to `cohort view`: node client.mjs SCENARIO ADDRESS [PROCESS]. Ends with 0 if all
// is right.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import rosmsg from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const { parse } = rosmsg;
const { MessageReader } = serialization;
const { FoxgloveClient } = protocol;

const patience = Number(process.env.COHORT_PATIENCE ?? 30_000); // [ms]

const [, , scenario, page, argument] = process.argv;
const address = new URL(page.replace(/^http/, "ws"));
address.hash = "";

function within(promise, what) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`nothing came: ${what}`)), patience);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

function connect() {
  const client = new FoxgloveClient({ ws: new WebSocket(address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
  const channels = within(new Promise((resolve) => client.on("advertise", resolve)), "channels");
  const services = within(new Promise((resolve) => client.on("advertiseServices", resolve)), "services");
  return { client, channels, services };
}

async function first(client, channel) {
  const reader = new MessageReader(parse(channel.schema, { ros2: true }));
  const id = client.subscribe(channel.id);
  return within(
    new Promise((resolve) =>
      client.on("message", ({ subscriptionId, data }) => {
        if (subscriptionId === id) resolve(reader.readMessage(data));
      }),
    ),
    channel.topic,
  );
}

async function call(client, service, request) {
  const data = new TextEncoder().encode(JSON.stringify(request));
  client.sendServiceCallRequest({
    serviceId: service.id,
    callId: 7,
    encoding: "json",
    data: new DataView(data.buffer),
  });
  return within(
    new Promise((resolve) =>
      client.on("serviceCallResponse", ({ callId, data: answer }) => {
        if (callId === 7) resolve(JSON.parse(new TextDecoder().decode(answer)));
      }),
    ),
    "an answer",
  );
}

// Every topic has its messages, as its schema says, and other viewers' too.
async function reads() {
  const { client, channels, services } = connect();
  const byTopic = new Map((await channels).map((each) => [each.topic, each]));
  const read = (topic) => first(client, byTopic.get(topic));
  const scene = await read("/cohort/scene");
  assert.equal(scene.entities.filter(({ robot }) => robot !== 0xffffffff).length, 16);
  const frame = await read("/cohort/frame");
  assert.equal(frame.revision, scene.revision);
  const links = scene.entities.reduce((sum, { model }) => sum + scene.models[model].links.length, 0);
  assert.equal(frame.positions.length, 3 * links);
  assert.equal(frame.orientations.length, 4 * links);
  const { transforms } = await read("/tf");
  assert.equal(transforms.length, links);
  const { markers } = await read("/markers");
  assert.ok(markers.length > links);
  const [service] = await services;
  assert.deepEqual(await call(client, service, { operation: "watch", numbers: [3] }), { done: true, text: "watched" });
  const { robots } = await read("/cohort/robots");
  assert.ok(robots.length <= 1);
  for (const topic of ["/cohort/signals", "/cohort/contacts", "/cohort/status", "/cohort/events"])
    assert.ok(await read(topic), topic);
  client.close();
}

// The values of a robot over a whole recording, while it plays, and what is refused.
async function histories() {
  const { id, samples } = JSON.parse(readFileSync(argument, "utf8"));
  const { client, services } = connect();
  const [service] = await services;
  const ask = (request) => call(client, service, { operation: "history", numbers: [id], ...request });
  const whole = async (request) => {
    const found = new Map();
    for (let from = request.from ?? 0; from !== undefined; ) {
      const { done, text, series, next } = await ask({ ...request, from });
      assert.ok(done, text);
      for (const { robot, name, unit, times, values } of series) {
        const key = `${robot} ${name}`;
        if (!found.has(key)) found.set(key, { unit, times: [], values: [] });
        found.get(key).times.push(...times);
        found.get(key).values.push(...values);
      }
      from = next;
    }
    return found;
  };
  const names = Object.keys(samples[0].values);
  const all = await whole({ names: [...names, "nothing"] });
  assert.deepEqual(
    [...all.keys()],
    names.map((name) => `${id} ${name}`),
  );
  for (const [key, { unit, times, values }] of all) {
    assert.equal(times.length, 401);
    assert.deepEqual([times[0], times.at(-1)], [0, 4]);
    assert.ok(!values.some((value) => Object.is(value, -0)));
    assert.equal(unit, key.endsWith("velocity") ? "m/s" : key.endsWith("position") ? "m" : "1");
    for (const { time, values: expected } of samples)
      assert.equal(values[times.indexOf(time)], expected[key.slice(String(id).length + 1)], `${key} at ${time}`);
  }
  // Commands alone are read from the file; the values are the same.
  const commands = names.filter((name) => name.startsWith("→"));
  for (const [key, { values }] of await whole({ names: commands })) assert.deepEqual(values, all.get(key).values);
  // A part of it, and few points.
  for (const { times } of (await whole({ names, from: 1, to: 1.5 })).values())
    assert.deepEqual([times.length, times[0], times.at(-1)], [51, 1, 1.5]);
  const few = await ask({ names, number: 20 });
  assert.equal(few.reduced, true);
  for (const { name, times, values } of few.series) {
    assert.ok(times.length <= 20, `${times.length} points`);
    const { values: exact } = all.get(`${id} ${name}`);
    assert.equal(Math.max(...values), Math.max(...exact), `the peak of ${name}`);
    assert.equal(Math.min(...values), Math.min(...exact));
  }
  const refused = [
    { names: [] },
    { names: ["nothing"] },
    { names, numbers: [] },
    { names, numbers: [1e9] },
    { names, numbers: Array(17).fill(0) },
    { names: Array(33).fill("a") },
    { names: Array(9).fill("a"), numbers: Array(16).fill(0) },
    { names, number: 1 },
    { names, from: 2, to: 1 },
  ];
  for (const request of refused) {
    const { done, text } = await ask(request);
    assert.equal(done, false, JSON.stringify(request));
    assert.notEqual(text, "");
  }
  client.close();
}

async function sendsNonsense() {
  const socket = new WebSocket(address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
  let complaints = 0;
  let failures = 0;
  socket.on("message", (data, isBinary) => {
    if (isBinary) return;
    const { op } = JSON.parse(String(data));
    complaints += op === "status" ? 1 : 0;
    failures += op === "serviceCallFailure" ? 1 : 0;
  });
  await within(new Promise((resolve) => socket.on("open", resolve)), "a connection");
  const number = (value) => {
    const bytes = Buffer.alloc(4);
    bytes.writeUInt32LE(value);
    return bytes;
  };
  const complained = [
    "",
    "{",
    "[]",
    "null",
    '{"op": 3}',
    '{"op": "subscribe"}',
    '{"op": "subscribe", "subscriptions": [{}]}',
    '{"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 0}]}',
    '{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 999}]}',
    '{"op": "unsubscribe", "subscriptionIds": [5]}',
    '{"op": "fetchAsset", "uri": "file:///etc/passwd", "requestId": 1}',
    "\ud800",
    "[".repeat(5000),
    Buffer.alloc(0),
    Buffer.from([0]),
    Buffer.from([2]),
    Buffer.from([99, 1, 2]),
    Buffer.concat([Buffer.from([2]), number(1), number(1), number(0xffffffff), Buffer.from("json{}")]),
  ];
  for (const each of complained) socket.send(each);
  const request = (text) =>
    Buffer.concat([Buffer.from([2]), number(1), number(1), number(4), Buffer.from(`json${text}`)]);
  const failed = [
    "",
    "{",
    "[]",
    '{"operation": 4}',
    '{"operation": "seek", "number": "x"}',
    '{"operation": "seek", "more": 1}',
    '{"operation": "history", "names": [1]}',
    '{"operation": "history", "names": "a"}',
    '{"operation": "history", "from": "a"}',
  ];
  for (const each of failed) socket.send(request(each));
  const deadline = Date.now() + patience;
  while ((complaints < complained.length || failures < failed.length) && Date.now() < deadline)
    await new Promise((resolve) => setTimeout(resolve, 20));
  assert.equal(complaints, complained.length);
  assert.equal(failures, failed.length);
  // A message that is too large ends the connection.
  socket.send(Buffer.alloc(2 << 20));
  await within(new Promise((resolve) => socket.on("close", resolve)), "the end of the connection");
}

const memoryOf = (process) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${process}/status`, "utf8"))[1]); // [kB]

// Counts frames that are sent to a client that reads them. Slowly, as the recording is short.
async function framesAreSent(count) {
  const { client, channels, services } = connect();
  await call(client, (await services)[0], { operation: "speed", number: 0.1 });
  const frames = (await channels).find(({ topic }) => topic === "/cohort/frame");
  let came = 0;
  const all = new Promise((resolve) =>
    client.on("message", () => {
      if (++came === count) resolve();
    }),
  );
  client.subscribe(frames.id);
  await within(all, `${count} frames`);
  client.close();
}

// Asks for everything and reads nothing: the server drops what does not fit, and serves others.
async function readsNothing() {
  const sockets = await Promise.all(
    Array.from({ length: 20 }, async () => {
      const socket = new WebSocket(address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
      await within(new Promise((resolve) => socket.on("open", resolve)), "a connection");
      const subscriptions = Array.from({ length: 60 }, (_, id) => ({ id, channelId: id % 9 }));
      socket.send(JSON.stringify({ op: "subscribe", subscriptions }));
      socket.pause();
      return socket;
    }),
  );
  await framesAreSent(60);
  const before = memoryOf(argument);
  await framesAreSent(120);
  const growth = memoryOf(argument) - before;
  assert.ok(growth < 16_000, `it has grown by ${growth} kB`);
  await reads();
  for (const socket of sockets) socket.terminate();
}

// Returns null if a client with these `headers` is admitted, otherwise the status of the answer.
function refusal(target, headers) {
  return within(
    new Promise((resolve) => {
      const socket = new WebSocket(target, [FoxgloveClient.SUPPORTED_SUBPROTOCOL], { headers });
      socket.on("open", () => {
        socket.terminate();
        resolve(null);
      });
      socket.on("unexpected-response", (_, response) => {
        socket.terminate();
        resolve(response.statusCode);
      });
      socket.on("error", () => undefined);
    }),
    "an answer",
  );
}

async function isRefused() {
  const withToken = new URL(address);
  withToken.search = `token=${new URLSearchParams(new URL(page).hash.slice(1)).get("token")}`;
  assert.equal(await refusal(withToken, {}), null);
  assert.equal(await refusal(withToken, { Origin: `http://${address.host}` }), null);
  assert.equal(await refusal(withToken, { Origin: "http://stranger.example" }), 403);
  assert.equal(await refusal(withToken, { Host: "stranger.example" }), 403);
  assert.equal(await refusal(address, {}), 403);
  const wrong = new URL(address);
  wrong.search = "token=0123456789abcdee";
  assert.equal(await refusal(wrong, {}), 403);
  const http = `http://${address.host}`;
  for (const path of ["/", "/index.html", "/page.js", "/page.css"])
    assert.equal((await fetch(http + path)).status, 200);
  for (const path of ["/src/main.ts", "/..%2f..%2fetc/passwd", "/page.js/", "//etc/passwd", "/run.mcap"])
    assert.equal((await fetch(http + path)).status, 404, path);
  assert.equal((await fetch(http, { method: "POST" })).status, 405);
}

const scenarios = {
  reads,
  histories,
  sends_nonsense: sendsNonsense,
  reads_nothing: readsNothing,
  is_refused: isRefused,
};
await scenarios[scenario]();
process.exit(0);
