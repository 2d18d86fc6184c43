// The two nearest copies of one sample: a loop over its block's runs of elements, exact but for float32.
//
// FETCH_BLOCK(n) is ivec2(first run, runs), FETCH_RUN(n) ivec4(first element, elements, label, 0), FETCH_ELEMENT(n)
// vec4(middle, half), the middle from the block's centre. Lengths are in pixels, as are the steps u and v.

uniform vec2 u;
uniform vec2 v;
uniform int block;
uniform int columns;

ivec4 two_nearest(ivec2 sample_at) {
    ivec2 home = sample_at / block;
    vec2 offset = vec2(sample_at - home * block) - 0.5 * float(block);
    vec2 p = offset.x * u + offset.y * v;
    ivec2 runs = FETCH_BLOCK(home.y * columns + home.x);
    float square1 = 3.0e38, square2 = 3.0e38;
    int label1 = -1, label2 = -1;
    for (int k = runs.x; k < runs.x + runs.y; ++k) {
        ivec4 run = FETCH_RUN(k);
        float square = 3.0e38;
        for (int n = run.x; n < run.x + run.y; ++n) {
            vec4 element = FETCH_ELEMENT(n);
            vec2 away = p - element.xy;
            vec2 half_vector = element.zw;
            float share = dot(away, half_vector) / max(dot(half_vector, half_vector), 1.0e-30);
            vec2 from_foot = away - clamp(share, -1.0, 1.0) * half_vector;
            square = min(square, dot(from_foot, from_foot));
        }
        if (square < square1) {
            square2 = square1;
            label2 = label1;
            square1 = square;
            label1 = run.z;
        } else if (square < square2) {
            square2 = square;
            label2 = run.z;
        }
    }
    return ivec4(label1, label2, floatBitsToInt(sqrt(square1)), floatBitsToInt(sqrt(square2)));
}
