// SPDX-License-Identifier: Apache-2.0

// A Kilobot that reports on its serial interface its type and the messages that it receives. With SENDS it sends its
// number four times a second, unless another Kilobot is sending. When it is told to run it turns, or drives ahead if it
// SENDS, and lights its LED. Messages are as those of other Kilobots: bits of 269 cycles, a 1 is a pulse.
#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/crc16.h>

#define BIT 269
enum { idle, preamble, message };

static volatile uint8_t state, place, value, arrived;
static volatile uint16_t began, high_gain, low_gain;
static volatile uint8_t bytes[12], whole[12];
static uint16_t number;

static void print(const char* text) {
  for (; *text; ++text) {
    while (!(UCSR0A & (1 << UDRE0)))
      ;
    UDR0 = *text;
  }
}

static void print_number(const char* name, uint16_t n) {
  char text[6], *at = text + 5;
  *at = 0;
  do *--at = '0' + n % 10;
  while (n /= 10);
  print(name);
  print(at);
}

static uint16_t sum(const uint8_t* text) {
  uint16_t crc = 0xffff;
  for (uint8_t i = 0; i < 10; ++i) crc = _crc_ccitt_update(crc, text[i]);
  return crc;
}

static uint16_t measure(uint8_t input) {
  ADMUX = input;
  ADCSRA = (1 << ADEN) | (1 << ADPS1) | (1 << ADPS0) | (1 << ADSC);
  while (ADCSRA & (1 << ADSC))
    ;
  return ADCW;
}

// The comparator starts the next conversion, of this input.
static void arm(uint8_t input) {
  ADMUX = input;
  ADCSRB = 1 << ADTS0;
  ADCSRA = (1 << ADEN) | (1 << ADATE) | (1 << ADPS1) | (1 << ADPS0);
}

static uint16_t converted(void) {
  while (ADCSRA & (1 << ADSC))
    ;
  return ADCW;
}

static void give_up(void) {
  state = idle;
  TIMSK1 = 0;
  arm(0);
}

ISR(TIMER1_COMPA_vect) { give_up(); }

ISR(ANALOG_COMP_vect) {
  const uint16_t now = TCNT1;
  OCR1A = now + 12 * BIT;
  TIFR1 = 1 << OCF1A;
  TIMSK1 = 1 << OCIE1A;
  if (state == idle) {
    began = now;
    high_gain = converted();
    arm(1);
    state = preamble;
    return;
  }
  const uint8_t bit = ((uint32_t)(uint16_t)(now - began + BIT / 2) * 244) >> 16;  // divided by BIT
  if (state == preamble) {
    if (bit != 9) return give_up();
    low_gain = converted();
    state = message;
    place = value = 0;
    began += 10 * BIT;
  } else if (bit == 0) {
    began = now;
  } else if (bit <= 8) {
    value |= 1 << (bit - 1);
  } else if (bit == 9) {
    bytes[place++] = value;
    value = 0;
    began += 10 * BIT;
    if (place < sizeof bytes) return;
    for (uint8_t i = 0; i < sizeof bytes; ++i) whole[i] = bytes[i];
    arrived = 1;
    give_up();
  } else {
    give_up();
  }
}

#ifdef SENDS
static void wait_until(uint16_t time) {
  while ((int16_t)(TCNT1 - time) < 0)
    ;
}

static void pulse(uint16_t time) {
  wait_until(time);
  PORTB |= 1;
  asm volatile("nop\nnop\nnop\nnop\nnop\nnop\nnop");
  PORTB &= ~1;
}

static void send(void) {
  uint8_t text[12] = {number, number >> 8, 'h', 'e', 'l', 'l', 'o', 0xff, 0x00, 0};
  const uint16_t crc = sum(text);
  text[10] = crc;
  text[11] = crc >> 8;
  cli();
  if (state != idle) {
    sei();
    return;
  }
  DDRB |= 1;
  uint16_t time = TCNT1 + 50;
  pulse(time);
  wait_until(time + 2 * BIT);
  uint8_t busy = 0;
  while ((int16_t)(TCNT1 - (time + 8 * BIT)) < 0) busy |= ACSR & (1 << ACO);
  if (!busy) {
    pulse(time += 9 * BIT);
    time += BIT;
    for (uint8_t i = 0; i < sizeof text; ++i) {
      const uint16_t frame = (uint16_t)text[i] << 1 | 0x201;
      for (uint8_t k = 0; k < 10; ++k, time += BIT)
        if (frame >> k & 1) pulse(time);
    }
  }
  DDRB &= ~1;
  ACSR |= 1 << ACI;
  sei();
}
#endif

static uint16_t calibrated(uint16_t address) {
  return (uint16_t)eeprom_read_byte((uint8_t*)address) << 8 | eeprom_read_byte((uint8_t*)(address + 1));
}

// In millimetres, by straight lines in a table of 14 counts, 5 mm apart.
static uint16_t distance(uint16_t count, uint16_t table) {
  uint16_t before = calibrated(table);
  for (uint8_t i = 1; i < 14; ++i) {
    const uint16_t next = calibrated(table + 2 * i);
    if (count >= before) return 28 + 5 * i;
    if (count >= next) return 28 + 5 * i + 5 * (before - count) / (before - next);
    before = next;
  }
  return 98;
}

static void run(void) {
  print("run\n");
  DDRB |= 1 << 3;
  DDRD |= 1 << 3;
  TCCR2A = (1 << COM2A1) | (1 << COM2B1) | (1 << WGM20);
  TCCR2B = 1 << CS21;
#ifdef SENDS
  OCR2A = eeprom_read_byte((uint8_t*)0x0c);
  OCR2B = eeprom_read_byte((uint8_t*)0x14);
  DDRD |= (1 << 5) | (1 << 4);  // red, bright
#else
  OCR2A = eeprom_read_byte((uint8_t*)0x05);
  OCR2B = 0;
  DDRC |= (1 << 3) | (1 << 4);  // green dim, blue less dim
#endif
}

int main(void) {
  UBRR0 = 25;  // 38400
  UCSR0A = 1 << U2X0;
  UCSR0B = 1 << TXEN0;
  TCCR1B = 1 << CS10;
  number = eeprom_read_byte((uint8_t*)0xb0) | eeprom_read_byte((uint8_t*)0xb1) << 8;
  print_number("number ", number);
  measure(6);
  print_number(" battery ", measure(6));
  print_number(" light ", measure(7));
  print("\n");
  ACSR = (1 << ACIE) | (1 << ACIS1) | (1 << ACIS0);
  arm(0);
  sei();
  TCCR0B = (1 << CS02) | (1 << CS00);  // 7.8 kHz
  for (uint16_t turns = 0;;) {
    if (TIFR0 & (1 << TOV0)) {
      TIFR0 = 1 << TOV0;
      ++turns;
#ifdef SENDS
      if (turns % 8 == 0) send();
#endif
    }
    if (!arrived) continue;
    arrived = 0;
    uint8_t text[12];
    for (uint8_t i = 0; i < sizeof text; ++i) text[i] = whole[i];
    const uint16_t high = high_gain, low = low_gain;
    if (sum(text) != (text[10] | (uint16_t)text[11] << 8)) {
      print("garbled\n");
    } else if (text[9] == 0x88) {
      run();
    } else {
      print_number("heard ", text[0] | text[1] << 8);
      print_number(" high ", high);
      print_number(" low ", low);
      print_number(" mm ", high >= 900 ? distance(low, 0x20) : distance(high, 0x50));
      print("\n");
    }
  }
}
