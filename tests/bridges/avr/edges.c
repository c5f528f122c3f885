// SPDX-License-Identifier: Apache-2.0

// Outputs on which two simulators of an ATmega328P have to agree, cycle by cycle. These are edges of pins by software,
// in loops and in timer interrupts, and bytes of the serial interface.

#include <avr/interrupt.h>
#include <avr/io.h>
#include <stdint.h>

ISR(TIMER0_OVF_vect) { PINB = 1 << PB0; }
ISR(TIMER1_COMPA_vect) { PINB = 1 << PB1; }
ISR(TIMER2_COMPA_vect) { PINB = 1 << PB2; }

int main(void) {
  DDRB = 0x3f;
  // A loop without interrupts: exact to the cycle. It writes whole ports: avr8js 0.21 counts one cycle for CBI, where
  // the data sheet has two.
  for (uint8_t i = 0; i < 100; ++i) {
    PORTB = 1 << PB5;
    for (volatile uint8_t wait = 0; wait < i; ++wait) {
    }
    PORTB = 0;
  }
  UBRR0 = 16;
  UCSR0A = 1 << U2X0;
  UCSR0B = 1 << TXEN0;
  for (const char* text = "Hello, judge!\n"; *text; ++text) {
    while (!(UCSR0A & (1 << UDRE0))) {
    }
    UDR0 = (uint8_t)*text;
  }
  TCCR0B = 1 << CS01 | 1 << CS00;
  TIMSK0 = 1 << TOIE0;
  TCCR1B = 1 << WGM12 | 1 << CS11;
  OCR1A = 1999;
  TIMSK1 = 1 << OCIE1A;
  TCCR2A = 1 << WGM21;
  TCCR2B = 1 << CS22;
  OCR2A = 249;
  TIMSK2 = 1 << OCIE2A;
  sei();
  for (uint32_t i = 0;; ++i) {
    if ((i & 0xff) == 0) PINB = 1 << PB4;
  }
}
