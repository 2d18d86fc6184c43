/* The boxes of a tree that meet other boxes: what box_index.py finds with shapely's tree, by the same comparisons. */

#include <stdint.h>
#include <stdlib.h>

#define WIDTH 8
#define FEW 32

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

/* Write the pairs of a box that is asked for and one of the tree, in order, as long as there is `room`; their number.

   The tree's boxes stand level by level, level k from first[k] up to first[k + 1], the smallest first: box m of a level
   holds the boxes WIDTH m ... of the level before it. Box m of level 0 is the one with number order[m]. */
int64_t base_boxes_meeting(int64_t asked, const Box *boxes, int64_t levels, const int64_t *first, const Box *tree,
                           const int64_t *order, int64_t room, int64_t *out_i, int64_t *out_j)
{
    int64_t found = 0, k, m, begun, stack[64 * WIDTH][2];
    for (k = 0; k < asked; k++) {
        int64_t depth = 0, top = levels - 1;
        begun = found;
        for (m = 0; m < first[levels] - first[top]; m++) {
            stack[depth][0] = top;
            stack[depth++][1] = m;
        }
        while (depth) {
            int64_t level = stack[--depth][0], place = stack[depth][1], below, last;
            if (!meet(boxes + k, tree + first[level] + place))
                continue;
            if (!level) {
                if (found < room) {
                    out_i[found] = k;
                    out_j[found] = order[place];
                }
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
        if (found <= room)
            sort(out_j + begun, found - begun);
    }
    return found;
}
