/* From the bounds of single cells to the closed boundaries of tiles: what trace.py does in numpy, and as there. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define OPEN (-1)
#define NO_MEMORY (-3)

typedef struct {
    double x, y;
} point;

/* The first and the last part of a half-edge or a corner; -1 where it has no rows. */
typedef struct {
    int64_t first, last;
} span;

/* A part that has no next one, by where it ends, or is none's, by where it starts. */
typedef struct {
    int64_t site, part;
    double along;
    point at;
} loose;

static int by_place(const void *one, const void *two)
{
    const loose *a = one, *b = two;
    if (a->site != b->site)
        return a->site < b->site ? -1 : 1;
    if (a->along != b->along)
        return a->along < b->along ? -1 : 1;
    return a->part < b->part ? -1 : 1;
}

/* Chain up the loose ends of each site with its starts, where their order along one direction tells how (`_match`). */
static int match(int64_t parts, point slant, const uint8_t *inner, const point *start, const point *end,
                 const int64_t *site, int64_t *following, uint8_t *entered)
{
    int64_t ends = 0, starts = 0, k;
    loose *left, *right;
    for (k = 0; k < parts; k++) {
        ends += !inner[k] && following[k] < 0;
        starts += !inner[k] && !entered[k];
    }
    if (!ends || ends != starts)
        return 1;
    left = malloc((size_t)(2 * ends) * sizeof *left);
    if (!left)
        return 0;
    right = left + ends;
    ends = starts = 0;
    for (k = 0; k < parts; k++) {
        loose z = {site[k], k, 0.0, end[k]};
        z.along = z.at.x * slant.x - z.at.y * slant.y;
        if (!inner[k] && following[k] < 0)
            left[ends++] = z;
        z.at = start[k];
        z.along = z.at.x * slant.x - z.at.y * slant.y;
        if (!inner[k] && !entered[k])
            right[starts++] = z;
    }
    qsort(left, (size_t)ends, sizeof *left, by_place);
    qsort(right, (size_t)ends, sizeof *right, by_place);
    for (k = 0; k < ends && left[k].site == right[k].site; k++)
        ;
    if (k == ends) {
        double before = INFINITY;
        for (k = 0; k < ends; k++) {
            double x = left[k].at.x - right[k].at.x, y = left[k].at.y - right[k].at.y, gap = sqrt(x * x + y * y);
            double after = INFINITY;
            if (k + 1 < ends && left[k + 1].site == left[k].site)
                after = fmin(left[k + 1].along - right[k].along, right[k + 1].along - left[k].along);
            if (gap < after && gap < before) {
                following[left[k].part] = right[k].part;
                entered[right[k].part] = 1;
            }
            before = after;
        }
    }
    free(left);
    return 1;
}

/* Write for each part the next one where that is plain, else -1; whether it faces its own site; whether it is the next
   one of another part; its start and end, counter-clockwise around its tile; its site. The result is 0, or NO_MEMORY. */
int64_t trace_links(const int64_t *half_edge, const int64_t *corner, int64_t parts, const int64_t *row, const int64_t *copy,
                    const int64_t *item, const double *begins, const double *ends,
                    int64_t half_edges, const int64_t *source, const int64_t *next, int64_t corners,
                    const int64_t *corner_node, const int64_t *node_site, int64_t bundles, double slant_x, double slant_y, int64_t *following,
                    uint8_t *inner, uint8_t *entered, double *starts_out, double *ends_out, int64_t *site)
{
    const point *begin = (const point *)begins, *end = (const point *)ends;
    point *start_ = (point *)starts_out, *end_ = (point *)ends_out;
    span *edge = malloc((size_t)(half_edges + corners) * sizeof *edge), *of_corner = edge + half_edges;
    int64_t k, c, last = -1;
    if (!edge)
        return NO_MEMORY;
    for (k = 0; k < half_edges + corners; k++)
        edge[k].first = edge[k].last = -1;
    for (k = 0; k < parts; k++) {
        int64_t r = row[k];
        int straight = corner[r] < 0;
        span *owner = straight ? edge + half_edge[r] : of_corner + corner[r];
        following[k] = -1;
        entered[k] = 0;
        start_[k] = straight ? end[k] : begin[k];
        end_[k] = straight ? begin[k] : end[k];
        site[k] = node_site[straight ? source[half_edge[r]] : corner_node[corner[r]]];
        c = item[k] < half_edges ? source[item[k]] : corner_node[item[k] - half_edges];
        inner[k] = copy[k] < bundles && node_site[c] == site[k];
        /* Parts, and rows, of one half-edge or corner follow each other by ascending x. */
        if (owner->first < 0)
            owner->first = k;
        else if (straight)
            following[k] = last;
        else
            following[last] = k;
        owner->last = last = k;
    }
    /* The corner between half-edges c and next[c]: counter-clockwise around the tile, from the latter over it to c. */
    for (c = 0; c < half_edges; c++)
        if (edge[c].first >= 0) {
            int64_t before = edge[next[c]].first;
            following[before] = of_corner[c].first < 0 ? edge[c].last : of_corner[c].first;
            if (of_corner[c].first >= 0)
                following[of_corner[c].last] = edge[c].last;
        }
    /* An isolated node's four corners are numbered clockwise. */
    for (c = half_edges; c < corners; c++)
        following[of_corner[c].last] = of_corner[(c - half_edges) % 4 ? c - 1 : c + 3].first;
    free(edge);
    for (k = 0; k < parts; k++)
        if (following[k] >= 0) {
            if (inner[k] || inner[following[k]])
                following[k] = -1;
            else
                entered[following[k]] = 1;
        }
    {
        point slant = {slant_x, slant_y};
        return match(parts, slant, inner, start_, end_, site, following, entered) ? 0 : NO_MEMORY;
    }
}

/* Write the rings to which the parts chain up that are not `seen`, without arcs that are no longer than `null`: their
   parts, vertices and rings. The result is the number of arcs, or OPEN where a site has none, or NO_MEMORY. */
int64_t trace_rings(int64_t parts, const int64_t *following, uint8_t *seen, const double *starts, const int64_t *site,
                    int64_t sites, double null, int64_t *part, double *vertices, int64_t *ring)
{
    const point *start = (const point *)starts;
    point *vertex = (point *)vertices;
    int64_t count = 0, before, number = 0, found = 0, k, first;
    uint8_t *has;
    for (first = 0; first < parts; first++) {
        if (seen[first])
            continue;
        for (k = first; !seen[k]; k = following[k], count++) {
            seen[k] = 1;
            part[count] = k;
            vertex[count] = start[k];
            ring[count] = number;
        }
        number++;
    }
    do {
        int64_t from, to;
        before = count;
        count = 0;
        for (from = 0; from < before; from = to) {
            point opening = vertex[from];
            int64_t here = ring[from];
            for (to = from; to < before && ring[to] == here; to++) {
                point z = to + 1 < before && ring[to + 1] == here ? vertex[to + 1] : opening;
                double x = z.x - vertex[to].x, y = z.y - vertex[to].y;
                if (!(sqrt(x * x + y * y) > null))
                    continue;
                part[count] = part[to];
                vertex[count] = vertex[to];
                ring[count++] = here;
            }
        }
    } while (count < before);
    has = calloc((size_t)sites, 1);
    if (!has)
        return NO_MEMORY;
    for (k = 0; k < count; k++)
        if (!has[site[part[k]]]) {
            has[site[part[k]]] = 1;
            found++;
        }
    free(has);
    return found == sites ? count : OPEN;
}
