/* How far arcs are from stretches of curves: what biarc_bounds.py does for all parts of stretches, with the same
   operations in the same order. What needs sines and angles, of which there are a few a stretch, stays in Python.

   Arrays of several rows have these one after the other; parts are (4, m): row k holds the k-th control points. */

#include <math.h>
#include <stdint.h>

static double larger(double a, double b) { return a > b ? a : b; }

/* The larger of a maximum and a value; one that is no number stays, as in numpy's maximum. */
static double risen(double most, double value) { return value > most || value != value ? value : most; }

static double within(double value, double low, double high)
{
    value = value < low ? low : value;
    return value > high ? high : value;
}

/* The segment of a run and the parameter at a place, as in SmoothRuns.locate. */
static int64_t located(const double *begin, const double *size, int64_t first, int64_t after, double place, int before,
                       double snap, double *parameter)
{
    int64_t low = first, high = after, middle;
    double t;
    while (high - low > 1) { /* the last that begins up to the place, or the first */
        middle = low + (high - low) / 2;
        if (begin[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    t = within((place - begin[low]) / size[low], 0.0, 1.0);
    t = t < snap ? 0.0 : t > 1 - snap ? 1.0 : t;
    if (before && t == 0.0 && low > first) {
        low -= 1;
        t = 1.0;
    } else if (!before && t == 1.0 && low < after - 1) {
        low += 1;
        t = 0.0;
    }
    *parameter = t;
    return low;
}

/* How many parts a stretch has from t0 to t1 of a segment. */
static int64_t parts_of(double size, double t0, double t1, double length, double parts)
{
    return (int64_t)larger(ceil(parts * (size * (t1 - t0) / length) - 1e-9), 1.0);
}

/* Where stretches of runs begin and end: segment and parameter; the first part of each stretch (one more: of all). */
int64_t biarc_places(int64_t stretches, const int64_t *first, const double *begin, const double *size, const int64_t *run,
                     const double *low, const double *high, double snap, double parts, int64_t *out_segment,
                     double *out_parameter, int64_t *out_first)
{
    int64_t found = 0, k, s;
    for (k = 0; k < stretches; k++) {
        int64_t from = first[run[k]], after = first[run[k] + 1], one, last;
        double at, until, length = high[k] - low[k];
        one = located(begin, size, from, after, low[k], 0, snap, &at);
        last = located(begin, size, from, after, high[k], 1, snap, &until);
        last = last > one ? last : one;
        out_first[k] = found;
        for (s = one; s <= last; s++)
            found += parts_of(size[s], s == one ? at : 0.0, s == last ? until : 1.0, length, parts);
        out_segment[k] = one;
        out_segment[stretches + k] = last;
        out_parameter[k] = at;
        out_parameter[stretches + k] = until;
    }
    out_first[stretches] = found;
    return found;
}

static double point(const double *c, int64_t n, double t)
{
    return c[0] + t * (3 * c[n] + t * (3 * c[2 * n] + t * c[3 * n]));
}

/* The control points of a cubic between two parameters, seen from an origin, as in _between. */
static void between(const double *c, int64_t n, double origin, double t0, double t1, double *out, int64_t m)
{
    double base = c[0] - origin, sum = t0 + t1, product = t0 * t1, c1 = c[n], c2 = c[2 * n], c3 = c[3 * n];
    out[0] = base + t0 * (3 * c1 + t0 * (3 * c2 + t0 * c3));
    out[m] = base + c1 * (sum + t0) + c2 * (t0 * t0 + 2 * product) + c3 * (t0 * product);
    out[2 * m] = base + c1 * (sum + t1) + c2 * (t1 * t1 + 2 * product) + c3 * (t1 * product);
    out[3 * m] = base + t1 * (3 * c1 + t1 * (3 * c2 + t1 * c3));
}

/* The Bernstein coefficients of half the square of the distance from the origin, as in _squares. */
static void squared(const double *x, const double *y, int64_t m, double *out, int64_t step)
{
    double x0 = x[0], x1 = x[m], x2 = x[2 * m], x3 = x[3 * m], y0 = y[0], y1 = y[m], y2 = y[2 * m], y3 = y[3 * m];
    out[0] = (x0 * x0 + y0 * y0) / 2;
    out[step] = (x0 * x1 + y0 * y1) / 2;
    out[2 * step] = ((x0 * x2 + y0 * y2) * 2 + (x1 * x1 + y1 * y1) * 3) / 10;
    out[3 * step] = ((x0 * x3 + y0 * y3) + (x1 * x2 + y1 * y2) * 9) / 20;
    out[4 * step] = ((x1 * x3 + y1 * y3) * 2 + (x2 * x2 + y2 * y2) * 3) / 10;
    out[5 * step] = (x2 * x3 + y2 * y3) / 2;
    out[6 * step] = (x3 * x3 + y3 * y3) / 2;
}

/* Cut stretches into parts, n segments of runs into m parts: their control points, squares, and stretches. */
int64_t biarc_parts(int64_t stretches, int64_t n, const double *cx, const double *cy, const double *size,
                    const double *low, const double *high, double parts, const int64_t *segment,
                    const double *parameter, int64_t m, double *x, double *y, double *squares, int64_t *stretch)
{
    int64_t i = 0, k, s, number;
    for (k = 0; k < stretches; k++) {
        int64_t one = segment[k], last = segment[stretches + k];
        double at = parameter[k], until = parameter[stretches + k], length = high[k] - low[k];
        double ox = point(cx + one, n, at), oy = point(cy + one, n, at);
        for (s = one; s <= last; s++) {
            double t0 = s == one ? at : 0.0, t1 = s == last ? until : 1.0;
            int64_t count = parts_of(size[s], t0, t1, length, parts);
            double step = (t1 - t0) / (double)count;
            for (number = 0; number < count; number++, i++) {
                double from = t0 + (double)number * step, to = t0 + (double)(number + 1) * step;
                between(cx + s, n, ox, from, to, x + i, m);
                between(cy + s, n, oy, from, to, y + i, m);
                squared(x + i, y + i, m, squares + i, m);
                stretch[i] = k;
            }
        }
    }
    return i;
}

typedef struct {
    double curvature, x, y, shift;
} Circle;

/* Circle k of n. */
static Circle circle_at(const double *circles, int64_t n, int64_t k)
{
    Circle circle = {circles[k], circles[n + k], circles[2 * n + k], circles[3 * n + k]};
    return circle;
}

/* The bound on the distance of a cubic from a circle, as in _values and _distances; also the values at its ends. */
static double distance(const double *x, const double *y, int64_t m, const double *squares, int64_t step, Circle circle,
                       double *begins, double *ends)
{
    double f[4], v[7], size[3], cross[3], most = 0.0, bend = fabs(circle.curvature), room, rest;
    double gx = circle.curvature * x[0] - circle.x, gy = circle.curvature * y[0] - circle.y;
    int k, onward = 1;
    for (k = 0; k < 4; k++)
        f[k] = circle.shift - circle.x * x[k * m] - circle.y * y[k * m];
    for (k = 0; k < 7; k++)
        v[k] = circle.curvature * squares[k * step];
    v[0] += f[0];
    v[1] += (f[0] + f[1]) / 2;
    v[2] += (f[0] + 3 * f[1] + f[2]) / 5;
    v[3] += (f[0] + f[3] + 9 * (f[1] + f[2])) / 20;
    v[4] += (f[1] + 3 * f[2] + f[3]) / 5;
    v[5] += (f[2] + f[3]) / 2;
    v[6] += f[3];
    *begins = v[0];
    *ends = v[6];
    for (k = 0; k < 7; k++)
        most = risen(most, fabs(v[k]));
    for (k = 0; k < 3; k++) {
        double vx = x[(k + 1) * m] - x[k * m], vy = y[(k + 1) * m] - y[k * m];
        size[k] = sqrt(vx * vx + vy * vy);
        cross[k] = vy * gx - vx * gy;
    }
    rest = bend * (size[0] + size[1] + size[2]);
    for (k = 0; k < 3; k++)
        onward = onward && cross[k] >= size[k] * rest;
    room = 1 - 2 * bend * most;
    return onward && room >= 0.0 ? 2 * most / (1 + sqrt(room)) : INFINITY;
}

/* The bounds for one arc and for one line over each stretch, how far the curve lies on the other side of the chord, and
   the values of the circle's equation at the ends of parts. `side` is the sign of the arc's angle. */
int64_t biarc_single(int64_t stretches, const int64_t *first, int64_t m, const double *x, const double *y,
                     const double *squares, const double *circles, const double *ux, const double *uy,
                     const double *chord, const double *side, double *out_arc, double *out_line, double *out_beyond,
                     double *out_begins, double *out_ends)
{
    int64_t k, i;
    int j;
    for (k = 0; k < stretches; k++) {
        Circle circle = circle_at(circles, stretches, k);
        double arc = 0.0, line = 0.0, most = -INFINITY;
        for (i = first[k]; i < first[k + 1]; i++) {
            arc = risen(arc, distance(x + i, y + i, m, squares + i, m, circle, out_begins + i, out_ends + i));
            for (j = 0; j < 4; j++) {
                double px = x[j * m + i], py = y[j * m + i];
                double across = ux[k] * py - uy[k] * px, along = ux[k] * px + uy[k] * py;
                double past = larger(larger(-along, along - chord[k]), 0.0);
                most = risen(most, -across * side[k]);
                line = risen(line, sqrt(across * across + past * past));
            }
        }
        out_arc[k] = arc;
        out_line[k] = line;
        out_beyond[k] = most;
    }
    return 0;
}

/* About where a cubic passes 0 upwards, as in _root. */
static double root(const double *b)
{
    double rise = b[3] - b[0], t = within(-b[0] / (rise > 0.0 ? rise : 1.0), 0.0, 1.0);
    double c1 = 3 * (b[1] - b[0]), c2 = 3 * (b[0] - 2 * b[1] + b[2]), c3 = rise + 3 * (b[1] - b[2]);
    int k;
    for (k = 0; k < 2; k++) {
        double slope = c1 + t * (2 * c2 + t * (3 * c3));
        t = within(t - (b[0] + t * (c1 + t * (c2 + t * c3))) / (slope > 0.0 ? slope : 1.0), 0.0, 1.0);
    }
    return t;
}

/* Cut a cubic in two, as in _halves. */
static void halved(const double *b, int64_t m, double t, double *left, double *right)
{
    double b0 = b[0], b1 = b[m], b2 = b[2 * m], b3 = b[3 * m];
    double p01 = b0 + t * (b1 - b0), p12 = b1 + t * (b2 - b1), p23 = b2 + t * (b3 - b2);
    double p02 = p01 + t * (p12 - p01), p13 = p12 + t * (p23 - p12), middle = p02 + t * (p13 - p02);
    left[0] = b0;
    left[1] = p01;
    left[2] = p02;
    left[3] = right[0] = middle;
    right[1] = p13;
    right[2] = p23;
    right[3] = b3;
}

/* The joint of a biarc, and the tangent there. */
typedef struct {
    double x, y, tx, ty;
} Joint;

static double along_of(Joint joint, double x, double y) { return (x - joint.x) * joint.tx + (y - joint.y) * joint.ty; }

/* The bound on the distance of a cubic from one arc of a biarc: on the wrong side of the joint it is farther. */
static double off(const double *x, const double *y, int64_t m, const double *squares, int64_t step, Circle circle,
                  Joint joint, int late)
{
    double begins, ends, astray = 0.0, found = distance(x, y, m, squares, step, circle, &begins, &ends);
    int j;
    for (j = 0; j < 4; j++) {
        double along = along_of(joint, x[j * m], y[j * m]);
        astray = risen(astray, late ? -along : along);
    }
    return found + (fabs(circle.curvature) * astray <= 0.25 ? astray : INFINITY);
}

/* The bounds for both arcs of a biarc over each stretch. The part that crosses the normal at the joint is cut there. */
int64_t biarc_double(int64_t stretches, const int64_t *first, int64_t m, const double *x, const double *y,
                     const double *squares, const double *circles1, const double *circles2, const double *joint_x,
                     const double *joint_y, const double *tx, const double *ty, double *out_error1, double *out_error2)
{
    int64_t k, i, cut;
    int j;
    for (k = 0; k < stretches; k++) {
        Circle one = circle_at(circles1, stretches, k), two = circle_at(circles2, stretches, k);
        Joint joint = {joint_x[k], joint_y[k], tx[k], ty[k]};
        double along[4], t, left_x[4], left_y[4], right_x[4], right_y[4], left[7], right[7], error1, error2;
        for (cut = first[k]; cut < first[k + 1] - 1; cut++)
            if (along_of(joint, x[3 * m + cut], y[3 * m + cut]) > 0.0)
                break;
        for (j = 0; j < 4; j++)
            along[j] = along_of(joint, x[j * m + cut], y[j * m + cut]);
        t = root(along);
        halved(x + cut, m, t, left_x, right_x);
        halved(y + cut, m, t, left_y, right_y);
        squared(left_x, left_y, 1, left, 1);
        squared(right_x, right_y, 1, right, 1);
        error1 = risen(0.0, off(left_x, left_y, 1, left, 1, one, joint, 0));
        error2 = risen(0.0, off(right_x, right_y, 1, right, 1, two, joint, 1));
        for (i = first[k]; i < cut; i++)
            error1 = risen(error1, off(x + i, y + i, m, squares + i, m, one, joint, 0));
        for (i = cut + 1; i < first[k + 1]; i++)
            error2 = risen(error2, off(x + i, y + i, m, squares + i, m, two, joint, 1));
        out_error1[k] = error1;
        out_error2[k] = error2;
    }
    return 0;
}
