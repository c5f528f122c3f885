// SPDX-License-Identifier: Apache-2.0
import { defaultSteering, readSteer } from "./hands/steering";

/** A command of the console. */
export interface Command {
  name: string;
  usage: string; // the arguments
  help: string;
  complete?: (index: number) => readonly string[]; // candidates for an argument
  run: (args: string[]) => unknown; // returns the output, if it is a text or a promise of one
}

/** Returns a command. `line` is its name, followed by its arguments. */
export function command(line: string, help: string, run: Command["run"], complete?: Command["complete"]): Command {
  const [name] = line.split(" ", 1);
  return { name, usage: line.slice(name.length + 1), help, complete, run };
}

interface Profile {
  aliases: Record<string, string>;
  keys: Record<string, string>;
  scripts: Record<string, string>;
  steering: Record<string, string>;
}

const storage = "cohort.view.profile";
const deepestAlias = 16;
const mostLines = 10_000;

export const defaultKeys: Record<string, string> = {
  " ": "toggle",
  ".": "step",
  ",": "step -1",
  f: "follow",
  o: "orbit",
  t: "top",
  e: "eye",
  g: "fly",
  Escape: "deselect",
  c: "toggle contacts",
  r: "toggle rays",
  l: "toggle labels",
  p: "screenshot",
  F: "fullscreen",
  Home: "home",
  "+": "faster",
  "-": "slower",
  "`": "console",
  "?": "keys",
};

/** Splits a line into words; spaces within quotes are kept. */
export function words(line: string): string[] {
  return [...line.matchAll(/"([^"]*)"|'([^']*)'|(\S+)/g)].map(([, a, b, c]) => a ?? b ?? c);
}

/**
 * Splits a line or a script into commands. Outside quotes, `;` and line breaks separate commands, and `#` begins a
 * comment.
 */
export function statements(text: string): string[] {
  const found: string[] = [];
  for (const line of text.split("\n")) {
    let quote = "";
    let current = "";
    for (const letter of line) {
      if (quote) quote = letter === quote ? "" : quote;
      else if (letter === '"' || letter === "'") quote = letter;
      else if (letter === "#") break;
      else if (letter === ";") {
        found.push(current);
        current = "";
        continue;
      }
      current += letter;
    }
    found.push(current);
  }
  return found.map((each) => each.trim()).filter((each) => each !== "");
}

/** All commands, aliases, scripts and key bindings. All except the commands are stored in the browser. */
export class Commands {
  private readonly commands = new Map<string, Command>();
  private profile: Profile = { aliases: {}, keys: { ...defaultKeys }, scripts: {}, steering: { ...defaultSteering } };

  constructor() {
    try {
      const kept = localStorage.getItem(storage);
      if (kept) this.profile = readProfile(kept);
    } catch {
      // The stored profile is damaged, or storage is not allowed: begin with the default profile.
    }
    for (const each of this.ownCommands()) this.add(each);
  }

  add(added: Command): void {
    this.commands.set(added.name, added);
  }
  names(): string[] {
    return [...this.commands.keys(), ...Object.keys(this.profile.aliases)].sort();
  }
  commandOfKey(key: string): string | undefined {
    return this.profile.keys[key];
  }
  keys(): Readonly<Record<string, string>> {
    return this.profile.keys;
  }
  /** Returns the effect of a held key on a driven robot. */
  steeringOfKey(key: string): string | undefined {
    return this.profile.steering[key];
  }

  /** Runs a line or a script. Throws Error with a message to the user if a command fails. */
  async run(text: string, depth = 0): Promise<string> {
    if (depth > deepestAlias) throw new Error("the alias refers to itself");
    const lines = statements(text);
    if (lines.length > mostLines) throw new Error(`a script has at most ${mostLines} commands`);
    const said: string[] = [];
    for (const line of lines) said.push(await this.runOne(line, depth));
    return said.filter((each) => each !== "").join("\n");
  }

  /** Returns the possible completions of the last word of a line. */
  complete(line: string): string[] {
    const given = words(line);
    if (line === "" || line.endsWith(" ")) given.push("");
    const last = given[given.length - 1];
    const candidates =
      given.length === 1 ? this.names() : (this.commands.get(given[0])?.complete?.(given.length - 2) ?? []);
    return [...new Set(candidates)].filter((each) => each.startsWith(last));
  }

  help(name?: string): string {
    if (!name)
      return [...this.commands.values()]
        .map(({ name: word, usage, help }) => `${`${word} ${usage}`.padEnd(34)} ${help}`)
        .join("\n");
    const found = this.commands.get(name);
    if (found) return `${found.name} ${found.usage}\n  ${found.help}`;
    const alias = this.profile.aliases[name];
    if (alias) return `${name} is an alias of: ${alias}`;
    throw new Error(`there is no command '${name}'`);
  }

  /** Returns a description of a line: the help of its command, or the line itself if it has arguments. */
  helpOf(line: string): string {
    const [name, ...args] = words(line);
    return args.length === 0 ? (this.commands.get(name)?.help ?? line) : line;
  }

  exportProfile(): string {
    return JSON.stringify(this.profile, null, 2);
  }
  importProfile(text: string): void {
    this.profile = readProfile(text);
    this.keep();
  }

  private async runOne(line: string, depth: number): Promise<string> {
    const [name, ...args] = words(line);
    const alias = this.profile.aliases[name];
    if (alias !== undefined) return this.run([alias, ...args.map((each) => JSON.stringify(each))].join(" "), depth + 1);
    const found = this.commands.get(name);
    if (!found) throw new Error(`there is no command '${name}': 'help' lists them`);
    const said = await found.run(args);
    return typeof said === "string" ? said : "";
  }

  private keep(): void {
    try {
      localStorage.setItem(storage, JSON.stringify(this.profile));
    } catch {
      // Storage is not available: the profile is lost when the page is closed.
    }
  }

  private ownCommands(): Command[] {
    const list = (of: Record<string, string>): string =>
      Object.entries(of)
        .map(([key, to]) => `${key.padEnd(10)} ${to}`)
        .join("\n");
    const need = (args: string[], count: number, usage: string): void => {
      if (args.length < count) throw new Error(`expected: ${usage}`);
    };
    const change =
      (kind: keyof Profile, usage: string, check: (text: string) => unknown = () => undefined) =>
      (args: string[]): string => {
        if (args.length === 0) return list(this.profile[kind]);
        need(args, 2, usage);
        check(args.slice(1).join(" "));
        this.profile[kind][keyName(args[0])] = args.slice(1).join(" ");
        this.keep();
        return "";
      };
    const forget =
      (kind: keyof Profile, usage: string) =>
      (args: string[]): string => {
        need(args, 1, usage);
        delete this.profile[kind][keyName(args[0])];
        this.keep();
        return "";
      };
    return [
      command(
        "help [COMMAND]",
        "lists the commands",
        ([name]) => this.help(name),
        () => this.names(),
      ),
      command(
        "bind [KEY COMMAND]",
        "binds a key or mouse button to a command; without arguments lists the bindings",
        change("keys", "bind KEY COMMAND"),
        (index) => (index === 0 ? Object.keys(this.profile.keys) : this.names()),
      ),
      command("unbind KEY", "removes the binding of a key", forget("keys", "unbind KEY"), () =>
        Object.keys(this.profile.keys),
      ),
      command(
        "steer [KEY DIRECTION | KEY CHANNEL VALUE]",
        "drives while a key is held: ahead, back, left, right, or a channel; without arguments lists these keys",
        change("steering", "steer KEY ahead|back|left|right, or steer KEY CHANNEL VALUE", readSteer),
        (index) => (index === 0 ? Object.keys(this.profile.steering) : ["ahead", "back", "left", "right"]),
      ),
      command("unsteer KEY", "removes a driving key", forget("steering", "unsteer KEY"), () =>
        Object.keys(this.profile.steering),
      ),
      command(
        "alias [NAME COMMAND]",
        "defines another name for a command; without arguments lists the aliases",
        change("aliases", "alias NAME COMMAND"),
      ),
      command("unalias NAME", "removes an alias", forget("aliases", "unalias NAME"), () =>
        Object.keys(this.profile.aliases),
      ),
      command(
        "script [NAME COMMANDS]",
        "saves a script of commands separated by ';'",
        change("scripts", "script NAME COMMANDS"),
      ),
      command(
        "exec NAME",
        "runs a script",
        ([name]) => {
          const script = this.profile.scripts[name ?? ""];
          if (script === undefined) throw new Error(`there is no script '${name ?? ""}'`);
          return this.run(script, 1);
        },
        () => Object.keys(this.profile.scripts),
      ),
      command("wait SECONDS", "waits before the next command", async ([time]) => {
        const seconds = Number(time);
        if (!(seconds >= 0 && seconds <= 3600)) throw new Error("expected a time from 0 to 3600 seconds");
        await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
      }),
    ];
  }
}

const keyName = (word: string): string => (word === "Space" ? " " : word);

function checkedSteering(steering: Record<string, string>): Record<string, string> {
  for (const line of Object.values(steering)) readSteer(line);
  return steering;
}

function readProfile(text: string): Profile {
  const read = JSON.parse(text) as Partial<Record<keyof Profile, unknown>>;
  const strings = (value: unknown, name: string): Record<string, string> => {
    if (typeof value !== "object" || value === null || !Object.values(value).every((each) => typeof each === "string"))
      throw new Error(`not a profile: its ${name} are not strings`);
    return { ...(value as Record<string, string>) };
  };
  return {
    aliases: strings(read.aliases ?? {}, "aliases"),
    keys: strings(read.keys ?? defaultKeys, "keys"),
    scripts: strings(read.scripts ?? {}, "scripts"),
    steering: checkedSteering(strings(read.steering ?? defaultSteering, "steering keys")),
  };
}
