/* Cubic curves for stretches of curves: what cubic_fit.py and cubic_bounds.py do for all parts of stretches, with the
   same operations in the same order.

   Arrays of several rows have these one after the other; parts are (4, m): row k holds the k-th control points. */

#include <math.h>
#include <stdint.h>

typedef struct {
    double x[4], y[4];
} Cubic;

typedef struct {
    double point, speed, bend;
} Motion;

static double clipped(double value, double low, double high)
{
    value = value < low ? low : value;
    return value > high ? high : value;
}

/* One coordinate at a parameter, and its first and second derivatives, as in derivatives. */
static Motion motion(const double *c, double t)
{
    double a = c[1] - c[0], b = c[2] - c[1], d = c[3] - c[2], bend = b - a, last = d - b, twist = last - bend;
    Motion found = {c[0] + t * (3.0 * a + t * (3.0 * bend + t * twist)), 3.0 * (a + t * (2.0 * bend + t * twist)),
                    6.0 * (bend + t * twist)};
    return found;
}

/* As nearer_foot. */
static double nearer(const Cubic *curve, double x, double y, double t)
{
    Motion u = motion(curve->x, t), v = motion(curve->y, t);
    double ex = u.point - x, ey = v.point - y, square = u.speed * u.speed + v.speed * v.speed;
    double slope = square + (ex * u.bend + ey * v.bend);
    slope = slope > 0.25 * square ? slope : square;
    return clipped(t - (ex * u.speed + ey * v.speed) / (slope > 0.0 ? slope : 1.0), 0.0, 1.0);
}

/* As _foot_speed. */
static double foot_speed(const Cubic *curve, double x, double y, double vx, double vy, double t)
{
    Motion u = motion(curve->x, t), v = motion(curve->y, t);
    double slope = u.speed * u.speed + v.speed * v.speed + ((u.point - x) * u.bend + (v.point - y) * v.bend);
    return (vx * u.speed + vy * v.speed) / (slope > 0.0 ? slope : INFINITY);
}

/* The product of polynomials of n and k coefficients, as in _product. */
static void product(const double *one, int n, const double *other, int k, double *out)
{
    int i, sum;
    for (sum = 0; sum < n + k - 1; sum++) {
        int first = sum - k + 1 > 0 ? sum - k + 1 : 0, last = sum < n - 1 ? sum : n - 1;
        double total = one[first] * other[sum - first];
        for (i = first + 1; i <= last; i++)
            total = total + one[i] * other[sum - i];
        out[sum] = total;
    }
}

/* The polar form of one coordinate, as in _between. */
static double polar(const double *c, double u, double v, double w)
{
    double p = c[0] + u * (c[1] - c[0]), q = c[1] + u * (c[2] - c[1]), r = c[2] + u * (c[3] - c[2]);
    p = p + v * (q - p);
    q = q + v * (r - q);
    return p + w * (q - p);
}

/* The Bernstein coefficients of one coordinate of the difference, as in _difference. */
static void difference(const double *control, const double *points, double (*basis)[10], double begin, double end,
                       double *out)
{
    static const double cubic[] = {1, 3, 3, 1}, sixth[] = {1, 6, 15, 20, 15, 6, 1},
                        ninth[] = {1, 9, 36, 84, 126, 126, 84, 36, 9, 1};
    double origin = points[0], b0 = polar(control, begin, begin, begin) - origin,
           b1 = polar(control, begin, begin, end) - origin, b2 = polar(control, begin, end, end) - origin,
           b3 = polar(control, end, end, end) - origin, own[4], raised[10];
    int k;
    for (k = 0; k < 4; k++)
        own[k] = cubic[k] * (points[k] - origin);
    product(own, 4, sixth, 7, raised);
    for (k = 0; k < 10; k++)
        out[k] = (b0 * basis[0][k] + 3.0 * (b1 * basis[1][k] + b2 * basis[2][k]) + b3 * basis[3][k] - raised[k]) /
                 ninth[k];
}

/* The bound on the distance of a part from a curve between two parameters, as in bounds. */
static double distance(const Cubic *curve, const double *x, const double *y, double begin, double end)
{
    double span = end > begin ? end - begin : 1.0, low, high, gg[7], gh[7], hh[7], basis[4][10], dx[10], dy[10], most;
    int k;
    low = clipped(foot_speed(curve, x[0], y[0], x[1] - x[0], y[1] - y[0], begin) / span, 0.0, 1.0);
    high = 1.0 - clipped(foot_speed(curve, x[3], y[3], x[3] - x[2], y[3] - y[2], end) / span, 0.0, 1.0);
    {
        double g[] = {0.0, 3.0 * low, 3.0 * high, 1.0}, h[] = {1.0, 3.0 * (1.0 - low), 3.0 * (1.0 - high), 0.0};
        product(g, 4, g, 4, gg);
        product(g, 4, h, 4, gh);
        product(h, 4, h, 4, hh);
        product(hh, 7, h, 4, basis[0]);
        product(gh, 7, h, 4, basis[1]);
        product(gg, 7, h, 4, basis[2]);
        product(gg, 7, g, 4, basis[3]);
    }
    difference(curve->x, x, basis, begin, end, dx);
    difference(curve->y, y, basis, begin, end, dy);
    most = dx[0] * dx[0] + dy[0] * dy[0];
    for (k = 1; k < 10; k++) {
        double square = dx[k] * dx[k] + dy[k] * dy[k];
        most = square > most || square != square ? square : most;
    }
    return sqrt(most);
}

/* The curves whose handles have these lengths, as in _Hermite.curves; ends are (6, n). */
static Cubic curve_of(const double *ends, int64_t n, int64_t k, double near, double far)
{
    double x = ends[k], y = ends[n + k];
    Cubic curve = {{0.0, near * ends[2 * n + k], x - far * ends[4 * n + k], x},
                   {0.0, near * ends[3 * n + k], y - far * ends[5 * n + k], y}};
    return curve;
}

/* What is asked of handles: the steps, the tie, the shortest, the longest and the farthest step, as in cubic_fit.py. */
typedef struct {
    double steps, tie, shortest, longest, farthest;
} Rules;

/* The handles of one stretch after one step, as in _better_handles. The samples are (2, m). */
static void better(const double *ends, int64_t n, int64_t k, double length, int64_t first, int64_t after,
                   const double *weight, const double *x, const double *y, const double *t, int64_t m,
                   const Rules *rules, double *near, double *far)
{
    Cubic curve = curve_of(ends, n, k, *near, *far);
    double a = 0.0, b = 0.0, mixed = 0.0, u = 0.0, v = 0.0, third = length / 3.0, det, most, low, high;
    int64_t i;
    int j;
    for (i = first; i < after; i++) {
        double off[2], by_near[2], by_far[2];
        for (j = 0; j < 2; j++) {
            double at = t[j * m + i], s = 1.0 - at;
            Motion along = motion(curve.x, at), up = motion(curve.y, at);
            double speed = sqrt(along.speed * along.speed + up.speed * up.speed), nx, ny;
            speed = speed > 0.0 ? speed : 1.0;
            nx = -up.speed / speed;
            ny = along.speed / speed;
            off[j] = (x[j * m + i] - along.point) * nx + (y[j * m + i] - up.point) * ny;
            by_near[j] = 3.0 * s * s * at * (ends[2 * n + k] * nx + ends[3 * n + k] * ny);
            by_far[j] = -3.0 * s * at * at * (ends[4 * n + k] * nx + ends[5 * n + k] * ny);
        }
        a += weight[i] * (by_near[0] * by_near[0] + by_near[1] * by_near[1]);
        b += weight[i] * (by_far[0] * by_far[0] + by_far[1] * by_far[1]);
        mixed += weight[i] * (by_near[0] * by_far[0] + by_near[1] * by_far[1]);
        u += weight[i] * (by_near[0] * off[0] + by_near[1] * off[1]);
        v += weight[i] * (by_far[0] * off[0] + by_far[1] * off[1]);
    }
    a += rules->tie;
    b += rules->tie;
    u += rules->tie * (third - *near);
    v += rules->tie * (third - *far);
    det = a * b - mixed * mixed;
    most = rules->farthest * length;
    low = rules->shortest * length;
    high = rules->longest * length;
    *near = clipped(*near + clipped((b * u - mixed * v) / det, -most, most), low, high);
    *far = clipped(*far + clipped((a * v - mixed * u) / det, -most, most), low, high);
}

/* The handles of the curves that follow stretches, and the bounds on their distances.

   The ends are (6, n): where stretches end, and the unit tangents at both ends; `x` and `y` the parts, (4, m); the
   samples (2, m), with parameters `t` to begin from, which change. */
int64_t cubic_fits(int64_t n, const int64_t *first, const double *ends, const double *length, const int64_t *even,
                   int64_t m, const double *x, const double *y, const double *weight, const double *sample_x,
                   const double *sample_y, double *t, const double *rules, double *out_near, double *out_far,
                   double *out_bound)
{
    Rules all = {rules[0], rules[1], rules[2], rules[3], rules[4]};
    int64_t k, i;
    int step, again, j;
    for (k = 0; k < n; k++) {
        double near = length[k] / 3.0, far = near, most = 0.0, begin = 0.0;
        Cubic curve;
        for (step = 0; step < (int)all.steps; step++) {
            curve = curve_of(ends, n, k, near, far);
            for (again = 0; again < (step == 0 ? 2 : 1); again++)
                for (j = 0; j < 2; j++)
                    for (i = first[k]; i < first[k + 1]; i++)
                        t[j * m + i] = nearer(&curve, sample_x[j * m + i], sample_y[j * m + i], t[j * m + i]);
            better(ends, n, k, length[k], first[k], first[k + 1], weight, sample_x, sample_y, t, m, &all, &near, &far);
        }
        if (even[k])
            near = far = (near + far) / 2;
        curve = curve_of(ends, n, k, near, far);
        for (i = first[k]; i < first[k + 1]; i++) {
            double px[4], py[4], end = 1.0, off;
            for (j = 0; j < 4; j++) {
                px[j] = x[j * m + i];
                py[j] = y[j * m + i];
            }
            if (i + 1 < first[k + 1]) {
                end = t[i + 1];
                for (again = 0; again < 3; again++)
                    end = nearer(&curve, x[i + 1], y[i + 1], end);
            }
            off = distance(&curve, px, py, begin, end);
            most = i == first[k] || off > most || off != off ? off : most;
            begin = end;
        }
        out_near[k] = near;
        out_far[k] = far;
        out_bound[k] = most;
    }
    return 0;
}
