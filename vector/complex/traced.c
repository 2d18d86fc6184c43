/* The curves of traced boundaries: what `_curves` in traced.py does, bit for bit. */

#include <math.h>
#include <stdint.h>

typedef struct {
    double x, y;
} point;

/* Write the arcs that do not go on along the curve of the one before, and the curve of each; their number.

   The parameters are arrays of Boundary, Rows, Parts, Contour and Copies, and the site of each node; behind them come
   those of _BisectorArcs in traced.py, with room for all arcs. The number of rings is written to `out_rings`. */
int64_t complex_curves(int64_t count, const int64_t *part, const double *vertex, const int64_t *ring,
                       const int64_t *half_edge, const int64_t *corner, const int64_t *row, const int64_t *copy,
                       const int64_t *item, int64_t half_edges, const int64_t *source, const int64_t *target,
                       const int64_t *corner_node, const double *nodes, const double *unit, const double *shift,
                       const uint8_t *conj, double *out_vertex, int64_t *out_bounds, int64_t *out_copy,
                       int64_t *out_item, int64_t *out_node, double *out_ends, int64_t *out_rings)
{
    const point *node = (const point *)nodes, *u = (const point *)unit, *t = (const point *)shift;
    int64_t kept = 0, rings = 0, begin, end, k, side;
    for (begin = 0; begin < count; begin = end) {
        int64_t fresh = 0, again;
        for (end = begin + 1; end < count && ring[end] == ring[begin]; end++)
            ;
        out_bounds[rings++] = kept;
        /* Of a ring with one curve only all arcs are kept, at the second time. */
        for (again = 0; again < 2 && !fresh; again++)
            for (k = begin; k < end; k++) {
                int64_t before = part[k > begin ? k - 1 : end - 1], at = part[k], pair[2][2], first[2][2], carrier[2][2];
                int64_t which;
                for (which = 0; which < 2; which++) {
                    int64_t p = which ? before : at;
                    pair[which][0] = corner[row[p]] >= 0 ? half_edges + corner[row[p]] : half_edge[row[p]];
                    pair[which][1] = item[p];
                    for (side = 0; side < 2; side++) {
                        int64_t i = pair[which][side];
                        first[which][side] = i < half_edges ? source[i] : corner_node[i - half_edges];
                        carrier[which][side] = i < half_edges ? i >> 1 : half_edges + first[which][side];
                    }
                }
                if (!again && carrier[0][0] == carrier[1][0] && carrier[0][1] == carrier[1][1] &&
                    copy[at] == copy[before])
                    continue;
                fresh = 1;
                ((point *)out_vertex)[kept] = ((const point *)vertex)[k];
                out_copy[kept] = copy[at];
                for (side = 0; side < 2; side++) {
                    int64_t i = pair[0][side], second = i < half_edges ? target[i] : first[0][side], c = copy[at];
                    int64_t ends[2] = {first[0][side], second}, n;
                    out_item[side * count + kept] = i;
                    for (n = 0; n < 2; n++) {
                        point z = node[ends[n]], *out = (point *)out_ends + (2 * n + side) * count + kept;
                        out_node[(2 * n + side) * count + kept] = ends[n];
                        if (side) {
                            double y = conj[c] ? -z.y : z.y;
                            out->x = u[c].x * z.x - u[c].y * y + t[c].x;
                            out->y = u[c].y * z.x + u[c].x * y + t[c].y;
                        } else
                            *out = z;
                    }
                }
                kept++;
            }
    }
    out_bounds[rings] = kept;
    *out_rings = rings;
    return kept;
}
