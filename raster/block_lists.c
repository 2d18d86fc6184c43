/* The kernel of block_lists.py: which elements of each block's list can matter near the block's centre.
 *
 * The same as _keep there, with the same bits: every operation on doubles is one of numpy's, in its order. What is
 * decided without a square root or a division follows from sums, differences and roots being monotone when rounded.
 */

#include <math.h>
#include <stdint.h>

static double least(double a, double b) { return b < a ? b : a; }
static double greatest(double a, double b) { return b > a ? b : a; }

/* How an element's nearest point leads to a block's centre; the square of the distance. */
static double from_foot(const double *centre, const double *middle, const double *half, double *x, double *y) {
    double away_x = centre[0] - middle[0], away_y = centre[1] - middle[1];
    double share = away_x * half[0] + away_y * half[1];
    double square = half[0] * half[0] + half[1] * half[1];
    square = square > 1e-300 ? square : 1e-300;
    share = fabs(share) < square ? share / square : copysign(1.0, share);
    away_x -= share * half[0];
    away_y -= share * half[1];
    *x = away_x;
    *y = away_y;
    return away_x * away_x + away_y * away_y;
}

/* Keep of the lists `element[first[b]] ... element[last[b] - 1]` of `blocks` blocks, none of them empty, what can
 * matter within `radius` of centre[b]: into `kept`, block after block, count[b] of each; the sum of the counts.
 *
 * Points are pairs of doubles. `label`, `middle` and `half` are the scene's; the labels of a list are in runs, one of
 * each copy. `reals` has room for 4 doubles and `runs` for 1 integer for each element of the longest list.
 */
int64_t raster_keep(int64_t blocks, const int64_t *first, const int64_t *last, const double *centre, double radius,
                    double loose, const int32_t *element, const int32_t *label, const double *middle,
                    const double *half, double *reals, int64_t *runs, int32_t *kept, int64_t *count) {
    int64_t total = 0;
    for (int64_t b = 0; b < blocks; b++) {
        const int32_t *list = element + first[b];
        const int64_t size = last[b] - first[b];
        double *distance = reals, *x = distance + size, *y = x + size, *nearest = y + size;
        double smallest = INFINITY, second = INFINITY;
        int64_t *run_end = runs, run_count = 0;
        for (int64_t i = 0; i < size;) {
            const int32_t copy = label[list[i]];
            double square = INFINITY; /* the roots are taken later, of what matters: the least has the least one */
            for (; i < size && label[list[i]] == copy; i++) {
                const int64_t k = list[i];
                distance[i] = from_foot(centre + 2 * b, middle + 2 * k, half + 2 * k, &x[i], &y[i]);
                square = least(square, distance[i]);
            }
            const double d = sqrt(square);
            second = least(second, d < smallest ? smallest : d);
            smallest = least(smallest, d);
            run_end[run_count] = i;
            nearest[run_count++] = d;
        }
        const double reach = (second + 2 * radius) * loose, limit = 2 * radius;
        const int64_t before = total;
        for (int64_t run = 0, i = 0; run < run_count; run++) {
            const double d = nearest[run];
            const int64_t start = i, end = run_end[run];
            i = end;
            if (!(d <= reach)) continue;
            for (int64_t j = start; j < end; j++) distance[j] = sqrt(distance[j]);
            int64_t w = start;
            while (w < end - 1 && distance[w] != d) w++;
            const double bend = radius * radius / (2.0 * d), scale = 1.0 / (d > 0.0 ? d : 1.0);
            const double gradient_x = x[w] * scale, gradient_y = y[w] * scale;
            for (int64_t j = start; j < end; j++) { /* without branches: the compiler takes two at once */
                const double excess = distance[j] - d, slack = (loose - 1.0) * (distance[j] + radius);
                const double turn_x = x[j] - gradient_x * distance[j], turn_y = y[j] - gradient_y * distance[j];
                const double beyond = greatest(excess - bend - slack, 0.0) * distance[j];
                const double turn = (turn_x * turn_x + turn_y * turn_y) * (radius * radius);
                x[j] = excess - slack;
                y[j] = turn - beyond * beyond;
            }
            for (int64_t j = start; j < end; j++) {
                kept[total] = list[j];
                total += (x[j] <= limit) & (y[j] >= 0.0);
            }
        }
        count[b] = total - before;
    }
    return total;
}
