// SPDX-License-Identifier: Apache-2.0
import { download, Film, screenshot } from "./capture";
import { type Command, type Commands, command } from "./commands";
import type { Connection, ViewRequest } from "./data/connection";
import { fixed } from "./data/numbers";
import { element } from "./element";
import type { ConsolePanel } from "./panels/console";
import { keyRows } from "./panels/keys";
import type { Panels } from "./panels/panels";
import type { TimeBar } from "./panels/time_bar";
import type { CameraMode, Viewpoint } from "./picture/cameras";
import type { Plots } from "./plots/plots";
import type { Layer, Viewer } from "./viewer";

const viewpointsKey = "cohort.view.viewpoints";
const themeKey = "cohort.view.theme";
const layers: Layer[] = ["labels", "contacts", "rays", "trails", "shadows", "sound", "collisions"];
const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100];

interface Parts {
  viewer: Viewer;
  connection: Connection;
  console: ConsolePanel;
  timeBar: TimeBar;
  plots: Plots;
  commands: Commands;
  canvas: HTMLCanvasElement;
  panels: Panels;
}

function numberOf(text: string | undefined, what: string): number {
  const number = Number(text);
  if (text === undefined || text === "" || !Number.isFinite(number)) throw new Error(`expected ${what}`);
  return number;
}

/** Sends a request, and returns the answer's text. Throws Error with the server's message if it fails. */
async function ask(connection: Connection, request: ViewRequest): Promise<string> {
  const { done, text } = await connection.ask(request);
  if (!done) throw new Error(text);
  return text;
}

/** Adds the commands of the console to those of Commands itself. */
export function addConsoleCommands(parts: Parts): void {
  for (const each of [
    ...playbackCommands(parts),
    ...cameraCommands(parts),
    ...pictureCommands(parts),
    ...worldCommands(parts),
  ])
    parts.commands.add(each);
}

function playbackCommands({ connection, timeBar }: Parts): Command[] {
  const plain = (name: string, help: string): Command =>
    command(name, help, () => ask(connection, { operation: name }));
  const speed = (number: number): Promise<string> => ask(connection, { operation: "speed", number });
  const next = (isFaster: boolean): number => {
    const now = timeBar.status?.speed ?? 1;
    const found = isFaster ? speeds.find((each) => each > now) : [...speeds].reverse().find((each) => each < now);
    return found ?? now;
  };
  return [
    plain("play", "resumes the run or the recording"),
    plain("pause", "pauses the run or the recording"),
    plain("again", "repeats a run that 'cohort run --view --control' started, once it has ended"),
    plain("replay", "shows the recording of a run that has ended"),
    command(
      "step [TICKS]",
      "steps by a number of ticks (default: 1); negative numbers step back where 'seek' can",
      ([ticks]) =>
        ask(connection, { operation: "step", number: ticks === undefined ? 1 : numberOf(ticks, "a number of ticks") }),
    ),
    command("seek SECONDS", "jumps to a time of a recording, or back in a run whose server keeps snapshots", ([time]) =>
      ask(connection, { operation: "seek", number: numberOf(time, "seconds") }),
    ),
    command(
      "speed FACTOR",
      "sets simulated seconds per second; max: as fast as possible",
      ([factor]) => speed(factor === "max" ? 0 : numberOf(factor, "a factor, or max")),
      () => ["max", ...speeds.map(String)],
    ),
    command("faster", "selects the next higher speed", () => speed(next(true))),
    command("slower", "selects the next lower speed", () => speed(next(false))),
  ];
}

function cameraCommands({ viewer, plots, panels }: Parts): Command[] {
  const names = (): string[] => viewer.poses?.scene.entities.map(({ name }) => name) ?? [];
  const entityOf = (name: string | undefined): number => {
    const found = name === undefined ? viewer.chosen.selected : viewer.find(name);
    if (found === undefined) throw new Error(name === undefined ? "select something first" : `there is no '${name}'`);
    return found;
  };
  const choose = (mode: CameraMode, help: string): Command => command(mode, help, () => viewer.cameras.choose(mode));
  const attach = (mode: CameraMode, help: string): Command =>
    command(
      `${mode} [NAME]`,
      help,
      ([name]) => {
        const entity = entityOf(name);
        if (name !== undefined || mode === "eye") viewer.chosen.select(entity);
        viewer.cameras.choose(mode, entity, mode === "follow" ? [...viewer.chosen.selection] : []);
      },
      names,
    );
  return [
    choose("orbit", "orbits the camera about its target"),
    choose("top", "looks from above"),
    choose("fly", "flies by the keys w a s d, q and z"),
    attach("follow", "follows an object or robot"),
    attach("eye", "looks through the eye of a robot"),
    command("home", "shows the whole world", () => viewer.home()),
    command(
      "select NAME",
      "selects an object or robot by its name or id",
      ([name]) => {
        viewer.chosen.select(entityOf(name));
        return viewer.chosen.selectedEntity?.name ?? "";
      },
      names,
    ),
    command("deselect", "clears the selection", () => viewer.chosen.select(undefined)),
    command(
      "viewpoint [save NAME | NAME]",
      "saves or recalls a viewpoint; without arguments lists them",
      (args) => viewpoint(viewer, args),
      () => ["save", ...Object.keys(viewpoints())],
    ),
    command(
      "where [NAME]",
      "prints a position and heading",
      ([name]) => {
        const { position, heading } = viewer.poseOf(entityOf(name));
        return `${position.map((each) => fixed(each, 4)).join(" ")} m, heading ${fixed(heading, 3)} rad`;
      },
      names,
    ),
    command(
      "plot CHANNEL|UNIT",
      "plots a channel of the selected robots, or all channels of a unit",
      (words) => {
        if (!plots.add(words.join(" "))) throw new Error(`the selected robot has no channel '${words.join(" ")}'`);
        panels.show("plotting");
      },
      () => plots.names(),
    ),
  ];
}

function viewpoints(): Record<string, Viewpoint> {
  try {
    return JSON.parse(localStorage.getItem(viewpointsKey) ?? "{}") as Record<string, Viewpoint>;
  } catch {
    return {};
  }
}

function viewpoint(viewer: Viewer, [first, second]: string[]): string {
  const kept = viewpoints();
  if (first === undefined) return Object.keys(kept).join("  ");
  if (first === "save") {
    if (!second) throw new Error("expected: viewpoint save NAME");
    localStorage.setItem(viewpointsKey, JSON.stringify({ ...kept, [second]: viewer.cameras.viewpoint() }));
    return "";
  }
  if (!kept[first]) throw new Error(`there is no viewpoint '${first}'`);
  viewer.cameras.look(kept[first]);
  return "";
}

function pictureCommands({ viewer, connection, console, timeBar, commands, canvas, panels }: Parts): Command[] {
  const film = new Film(canvas);
  const toggleLayer = (name: string | undefined): string => {
    if (name === undefined) {
      timeBar.toggle();
      return "";
    }
    if (!layers.includes(name as Layer)) throw new Error(`expected one of ${layers.join(", ")}`);
    const isOn = viewer.toggle(name as Layer);
    if (name === "contacts") connection.want("/cohort/contacts", isOn);
    showPressed(viewer);
    return `${name} ${isOn ? "on" : "off"}`;
  };
  return [
    command(
      "toggle [LAYER]",
      `${layers.join(", ")}; without argument plays or pauses`,
      ([name]) => toggleLayer(name),
      () => layers,
    ),
    command(
      "theme [light|dark]",
      "changes the colours of the page",
      ([asked]) => {
        const theme = asked === "light" || asked === "dark" ? asked : viewer.stage.theme === "dark" ? "light" : "dark";
        viewer.wear(theme);
        localStorage.setItem(themeKey, theme);
      },
      () => ["light", "dark"],
    ),
    command("screenshot", "saves the picture as PNG", async () => {
      download(await screenshot(canvas, () => viewer.drawFinely()), "cohort.png");
      return "cohort.png";
    }),
    command("film", "starts or stops recording the picture as WebM", () => {
      if (film.isOn) film.stop();
      else film.start();
      viewer.stage.quality.isHeld = film.isOn;
      return film.isOn ? "recording; 'film' ends it" : "cohort.webm";
    }),
    command("fullscreen", "enters or leaves full screen", async () => {
      if (document.fullscreenElement) await document.exitFullscreen();
      else await document.documentElement.requestFullscreen();
    }),
    command("console", "opens or closes the console", () => console.toggle()),
    command("events", "shows or hides the events", () => {
      if (panels.isShown("events")) panels.close("events");
      else panels.show("events");
    }),
    command(
      "panel left|right|dock",
      "opens or closes a panel",
      ([name]) => {
        if (name !== "left" && name !== "right" && name !== "dock") throw new Error("expected left, right or dock");
        panels.toggle(name);
      },
      () => ["left", "right", "dock"],
    ),
    command("keys", "shows the keys", () => {
      element("key-table").replaceChildren(...keyRows(commands));
      (element("keys") as HTMLDialogElement).showModal();
    }),
    command(
      "profile export|import",
      "exports or imports keys, aliases and scripts as a file",
      async ([what]) => {
        if (what === "export")
          download(new Blob([commands.exportProfile()], { type: "application/json" }), "cohort-profile.json");
        else if (what === "import") commands.importProfile(await chosenFile());
        else throw new Error("expected export or import");
      },
      () => ["export", "import"],
    ),
  ];
}

function worldCommands({ viewer, connection }: Parts): Command[] {
  const names = (): string[] => viewer.poses?.scene.entities.map(({ name }) => name) ?? [];
  const models = (): string[] => viewer.poses?.scene.models.map(({ name }) => name) ?? [];
  const whole = (name: string | undefined): string | undefined => {
    const found = name === undefined ? undefined : viewer.find(name);
    return found === undefined ? name : viewer.poses?.scene.entities[found].name;
  };
  const numbers = (args: string[], count: number, what: string): number[] =>
    Array.from({ length: count }, (_, i) => numberOf(args[i], what));
  return [
    command("reset", "restarts the run from its beginning", () => ask(connection, { operation: "reset" })),
    command("shutdown", "ends the run and its server", () => ask(connection, { operation: "shutdown" })),
    command(
      "spawn MODEL NAME X Y [Z]",
      "adds an object to the world",
      ([model, name, ...at]) =>
        ask(connection, {
          operation: "spawn",
          name,
          text: model,
          numbers: [...numbers(at, 2, "x and y"), Number(at[2] ?? 0)],
        }),
      (index) => (index === 0 ? models() : []),
    ),
    command(
      "remove NAME",
      "removes an object from the world",
      ([name]) => ask(connection, { operation: "remove", name: whole(name) }),
      names,
    ),
    command(
      "move NAME X Y [Z [HEADING]]",
      "moves an object and sets it upright",
      ([name, ...at]) =>
        ask(connection, {
          operation: "move",
          name: whole(name),
          numbers: [...numbers(at, 2, "x and y"), ...at.slice(2).map((each) => numberOf(each, "z and a heading"))],
        }),
      (index) => (index === 0 ? names() : []),
    ),
    command(
      "light NAME on|off",
      "switches a light",
      ([name, on]) => ask(connection, { operation: "light", name: whole(name), number: on === "off" ? 0 : 1 }),
      (index) => (index === 0 ? names() : ["on", "off"]),
    ),
    command(
      "push NAME FX FY [FZ]",
      "applies a force [N] for 0.1 s",
      ([name, ...force]) =>
        ask(connection, {
          operation: "push",
          name: whole(name),
          numbers: [...numbers(force, 2, "a force"), Number(force[2] ?? 0)],
        }),
      (index) => (index === 0 ? names() : []),
    ),
  ];
}

const isCameraMode = (command: string): boolean => ["orbit", "follow", "top", "eye", "fly"].includes(command);

/** Shows which tools are switched on. */
export function showPressed(viewer: Viewer): void {
  for (const button of document.querySelectorAll<HTMLButtonElement>("#tools [data-command]")) {
    const { command = "" } = button.dataset;
    const layer = command.startsWith("toggle ") ? (command.slice(7) as Layer) : undefined;
    const isOn = layer ? viewer.layers.has(layer) : viewer.cameras.mode === command;
    if (layer || isCameraMode(command)) button.setAttribute("aria-pressed", String(isOn));
  }
}

/** Returns the theme that the user has chosen before, or otherwise the one that the system prefers. */
export function preferredTheme(): "light" | "dark" {
  try {
    const kept = localStorage.getItem(themeKey);
    if (kept === "light" || kept === "dark") return kept;
  } catch {
    // Some browsers offer no storage to a page that is embedded in a frame.
  }
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

function chosenFile(): Promise<string> {
  return new Promise((resolve, reject) => {
    const input = document.createElement("input");
    input.type = "file";
    input.onchange = () =>
      input.files?.[0] ? input.files[0].text().then(resolve, reject) : reject(new Error("no file was chosen"));
    input.click();
  });
}
