// SPDX-License-Identifier: Apache-2.0

// An ATmega328P that is reset by its watchdog every 128 ms, and sets PB0 after each start.

#include <avr/io.h>
#include <avr/wdt.h>

int main(void) {
  MCUSR = 0;
  DDRB = 1 << PB0;
  PORTB = 1 << PB0;
  wdt_enable(WDTO_120MS);
  for (;;) {
  }
}
