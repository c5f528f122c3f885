// SPDX-License-Identifier: Apache-2.0
import type { Connection, Handlers } from "./connection";
import { FileConnection } from "./file_connection";
import { blocksOf } from "./packed";
import { ServerConnection } from "./server_connection";

/** Returns the recording that the document contains, or else a connection to the server of this address. */
export function connect(url: string, handlers: Handlers, changed: (isConnected: boolean) => void): Connection {
  const blocks = blocksOf(document);
  return blocks.length > 0
    ? new FileConnection(blocks, handlers, changed)
    : new ServerConnection(url, handlers, changed);
}
