// SPDX-License-Identifier: Apache-2.0

// An ATmega328P that drives both motors of worlds/robots/two_wheeler, and after 0.5 s does what FAULT says.

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <util/delay.h>

int main(void) {
  MCUSR = 0;
  wdt_disable();
  DDRD = 1 << PD5 | 1 << PD6 | 1 << PD7;
  DDRB = 1 << PB4;
  PORTD = 1 << PD5 | 1 << PD6 | 1 << PD7;
  PORTB = 1 << PB4;
  _delay_ms(500);
#if FAULT == 1  // no instruction
  __asm__ volatile(".word 0x0001");
#elif FAULT == 2  // no memory
  *(volatile unsigned char*)0x7000 = 1;
#elif FAULT == 3  // beyond the flash memory
  __asm__ volatile("ldi r30, 0xff\n ldi r31, 0x7f\n ijmp");
#elif FAULT == 4  // the watchdog
  wdt_enable(WDTO_120MS);
#elif FAULT == 5  // for ever
  cli();
  sleep_enable();
  sleep_cpu();
#elif FAULT == 6  // until the watchdog comes
  wdt_enable(WDTO_120MS);
  cli();
  sleep_enable();
  sleep_cpu();
#endif
  for (;;) {
  }
}
