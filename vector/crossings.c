/* The pairs of arcs of one outline that may cross: what `_swept` in crossings.py does, with the same comparisons. */

#include <stdint.h>
#include <stdlib.h>

/* An arc's upright box. */
typedef struct {
    int64_t tile, arc;
    double left, right, low, high;
} Box;

static int from_left_to_right(const void *one, const void *two)
{
    const Box *a = one, *b = two;
    if (a->tile != b->tile)
        return a->tile < b->tile ? -1 : 1;
    if (a->left != b->left)
        return a->left < b->left ? -1 : 1;
    return (a->arc > b->arc) - (a->arc < b->arc);
}

static double least(double a, double b, double c)
{
    double d = a < b ? a : b;
    return d < c ? d : c;
}

static double most(double a, double b, double c)
{
    double d = a > b ? a : b;
    return d > c ? d : c;
}

/* Whether more than an end lies in both ranges; a range without length meets only itself. */
static int meet(double low, double high, double other_low, double other_high)
{
    return (low < other_high && other_low < high) || (low == other_high && other_low == high);
}

/* Write the pairs; their number, -1 where more than `limit` are above each other, -2 where memory runs out.

   Points are x and y in turn. */
int64_t proof_pairs(int64_t count, const double *start, const double *control, const double *end, const int64_t *tile,
                    int64_t limit, int64_t *out_i, int64_t *out_j)
{
    int64_t found = 0, looked_at = 0, k, m;
    Box *boxes = malloc(((size_t)count + 1) * sizeof *boxes);
    if (!boxes)
        return -2;
    for (k = 0; k < count; k++) {
        const double *a = start + 2 * k, *b = control + 2 * k, *c = end + 2 * k;
        Box box = {tile[k], k, least(a[0], b[0], c[0]), most(a[0], b[0], c[0]), least(a[1], b[1], c[1]),
                   most(a[1], b[1], c[1])};
        boxes[k] = box;
    }
    qsort(boxes, (size_t)count, sizeof *boxes, from_left_to_right);
    for (k = 0; k < count && looked_at <= limit; k++) {
        const Box *a = boxes + k;
        for (m = k + 1; m < count && boxes[m].tile == a->tile && boxes[m].left <= a->right; m++) {
            const Box *b = boxes + m;
            if (++looked_at > limit)
                break;
            if (meet(a->left, a->right, b->left, b->right) && meet(a->low, a->high, b->low, b->high)) {
                out_i[found] = a->arc < b->arc ? a->arc : b->arc;
                out_j[found++] = a->arc < b->arc ? b->arc : a->arc;
            }
        }
    }
    free(boxes);
    return looked_at > limit ? -1 : found;
}
