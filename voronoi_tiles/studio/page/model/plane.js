// @ts-check
/**
 * Points of the plane, and the similarities that place and repeat what is drawn.
 *
 * The names are those of `voronoi_tiles.base.maps`, and so is the arithmetic: turns by multiples of 30 degrees are
 * exact.
 */

/** @typedef {[number, number]} Point x to the right, y up; also a vector, and a complex number */

/**
 * The map z -> a z + b, or a conj(z) + b where `conj`.
 * @typedef {object} Similarity
 * @property {Point} a
 * @property {Point} b
 * @property {boolean} conj
 */

/** @typedef {[number, number, number, number]} Box left, bottom, right, top */

const HALF_SQRT3 = Math.sqrt(3) / 2;

/** @type {readonly Point[]} The unit complex numbers at the multiples of 30 degrees. */
const UNITS = [
    [1, 0],
    [HALF_SQRT3, 0.5],
    [0.5, HALF_SQRT3],
    [0, 1],
    [-0.5, HALF_SQRT3],
    [-HALF_SQRT3, 0.5],
    [-1, 0],
    [-HALF_SQRT3, -0.5],
    [-0.5, -HALF_SQRT3],
    [0, -1],
    [0.5, -HALF_SQRT3],
    [HALF_SQRT3, -0.5],
];

/** What moves nothing. @type {Readonly<Similarity>} */
export const IDENTITY = { a: [1, 0], b: [0, 0], conj: false };

/** The sum of two points. @type {(p: Point, q: Point) => Point} */
export const plus = (p, q) => [p[0] + q[0], p[1] + q[1]];

/** The vector from q to p. @type {(p: Point, q: Point) => Point} */
export const minus = (p, q) => [p[0] - q[0], p[1] - q[1]];

/** A vector times a number. @type {(p: Point, factor: number) => Point} */
export const scaled = (p, factor) => [p[0] * factor, p[1] * factor];

/** The product of two complex numbers. @type {(p: Point, q: Point) => Point} */
export const times = (p, q) => [p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]];

/** The mirror image in the x axis. @type {(p: Point) => Point} */
export const conjugate = (p) => [p[0], -p[1]];

/** The inner product. @type {(p: Point, q: Point) => number} */
export const dot = (p, q) => p[0] * q[0] + p[1] * q[1];

/** The cross product, positive where q is to the left of p. @type {(p: Point, q: Point) => number} */
export const cross = (p, q) => p[0] * q[1] - p[1] * q[0];

/** The length of a vector. @type {(p: Point) => number} */
export const length = (p) => Math.hypot(p[0], p[1]);

/** The distance of two points. @type {(p: Point, q: Point) => number} */
export const distance = (p, q) => Math.hypot(p[0] - q[0], p[1] - q[1]);

/** Whether two points are the same. @type {(p: Point, q: Point) => boolean} */
export const same = (p, q) => p[0] === q[0] && p[1] === q[1];

/** The point at the share t of the way from p to q. @type {(p: Point, q: Point, t: number) => Point} */
export const between = (p, q, t) => [p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t];

/** The unit complex number at an angle in degrees, exact at multiples of 30. @type {(degrees: number) => Point} */
export function unitAt(degrees) {
    const turn = degrees % 360; // exact, unlike a reduction in radians
    const steps = Math.round(turn / 30);
    if (steps * 30 === turn) return UNITS[(steps + 12) % 12];
    const angle = (turn * Math.PI) / 180;
    return [Math.cos(angle), Math.sin(angle)];
}

/**
 * The multiple of 30 degrees that is nearest to a direction, as a unit complex number.
 * @type {(direction: Point) => Point}
 */
export function nearestUnit(direction) {
    return UNITS[(Math.round((Math.atan2(direction[1], direction[0]) * 6) / Math.PI) + 12) % 12];
}

/** The image of a point. @type {(map: Readonly<Similarity>, z: Point) => Point} */
export function apply(map, z) {
    const image = turned(map, z);
    return [image[0] + map.b[0], image[1] + map.b[1]];
}

/** The image of a vector: of the difference of two points. @type {(map: Readonly<Similarity>, v: Point) => Point} */
export function turned(map, v) {
    const x = v[0];
    const y = map.conj ? -v[1] : v[1];
    return [map.a[0] * x - map.a[1] * y, map.a[1] * x + map.a[0] * y];
}

/**
 * The similarity that applies `inner` first and `outer` to its result.
 * @type {(outer: Readonly<Similarity>, inner: Readonly<Similarity>) => Similarity}
 */
export function compose(outer, inner) {
    return { a: turned(outer, inner.a), b: apply(outer, inner.b), conj: outer.conj !== inner.conj };
}

/** The similarity that undoes another one, but for rounding. @type {(map: Readonly<Similarity>) => Similarity} */
export function inverse(map) {
    const square = dot(map.a, map.a);
    const back = scaled(map.conj ? map.a : conjugate(map.a), 1 / square);
    const linear = { a: back, b: /** @type {Point} */ ([0, 0]), conj: map.conj };
    return { ...linear, b: scaled(turned(linear, map.b), -1) };
}

/** A vector of length 1 in the direction of another; none of the zero vector. @type {(v: Point) => Point} */
export const unit = (v) => scaled(v, 1 / (length(v) || 1));

/** A point with so many digits behind the point. @type {(p: Point, digits: number) => Point} */
export const fixed = (p, digits) => [Number(p[0].toFixed(digits)) + 0, Number(p[1].toFixed(digits)) + 0];

/** The factor by which a similarity enlarges. @type {(map: Readonly<Similarity>) => number} */
export const factorOf = (map) => length(map.a);

/**
 * The sum of two coordinates, without what binary fractions leave: 0.1 and 0.2 are 0.3.
 *
 * It is rounded to 15 significant digits of the larger of the two, which every decimal number of so many digits
 * survives: what is moved and moved back is written as before.
 * @type {(x: number, y: number) => number}
 */
export function tidySum(x, y) {
    const largest = Math.max(Math.abs(x), Math.abs(y));
    const digits = largest ? 14 - Math.floor(Math.log10(largest)) : 0;
    return digits >= 0 && digits <= 100 ? Number((x + y).toFixed(digits)) + 0 : x + y;
}

/** A point moved by a vector, each coordinate a tidy sum. @type {(p: Point, by: Point) => Point} */
export const tidyPlus = (p, by) => [tidySum(p[0], by[0]), tidySum(p[1], by[1])];

/** The vector from q to p, each coordinate a tidy sum. @type {(p: Point, q: Point) => Point} */
export const tidyMinus = (p, q) => tidyPlus(p, scaled(q, -1));

/** The product of two numbers with at most 15 significant digits. @type {(x: number, y: number) => number} */
export const tidyProduct = (x, y) => Number((x * y).toPrecision(15));

/** A vector times a number, each coordinate a tidy product. @type {(p: Point, factor: number) => Point} */
export const tidyScaled = (p, factor) => [tidyProduct(p[0], factor), tidyProduct(p[1], factor)];
