// One element as a mesh whose height is the distance: two half cones and two tents (Hoff et al. 1999).

uniform mat2 to_grid;  // from lengths in pixels to steps of the grid
uniform vec2 size;

in vec3 corner;   // end (-1 or 1), along, across; for a reach of 1
in vec2 slope;    // the gradient of the triangle's height, along and across
in vec4 element;  // middle on the grid, half vector in pixels
in float reach;
in int label;

flat out int copy_label;
flat out vec2 gradient;
flat out vec2 foot;

void main() {
    float half_length = length(element.zw);
    vec2 unit = half_length > 0.0 ? element.zw / half_length : vec2(1.0, 0.0);
    vec2 normal = vec2(-unit.y, unit.x);
    copy_label = label;
    gradient = slope.x * unit + slope.y * normal;
    foot = element.xy + to_grid * (corner.x * element.zw);
    vec2 at = foot + to_grid * (reach * (corner.y * unit + corner.z * normal));
    gl_Position = vec4(2.0 * at / size - 1.0, 0.0, 1.0);
}
