/* Which edges are plainly the images of others: `_agree` of edges.py. */

#include <stdint.h>

/* Of motion_codes.c. */
int64_t codes_images(int64_t count, const int64_t *code, const double *points, const double *units, const double *signs,
                     double a_x, double a_y, double b_x, double b_y, int64_t further_s, int64_t further_t, double *out);

typedef struct {
    double x, y;
} point;

/* Write for each link whether the image of its edge has the vertices of the edge that it leads to, within a limit.

   Edge k are the arcs `arcs` from `offsets[k]` up to, not including, `offsets[k + 1]`; it begins at the vertex
   `start[k]` and ends where the edge `following[k]` begins. */
int64_t complex_agree(int64_t count, const int64_t *links, const int64_t *source, const int64_t *image,
                      const int64_t *by, const uint8_t *backwards, const int64_t *offsets, const int64_t *arcs,
                      const int64_t *start, const int64_t *following, const double *vertices, const double *units,
                      const double *signs, double a_x, double a_y, double b_x, double b_y, double limit, uint8_t *agree)
{
    const point *vertex = (const point *)vertices;
    int64_t k, i;
    for (k = 0; k < count; k++) {
        int64_t link = links[k], here = source[link], there = image[link], arcs_here = offsets[here + 1] - offsets[here];
        agree[k] = arcs_here == offsets[there + 1] - offsets[there];
        for (i = 0; agree[k] && i <= arcs_here; i++) {
            int64_t j = backwards[link] ? arcs_here - i : i;
            point one = vertex[i < arcs_here ? arcs[offsets[here] + i] : start[following[here]]], gap;
            point two = vertex[j < arcs_here ? arcs[offsets[there] + j] : start[following[there]]];
            codes_images(1, by + link, &one.x, units, signs, a_x, a_y, b_x, b_y, 0, 0, &gap.x);
            gap.x -= two.x;
            gap.y -= two.y;
            agree[k] = gap.x * gap.x + gap.y * gap.y <= limit * limit;
        }
    }
    return 0;
}
