// Obstacle avoidance for the robot of worlds/robots/two_wheeler, as a sketch for an Arduino Uno.
#include <Arduino.h>

const int left_enable = 5, left_forward = 7, left_backward = 8;
const int right_enable = 6, right_forward = 12, right_backward = 11;
const int trigger = 9, echo = 10, bumper = A5, buzzer = 4, led = 13;

volatile long edges = 0;
void on_edge() { edges += digitalRead(2) != digitalRead(A3) ? 1 : -1; }

void motor(int enable, int forward, int backward, int speed) {
  digitalWrite(forward, speed >= 0);
  digitalWrite(backward, speed < 0);
  analogWrite(enable, abs(speed));
}

void drive(int left, int right) {
  motor(left_enable, left_forward, left_backward, left);
  motor(right_enable, right_forward, right_backward, right);
}

// [mm], 0 if there is no echo.
unsigned long distance_ahead() {
  digitalWrite(trigger, HIGH);
  delayMicroseconds(10);
  digitalWrite(trigger, LOW);
  return pulseIn(echo, HIGH, 30000) * 10 / 58;
}

void setup() {
  Serial.begin(115200);
  const int outputs[] = {left_enable,    left_forward, left_backward, right_enable, right_forward,
                         right_backward, trigger,      buzzer,        led};
  for (unsigned i = 0; i < sizeof outputs / sizeof outputs[0]; ++i) pinMode(outputs[i], OUTPUT);
  pinMode(bumper, INPUT_PULLUP);
  attachInterrupt(digitalPinToInterrupt(2), on_edge, CHANGE);
  Serial.println("ready");
}

unsigned long next_line = 1000;

void loop() {
  const int left = analogRead(A0), right = analogRead(A2);
  const unsigned long ahead = distance_ahead();
  const bool blocked = ahead > 0 && ahead < 350;
  if (digitalRead(bumper) == LOW) {
    tone(buzzer, 880, 200);
    drive(-100, -60);
    delay(300);
  } else if (blocked || left > 300 || right > 300) {
    drive(left > right ? 80 : -80, left > right ? -80 : 80);
  } else {
    drive(100 - (right - left) / 8, 100 + (right - left) / 8);
  }
  digitalWrite(led, blocked);
  if (millis() >= next_line) {
    next_line += 1000;
    noInterrupts();
    const long made = edges;
    interrupts();
    Serial.print("edges ");
    Serial.print(made);
    Serial.print(" ahead ");
    Serial.println(ahead);
  }
}
