/* The first of some pairs of outlines that come near to each other: what clearance.py does, with the same operations in
   the same order. */

#include <stdint.h>

#define GROUP 8

/* Upright boxes and segments, as four numbers in a row. */
typedef struct {
    double left, low, right, high;
} Box;

typedef struct {
    double x0, y0, x1, y1;
} Segment;

static double least(double a, double b) { return a < b ? a : b; }
static double most(double a, double b) { return a > b ? a : b; }

static int apart(Box a, Box b, double reach)
{
    return b.left - a.right > reach || a.left - b.right > reach || b.low - a.high > reach || a.low - b.high > reach;
}

static Box moved_box(Box box, double x, double y)
{
    Box moved = {box.left + x, box.low + y, box.right + x, box.high + y};
    return moved;
}

static Segment moved_segment(Segment s, double x, double y)
{
    Segment moved = {s.x0 + x, s.y0 + y, s.x1 + x, s.y1 + y};
    return moved;
}

static Box box_of(Segment s)
{
    Box box = {least(s.x0, s.x1), least(s.y0, s.y1), most(s.x0, s.x1), most(s.y0, s.y1)};
    return box;
}

/* The square of the distance of a point from a segment; x and y from the segment's nearest point to it. */
static double from_segment(double px, double py, Segment s, double *x, double *y)
{
    double wx = s.x1 - s.x0, wy = s.y1 - s.y0, length = wx * wx + wy * wy;
    double t = ((px - s.x0) * wx + (py - s.y0) * wy) / (length > 0.0 ? length : 1.0);
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    *x = px - (s.x0 + t * wx);
    *y = py - (s.y0 + t * wy);
    return *x * *x + *y * *y;
}

static double area(double ux, double uy, double vx, double vy) { return ux * vy - uy * vx; }

static int cross(Segment a, Segment b)
{
    double ux = a.x1 - a.x0, uy = a.y1 - a.y0, vx = b.x1 - b.x0, vy = b.y1 - b.y0;
    return area(ux, uy, b.x0 - a.x0, b.y0 - a.y0) * area(ux, uy, b.x1 - a.x0, b.y1 - a.y0) < 0.0 &&
           area(vx, vy, a.x0 - b.x0, a.y0 - b.y0) * area(vx, vy, a.x1 - b.x0, a.y1 - b.y0) < 0.0;
}

/* The square of the distance of two segments; x and y from the second's nearest point to the first's. */
static double between(Segment a, Segment b, double *x, double *y)
{
    double best, next, nx, ny;
    *x = *y = 0.0;
    if (cross(a, b))
        return 0.0;
    best = from_segment(a.x0, a.y0, b, x, y);
    next = from_segment(a.x1, a.y1, b, &nx, &ny);
    if (next < best) {
        best = next;
        *x = nx;
        *y = ny;
    }
    next = from_segment(b.x0, b.y0, a, &nx, &ny);
    if (next < best) {
        best = next;
        *x = -nx;
        *y = -ny;
    }
    next = from_segment(b.x1, b.y1, a, &nx, &ny);
    if (next < best) {
        best = next;
        *x = -nx;
        *y = -ny;
    }
    return best;
}

/* The first of the pairs, of outline one[k] and outline two[k] moved by `shift` (x, y), that come within a reach; -1
   where none does. Then `out` is the way from the second's nearest point to the first's.

   Outline k has the segments first[k] ... and the box whole[k]; boxes[group[k]] ... hold GROUP of these each. */
int64_t outlines_near(int64_t pairs, const int64_t *one, const int64_t *two, const double *shift, double reach,
                      const int64_t *first, const int64_t *group, const Box *whole, const Box *boxes,
                      const Segment *segments, double *out)
{
    int64_t k, g, h, i, j;
    for (k = 0; k < pairs; k++) {
        int64_t a = one[k], b = two[k];
        double dx = shift[2 * k], dy = shift[2 * k + 1], best = reach * reach, x, y;
        int found = 0;
        if (apart(whole[a], moved_box(whole[b], dx, dy), reach))
            continue;
        for (g = group[a]; g < group[a + 1]; g++) {
            int64_t from = first[a] + GROUP * (g - group[a]);
            int64_t after = from + GROUP < first[a + 1] ? from + GROUP : first[a + 1];
            for (h = group[b]; h < group[b + 1]; h++) {
                int64_t begin = first[b] + GROUP * (h - group[b]);
                int64_t end = begin + GROUP < first[b + 1] ? begin + GROUP : first[b + 1];
                Box there = moved_box(boxes[h], dx, dy);
                if (apart(boxes[g], there, reach))
                    continue;
                for (i = from; i < after; i++) {
                    Box here = box_of(segments[i]);
                    if (apart(here, there, reach))
                        continue;
                    for (j = begin; j < end; j++) {
                        Segment other = moved_segment(segments[j], dx, dy);
                        double square;
                        if (apart(here, box_of(other), reach))
                            continue;
                        square = between(segments[i], other, &x, &y);
                        if (square < best || (!found && square == best)) {
                            found = 1;
                            best = square;
                            out[0] = x;
                            out[1] = y;
                        }
                    }
                }
            }
        }
        if (found)
            return k;
    }
    return -1;
}
