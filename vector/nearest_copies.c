/* The nearest of all copies of all elements, for blocks of a few neighbouring points: what nearest_copies.py does.

   The two inequalities that leave boxes out are those that stand there, and the distances are taken by the same
   operations in the same order: of each point the same pairs are found, all those whose element has a copy that is no
   farther than the nearest one and the slack. Which boxes are looked at on the way is another matter and does not show:
   they are made here as in box_tree.py, but rounding may differ by far less than the slack. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define WIDTH 8 /* boxes in a box of the next level, as in box_tree.py */
#define DEPTH 20
#define BLOCK 16 /* points of a block */

typedef struct {
    double x, y;
} Complex;

/* All centre + x axis + y i axis with |x| <= half_length and |y| <= half_width; |axis| = 1. */
typedef struct {
    Complex centre, axis;
    double half_length, half_width;
} Box;

/* The entries as boxes without width, and boxes of each WIDTH boxes of the level before, up to a level of at most
   WIDTH: those of one level stand from its `first` up to that of the next. No tree has more than DEPTH levels. */
typedef struct {
    int64_t levels, first[DEPTH + 1];
    Box *box;
} Tree;

/* One copy of the tree: the image of a point under a motion, less the shift; no box of it is nearer to the anchor. */
typedef struct {
    int64_t motion;
    Complex shift;
    double nearest;
} Copy;

/* An entry of a copy of the tree, and its distance from a point. */
typedef struct {
    const Copy *copy;
    int64_t entry;
    double distance;
} Found;

typedef struct {
    Found *items;
    int64_t count, size;
} List;

/* A box, with the vector that leads from it to a point. */
typedef struct {
    int64_t level, box;
    double distance;
    Complex away;
} Seen;

static double from_segment(Complex point, Complex start, Complex chord)
{
    double x = point.x - start.x, y = point.y - start.y;
    double square = chord.x * chord.x + chord.y * chord.y;
    double share = (x * chord.x + y * chord.y) / (square > 0.0 ? square : 1.0);
    double foot = share > 0.0 ? share : 0.0;
    foot = foot < 1.0 ? foot : 1.0;
    x = x - foot * chord.x;
    y = y - foot * chord.y;
    return sqrt(x * x + y * y);
}

static double beyond(double value, double half)
{
    return value > half ? value - half : value < -half ? value + half : 0.0;
}

static double square(const Box *box, Complex point)
{
    double x = point.x - box->centre.x, y = point.y - box->centre.y;
    double u = box->axis.x, v = box->axis.y;
    double along = fabs(x * u + y * v) - box->half_length;
    double across = fabs(y * u - x * v) - box->half_width;
    along = along > 0.0 ? along : 0.0;
    across = across > 0.0 ? across : 0.0;
    return along * along + across * across;
}

static Seen look(const Tree *tree, int64_t level, int64_t number, Complex point)
{
    const Box *box = tree->box + number;
    double x = point.x - box->centre.x, y = point.y - box->centre.y;
    double u = box->axis.x, v = box->axis.y;
    double along = beyond(x * u + y * v, box->half_length);
    double across = beyond(y * u - x * v, box->half_width);
    Seen seen = {level, number, sqrt(along * along + across * across), {along * u - across * v, along * v + across * u}};
    return seen;
}

/* A segment as a box. */
static Box box_of(Complex start, Complex chord)
{
    double length = sqrt(chord.x * chord.x + chord.y * chord.y);
    Box box = {{start.x + chord.x / 2.0, start.y + chord.y / 2.0}, {1.0, 0.0}, length / 2.0, 0.0};
    if (length > 0.0) {
        box.axis.x = chord.x / length;
        box.axis.y = chord.y / length;
    }
    return box;
}

/* The end `k` of segments: first both of one, then both of the next. */
static Complex end_of(const Complex *start, const Complex *chord, int64_t k)
{
    Complex end = start[k / 2];
    if (k % 2) {
        end.x += chord[k / 2].x;
        end.y += chord[k / 2].y;
    }
    return end;
}

/* The box around segments along their principal axis: as the square of a direction does not know its sign, that is the
   root of the sum of the squares of all vectors from the mean. */
static Box box_around(int64_t count, const Complex *start, const Complex *chord)
{
    Complex mean = {0.0, 0.0}, sum = {0.0, 0.0};
    double left = INFINITY, right = -INFINITY, below = INFINITY, above = -INFINITY;
    for (int64_t k = 0; k < 2 * count; k++) {
        Complex end = end_of(start, chord, k);
        mean.x += end.x / (double)(2 * count);
        mean.y += end.y / (double)(2 * count);
    }
    for (int64_t k = 0; k < 2 * count; k++) {
        Complex end = end_of(start, chord, k);
        double x = end.x - mean.x, y = end.y - mean.y;
        sum.x += x * x - y * y;
        sum.y += 2.0 * x * y;
    }
    double size = sqrt(sum.x * sum.x + sum.y * sum.y), u = 1.0, v = 0.0;
    if (size > 0.0 && sum.x >= 0.0) {
        u = sqrt((1.0 + sum.x / size) / 2.0);
        v = sum.y / size / (2.0 * u);
    } else if (size > 0.0) {
        v = sqrt((1.0 - sum.x / size) / 2.0);
        u = sum.y / size / (2.0 * v);
    }
    for (int64_t k = 0; k < 2 * count; k++) {
        Complex end = end_of(start, chord, k);
        double x = end.x - mean.x, y = end.y - mean.y, along = x * u + y * v, across = y * u - x * v;
        left = along < left ? along : left;
        right = along > right ? along : right;
        below = across < below ? across : below;
        above = across > above ? across : above;
    }
    double along = (left + right) / 2.0, across = (below + above) / 2.0;
    Box box = {{mean.x + (along * u - across * v), mean.y + (along * v + across * u)}, {u, v}, (right - left) / 2.0,
               (above - below) / 2.0};
    return box;
}

/* 0 where there is no memory for it. */
static int grow(Tree *tree, int64_t count, const Complex *start, const Complex *chord)
{
    int64_t boxes = 0, width = 1, here = WIDTH + 1;
    for (tree->levels = 0; here > WIDTH; width *= WIDTH) {
        here = (count - 1) / width + 1;
        tree->first[tree->levels++] = boxes;
        boxes += here;
    }
    tree->first[tree->levels] = boxes;
    tree->box = malloc((size_t)boxes * sizeof(Box));
    if (tree->box == NULL)
        return 0;
    Box *box = tree->box;
    for (int64_t k = 0; k < count; k++)
        *box++ = box_of(start[k], chord[k]);
    width = WIDTH;
    for (int64_t level = 1; level < tree->levels; level++, width *= WIDTH)
        for (int64_t k = 0; k < count; k += width)
            *box++ = box_around(count - k < width ? count - k : width, start + k, chord + k);
    return 1;
}

static Complex image(Complex point, Complex unit, Complex shift, int conj, Complex less)
{
    double y = conj ? -point.y : point.y;
    Complex result = {unit.x * point.x - unit.y * y + shift.x, unit.y * point.x + unit.x * y + shift.y};
    result.x = result.x - less.x;
    result.y = result.y - less.y;
    return result;
}

static int append(List *list, Found found)
{
    if (list->count == list->size) {
        int64_t size = 2 * list->size + 64;
        Found *items = realloc(list->items, (size_t)size * sizeof(Found));
        if (items == NULL)
            return 0;
        list->items = items;
        list->size = size;
    }
    list->items[list->count++] = found;
    return 1;
}

/* What is known of a block and one copy: what the two inequalities need. */
typedef struct {
    double radius, slack;
    double of_all;      /* the distance of the block's middle from the nearest element of any copy */
    double of_copy;     /* that from the nearest of this copy */
    Complex direction;  /* the unit vector from that one */
} Known;

static int possible(const Known *known, const Seen *seen)
{
    double bound = known->of_copy + 2.0 * known->slack;
    if (seen->distance > known->of_all + 2.0 * (known->radius + known->slack))
        return 0;
    if (seen->distance <= bound || !(known->of_copy > 0.0))
        return 1;
    double x = seen->away.x / seen->distance - known->direction.x;
    double y = seen->away.y / seen->distance - known->direction.y;
    bound = bound + known->radius * known->radius / (2.0 * known->of_copy) + sqrt(x * x + y * y) * known->radius;
    return seen->distance <= bound;
}

/* Go down one copy of the tree: the entries that can be nearest to a point of the block are appended to the list. Of
   each level at most WIDTH boxes wait at once. */
static int descend(const Tree *tree, Complex middle, Known *known, Found found, List *list)
{
    Seen stack[WIDTH * DEPTH];
    int64_t waiting = 0, top = tree->levels - 1, before = list->count;
    known->of_copy = INFINITY;
    for (int64_t box = tree->first[top]; box < tree->first[top + 1]; box++)
        stack[waiting++] = look(tree, top, box, middle);
    while (waiting > 0) {
        Seen seen = stack[--waiting];
        if (!possible(known, &seen))
            continue;
        if (seen.level == 0) {
            if (seen.distance < known->of_copy) {
                known->of_copy = seen.distance;
                known->direction.x = seen.away.x / seen.distance;
                known->direction.y = seen.away.y / seen.distance;
                if (seen.distance < known->of_all)
                    known->of_all = seen.distance;
            }
            found.entry = seen.box;
            found.distance = seen.distance;
            if (!append(list, found))
                return 0;
            continue;
        }
        int64_t begin = tree->first[seen.level - 1] + WIDTH * (seen.box - tree->first[seen.level]);
        int64_t end = begin + WIDTH < tree->first[seen.level] ? begin + WIDTH : tree->first[seen.level];
        int64_t below = waiting;
        double bound = known->of_all + 2.0 * (known->radius + known->slack), squares[WIDTH];
        for (int64_t box = begin; box < end; box++)
            squares[box - begin] = square(tree->box + box, middle);
        for (int64_t box = begin; box < end; box++) {
            if (squares[box - begin] > bound * bound)
                continue;
            Seen child = look(tree, seen.level - 1, box, middle);
            if (!possible(known, &child))
                continue;
            /* The nearest is on top. */
            int64_t place = waiting++;
            for (; place > below && stack[place - 1].distance < child.distance; place--)
                stack[place] = stack[place - 1];
            stack[place] = child;
        }
    }
    /* Without those that came before the nearest was known. */
    int64_t kept = before;
    for (int64_t k = before; k < list->count; k++)
        if (list->items[k].distance <= known->of_all + 2.0 * (known->radius + known->slack))
            list->items[kept++] = list->items[k];
    list->count = kept;
    return 1;
}

/* For `count` points the distance from the nearest copy of any element, and the distances of their `places`, two rows,
   from the nearest element of their `sites`, two rows, among the pairs found; `result` has three rows. Copies are chosen
   anew where points are farther than `near` from the place for which they were chosen: the motions followed by up to
   m and n steps along the vectors of the reduced `basis`. The first row of places are the points. 0 if all went well. */
int64_t proof_nearest(int64_t count, const Complex *places, const int64_t *sites, int64_t motions, const Complex *unit,
                      const Complex *shift, const uint8_t *conj, const Complex *basis, int64_t m, int64_t n,
                      double near, double slack, int64_t elements, const Complex *start, const Complex *chord,
                      const int64_t *element, const int64_t *site, const Complex *site_start,
                      const Complex *site_chord, double *result)
{
    const Complex *points = places, p = basis[0], q = basis[1];
    double det = p.x * q.y - p.y * q.x;
    Tree tree;
    List entries = {NULL, 0, 0}, pairs = {NULL, 0, 0};
    int64_t copies = motions * (2 * m + 1) * (2 * n + 1);
    Copy *copy = malloc((size_t)copies * sizeof(Copy));
    int64_t failed = !grow(&tree, elements, start, chord) || copy == NULL, chosen = 0, size;
    Complex anchor = {0.0, 0.0}, zero = {0.0, 0.0};
    for (int64_t k = 0; k < count && !failed; k += size) {
        Known known = {0.0, slack, INFINITY, INFINITY, zero};
        Complex middle = zero;
        /* Fewer points where these are far apart, for they have few elements in common. */
        for (size = count - k < BLOCK ? count - k : BLOCK;; size = (size + 1) / 2) {
            middle = zero;
            known.radius = 0.0;
            for (int64_t b = 0; b < size; b++) {
                middle.x += points[k + b].x / (double)size;
                middle.y += points[k + b].y / (double)size;
            }
            for (int64_t b = 0; b < size; b++) {
                double x = points[k + b].x - middle.x, y = points[k + b].y - middle.y, away = sqrt(x * x + y * y);
                known.radius = away > known.radius ? away : known.radius;
            }
            if (size == 1 || known.radius <= near / 4.0)
                break;
        }
        double x = middle.x - anchor.x, y = middle.y - anchor.y, away = sqrt(x * x + y * y);
        if (!chosen || !(away + known.radius <= near)) {
            chosen = 1;
            anchor = middle;
            away = 0.0;
            int64_t known_copies = 0;
            for (int64_t g = 0; g < motions; g++) {
                Complex w = image(anchor, unit[g], shift[g], conj[g], zero);
                double s = rint((w.x * q.y - w.y * q.x) / det), t = rint((p.x * w.y - p.y * w.x) / det);
                for (int64_t i = -m; i <= m; i++)
                    for (int64_t j = -n; j <= n; j++) {
                        double x = s + (double)i, y = t + (double)j;
                        Copy next = {g, {x * p.x + y * q.x, x * p.y + y * q.y}, INFINITY};
                        Complex from = {w.x - next.shift.x, w.y - next.shift.y};
                        for (int64_t box = tree.first[tree.levels - 1]; box < tree.first[tree.levels]; box++) {
                            double nearer = square(tree.box + box, from);
                            next.nearest = nearer < next.nearest ? nearer : next.nearest;
                        }
                        next.nearest = sqrt(next.nearest);
                        /* The nearest first. */
                        int64_t place = known_copies++;
                        for (; place > 0 && copy[place - 1].nearest > next.nearest; place--)
                            copy[place] = copy[place - 1];
                        copy[place] = next;
                    }
            }
        }
        entries.count = 0;
        for (const Copy *next = copy; next < copy + copies && !failed; next++) {
            if (next->nearest - away > known.of_all + 2.0 * (known.radius + slack))
                break;
            Complex from = image(middle, unit[next->motion], shift[next->motion], conj[next->motion], next->shift);
            Found found = {next, 0, 0.0};
            failed = !descend(&tree, from, &known, found, &entries);
        }
        for (int64_t b = k; b < k + size && !failed; b++) {
            double nearest = INFINITY, least[2] = {INFINITY, INFINITY};
            Complex from = zero;
            pairs.count = 0;
            for (int64_t e = 0; e < entries.count && !failed; e++) {
                Found found = entries.items[e];
                if (e == 0 || found.copy != entries.items[e - 1].copy) {
                    int64_t g = found.copy->motion;
                    from = image(points[b], unit[g], shift[g], conj[g], found.copy->shift);
                }
                found.distance = from_segment(from, start[found.entry], chord[found.entry]);
                if (found.distance <= nearest + slack) {
                    nearest = found.distance < nearest ? found.distance : nearest;
                    failed = !append(&pairs, found);
                }
            }
            for (int64_t e = 0; e < pairs.count; e++) {
                if (!(pairs.items[e].distance <= nearest + slack))
                    continue;
                int64_t which = element[pairs.items[e].entry];
                for (int64_t side = 0; side < 2; side++)
                    if (site[which] == sites[side * count + b]) {
                        double distance =
                            from_segment(places[side * count + b], site_start[which], site_chord[which]);
                        least[side] = distance < least[side] ? distance : least[side];
                    }
            }
            result[b] = nearest;
            result[count + b] = least[0];
            result[2 * count + b] = least[1];
        }
    }
    free(tree.box);
    free(copy);
    free(entries.items);
    free(pairs.items);
    return failed;
}
