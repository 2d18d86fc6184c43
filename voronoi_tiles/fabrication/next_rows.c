/* The lowest rows of a lattice above its first one: what next_rows.py does, with the same operations in the same
   order. */

#include <math.h>
#include <stdint.h>

#define NUDGE 1e-5
#define MULTIPLES 8
#define ABOVE 6

/* Directed segments, the region on their left. */
typedef struct {
    double x0, y0, x1, y1;
} Edge;

/* A level at which a line upwards enters a part of a region, +1, or leaves one, -1. */
typedef struct {
    double level;
    int64_t line, way;
} Passage;

static int64_t winding(const Edge *edges, int64_t count, double x, double y)
{
    int64_t k, sum = 0;
    for (k = 0; k < count; k++) {
        Edge e = edges[k];
        int low = e.y0 <= y, high = e.y1 > y;
        if (low == high) {
            double left = (e.x0 - x) * (e.y1 - y) - (e.y0 - y) * (e.x1 - x);
            sum += low ? left > 0.0 : -(left < 0.0);
        }
    }
    return sum;
}

/* Whether a place lies in the region, and not on its border. */
static int within(const Edge *edges, int64_t count, const double *box, double x, double y)
{
    if (x <= box[0] || x >= box[2] || y <= box[1] || y >= box[3])
        return 0;
    return winding(edges, count, x - NUDGE, y - NUDGE) > 0 && winding(edges, count, x + NUDGE, y - NUDGE) > 0 &&
           winding(edges, count, x + NUDGE, y + NUDGE) > 0 && winding(edges, count, x - NUDGE, y + NUDGE) > 0;
}

static int row_fits(const Edge *edges, int64_t count, const double *box, double ux, double uy)
{
    int64_t i;
    for (i = 1; i <= ABOVE; i++)
        if (within(edges, count, box, (double)i * ux, (double)i * uy))
            return 0;
    return 1;
}

static int rows_fit(const Edge *edges, int64_t count, const double *box, double ux, double uy, double vx, double vy)
{
    int64_t i, j;
    for (j = 1; j <= ABOVE; j++)
        for (i = -MULTIPLES; i <= MULTIPLES; i++)
            if (within(edges, count, box, (double)j * vx + (double)i * ux, (double)j * vy + (double)i * uy))
                return 0;
    return 1;
}

/* The passages of `lines` upright lines, that part the length of a row, through all its copies of the region; lines
   with the same number lie on each other. Gives their count; none are written beyond `room`. */
static int64_t passages(const Edge *edges, int64_t count, double ux, double uy, double step, int64_t lines,
                        Passage *found, int64_t room)
{
    double width = step / (double)lines;
    int64_t k, q, n = 0;
    for (k = 0; k < count; k++) {
        Edge e = edges[k];
        double x0 = e.x0 * ux + e.y0 * uy, y0 = e.y0 * ux - e.x0 * uy;
        double x1 = e.x1 * ux + e.y1 * uy, y1 = e.y1 * ux - e.x1 * uy;
        int64_t from = (int64_t)ceil(x0 / width - 0.5), to = (int64_t)ceil(x1 / width - 0.5), way = 1;
        double slope;
        if (from == to)
            continue;
        slope = (y1 - y0) / (x1 - x0);
        if (from > to) {
            int64_t other = from;
            from = to;
            to = other;
            way = -1;
        }
        for (q = from; q < to; q++) {
            if (n < room) {
                int64_t line = q % lines;
                found[n].level = y0 + (((double)q + 0.5) * width - x0) * slope;
                found[n].line = line < 0 ? line + lines : line;
                found[n].way = way;
            }
            n++;
        }
    }
    return n;
}

/* For each row (x, y) the lowest next one, `next`; (0, 0) where none has cells of an area between `least` and `most`.
   `heads` and `filled` are `lines` + 1 numbers, `found` and `sorted` room for `room` passages; gives how many there
   are where that is not enough. */
int64_t lattice_next_rows(int64_t count, const Edge *edges, const double *box, int64_t rows, const double *row,
                          double least, double most, int64_t lines, int64_t tries, int64_t *heads, int64_t *filled,
                          Passage *found, Passage *sorted, int64_t room, double *next)
{
    int64_t r, k, q;
    for (r = 0; r < rows; r++) {
        double ux = row[2 * r], uy = row[2 * r + 1], step = sqrt(ux * ux + uy * uy);
        double low = least / step, top = most / step;
        int64_t many, try;
        next[2 * r] = next[2 * r + 1] = 0.0;
        if (!row_fits(edges, count, box, ux, uy))
            continue;
        many = passages(edges, count, ux / step, uy / step, step, lines, found, room);
        if (many > room)
            return many;
        for (q = 0; q < lines; q++)
            heads[q + 1] = filled[q] = 0;
        heads[0] = 0;
        for (k = 0; k < many; k++)
            heads[found[k].line + 1]++;
        for (q = 0; q < lines; q++)
            heads[q + 1] += heads[q];
        for (k = 0; k < many; k++) {
            /* Those of a line, the lowest first; of two as low as each other the first found. */
            int64_t begin = heads[found[k].line], at = begin + filled[found[k].line]++;
            for (; at > begin && sorted[at - 1].level > found[k].level; at--)
                sorted[at] = sorted[at - 1];
            sorted[at] = found[k];
        }
        for (try = 0; try < tries; try++) {
            /* Of each line the lowest free level that was not tried; of these the lowest. */
            double best = top;
            int64_t line = -1;
            for (q = 0; q < lines; q++) {
                int64_t inside = 0;
                for (k = heads[q]; k < heads[q + 1]; k++) {
                    inside += sorted[k].way;
                    if (inside <= 0 && sorted[k].level > low) {
                        if (sorted[k].level < best) {
                            best = sorted[k].level;
                            line = q;
                        }
                        break;
                    }
                }
            }
            if (line < 0)
                break;
            low = best;
            {
                double x = ((double)line + 0.5) * (step / (double)lines), a = ux / step, b = uy / step;
                double vx = x * a - best * b, vy = x * b + best * a;
                if (rows_fit(edges, count, box, ux, uy, vx, vy)) {
                    next[2 * r] = vx;
                    next[2 * r + 1] = vy;
                    break;
                }
            }
        }
    }
    return 0;
}
