// SPDX-License-Identifier: Apache-2.0

// Unpacks the data of a page that contains a recording, which tools/view/html/ has packed.

export interface Packed {
  topic: number; // index in the page's table
  data: Uint8Array;
}

/** Table of the recording: its last block, as JSON. */
export interface Table {
  version: number;
  name: string;
  seed: string;
  note: string;
  events: number; // index of their block
  contacts: boolean;
  robots: number[]; // ids of the robots whose channels the file contains
  topics: { name: string; schema: string }[];
  chunks: { block: number; scene: number; times: number[]; ticks: number[] }[]; // times [ns]
}

const blockSelector = 'script[type="application/x-cohort"]';

/** Returns the blocks of this document; none for the page of a server. */
export const blocksOf = (page: Document): HTMLElement[] => [...page.querySelectorAll<HTMLElement>(blockSelector)];

async function inflated(block: HTMLElement): Promise<ArrayBuffer> {
  const bytes = Uint8Array.from(atob(block.textContent ?? ""), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

export async function readTable(blocks: readonly HTMLElement[]): Promise<Table> {
  return JSON.parse(new TextDecoder().decode(await inflated(blocks[blocks.length - 1]))) as Table;
}

const bytesOf = (numbers: number): number => 4 * numbers;

/** Returns the messages of a block in their order. message_block.hpp describes how they are packed. */
export async function readMessages(block: HTMLElement): Promise<Packed[]> {
  const buffer = await inflated(block);
  const numbers = new DataView(buffer);
  const count = numbers.getUint32(0, true);
  const messages: Packed[] = [];
  const series = new Map<string, Uint32Array[]>();
  for (let i = 0; i < count; ++i) {
    const [topic, size] = [1, 2].map((number) => numbers.getUint32(bytesOf(2 * i + number), true));
    const words = new Uint32Array(Math.ceil(size / 4));
    messages.push({ topic, data: new Uint8Array(words.buffer, 0, size) });
    const key = `${topic} ${size}`;
    const known = series.get(key);
    if (known) known.push(words);
    else series.set(key, [words]);
  }
  let at = bytesOf(1 + 2 * count);
  for (const each of series.values()) {
    fill(each, new Uint8Array(buffer, at + bytesOf(1)), numbers.getUint32(at, true) === 1);
    at += bytesOf(1 + each.length * each[0].length);
  }
  return messages;
}

function fill(series: readonly Uint32Array[], bytes: Uint8Array, hasDifferences: boolean): void {
  const [columns, rows] = [series.length, series[0].length];
  const size = columns * rows;
  let at = 0;
  for (let row = 0; row < rows; ++row) {
    let left = 0;
    for (let column = 0; column < columns; ++column, ++at) {
      const entry = bytes[at] | (bytes[at + size] << 8) | (bytes[at + 2 * size] << 16) | (bytes[at + 3 * size] << 24);
      left = hasDifferences ? (left + ((entry >>> 1) ^ -(entry & 1))) | 0 : entry;
      series[column][row] = left;
    }
  }
}
