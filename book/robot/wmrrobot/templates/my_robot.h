/* my_robot.h: one robot's numbers, beside wmr_law.h.
   Metres, seconds, radians; x is east, headings are counter-clockwise from east. */
#ifndef MY_ROBOT_H
#define MY_ROBOT_H

#include "wmr_law.h"

/* wmr_local_position_e7(MY_START_E7, MY_GOAL_E7, &goal.x, &goal.y): degrees * 1e7 */
#define MY_START_E7 @start_lat_e7@, @start_lon_e7@
#define MY_GOAL_E7 @goal_lat_e7@, @goal_lon_e7@
#define MY_GOAL_HEADING WMR_C(@heading@)

#define MY_GAINS {WMR_C(@k_rho@), WMR_C(@k_alpha@), WMR_C(@h@), WMR_C(@v_max@)}
#define MY_PERIOD WMR_C(@period@) /* of the loop: longest step @longest_step@ s */
#define MY_RADIUS WMR_C(@radius@) /* within it, turn on the spot */

#define MY_TRACK_WIDTH WMR_C(@track_width@)
#define MY_MAX_SPEED WMR_C(@max_speed@)
#define MY_MIN_SPEED WMR_C(@min_speed@) /* over the dead band, for wmr_hurry */
#define MY_ACCELERATION WMR_C(@acceleration@) /* for wmr_drive.h: else honest wheels seem stuck */
#define MY_DEAD_BAND WMR_C(@dead_band@)

/* wmr_turn_rate(error, MY_TURN) until the error is within the tolerance */
#define MY_TURN WMR_C(@gain@), WMR_C(@min_rate@), WMR_C(@max_rate@)
#define MY_TOLERANCE WMR_C(@tolerance@)
#define MY_SETTLE WMR_C(@settle@) /* for so many seconds, as the heading is seen late */

/* of wmr_drive.h's rules: an older fix is not used; without one for so long the robot waits */
#define MY_OLDEST WMR_C(@oldest@)
#define MY_PATIENCE WMR_C(@patience@)
#define MY_LARGEST_ERROR WMR_C(@largest_error@)
#define MY_JUMP WMR_C(@jump@)
#define MY_COURSE WMR_C(@course@)
#define MY_LONGEST_PERIOD WMR_C(@longest_period@)
#define MY_LONGEST_DRIVE WMR_C(@longest_drive@)
#define MY_FARTHEST WMR_C(@farthest@)

#endif
