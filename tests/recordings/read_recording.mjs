// SPDX-License-Identifier: Apache-2.0

// Reads a recording with @mcap/core, by its index and from beginning to end. Checks every CRC, decodes messages by
// their schemas, and prints the contents as JSON.
import { readFileSync } from "node:fs";
import { open } from "node:fs/promises";
import { crc32 } from "@foxglove/crc";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";

const file = process.argv[2];
const decompressHandlers = {
  zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))),
};

const handle = await open(file);
const readable = {
  size: async () => BigInt((await handle.stat()).size),
  read: async (offset, length) => {
    const buffer = new Uint8Array(Number(length));
    const { bytesRead } = await handle.read(buffer, 0, buffer.length, Number(offset));
    if (bytesRead !== buffer.length) throw new Error(`${bytesRead} bytes, not ${length}, at ${offset}`);
    return buffer;
  },
};

const decoders = new Map();
function decode(channel, schema, data) {
  if (schema?.encoding !== "ros2msg") return new TextDecoder().decode(data);
  if (!decoders.has(channel.id)) {
    const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
    decoders.set(channel.id, new MessageReader(definitions));
  }
  const decoder = decoders.get(channel.id);
  const message = decoder.readMessage(data);
  if (decoder.lastReadHadTrailingBytes()) throw new Error(`bytes left in a message of ${channel.topic}`);
  return message;
}

const found = { messages: [], attachments: [], metadata: [] };
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
found.header = { profile: reader.header.profile, library: reader.header.library };
found.statistics = { ...reader.statistics, channelMessageCounts: [...reader.statistics.channelMessageCounts] };
found.schemas = [...reader.schemasById.values()].map(({ id, name, encoding }) => ({ id, name, encoding }));
found.channels = [...reader.channelsById.values()].map((channel) => ({ ...channel, metadata: [...channel.metadata] }));
found.summary_offsets = [...reader.summaryOffsetsByOpcode.keys()].sort((a, b) => a - b);
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  found.messages.push({
    topic: channel.topic,
    sequence: message.sequence,
    log_time: message.logTime,
    publish_time: message.publishTime,
    message: decode(channel, schema, message.data),
  });
}
for await (const { name, mediaType, data } of reader.readAttachments({ validateCrcs: true }))
  found.attachments.push({ name, media_type: mediaType, size: data.length });
for await (const { name, metadata } of reader.readMetadata()) found.metadata.push({ name, entries: [...metadata] });

// Reads from beginning to end, without the index, and checks the CRC of all data, which the reader does not check.
const bytes = readFileSync(file);
const stream = new McapStreamReader({ decompressHandlers, includeChunks: true, validateCrcs: true });
stream.append(bytes);
found.records = {};
for (let record = stream.nextRecord(); record; record = stream.nextRecord()) {
  found.records[record.type] = (found.records[record.type] ?? 0) + 1;
  if (record.type === "DataEnd") {
    found.data_crc_is_right = record.dataSectionCrc === crc32(bytes.subarray(0, Number(reader.dataEndOffset)));
  }
}
found.is_read_to_its_end = stream.done() && stream.bytesRemaining() === 0;
await handle.close();

console.log(
  JSON.stringify(found, (_, value) => {
    if (typeof value === "bigint") return Number(value);
    return ArrayBuffer.isView(value) ? Array.from(value) : value;
  }),
);
