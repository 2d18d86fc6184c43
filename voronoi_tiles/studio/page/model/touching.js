// @ts-check
/** Whether copies of sites touch: a quick look at coarse segments; the engine has the last word. */

import { cosets } from "./copies.js";
import { imagesIn } from "./lattice.js";
import { length } from "./plane.js";
import { boxOf, mapped, segmentsTouch } from "./segments.js";
import { cubicsOf, flatten, placementOf } from "./strokes.js";
import { latticeOf, motionsOf } from "./symmetry.js";

/** @import { Box } from "./plane.js" */
/** @import { Design } from "./design.js" */
/** @import { Lattice } from "./lattice.js" */
/** @import { Tables } from "./symmetry.js" */

/** How far apart copies must be to stay; relative to a. */
const APART = 2e-3;

/** How exactly strokes are flattened to look for copies that touch; relative to a. */
const FLATTENING = 1e-3;

/**
 * Whether copies of a design's sites touch, or nearly so.
 * @type {(design: Design, tables: Tables, resolved?: Readonly<Record<string, string>>) => boolean}
 */
export function copiesTouch(design, tables, resolved = {}) {
    const lattice = latticeOf(design, tables);
    const motions = motionsOf(design, tables);
    const sites = design.site.map((_, k) => segmentsOf(design, k, resolved)).filter((segments) => segments.length);
    const apart = APART * length(lattice.a);
    const copies = sites.map((segments) => cosets(motions, lattice, segments).map((k) => mapped(motions[k], segments)));
    return sites.some((segments, one) =>
        copies
            .slice(one)
            .some((images, other) =>
                images.some((image, k) => imageTouches(segments, image, lattice, apart, other === 0 && k === 0)),
            ),
    );
}

/**
 * A site's segments, coarse.
 * @type {(d: Design, k: number, resolved: Readonly<Record<string, string>>) => Float64Array}
 */
export function segmentsOf(design, k, resolved) {
    const site = design.site[k];
    const parts = site.strokes.map((stroke, n) => [
        ...flatten(cubicsOf(stroke, placementOf(site, stroke), resolved[`${k}.${n}`]), FLATTENING * design.cell.a),
    ]);
    return Float64Array.from(parts.flat());
}

/**
 * Whether segments are nearer than `apart` to a translate of an image of theirs, or of another site's.
 * @param {Float64Array} segments
 * @param {Float64Array} image
 * @param {Lattice} lattice
 * @param {number} apart
 * @param {boolean} isItself whether the image is the segments, so that the zero translation does not count
 * @returns {boolean}
 */
function imageTouches(segments, image, lattice, apart, isItself) {
    const [left, bottom, right, top] = boxOf(segments);
    const box = boxOf(image);
    // Translations t with which the image's box, moved by t, meets that of the segments.
    /** @type {Box} */
    const window = [left - box[2] - apart, bottom - box[3] - apart, right - box[0] + apart, top - box[1] + apart];
    return imagesIn(lattice, [0, 0], window).some((t) => {
        if (isItself && t[0] === 0 && t[1] === 0) return false;
        return segmentsTouch(segments, mapped({ a: [1, 0], b: t, conj: false }, image), apart);
    });
}
