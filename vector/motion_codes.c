/* Motions as integers, as motion_codes.py explains them: the images of points, products and inverses, and the least of several products. */

#include <stdint.h>

#define BITS 29
#define MASK (((int64_t)1 << BITS) - 1)
#define HALF ((int64_t)1 << (BITS - 1))
#define TRANSLATION (((int64_t)1 << 2 * BITS) - 1)

typedef struct {
    double x, y;
} point;

/* Twice the translation of a motion, in both coordinates. */
void codes_translation(int64_t code, int64_t *s, int64_t *t)
{
    *s = ((code >> BITS) & MASK) - HALF;
    *t = (code & MASK) - HALF;
}

/* The motion that applies another first, and then a translation by i and j cells; -1 where it has no code. */
int64_t codes_moved(int64_t code, int64_t i, int64_t j)
{
    if (i > HALF / 4 || i < -HALF / 4 || j > HALF / 4 || j < -HALF / 4)
        return -1;
    return code + 2 * (i * ((int64_t)1 << BITS) + j);
}

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

/* The motion that applies `inner` first and `outer` to its result.

   Of linear parts `product` has the codes of all products, and `along` what each makes of a translation's two
   coordinates: first of the one, then of the other. */
static int64_t composed(int64_t outer, int64_t inner, int64_t parts, const int64_t *product, const int64_t *along)
{
    int64_t linear = outer >> 2 * BITS, u = ((inner >> BITS) & MASK) - HALF, v = (inner & MASK) - HALF;
    return product[linear * parts + (inner >> 2 * BITS)] + (outer & TRANSLATION) + along[linear] * u +
           along[parts + linear] * v;
}

/* Motions composed one by one. */
int64_t codes_composed(int64_t count, const int64_t *outer, const int64_t *inner, int64_t parts, const int64_t *product,
                       const int64_t *along, int64_t *out)
{
    int64_t k;
    for (k = 0; k < count; k++)
        out[k] = composed(outer[k], inner[k], parts, product, along);
    return 0;
}

/* The motions that undo others. Of linear parts `back` has the codes of their inverses with no translation, `along` what
   each inverse makes of a translation's two coordinates. */
int64_t codes_inverted(int64_t count, const int64_t *code, int64_t parts, const int64_t *back, const int64_t *along,
                       int64_t *out)
{
    int64_t k;
    for (k = 0; k < count; k++) {
        int64_t linear = code[k] >> 2 * BITS, s = ((code[k] >> BITS) & MASK) - HALF, t = (code[k] & MASK) - HALF;
        out[k] = back[linear] - along[linear] * s - along[parts + linear] * t;
    }
    return 0;
}

/* The least of each motion's products with the motions of a row, or the motion itself where its row is negative;
   the rows have `width` motions each. */
int64_t codes_least(int64_t count, const int64_t *code, const int64_t *row, int64_t width, const int64_t *rows,
                    int64_t parts, const int64_t *product, const int64_t *along, int64_t *out)
{
    int64_t k, n;
    for (k = 0; k < count; k++) {
        int64_t least = row[k] < 0 ? code[k] : INT64_MAX;
        for (n = 0; row[k] >= 0 && n < width; n++) {
            int64_t other = composed(code[k], rows[row[k] * width + n], parts, product, along);
            least = other < least ? other : least;
        }
        out[k] = least;
    }
    return 0;
}
