/* The boxes of a tree that meet other boxes: what box_index.py finds with shapely's tree, by the same comparisons. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define WIDTH 8
#define FEW 32
#define TOGETHER 8 /* boxes that stand beside each other in what is asked are most often near to each other */
#define ROOM 64

/* A box: its least x and y, and its greatest. */
typedef struct {
    double left, low, right, high;
} Box;

static int meet(const Box *a, const Box *b)
{
    return a->left <= b->right && b->left <= a->right && a->low <= b->high && b->low <= a->high;
}

static int rising(const void *one, const void *two)
{
    int64_t a = *(const int64_t *)one, b = *(const int64_t *)two;
    return (a > b) - (a < b);
}

/* Put places into rising order; most often they are few. */
static void sort(int64_t *places, int64_t count)
{
    int64_t k, m, place;
    if (count > FEW) {
        qsort(places, (size_t)count, sizeof *places, rising);
        return;
    }
    for (k = 1; k < count; k++) {
        place = places[k];
        for (m = k; m > 0 && places[m - 1] > place; m--)
            places[m] = places[m - 1];
        places[m] = place;
    }
}

/* The places of the tree's smallest boxes that meet a box; as long as there is `room` they are written, and more than
   `most` are not looked for. Their number.

   The tree's boxes stand level by level, level k from first[k] up to first[k + 1], the smallest first: box m of a level
   holds the boxes WIDTH m ... of the level before it. */
static int64_t beneath(const Box *box, int64_t levels, const int64_t *first, const Box *tree, int64_t room, int64_t most,
                       int64_t *out)
{
    int64_t found = 0, depth = 0, top = levels - 1, m, stack[64 * WIDTH][2];
    for (m = 0; m < first[levels] - first[top]; m++) {
        stack[depth][0] = top;
        stack[depth++][1] = m;
    }
    while (depth && found <= most) {
        int64_t level = stack[--depth][0], place = stack[depth][1], below, last;
        if (!meet(box, tree + first[level] + place))
            continue;
        if (!level) {
            if (found < room)
                out[found] = place;
            found++;
            continue;
        }
        below = first[level] - first[level - 1];
        last = WIDTH * (place + 1) < below ? WIDTH * (place + 1) : below;
        for (m = WIDTH * place; m < last; m++) {
            stack[depth][0] = level - 1;
            stack[depth++][1] = m;
        }
    }
    return found;
}

/* The box that holds some; those that are no numbers meet nothing, and do not count. */
static Box hull(const Box *boxes, int64_t count)
{
    Box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    int64_t k;
    for (k = 0; k < count; k++) {
        all.left = boxes[k].left < all.left ? boxes[k].left : all.left;
        all.low = boxes[k].low < all.low ? boxes[k].low : all.low;
        all.right = boxes[k].right > all.right ? boxes[k].right : all.right;
        all.high = boxes[k].high > all.high ? boxes[k].high : all.high;
    }
    return all;
}

/* Write the pairs of a box that is asked for and one of the tree, in order, as long as there is `room`; their number.
   The box at place m of the tree is the one with number order[m]; there are fewer than 2^31.

   What a few boxes may meet is looked for at once, where it is not too much. */
int64_t base_boxes_meeting(int64_t asked, const Box *boxes, int64_t levels, const int64_t *first, const Box *tree,
                           const int64_t *order, int64_t room, int64_t *out_i, int64_t *out_j)
{
    int64_t found = 0, k, m, n, held[ROOM];
    for (k = 0; k < asked; k += TOGETHER) {
        int64_t few = asked - k < TOGETHER ? asked - k : TOGETHER;
        Box all = hull(boxes + k, few);
        int64_t count = beneath(&all, levels, first, tree, ROOM, ROOM, held);
        if (count <= ROOM) {
            for (m = 0; m < count; m++)
                held[m] |= order[held[m]] << 32;
            sort(held, count);
        }
        for (n = k; n < k + few; n++) {
            if (count <= ROOM) {
                for (m = 0; m < count; m++)
                    if (meet(boxes + n, tree + (held[m] & 0xffffffff))) {
                        if (found < room) {
                            out_i[found] = n;
                            out_j[found] = held[m] >> 32;
                        }
                        found++;
                    }
            } else {
                int64_t begun = found < room ? found : room;
                int64_t more = beneath(boxes + n, levels, first, tree, room - begun, INT64_MAX, out_j + begun);
                for (m = begun; m < begun + more && m < room; m++) {
                    out_i[m] = n;
                    out_j[m] = order[out_j[m]];
                }
                found += more;
                if (found <= room)
                    sort(out_j + begun, more);
            }
        }
    }
    return found;
}
