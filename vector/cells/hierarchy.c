/* The elements of all sites in nested boxes: `build_hierarchy` of hierarchy.py, bit for bit, where the method is
   explained. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define FEW 64
#define BRANCH 8
#define SLACK 1e-9
#define DIGITS 8 /* bits of a key that one pass sorts by */

#define NO_MEMORY (-3)

typedef struct {
    double x, y;
} point;

/* Bring `order` into the ascending order of the keys' digit from `shift` on, stably. */
static void sort_by_digit(const uint64_t *key, int shift, int64_t count, int64_t *order, int64_t *other)
{
    int64_t place[1 << DIGITS] = {0}, k, total = 0;
    for (k = 0; k < count; k++)
        place[key[k] >> shift & ((1 << DIGITS) - 1)]++;
    for (k = 0; k < 1 << DIGITS; k++) {
        int64_t some = place[k];
        place[k] = total;
        total += some;
    }
    for (k = 0; k < count; k++)
        other[place[key[order[k]] >> shift & ((1 << DIGITS) - 1)]++] = order[k];
    memcpy(order, other, (size_t)count * sizeof *order);
}

static void sort_by(const uint64_t *key, uint64_t largest, int64_t count, int64_t *order, int64_t *other)
{
    int shift;
    for (shift = 0; largest >> shift > 0; shift += DIGITS)
        sort_by_digit(key, shift, count, order, other);
}

/* The bits of a number below 2^16, each followed by a 0. */
static uint64_t spread(uint64_t bits)
{
    bits = (bits | bits << 8) & 0x00FF00FF;
    bits = (bits | bits << 4) & 0x0F0F0F0F;
    bits = (bits | bits << 2) & 0x33333333;
    return (bits | bits << 1) & 0x55555555;
}

/* The keys of points along the Z-order curve (`z_order` of box_join.py). */
static void z_keys(const point *middle, int64_t count, uint64_t *key)
{
    double x0 = middle[0].x, x1 = x0, y0 = middle[0].y, y1 = y0, side, scale;
    int64_t k;
    for (k = 1; k < count; k++) {
        x0 = fmin(x0, middle[k].x);
        x1 = fmax(x1, middle[k].x);
        y0 = fmin(y0, middle[k].y);
        y1 = fmax(y1, middle[k].y);
    }
    side = fmax(x1 - x0, y1 - y0);
    scale = 65535.0 / (side != 0.0 ? side : 1.0);
    for (k = 0; k < count; k++)
        key[k] = spread((uint64_t)((middle[k].x - x0) * scale)) | spread((uint64_t)((middle[k].y - y0) * scale)) << 1;
}

/* The ends and the radius of the box along the principal axis of some segments. */
static void box_around(const point *start, const point *end, int64_t count, point *from, point *to, double *radius)
{
    double sum_x = 0.0, sum_y = 0.0, u = 0.0, v = 0.0, x, y, moment, big, small, cosine, sine, across;
    double back = INFINITY, front = -INFINITY, low = INFINITY, high = -INFINITY;
    int64_t k;
    int which;
    for (k = 0; k < count; k++) {
        sum_x += start[k].x + end[k].x;
        sum_y += start[k].y + end[k].y;
    }
    x = sum_x / (double)(2 * count);
    y = sum_y / (double)(2 * count);
    for (k = 0; k < count; k++) {
        double ax = start[k].x - x, ay = start[k].y - y, bx = end[k].x - x, by = end[k].y - y;
        u += (ax * ax - ay * ay) + (bx * bx - by * by);
        v += 2.0 * (ax * ay) + 2.0 * (bx * by);
    }
    moment = sqrt(u * u + v * v);
    if (moment == 0.0)
        u = moment = 1.0;
    big = sqrt((1.0 + fabs(u) / moment) / 2.0);
    small = v / (2.0 * moment * big);
    cosine = u >= 0.0 ? big : fabs(small);
    sine = u >= 0.0 ? small : copysign(big, v);
    for (k = 0; k < count; k++)
        for (which = 0; which < 2; which++) {
            const point *z = which ? end + k : start + k;
            double along = (z->x - x) * cosine + (z->y - y) * sine, left = (z->y - y) * cosine - (z->x - x) * sine;
            back = fmin(back, along);
            front = fmax(front, along);
            low = fmin(low, left);
            high = fmax(high, left);
        }
    across = (low + high) / 2.0;
    from->x = x + (cosine * back - sine * across);
    from->y = y + (sine * back + cosine * across);
    to->x = x + (cosine * front - sine * across);
    to->y = y + (sine * front + cosine * across);
    *radius = (high - low) / 2.0 * (1.0 + SLACK) + SLACK * (front - back);
}

/* Write the elements and the boxes around them, level by level from the top; the number of levels, or NO_MEMORY. There
   is as much room for boxes and levels as `build_hierarchy` reckons. */
int64_t hierarchy_build(int64_t half_edges, const int64_t *source, const int64_t *target, int64_t corners,
                        const int64_t *corner_node, const double *nodes, const int64_t *node_bundle, int64_t bundles,
                        double *start_, double *end_, double *radius, double *anchor_start_, double *anchor_end_,
                        int64_t *bundle, int64_t *child, int64_t *level, int64_t *element)
{
    const point *node = (const point *)nodes;
    point *start = (point *)start_, *end = (point *)end_, *middle;
    point *anchor_start = (point *)anchor_start_, *anchor_end = (point *)anchor_end_;
    int64_t segments = half_edges / 2, count = segments + (corners - half_edges) / 4, k, b, run, levels = 1, at;
    int64_t branch = count > FEW ? BRANCH : FEW, most = 0, *from, *to, *first, *other;
    uint64_t *key;
    void *memory = malloc((size_t)count * (sizeof(point) + sizeof(uint64_t) + 3 * sizeof(int64_t)) +
                          (size_t)(bundles + 1) * sizeof(int64_t));
    if (!memory)
        return NO_MEMORY;
    middle = memory;
    key = (uint64_t *)(middle + count);
    from = (int64_t *)(key + count);
    to = from + count;
    other = to + count;
    first = other + count;
    for (k = 0; k < count; k++) {
        from[k] = k < segments ? source[2 * k] : corner_node[half_edges + 4 * (k - segments)];
        to[k] = k < segments ? target[2 * k] : from[k];
        middle[k].x = (node[from[k]].x + node[to[k]].x) / 2.0;
        middle[k].y = (node[from[k]].y + node[to[k]].y) / 2.0;
        element[k] = k;
    }
    if (count > BRANCH) {
        z_keys(middle, count, key);
        sort_by(key, 0xFFFFFFFF, count, element, other);
    }
    for (k = 0; k < count; k++)
        key[k] = (uint64_t)node_bundle[from[k]];
    sort_by(key, (uint64_t)bundles - 1, count, element, other);
    memset(first, 0, (size_t)(bundles + 1) * sizeof *first);
    for (k = 0; k < count; k++)
        first[key[k] + 1]++;
    for (b = 0; b < bundles; b++) {
        most = first[b + 1] > most ? first[b + 1] : most;
        first[b + 1] += first[b];
    }
    for (run = 1; run < most; run *= branch)
        levels++;
    level[0] = 0;
    for (k = 0; k < levels; k++, run /= branch) {
        int64_t here = level[k];
        for (b = 0; b < bundles; b++)
            here += (first[b + 1] - first[b] + run - 1) / run;
        level[k + 1] = here;
    }
    at = level[levels - 1];
    for (k = 0; k < count; k++, at++) {
        start[at] = anchor_start[at] = node[from[element[k]]];
        end[at] = anchor_end[at] = node[to[element[k]]];
        radius[at] = 0.0;
        bundle[at] = (int64_t)key[element[k]];
        child[at] = level[levels];
    }
    child[at] = level[levels];
    start += level[levels - 1];
    end += level[levels - 1];
    for (k = levels - 2, run = branch; k >= 0; k--, run *= branch) {
        int64_t below = level[k + 1];
        at = level[k];
        for (b = 0; b < bundles; b++) {
            int64_t begin;
            for (begin = first[b]; begin < first[b + 1]; begin += run, at++) {
                int64_t some = first[b + 1] - begin < run ? first[b + 1] - begin : run;
                int64_t anchor = begin + (run / 2 < some ? run / 2 : some - 1);
                box_around(start + begin, end + begin, some, (point *)start_ + at, (point *)end_ + at, radius + at);
                anchor_start[at] = start[anchor];
                anchor_end[at] = end[anchor];
                bundle[at] = b;
                child[at] = below;
                below += (some + run / branch - 1) / (run / branch);
            }
        }
    }
    free(memory);
    return levels;
}
