// SPDX-License-Identifier: Apache-2.0
import { type Packed, readMessages, readTable, type Table } from "./packed";

/** Messages of a frame by topic, packed as CDR. */
export type Frame = ReadonlyMap<string, Uint8Array>;

const mostChunks = 4; // number of unpacked chunks to keep

/** The frames of the recording that a document contains. A frame is unpacked when it is requested. */
export class RecordedFrames {
  /** Log times [ns] and ticks of all frames. */
  readonly times: number[] = [];
  readonly ticks: number[] = [];
  private readonly chunkOfFrame: number[] = [];
  private readonly firstOfChunk: number[] = [];
  private readonly chunks = new Map<number, Promise<Frame[]>>(); // in the order of the last request

  private constructor(
    private readonly blocks: readonly HTMLElement[],
    readonly table: Table,
  ) {
    table.chunks.forEach(({ times, ticks }, chunk) => {
      this.firstOfChunk.push(this.times.length);
      for (const [i, time] of times.entries()) {
        this.times.push(time);
        this.ticks.push(ticks[i]);
        this.chunkOfFrame.push(chunk);
      }
    });
  }

  static async read(blocks: readonly HTMLElement[]): Promise<RecordedFrames> {
    const table = await readTable(blocks);
    if (table.version !== 1) throw new Error(`this page cannot read data of version ${table.version}`);
    return new RecordedFrames(blocks, table);
  }

  /** Returns the first frame that is not before a log time [ns], or the last frame. */
  notBefore(time: number): number {
    return Math.min(lowerBound(this.times, time), this.times.length - 1);
  }
  /** Returns the last frame that is not after a log time [ns], or the first frame. */
  notAfter(time: number): number {
    return Math.max(0, lowerBound(this.times, time + 1) - 1);
  }
  /** Returns the block of the scene that a frame belongs to. */
  sceneOf(frame: number): number {
    return this.table.chunks[this.chunkOfFrame[frame]].scene;
  }

  async frame(index: number): Promise<Frame> {
    const chunk = this.chunkOfFrame[index];
    const frames = await this.chunk(chunk);
    if (chunk + 1 < this.table.chunks.length) void this.chunk(chunk + 1).catch(() => undefined);
    return frames[index - this.firstOfChunk[chunk]];
  }

  /** Returns the only message of a block. */
  async single(block: number): Promise<Uint8Array> {
    return (await readMessages(this.blocks[block]))[0].data;
  }
  schemaOf(topic: string): string {
    return this.table.topics.find(({ name }) => name === topic)?.schema ?? "";
  }

  private chunk(index: number): Promise<Frame[]> {
    const known = this.chunks.get(index);
    this.chunks.delete(index);
    const frames = known ?? readMessages(this.blocks[this.table.chunks[index].block]).then((all) => this.split(all));
    this.chunks.set(index, frames);
    const [oldest] = this.chunks.keys();
    if (this.chunks.size > mostChunks) this.chunks.delete(oldest);
    return frames;
  }

  // A frame begins with its poses; signals hold until they change.
  private split(messages: readonly Packed[]): Frame[] {
    const frames: Map<string, Uint8Array>[] = [];
    let signals: Uint8Array | undefined;
    for (const { topic, data } of messages) {
      const { name } = this.table.topics[topic];
      if (name === "/cohort/frame") frames.push(new Map(signals && [["/cohort/signals", signals]]));
      frames[frames.length - 1].set(name, data);
      if (name === "/cohort/signals") signals = data;
    }
    return frames;
  }
}

function lowerBound(sorted: readonly number[], value: number): number {
  let [low, high] = [0, sorted.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}
