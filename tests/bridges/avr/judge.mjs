// SPDX-License-Identifier: Apache-2.0

// Runs an image in Intel HEX on avr8js, and writes the outputs of its pins and its serial interface as JSON. Edges of
// port B are [cycle, levels]; bytes are [cycle, byte]. Arguments: the file, atmega328p or atmega2560, number of cycles.

import { readFileSync } from "node:fs";
import {
  AVRIOPort,
  AVRTimer,
  AVRUSART,
  avrInstruction,
  CPU,
  portBConfig,
  timer0Config,
  timer1Config,
  timer2Config,
  usart0Config,
} from "avr8js";

const [file, mcu, cycles] = process.argv.slice(2);
const program = new Uint8Array(mcu === "atmega2560" ? 0x40000 : 0x8000).fill(0xff);
for (const line of readFileSync(file, "utf8").split("\n")) {
  if (line.slice(7, 9) !== "00") continue;
  const count = Number.parseInt(line.slice(1, 3), 16);
  const address = Number.parseInt(line.slice(3, 7), 16);
  for (let i = 0; i < count; i++) program[address + i] = Number.parseInt(line.slice(9 + 2 * i, 11 + 2 * i), 16);
}

// It begins memory at 0x100, where an ATmega2560 still has registers.
const cpu = new CPU(new Uint16Array(program.buffer), mcu === "atmega2560" ? 8192 + 256 : 2048);
const port = new AVRIOPort(cpu, portBConfig);
// The interrupt vectors that the image uses are elsewhere on an ATmega2560.
const vectors =
  mcu === "atmega2560" ? [{ ovfInterrupt: 0x2e }, { compAInterrupt: 0x22 }, { compAInterrupt: 0x1a }] : [{}, {}, {}];
for (const [i, config] of [timer0Config, timer1Config, timer2Config].entries())
  new AVRTimer(cpu, { ...config, ...vectors[i] });
const serial = new AVRUSART(cpu, usart0Config, 16e6);
const found = { edges: [], bytes: [] };
port.addListener((levels) => found.edges.push([cpu.cycles, levels]));
serial.onByteTransmit = (byte) => found.bytes.push([cpu.cycles, byte]);
while (cpu.cycles < Number(cycles)) {
  avrInstruction(cpu);
  cpu.tick();
}
console.log(JSON.stringify(found));
