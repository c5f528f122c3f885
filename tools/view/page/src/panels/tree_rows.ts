// SPDX-License-Identifier: Apache-2.0
import { none, type Scene, type SceneModel } from "../data/messages";

/** A row of the tree: a group of entities, an entity, or a part of one. */
export interface Row {
  key: string; // identifies the row in later scenes
  text: string;
  detail: string;
  level: number; // from 1
  entities: readonly number[];
  hasChildren: boolean;
}

interface Group {
  key: string;
  text: string;
  detail: string;
  entities: number[];
}

const partsOf = (model: SceneModel): readonly (readonly [string, string])[] => {
  const links = model.links.map(({ name }) => [name, "link"] as const);
  const sensors = model.sensors.map(({ name, kind }) => [name, kind.replaceAll("_", " ")] as const);
  const actuators = new Set(model.command.map(({ name }) => name.slice(0, name.lastIndexOf("/"))));
  return [
    ...links,
    ...sensors,
    ...[...actuators].filter((name) => name !== "").map((name) => [name, "actuator"] as const),
  ];
};

// Returns teams in the order of their first robots, then movable objects, then static ones.
function groupsOf(scene: Scene): Group[] {
  const groups = new Map<string, Group>();
  scene.entities.forEach(({ robot, team, model }, entity) => {
    const [key, text, detail] =
      robot !== none
        ? [`team ${team}`, team || "robots", "team"]
        : scene.models[model].is_static
          ? ["fixed", "fixed objects", ""]
          : ["movable", "movable objects", ""];
    const group = groups.get(key) ?? { key, text, detail, entities: [] };
    group.entities.push(entity);
    groups.set(key, group);
  });
  const rank = ({ key }: Group): number => (key.startsWith("team ") ? 0 : key === "movable" ? 1 : 2);
  return [...groups.values()].sort((a, b) => rank(a) - rank(b));
}

/**
 * Returns the rows to show: those of open parents or, if `wanted` is not empty, the entities whose name or kind
 * contains it, with their groups.
 */
export function rowsOf(scene: Scene, open: ReadonlySet<string>, wanted: string): Row[] {
  const rows: Row[] = [];
  const text = wanted.trim().toLowerCase();
  for (const group of groupsOf(scene)) {
    const matches = (entity: number): boolean => {
      const { name, model } = scene.entities[entity];
      return text === "" || name.toLowerCase().includes(text) || scene.models[model].name.toLowerCase().includes(text);
    };
    const entities = group.entities.filter(matches);
    if (entities.length === 0) continue;
    const count = `${entities.length}`;
    rows.push({ ...group, entities, level: 1, detail: `${group.detail} ${count}`.trim(), hasChildren: true });
    if (text === "" && !open.has(group.key)) continue;
    for (const entity of entities) rows.push(...rowsOfEntity(scene, entity, open));
  }
  return rows;
}

function rowsOfEntity(scene: Scene, entity: number, open: ReadonlySet<string>): Row[] {
  const { name, model: index, team } = scene.entities[entity];
  const model = scene.models[index];
  const key = `entity ${name}`;
  const parts = partsOf(model);
  const short = team !== "" && name.startsWith(`${team}/`) ? name.slice(team.length + 1) : name;
  const row = { key, text: short, detail: model.name, level: 2, entities: [entity], hasChildren: parts.length > 1 };
  if (!open.has(key)) return [row];
  const children = parts.map(([text, detail], i) => ({
    key: `${key} ${i}`,
    text,
    detail,
    level: 3,
    entities: [entity],
    hasChildren: false,
  }));
  return [row, ...children];
}
