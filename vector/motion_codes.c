/* Motions as integers, as motion_codes.py explains them: the images of points, and the least of several products. */

#include <stdint.h>

#define BITS 29
#define MASK (((int64_t)1 << BITS) - 1)
#define HALF ((int64_t)1 << (BITS - 1))
#define TRANSLATION (((int64_t)1 << 2 * BITS) - 1)

typedef struct {
    double x, y;
} point;

/* The images of points, each under its motion and then a translation. Of each linear part `units` has the unit complex
   number, `signs` -1 where it conjugates, else 1; a and b are the lattice's vectors. */
int64_t codes_images(int64_t count, const int64_t *code, const double *points, const double *units, const double *signs,
                     double a_x, double a_y, double b_x, double b_y, int64_t further_s, int64_t further_t, double *out)
{
    const point *unit = (const point *)units, *z = (const point *)points;
    point *result = (point *)out;
    int64_t k;
    for (k = 0; k < count; k++) {
        int64_t linear = code[k] >> 2 * BITS;
        double i = (double)(((code[k] >> BITS) & MASK) - HALF + further_s) / 2;
        double j = (double)((code[k] & MASK) - HALF + further_t) / 2;
        double x = z[k].x, y = signs[linear] * z[k].y;
        result[k].x = unit[linear].x * x - unit[linear].y * y + (i * a_x + j * b_x);
        result[k].y = unit[linear].y * x + unit[linear].x * y + (i * a_y + j * b_y);
    }
    return 0;
}

/* The least of each motion's products with the motions of a row, or the motion itself where its row is negative.

   The rows have `width` motions each. Of linear parts `product` has the codes of all products, and `along` what each
   makes of a translation's two coordinates: first of the one, then of the other. */
int64_t codes_least(int64_t count, const int64_t *code, const int64_t *row, int64_t width, const int64_t *rows,
                    int64_t parts, const int64_t *product, const int64_t *along, int64_t *out)
{
    int64_t k, n;
    for (k = 0; k < count; k++) {
        int64_t linear = code[k] >> 2 * BITS, shift = code[k] & TRANSLATION;
        const int64_t *inner = rows + row[k] * width;
        out[k] = row[k] < 0 ? code[k] : INT64_MAX;
        for (n = 0; row[k] >= 0 && n < width; n++) {
            int64_t u = ((inner[n] >> BITS) & MASK) - HALF, v = (inner[n] & MASK) - HALF;
            int64_t composed = product[linear * parts + (inner[n] >> 2 * BITS)] + shift + along[linear] * u +
                               along[parts + linear] * v;
            if (composed < out[k])
                out[k] = composed;
        }
    }
    return 0;
}
