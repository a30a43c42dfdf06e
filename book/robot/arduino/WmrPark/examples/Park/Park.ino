// Park: drives from one GPS point to another and parks there, facing as it is told.
// The numbers of your robot: save my_robot_arduino.h of the page "My robot" beside this file.
// Wiring and bench test: README.md of the library. SPDX-License-Identifier: BSD-3-Clause
#include <WmrPark.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include "my_robot_arduino.h"

const uint8_t STOP_PIN = 12;    // closed to ground; open, or cut, it stops
const uint8_t POWER_PIN = A0;   // the motors' relay
const uint8_t BATTERY_PIN = A1; // through a divider
const float VOLTS = 5.0f * 4 / 1023, BATTERY_LOW = 10.5f;
const float FULL_SPEED = 1.25f * MAX_SPEED, COUNT_M = 0.001f;
const float FENCE = 15; // m round the rectangle of start and goal
const float TICK = 78 * 1024L / 16e6f; // s of the wheels' loop
const uint32_t PERIOD_US = (uint32_t)(1e6f * PERIOD);

//                     PWM, back, encoder A and B
Wheel left({9, 8, 2, 4, COUNT_M, FULL_SPEED, ACCELERATION, 2});
Wheel right({10, 11, 3, 7, COUNT_M, FULL_SPEED, ACCELERATION, 2});
Compass compass;
Ublox ublox;
Pilot pilot;
bool fresh = false;            // a fix has come
volatile bool stopped = false; // by the button, until a reset

void left_changed() { left.changed(); }
void right_changed() { right.changed(); }

ISR(TIMER2_COMPA_vect, ISR_NOBLOCK) {
  stopped = stopped || digitalRead(STOP_PIN);
  if (stopped) {
    digitalWrite(POWER_PIN, LOW);
    left.cut(), right.cut();
  } else {
    left.tick(TICK), right.tick(TICK);
  }
}

void receive() { fresh = ublox.read(Serial) || fresh; }

void setup() {
  wdt_enable(WDTO_250MS);
  pinMode(STOP_PIN, INPUT_PULLUP);
  pinMode(POWER_PIN, OUTPUT);
  left.begin(left_changed), right.begin(right_changed);
  Serial.begin(38400);
  compass.iron_x = 0, compass.iron_y = 0; // of the bench test
  compass.declination = 0.087f;           // of your place and year
  compass.begin();

  pilot.lat = START_LAT_E7, pilot.lon = START_LON_E7;
  pilot.goal(GOAL_LAT_E7, GOAL_LON_E7, GOAL_HEADING);
  pilot.plan.gains = {K_RHO, K_ALPHA, H, V_MAX};
  pilot.plan.motors = {TRACK_WIDTH, MAX_SPEED, MIN_SPEED, ACCELERATION, 0.1f, 0, COUNT_M};
  pilot.plan.end = {TURN_TOLERANCE, TURN_GAIN, TURN_MIN, TURN_MAX, 2, TURN_SETTLE};
  pilot.plan.rules = WMR_USUAL_RULES;
  pilot.plan.rules.arrival_radius = RADIUS_IN;
  pilot.plan.rules.oldest = OLDEST_FIX, pilot.plan.rules.patience = PATIENCE;
  pilot.plan.rules.largest_error = fmax(1, 3 * SIGMA);
  pilot.plan.rules.jump = fmax(1, 6 * SIGMA), pilot.plan.rules.course = fmax(4, 12 * SIGMA);
  pilot.plan.rules.longest_drive = LONGEST_DRIVE;
  pilot.plan.rules.battery = BATTERY_LOW;
  pilot.noise = {0.02f, 0.01f, 0.001f, 0.001f, TRACK_WIDTH};
  pilot.delay = DELAY, pilot.compass = COMPASS_DEG * DEG_TO_RAD, pilot.fence = FENCE;

  TCCR2A = 1 << WGM21, OCR2A = 77; // a tick is 78 * 1024 cycles
  TCCR2B = 1 << CS22 | 1 << CS21 | 1 << CS20, TIMSK2 = 1 << OCIE2A;
  digitalWrite(POWER_PIN, HIGH);
}

void loop() {
  static uint32_t begun = micros();
  static uint16_t periods = 0, longest = 0;
  receive();
  if (micros() - begun < PERIOD_US) {
    sleep_mode(); // until the next interrupt
    return;
  }
  const uint32_t now = micros(), past = now - begun;
  begun = now;

  pilot.roll(1e-6f * (float)past, left.rolled(), right.rolled());
  receive();
  if (fresh) {
    float heading;
    pilot.fix(ublox.pvt, compass.read(&heading) ? heading : NAN);
    fresh = false;
    receive();
  }
  const wmr_wheels wheels = pilot.drive(VOLTS * (float)analogRead(BATTERY_PIN));
  if (stopped) pilot.memory.state = WMR_STOPPED;
  if (pilot.memory.state == WMR_STOPPED) stopped = true;
  left.tell(wheels.left), right.tell(wheels.right);

  const uint32_t took = micros() - now;
  if (took > longest) longest = (uint16_t)took;
  if (took <= PERIOD_US) wdt_reset(); // a turn that is late does not feed the watchdog
  if (++periods % 10 == 0) report(longest);
}

// State, reason, x and y in cm, heading in mrad, and the longest period in us.
void report(uint16_t longest) {
  const wmr_memory &m = pilot.memory;
  const int32_t numbers[] = {m.state, m.reason, (int32_t)(100 * m.pose.x), (int32_t)(100 * m.pose.y),
                             (int32_t)(1000 * m.pose.heading), longest};
  for (const int32_t number : numbers) Serial.print(number), Serial.print(' ');
  Serial.println();
}
