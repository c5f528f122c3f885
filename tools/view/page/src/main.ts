// SPDX-License-Identifier: Apache-2.0
import "uplot/dist/uPlot.min.css";
import "./page.css";
import { Commands } from "./commands";
import { addConsoleCommands, preferredTheme, showPressed } from "./console_commands";
import { connect } from "./data/connect";
import type { Connection } from "./data/connection";
import { seconds, type ViewEvent, type ViewStatus } from "./data/messages";
import { addressOfServer } from "./data/server_connection";
import { element } from "./element";
import { FilmMode } from "./film_mode";
import { Driving } from "./hands/driving";
import { Objects } from "./hands/objects";
import { ConsolePanel } from "./panels/console";
import { Panels } from "./panels/panels";
import { PhaseCard } from "./panels/phase_card";
import { clockText, TimeBar } from "./panels/time_bar";
import { TopBar } from "./panels/top_bar";
import { Plots } from "./plots/plots";
import "./panels/tree.css";
import { Tree } from "./panels/tree";
import { Viewer } from "./viewer";

const canvas = element("canvas") as HTMLCanvasElement;
const mostWatched = 256; // robots; also in tools/view/web/client_session.hpp
const clickSlack = 4; // [pixels] by which the mouse may move during a click

let bytes = 0;
let unrecorded = ""; // reason why the recording of the run has ended; empty while it records
let notes: readonly string[] = []; // from the last status

const viewer: Viewer = new Viewer(canvas, (robots) => {
  connection.want("/cohort/robots", robots.length > 0);
  void connection.ask({ operation: "watch", numbers: robots.slice(0, mostWatched) });
  plots.show(robots);
  tree.show();
  driving.show();
  objects.show();
});
const commands = new Commands();
const panels = new Panels();
const topBar = new TopBar();
const consolePanel = new ConsolePanel(commands, panels);
const tree: Tree = new Tree(viewer);
const timeBar = new TimeBar({
  play: () => void consolePanel.run("play"),
  pause: () => void consolePanel.run("pause"),
  step: (ticks) => void consolePanel.run(`step ${ticks}`),
  seek: (time) =>
    void (timeBar.status?.loses_what_follows
      ? consolePanel.run(`seek ${time}`)
      : connection.ask({ operation: "seek", number: time })),
  speed: (factor) => void connection.ask({ operation: "speed", number: factor }),
});
const plots = new Plots({
  ask: (request) => connection.ask(request),
  seek: (time) => void consolePanel.run(`seek ${time}`),
});
viewer.inspector.onPlot = (name) => {
  panels.show("plotting");
  plots.add(name);
};

const phaseCard = new PhaseCard(
  () => void consolePanel.run("replay"),
  () => void consolePanel.run("again"),
  () => `${element("tick").textContent} ticks, state hash ${element("hash").textContent}`,
);
const connection: Connection = connect(
  addressOfServer(location),
  {
    "/cohort/scene": (scene, size) => {
      bytes += size;
      plots.setScene(scene);
      viewer.show(scene);
      showPressed(viewer);
    },
    "/cohort/frame": (frame, size) => {
      bytes += size;
      viewer.take(frame);
      element("tick").textContent = String(frame.tick);
      element("hash").textContent = frame.state_hash === 0n ? "–" : frame.state_hash.toString(16).padStart(16, "0");
      const gone = new Set(frame.absent);
      const robots = viewer.robotEntities().filter((entity) => !gone.has(entity)).length;
      element("robots").textContent = String(robots);
      phaseCard.refresh();
    },
    "/cohort/signals": (signals, size) => {
      bytes += size;
      viewer.takeSignals(signals);
      objects.showLight();
    },
    "/cohort/contacts": (contacts) => viewer.takeContacts(contacts),
    "/cohort/robots": ({ robots }) => {
      viewer.takeRobots(robots);
      plots.take(robots);
    },
    "/cohort/status": showStatus,
    "/cohort/events": ({ events }) => showEvents(events),
  },
  (isConnected) => {
    phaseCard.connect(isConnected);
    topBar.connect(isConnected);
    plots.forget();
    if (isConnected && viewer.chosen.selection.size > 0) viewer.chosen.selectMany([...viewer.chosen.selection]);
  },
);
for (const topic of ["/cohort/scene", "/cohort/frame", "/cohort/signals", "/cohort/status", "/cohort/events"] as const)
  connection.want(topic);
addConsoleCommands({ viewer, connection, console: consolePanel, timeBar, plots, commands, canvas, panels });
const driving = new Driving(viewer, connection, commands, consolePanel, canvas);
const objects = new Objects(viewer, connection, consolePanel, canvas, panels);
const film = new FilmMode(viewer, connection, canvas);
for (const command of [...driving.consoleCommands(), ...objects.consoleCommands()]) commands.add(command);

function showStatus(status: ViewStatus): void {
  timeBar.take(status);
  plots.takeStatus(status);
  phaseCard.take(status);
  document.body.classList.toggle("is-server", status.source === "server");
  topBar.take(status);
  const waiting = status.awaited.length > 0 ? `waits for ${status.awaited.join(", ")}` : "";
  notes = [status.note, waiting];
  showNotes();
}

function showNotes(): void {
  const text = [unrecorded && `NOT RECORDED: ${unrecorded}`, ...notes].filter((each) => each !== "").join(" · ");
  element("note").hidden = text === "";
  element("note").textContent = text;
}

function showEvents(events: readonly ViewEvent[]): void {
  timeBar.mark(events);
  unrecorded = events.find(({ kind }) => kind === "unrecorded")?.text ?? "";
  showNotes();
  element("events").replaceChildren(
    ...events.slice(-200).map(({ time_ns, kind, text, count, last_ns }) => {
      const line = document.createElement("p");
      const time = document.createElement("b");
      time.textContent = `${clockText(seconds(time_ns))} ${kind} `;
      const again = count > 1n ? ` (${count} times, last at ${clockText(seconds(last_ns))})` : "";
      line.append(time, text + again);
      return line;
    }),
  );
  element("events").scrollTop = element("events").scrollHeight;
}

// Keys and mouse.

const flyKeys: Record<string, string> = { w: "forward", s: "back", a: "left", d: "right", q: "up", z: "down" };

function runBound(key: string): boolean {
  const command = commands.commandOfKey(key);
  if (command === undefined) return false;
  if (command === "help") consolePanel.toggle(true);
  void consolePanel.run(command).then(() => showPressed(viewer));
  return true;
}

addEventListener("keydown", (event) => {
  if (document.querySelector("dialog[open]")) return;
  const isTyping = event.target instanceof HTMLInputElement && event.target.type !== "range";
  if (isTyping || event.target instanceof HTMLSelectElement || event.ctrlKey || event.metaKey || event.altKey) return;
  if (driving.keyDown(event)) {
    /* drives */
  } else if (event.key === "Escape" && objects.isAdding) objects.close();
  else if (viewer.cameras.mode === "fly" && event.key in flyKeys) viewer.cameras.held.add(flyKeys[event.key]);
  else if (!runBound(event.key)) return;
  event.preventDefault();
});
addEventListener("keyup", (event) => {
  viewer.cameras.held.delete(flyKeys[event.key] ?? "");
  driving.keyUp(event);
});
addEventListener("blur", () => viewer.cameras.held.clear());

let pressed = { x: 0, y: 0 };
canvas.addEventListener(
  "pointerdown",
  ({ clientX: x, clientY: y, shiftKey, pointerId }) => {
    pressed = { x, y };
    const isGrabbed = shiftKey && objects.grab(x, y);
    if (isGrabbed) canvas.setPointerCapture(pointerId); // so that a release over a card is noticed too
    viewer.cameras.controls.enabled = !isGrabbed && viewer.cameras.mode !== "eye";
  },
  { capture: true },
);
canvas.addEventListener("pointermove", ({ clientX: x, clientY: y }) => objects.hover(x, y));
// Selects the entity under the mouse. With Ctrl, adds it to the selection or removes it.
function pick(x: number, y: number, isAdded: boolean): void {
  const entity = viewer.pickAt(x, y);
  if (!isAdded) viewer.chosen.select(entity);
  if (!isAdded || entity === undefined) return;
  const others = [...viewer.chosen.selection].filter((each) => each !== entity);
  viewer.chosen.selectMany(viewer.chosen.selection.has(entity) ? others : [...others, entity]);
}
canvas.addEventListener("pointerup", ({ clientX: x, clientY: y, button, ctrlKey, metaKey }) => {
  if (objects.isDragging) {
    viewer.cameras.controls.enabled = viewer.cameras.mode !== "eye";
    void objects.drop(x, y);
    return;
  }
  if (Math.hypot(x - pressed.x, y - pressed.y) > clickSlack) return;
  if (button === 0 && objects.place(x, y)) return;
  if (button === 0) pick(x, y, ctrlKey || metaKey);
  else runBound(`mouse${button}`);
});
canvas.addEventListener("dblclick", ({ clientX: x, clientY: y }) => {
  const entity = viewer.pickAt(x, y);
  if (entity === undefined) return;
  viewer.chosen.select(entity);
  viewer.cameras.choose("follow", entity);
  showPressed(viewer);
});
for (const bar of ["tools", "menu"])
  element(bar).addEventListener("click", ({ target }) => {
    const command = (target as Element).closest<HTMLElement>("[data-command]")?.dataset.command;
    if (command) void consolePanel.run(command).then(() => showPressed(viewer));
  });

// The picture.

function resize(): void {
  viewer.stage.resize(canvas.clientWidth, canvas.clientHeight);
  viewer.stillness.touch();
}
new ResizeObserver(resize).observe(canvas);
resize();
viewer.wear(preferredTheme());
viewer.onLayers = () => showPressed(viewer);
showPressed(viewer);
for (const kind of ["pointerdown", "pointermove", "pointerup", "wheel", "keydown", "keyup", "input", "change"])
  addEventListener(kind, () => viewer.stillness.touch(), { capture: true, passive: true });
function draw(now: number): void {
  viewer.drawIfDue(now);
  requestAnimationFrame(draw);
}
if (!film.isOn) requestAnimationFrame(draw);
setInterval(() => {
  element("seen").textContent = viewer.describe();
  element("rate").textContent = String(viewer.framesDrawn);
  element("traffic").textContent = (bytes / 1000).toFixed(0);
  viewer.framesDrawn = 0;
  bytes = 0;
}, 1000);

/** Exports for tests and for the browser's console. */
Object.assign(window, {
  cohort: { viewer, commands, connection, driving, objects, plots, film, run: (line: string) => commands.run(line) },
});
