// SPDX-License-Identifier: Apache-2.0

// Obstacle avoidance for the robot of worlds/robots/two_wheeler, in plain C: motors by timer 0, distances by the ADC,
// lines by the serial interface. It sleeps while it waits for the next of its steps.

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <stdint.h>
#include <stdio.h>

static volatile uint16_t milliseconds;
static volatile int16_t edges;

ISR(TIMER2_COMPA_vect) { ++milliseconds; }
// The left encoder: what its second barrier says at each edge of the first.
ISR(INT0_vect) { edges += ((PIND >> PD2) ^ (PINC >> PC3)) & 1 ? 1 : -1; }

static void send(const char* text) {
  for (; *text; ++text) {
    while (!(UCSR0A & (1 << UDRE0))) {
    }
    UDR0 = (uint8_t)*text;
  }
}

static uint16_t read_adc(uint8_t input) {
  ADMUX = (1 << REFS0) | input;
  ADCSRA |= 1 << ADSC;
  while (ADCSRA & (1 << ADSC)) {
  }
  return ADC;
}

// Speeds from -255 to 255.
static void drive(int16_t left, int16_t right) {
  if (left < 0) {
    PORTD &= (uint8_t) ~(1 << PD7);
    PORTB |= 1 << PB0;
  } else {
    PORTD |= 1 << PD7;
    PORTB &= (uint8_t) ~(1 << PB0);
  }
  if (right < 0) {
    PORTB &= (uint8_t) ~(1 << PB4);
    PORTB |= 1 << PB3;
  } else {
    PORTB |= 1 << PB4;
    PORTB &= (uint8_t) ~(1 << PB3);
  }
  OCR0B = (uint8_t)(left < 0 ? -left : left);
  OCR0A = (uint8_t)(right < 0 ? -right : right);
}

static void set_up(void) {
  DDRD = 1 << PD5 | 1 << PD6 | 1 << PD7;
  DDRB = 1 << PB0 | 1 << PB3 | 1 << PB4 | 1 << PB5;
  PORTC = 1 << PC5;  // pull-up of the bumper
  TCCR0A = 1 << COM0A1 | 1 << COM0B1 | 1 << WGM01 | 1 << WGM00;
  TCCR0B = 1 << CS01 | 1 << CS00;
  TCCR2A = 1 << WGM21;
  TCCR2B = 1 << CS22;
  OCR2A = 249;  // 1 ms
  TIMSK2 = 1 << OCIE2A;
  EICRA = 1 << ISC00;  // any edge
  EIMSK = 1 << INT0;
  UBRR0 = 16;  // 115200 baud, nearly
  UCSR0A = 1 << U2X0;
  UCSR0B = 1 << TXEN0;
  ADCSRA = 1 << ADEN | 7;
  set_sleep_mode(SLEEP_MODE_IDLE);
  sei();
}

int main(void) {
  set_up();
  send("ready\n");
  uint8_t backing = 0;
  for (uint16_t step = 0;; ++step) {
    const uint16_t next = (uint16_t)(step + 1) * 20;
    for (;;) {
      cli();
      const uint16_t now = milliseconds;
      sei();
      if ((int16_t)(now - next) >= 0) break;
      sleep_mode();
    }
    const int16_t left = (int16_t)read_adc(0), front = (int16_t)read_adc(1), right = (int16_t)read_adc(2);
    if (!(PINC & (1 << PC5))) backing = 25;
    if (backing > 0) {
      --backing;
      drive(-90, -60);
      PORTB |= 1 << PB5;
    } else if (front > 180 || left > 300 || right > 300) {
      drive(left > right ? 80 : -80, left > right ? -80 : 80);
      PORTB |= 1 << PB5;
    } else {
      drive(100 - (right - left) / 8, 100 + (right - left) / 8);
      PORTB &= (uint8_t) ~(1 << PB5);
    }
    if (step % 50 == 49) {
      char line[48];
      snprintf(line, sizeof line, "step %u edges %d adc %d %d %d\n", step + 1, edges, left, front, right);
      send(line);
    }
  }
}
