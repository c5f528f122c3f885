// SPDX-License-Identifier: Apache-2.0
import { Plane, Quaternion, Raycaster, Sphere, Vector2, Vector3 } from "three";
import { Chosen } from "./chosen";
import {
  none,
  type Scene,
  type SceneContacts,
  type SceneFrame,
  type SceneRobot,
  type SceneSignals,
  seconds,
} from "./data/messages";
import { fixed } from "./data/numbers";
import { element } from "./element";
import { GroupPanel } from "./panels/group";
import { Inspector } from "./panels/inspector";
import { Bounds } from "./picture/bounds";
import { Cameras } from "./picture/cameras";
import { ContactShadows } from "./picture/contact_shadows";
import { unionOf } from "./picture/framing";
import { Gizmo } from "./picture/gizmo";
import { Glow } from "./picture/glow";
import { Instances } from "./picture/instances";
import { Labels } from "./picture/labels";
import { type LegendEntry, legendOf, showLegend } from "./picture/legend";
import { Contacts, Rays, Trails } from "./picture/overlays";
import { Poses } from "./picture/poses";
import { levels } from "./picture/quality";
import { withRoleColors } from "./picture/role_colors";
import { Outline, pick } from "./picture/selection";
import { Sound } from "./picture/sound";
import { Stage } from "./picture/stage";
import { Stillness } from "./picture/stillness";
import { Textures } from "./picture/textures";

export type Layer = "labels" | "contacts" | "rays" | "trails" | "shadows" | "sound" | "collisions";

const mostTold = 5; // selected entities
const manyEntities = 1500; // above this number, shadows are off unless requested
const boundsShare = 12; // minimum interval between searches of bounds, as a multiple of a search's duration

/** The picture and sound of the world. */
export class Viewer {
  readonly stage: Stage;
  readonly cameras: Cameras;
  readonly layers = new Set<Layer>(["rays", "shadows"]);
  readonly sound = new Sound();
  readonly stillness = new Stillness();
  readonly inspector: Inspector;
  poses: Poses | undefined;
  readonly chosen = new Chosen(
    () => this.showSelection(),
    () => this.hideEntities(),
  );
  signals: SceneSignals | undefined;
  framesDrawn = 0;
  /** True if bounds are computed for each picture, regardless of the time this takes, such as for a film. */
  isExact = false;
  /** Called when the page itself switches a layer. */
  onLayers: () => void = () => undefined;

  /** The images of the scene. */
  textures: Textures | undefined;
  private instances: Instances | undefined;
  private glow: Glow | undefined;
  private robots: readonly SceneRobot[] = []; // the selected ones
  private readonly group = new GroupPanel();
  private readonly outline = new Outline();
  private readonly contacts = new Contacts();
  private readonly rays = new Rays();
  private readonly trails = new Trails();
  private readonly labels = new Labels(element("labels"));
  private readonly gizmo: Gizmo;
  private bounds: Bounds | undefined;
  private contactShadows: ContactShadows | undefined;
  private areShadowsByHand = false;
  private areBoundsStale = false;
  private nextBounds = 0; // [ms]
  private lastAspect = 0;
  private lastDrawn = performance.now();
  private lastPicture: number | undefined; // [ms] of the page's clock; undefined if the page was hidden since
  private world = "";

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly onSelect: (robots: number[]) => void,
  ) {
    this.stage = new Stage(canvas);
    this.cameras = new Cameras(this.stage.camera, canvas);
    this.inspector = new Inspector(() => this.chosen.select(undefined));
    this.stage.add(this.outline.group, this.contacts.group, this.rays.group, this.trails.group);
    this.contacts.group.visible = false;
    this.gizmo = new Gizmo(canvas);
    document.addEventListener("visibilitychange", () => {
      this.lastPicture = undefined;
      this.stage.quality.forget();
    });
  }

  // Data from the server.

  show(sent: Scene): void {
    const scene = withRoleColors(sent);
    const followed = this.cameras.followedEntity !== undefined ? this.cameras.mode : undefined;
    if (this.glow) this.stage.remove(this.glow.group);
    this.poses = new Poses(scene);
    this.textures?.dispose();
    this.textures = new Textures(scene);
    this.glow = new Glow(this.poses);
    this.glow.wear(this.stage.theme === "dark");
    this.stage.lay(scene);
    this.build(this.poses, this.textures);
    this.stage.add(this.glow.group);
    this.trails.clear();
    const again = this.chosen.moveTo(scene);
    if (followed) this.cameras.choose(again >= 0 ? followed : "orbit", again);
    if (scene.world !== this.world) this.switchShadows();
    this.apply();
  }

  take(frame: SceneFrame): void {
    const before = this.poses?.frame;
    const isFirst = this.poses !== undefined && before === undefined;
    if (!this.poses?.take(frame, performance.now())) return;
    if (before && (frame.run !== before.run || frame.tick < before.tick)) this.trails.clear();
    this.instances?.update();
    this.areBoundsStale = true;
    if (isFirst && this.signals) this.glow?.take(this.signals);
    if (isFirst && this.poses.scene.world !== this.world) {
      this.world = this.poses.scene.world;
      this.home();
    }
    if (this.layers.has("trails"))
      this.trails.add(this.poses, this.chosen.selection.size === 0 ? this.robotEntities() : [...this.chosen.selection]);
  }

  takeSignals(signals: SceneSignals): void {
    this.signals = signals;
    if (this.poses?.frame) this.glow?.take(signals);
    this.sound.take(signals);
  }

  takeContacts(contacts: SceneContacts): void {
    if (contacts.revision === this.poses?.scene.revision) this.contacts.take(contacts);
  }

  takeRobots(robots: readonly SceneRobot[]): void {
    const ids = this.chosen.robots();
    this.robots = robots.filter(({ robot }) => ids.has(robot));
    if (this.robot) this.inspector.take(this.robot);
    this.group.take(this.robots);
  }

  // User input.

  private showSelection(): void {
    const entities = [...this.chosen.selection];
    this.robots = [];
    this.outline.select(entities, this.poses, this.instances);
    const isOne = entities.length === 1;
    const only = isOne ? this.chosen.selectedEntity : undefined;
    this.inspector.select(only, only && this.poses?.scene.models[only.model]);
    this.group.select(isOne ? [] : entities, this.poses);
    this.showLegend();
    this.onSelect([...this.chosen.robots()]);
  }
  private hideEntities(): void {
    this.poses?.hide(this.chosen.hidden);
    this.instances?.update();
  }
  // The state of the robot that was selected last.
  private get robot(): SceneRobot | undefined {
    const id = this.chosen.selectedEntity?.robot ?? none;
    return id === none ? undefined : this.robots.find(({ robot }) => robot === id);
  }

  follow(): void {
    if (this.chosen.selected !== undefined)
      this.cameras.choose("follow", this.chosen.selected, [...this.chosen.selection]);
  }

  pickAt(x: number, y: number): number | undefined {
    if (!this.poses?.frame || !this.instances) return undefined;
    return pick(this.poses, this.instances, this.stage.camera, this.inPicture(x, y));
  }

  /**
   * Returns the x and y in the world [m] that the picture shows at a point of the page, at this height [m]. Returns
   * undefined above the horizon.
   */
  placeAt(x: number, y: number, height: number): [number, number] | undefined {
    const raycaster = new Raycaster();
    raycaster.setFromCamera(this.inPicture(x, y), this.stage.camera);
    const at = raycaster.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -height), new Vector3());
    return at ? [at.x, at.y] : undefined;
  }

  // Converts a point of the page to the picture: from -1 at its left and lower edges to 1.
  private inPicture(x: number, y: number): Vector2 {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height);
  }

  find(name: string): number | undefined {
    const { entities } = this.poses?.scene ?? { entities: [] };
    const exact = entities.findIndex((each) => each.name === name || String(each.robot) === name);
    const found = exact >= 0 ? exact : entities.findIndex((each) => each.name.endsWith(name));
    return found >= 0 ? found : undefined;
  }

  /** Shows all bodies, and keeps them in the picture until the user moves the camera. */
  home(): void {
    if (this.poses?.frame && this.bounds) this.cameras.home(this.bounds.boxes());
  }

  /** Returns the colours of the picture and their meanings. */
  legend(): LegendEntry[] {
    if (!this.poses) return [];
    const rays =
      this.layers.has("rays") && this.chosen.selectedEntity !== undefined && this.chosen.selectedEntity.robot !== none;
    return legendOf(this.poses.scene, { rays, contacts: this.layers.has("contacts") });
  }

  private showLegend(): void {
    const panel = document.getElementById("legend");
    if (panel) showLegend(panel, this.legend());
  }

  /** Returns a description of the picture in a few sentences. */
  describe(): string {
    const { poses } = this;
    if (!poses?.frame) return "There is no world yet.";
    const { scene, frame, absent } = poses;
    const counts = new Map<string, number>();
    scene.entities.forEach(({ robot, team, model }, entity) => {
      if (absent.has(entity) || (robot === none && scene.models[model].is_static)) return;
      const kind = robot === none ? "movable objects" : `robots${team ? ` of team ${team}` : ""}`;
      counts.set(kind, (counts.get(kind) ?? 0) + 1);
    });
    const what = [...counts].map(([kind, count]) => `${count} ${kind}`).join(", ") || "nothing that can move";
    const chosen = [...this.chosen.selection].slice(0, mostTold).map((entity) => {
      const { position, heading } = this.poseOf(entity);
      const [x, y] = position.map((each) => fixed(each, 2));
      return `${scene.entities[entity].name} at x ${x} m, y ${y} m, heading ${fixed((180 * heading) / Math.PI, 0)} degrees`;
    });
    const selected = chosen.length > 0 ? ` Selected: ${chosen.join("; ")}.` : "";
    return `At ${fixed(seconds(frame.time_ns), 1)} s: ${what}. Camera: ${this.cameras.mode}.${selected}`;
  }

  toggle(layer: Layer): boolean {
    const isOn = !this.layers.has(layer);
    if (isOn) this.layers.add(layer);
    else this.layers.delete(layer);
    if (layer === "shadows") this.areShadowsByHand = true;
    this.apply(layer);
    return isOn;
  }

  wear(theme: "light" | "dark"): void {
    document.documentElement.dataset.theme = theme;
    this.stage.wear(theme);
    this.glow?.wear(theme === "dark");
    this.contactShadows?.wear(theme === "dark");
  }

  robotEntities(): number[] {
    return this.poses ? this.poses.scene.entities.flatMap(({ robot }, entity) => (robot === none ? [] : [entity])) : [];
  }

  poseOf(entity: number): { position: number[]; heading: number } {
    if (!this.poses) throw new Error("there is no scene yet");
    const position = new Vector3();
    const turn = new Quaternion();
    this.poses.read(this.poses.placeOf(entity), position, turn);
    const forward = new Vector3(1, 0, 0).applyQuaternion(turn);
    return { position: position.toArray(), heading: Math.atan2(forward.y, forward.x) };
  }

  /** Draws a picture, but only a few times a second while nothing moves. */
  drawIfDue(now: number): void {
    if (this.stillness.isDue(now, this.lastDrawn, this.poses)) this.draw(now);
    else this.lastPicture = undefined; // the time to the next picture is not the speed of drawing
  }

  draw(now: number): void {
    const elapsed = Math.min(1, Math.max(0, now - this.lastDrawn) / 1000);
    this.lastDrawn = now;
    const { poses, stage } = this;
    const clock = performance.now();
    this.adapt(this.lastPicture === undefined ? 0 : clock - this.lastPicture);
    this.lastPicture = clock;
    if (poses?.frame) {
      if (poses.blend < 1 || this.areBoundsStale) stage.isShadowStale = true;
      poses.advance(now);
      this.instances?.draw();
      this.glow?.draw(this.canvas.height);
      this.outline.draw(poses);
      this.rays.draw(poses, this.layers.has("rays") ? this.robot : undefined);
      this.sound.draw(poses, stage.camera);
      this.showPose();
    }
    this.findBounds();
    this.cameras.advance(poses, elapsed);
    stage.draw(this.cameras.target);
    this.gizmo.draw(stage.camera, this.cameras.target);
    const named = this.layers.has("labels") ? this.robotEntities() : [...this.chosen.selection];
    this.labels.draw(
      poses?.frame ? poses : undefined,
      named,
      stage.camera,
      this.canvas.clientWidth,
      this.canvas.clientHeight,
      this.chosen.selected,
    );
    ++this.framesDrawn;
    this.stillness.take(poses, stage.camera);
  }

  /** Draws at full resolution, such as for a screenshot. */
  drawFinely(): void {
    this.draw(performance.now());
    this.stage.drawFinely(this.cameras.target);
  }

  private showPose(): void {
    if (this.chosen.selection.size > 1) this.group.showPoses(this.poses);
    if (this.chosen.selection.size !== 1 || this.chosen.selected === undefined) return;
    const { position, heading } = this.poseOf(this.chosen.selected);
    const [x, y, z] = position.map((each) => fixed(each, 3));
    this.inspector.showPose(`x ${x}  y ${y}  z ${z} m · ${fixed((180 * heading) / Math.PI, 0)}°`);
  }

  private build(poses: Poses, textures: Textures): void {
    for (const each of [this.instances, this.contactShadows]) {
      if (each) this.stage.remove(each.group);
      each?.dispose();
    }
    this.instances = new Instances(poses, textures, this.layers.has("collisions") ? "collision" : "visual");
    this.bounds = new Bounds(poses, this.instances);
    this.stage.add(this.instances.group);
    this.contactShadows = undefined;
    const height = this.stage.groundHeight;
    if (height !== undefined) {
      this.contactShadows = new ContactShadows(poses, this.instances, height);
      this.contactShadows.wear(this.stage.theme === "dark");
      this.stage.add(this.contactShadows.group);
    }
    if (poses.frame) this.instances.update();
    this.areBoundsStale = true;
  }

  // Computes the bounds of everything, for the camera that keeps them in the picture, and for shadows.
  private findBounds(): void {
    const begin = performance.now();
    const { aspect } = this.stage.camera;
    const isDue = this.areBoundsStale || aspect !== this.lastAspect;
    if (!isDue || (!this.isExact && begin < this.nextBounds) || !this.bounds || !this.poses?.frame) return;
    this.areBoundsStale = false;
    this.lastAspect = aspect;
    const boxes = this.bounds.boxes();
    this.stage.surroundings = unionOf(this.bounds.all).getBoundingSphere(new Sphere());
    if (boxes.length > 0) this.cameras.watch(boxes);
    this.nextBounds = performance.now() + boundsShare * (performance.now() - begin);
  }

  /** Adapts the quality to the time since the previous picture [ms]. */
  adapt(elapsed: number): void {
    if (!this.stage.adapt(elapsed)) return;
    this.switchShadows();
    this.stage.cast(this.layers.has("shadows"));
    this.onLayers();
  }

  // The page decides, unless the user has chosen.
  private switchShadows(): void {
    if (this.areShadowsByHand || !this.poses) return;
    const isOn = this.poses.scene.entities.length <= manyEntities && levels[this.stage.quality.level].shadows;
    if (isOn) this.layers.add("shadows");
    else this.layers.delete("shadows");
  }

  private apply(changed?: Layer): void {
    this.stage.cast(this.layers.has("shadows"));
    this.contacts.group.visible = this.layers.has("contacts");
    this.showLegend();
    this.sound.switch(this.layers.has("sound"));
    if (!this.layers.has("trails")) this.trails.clear();
    if (changed === "collisions" && this.poses && this.instances && this.textures) {
      this.build(this.poses, this.textures);
      this.outline.select([...this.chosen.selection], this.poses, this.instances);
    }
  }
}
