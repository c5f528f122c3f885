import type { CameraMode, Viewpoint } from "./cameras";
import { download, Film, screenshot } from "./capture";
import type { Command, Commands } from "./commands";
import type { Connection, ViewRequest } from "./connection";
import type { ConsolePanel } from "./console";
import { element } from "./element";
import type { TimeBar } from "./time_bar";
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
  commands: Commands;
  canvas: HTMLCanvasElement;
}

function numberOf(text: string | undefined, what: string): number {
  const number = Number(text);
  if (text === undefined || text === "" || !Number.isFinite(number)) throw new Error(`expected ${what}`);
  return number;
}

/** Asks the server. Throws Error with what it said if it could not be done. */
async function ask(connection: Connection, request: ViewRequest): Promise<string> {
  const { done, text } = await connection.ask(request);
  if (!done) throw new Error(text);
  return text;
}

/** What can be said in the console beside what Commands know themselves. */
export function addConsoleCommands(parts: Parts): void {
  for (const command of [
    ...playbackCommands(parts),
    ...cameraCommands(parts),
    ...pictureCommands(parts),
    ...worldCommands(parts),
  ])
    parts.commands.add(command);
}

function playbackCommands({ connection, timeBar }: Parts): Command[] {
  const plain = (name: string, help: string): Command => ({
    name,
    usage: "",
    help,
    run: () => ask(connection, { operation: name }),
  });
  const speed = (number: number): Promise<string> => ask(connection, { operation: "speed", number });
  const next = (isFaster: boolean): number => {
    const now = timeBar.status?.speed ?? 1;
    const found = isFaster ? speeds.find((each) => each > now) : [...speeds].reverse().find((each) => each < now);
    return found ?? now;
  };
  return [
    plain("play", "goes on"),
    plain("pause", "stands still"),
    {
      name: "step",
      usage: "[TICKS]",
      help: "goes on by ticks, one if none is said; back where seek can",
      run: ([ticks]) =>
        ask(connection, { operation: "step", number: ticks === undefined ? 1 : numberOf(ticks, "a number of ticks") }),
    },
    {
      name: "seek",
      usage: "SECONDS",
      help: "goes to a time of a recording, or back to one of a server that keeps snapshots",
      run: ([time]) => ask(connection, { operation: "seek", number: numberOf(time, "seconds") }),
    },
    {
      name: "speed",
      usage: "FACTOR",
      help: "simulated seconds a second; max: as fast as it goes",
      complete: () => ["max", ...speeds.map(String)],
      run: ([factor]) => speed(factor === "max" ? 0 : numberOf(factor, "a factor, or max")),
    },
    { name: "faster", usage: "", help: "the next speed up", run: () => speed(next(true)) },
    { name: "slower", usage: "", help: "the next speed down", run: () => speed(next(false)) },
  ];
}

function cameraCommands({ viewer }: Parts): Command[] {
  const names = (): string[] => viewer.poses?.scene.entities.map(({ name }) => name) ?? [];
  const entityOf = (name: string | undefined): number => {
    const found = name === undefined ? viewer.selected : viewer.find(name);
    if (found === undefined) throw new Error(name === undefined ? "select something first" : `there is no '${name}'`);
    return found;
  };
  const choose = (mode: CameraMode, help: string): Command => ({
    name: mode,
    usage: "",
    help,
    run: () => {
      viewer.cameras.choose(mode);
      return "";
    },
  });
  const attach = (mode: CameraMode, help: string): Command => ({
    name: mode,
    usage: "[NAME]",
    help,
    complete: names,
    run: ([name]) => {
      const entity = entityOf(name);
      viewer.select(entity);
      viewer.cameras.choose(mode, entity);
      return "";
    },
  });
  return [
    choose("orbit", "turns about what is looked at"),
    choose("top", "looks from above"),
    choose("fly", "moves by keys: w a s d, q and z"),
    attach("follow", "goes along with an object or robot"),
    attach("eye", "looks as a robot does"),
    {
      name: "home",
      usage: "",
      help: "looks at everything",
      run: () => {
        viewer.home();
        return "";
      },
    },
    {
      name: "select",
      usage: "NAME",
      help: "chooses an object or robot, by its name or id",
      complete: names,
      run: ([name]) => {
        viewer.select(entityOf(name));
        return viewer.selectedEntity?.name ?? "";
      },
    },
    {
      name: "deselect",
      usage: "",
      help: "chooses nothing",
      run: () => {
        viewer.select(undefined);
        return "";
      },
    },
    {
      name: "viewpoint",
      usage: "[save NAME | NAME]",
      help: "keeps or takes a place to look from; without arguments lists them",
      complete: () => ["save", ...Object.keys(viewpoints())],
      run: (args) => viewpoint(viewer, args),
    },
    {
      name: "where",
      usage: "[NAME]",
      help: "says where it is",
      complete: names,
      run: ([name]) => {
        const { position, heading } = viewer.poseOf(entityOf(name));
        return `${position.map((each) => each.toFixed(4)).join(" ")} m, heading ${heading.toFixed(3)} rad`;
      },
    },
    {
      name: "plot",
      usage: "CHANNEL",
      help: "plots a channel of the selected robot",
      run: ([name]) => {
        if (!viewer.inspector.plot(name ?? "")) throw new Error(`what is selected has no channel '${name ?? ""}'`);
        return "";
      },
    },
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

function pictureCommands({ viewer, connection, console, timeBar, commands, canvas }: Parts): Command[] {
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
    {
      name: "toggle",
      usage: "[LAYER]",
      help: `${layers.join(", ")}; without argument plays or pauses`,
      complete: () => layers,
      run: ([name]) => toggleLayer(name),
    },
    {
      name: "theme",
      usage: "[light|dark]",
      help: "changes the colours of the page",
      complete: () => ["light", "dark"],
      run: ([asked]) => {
        const theme = asked === "light" || asked === "dark" ? asked : viewer.stage.theme === "dark" ? "light" : "dark";
        viewer.wear(theme);
        localStorage.setItem(themeKey, theme);
        return "";
      },
    },
    {
      name: "screenshot",
      usage: "",
      help: "the picture as PNG",
      run: async () => {
        download(await screenshot(canvas, () => viewer.draw(performance.now())), "cohort.png");
        return "cohort.png";
      },
    },
    {
      name: "film",
      usage: "",
      help: "begins or ends recording the picture as WebM",
      run: () => {
        if (film.isOn) film.stop();
        else film.start();
        return film.isOn ? "recording; 'film' ends it" : "cohort.webm";
      },
    },
    {
      name: "fullscreen",
      usage: "",
      help: "fills the screen, or no longer",
      run: async () => {
        if (document.fullscreenElement) await document.exitFullscreen();
        else await document.documentElement.requestFullscreen();
        return "";
      },
    },
    {
      name: "console",
      usage: "",
      help: "opens or closes this",
      run: () => {
        console.toggle();
        return "";
      },
    },
    {
      name: "events",
      usage: "",
      help: "shows or hides what happened",
      run: () => {
        const panel = element("events");
        panel.hidden = !panel.hidden;
        return "";
      },
    },
    {
      name: "profile",
      usage: "export|import",
      help: "keys, aliases and scripts as a file",
      complete: () => ["export", "import"],
      run: async ([what]) => {
        if (what === "export")
          download(new Blob([commands.exportProfile()], { type: "application/json" }), "cohort-profile.json");
        else if (what === "import") commands.importProfile(await chosenFile());
        else throw new Error("expected export or import");
        return "";
      },
    },
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
    { name: "reset", usage: "", help: "begins the run anew", run: () => ask(connection, { operation: "reset" }) },
    {
      name: "spawn",
      usage: "MODEL NAME X Y [Z]",
      help: "brings an object into the world",
      complete: (index) => (index === 0 ? models() : []),
      run: ([model, name, ...at]) =>
        ask(connection, {
          operation: "spawn",
          name,
          text: model,
          numbers: [...numbers(at, 2, "x and y"), Number(at[2] ?? 0)],
        }),
    },
    {
      name: "remove",
      usage: "NAME",
      help: "takes an object out",
      complete: names,
      run: ([name]) => ask(connection, { operation: "remove", name: whole(name) }),
    },
    {
      name: "move",
      usage: "NAME X Y [Z [HEADING]]",
      help: "puts an object elsewhere, upright",
      complete: (index) => (index === 0 ? names() : []),
      run: ([name, ...at]) =>
        ask(connection, {
          operation: "move",
          name: whole(name),
          numbers: [...numbers(at, 2, "x and y"), ...at.slice(2).map((each) => numberOf(each, "z and a heading"))],
        }),
    },
    {
      name: "light",
      usage: "NAME on|off",
      help: "switches a light",
      complete: (index) => (index === 0 ? names() : ["on", "off"]),
      run: ([name, on]) => ask(connection, { operation: "light", name: whole(name), number: on === "off" ? 0 : 1 }),
    },
    {
      name: "push",
      usage: "NAME FX FY [FZ]",
      help: "a force for a tenth of a second [N]",
      complete: (index) => (index === 0 ? names() : []),
      run: ([name, ...force]) =>
        ask(connection, {
          operation: "push",
          name: whole(name),
          numbers: [...numbers(force, 2, "a force"), Number(force[2] ?? 0)],
        }),
    },
  ];
}

/** Which of the tools are on. */
export function showPressed(viewer: Viewer): void {
  for (const button of document.querySelectorAll<HTMLButtonElement>("#tools [data-command]")) {
    const { command = "" } = button.dataset;
    const layer = command.startsWith("toggle ") ? (command.slice(7) as Layer) : undefined;
    button.classList.toggle("on", layer ? viewer.layers.has(layer) : viewer.cameras.mode === command);
  }
}

/** What was chosen before, or else what the system prefers. */
export function preferredTheme(): "light" | "dark" {
  const kept = localStorage.getItem(themeKey);
  if (kept === "light" || kept === "dark") return kept;
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
