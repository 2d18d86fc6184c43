/* The copies that can shape a tile: `copies_near` of copies.py, where the method is explained. The copies are the same,
   in the same order, and so are their bits: what decides on them has a slack far above rounding. */

#include <math.h>
#include <stdint.h>

#define SLACK 1e-9

/* Of motion_codes.c. */
void codes_translation(int64_t code, int64_t *s, int64_t *t);
int64_t codes_moved(int64_t code, int64_t i, int64_t j);

typedef struct {
    double x, y;
} point;

static double inner(point a, point b) { return a.x * b.x + a.y * b.y; }

/* How far a site's or a copy's nodes reach along the sides of the lattice's cell. */
typedef struct {
    double low[3], high[3];
} extent;

/* The extent of the nodes of a bundle, moved by a motion's linear part. */
static extent extent_of(const point *across, point unit, int conj, int64_t bundle, int64_t nodes, const point *node,
                        const int64_t *node_bundle)
{
    extent e;
    int64_t n;
    int k;
    for (k = 0; k < 3; k++) {
        /* A moved point is along r where the point itself is along r moved back: r / unit, or its mirror image. */
        point along = {across[k].x * unit.x + across[k].y * unit.y, across[k].y * unit.x - across[k].x * unit.y};
        if (conj)
            along.y = -along.y;
        e.low[k] = INFINITY;
        e.high[k] = -INFINITY;
        for (n = 0; n < nodes; n++)
            if (node_bundle[n] == bundle) {
                double at = inner(along, node[n]);
                e.low[k] = fmin(e.low[k], at);
                e.high[k] = fmax(e.high[k], at);
            }
    }
    return e;
}

/* The translation of a motion. */
static point shift_of(int64_t motion, point a, point b)
{
    int64_t s, t;
    double i, j;
    point shift;
    codes_translation(motion, &s, &t);
    i = (double)s / 2;
    j = (double)t / 2;
    shift.x = i * a.x + j * b.x;
    shift.y = i * a.y + j * b.y;
    return shift;
}

/* Write the copies, as far as there is room; their number, or -1 where a motion has no code.

   The motions are those of all bundles (`of`, ascending), in each the identity first. `lattice` are its vectors a, b, and
   p, q of its shortest basis; `reduced` are p and q over a and b. */
int64_t copies_near(int64_t count, const int64_t *motion, const double *units, const uint8_t *conj, const int64_t *of,
                    int64_t nodes, const double *node, const int64_t *node_bundle, const double *lattice,
                    const int64_t *reduced, int64_t room, int64_t *out_motion, double *out_unit, double *out_shift,
                    uint8_t *out_conj, int64_t *out_bundle)
{
    const point *unit = (const point *)units, *basis = (const point *)lattice;
    point a = basis[0], b = basis[1], p = basis[2], q = basis[3];
    double product = inner(p, q), area = p.x * q.y - p.y * q.x, sign = product < 0.0 ? 1.0 : -1.0;
    point across[3] = {p, q, {p.x + sign * q.x, p.y + sign * q.y}};
    /* The inverse of the Gram matrix. */
    double pp = inner(q, q) / (area * area), qq = inner(p, p) / (area * area), pq = -product / (area * area);
    double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
    int64_t m, i, j, found = of[count - 1] + 1;
    int k;
    for (m = 0; m < count; m++)
        if (m == 0 || of[m] != of[m - 1]) {
            extent e = extent_of(across, unit[m], conj[m], of[m], nodes, (const point *)node, node_bundle);
            for (k = 0; k < 3; k++) {
                least[k] = fmin(least[k], e.low[k]);
                most[k] = fmax(most[k], e.high[k]);
            }
        }
    for (m = 0; m < count; m++) {
        extent e = extent_of(across, unit[m], conj[m], of[m], nodes, (const point *)node, node_bundle);
        double bound[3], away[3];
        point shift = shift_of(motion[m], a, b);
        double near_p, near_q;
        int64_t reach_p, reach_q;
        for (k = 0; k < 3; k++) {
            bound[k] = inner(across[k], across[k]) * (1.0 + SLACK) + (e.high[k] - e.low[k] + most[k] - least[k]) / 2;
            away[k] = inner(across[k], shift) + (e.low[k] + e.high[k] - least[k] - most[k]) / 2;
        }
        /* How many steps along p and q lead near, and how many there are to try. */
        near_p = floor(pp * away[0] + pq * away[1] + 0.5);
        near_q = floor(pq * away[0] + qq * away[1] + 0.5);
        reach_p = (int64_t)ceil(pp * bound[0] + fabs(pq) * bound[1]) + 1;
        reach_q = (int64_t)ceil(fabs(pq) * bound[0] + qq * bound[1]) + 1;
        for (i = -reach_p; i <= reach_p; i++)
            for (j = -reach_q; j <= reach_q; j++) {
                double along_p = (double)i - near_p, along_q = (double)j - near_q;
                point step = {along_p * p.x + along_q * q.x, along_p * p.y + along_q * q.y};
                int64_t x, y, moved, place;
                int inside = 1;
                for (k = 0; k < 3; k++)
                    inside &= fabs(away[k] + inner(across[k], step)) <= bound[k];
                if (!inside)
                    continue;
                x = (int64_t)along_p * reduced[0] + (int64_t)along_q * reduced[2];
                y = (int64_t)along_p * reduced[1] + (int64_t)along_q * reduced[3];
                moved = codes_moved(motion[m], x, y);
                if (moved < 0)
                    return -1;
                /* The identities come first: each is the first motion of its bundle, and never left out. */
                place = (m == 0 || of[m] != of[m - 1]) && !x && !y ? of[m] : found++;
                if (place >= room)
                    continue;
                out_motion[place] = moved;
                ((point *)out_unit)[place] = unit[m];
                ((point *)out_shift)[place] = shift_of(moved, a, b);
                out_conj[place] = conj[m];
                out_bundle[place] = of[m];
            }
    }
    return found;
}
