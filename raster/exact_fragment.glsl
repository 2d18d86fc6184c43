// OpenGL 3.3: one fragment per sample, the lists in textures of a fixed width.

uniform isampler2D block_table;
uniform isampler2D run_table;
uniform sampler2D element_table;

out ivec4 result;

#define AT(n) ivec2((n) & (TEXTURE_WIDTH - 1), (n) / TEXTURE_WIDTH)
#define FETCH_BLOCK(n) texelFetch(block_table, AT(n), 0).xy
#define FETCH_RUN(n) texelFetch(run_table, AT(n), 0)
#define FETCH_ELEMENT(n) texelFetch(element_table, AT(n), 0)
#include "exact.glsl"

void main() {
    result = two_nearest(ivec2(gl_FragCoord.xy));
}
