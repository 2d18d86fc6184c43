/* The kernel of block_lists.py: which elements of each block's list can matter near the block's centre.
 *
 * The same as _keep there, with the same bits: every operation on doubles is one of numpy's, in its order. The loops
 * over elements have no branches, so that the compiler takes two elements at once.
 */

#include <math.h>
#include <stdint.h>

static double least(double a, double b) { return b < a ? b : a; }
static double greatest(double a, double b) { return b > a ? b : a; }

/* How the nearest points of elements of a list lead to a block's centre, and the squares of the distances. */
static void from_feet(const double *centre, const int32_t *list, int64_t count, const double *restrict middle,
                      const double *restrict unit, const double *restrict length, double *restrict square,
                      double *restrict x, double *restrict y) {
    const double centre_x = centre[0], centre_y = centre[1];
/* It would take one at a time, since it must gather them: two are faster all the same. */
#pragma clang loop vectorize(enable)
    for (int64_t j = 0; j < count; j++) {
        const int64_t k = list[j];
        const double unit_x = unit[2 * k], unit_y = unit[2 * k + 1];
        double away_x = centre_x - middle[2 * k], away_y = centre_y - middle[2 * k + 1];
        const double along = least(greatest(away_x * unit_x + away_y * unit_y, -length[k]), length[k]);
        away_x -= along * unit_x;
        away_y -= along * unit_y;
        x[j] = away_x;
        y[j] = away_y;
        square[j] = away_x * away_x + away_y * away_y;
    }
}

/* The least of some values, one of them at least. */
static double least_of(const double *value, int64_t count) {
    double even = INFINITY, odd = INFINITY;
    for (int64_t j = 0; j + 1 < count; j += 2) {
        even = least(even, value[j]);
        odd = least(odd, value[j + 1]);
    }
    return least(least(even, odd), value[count - 1]);
}

/* The element of a run that is nearest to the block's centre: its distance, the gradient of that, r^2 / 2D. */
typedef struct {
    double distance, gradient_x, gradient_y, bend;
} winner;

static winner winner_of(int64_t count, double radius, const double *square, const double *x, const double *y) {
    const double least_square = least_of(square, count);
    int64_t j = 0;
    while (j < count - 1 && square[j] != least_square) j++;
    const double distance = sqrt(least_square), scale = 1.0 / (distance > 0.0 ? distance : 1.0);
    return (winner){distance, x[j] * scale, y[j] * scale, radius * radius / (2.0 * distance)};
}

/* Whether elements can be nearer somewhere in the disc than another one: at least 0 in `turned` if so. */
static void judge(int64_t count, const winner *than, double radius, double loose, const double *restrict square,
                  const double *restrict x, const double *restrict y, double *restrict turned) {
    for (int64_t j = 0; j < count; j++) {
        const double distance = sqrt(square[j]), excess = distance - than->distance;
        const double slack = (loose - 1.0) * (distance + radius);
        const double turn_x = x[j] - than->gradient_x * distance, turn_y = y[j] - than->gradient_y * distance;
        const double turn = (turn_x * turn_x + turn_y * turn_y) * (radius * radius);
        const double beyond = greatest(excess - than->bend - slack, 0.0) * distance;
        turned[j] = least(turn - beyond * beyond, 2 * radius - (excess - slack));
    }
}

/* Keep of the lists of `blocks` blocks what can matter within `radius` of centre[b]: into `kept`, block after block, in
 * runs of kept_size[...] elements of the copy kept_label[...], kept_runs[b] of each block; the number of elements.
 *
 * Block b has the list of its parent: the runs from run_start[parent[b]] up to run_start[parent[b] + 1], where run k are
 * the elements element[first[k]] ... element[last[k] - 1] of the copy label[k]; none is empty. Points are pairs of
 * doubles; `middle`, `unit` and `length` are the scene's. `reals` has room for 10 doubles for each element of the longest
 * list.
 */
int64_t raster_keep(int64_t blocks, const int64_t *parent, const double *centre, double radius, double loose,
                    double spare, const int64_t *run_start, const int32_t *label, const int64_t *first,
                    const int64_t *last, const int32_t *element, const double *middle, const double *unit,
                    const double *length, double *reals, int64_t *kept_runs, int32_t *kept_label, int64_t *kept_size,
                    int32_t *kept) {
    int64_t total = 0, runs = 0;
    for (int64_t b = 0; b < blocks; b++) {
        const int64_t run_first = run_start[parent[b]], run_last = run_start[parent[b] + 1], runs_before = runs;
        int64_t size = 0;
        for (int64_t run = run_first; run < run_last; run++) size += last[run] - first[run];
        double *square = reals, *x = square + size, *y = x + size;
        double *turned = y + size, *turned_first = turned + size, *turned_second = turned_first + size;
        winner *winners = (winner *)(turned_second + size);
        const winner none = {INFINITY, 0.0, 0.0, 0.0}, *nearest = &none, *second = &none;
        for (int64_t run = run_first, i = 0; run < run_last; run++) {
            const int64_t count = last[run] - first[run];
            from_feet(centre + 2 * b, element + first[run], count, middle, unit, length, square + i, x + i, y + i);
            winner *own = winners + (run - run_first);
            *own = winner_of(count, radius, square + i, x + i, y + i);
            if (own->distance < nearest->distance) {
                second = nearest;
                nearest = own;
            } else if (own->distance < second->distance) {
                second = own;
            }
            i += count;
        }
        const double reach = (second->distance + 2 * radius) * loose;
        winner first_rival = *nearest, second_rival = *second;
        first_rival.distance += spare * radius;
        second_rival.distance += spare * radius;
        for (int64_t run = run_first, i = 0; run < run_last; run++) {
            const int64_t count = last[run] - first[run], before = total;
            const winner *own = winners + (run - run_first);
            if (own->distance <= reach) {
                judge(count, own, radius, loose, square + i, x + i, y + i, turned);
                if (own != nearest && own != second) {
                    judge(count, &first_rival, radius, loose, square + i, x + i, y + i, turned_first);
                    judge(count, &second_rival, radius, loose, square + i, x + i, y + i, turned_second);
                    for (int64_t j = 0; j < count; j++)
                        turned[j] = least(turned[j], greatest(turned_first[j], turned_second[j]));
                }
                for (int64_t j = 0; j < count; j++) {
                    kept[total] = element[first[run] + j];
                    total += turned[j] >= 0.0;
                }
            }
            kept_label[runs] = label[run];
            kept_size[runs] = total - before;
            runs += total > before;
            i += count;
        }
        kept_runs[b] = runs - runs_before;
    }
    return total;
}
