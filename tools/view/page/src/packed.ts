// Unpacks the data of a page that contains a recording. tools/view/html/ packs it.

export interface Packed {
  topic: number; // index in the page's table
  data: Uint8Array;
}

/** Table of the recording: its last block, as JSON. */
export interface Table {
  version: number;
  name: string;
  note: string;
  events: number; // block
  contacts: boolean;
  robots: number[]; // ids of those that have channels
  topics: { name: string; schema: string }[];
  chunks: { block: number; scene: number; times: number[]; ticks: number[] }[]; // times [ns]
}

const blockSelector = 'script[type="application/x-cohort"]';

/** Returns the blocks of this document; there are none in the page of a server. */
export const blocksOf = (page: Document): HTMLElement[] => [...page.querySelectorAll<HTMLElement>(blockSelector)];

async function inflated(block: HTMLElement): Promise<ArrayBuffer> {
  const bytes = Uint8Array.from(atob(block.textContent ?? ""), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

export async function readTable(blocks: readonly HTMLElement[]): Promise<Table> {
  return JSON.parse(new TextDecoder().decode(await inflated(blocks[blocks.length - 1]))) as Table;
}

/** Returns the messages of a block in their order. message_block.hpp describes how they are packed. */
export async function readMessages(block: HTMLElement): Promise<Packed[]> {
  const buffer = await inflated(block);
  const view = new DataView(buffer);
  const bytes = new Uint8Array(buffer);
  const last = new Map<number, Uint32Array>();
  const messages: Packed[] = [];
  for (let at = 0; at < buffer.byteLength; ) {
    const topic = view.getUint32(at, true);
    const size = view.getUint32(at + 4, true);
    const count = Math.ceil(size / 4);
    const words = new Uint32Array(count);
    const before = last.get(topic);
    const isDifference = before?.length === count;
    const [a, b, c, d] = [0, 1, 2, 3].map((byte) => at + 8 + byte * count);
    for (let i = 0; i < count; ++i) {
      const folded = bytes[a + i] | (bytes[b + i] << 8) | (bytes[c + i] << 16) | (bytes[d + i] << 24);
      words[i] = ((folded >>> 1) ^ -(folded & 1)) + (isDifference ? before[i] : 0);
    }
    last.set(topic, words);
    messages.push({ topic, data: new Uint8Array(words.buffer, 0, size) });
    at += 8 + 4 * count;
  }
  return messages;
}
