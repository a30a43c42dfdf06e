/* The limit: the closed loop under the corrected law, (7)-(9) and (22), in polar coordinates and in the plane, as one writes it in C.
   Blocks of runs stay in the cache. */
#include <math.h>

enum { BLOCK = 256 };

typedef struct { double rho, alpha, theta; } Rates;

static inline Rates closed_loop(double rho, double alpha, double theta, double k_rho, double k_alpha, double h, double v_max) {
    double v = v_max * (1 - exp(-k_rho * rho)) * cos(alpha), turning = v / rho * sin(alpha);
    double omega = k_alpha * alpha + v / rho * (sin(alpha) / alpha) * (alpha + h * theta);
    return (Rates){-v * cos(alpha), turning - omega, turning};
}

#define SWEEP(name, ...)                                                                                                          \
    void name(double *restrict rho, double *restrict alpha, double *restrict theta, const double *restrict k_rho,                \
              const double *restrict k_alpha, const double *restrict h, const double *restrict v_max, long runs, long steps,     \
              double dt) {                                                                                                       \
        for (long first = 0; first < runs; first += BLOCK) {                                                                     \
            long last = first + BLOCK < runs ? first + BLOCK : runs;                                                             \
            for (long k = 0; k < steps; k++)                                                                                     \
                for (long i = first; i < last; i++) __VA_ARGS__                                                                  \
        }                                                                                                                        \
    }

#define RATES(r, a, t) closed_loop(r, a, t, k_rho[i], k_alpha[i], h[i], v_max[i])

SWEEP(euler, {
    Rates d = RATES(rho[i], alpha[i], theta[i]);
    rho[i] += dt * d.rho, alpha[i] += dt * d.alpha, theta[i] += dt * d.theta;
})

SWEEP(rk4, {
    double r = rho[i], a = alpha[i], t = theta[i], half = dt / 2;
    Rates p = RATES(r, a, t), q = RATES(r + half * p.rho, a + half * p.alpha, t + half * p.theta);
    Rates u = RATES(r + half * q.rho, a + half * q.alpha, t + half * q.theta);
    Rates w = RATES(r + dt * u.rho, a + dt * u.alpha, t + dt * u.theta);
    rho[i] = r + dt / 6 * (p.rho + 2 * (q.rho + u.rho) + w.rho);
    alpha[i] = a + dt / 6 * (p.alpha + 2 * (q.alpha + u.alpha) + w.alpha);
    theta[i] = t + dt / 6 * (p.theta + 2 * (q.theta + u.theta) + w.theta);
})

/* Sampled control in the plane: the twist is held for a step along the tangent, or along the arc. */

static inline double wrap(double angle) { return angle - 2 * M_PI * rint(angle / (2 * M_PI)); }

#define PLANE(name, ...)                                                                                                          \
    void name(double *restrict x, double *restrict y, double *restrict heading, const double *restrict goal_x,                   \
              const double *restrict goal_y, const double *restrict goal_heading, const double *restrict k_rho,                  \
              const double *restrict k_alpha, const double *restrict h, const double *restrict v_max, long runs, long steps,     \
              double dt) {                                                                                                       \
        for (long first = 0; first < runs; first += BLOCK) {                                                                     \
            long last = first + BLOCK < runs ? first + BLOCK : runs;                                                             \
            for (long k = 0; k < steps; k++)                                                                                     \
                for (long i = first; i < last; i++) {                                                                            \
                    double east = goal_x[i] - x[i], north = goal_y[i] - y[i], sight = atan2(north, east);                        \
                    double rho = sqrt(east * east + north * north);                                                              \
                    double alpha = wrap(sight - heading[i]), theta = wrap(sight - goal_heading[i]);                              \
                    double v = v_max[i] * (1 - exp(-k_rho[i] * rho)) * cos(alpha);                                               \
                    double omega = k_alpha[i] * alpha + v / rho * (sin(alpha) / alpha) * (alpha + h[i] * theta);                 \
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
