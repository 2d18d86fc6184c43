// The depth test keeps the nearest copy; in the second layer the owner, which the first layer has found, is left out.
// Heights are taken from the triangle's plane: interpolated between far corners they lose digits in thin triangles.

uniform isampler2D owner;
uniform bool second_layer;
uniform float farthest;
uniform vec2 u;
uniform vec2 v;

flat in int copy_label;
flat in vec2 gradient;
flat in vec2 foot;

out ivec2 result;

void main() {
    if (second_layer && texelFetch(owner, ivec2(gl_FragCoord.xy), 0).x == copy_label) {
        discard;
    }
    vec2 steps = gl_FragCoord.xy - foot;
    float height = max(dot(gradient, steps.x * u + steps.y * v), 0.0);
    gl_FragDepth = height / farthest;
    result = ivec2(copy_label, floatBitsToInt(height));
}
