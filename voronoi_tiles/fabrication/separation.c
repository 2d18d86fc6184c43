/* Pieces that overlap, moved until none does: what separation.py does, with the same operations in the same order. */

#include <stdint.h>

#define TOUCH 1e-6
#define SLABS 32
#define SETTLED 4

/* What is known of ways to lie, and the pieces that are moved. Way b overlaps way a where its place, seen from that of
   a, lies within the rings of pair a * ways + b. Its box is cut into slabs, the lowest first, and
   anew, the leftmost first: slab k of all, 2 * SLABS a pair, has the edges (x0, y0, x1, y1) first[k] ... of the next. */
typedef struct {
    int64_t ways, pieces;
    const int64_t *first;
    const double *edges, *boxes, *rooms;
    int64_t *way;
    double *place, *weight, *levels, *spans;
    uint64_t state;
    int64_t tried;
} Sheet;

static uint64_t random_bits(Sheet *s)
{
    s->state ^= s->state << 13;
    s->state ^= s->state >> 7;
    s->state ^= s->state << 17;
    return s->state;
}

static double random_share(Sheet *s) { return (double)(random_bits(s) >> 11) * 0x1p-53; }

/* Where a line along an axis, at `across` on the other, meets the rings of a pair, the least first. */
static int64_t crossings(const Sheet *s, int64_t pair, int axis, double across)
{
    const double *box = s->boxes + 4 * pair;
    int64_t slab = (int64_t)((across - box[1 - axis]) * (SLABS / (box[3 - axis] - box[1 - axis])));
    const int64_t *first = s->first + (2 * pair + axis) * SLABS + (slab < SLABS - 1 ? slab : SLABS - 1);
    const double *e = s->edges + 4 * first[0], *end = s->edges + 4 * first[1];
    int64_t count = 0, k;
    for (; e < end; e += 4) {
        double from = e[1 - axis], to = e[3 - axis];
        if ((from <= across) != (to <= across)) {
            double at = e[axis] + (across - from) * (e[2 + axis] - e[axis]) / (to - from);
            for (k = count++; k > 0 && s->levels[k - 1] > at; k--)
                s->levels[k] = s->levels[k - 1];
            s->levels[k] = at;
        }
    }
    return count;
}

/* How far a place within the rings of a pair is from leaving them along an axis; 0 outside. */
static double way_out(const Sheet *s, int64_t pair, int axis, double along, double across)
{
    int64_t count = crossings(s, pair, axis, across), k;
    for (k = 0; k + 1 < count; k += 2) {
        double a = along - s->levels[k], b = s->levels[k + 1] - along, least = a < b ? a : b;
        if (least > TOUCH)
            return least;
    }
    return 0.0;
}

/* How deep a piece that lies in a way at a place overlaps piece j: by x or by y, whichever is less. */
static double depth(const Sheet *s, int64_t way, double x, double y, int64_t j)
{
    int64_t pair = s->way[j] * s->ways + way;
    const double *box = s->boxes + 4 * pair;
    double dx = x - s->place[2 * j], dy = y - s->place[2 * j + 1], wide, high;
    if (dx <= box[0] || dx >= box[2] || dy <= box[1] || dy >= box[3])
        return 0.0;
    wide = way_out(s, pair, 0, dx, dy);
    if (wide == 0.0)
        return 0.0;
    high = way_out(s, pair, 1, dy, dx);
    return wide < high ? wide : high;
}

static double overlap(const Sheet *s, int64_t i, int64_t way, double x, double y)
{
    double sum = 0.0;
    int64_t j;
    for (j = 0; j < s->pieces; j++)
        if (j != i)
            sum += s->weight[i * s->pieces + j] * depth(s, way, x, y, j);
    return sum;
}

/* The best place on a line for piece i in a way: where what it overlaps, as deep as along the line, weighs least; of
   several the one nearest to `here`. */
static double on_line(Sheet *s, int64_t i, int64_t way, int axis, double across, double here)
{
    const double *room = s->rooms + 4 * way;
    double low = room[axis], high = room[2 + axis], least = 0.0, best = low;
    int64_t spans = 0, j, k, m;
    int any = 0;
    s->tried++;
    for (j = 0; j < s->pieces; j++) {
        int64_t pair = s->way[j] * s->ways + way, count;
        const double *box = s->boxes + 4 * pair;
        double from = s->place[2 * j + axis], level = across - s->place[2 * j + 1 - axis];
        if (j == i || level <= box[1 - axis] || level >= box[3 - axis] || from + box[axis] >= high ||
            from + box[2 + axis] <= low)
            continue;
        count = crossings(s, pair, axis, level);
        for (k = 0; k + 1 < count; k += 2, spans++) {
            s->spans[3 * spans] = from + s->levels[k];
            s->spans[3 * spans + 1] = from + s->levels[k + 1];
            s->spans[3 * spans + 2] = s->weight[i * s->pieces + j];
        }
    }
    for (m = -2; m < 2 * spans; m++) {
        double at = m == -2 ? low : m == -1 ? high : s->spans[3 * (m / 2) + m % 2], sum = 0.0;
        if (at < low || at > high)
            continue;
        for (k = 0; k < spans && (!any || sum <= least); k++) {
            double a = at - s->spans[3 * k], b = s->spans[3 * k + 1] - at, d = a < b ? a : b;
            if (d > TOUCH)
                sum += s->spans[3 * k + 2] * d;
        }
        if (!any || sum < least || (sum == least && (at - here) * (at - here) < (best - here) * (best - here))) {
            any = 1;
            least = sum;
            best = at;
        }
    }
    return best;
}

static double held(double value, double low, double high) { return value < low ? low : value > high ? high : value; }

/* Move a piece to where what it overlaps weighs less, if there is such a place on a few lines. */
static void move_piece(Sheet *s, int64_t i, int64_t from, int64_t to, int64_t lines)
{
    double x = s->place[2 * i], y = s->place[2 * i + 1];
    double least = overlap(s, i, s->way[i], x, y), best_x = x, best_y = y;
    int64_t best_way = s->way[i], way, k;
    for (way = from; way < to && least > 0.0; way++) {
        const double *room = s->rooms + 4 * way;
        for (k = 0; k < lines && least > 0.0; k++) {
            int axis = (int)(k % 2);
            double low = room[1 - axis], high = room[3 - axis], at, sum;
            double across = k < 2 ? held(axis ? x : y, low, high) : low + random_share(s) * (high - low);
            at = on_line(s, i, way, axis, across, axis ? y : x);
            sum = overlap(s, i, way, axis ? across : at, axis ? at : across);
            if (sum < least) {
                least = sum;
                best_x = axis ? across : at;
                best_y = axis ? at : across;
                best_way = way;
            }
        }
    }
    for (k = 0; k < SETTLED && least > 0.0; k++) {
        int axis = (int)(k % 2);
        double at = on_line(s, i, best_way, axis, axis ? best_x : best_y, axis ? best_y : best_x);
        double sum = overlap(s, i, best_way, axis ? best_x : at, axis ? at : best_y);
        if (sum < least) {
            least = sum;
            best_x = axis ? best_x : at;
            best_y = axis ? at : best_y;
        }
    }
    s->place[2 * i] = best_x;
    s->place[2 * i + 1] = best_y;
    s->way[i] = best_way;
}

/* Move pieces until none overlaps another, or `effort` lines were tried; gives how many were, or where some still
   overlap, -1 less as many. A piece of kind k may lie in the ways range[k] ... of the next. */
int64_t pieces_separate(int64_t ways, int64_t pieces, const int64_t *first, const double *edges, const double *boxes,
                        const double *rooms, const int64_t *range, const int64_t *kind, int64_t *way, double *place,
                        double *weight, double *depths, double *levels, double *spans, int64_t *order, int64_t seed,
                        int64_t lines, int64_t effort)
{
    Sheet s = {ways, pieces, first, edges, boxes, rooms, way, place, weight, levels, spans, (uint64_t)seed, 0};
    int64_t i, j, k;
    for (;;) {
        double most = 0.0;
        int64_t wrong = 0;
        for (i = 0; i < pieces; i++)
            for (j = 0; j < i; j++) {
                double d = depth(&s, way[i], place[2 * i], place[2 * i + 1], j);
                depths[i * pieces + j] = depths[j * pieces + i] = d;
                most = d > most ? d : most;
            }
        if (most == 0.0)
            return s.tried;
        if (s.tried >= effort)
            return -s.tried - 1;
        for (i = 0; i < pieces; i++) {
            int too_near = 0;
            for (j = 0; j < pieces; j++) {
                double d = depths[i * pieces + j], *w = weight + i * pieces + j;
                if (j == i)
                    continue;
                too_near |= d > 0.0;
                *w *= d > 0.0 ? 1.2 + 0.8 * d / most : 0.95;
                *w = *w < 1.0 ? 1.0 : *w;
            }
            if (too_near)
                order[wrong++] = i;
        }
        for (k = wrong - 1; k > 0; k--) {
            int64_t other = (int64_t)(random_bits(&s) % (uint64_t)(k + 1)), here = order[k];
            order[k] = order[other];
            order[other] = here;
        }
        for (k = 0; k < wrong; k++)
            move_piece(&s, order[k], range[kind[order[k]]], range[kind[order[k]] + 1], lines);
    }
}
