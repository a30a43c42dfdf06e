/* The limit: sampled control under the corrected law, (22), as one writes it in C: the twist is held for a step along the tangent, or along
   the arc. Blocks of runs stay in the cache. With SUMS it does all that a sweep does: a run stops where it arrives, and its
   largest |omega| and its length are kept. */
#include <math.h>

enum { BLOCK = 256 };

static inline double wrap(double angle) { return angle - 2 * M_PI * rint(angle / (2 * M_PI)); }

#ifdef SUMS
#define SUM_UP                                                                                                                   \
    double to_go = left[i];                                                                                                      \
    int taken = (to_go > 0) & (rho > radius);                                                                                    \
    v = taken ? v : 0, omega = taken ? omega : 0, left[i] = taken ? to_go - 1 : -fabs(to_go);                                    \
    peak[i] = fabs(omega) > peak[i] ? fabs(omega) : peak[i], length[i] += dt * fabs(v);
#else
#define SUM_UP
#endif

#define PLANE(name, ...)                                                                                                         \
    void name(double *restrict x, double *restrict y, double *restrict heading, const double *restrict goal_x,                   \
              const double *restrict goal_y, const double *restrict goal_heading, const double *restrict k_rho,                  \
              const double *restrict k_alpha, const double *restrict h, const double *restrict v_max, double *restrict left,     \
              double *restrict peak, double *restrict length, long runs, long steps, double dt, double radius) {                 \
        for (long first = 0; first < runs; first += BLOCK) {                                                                     \
            long last = first + BLOCK < runs ? first + BLOCK : runs;                                                             \
            for (long k = 0; k < steps; k++)                                                                                     \
                for (long i = first; i < last; i++) {                                                                            \
                    double east = goal_x[i] - x[i], north = goal_y[i] - y[i], sight = atan2(north, east);                        \
                    double rho = sqrt(east * east + north * north);                                                              \
                    double alpha = wrap(sight - heading[i]), theta = wrap(sight - goal_heading[i]);                              \
                    double v = v_max[i] * (1 - exp(-k_rho[i] * rho)) * cos(alpha);                                               \
                    double omega = k_alpha[i] * alpha + v / rho * (sin(alpha) / alpha) * (alpha + h[i] * theta);                 \
                    SUM_UP                                                                                                       \
                    __VA_ARGS__                                                                                                  \
                }                                                                                                                \
        }                                                                                                                        \
    }

PLANE(tangent, {
    x[i] += dt * v * cos(heading[i]), y[i] += dt * v * sin(heading[i]);
    heading[i] = wrap(heading[i] + dt * omega);
})

PLANE(arc, {
    double half = dt * omega / 2, chord = dt * v * (sin(half) / half), along = heading[i] + half;
    x[i] += chord * cos(along), y[i] += chord * sin(along);
    heading[i] = wrap(along + half);
})
