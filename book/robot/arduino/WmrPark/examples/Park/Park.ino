// Park: drives from one GPS point to another and parks there, facing as it is told.
// The numbers of your robot: save my_robot.h of the page "My robot" beside this file.
// Wiring and bench test: README.md of the library. SPDX-License-Identifier: BSD-3-Clause
#include <WmrPark.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "my_robot.h"

const bool BENCH = false; // true: the bench test, wheels in the air

// pins: the emergency stop, closed to ground; the motors' relay; the battery, by a divider
const uint8_t STOP_PIN = 12, POWER_PIN = A0, BATTERY_PIN = A1;
const float DIVIDER = 4, BATTERY_LOW = 10.5f; // the pin has a quarter of the volts
const float FULL_SPEED = 1.25f * MY_MAX_SPEED; // m/s at full PWM
const float COUNT_M = 0.001f;                 // m from one change of encoder pin A to the next
const float FENCE = 15;                       // m round the rectangle of start and goal
const float TICK = 78 * 1024L / 16e6f;        // s of the wheels' loop
const uint32_t PERIOD_US = (uint32_t)(1e6f * MY_PERIOD);

//          pins: PWM, back, encoder A and B
Wheel left({9, 8, 2, 4, COUNT_M, FULL_SPEED, MY_ACCELERATION, 2});
Wheel right({10, 11, 3, 7, COUNT_M, FULL_SPEED, MY_ACCELERATION, 2});
Compass compass;
Ublox ublox;
Pilot pilot;
bool fresh = false;            // a fix has come
volatile bool stopped = false; // by the button, or as the drive has ended, until a reset

// More often than the 64 bytes of its buffer take, 16 ms.
void receive() { fresh = ublox.read(Serial) || fresh; }
void left_changed() { left.changed(); }
void right_changed() { right.changed(); }

// It lets encoders and receiver interrupt it; not itself, if it ever takes longer than a tick.
ISR(TIMER2_COMPA_vect, ISR_NOBLOCK) {
  static volatile bool busy = false;
  if (busy) return;
  busy = true;
  stopped = stopped || digitalRead(STOP_PIN);
  if (stopped) {
    digitalWrite(POWER_PIN, LOW);
    left.cut(), right.cut();
  } else {
    left.tick(TICK), right.tick(TICK);
  }
  busy = false;
}

void setup() {
  wdt_enable(WDTO_250MS);
  pinMode(STOP_PIN, INPUT_PULLUP), pinMode(POWER_PIN, OUTPUT);
  left.begin(left_changed), right.begin(right_changed);
  Serial.begin(38400);
  while (MY_PERIOD < 0.019f || MY_PERIOD > 0.201f) // the watchdog's, and a counter's, bounds
    wdt_disable(), Serial.println(F("MY_PERIOD: 0.02 to 0.2 s")), delay(1000);
  compass.iron_x = 0, compass.iron_y = 0; // of the bench test
  compass.declination = 0.087f;           // of your place and year
  compass.begin();

  pilot.start(MY_START_E7);
  my_plan(&pilot.plan);
  pilot.plan.motors.lag = 0.1f, pilot.plan.motors.dead_band = 0; // their loops see to that
  pilot.plan.rules.battery = BATTERY_LOW;
  pilot.noise = {0.02f, 0.01f, 0.001f, 0.001f, MY_TRACK_WIDTH, MY_MAX_SPEED};
  pilot.delay = MY_DELAY, pilot.compass = MY_COMPASS_DEG * (float)DEG_TO_RAD;
  pilot.ahead = MY_ANTENNA_AHEAD, pilot.left = MY_ANTENNA_LEFT, pilot.fence = FENCE;
  pilot.meanwhile = receive;

  TCCR2A = 1 << WGM21, OCR2A = 77; // a tick is 78 * 1024 cycles
  TCCR2B = 1 << CS22 | 1 << CS21 | 1 << CS20, TIMSK2 = 1 << OCIE2A;
  digitalWrite(POWER_PIN, HIGH);
}

void loop() {
  static uint32_t begun = micros();
  static uint16_t longest = 0;
  receive();
  const uint32_t now = micros(), past = now - begun;
  if (past < PERIOD_US) {
    sleep_mode(); // until the next interrupt
    return;
  }
  begun = now;
  if (BENCH) bench();
  else drive(1e-6f * (float)past, longest);
  const uint32_t took = micros() - now;
  if (took > longest) longest = (uint16_t)took;
  if (took <= PERIOD_US) wdt_reset(); // a turn that is late does not feed the watchdog
}

void drive(float seconds, uint16_t longest) {
  static uint8_t periods = 0;
  const wmr_memory &m = pilot.memory;
  pilot.roll(seconds, left.rolled(), right.rolled());
  receive();
  if (fresh) {
    float heading;
    fresh = false;
    pilot.fix(ublox.pvt, compass.read(&heading) ? heading : NAN);
    receive();
  }
  const wmr_wheels wheels = pilot.drive(DIVIDER * 5 / 1023 * (float)analogRead(BATTERY_PIN));
  if (stopped && m.state != WMR_PARKED) pilot.memory.state = WMR_STOPPED;
  if (m.state >= WMR_PARKED) stopped = true;
  left.tell(wheels.left), right.tell(wheels.right);
  if (++periods % 10) return;
  // state, reason, x and y in cm, heading in mrad, longest period in us
  const int32_t numbers[] = {m.state, m.reason, (int32_t)(100 * m.pose.x),
                             (int32_t)(100 * m.pose.y), (int32_t)(1000 * m.pose.heading), longest};
  say(numbers, 6);
}

// Twelve times three seconds: left, right, a turn to the left, the eight poses of chapter 11 with
// the goal at the origin facing east, and a stop. Each ends with mm/s told and rolled, left and
// right, the compass's x, y and heading in degrees, and the fix's quality.
void bench() {
  static const int8_t POSES[8][3] = {{-50, 0, 0},  {-50, 0, 30}, {-50, 0, -30}, {-50, 20, 0},
                                     {-50, -20, 0}, {50, 0, 0},   {-5, 0, 0},    {0, 0, 0}};
  static uint8_t phase = 0, periods = 0;
  static wmr_wheels told = {0.2f, 0, WMR_OK};
  static float rolled[2] = {0, 0};
  const uint8_t second = (uint8_t)(1 / MY_PERIOD);
  // by then it has sped up; after the last phase it counts on, for wheels turned by hand
  if (periods == 2 * second && phase < 12) rolled[0] = rolled[1] = 0;
  rolled[0] += left.rolled(), rolled[1] += right.rolled();
  left.tell(told.left), right.tell(told.right);
  if (++periods < 3 * second) return;
  float heading = 0;
  if (!compass.read(&heading)) compass.x = compass.y = 0;
  const int32_t numbers[] = {(int32_t)(1000 * told.left), (int32_t)(1000 * told.right),
                             (int32_t)(1000 * rolled[0]), (int32_t)(1000 * rolled[1]),
                             compass.x, compass.y, (int32_t)(heading * RAD_TO_DEG),
                             ublox.pvt.quality};
  say(numbers, 8);
  periods = 0;
  if (phase < 12) ++phase; // then it stands, however long
  told = {phase == 2 ? -0.2f : 0, phase < 3 ? 0.2f : 0, WMR_OK};
  if (phase < 3 || phase > 10) return;
  const int8_t *at = POSES[phase - 3];
  const wmr_pose pose = {0.1f * at[0], 0.1f * at[1], at[2] * (float)DEG_TO_RAD}, goal = {0, 0, 0};
  const wmr_twist twist = wmr_law(wmr_polar_error(pose, goal), pilot.plan.gains);
  told = wmr_limited_wheels(twist, MY_TRACK_WIDTH, MY_MAX_SPEED);
}

void say(const int32_t *numbers, uint8_t count) {
  while (count--) Serial.print(*numbers++), Serial.print(count ? ' ' : '\n');
}
