// @ts-check
/** The preview's shaders about the shader text of the raster stage, which finds the two nearest copies of a sample. */

/** Records along a row of a texture that holds a table; a power of 2. */
export const TABLE_WIDTH = 1024;

const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp isampler2D;
#define AT(n) ivec2((n) & ${TABLE_WIDTH - 1}, (n) / ${TABLE_WIDTH})
`;

/** One triangle over the whole image, without any vertex data. */
export const WHOLE_SCREEN = `#version 300 es
void main() {
    gl_Position = vec4(vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1), 0.0, 1.0);
}
`;

/**
 * What is seen at a sample: the nearest copy, the cells that it is moved by (two numbers of 16 bits), and the bits of
 * two distances in pixels: to the nearest border, and to the copy.
 *
 * Of the border between copies 1 and k, where their distances are equal, (d_k - d_1) / |n_k - n_1| is the distance to
 * first order, n being the unit vectors from the feet: d_k - d_1 itself, as near it comes to 0, changes slowly where
 * these are nearly alike. It is never less than half of d_k - d_1, so only what is nearer than `band` is measured.
 * Where two copies have one foot, they touch there: what is nearest to it belongs to nobody, and the distance is -1.
 */
const LOOK = `
uniform isampler2D block_table;
uniform isampler2D run_table;
uniform sampler2D element_table;
uniform float band;
#define FETCH_BLOCK(n) texelFetch(block_table, AT(n), 0).xy
#define FETCH_RUN(n) texelFetch(run_table, AT(n), 0)
#define FETCH_ELEMENT(n) texelFetch(element_table, AT(n), 0)

#include "exact.glsl"

vec2 from_foot_of(ivec4 run, vec2 p) {
    float least = 3.0e38;
    vec2 shortest = vec2(0.0);
    for (int n = run.x; n < run.x + run.y; ++n) {
        vec4 element = FETCH_ELEMENT(n);
        vec2 away = p - element.xy;
        float share = dot(away, element.zw) / max(dot(element.zw, element.zw), 1.0e-30);
        vec2 from_foot = away - clamp(share, -1.0, 1.0) * element.zw;
        float square = dot(from_foot, from_foot);
        if (square < least) {
            least = square;
            shortest = from_foot;
        }
    }
    return shortest;
}

float border_distance(ivec2 sample_at, int owner) {
    ivec2 home = sample_at / block;
    vec2 offset = vec2(sample_at - home * block) - 0.5 * float(block);
    vec2 p = offset.x * u + offset.y * v;
    ivec2 runs = FETCH_BLOCK(home.y * columns + home.x);
    vec2 from1 = vec2(0.0);
    for (int k = runs.x; k < runs.x + runs.y; ++k) {
        ivec4 run = FETCH_RUN(k);
        if (run.z == owner) {
            from1 = from_foot_of(run, p);
        }
    }
    float d1 = length(from1);
    vec2 n1 = from1 / max(d1, 1.0e-30);
    float least = 3.0e38;
    for (int k = runs.x; k < runs.x + runs.y; ++k) {
        ivec4 run = FETCH_RUN(k);
        if (run.z != owner) {
            vec2 from = from_foot_of(run, p);
            float d = length(from);
            if (distance(from, from1) <= 1.0e-2 + 1.0e-5 * d) {
                return -1.0;
            }
            least = min(least, (d - d1) / max(distance(from / max(d, 1.0e-30), n1), 1.0e-4));
        }
    }
    return least;
}

ivec4 look(ivec2 sample_at) {
    ivec4 found = two_nearest(sample_at);
    ivec2 home = sample_at / block;
    ivec2 cell = texelFetch(block_table, AT(home.y * columns + home.x), 0).zw;
    float border = 3.0e38;
    if (intBitsToFloat(found.w) - intBitsToFloat(found.z) < band) {
        border = border_distance(sample_at, found.x);
    }
    return ivec4(found.x, (cell.x & 0xffff) | (cell.y << 16), floatBitsToInt(border), found.z);
}
`;

/** The cells that a copy is moved by, and the same when it is moved by more. */
const CELLS = `
ivec2 cells_of(ivec4 seen) {
    return ivec2((seen.y << 16) >> 16, seen.y >> 16);
}

ivec4 moved(ivec4 seen, ivec2 by) {
    ivec2 cells = cells_of(seen) + by;
    return ivec4(seen.x, (cells.x & 0xffff) | (cells.y << 16), seen.zw);
}
`;

/** The colour of what is seen. Copies have the colour at their place in the colouring's repeat. */
const SHADE = `
uniform isampler2D copy_table;   // of each copy: placement, and the cells that it is moved by
uniform sampler2D colour_table;  // of each placement and place
uniform ivec4 rows;
uniform ivec2 repeat;
uniform ivec2 home_cell;
uniform vec4 border;             // red, green, blue; half the width in pixels
uniform vec4 stroke;
uniform float stroke_opacity;
uniform vec3 nobody;

int modulo(int x, int m) {
    return x - m * int(floor((float(x) + 0.5) / float(m)));
}

vec3 shade(ivec4 seen) {
    ivec4 copy = texelFetch(copy_table, AT(seen.x), 0);
    ivec2 cells = copy.yz + cells_of(seen) + home_cell;
    int x = modulo(rows.x * cells.x + rows.y * cells.y, repeat.x);
    int y = modulo(rows.z * cells.x + rows.w * cells.y, repeat.y);
    vec3 colour = texelFetch(colour_table, AT((copy.x * repeat.x + x) * repeat.y + y), 0).rgb;
    float edge = intBitsToFloat(seen.z);
    if (edge < 0.0) {
        colour = nobody;
        edge = 3.0e38;
    }
    float in_stroke = clamp(stroke.w + 0.5 - intBitsToFloat(seen.w), 0.0, 1.0);
    colour = mix(colour, stroke.rgb, stroke_opacity * in_stroke);
    return mix(colour, border.rgb, clamp(border.w + 0.5 - edge, 0.0, 1.0));
}
`;

/** A pixel's place in fractional coordinates: those of a corner of the image, and what a pixel adds to them. */
const PLACE = `
uniform vec2 corner;
uniform vec2 per_column;
uniform vec2 per_row;

vec2 place() {
    return corner + gl_FragCoord.x * per_column + gl_FragCoord.y * per_row;
}
`;

/** What is seen, looked up in the image of one cell. */
const FOLD = `
uniform isampler2D cell_image;

ivec4 fold() {
    vec2 at = place();
    ivec2 size = textureSize(cell_image, 0);
    ivec2 texel = clamp(ivec2((at - floor(at)) * vec2(size)), ivec2(0), size - 1);
    return moved(texelFetch(cell_image, texel, 0), ivec2(floor(at)));
}
`;

/**
 * The fragment shaders by name, about the text of exact.glsl.
 *
 * `look` gives what is seen at the samples of a frame, `exact` its colours; `fold` and `colour` give the same from an
 * image of one cell; `tile` repeats a picture of one period.
 * @param {string} exact
 */
export function fragmentShaders(exact) {
    const look = LOOK.replace('#include "exact.glsl"', () => exact);
    const seen = "out ivec4 result;\n";
    const drawn = "out vec4 result;\n";
    const here = "ivec2(gl_FragCoord.xy)";
    return {
        look: `${HEAD}${look}${seen}void main() { result = look(${here}); }`,
        exact: `${HEAD}${look}${CELLS}${SHADE}${drawn}void main() { result = vec4(shade(look(${here})), 1.0); }`,
        fold: `${HEAD}${CELLS}${PLACE}${FOLD}${seen}void main() { result = fold(); }`,
        colour: `${HEAD}${CELLS}${SHADE}${PLACE}${FOLD}${drawn}void main() { result = vec4(shade(fold()), 1.0); }`,
        tile: `${HEAD}${PLACE}uniform sampler2D period_image;
${drawn}void main() { result = texture(period_image, place()); }`,
    };
}

/** @typedef {keyof ReturnType<typeof fragmentShaders>} ShaderName */
