// OpenGL 4.3: one work group per block, one invocation per sample.

layout(local_size_x = BLOCK, local_size_y = BLOCK) in;

layout(std430, binding = 0) readonly buffer Blocks { ivec2 block_table[]; };
layout(std430, binding = 1) readonly buffer Runs { ivec4 run_table[]; };
layout(std430, binding = 2) readonly buffer Elements { vec4 element_table[]; };
layout(std430, binding = 3) writeonly buffer Result { ivec4 result[]; };

uniform ivec2 size;

#define FETCH_BLOCK(n) block_table[n]
#define FETCH_RUN(n) run_table[n]
#define FETCH_ELEMENT(n) element_table[n]
#include "exact.glsl"

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x < size.x && at.y < size.y) {
        result[at.y * size.x + at.x] = two_nearest(at);
    }
}
