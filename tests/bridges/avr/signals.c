// SPDX-License-Identifier: Apache-2.0

// Signals of many kinds on an ATmega328P, for tests to measure; byte by byte it answers to what it is asked.

#include <avr/interrupt.h>
#include <avr/io.h>
#include <stdint.h>

static void send(uint8_t byte) {
  while (!(UCSR0A & (1 << UDRE0))) {
  }
  UDR0 = byte;
}

// A signal by software: PD2 is high for 1 ms of 4.
ISR(TIMER1_OVF_vect) {}

static volatile uint8_t phase;
ISR(TIMER2_COMPA_vect) {
  if (phase == 0) PORTD |= 1 << PD2;
  if (phase == 1) PORTD &= (uint8_t) ~(1 << PD2);
  phase = (phase + 1) & 3;
}

int main(void) {
  DDRD = 1 << PD2 | 1 << PD5 | 1 << PD6 | 1 << PD7;
  DDRB = 1 << PB1 | 1 << PB2 | 1 << PB3;
  PORTB = 1 << PB0;  // pull-up
  TCCR0A = 1 << COM0A1 | 1 << COM0B1 | 1 << COM0B0 | 1 << WGM01 | 1 << WGM00;
  TCCR0B = 1 << CS00;
  OCR0A = 63;  // PD6: 64 of 256
  OCR0B = 63;  // PD5: the same, inverted
  TCCR1A = 1 << COM1A1 | 1 << COM1B1 | 1 << WGM11 | 1 << WGM10;
  TCCR1B = 1 << CS11;
  OCR1A = 256;   // PB1: 256 of 1023, phase correct
  OCR1B = 1023;  // PB2: always
  TCCR2A = 1 << COM2A0 | 1 << WGM21;
  TCCR2B = 1 << CS22;
  OCR2A = 249;  // PB3 changes each 1 ms
  TIMSK2 = 1 << OCIE2A;
  UBRR0 = 16;
  UCSR0A = 1 << U2X0;
  UCSR0B = 1 << TXEN0 | 1 << RXEN0;
  ADMUX = 1 << REFS0 | 3;
  ADCSRA = 1 << ADEN | 7;
  sei();
  send('!');
  for (;;) {
    if (!(UCSR0A & (1 << RXC0))) continue;
    switch (UDR0) {
      case 'a':  // analog input 3
        ADCSRA |= 1 << ADSC;
        while (ADCSRA & (1 << ADSC)) {
        }
        send((uint8_t)(ADC >> 2));
        break;
      case 'p': send(PINB & 1); break;
      case 'w':  // a write to the port of an input with a pull-up
        PORTB ^= 1 << PB2;
        send(PINB & 1);
        break;
      case 's':  // stops what timers make of pins
        TCCR0A = TCCR1A = TCCR2A = 0;
        PORTD |= 1 << PD7;
        break;
    }
  }
}
