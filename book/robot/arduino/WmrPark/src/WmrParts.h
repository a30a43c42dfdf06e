// WmrParts.h: a robot's receiver, its compass and its wheels, for boards with an AVR.
// Metres, seconds, radians; headings are counter-clockwise from east.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Arduino.h>
#include <util/atomic.h>

#define WMR_REAL float
#include "wmr_law.h"

// What a u-blox receiver says in a NAV-PVT.
struct Pvt {
  uint32_t time;        // ms of the week
  int32_t lat, lon;     // degrees * 1e7
  float error;          // m, by its own word
  int quality;          // as NMEA counts: 0 none, 1 GPS, 2 differential, 4 RTK fixed, 5 float
};

class Ublox {
 public:
  // Reads what has come; true once a message is complete and its sum is right.
  bool read(Stream &from) {
    while (from.available())
      if (take((uint8_t)from.read())) return true;
    return false;
  }
  Pvt pvt;

 private:
  enum { HEAD = 6, LENGTH = 92, KEPT = 44 };
  uint8_t kept[KEPT], count, sum_a, sum_b;

  bool take(uint8_t byte) {
    static const uint8_t head[HEAD] = {0xB5, 0x62, 0x01, 0x07, LENGTH, 0};
    if (count < HEAD && byte != head[count]) {
      count = byte == head[0];
      return false;
    }
    if (count < HEAD + LENGTH) {
      if (count < 2) sum_a = sum_b = 0;
      else sum_a += byte, sum_b += sum_a;
      if (count >= HEAD && count < HEAD + KEPT) kept[count - HEAD] = byte;
      ++count;
      return false;
    }
    if (count == HEAD + LENGTH && byte == sum_a) {
      ++count;
      return false;
    }
    const bool whole = count > HEAD + LENGTH && byte == sum_b;
    count = 0;
    if (whole) decode();
    return whole;
  }

  void decode() {
    const uint8_t type = kept[20], flags = kept[21], carrier = flags >> 6;
    uint32_t mm;
    memcpy(&pvt.time, kept, 4), memcpy(&pvt.lon, kept + 24, 4), memcpy(&pvt.lat, kept + 28, 4);
    memcpy(&mm, kept + 40, 4);
    pvt.error = 0.001f * (float)mm;
    const int good = carrier == 2 ? 4 : carrier == 1 ? 5 : flags & 2 ? 2 : 1;
    pvt.quality = (flags & 1) && type >= 2 && type <= 4 ? good : 0;
  }
};

// A QMC5883L, level, its x axis ahead and its y axis to the left, on SDA and SCL. The bus is
// polled: Wire's buffers would take 200 bytes of RAM that the filter's stack needs.
class Compass {
 public:
  float iron_x, iron_y;  // hard iron: what it reads in the middle of a full turn
  float declination;     // of magnetic north, to the east
  int16_t x, y;          // the last reading

  bool begin() {
    TWSR = 0, TWBR = (F_CPU / 100000 - 16) / 2;  // 100 kHz
    return write(0x0B, 0x01) && write(0x09, 0x05);  // 50 Hz, 2 gauss
  }

  // False if it is silent or has nothing new; a silent one is asked to begin anew.
  bool read(float *heading) {
    uint8_t status, raw[4];
    if (!ask(6, &status, 1) || !ask(0, raw, 4)) return begin(), false;
    if ((status & 3) != 1) return false;  // nothing new, or it has overflowed
    x = (int16_t)(raw[0] | raw[1] << 8), y = (int16_t)(raw[2] | raw[3] << 8);
    const float ahead = (float)x - iron_x, left = (float)y - iron_y;
    *heading = wmr_wrap(1.5707963f - declination - atan2f(left, ahead));
    return ahead != 0 || left != 0;
  }

 private:
  enum { ADDRESS = 0x0D << 1 };
  enum { BEGUN = 0x08, AGAIN = 0x10, HEARD = 0x18, TAKEN = 0x28, ASKED = 0x40 };

  // One step on the bus, and its status; 0 if nothing happens, for a hung bus must not hang all.
  static uint8_t step(uint8_t control) {
    TWCR = (uint8_t)(control | 1 << TWINT | 1 << TWEN);
    for (uint16_t tries = 0; tries < 500; ++tries)
      if (TWCR & 1 << TWINT) return TWSR & 0xF8;
    TWCR = 0;
    return 0;
  }
  static uint8_t send(uint8_t byte) { return TWDR = byte, step(0); }
  static bool stop(bool good) {
    TWCR = 1 << TWINT | 1 << TWEN | 1 << TWSTO;
    for (uint16_t tries = 0; tries < 500 && (TWCR & 1 << TWSTO);) ++tries;
    return good;
  }
  static bool begun(uint8_t place) {
    return step(1 << TWSTA) == BEGUN && send(ADDRESS) == HEARD && send(place) == TAKEN;
  }

  static bool ask(uint8_t place, uint8_t *to, uint8_t count) {
    bool good = begun(place) && step(1 << TWSTA) == AGAIN && send(ADDRESS | 1) == ASKED;
    while (good && count--) good = step(count ? 1 << TWEA : 0), *to++ = TWDR;
    return stop(good);
  }
  static bool write(uint8_t place, uint8_t value) {
    return stop(begun(place) && send(value) == TAKEN);
  }
};

// A wheel's pins and sizes; its loop follows the distance that is due.
struct WheelSettings {
  uint8_t pwm, back, a, b;  // pins: motor, its direction, encoder
  float count_m;            // m from one change of a to the next; negative if it counts backwards
  float full_speed;         // m/s at full PWM
  float acceleration;       // m/s^2
  float gain;               // 1/s: speed per distance that is lacking
};

class Wheel {
 public:
  explicit Wheel(const WheelSettings &settings) : s(settings) {}

  void begin(void (*changed)()) {
    pinMode(s.pwm, OUTPUT), pinMode(s.back, OUTPUT);
    pinMode(s.a, INPUT_PULLUP), pinMode(s.b, INPUT_PULLUP);
    attachInterrupt(digitalPinToInterrupt(s.a), changed, CHANGE);
  }

  void changed() { count += digitalRead(s.a) == digitalRead(s.b) ? -1 : 1; }

  void tell(float speed) {
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { told = speed; }
  }

  float rolled() {  // m since the last call
    int32_t now;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { now = count; }
    const int32_t more = (int32_t)((uint32_t)now - (uint32_t)before);
    before = now;
    return s.count_m * (float)more;
  }

  // Every dt seconds, in an interrupt.
  void tick(float dt) {
    int32_t now;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { now = count; }
    const float reach = s.acceleration * dt, lacking = 0.1f;
    speed += constrain(told - speed, -reach, reach);
    lack += speed * dt - s.count_m * (float)(int32_t)((uint32_t)now - (uint32_t)counted);
    counted = now;
    if (speed == 0 && told == 0) lack = 0;  // it rests where it is
    lack = constrain(lack, -lacking, lacking);
    drive((speed + s.gain * lack) / s.full_speed);
  }

  void cut() { told = speed = lack = 0, drive(0); }

 private:
  void drive(float duty) {
    digitalWrite(s.back, duty < 0);
    analogWrite(s.pwm, (int)(255.0f * constrain(fabs(duty), 0.0f, 1.0f) + 0.5f));
  }
  const WheelSettings s;
  volatile int32_t count = 0;
  volatile float told = 0;
  int32_t before = 0, counted = 0;
  float speed = 0, lack = 0;
};
