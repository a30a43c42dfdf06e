// my_robot_arduino.h: one robot's numbers, for an Arduino sketch.
// Metres, seconds, radians; x is east, headings are counter-clockwise from east.
#pragma once
#include <stdint.h>

// Degrees * 1e7, as UBX sends them: a float loses half a metre.
const int32_t START_LAT_E7 = @start_lat_e7@, START_LON_E7 = @start_lon_e7@;
const int32_t GOAL_LAT_E7 = @goal_lat_e7@, GOAL_LON_E7 = @goal_lon_e7@;
const float GOAL_HEADING = @heading@f;

const float K_RHO = @k_rho@f, K_ALPHA = @k_alpha@f, H = @h@f, V_MAX = @v_max@f;
const float PERIOD = @period@f;    // of the loop: longest step @longest_step@ s
const float RADIUS_IN = @radius@f; // within it, turn on the spot

const float TRACK_WIDTH = @track_width@f;
const float MAX_SPEED = @max_speed@f;
const float MIN_SPEED = @min_speed@f; // over the dead band
const float ACCELERATION = @acceleration@f, DEAD_BAND = @dead_band@f;

const float TURN_GAIN = @gain@f, TURN_MIN = @min_rate@f, TURN_MAX = @max_rate@f;
const float TURN_TOLERANCE = @tolerance@f;
const float TURN_SETTLE = @settle@f; // s within it, as the heading is seen late

const float OLDEST_FIX = @oldest@f; // s: an older one is not used
const float PATIENCE = @patience@f; // s without a usable one, and it waits
const float LARGEST_ERROR = @largest_error@f, JUMP = @jump@f; // m: a worse fix is not used
const float COURSE = @course@f; // m: over legs so long it compares headings
const float LONGEST_PERIOD = @longest_period@f, LONGEST_DRIVE = @longest_drive@f; // s
const float FARTHEST = @farthest@f;

const float DELAY = @delay@f;          // s, of a fix
const float COMPASS_DEG = @compass@f;  // the compass's error
