/* The outlines of tiles and the counterparts of their arcs: what `TileBoundaries` in boundary.py does, bit for bit; and
   where points are, as `Representatives` in representatives.py has it. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Of motion_codes.c. */
int64_t codes_images(int64_t count, const int64_t *code, const double *points, const double *units, const double *signs,
                     double a_x, double a_y, double b_x, double b_y, int64_t further_s, int64_t further_t, double *out);
int64_t codes_composed(int64_t count, const int64_t *outer, const int64_t *inner, int64_t parts, const int64_t *product,
                       const int64_t *along, int64_t *out);
int64_t codes_least(int64_t count, const int64_t *code, const int64_t *row, int64_t width, const int64_t *rows,
                    int64_t parts, const int64_t *product, const int64_t *along, int64_t *out);

typedef struct {
    double x, y;
} point;

/* Images of representatives, as `Points` in representatives.py. */
typedef struct {
    const int64_t *index, *motion;
} images;

/* The representatives with the rows of the motions that fix them, the linear parts of motions, and the lattice. */
typedef struct {
    const point *position;
    const int64_t *row;
    int64_t width;
    const int64_t *fixing;
    int64_t parts;
    const int64_t *product, *along;
    const double *units, *signs;
    double a_x, a_y, b_x, b_y;
    int64_t further_s, further_t; /* twice a translation that comes after all motions */
} plane;

static point image(const plane *p, int64_t motion, point at)
{
    point result;
    codes_images(1, &motion, &at.x, p->units, p->signs, p->a_x, p->a_y, p->b_x, p->b_y, p->further_s, p->further_t,
                 &result.x);
    return result;
}

static int64_t composed(const plane *p, int64_t outer, int64_t inner)
{
    int64_t result;
    codes_composed(1, &outer, &inner, p->parts, p->product, p->along, &result);
    return result;
}

/* Where a point is under one more motion; 0 where there is none. */
static point located(const plane *p, int64_t outer, images points, int64_t k)
{
    int64_t index = points.index[k], motion;
    point nowhere = {0.0, 0.0};
    if (index < 0)
        return nowhere;
    motion = composed(p, outer, points.motion[k]);
    codes_least(1, &motion, p->row + index, p->width, p->fixing, p->parts, p->product, p->along, &motion);
    return image(p, motion, p->position[index]);
}

/* The middle between two points, as numpy divides complex numbers: -0 becomes 0. */
static point middle(point a, point b)
{
    point sum = {a.x + b.x, a.y + b.y}, result = {(sum.x + sum.y * 0.0) * 0.5, (sum.y - sum.x * 0.0) * 0.5};
    return result;
}

/* Write what follows each entry in its ring. */
static void follow(int64_t rings, const int64_t *offsets, int64_t *following)
{
    int64_t r, k;
    for (r = 0; r < rings; r++)
        for (k = offsets[r]; k < offsets[r + 1]; k++)
            following[k] = k + 1 < offsets[r + 1] ? k + 1 : offsets[r];
}

/* Write where points are, under a translation that comes after their motions. */
int64_t representatives_located(int64_t count, const int64_t *index, const int64_t *motion, const double *position,
                                const int64_t *row, int64_t width, const int64_t *fixing, int64_t parts,
                                const int64_t *product, const int64_t *along, const double *units, const double *signs,
                                double a_x, double a_y, double b_x, double b_y, int64_t identity, int64_t further_s,
                                int64_t further_t, double *out)
{
    const plane p = {(const point *)position, row, width, fixing, parts, product, along, units, signs, a_x, a_y,
                     b_x, b_y, further_s, further_t};
    const images points = {index, motion};
    int64_t k;
    for (k = 0; k < count; k++)
        ((point *)out)[k] = located(&p, identity, points, k);
    return 0;
}

/* Write the arcs of all boundaries under a motion: start, control, end and focus, and both points of the directrix. */
int64_t complex_arcs(int64_t count, const int64_t *start, const int64_t *start_motion, const int64_t *control,
                     const int64_t *control_motion, const double *position, const int64_t *row, int64_t width,
                     const int64_t *fixing, int64_t parts, const int64_t *product, const int64_t *along,
                     const double *units, const double *signs, double a_x, double a_y, double b_x, double b_y,
                     int64_t rings, const int64_t *ring_offsets, const double *foci, const double *directrices,
                     int64_t turn, int64_t further_s, int64_t further_t, double *out_start, double *out_control,
                     double *out_end, double *out_focus, double *out_directrix)
{
    const plane p = {(const point *)position, row, width, fixing, parts, product, along, units, signs, a_x, a_y,
                     b_x, b_y, further_s, further_t};
    const images starts = {start, start_motion}, controls = {control, control_motion};
    const point *focus = (const point *)foci, *directrix = (const point *)directrices, nowhere = {0.0, 0.0};
    point *from = (point *)out_start, *to = (point *)out_end, *over = (point *)out_control;
    int64_t k, r;
    for (k = 0; k < count; k++)
        from[k] = located(&p, turn, starts, k);
    for (r = 0; r < rings; r++)
        for (k = ring_offsets[r]; k < ring_offsets[r + 1]; k++) {
            int curved = control[k] >= 0;
            int64_t motion = composed(&p, turn, control_motion[k]);
            to[k] = from[k + 1 < ring_offsets[r + 1] ? k + 1 : ring_offsets[r]];
            over[k] = curved ? located(&p, turn, controls, k) : middle(from[k], to[k]);
            ((point *)out_focus)[k] = curved ? image(&p, motion, focus[k]) : nowhere;
            ((point *)out_directrix)[2 * k] = curved ? image(&p, motion, directrix[2 * k]) : nowhere;
            ((point *)out_directrix)[2 * k + 1] = curved ? image(&p, motion, directrix[2 * k + 1]) : nowhere;
        }
    return 0;
}

/* An edge that a tile uses, and what tells it apart from others of its face: its ends, and its first arc. */
typedef struct {
    point start, end, next, control;
    int64_t use;
} edge;

static int order_of(const void *one, const void *two)
{
    const edge *a = one, *b = two;
    const double *x = &a->start.x, *y = &b->start.x;
    int k;
    for (k = 0; k < 8; k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return (a->use > b->use) - (a->use < b->use);
}

/* Write start, control and end of each arc's counterpart into three rows, where it has one.

   The arcs of edge k of a boundary begin at `uses[k]`, and the last ones end at `uses[edges]`; arc k is part of the face
   `face[k]`. The tile beyond a face is moved by `motion`, and faces it with its face `partner`, -1 where there is none. */
int64_t complex_counterparts(int64_t count, const int64_t *start, const int64_t *start_motion, const int64_t *control,
                             const int64_t *control_motion, const double *position, const int64_t *row, int64_t width,
                             const int64_t *fixing, int64_t parts, const int64_t *product, const int64_t *along,
                             const double *units, const double *signs, double a_x, double a_y, double b_x, double b_y,
                             int64_t rings, const int64_t *ring_offsets, int64_t edges, const int64_t *uses,
                             const int64_t *face, int64_t faces, const int64_t *motion, const int64_t *partner,
                             int64_t identity, double *out)
{
    const plane p = {(const point *)position, row, width, fixing, parts, product, along, units, signs, a_x, a_y,
                     b_x, b_y, 0, 0};
    const images starts = {start, start_motion}, controls = {control, control_motion};
    point *low = (point *)out, *over = low + count, *high = over + count;
    int64_t *following = malloc(((size_t)count + 1) * sizeof *following);
    int64_t *begin = calloc((size_t)faces + 2, sizeof *begin), *of_face = malloc(((size_t)edges + 1) * sizeof *of_face);
    edge *ours = malloc(2 * ((size_t)edges + 1) * sizeof *ours), *theirs = ours + edges + 1;
    int64_t f, k, j, failed = !following || !begin || !of_face || !ours;
    if (!failed) {
        follow(rings, ring_offsets, following);
        /* The edges face by face: those of face f begin at begin[f]. */
        for (k = 0; k < edges; k++)
            begin[face[uses[k]] + 2]++;
        for (f = 0; f < faces; f++)
            begin[f + 2] += begin[f + 1];
        for (k = 0; k < edges; k++)
            of_face[begin[face[uses[k]] + 1]++] = k;
        for (f = 0; f < faces; f++) {
            int64_t there = partner[f], by = motion[f];
            int64_t here_count = begin[f + 1] - begin[f], there_count = there < 0 ? 0 : begin[there + 1] - begin[there];
            int turned = there >= 0 && signs[by >> 58] < 0.0;
            if (!there_count)
                continue;
            for (k = 0; k < here_count; k++) {
                int64_t use = of_face[begin[f] + k], first = uses[use], last = uses[use + 1] - 1;
                ours[k].start = located(&p, identity, starts, first);
                ours[k].end = located(&p, identity, starts, following[last]);
                ours[k].next = located(&p, identity, starts, following[first]);
                ours[k].control = located(&p, identity, controls, first);
                ours[k].use = use;
            }
            /* Of theirs the arcs are run through in the order of ours. */
            for (k = 0; k < there_count; k++) {
                int64_t use = of_face[begin[there] + k], first = uses[use], last = uses[use + 1] - 1;
                theirs[k].start = located(&p, by, starts, turned ? first : following[last]);
                theirs[k].end = located(&p, by, starts, turned ? following[last] : first);
                theirs[k].next = located(&p, by, starts, turned ? following[first] : last);
                theirs[k].control = located(&p, by, controls, turned ? first : last);
                theirs[k].use = use;
            }
            qsort(ours, (size_t)here_count, sizeof *ours, order_of);
            qsort(theirs, (size_t)there_count, sizeof *theirs, order_of);
            for (k = 0; k < here_count && k < there_count; k++) {
                int64_t here = uses[ours[k].use], size = uses[ours[k].use + 1] - here, first = uses[theirs[k].use];
                if (uses[theirs[k].use + 1] - first != size)
                    continue;
                for (j = 0; j < size; j++) {
                    int64_t arc = first + (turned ? j : size - 1 - j);
                    point one = located(&p, by, starts, arc), two = located(&p, by, starts, following[arc]);
                    low[here + j] = turned ? one : two;
                    high[here + j] = turned ? two : one;
                    over[here + j] = control[arc] >= 0 ? located(&p, by, controls, arc) : middle(one, two);
                }
            }
        }
    }
    free(following);
    free(begin);
    free(of_face);
    free(ours);
    return failed;
}
