/* How often the outlines of tiles run around the parts of their sites: what windings_of_parts in
   strayed.py does, with the same products and sums. */

#include <stdint.h>
#include <stdlib.h>

typedef struct {
    double x, y;
} Complex;

/* A node that stands for its part. */
typedef struct {
    int64_t tile, node;
    double height;
} Part;

static int by_height(const void *one, const void *two)
{
    const Part *a = one, *b = two;
    if (a->tile != b->tile)
        return a->tile < b->tile ? -1 : 1;
    return (a->height > b->height) - (a->height < b->height);
}

static int64_t least_of(int64_t *least, int64_t node)
{
    while (least[node] != node)
        node = least[node] = least[least[node]];
    return node;
}

static double cross(Complex u, Complex v)
{
    return u.x * v.y - u.y * v.x;
}

static Complex seen_from(Complex point, Complex place)
{
    Complex away = {place.x - point.x, place.y - point.y};
    return away;
}

/* What an arc adds to the winding number of its outline around 0, as in strayed.py. */
static int64_t turns(Complex start, Complex control, Complex end, int curved)
{
    double across = cross(start, end), side = across;
    if (side == 0.0)
        side = end.y - start.y != 0.0 ? -(end.y - start.y) : end.x - start.x;
    int64_t rising = (start.y <= 0.0) - (end.y <= 0.0), result = (double)rising * side > 0.0 ? rising : 0;
    if (curved) {
        double s = cross(control, end), t = -across, r = cross(start, control), sum = s + t + r;
        double sign = (double)((sum > 0.0) - (sum < 0.0));
        if (s * sign > 0.0 && r * sign > 0.0 && side * sign < 0.0 && t * t < 4.0 * s * r)
            result += (int64_t)sign;
    }
    return result;
}

static double least_of_three(double a, double b, double c)
{
    double least = a < b ? a : b;
    return least < c ? least : c;
}

/* For each node that is the least of its part the winding number of its tile's outline around it, for all others 1.
   Arcs are looked at from the parts of their tiles at whose height they are. 0 if all went well. */
int64_t proof_windings(int64_t nodes, const Complex *position, const int64_t *tile, int64_t segments,
                       const int64_t *ends, int64_t arcs, const Complex *start, const Complex *control,
                       const Complex *end, const uint8_t *curved, const int64_t *arc_tile, int64_t *result)
{
    int64_t *least = malloc((size_t)nodes * sizeof(int64_t)), parts = 0;
    Part *part = malloc((size_t)nodes * sizeof(Part));
    int64_t failed = least == NULL || part == NULL;
    for (int64_t k = 0; k < nodes && !failed; k++)
        least[k] = k;
    for (int64_t k = 0; k < segments && !failed; k++) {
        int64_t a = least_of(least, ends[2 * k]), b = least_of(least, ends[2 * k + 1]);
        least[a < b ? b : a] = a < b ? a : b;
    }
    for (int64_t k = 0; k < nodes && !failed; k++) {
        result[k] = least[k] != k;
        if (least[k] == k) {
            Part new = {tile[k], k, position[k].y};
            part[parts++] = new;
        }
    }
    if (!failed)
        qsort(part, (size_t)parts, sizeof(Part), by_height);
    for (int64_t k = 0; k < arcs && !failed; k++) {
        double lowest = least_of_three(start[k].y, control[k].y, end[k].y);
        double highest = -least_of_three(-start[k].y, -control[k].y, -end[k].y);
        Part from = {arc_tile[k], 0, lowest};
        int64_t first = 0, last = parts;
        while (first < last) {
            int64_t middle = (first + last) / 2;
            if (by_height(part + middle, &from) < 0)
                first = middle + 1;
            else
                last = middle;
        }
        for (; first < parts && part[first].tile == arc_tile[k] && part[first].height <= highest; first++) {
            Complex point = position[part[first].node];
            result[part[first].node] += turns(seen_from(point, start[k]), seen_from(point, control[k]),
                                              seen_from(point, end[k]), curved[k]);
        }
    }
    free(least);
    free(part);
    return failed;
}
