/* What bounds the Voronoi cells of the sites' elements: `bound_cells` of cells.py, row by row.

   The reference is the numpy code beside this file (candidates.py, provisional.py, bisectors.py, envelope.py, cells.py),
   where the method is explained; names are the same. What comes out is the same bit for bit: every sum and product is
   rounded as there (no contraction, no reordering), every test and every tie is decided as there. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define SLACK 1e-9
#define INFINITE 1e100
#define STEEPEST 1e18
#define TINY 1e-6
#define NEAR 1e-3
#define EPSILON 2.220446049250313e-16
#define NOTHING (-1)
#define FEW 64

#define UNBOUNDED (-1)
#define TOUCHING (-2)
#define NO_MEMORY (-3)

typedef struct {
    double x, y;
} point;

typedef struct {
    /* rows */
    const int64_t *half_edge, *corner;
    const point *origin, *axis;
    const double *low, *high;
    const point *base0, *ray0, *base1, *ray1, *base, *ray;
    const double *spread;
    /* contour, of so many half-edges */
    int64_t half_edges;
    const point *node;
    const int64_t *source, *target;
    const point *direction;
    const double *length;
    const int64_t *corner_node;
    const point *arriving, *leaving;
    const double *turn;
    const uint8_t *bounding;
    /* copies */
    int64_t copies, bundles;
    const point *unit, *shift;
    const uint8_t *conj;
    const int64_t *bundle;
    /* hierarchy */
    int64_t levels;
    const point *start, *end;
    const double *radius;
    const point *anchor_start, *anchor_end;
    const int64_t *box_bundle, *child, *level, *element;
    double covering_radius;
    double rounding; /* set with the pairs of the first level */
} input;

/* numpy's minimum and maximum hand NaN on. */
static double least(double a, double b) { return a <= b || a != a ? a : b; }
static double most(double a, double b) { return a >= b || a != a ? a : b; }
static double middle_of(double low, double value, double high) { return least(most(value, low), high); }

/* A copy's isometry: unit z + shift, of conj(z) where `sign` is -1. */
typedef struct {
    double ux, uy, sx, sy, sign;
} isometry;

static isometry of_copy(const input *in, int64_t copy)
{
    isometry r = {in->unit[copy].x, in->unit[copy].y, in->shift[copy].x, in->shift[copy].y, in->conj[copy] ? -1.0 : 1.0};
    return r;
}

static point move(isometry to, point z)
{
    double y = to.sign * z.y;
    point r = {to.ux * z.x - to.uy * y + to.sx, to.uy * z.x + to.ux * y + to.sy};
    return r;
}

static point moved(const input *in, int64_t copy, point z) { return move(of_copy(in, copy), z); }

/* The direction of a half-edge in a copy; one that is turned over runs through it backwards. */
static point turned(const input *in, int64_t copy, point z)
{
    point unit = in->unit[copy], r;
    double y = z.y;
    if (in->conj[copy]) {
        unit.x = -unit.x;
        unit.y = -unit.y;
        y = -y;
    }
    r.x = unit.x * z.x - unit.y * y + 0.0;
    r.y = unit.y * z.x + unit.x * y + 0.0;
    return r;
}

static point minus(point a, point b)
{
    point r = {a.x - b.x, a.y - b.y};
    return r;
}

static int same(point a, point b) { return a.x == b.x && a.y == b.y; }

/* The coordinates of vectors along and to the left of unit vectors. */
static double along_of(point axis, point v) { return axis.x * v.x + axis.y * v.y; }
static double left_of(point axis, point v) { return axis.x * v.y - axis.y * v.x; }

/* The height at which a ray meets the bisector of its base and a point, as a fraction; infinite where `below` is not
   above 0. Most of them are too high, which is plain without a division. */
typedef struct {
    double above, below;
} ratio;

static ratio bisector_ratio(point base, point ray, point z, double rounding)
{
    point away = minus(z, base);
    ratio r = {away.x * away.x + away.y * away.y, 2.0 * (away.x * ray.x + away.y * ray.y - rounding)};
    return r;
}

static double quotient(ratio r) { return r.below > 0.0 ? r.above / r.below : INFINITY; }

static int exceeds(ratio r, double height) { return !(r.below > 0.0) || r.above > r.below * height * (1.0 + SLACK); }

static double bisector(point base, point ray, point z, double rounding)
{
    return quotient(bisector_ratio(base, ray, z, rounding));
}

static double bisector_of_segment(point base, point ray, point start, point end, double rounding)
{
    double height = least(bisector(base, ray, start, rounding), bisector(base, ray, end, rounding));
    point chord = minus(end, start), away = minus(base, start);
    double square = chord.x * chord.x + chord.y * chord.y, length = sqrt(square);
    double distance = (chord.x * away.y - chord.y * away.x) / length;
    double sign = distance > 0.0 ? 1.0 : distance < 0.0 ? -1.0 : distance;
    double growth = (chord.x * ray.y - chord.y * ray.x) / length * sign;
    double touching = fabs(distance) / (1.0 - growth);
    double foot = chord.x * (away.x + touching * ray.x) + chord.y * (away.y + touching * ray.y);
    if (foot >= 0.0 && foot <= square && fabs(distance) > rounding / SLACK && growth < 1.0 - SLACK)
        return least(height, touching);
    return height;
}

/* A box's length and direction, any for a point; and a disc that holds it, but for rounding. */
typedef struct {
    double length;
    point direction, middle;
    double radius;
} box;

static box box_of(const input *in, int64_t place)
{
    point start = in->start[place], end = in->end[place], chord = minus(end, start);
    double inverse;
    box d;
    d.length = sqrt(chord.x * chord.x + chord.y * chord.y);
    inverse = d.length > 0.0 ? 1.0 / d.length : 0.0;
    d.direction.x = chord.x * inverse + (d.length == 0.0);
    d.direction.y = chord.y * inverse;
    d.middle.x = (start.x + end.x) / 2;
    d.middle.y = (start.y + end.y) / 2;
    d.radius = d.length / 2 + in->radius[place];
    return d;
}

/* --- The provisional envelope of one row --- */

typedef struct {
    const input *in;
    int64_t row;
    int straight;
    double middle, low, high;
    double lowest[3];
    point point_[3], inner;
    /* bounds */
    double height;
    point envelope[3];
    double cut[2];
    point centre[4];
    double reach[4];
    point around_middle;
    double around;
} provisional;

static const point NO_POINT = {NAN, 0.0};

static void begin_row(provisional *p, const input *in, int64_t row)
{
    int k;
    p->in = in;
    p->row = row;
    p->straight = in->corner[row] < 0;
    p->middle = p->straight ? (in->low[row] + in->high[row]) / 2.0 : 0.0;
    p->low = in->low[row] - p->middle;
    p->high = in->high[row] - p->middle;
    for (k = 0; k < 3; k++) {
        p->lowest[k] = INFINITY;
        p->point_[k] = p->envelope[k] = NO_POINT;
    }
    p->inner = NO_POINT;
    for (k = 0; k < 4; k++) {
        p->centre[k] = in->base[row];
        p->reach[k] = INFINITY;
    }
    p->around_middle = in->base[row];
    p->around = INFINITY;
    p->height = in->covering_radius;
    p->cut[0] = in->low[row];
    p->cut[1] = in->high[row];
}

static int is_wide(const provisional *p) { return p->in->spread[p->row] > p->height / 8.0; }

/* The ray at t: where it starts and its unit direction. */
static void ray_at(const provisional *p, double t, point *start, point *ray)
{
    point axis = p->in->axis[p->row], base = p->in->base[p->row];
    double scale = p->straight ? 1.0 : 1.0 + t * t;
    double along = p->straight ? 0.0 : (1.0 - t * t) / scale, across = p->straight ? 1.0 : 2.0 * t / scale;
    double step = p->straight ? t : 0.0;
    start->x = base.x + step * axis.x;
    start->y = base.y + step * axis.y;
    ray->x = along * axis.x - across * axis.y;
    ray->y = along * axis.y + across * axis.x;
}

/* The coefficients of t^2, t and 1 of the row's bisector with a point. */
static void quadratic_of(const provisional *p, point z, double *r)
{
    point axis = p->in->axis[p->row], away = minus(z, p->in->base[p->row]);
    double x = along_of(axis, away), y = left_of(axis, away), square = x * x + y * y;
    double scale = p->straight ? 0.5 / y : 2.0 / square;
    r[0] = p->straight ? scale : scale * x;
    r[1] = -2.0 * scale * (p->straight ? x : y);
    r[2] = scale * (p->straight ? square : -x);
}

static double crossing(const double *f, const double *g, double low, double high)
{
    double a = f[0] - g[0], b = f[1] - g[1], c = f[2] - g[2];
    double root = sqrt(b * b - 4.0 * a * c);
    double t = b >= 0.0 ? -2.0 * c / (b + root) : (root - b) / (2.0 * a);
    if (t != t)
        t = (low + high) / 2.0;
    return middle_of(low, t, high);
}

static double heights_of(const provisional *p, const point *base, const point *ray, double *heights)
{
    double rounding = p->in->rounding, before[3], after[3];
    int k;
    for (k = 0; k < 3; k++) {
        before[k] = bisector(base[k + 1], ray[k + 1], p->envelope[k], rounding);
        after[k] = bisector(base[k], ray[k], p->envelope[k], rounding);
    }
    heights[0] = after[0];
    heights[1] = most(before[0], after[1]);
    heights[2] = most(before[1], after[2]);
    heights[3] = before[2];
    return most(most(most(heights[0], heights[1]), heights[2]), heights[3]);
}

/* Take note of points and tighten the bounds; whether these have changed. */
static int lower(provisional *p, const point *points, int64_t count)
{
    const input *in = p->in;
    int64_t row = p->row, i;
    double rounding = in->rounding, ends[2][3], inner[3], between, best, other, cut[2], heights[4], highest, width[3];
    point base[4], ray[4];
    double x0, x1, y0, y1, around;
    int k, changed = 0;
    for (i = 0; i < count; i++) {
        ratio one = bisector_ratio(in->base0[row], in->ray0[row], points[i], rounding);
        ratio two = bisector_ratio(in->base1[row], in->ray1[row], points[i], rounding);
        double value[3];
        if (exceeds(one, p->lowest[0]) && exceeds(two, p->lowest[1]) &&
            (exceeds(one, p->lowest[2]) || exceeds(two, p->lowest[2])))
            continue;
        value[0] = quotient(one);
        value[1] = quotient(two);
        value[2] = most(value[0], value[1]);
        for (k = 0; k < 3; k++)
            if (value[k] <= p->lowest[k] && value[k] < INFINITY) {
                p->lowest[k] = value[k];
                changed |= !same(p->point_[k], points[i]);
                p->point_[k] = points[i];
            }
    }
    quadratic_of(p, p->point_[0], ends[0]);
    quadratic_of(p, p->point_[1], ends[1]);
    between = crossing(ends[0], ends[1], p->low, p->high);
    ray_at(p, between, &base[0], &ray[0]);
    best = bisector(base[0], ray[0], p->inner, rounding);
    other = bisector(base[0], ray[0], p->point_[2], rounding);
    if (other <= best) {
        best = other;
        changed |= !same(p->inner, p->point_[2]);
        p->inner = p->point_[2];
    }
    for (i = 0; i < count; i++) {
        ratio here = bisector_ratio(base[0], ray[0], points[i], rounding);
        double value;
        if (exceeds(here, best))
            continue;
        value = quotient(here);
        if (value <= best && value < INFINITY) {
            best = value;
            changed |= !same(p->inner, points[i]);
            p->inner = points[i];
        }
    }
    if (!changed)
        return 0;
    quadratic_of(p, p->inner, inner);
    cut[0] = crossing(ends[0], inner, p->low, between);
    cut[1] = crossing(inner, ends[1], between, p->high);
    p->envelope[0] = p->point_[0];
    p->envelope[1] = p->inner;
    p->envelope[2] = p->point_[1];
    base[0] = in->base0[row];
    ray[0] = in->ray0[row];
    ray_at(p, cut[0], &base[1], &ray[1]);
    ray_at(p, cut[1], &base[2], &ray[2]);
    base[3] = in->base1[row];
    ray[3] = in->ray1[row];
    highest = heights_of(p, base, ray, heights);
    if (highest == INFINITY) {
        for (k = 0; k < 3; k++)
            p->envelope[k] = p->point_[2];
        highest = heights_of(p, base, ray, heights);
    }
    p->height = least(p->height, highest);
    p->cut[0] = cut[0] + p->middle;
    p->cut[1] = cut[1] + p->middle;
    width[0] = cut[0] - p->low;
    width[1] = cut[1] - cut[0];
    width[2] = p->high - cut[1];
    x0 = y0 = INFINITY;
    x1 = y1 = -INFINITY;
    for (k = 0; k < 4; k++) {
        double half = k == 0 ? width[0] : k == 3 ? width[2] : most(width[k - 1], width[k]);
        double height = heights[k];
        half *= p->straight ? 0.5 : 0.0;
        p->reach[k] = sqrt(height * height + half * half) * (1.0 + SLACK);
        if (height == INFINITY)
            height = 0.0;
        p->centre[k].x = base[k].x + height * ray[k].x;
        p->centre[k].y = base[k].y + height * ray[k].y;
        x0 = least(x0, p->centre[k].x - p->reach[k]);
        x1 = most(x1, p->centre[k].x + p->reach[k]);
        y0 = least(y0, p->centre[k].y - p->reach[k]);
        y1 = most(y1, p->centre[k].y + p->reach[k]);
    }
    p->around_middle.x = highest < INFINITY ? (x0 + x1) / 2.0 : 0.0;
    p->around_middle.y = highest < INFINITY ? (y0 + y1) / 2.0 : 0.0;
    around = -INFINITY;
    for (k = 0; k < 4; k++) {
        point away = minus(p->centre[k], p->around_middle);
        around = most(around, sqrt(away.x * away.x + away.y * away.y) + p->reach[k]);
    }
    p->around = around * (1.0 + SLACK);
    return 1;
}

/* --- Candidates --- */

typedef struct {
    int64_t copy, place;
    point start, direction;
    double length, radius;
} pair;

/* Whether a box is within reach of a centre. */
static int meets(point centre, double reach, const pair *c)
{
    point away = minus(centre, c->start);
    double along = away.x * c->direction.x + away.y * c->direction.y;
    double across = fabs(away.x * c->direction.y - away.y * c->direction.x);
    double x = -along > along - c->length ? -along : along - c->length, y = across - c->radius;
    x = x > 0.0 ? x : 0.0;
    y = y > 0.0 ? y : 0.0;
    return x * x + y * y <= reach * reach;
}

static int enters_box(double x0, double y0, double x1, double y1, double width, double low, double high)
{
    double enter = 0.0, leave = 1.0;
    double at[2] = {x0, y0}, step[2] = {x1 - x0, y1 - y0}, floor_[2] = {-width, low}, ceiling[2] = {width, high};
    int k;
    for (k = 0; k < 2; k++) {
        if (step[k] == 0.0) {
            enter = most(enter, at[k] >= floor_[k] && at[k] <= ceiling[k] ? 0.0 : 2.0);
            leave = least(leave, 1.0);
        } else {
            double one = (floor_[k] - at[k]) / step[k], two = (ceiling[k] - at[k]) / step[k];
            enter = most(enter, least(one, two));
            leave = least(leave, most(one, two));
        }
    }
    return enter <= leave + SLACK;
}

static int in_reach(const provisional *p, const pair *c, int wide)
{
    const input *in = p->in;
    if (!meets(p->around_middle, p->around, c))
        return 0;
    if (!(meets(p->centre[0], p->reach[0], c) || meets(p->centre[1], p->reach[1], c) ||
          meets(p->centre[2], p->reach[2], c) || meets(p->centre[3], p->reach[3], c)))
        return 0;
    if (wide) {
        double width = c->radius * (1.0 + SLACK), reach = p->height * (1.0 + SLACK);
        point origin = in->base[p->row], ray = in->ray[p->row];
        point one = minus(c->start, origin), two = minus(moved(in, c->copy, in->end[c->place]), origin);
        return enters_box(one.x * ray.y - one.y * ray.x, one.x * ray.x + one.y * ray.y,
                          two.x * ray.y - two.y * ray.x, two.x * ray.x + two.y * ray.y,
                          in->spread[p->row] + reach + width, -width, 2.0 * reach + width);
    }
    return 1;
}

static void set_pair(const input *in, pair *c, isometry to, const box *d, int64_t copy, int64_t place)
{
    isometry turn = {to.ux, to.uy, 0.0, 0.0, to.sign};
    c->copy = copy;
    c->place = place;
    c->start = move(to, in->start[place]);
    c->direction = move(turn, d->direction);
    c->length = d->length;
    c->radius = in->radius[place];
}

/* Whether a box is so far from the disc that holds what matters that `in_reach` is not worth asking. */
static int is_far(const provisional *p, isometry to, const box *d)
{
    point away = minus(move(to, d->middle), p->around_middle);
    double reach = (p->around + d->radius + p->in->rounding) * (1.0 + SLACK);
    return away.x * away.x + away.y * away.y > reach * reach;
}

/* --- Buffers that grow --- */

typedef struct {
    double a, b, c, m, low, high;
    int64_t copy, item;
} function;

typedef struct {
    double start;
    int64_t lowest;
} part;

typedef struct {
    pair *pair[2];
    int64_t pairs[2];
    point *anchor;
    int64_t anchors;
    function *function, *wrapped;
    int64_t functions, wraps;
    part *part[2];
    int64_t *offset[2];
    int64_t parts, offsets;
    box *box;
    int64_t *place;
    pair *top;
    int64_t tops;
} work;

static int grow(void *buffer, int64_t *capacity, int64_t needed, size_t size)
{
    int64_t more = *capacity * 2 > needed ? *capacity * 2 : needed;
    void *items; /* copied: no pointer may be read as one of another type */
    if (needed <= *capacity)
        return 1;
    memcpy(&items, buffer, sizeof items);
    items = realloc(items, (size_t)more * size);
    if (!items)
        return 0;
    memcpy(buffer, &items, sizeof items);
    *capacity = more;
    return 1;
}

static void release(work *w)
{
    int k;
    for (k = 0; k < 2; k++) {
        free(w->pair[k]);
        free(w->part[k]);
        free(w->offset[k]);
    }
    free(w->anchor);
    free(w->box);
    free(w->place);
    free(w->top);
    free(w->function);
    free(w->wrapped);
}

static void swap(work *w)
{
    pair *other = w->pair[0];
    int64_t room = w->pairs[0];
    w->pair[0] = w->pair[1];
    w->pairs[0] = w->pairs[1];
    w->pair[1] = other;
    w->pairs[1] = room;
}

/* The pairs with which every row begins, the boxes of the first level in all copies; and by how much coordinates, and
   their differences, may be off: 16 ulps of the largest. */
static int set_tops(work *w, input *in)
{
    int64_t copy, k, room = 0;
    double farthest = 0.0;
    for (copy = 0; copy < in->copies; copy++)
        for (k = in->level[0]; k < in->level[1]; k++)
            if (in->box_bundle[k] == in->bundle[copy]) {
                point start;
                if (!grow(&w->top, &room, w->tops + 1, sizeof(pair)))
                    return 0;
                set_pair(in, &w->top[w->tops], of_copy(in, copy), &w->box[k], copy, k);
                start = w->top[w->tops++].start;
                farthest = most(farthest, sqrt(start.x * start.x + start.y * start.y));
            }
    in->rounding = 16.0 * EPSILON * farthest;
    return 1;
}

/* Begin a corner's row with the ends of elements beside its own in the hierarchy's order. */
static void seed(const work *w, provisional *p)
{
    static const int64_t BESIDE[4] = {-2, -1, 1, 2};
    const input *in = p->in;
    int64_t first = in->level[in->levels - 1], count = in->level[in->levels] - first, corner = in->corner[p->row];
    int64_t element = corner < in->half_edges ? corner >> 1 : in->half_edges / 2 + (corner - in->half_edges) / 4;
    point ends[8];
    int k;
    for (k = 0; k < 4; k++) {
        int64_t place = w->place[element] + BESIDE[k];
        place = first + (place < 0 ? 0 : place > count - 1 ? count - 1 : place);
        ends[2 * k] = in->start[place];
        ends[2 * k + 1] = in->end[place];
    }
    lower(p, ends, 8);
}

/* The pairs that may shape the row's cell, in w->pair[0]; their number, or an error. */
static int64_t find_candidates(work *w, provisional *p)
{
    const input *in = p->in;
    int64_t count = 0, level, i, k;
    if (!p->straight && in->level[in->levels] - in->level[in->levels - 1] > FEW)
        seed(w, p);
    for (level = 0; level < in->levels; level++) {
        int leaf = level == in->levels - 1, wide, changed;
        int64_t found = 0, anchors = 0;
        pair *next;
        if (level == 0) {
            found = w->tops;
            if (!grow(&w->pair[1], &w->pairs[1], found, sizeof(pair)))
                return NO_MEMORY;
            memcpy(w->pair[1], w->top, (size_t)found * sizeof(pair));
        } else {
            wide = is_wide(p);
            for (i = 0; i < count; i++) {
                int64_t first = in->child[w->pair[0][i].place], last = in->child[w->pair[0][i].place + 1];
                isometry to = of_copy(in, w->pair[0][i].copy);
                if (!grow(&w->pair[1], &w->pairs[1], found + last - first, sizeof(pair)))
                    return NO_MEMORY;
                for (k = first; k < last; k++)
                    if (!is_far(p, to, &w->box[k])) {
                        set_pair(in, &w->pair[1][found], to, &w->box[k], w->pair[0][i].copy, k);
                        found += in_reach(p, &w->pair[1][found], wide);
                    }
            }
        }
        next = w->pair[1];
        if (!grow(&w->anchor, &w->anchors, 2 * found, sizeof(point)))
            return NO_MEMORY;
        for (i = 0; i < found; i++) {
            isometry to = of_copy(in, next[i].copy);
            w->anchor[anchors++] = leaf ? next[i].start : move(to, in->anchor_start[next[i].place]);
            if (!leaf)
                w->anchor[anchors++] = move(to, in->anchor_end[next[i].place]);
        }
        changed = lower(p, w->anchor, anchors);
        if ((level > 0 || leaf) && is_wide(p)) { /* segments bound well what points do not */
            double height = p->height;
            for (i = 0; i < found; i++) {
                int64_t row = p->row;
                point start = w->anchor[leaf ? i : 2 * i];
                point end = leaf ? moved(in, next[i].copy, in->end[next[i].place]) : w->anchor[2 * i + 1];
                double one = bisector_of_segment(in->base0[row], in->ray0[row], start, end, in->rounding);
                double two = bisector_of_segment(in->base1[row], in->ray1[row], start, end, in->rounding);
                height = least(height, most(one, two));
            }
            changed |= height != p->height;
            p->height = height;
        }
        wide = is_wide(p);
        count = 0;
        if (level > 0 && !changed) { /* all passed this test before */
            swap(w);
            count = found;
            continue;
        }
        if (!grow(&w->pair[0], &w->pairs[0], found, sizeof(pair)))
            return NO_MEMORY;
        for (i = 0; i < found; i++)
            if (in_reach(p, &next[i], wide))
                w->pair[0][count++] = next[i];
    }
    return count;
}

/* --- Bisectors --- */

static double bisecting_slope(double cosine, double sine, double infinite)
{
    if (sine == 0.0 && cosine > 0.0)
        return infinite;
    return cosine < 0.0 ? -sine / (1.0 - cosine) : -(1.0 + cosine) / sine;
}

static double touching_ray(point direction, point axis, point v, double square, double infinite)
{
    double along = direction.x * axis.x - direction.y * axis.y, across = direction.x * axis.y + direction.y * axis.x;
    double real = (v.x - v.y) * (v.x + v.y), imag = 2.0 * v.x * v.y;
    double cosine = across * real - along * imag, sine = across * imag + along * real;
    if (sine == 0.0 && cosine < 0.0)
        return infinite;
    return cosine < 0.0 ? (square - cosine) / sine : sine / (square + cosine);
}

static double unswapped(double low, double high, int tiny) { return tiny && 1.0 + low * high < 0.0 ? low : high; }

static double value_of(const function *f, double x)
{
    double step = x - f->m;
    return f->c + step * (f->b + step * f->a);
}

static double slope_of(const function *f, double x) { return f->b + 2.0 * f->a * (x - f->m); }

/* Whether a function somewhere on [begin, end] falls below a limit, give or take a doubt. */
static int below(const function *f, const double *limit, double doubt, double begin, double end, int straight)
{
    double low = most(f->low, begin), high = least(f->high, end);
    double x = low - limit[3], y = high - limit[3];
    double limit_low = limit[2] + x * (limit[1] + x * limit[0]), limit_high = limit[2] + y * (limit[1] + y * limit[0]);
    double u = low - f->m, v = high - f->m;
    double over_low = f->c + u * (f->b + u * f->a) - limit_low, over_high = f->c + v * (f->b + v * f->a) - limit_high;
    double curvature = f->a - limit[0], slope = f->b + 2.0 * f->a * u - limit[1] - 2.0 * limit[0] * x;
    double step = -slope / (2.0 * curvature);
    double dip = curvature > 0.0 && step > 0.0 && step < high - low ? over_low + slope * step / 2.0 : over_low;
    double lowest = least(least(over_low, over_high), dip);
    double terms = fabs(limit_low) + fabs(limit_high) + (straight ? 0.0 : fabs(limit[0]) + fabs(limit[1]));
    return lowest <= (SLACK + doubt) * terms && low <= high;
}

typedef struct {
    double flat[4], part[3][4], doubt[3], ends[4];
    int bounded;
} limits;

static void set_limits(limits *l, const provisional *p)
{
    const input *in = p->in;
    point axis = in->axis[p->row];
    int k;
    l->flat[0] = p->straight ? 0.0 : -1.0 / p->height;
    l->flat[1] = l->flat[3] = 0.0;
    l->flat[2] = p->straight ? p->height : -1.0 / p->height;
    l->bounded = p->envelope[0].x == p->envelope[0].x;
    l->ends[0] = in->low[p->row];
    l->ends[1] = p->cut[0];
    l->ends[2] = p->cut[1];
    l->ends[3] = in->high[p->row];
    for (k = 0; k < 3; k++) {
        point away = minus(p->envelope[k], in->origin[p->row]);
        double x = along_of(axis, away), y = left_of(axis, away), square = away.x * away.x + away.y * away.y;
        if (p->straight) {
            l->part[k][0] = 0.5 / y;
            l->part[k][1] = 0.0;
            l->part[k][2] = y / 2.0;
            l->part[k][3] = x;
        } else {
            l->part[k][0] = 2.0 * x / square;
            l->part[k][1] = -4.0 * y / square;
            l->part[k][2] = -l->part[k][0];
            l->part[k][3] = 0.0;
        }
        l->doubt[k] = 4.0 * in->rounding / (p->straight ? y : sqrt(square));
    }
}

static int below_limits(const limits *l, const function *f, int straight)
{
    int k;
    if (!below(f, l->flat, 0.0, l->ends[0], l->ends[3], straight))
        return 0;
    if (!l->bounded)
        return 1;
    for (k = 0; k < 3; k++)
        if (below(f, l->part[k], l->doubt[k], l->ends[k], l->ends[k + 1], straight))
            return 1;
    return 0;
}

/* Add a function within the row, or where its ends are swapped and not by rounding, its two rays. */
static int add(work *w, const provisional *p, const limits *l, function f, int wraps, int64_t *count, int64_t *wrapped)
{
    double low = p->in->low[p->row], high = p->in->high[p->row];
    function second = f;
    if (wraps)
        f.high = INFINITY;
    f.low = most(f.low, low);
    f.high = least(f.high, high);
    if (f.low < f.high && below_limits(l, &f, p->straight)) {
        if (!grow(&w->function, &w->functions, *count + 1, sizeof(function)))
            return 0;
        w->function[(*count)++] = f;
    }
    if (wraps) {
        second.low = most(-INFINITY, low);
        second.high = least(second.high, high);
        if (second.low < second.high && below_limits(l, &second, p->straight)) {
            if (!grow(&w->wrapped, &w->wraps, *wrapped + 1, sizeof(function)))
                return 0;
            w->wrapped[(*wrapped)++] = second;
        }
    }
    return 1;
}

static int half_edge_with_half_edge(const provisional *p, int64_t copy, int64_t item, function *f)
{
    const input *in = p->in;
    int64_t row = p->row, half_edge = in->half_edge[row];
    int64_t start = in->conj[copy] ? in->target[item] : in->source[item];
    int64_t end = in->conj[copy] ? in->source[item] : in->target[item];
    point axis = in->axis[row], origin = in->origin[row], direction = turned(in, copy, in->direction[item]);
    point to1 = minus(moved(in, copy, in->node[start]), origin), to2 = minus(moved(in, copy, in->node[end]), origin);
    double p1 = along_of(axis, to1), q1 = left_of(axis, to1), p2 = along_of(axis, to2), q2 = left_of(axis, to2);
    double k = bisecting_slope(along_of(axis, direction), left_of(axis, direction), INFINITE);
    double s1, s2, half_square, foot;
    int at_start;
    if (copy < in->bundles) {
        if (item >> 1 == half_edge >> 1)
            return 0;
        if (start == in->target[half_edge]) {
            q1 = 0.0;
            p1 = in->length[half_edge];
        }
        if (end == in->target[half_edge]) {
            q2 = 0.0;
            p2 = in->length[half_edge];
        }
    }
    s1 = p1 + q1 * k;
    s2 = p2 + q2 * k;
    if (!(most(q1, q2) > 0.0 && fabs(k) < STEEPEST && s1 > in->low[row] && s2 < in->high[row]))
        return 0;
    half_square = (1.0 + k * k) / 2.0;
    at_start = q1 >= 0.0 && (q1 <= q2 || q2 < 0.0);
    f->a = 0.0;
    f->b = k;
    f->m = at_start ? s1 : s2;
    f->c = (at_start ? q1 : q2) * half_square;
    foot = f->m - f->c / k;
    f->low = q2 < 0.0 ? foot : s2;
    f->high = q1 < 0.0 ? foot : s1;
    return 1;
}

static int half_edge_with_corner(const provisional *p, int64_t copy, int64_t corner, function *f, int *wraps)
{
    const input *in = p->in;
    int64_t row = p->row, half_edge = in->half_edge[row], node = in->corner_node[corner];
    point axis = in->axis[row], away = minus(moved(in, copy, in->node[node]), in->origin[row]);
    double x = along_of(axis, away), y = left_of(axis, away), leaving, arriving;
    point before, after;
    int tiny;
    if (copy < in->bundles && (node == in->source[half_edge] || node == in->target[half_edge]))
        return 0;
    if (fabs(y) <= in->rounding) {
        double half_length = in->length[half_edge] / 2;
        if (fabs(x - half_length) <= half_length + in->rounding)
            return TOUCHING;
    }
    if (!(y > 0.0))
        return 0;
    before = turned(in, copy, in->conj[copy] ? in->leaving[corner] : in->arriving[corner]);
    after = turned(in, copy, in->conj[copy] ? in->arriving[corner] : in->leaving[corner]);
    leaving = bisecting_slope(along_of(axis, after), left_of(axis, after), -INFINITE);
    arriving = bisecting_slope(along_of(axis, before), left_of(axis, before), INFINITE);
    tiny = in->turn[corner] <= TINY;
    f->low = x + y * leaving;
    f->high = x + y * unswapped(leaving, arriving, tiny);
    f->a = 0.5 / y;
    f->b = 0.0;
    f->c = y / 2.0;
    f->m = x;
    *wraps = f->low > f->high && !tiny;
    return 1;
}

static int corner_with_half_edge(const provisional *p, int64_t copy, int64_t item, function *f, int *wraps)
{
    const input *in = p->in;
    int64_t row = p->row, here = in->corner_node[in->corner[row]];
    int64_t start = in->conj[copy] ? in->target[item] : in->source[item];
    int64_t end = in->conj[copy] ? in->source[item] : in->target[item];
    point axis = in->axis[row], origin = in->origin[row], direction = turned(in, copy, in->direction[item]);
    point to1 = minus(moved(in, copy, in->node[start]), origin), to2 = minus(moved(in, copy, in->node[end]), origin);
    double along1 = along_of(direction, to1), left1 = left_of(direction, to1);
    double along2 = along_of(direction, to2), left2 = left_of(direction, to2);
    double square1 = to1.x * to1.x + to1.y * to1.y, square2 = to2.x * to2.x + to2.y * to2.y;
    double distance = -(square1 < square2 ? left1 : left2), along, across, big, small, cosine, sine, root, scale;
    int tiny;
    if (!(distance > 0.0) || (copy < in->bundles && (start == here || end == here)))
        return 0;
    f->low = touching_ray(direction, axis, to1, square1, -INFINITE);
    f->high = touching_ray(direction, axis, to2, square2, INFINITE);
    tiny = distance * (along2 - along1) <= TINY * (distance * distance + along1 * along2);
    f->high = unswapped(f->low, f->high, tiny);
    along = along_of(axis, direction);
    across = left_of(axis, direction);
    big = sqrt((1.0 + fabs(across)) / 2.0);
    small = -along / 2.0;
    cosine = across >= 0.0 ? big : small / big;
    sine = across >= 0.0 ? small / big : big;
    f->m = least(most(f->low, in->low[row]), in->high[row]);
    root = cosine + f->m * sine;
    scale = -2.0 / distance;
    f->a = scale * sine * sine;
    f->b = 2.0 * scale * sine * root;
    f->c = scale * root * root;
    *wraps = f->low > f->high && !tiny;
    return 1;
}

static int corner_with_corner(const provisional *p, int64_t copy, int64_t corner, function *f, int *wraps)
{
    const input *in = p->in;
    int64_t row = p->row, node = in->corner_node[corner];
    point axis = in->axis[row], away = minus(moved(in, copy, in->node[node]), in->origin[row]), before, after;
    double square = away.x * away.x + away.y * away.y;
    int tiny;
    if (copy < in->bundles && node == in->corner_node[in->corner[row]])
        return 0;
    if (square <= in->rounding * in->rounding)
        return TOUCHING;
    before = turned(in, copy, in->conj[copy] ? in->leaving[corner] : in->arriving[corner]);
    after = turned(in, copy, in->conj[copy] ? in->arriving[corner] : in->leaving[corner]);
    f->low = touching_ray(before, axis, away, square, -INFINITE);
    f->high = touching_ray(after, axis, away, square, INFINITE);
    tiny = in->turn[corner] <= TINY;
    f->high = unswapped(f->low, f->high, tiny);
    f->a = 2.0 * along_of(axis, away) / square;
    f->b = -4.0 * left_of(axis, away) / square;
    f->c = -f->a;
    f->m = 0.0;
    *wraps = f->low > f->high && !tiny;
    return 1;
}

/* The items of an element: half-edge i, with corner i, or the corners of an isolated node. */
static void items_of(const input *in, int64_t place, int64_t *first, int64_t *count)
{
    int64_t element = in->element[place - in->level[in->levels - 1]], segments = in->half_edges / 2;
    *first = element < segments ? 2 * element : 4 * element - 2 * segments;
    *count = element < segments ? 2 : 4;
}

/* The bisectors of the row's element with its candidates, in w->function; their number, or an error. */
static int64_t find_bisectors(work *w, const provisional *p, int64_t pairs)
{
    const input *in = p->in;
    limits l;
    int64_t count = 0, i, item, first, some;
    int corners, status, touching = 0;
    set_limits(&l, p);
    for (corners = 0; corners < 2; corners++) {
        int64_t wrapped = 0;
        for (i = 0; i < pairs; i++) {
            int64_t copy = w->pair[0][i].copy;
            items_of(in, w->pair[0][i].place, &first, &some);
            for (item = first; item < first + some; item++) {
                function f;
                int wraps = 0;
                if (corners ? !in->bounding[item] : item >= in->half_edges)
                    continue;
                if (corners)
                    status = p->straight ? half_edge_with_corner(p, copy, item, &f, &wraps)
                                         : corner_with_corner(p, copy, item, &f, &wraps);
                else
                    status = p->straight ? half_edge_with_half_edge(p, copy, item, &f)
                                         : corner_with_half_edge(p, copy, item, &f, &wraps);
                touching |= status == TOUCHING;
                if (status != 1)
                    continue;
                f.copy = copy;
                f.item = corners ? in->half_edges + item : item;
                if (!add(w, p, &l, f, wraps, &count, &wrapped))
                    return NO_MEMORY;
            }
        }
        if (!grow(&w->function, &w->functions, count + wrapped, sizeof(function)))
            return NO_MEMORY;
        if (wrapped)
            memcpy(w->function + count, w->wrapped, (size_t)wrapped * sizeof(function));
        count += wrapped;
    }
    return touching ? TOUCHING : count;
}

/* --- The lower envelope --- */

/* Append a part; one without width is replaced, one of the same function continued. */
static int64_t push(part *out, int64_t first, int64_t count, double start, int64_t lowest)
{
    if (count > first && !(start > out[count - 1].start))
        count--;
    if (count > first && out[count - 1].lowest == lowest)
        return count;
    out[count].start = start;
    out[count].lowest = lowest;
    return count + 1;
}

/* Append the parts of an interval on which both envelopes have a function. */
static int64_t contest(const function *functions, int64_t one, int64_t two, double x0, double x1, part *out,
                       int64_t first, int64_t count)
{
    int64_t i = one < two ? one : two, j = one < two ? two : one;
    const function *f = functions + i, *g = functions + j;
    double middle = (x0 + x1) / 2, half = (x1 - x0) / 2;
    double v = value_of(f, middle) - value_of(g, middle), b = slope_of(f, middle) - slope_of(g, middle);
    double a = f->a - g->a, reach = fabs(b) * half + fabs(a) * half * half, q, r, s, low, high, at[2];
    int64_t who[2];
    int k, cuts;
#define LOWER(t) (v + (t) * (b + (t) * a) <= 0.0 ? i : j)
    if (!(fabs(v) <= reach))
        return push(out, first, count, x0, v <= 0.0 ? i : j);
    q = -0.5 * (b + copysign(sqrt(b * b - 4.0 * a * v), b));
    r = q / a;
    s = v / q;
    if (!(fabs(r) < half))
        r = NAN;
    if (!(fabs(s) < half))
        s = NAN;
    low = fmin(r, s);
    high = fmax(r, s);
    if (low != low)
        return push(out, first, count, x0, v <= 0.0 ? i : j);
    cuts = high > low ? 2 : 1;
    at[0] = middle + low;
    at[1] = middle + high;
    who[0] = high > low ? LOWER((low + high) / 2) : LOWER((low + half) / 2);
    who[1] = LOWER((high + half) / 2);
    reach = NEAR * (high > low ? least(high - low, half) : half);
    for (k = 0; k < cuts; k++) {
        double step = (value_of(f, at[k]) - value_of(g, at[k])) / (slope_of(f, at[k]) - slope_of(g, at[k]));
        if (fabs(step) <= reach)
            at[k] -= step;
        at[k] = middle_of(x0, at[k], x1);
    }
    count = push(out, first, count, x0, LOWER((low - half) / 2));
    k = cuts == 2 && at[1] < at[0];
    count = push(out, first, count, at[k], who[k]);
    if (cuts == 2)
        count = push(out, first, count, at[1 - k], who[1 - k]);
#undef LOWER
    return count;
}

/* Append the lower envelope of two, a and b, from out[first] on. */
static int64_t merge(const function *functions, const part *a, int64_t na, const part *b, int64_t nb, double high,
                     part *out, int64_t first)
{
    int64_t count = first, i = 0, j = 0, one = NOTHING, two = NOTHING;
    while (i < na || j < nb) {
        double start = j >= nb || (i < na && a[i].start <= b[j].start) ? a[i].start : b[j].start, end = high;
        while (i < na && a[i].start <= start)
            one = a[i++].lowest;
        while (j < nb && b[j].start <= start)
            two = b[j++].lowest;
        if (i < na)
            end = a[i].start;
        if (j < nb && (i >= na || b[j].start < end))
            end = b[j].start;
        if (!(end > start))
            continue;
        if (one >= 0 && two >= 0 && one != two)
            count = contest(functions, one, two, start, end, out, first, count);
        else
            count = push(out, first, count, start, one > two ? one : two);
    }
    if (count > first && !(high > out[count - 1].start))
        count--;
    return count;
}

/* The parts of the lower envelope of the row's functions; their number, or an error. */
static int64_t lower_envelope(work *w, double low, double high, int64_t count, const part **result)
{
    int64_t n = count, i, total = 0;
    int from = 0;
    for (i = 0; i < 2; i++) {
        int64_t capacity = w->offsets;
        if (!grow(&w->offset[i], &capacity, count + 2, sizeof(int64_t)))
            return NO_MEMORY;
        if (i == 1)
            w->offsets = capacity;
    }
    for (i = 0; i < 2; i++) {
        int64_t capacity = w->parts;
        if (!grow(&w->part[i], &capacity, 3 * count + 1, sizeof(part)))
            return NO_MEMORY;
        if (i == 1)
            w->parts = capacity;
    }
    for (i = 0; i < count; i++) {
        const function *f = w->function + i;
        part *out = w->part[0];
        w->offset[0][i] = total;
        if (f->low > low) {
            out[total].start = low;
            out[total++].lowest = NOTHING;
        }
        out[total].start = f->low;
        out[total++].lowest = i;
        if (f->high < high) {
            out[total].start = f->high;
            out[total++].lowest = NOTHING;
        }
    }
    w->offset[0][count] = total;
    while (n > 1) {
        int to = 1 - from;
        int64_t *before = w->offset[from], *after = w->offset[to], made = 0, needed = 3 * total + 3, capacity = w->parts;
        /* Each interval of a merge is cut into three parts at most. */
        if (needed > w->parts) {
            if (!grow(&w->part[0], &capacity, needed, sizeof(part)))
                return NO_MEMORY;
            capacity = w->parts;
            if (!grow(&w->part[1], &capacity, needed, sizeof(part)))
                return NO_MEMORY;
            w->parts = capacity;
        }
        for (i = 0; i < n; i += 2) {
            const part *a = w->part[from] + before[i], *b = i + 1 < n ? w->part[from] + before[i + 1] : NULL;
            int64_t na = before[i + 1] - before[i], nb = i + 1 < n ? before[i + 2] - before[i + 1] : 0;
            after[i / 2] = made;
            made = merge(w->function, a, na, b, nb, high, w->part[to], made);
        }
        n = (n + 1) / 2;
        after[n] = made;
        total = made;
        from = to;
    }
    *result = w->part[from];
    return count ? total : 0;
}

/* --- The parts' places --- */

static int place_of(const provisional *p, double x, double value, point *z)
{
    point axis = p->in->axis[p->row], origin = p->in->origin[p->row];
    double along, left;
    if (p->straight) {
        along = x;
        left = most(value, 0.0);
    } else {
        if (value >= 0.0)
            return 0;
        along = (1.0 - x) * (1.0 + x) / -value;
        left = 2.0 * x / -value;
    }
    z->x = origin.x + (axis.x * along - axis.y * left);
    z->y = origin.y + (axis.x * left + axis.y * along);
    return 1;
}

typedef struct {
    int64_t *row, *copy, *item;
    point *begin, *end;
    int64_t count, capacity;
} output;

/* Write the parts of a row's envelope; 1, 0 where there is no room, or UNBOUNDED. */
static int locate(const work *w, const provisional *p, const part *parts, int64_t count, output *out)
{
    double low = p->in->low[p->row], high = p->in->high[p->row];
    double null = 4.0 * EPSILON * most(fabs(low), fabs(high));
    const function *f = w->function, *before = NULL;
    int64_t i, first = out->count, last = -1;
    for (i = 0; i < count; i++) {
        double end = i + 1 < count ? parts[i + 1].start : high;
        if (!(end - parts[i].start > null))
            continue;
        if (parts[i].lowest < 0)
            return UNBOUNDED;
        if (out->count == out->capacity)
            return 0;
        {
            const function *here = f + parts[i].lowest, *at = here;
            double x = before ? parts[i].start : low;
            if (before && fabs(slope_of(before, x)) <= fabs(slope_of(here, x)))
                at = before;
            if (!place_of(p, x, value_of(at, x), &out->begin[out->count]))
                return UNBOUNDED;
            if (before)
                out->end[out->count - 1] = out->begin[out->count];
            out->row[out->count] = p->row;
            out->copy[out->count] = here->copy;
            out->item[out->count] = here->item;
            out->count++;
            before = here;
            last = i;
        }
    }
    if (last < 0 || out->count == first)
        return UNBOUNDED;
    return place_of(p, high, value_of(before, high), &out->end[out->count - 1]) ? 1 : UNBOUNDED;
}

/* Write what bounds the cells of the rows from `first` on, until all is done or the room is full.

   progress[0] becomes the row that is next, progress[1] the number of parts written. The result is 0, or UNBOUNDED,
   TOUCHING or NO_MEMORY. */
int64_t cells_bound(int64_t rows, const int64_t *half_edge, const int64_t *corner, const double *origin,
                    const double *axis, const double *low, const double *high, const double *base0, const double *ray0,
                    const double *base1, const double *ray1, const double *base, const double *ray,
                    const double *spread, int64_t half_edges, const double *node, const int64_t *source,
                    const int64_t *target, const double *direction, const double *length, const int64_t *corner_node,
                    const double *arriving, const double *leaving, const double *turn, const uint8_t *bounding,
                    int64_t copies, int64_t bundles, const double *unit, const double *shift, const uint8_t *conj,
                    const int64_t *bundle, int64_t levels, const double *start, const double *end,
                    const double *radius, const double *anchor_start, const double *anchor_end,
                    const int64_t *box_bundle, const int64_t *child, const int64_t *level, const int64_t *element,
                    double covering_radius, int64_t first, int64_t capacity, int64_t *out_row,
                    int64_t *out_copy, int64_t *out_item, double *out_begin, double *out_end, int64_t *progress)
{
    input in = {half_edge, corner, (const point *)origin, (const point *)axis, low, high, (const point *)base0,
                (const point *)ray0, (const point *)base1, (const point *)ray1, (const point *)base,
                (const point *)ray, spread, half_edges, (const point *)node, source, target,
                (const point *)direction, length, corner_node, (const point *)arriving, (const point *)leaving, turn,
                bounding, copies, bundles, (const point *)unit, (const point *)shift, conj, bundle, levels,
                (const point *)start, (const point *)end, radius, (const point *)anchor_start,
                (const point *)anchor_end, box_bundle, child, level, element, covering_radius, 0.0};
    output out = {out_row, out_copy, out_item, (point *)out_begin, (point *)out_end, 0, capacity};
    work w;
    int64_t row, status = 0;
    memset(&w, 0, sizeof w);
    w.box = malloc((size_t)level[levels] * sizeof(box));
    w.place = malloc((size_t)(level[levels] - level[levels - 1]) * sizeof(int64_t));
    if (!w.box || !w.place) {
        release(&w);
        return NO_MEMORY;
    }
    for (row = 0; row < level[levels]; row++)
        w.box[row] = box_of(&in, row);
    for (row = 0; row < level[levels] - level[levels - 1]; row++)
        w.place[element[row]] = row;
    if (!set_tops(&w, &in)) {
        release(&w);
        return NO_MEMORY;
    }
    for (row = first; row < rows; row++) {
        provisional p;
        const part *parts = NULL;
        int64_t count, kept = out.count;
        int done;
        begin_row(&p, &in, row);
        count = find_candidates(&w, &p);
        if (count >= 0)
            count = find_bisectors(&w, &p, count);
        if (count >= 0)
            count = lower_envelope(&w, low[row], high[row], count, &parts);
        if (count < 0) {
            status = count;
            break;
        }
        done = locate(&w, &p, parts, count, &out);
        if (done < 0) {
            status = done;
            break;
        }
        if (!done) {
            out.count = kept;
            break;
        }
    }
    release(&w);
    progress[0] = row;
    progress[1] = out.count;
    return status;
}
