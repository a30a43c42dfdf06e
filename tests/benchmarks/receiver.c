/* A sweep in which each run steers by what a receiver shows, as one writes it in C: run after run, the corrected law, (22), along arcs.
   A fix has the error of a Gauss-Markov process and is shown late and for a period; the heading is late too. The random numbers are
   wmrlib's: Philox 4x32-10 and the rule of Box and Muller. As in wmrlib, each sample is recorded: the true pose and polar error, and the
   twist. What a run amounts to is its time, its distance, its heading error, its largest |omega| and its length. */
#include <math.h>
#include <stdint.h>

static inline double wrap(double angle) { return angle - 2 * M_PI * ceil(angle / (2 * M_PI) - 0.5); }

static void normals(uint32_t run, uint32_t sample, uint32_t purpose, const uint32_t key[2], double *east, double *north) {
    uint32_t a = run, b = 0, c = sample, d = purpose, key_1 = key[0], key_2 = key[1];
    for (int round = 0; round < 10; round++, key_1 += 0x9E3779B9, key_2 += 0xBB67AE85) {
        uint64_t one = (uint64_t)0xD2511F53 * a, two = (uint64_t)0xCD9E8D57 * c;
        a = (uint32_t)(two >> 32) ^ b ^ key_1, c = (uint32_t)(one >> 32) ^ d ^ key_2;
        b = (uint32_t)two, d = (uint32_t)one;
    }
    double size = (((uint64_t)a << 21) + (b >> 11) + 0.5) * 0x1p-53, turn = (((uint64_t)c << 21) + (d >> 11)) * 0x1p-53;
    double length = sqrt(-2 * log(size));
    *east = length * cos(2 * M_PI * turn), *north = length * sin(2 * M_PI * turn);
}

/* Times are whole samples; `fading` is one over the memory. `record` has room for eight numbers in each sample of a run. */
void read_by_a_receiver(const double *x0, const double *y0, const double *heading0, const double *goal_x, const double *goal_y,
                        const double *goal_heading, const double *k_rho, const double *k_alpha, const double *h, const double *v_max,
                        double *time, double *off, double *peak, double *length, double *distance, double *record, long runs, long samples, double dt, double radius,
                        double sigma, double fading, long period, long delay, long heading_delay, const uint32_t *key) {
    double *xs = record, *ys = xs + samples, *headings = ys + samples, *rhos = headings + samples, *alphas = rhos + samples;
    double *thetas = alphas + samples, *vs = thetas + samples, *omegas = vs + samples;
    for (long i = 0; i < runs; i++) {
        double x = x0[i], y = y0[i], heading = wrap(heading0[i]), error_east = 0, error_north = 0, seen_x = 0, seen_y = 0;
        long shown = -1;
        time[i] = INFINITY, peak[i] = length[i] = 0;
        double rolled = 0;
        for (long k = 0; k < samples; k++) {
            double true_sight = atan2(goal_y[i] - y, goal_x[i] - x);
            xs[k] = x, ys[k] = y, headings[k] = heading, rhos[k] = hypot(goal_x[i] - x, goal_y[i] - y);
            alphas[k] = wrap(true_sight - heading), thetas[k] = wrap(true_sight - goal_heading[i]);
            long fix = k / period * period - delay;
            fix = fix > 0 ? fix : 0;
            if (fix > shown) {
                double age = shown < 0 ? INFINITY : (fix - shown) * fading, keep = exp(-age), new = sqrt(-expm1(-2 * age)), east, north;
                normals(i, fix, 0, key, &east, &north);
                error_east = keep * error_east + new * east, error_north = keep * error_north + new * north;
                seen_x = xs[fix] + sigma * error_east, seen_y = ys[fix] + sigma * error_north, shown = fix;
            }
            double east = goal_x[i] - seen_x, north = goal_y[i] - seen_y, sight = atan2(north, east), rho = hypot(east, north);
            double alpha = wrap(sight - headings[k > heading_delay ? k - heading_delay : 0]), theta = wrap(sight - goal_heading[i]);
            double v_over_rho = v_max[i] * (rho > 1e-8 ? -expm1(-k_rho[i] * rho) / rho : k_rho[i]) * cos(alpha);
            double shape = fabs(alpha) > 1e-8 ? sin(alpha) / alpha : 1, v = v_over_rho * rho;
            double omega = k_alpha[i] * alpha + v_over_rho * shape * (alpha + h[i] * theta);
            peak[i] = fabs(omega) > peak[i] ? fabs(omega) : peak[i];
            vs[k] = v, omegas[k] = omega, length[i] += rolled, rolled = dt * fabs(v);
            distance[i] = rhos[k], off[i] = wrap(thetas[k] - alphas[k]);
            if (rho <= radius) {
                time[i] = k * dt;
                break;
            }
            double half = dt * omega / 2, chord = v * dt * (fabs(half) > 1e-8 ? sin(half) / half : 1), along = heading + half;
            x += chord * cos(along), y += chord * sin(along), heading = wrap(heading + 2 * half);
        }
    }
}
