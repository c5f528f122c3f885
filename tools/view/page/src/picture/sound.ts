// SPDX-License-Identifier: Apache-2.0
import { type Camera, Quaternion, Vector3 } from "three";
import type { SceneSignals } from "../data/messages";
import type { Poses } from "./poses";

const mostVoices = 24;

interface Voice {
  oscillator: OscillatorNode;
  gain: GainNode;
  panner: PannerNode;
}

/** Plays the loudspeakers at their places, each with its frequency. Silent until the user switches it on. */
export class Sound {
  private context: AudioContext | undefined;
  private readonly voices = new Map<number, Voice>();
  private signals: SceneSignals | undefined;

  get isOn(): boolean {
    return this.context !== undefined;
  }
  get sounding(): number {
    return this.voices.size;
  }

  switch(on: boolean): void {
    if (on === this.isOn) return;
    if (on) {
      this.context = new AudioContext();
      return;
    }
    this.silenceAll();
    void this.context?.close();
    this.context = undefined;
  }

  take(signals: SceneSignals): void {
    if (signals.revision !== this.signals?.revision) this.silenceAll(); // it has other loudspeakers
    this.signals = signals;
  }

  draw(poses: Poses, camera: Camera): void {
    const { context, signals } = this;
    if (!context || !signals || signals.revision !== poses.scene.revision) return;
    hearFrom(context.listener, camera);
    const at = new Vector3();
    const turn = new Quaternion();
    poses.scene.tones.forEach((tone, i) => {
      const [frequency, intensity] = signals.tones.subarray(2 * i, 2 * i + 2);
      if (!(intensity > 0 && frequency > 0)) {
        this.silence(i);
        return;
      }
      poses.read(tone.link, at, turn);
      at.add(new Vector3().fromArray(tone.position).applyQuaternion(turn));
      const voice =
        this.voices.get(i) ?? (this.voices.size < mostVoices ? this.begin(i, context, frequency, at) : undefined);
      if (!voice) return;
      const now = context.currentTime + 0.03;
      voice.oscillator.frequency.linearRampToValueAtTime(frequency, now);
      voice.gain.gain.linearRampToValueAtTime(0.15 * Math.min(1, intensity), now);
      voice.panner.positionX.linearRampToValueAtTime(at.x, now);
      voice.panner.positionY.linearRampToValueAtTime(at.y, now);
      voice.panner.positionZ.linearRampToValueAtTime(at.z, now);
    });
  }

  private begin(tone: number, context: AudioContext, frequency: number, { x, y, z }: Vector3): Voice {
    const oscillator = new OscillatorNode(context, { type: "triangle", frequency });
    const gain = new GainNode(context, { gain: 0 });
    const panner = new PannerNode(context, {
      panningModel: "equalpower",
      distanceModel: "inverse",
      refDistance: 0.5,
      positionX: x,
      positionY: y,
      positionZ: z,
    });
    oscillator.connect(gain).connect(panner).connect(context.destination);
    oscillator.start();
    const voice = { oscillator, gain, panner };
    this.voices.set(tone, voice);
    return voice;
  }

  private silenceAll(): void {
    for (const tone of [...this.voices.keys()]) this.silence(tone);
  }

  private silence(tone: number): void {
    const voice = this.voices.get(tone);
    if (!voice) return;
    voice.oscillator.stop();
    voice.panner.disconnect();
    this.voices.delete(tone);
  }
}

function hearFrom(listener: AudioListener, camera: Camera): void {
  const forward = new Vector3(0, 0, -1).applyQuaternion(camera.quaternion);
  const up = new Vector3(0, 1, 0).applyQuaternion(camera.quaternion);
  const { position } = camera;
  for (const [node, value] of [
    [listener.positionX, position.x],
    [listener.positionY, position.y],
    [listener.positionZ, position.z],
    [listener.forwardX, forward.x],
    [listener.forwardY, forward.y],
    [listener.forwardZ, forward.z],
    [listener.upX, up.x],
    [listener.upY, up.y],
    [listener.upZ, up.z],
  ] as const)
    node.value = value;
}
